//! Points drawn on primitives: uniform over the area, on the surface, with the right normal.
//!
//! Each primitive is seen in natural coordinates computed here from the world position: (a, b) of a
//! parallelogram, radius and azimuth of an ellipse, barycentric ones of a triangle, cosine and
//! azimuth of a sphere, height and azimuth of a cylinder.

use std::f64::consts::PI;

use glam::DVec3;
use tpb_optics::Stream;
use tpb_scene::Primitive;
use tpb_scene::geometry::{Cylinder, Outline, Planar, Sphere};

use super::Draws;
use super::histogram::{Grid, Tested, test};
use super::{axes, polar};

/// A primitive, where its points lie in natural coordinates, and their density there.
pub(super) struct Case {
    pub(super) name: &'static str,
    pub(super) primitive: Primitive,
    pub(super) grid: Grid,
    pub(super) natural: Box<dyn Fn(DVec3) -> [f64; 2] + Sync + Send>,
    pub(super) density: fn(f64, f64) -> f64,
    area: f64,
    /// Distance of a point from the surface.
    gap: Box<dyn Fn(DVec3) -> f64 + Sync + Send>,
}

pub(super) fn tests(samples: u64, seed: Draws) -> Vec<Tested> {
    let mut tests = Vec::new();
    for case in cases() {
        let Case { name, primitive, grid, natural, density, area, gap } = case;
        let draw = |rng: &mut Stream| {
            let (u1, u2) = (rng.uniform(), rng.uniform());
            primitive.sample(u1, u2)
        };
        tests.push(test(name, grid, samples, seed, |rng| natural(draw(rng).position), density));
        let mut rng = Stream::new(seed.seed, 1, 0);
        let sound = (0..10_000).all(|_| {
            let p = draw(&mut rng);
            gap(p.position).abs() < 1e-12
                && (p.normal - primitive.normal(p.position)).length() < 1e-9
        });
        let right_area = (primitive.area() / area - 1.0).abs() < 1e-12;
        tests.push(Tested::exact(
            format!("{name}: on the surface, normal, area"),
            sound && right_area,
        ));
    }
    tests
}

fn uniform(_: f64, _: f64) -> f64 {
    1.0
}

/// All kinds of primitives, askew in space.
pub(super) fn cases() -> Vec<Case> {
    let (o, u, v) = (DVec3::ONE, DVec3::new(1.0, 0.2, 0.0), DVec3::new(-0.1, 0.5, 0.4));
    let normal = u.cross(v).normalize();
    let plane = |outline| Primitive::Planar(Planar::new(o, u, v, outline));
    let coordinates = move |p: DVec3| {
        // Cramer's rule in the plane.
        let d = p - o;
        let whole = u.cross(v).dot(normal);
        [d.cross(v).dot(normal) / whole, u.cross(d).dot(normal) / whole]
    };
    let in_plane = move || Box::new(move |p: DVec3| (p - o).dot(normal));
    let (centre, radius) = (DVec3::new(-0.4, 0.3, 2.0), 0.7);
    let sphere = Primitive::Sphere(Sphere { centre, radius, flipped: true });
    let (p0, p1, r) = (DVec3::new(0.1, 0.0, -1.0), DVec3::new(0.3, 0.5, 1.0), 0.4);
    let (axis, length) = ((p1 - p0).normalize(), (p1 - p0).length());
    let cylinder = Primitive::Cylinder(Cylinder::new(p0, p1, r, false));
    let around = axes(axis);
    let area = u.cross(v).length();
    let band = Grid { x: [0.0, 1.0], y: [-PI, PI], cells: [21, 31] };
    vec![
        Case {
            name: "parallelogram",
            primitive: plane(Outline::Parallelogram),
            grid: Grid { x: [-1.0, 1.0], y: [-1.0, 1.0], cells: [21, 21] },
            natural: Box::new(coordinates),
            density: |_, _| 0.25,
            area: 4.0 * area,
            gap: in_plane(),
        },
        Case {
            name: "ellipse",
            primitive: plane(Outline::Ellipse),
            grid: band,
            natural: Box::new(move |p| {
                let [a, b] = coordinates(p);
                [a.hypot(b).min(1.0), b.atan2(a)]
            }),
            density: |r, _| r / PI,
            area: PI * area,
            gap: in_plane(),
        },
        Case {
            name: "triangle",
            primitive: plane(Outline::Triangle),
            grid: Grid::SQUARE,
            natural: Box::new(move |p| {
                let [a, b] = coordinates(p);
                [a.max(0.0), (b / (1.0 - a)).clamp(0.0, 1.0)]
            }),
            density: |a, _| 2.0 * (1.0 - a),
            area: 0.5 * area,
            gap: in_plane(),
        },
        Case {
            name: "sphere",
            primitive: sphere,
            grid: Grid::SPHERE,
            natural: Box::new(move |p| {
                polar((p - centre).normalize(), [DVec3::X, DVec3::Y, DVec3::Z])
            }),
            density: |_, _| 0.25 / PI,
            area: 4.0 * PI * radius * radius,
            gap: Box::new(move |p| (p - centre).length() - radius),
        },
        Case {
            name: "cylinder",
            primitive: cylinder,
            grid: band,
            natural: Box::new(move |p| {
                let d = p - p0;
                [d.dot(axis) / length, d.dot(around[1]).atan2(d.dot(around[0]))]
            }),
            density: |_, _| 0.5 / PI,
            area: 2.0 * PI * r * length,
            gap: Box::new(move |p| {
                let d = p - p0;
                (d - d.dot(axis) * axis).length() - r
            }),
        },
    ]
}

/// A rectangle of unit coordinates for two numbers that should be uniform.
pub(super) fn unit_square() -> (Grid, fn(f64, f64) -> f64) {
    (Grid::SQUARE, uniform)
}
