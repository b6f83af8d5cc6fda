//! Rays against a mesh of 99 904 triangles, on one core: ours (boxes in f32, triangles in f64) beside the
//! crates of the registry. Million rays per CPU second, taken in turns so that a busy machine slows all
//! alike; the best of the turns counts. Ours answers with distance and primitive by `Scene::nearest`, and
//! whether a point is seen from another by `Scene::connect`.
//!
//! `cargo run --release -p tpb-benches --example triangles [TURNS]`

use std::f64::consts::PI;
use std::time::Duration;

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use cpu_time::ProcessTime;
use glam::{DAffine3, DVec3};
use nalgebra::{Point3, Vector3};
use obvhs::bvh2::Bvh2;
use obvhs::cwbvh::CwBvh;
use obvhs::ray::{Ray, RayHit};
use obvhs::rt_triangle::RtTriangle;
use obvhs::{BvhBuildParams, triangle::Triangle};
use tpb_benches::one_thread;
use tpb_optics::{Rgb, Stream, warp};
use tpb_scene::geometry::{Outline, Planar};
use tpb_scene::{
    Bsdf, FilmSpec, FovAxis, IntegratorSpec, PixelFormat, Primitive, Reflector, Region, Scene,
    SceneParts, Sensor, ShapePart, Vertex,
};

/// Squares around and along the sphere.
const SQUARES: usize = 224;
/// Rays of one kind: a square number.
const RAYS: usize = 1 << 18;

/// One way to ask.
type Way<'a> = (&'static str, Box<dyn Fn(&[Segment]) -> usize + Send + Sync + 'a>);

/// A ray, and how far it goes when only obstacles are asked for.
#[derive(Clone, Copy)]
struct Segment {
    from: DVec3,
    direction: DVec3,
    length: f64,
}

#[expect(clippy::print_stdout, reason = "a program that prints a table")]
fn main() {
    let turns: usize = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(3);
    let corners = displaced_sphere();
    let scene = scene(&corners);
    let narrow = corners.iter().map(|c| {
        let [v0, v1, v2] = c.map(DVec3::as_vec3a);
        Triangle { v0, v1, v2 }
    });
    let narrow: Vec<_> = narrow.collect();
    let params = BvhBuildParams::slow_build();
    let time = &mut Duration::default();
    let wide = obvhs::cwbvh::builder::build_cwbvh_from_tris(&narrow, params, time);
    let binary = obvhs::bvh2::builder::build_bvh2_from_tris(&narrow, params, time);
    let in_order = |order: &[u32]| -> Vec<RtTriangle> {
        order.iter().map(|&index| (&narrow[index as usize]).into()).collect()
    };
    let of_wide = in_order(&wide.primitive_indices);
    let of_binary = in_order(&binary.primitive_indices);
    let mut shapes: Vec<_> = corners.iter().map(|c| Shape { corners: *c, node: 0 }).collect();
    let other = bvh::bvh::Bvh::build(&mut shapes);
    println!("{} triangles, {RAYS} rays, one core, {turns} turns: M rays/s", corners.len());
    for coherent in [true, false] {
        let rays = rays(coherent);
        let rays = &rays[..];
        let order = if coherent { "coherent" } else { "incoherent" };
        let nearest: [Way<'_>; 4] = [
            ("ours", Box::new(|rays| count(rays, |ray| nearest(&scene, ray)))),
            ("obvhs CwBvh", Box::new(|rays| count(rays, |ray| of_cwbvh(&wide, &of_wide, ray)))),
            ("obvhs Bvh2", Box::new(|rays| count(rays, |ray| of_bvh2(&binary, &of_binary, ray)))),
            ("bvh f64", Box::new(|rays| count(rays, |ray| of_bvh(&other, &shapes, ray)))),
        ];
        compare(&format!("nearest, {order}"), &nearest, rays, turns);
        let any: [Way<'_>; 4] = [
            ("ours", Box::new(|rays| count(rays, |ray| blocked(&scene, ray)))),
            ("obvhs CwBvh", Box::new(|rays| count(rays, |ray| any_cwbvh(&wide, &of_wide, ray)))),
            ("obvhs Bvh2", Box::new(|rays| count(rays, |ray| any_bvh2(&binary, &of_binary, ray)))),
            ("bvh f64", Box::new(|rays| count(rays, |ray| any_bvh(&other, &shapes, ray)))),
        ];
        compare(&format!("any hit, {order}"), &any, rays, turns);
    }
}

#[expect(clippy::print_stdout, reason = "a program that prints a table")]
fn compare(case: &str, ways: &[Way<'_>], rays: &[Segment], turns: usize) {
    let mut best = vec![(f64::INFINITY, 0); ways.len()];
    one_thread(|| {
        for _ in 0..turns {
            for (best, (_, ask)) in best.iter_mut().zip(ways) {
                let start = ProcessTime::now();
                let hits = ask(rays);
                *best = (best.0.min(start.elapsed().as_secs_f64()), hits);
            }
        }
    });
    let fastest = best[1..].iter().map(|b| b.0).fold(f64::INFINITY, f64::min);
    println!("{case}: {:.2} of the fastest", fastest / best[0].0);
    for ((name, _), (seconds, hits)) in ways.iter().zip(best) {
        println!("  {name:<12} {:>7.2}  ({hits} hits)", rays.len() as f64 / seconds / 1e6);
    }
}

fn count(rays: &[Segment], hit: impl Fn(&Segment) -> bool) -> usize {
    rays.iter().filter(|&ray| hit(ray)).count()
}

fn vertex(ray: &Segment) -> Vertex {
    Vertex { position: ray.from, primitive: None, region: Region::VACUUM }
}

fn nearest(scene: &Scene, ray: &Segment) -> bool {
    scene.nearest(&vertex(ray), ray.direction, f64::INFINITY).is_some()
}

fn blocked(scene: &Scene, ray: &Segment) -> bool {
    scene.connect::<1>(&vertex(ray), ray.direction, ray.length, None).is_none()
}

fn single(ray: &Segment, end: f32) -> Ray {
    Ray::new(ray.from.as_vec3a(), ray.direction.as_vec3a(), 0.0, end)
}

fn of_cwbvh(bvh: &CwBvh, triangles: &[RtTriangle], ray: &Segment) -> bool {
    let mut hit = RayHit::none();
    bvh.ray_traverse(single(ray, f32::INFINITY), &mut hit, |ray, id| triangles[id].intersect(ray))
}

fn of_bvh2(bvh: &Bvh2, triangles: &[RtTriangle], ray: &Segment) -> bool {
    let mut hit = RayHit::none();
    bvh.ray_traverse(single(ray, f32::INFINITY), &mut hit, |ray, id| triangles[id].intersect(ray));
    hit.t < f32::INFINITY
}

fn any_cwbvh(bvh: &CwBvh, triangles: &[RtTriangle], ray: &Segment) -> bool {
    !bvh.ray_traverse_miss(single(ray, ray.length as f32), |ray, id| triangles[id].intersect(ray))
}

fn any_bvh2(bvh: &Bvh2, triangles: &[RtTriangle], ray: &Segment) -> bool {
    !bvh.ray_traverse_miss(single(ray, ray.length as f32), |ray, id| triangles[id].intersect(ray))
}

/// A triangle of the crate `bvh`.
struct Shape {
    corners: [DVec3; 3],
    node: usize,
}

impl Bounded<f64, 3> for Shape {
    fn aabb(&self) -> Aabb<f64, 3> {
        let (mut min, mut max) = (self.corners[0], self.corners[0]);
        for corner in self.corners {
            (min, max) = (min.min(corner), max.max(corner));
        }
        Aabb::with_bounds(min.to_array().into(), max.to_array().into())
    }
}

impl BHShape<f64, 3> for Shape {
    fn set_bh_node_index(&mut self, node: usize) {
        self.node = node;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

type OfBvh = bvh::bvh::Bvh<f64, 3>;

fn double(ray: &Segment) -> bvh::ray::Ray<f64, 3> {
    let (from, direction) = (ray.from.to_array(), ray.direction.to_array());
    bvh::ray::Ray::new(Point3::from(from), Vector3::from(direction))
}

fn of_bvh(bvh: &OfBvh, shapes: &[Shape], ray: &Segment) -> bool {
    let (ray, mut best) = (double(ray), f64::INFINITY);
    for shape in bvh.traverse_iterator(&ray, shapes) {
        let [a, b, c] = shape.corners.map(|p| Point3::from(p.to_array()));
        best = best.min(ray.intersects_triangle(&a, &b, &c).distance);
    }
    best < f64::INFINITY
}

fn any_bvh(bvh: &OfBvh, shapes: &[Shape], ray: &Segment) -> bool {
    let (length, ray) = (ray.length, double(ray));
    bvh.traverse_iterator(&ray, shapes).any(|shape| {
        let [a, b, c] = shape.corners.map(|p| Point3::from(p.to_array()));
        ray.intersects_triangle(&a, &b, &c).distance < length
    })
}

/// Triangles of a sphere of radius 1 with waves on it, about the origin.
fn displaced_sphere() -> Vec<[DVec3; 3]> {
    let at = |i: usize, j: usize| {
        let theta = PI * i as f64 / SQUARES as f64;
        let phi = 2.0 * PI * (j % SQUARES) as f64 / SQUARES as f64;
        let radius = 1.0 + 0.15 * (9.0 * theta).sin() * (7.0 * phi).sin() * theta.sin();
        let (sin, cos) = theta.sin_cos();
        radius * DVec3::new(sin * phi.cos(), sin * phi.sin(), cos)
    };
    let squares = (0..SQUARES * SQUARES).map(|n| (n / SQUARES, n % SQUARES));
    let halves = |(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    let area = |c: &[DVec3; 3]| (c[1] - c[0]).cross(c[2] - c[0]).length();
    squares.flat_map(halves).filter(|corners| area(corners) > 1e-12).collect()
}

fn scene(corners: &[[DVec3; 3]]) -> Scene {
    let triangle = |&[a, b, c]: &[DVec3; 3]| {
        Primitive::Planar(Planar::new(a, b - a, c - a, Outline::Triangle))
    };
    let grey = Reflector::Diffuse(Rgb::splat(0.5));
    let mesh = ShapePart {
        name: "mesh".to_owned(),
        primitives: corners.iter().map(triangle).collect(),
        bsdf: Bsdf::Opaque { front: grey, back: grey },
        boundary: None,
        radiance: None,
    };
    let film = FilmSpec { width: 8, height: 8, pixel_format: PixelFormat::Luminance, time: None };
    let to_world = DAffine3::from_translation(DVec3::new(0.0, 0.0, -4.0));
    let parts = SceneParts {
        shapes: vec![mesh],
        media: vec![],
        textures: vec![],
        emitters: vec![],
        background: None,
        sensor: Sensor::perspective(to_world, 40.0, FovAxis::X, 8, 8),
        film,
        integrator: IntegratorSpec::default(),
    };
    Scene::assemble(parts).expect("a sound scene")
}

/// From a pinhole in front of the mesh, row by row; or between points of the ball around it.
fn rays(coherent: bool) -> Vec<Segment> {
    let edge = RAYS.isqrt();
    let mut rng = Stream::new(1, 0, 0);
    let mut somewhere = || {
        let radius = 1.3 * rng.uniform().cbrt();
        radius * warp::uniform_sphere(rng.uniform(), rng.uniform())
    };
    let ray = |n: usize| {
        let (from, to) = if coherent {
            let place = |k: usize| 2.4 * (k as f64 + 0.5) / edge as f64 - 1.2;
            (DVec3::new(0.0, 0.0, -4.0), DVec3::new(place(n % edge), place(n / edge), 0.0))
        } else {
            (somewhere(), somewhere())
        };
        let length = (to - from).length();
        Segment { from, direction: (to - from) / length, length }
    };
    (0..RAYS).map(ray).collect()
}
