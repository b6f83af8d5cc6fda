//! Regions and times behind rough glass, and the symmetry that shading normals must keep.

use glam::{DAffine3, DVec2, DVec3};
use tpb_optics::Spectrum;
use tpb_optics::microfacet::{Ggx, Metal, RoughConductor};
use tpb_scene::geometry::{Outline, Planar, Sphere, VertexData};
use tpb_scene::{
    Dielectric, EmitterKind, EmitterPart, FilmSpec, FovAxis, IntegratorSpec, PixelFormat,
    Primitive, RoughMetal, SceneParts, Sensor, ShapePart, Vertex,
};

use super::*;
use crate::{FreeFlight, Outcome, Photon, PhotonBatch, PhotonTracer, PhotonVisitor, Sampling};

const GLASS: Dielectric = Dielectric {
    interior_eta: 1.5,
    exterior_eta: 1.0,
    reflectance: Rgb::ONE,
    transmittance: Rgb::ONE,
};

fn scene(lamp: DVec3, shapes: Vec<(Primitive, Bsdf)>) -> Scene {
    let part = |(primitive, bsdf)| ShapePart {
        name: "shape".into(),
        primitives: vec![primitive],
        bsdf,
        boundary: None,
        radiance: None,
    };
    let kind = EmitterKind::Point { position: lamp, intensity: Rgb::ONE };
    let to_world = DAffine3::from_translation(DVec3::new(0.1, 0.2, 1.7));
    Scene::assemble(SceneParts {
        shapes: shapes.into_iter().map(part).collect(),
        media: vec![],
        textures: vec![],
        emitters: vec![EmitterPart { name: "point".into(), kind, stated_medium: None }],
        background: None,
        sensor: Sensor::perspective(to_world, 40.0, FovAxis::X, 1, 1),
        film: FilmSpec { width: 1, height: 1, pixel_format: PixelFormat::Rgb, time: None },
        integrator: IntegratorSpec::default(),
    })
    .expect("a consistent scene")
}

/// What a photon's flights must look like around a ball of rough glass of radius 1.
#[derive(Default)]
struct Watch {
    last: f64,
    inside: u32,
    outside: u32,
}

impl PhotonVisitor<1> for Watch {
    fn emission(&mut self, _: &Photon<1>, _: &mut Stream) {
        self.last = 0.0;
    }

    fn flight(
        &mut self,
        photon: &Photon<1>,
        free: &FreeFlight<'_, 1>,
        _: &Outcome<'_, 1>,
        _: &mut Stream,
    ) {
        let flight = free.flight();
        let inside = photon.events == 0 || flight.direction.dot(flight.origin) < 0.0;
        let eta = if inside { 1.5 } else { 1.0 };
        assert_eq!(photon.vertex.region.eta, eta);
        assert!((photon.opl - self.last).abs() < 1e-12);
        *(if inside { &mut self.inside } else { &mut self.outside }) += 1;
        if let Some(hit) = &flight.hit {
            self.last = photon.opl + eta * hit.distance;
        }
    }
}

#[test]
fn light_behind_rough_glass_is_in_the_right_region_at_the_right_time() {
    let ball = Primitive::Sphere(Sphere { centre: DVec3::ZERO, radius: 1.0, flipped: false });
    for alpha in [0.02, 0.3, 1.0] {
        let scene = scene(
            DVec3::new(0.2, 0.1, 0.3),
            vec![(ball.clone(), Bsdf::RoughDielectric(GLASS, Ggx::new(alpha)))],
        );
        let integrator = IntegratorSpec { max_depth: Some(20), ..IntegratorSpec::default() };
        let batch = PhotonBatch { seed: 5, pass: 0, count: 4000 };
        let tracer = PhotonTracer { scene: &scene, integrator, sampling: Sampling::default() };
        let (seen, ledger) = tracer.trace::<1, _>(batch, |_| Watch::default());
        assert!(ledger.closure().abs() < 1e-9, "{ledger:?}");
        assert!(ledger.escaped > 0.25 * ledger.emitted && ledger.absorbed_on_surfaces > 0.0);
        assert!(seen.iter().all(|watch| watch.inside > watch.outside && watch.outside > 100));
    }
}

/// A triangle in the plane z = 0 whose corners' normals lean to all sides.
fn bent(bsdf: Bsdf) -> Scene {
    let normals = [(0.5, 0.1), (-0.3, 0.4), (-0.1, -0.6)]
        .map(|(x, y): (f64, f64)| DVec3::new(x, y, 1.0).normalize());
    let data = VertexData { normals: Some(normals), uv: Some([DVec2::ZERO; 3]) };
    let plane =
        Planar::new(DVec3::new(-1.0, -1.0, 0.0), 4.0 * DVec3::X, 4.0 * DVec3::Y, Outline::Triangle);
    scene(DVec3::new(0.0, 0.0, 1.2), vec![(Primitive::Planar(plane.with_vertices(data)), bsdf)])
}

/// Unit directions over the sphere.
fn directions() -> impl Iterator<Item = DVec3> {
    let golden = 0.5 * (5_f64.sqrt() - 1.0);
    (0..200).map(move |i| {
        let (z, phi) = (1.0 - (f64::from(i) + 0.5) / 100.0, f64::from(i) * golden);
        let sine = (1.0 - z * z).sqrt();
        let azimuth = 2.0 * std::f64::consts::PI * phi;
        DVec3::new(sine * azimuth.cos(), sine * azimuth.sin(), z)
    })
}

/// What goes to a direction, reflectance included.
fn value(lobe: &impl Lobe<1>, direction: DVec3) -> f64 {
    (lobe.factor() * lobe.towards(direction).value)[0]
}

/// A drawn direction and its region; its weight is what its value says.
fn drawn(lobe: &impl Lobe<1>, rng: &mut Stream) -> Option<(DVec3, Region)> {
    let drawn = lobe.sample(rng)?;
    let towards = lobe.towards(drawn.direction);
    let Spectrum([value]) = towards.value;
    let stated = drawn.weight[0] * drawn.density;
    assert!((value - stated).abs() <= 1e-6 * value, "{value} {stated}");
    Some((drawn.direction, drawn.region))
}

/// A carrier that comes from the direction `from` meets the point (x, y, 0).
fn lobe(scene: &Scene, from: DVec3, carrier: Carrier, direction: DVec3) -> f64 {
    let position = DVec3::new(-0.4, 0.1, 0.0) + from;
    let vertex = Vertex { position, primitive: None, region: tpb_scene::Region::VACUUM };
    let flight = scene.fly(&vertex, -from);
    let hit = flight.hit.expect("the triangle is met");
    let encounter = Encounter::new(scene, &flight, &hit, carrier);
    match encounter.respond(&mut Stream::new(1, 2, 3)) {
        Response::Diffuse(lobe) => value(&lobe, direction),
        Response::Rough(lobe) => value(&lobe, direction),
        Response::Absorbed => 0.0,
        Response::Turned(_) => panic!("a lobe"),
    }
}

/// What a photon from a sends to b, over the true cosine at b, is what the camera's path from b
/// sees from a over that at a (and over η² where it crosses): both are the one BSDF.
#[test]
fn photons_and_camera_paths_see_the_same_bsdf_on_bent_surfaces() {
    let metal = RoughConductor { ggx: Ggx::new(0.4), metal: Metal::Perfect };
    let rough = Reflector::Rough(RoughMetal { surface: metal, reflectance: Rgb::splat(0.9) });
    let diffuse = Reflector::Diffuse(Rgb::splat(0.7));
    for bsdf in [
        Bsdf::Opaque { front: diffuse, back: diffuse },
        Bsdf::Opaque { front: rough, back: rough },
        Bsdf::RoughDielectric(GLASS, Ggx::new(0.5)),
    ] {
        let scene = bent(bsdf);
        let (mut lit, mut through) = (0, 0);
        for a in directions() {
            for b in directions() {
                let light = lobe(&scene, a, Carrier::Light, b) / b.z.abs();
                let camera = lobe(&scene, b, Carrier::Importance, a) / a.z.abs();
                let crosses = (a.z > 0.0) != (b.z > 0.0);
                let eta = |w: DVec3| if w.z > 0.0 { 1.0_f64 } else { 1.5 };
                // The camera's radiance has (η_b/η_a)² besides.
                let camera = if crosses { camera * (eta(b) / eta(a)).powi(2) } else { camera };
                assert!(light >= 0.0 && (light - camera).abs() <= 1e-6 * light, "{a} {b}");
                lit += u32::from(light > 0.0);
                through += u32::from(light > 0.0 && crosses);
            }
        }
        assert!(lit > 5000, "{lit}");
        assert_eq!(through > 0, matches!(bsdf, Bsdf::RoughDielectric(..)));
    }
}

/// Whatever is drawn is where it should be, and weighs what its value says.
#[test]
fn draws_on_bent_surfaces_do_not_leak() {
    let metal = RoughConductor { ggx: Ggx::new(0.4), metal: Metal::Perfect };
    let rough = Reflector::Rough(RoughMetal { surface: metal, reflectance: Rgb::ONE });
    let mirror = Reflector::Mirror(Rgb::ONE);
    let diffuse = Reflector::Diffuse(Rgb::splat(0.7));
    let mut rng = Stream::new(8, 0, 0);
    for bsdf in [
        Bsdf::Opaque { front: diffuse, back: diffuse },
        Bsdf::Opaque { front: rough, back: rough },
        Bsdf::Opaque { front: mirror, back: mirror },
        Bsdf::RoughDielectric(GLASS, Ggx::new(0.5)),
        Bsdf::Dielectric(GLASS),
    ] {
        let scene = bent(bsdf);
        for carrier in [Carrier::Light, Carrier::Importance] {
            for from in directions().chain(directions()) {
                let start = DVec3::new(-0.4, 0.1, 0.0) + from;
                let region = Region { medium: None, eta: if from.z > 0.0 { 1.0 } else { 1.5 } };
                let vertex = Vertex { position: start, primitive: None, region };
                let flight = scene.fly(&vertex, -from);
                let hit = flight.hit.expect("the triangle is met");
                let encounter = Encounter::new(&scene, &flight, &hit, carrier);
                let next = match encounter.respond(&mut rng) {
                    Response::Absorbed => None,
                    Response::Turned(turn) => Some((turn.direction, turn.region)),
                    Response::Diffuse(lobe) => drawn(&lobe, &mut rng),
                    Response::Rough(lobe) => drawn(&lobe, &mut rng),
                };
                let Some((direction, region)) = next else { continue };
                let crossed = (direction.z > 0.0) != (from.z > 0.0);
                assert!(!crossed || bsdf.interface().is_some());
                if bsdf.interface().is_some() {
                    assert_eq!(region.eta, if direction.z > 0.0 { 1.0 } else { 1.5 });
                }
            }
        }
    }
}
