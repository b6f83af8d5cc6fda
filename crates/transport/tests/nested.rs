//! A liquid in a glass: three kinds of interfaces, none upon another.
//!
//! The cup is a box of glass (index 1.5), open at its top, with a liquid (1.33) in it. Where liquid
//! and glass touch, *one* interface stands between the two indices; it is not the glass's inner
//! surface with the liquid's own surface upon it. Photons from a lamp within the liquid must find
//! every region where geometry says that it is, and take as long as its index says.

use glam::{DAffine3, DVec3};
use tpb_optics::{Coefficients, Phase, Rgb, Stream};
use tpb_scene::geometry::{Outline, Planar};
use tpb_scene::{
    AssembleError, Bsdf, Dielectric, EmitterKind, EmitterPart, FilmSpec, FovAxis, IntegratorSpec,
    Medium, MediumBoundary, MediumId, PixelFormat, Primitive, Scene, SceneParts, Sensor, ShapePart,
};
use tpb_transport::{
    FreeFlight, Outcome, Photon, PhotonBatch, PhotonTracer, PhotonVisitor, Sampling,
};

const INNER: f64 = 1.0;
const OUTER: f64 = 1.2;
const BOTTOM: f64 = -0.2;
const LEVEL: f64 = 0.9;
const RIM: f64 = 2.0;

/// Index and medium of a region.
type Content = (f64, Option<MediumId>);

const AIR: Content = (1.0, None);
const GLASS: Content = (1.5, None);
const WET: Content = (1.33, Some(MediumId(0)));

/// An interface of parallelograms, each with its normal on the side of `exterior`.
fn interface(name: &str, faces: Vec<Primitive>, interior: Content, exterior: Content) -> ShapePart {
    let glass = Dielectric {
        interior_eta: interior.0,
        exterior_eta: exterior.0,
        reflectance: Rgb::ONE,
        transmittance: Rgb::ONE,
    };
    ShapePart {
        name: name.into(),
        primitives: faces,
        bsdf: Bsdf::Dielectric(glass),
        boundary: Some(MediumBoundary { interior: interior.1, exterior: exterior.1 }),
        radiance: None,
    }
}

/// A rectangle about `centre` with half edges u and v, its normal along u × v.
fn face(centre: DVec3, u: DVec3, v: DVec3) -> Primitive {
    Primitive::Planar(Planar::new(centre, u, v, Outline::Parallelogram))
}

/// Four walls at distance `half` from the axis, from z = `low` to `high`, with normals outwards or
/// inwards.
fn walls(half: f64, low: f64, high: f64, inwards: bool) -> Vec<Primitive> {
    let height = 0.5 * (high - low) * DVec3::Z;
    let wall = |out: DVec3| {
        let along = half * DVec3::Z.cross(out);
        let centre = half * out + 0.5 * (low + high) * DVec3::Z;
        if inwards { face(centre, height, along) } else { face(centre, along, height) }
    };
    [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y].map(wall).into()
}

/// A square across the axis at height z, its normal up (1) or down (−1).
fn square(z: f64, half: f64, up: f64) -> Primitive {
    face(z * DVec3::Z, half * DVec3::X, up * half * DVec3::Y)
}

/// Four rectangles that close the walls at the top.
fn rim() -> Vec<Primitive> {
    let (middle, half) = (0.5 * (INNER + OUTER), 0.5 * (OUTER - INNER));
    let strip = |x: f64| face(DVec3::new(x, 0.0, RIM), half * DVec3::X, OUTER * DVec3::Y);
    let cap = |y: f64| face(DVec3::new(0.0, y, RIM), INNER * DVec3::X, half * DVec3::Y);
    vec![strip(middle), strip(-middle), cap(middle), cap(-middle)]
}

fn assemble(shapes: Vec<ShapePart>) -> Result<Scene, AssembleError> {
    let sigma = Rgb::splat(0.01);
    let coefficients = Coefficients { sigma_s: sigma, sigma_t: sigma };
    let liquid = Medium { name: "liquid".into(), coefficients, phase: Phase::Isotropic, eta: None };
    let position = DVec3::new(0.3, -0.2, 0.4);
    let kind = EmitterKind::Point { position, intensity: Rgb::ONE };
    let to_world = DAffine3::from_translation(DVec3::new(0.0, 0.0, 5.0));
    Scene::assemble(SceneParts {
        shapes,
        media: vec![liquid],
        textures: vec![],
        emitters: vec![EmitterPart { name: "lamp".into(), kind, stated_medium: None }],
        background: None,
        sensor: Sensor::perspective(to_world, 40.0, FovAxis::X, 1, 1),
        film: FilmSpec { width: 1, height: 1, pixel_format: PixelFormat::Rgb, time: None },
        integrator: IntegratorSpec::default(),
    })
}

fn cup() -> Scene {
    let mut dry = walls(OUTER, BOTTOM, RIM, false);
    dry.push(square(BOTTOM, OUTER, -1.0));
    dry.extend(rim());
    dry.extend(walls(INNER, LEVEL, RIM, true));
    let mut wet = walls(INNER, 0.0, LEVEL, true);
    wet.push(square(0.0, INNER, 1.0));
    let shapes = vec![
        interface("air-glass", dry, GLASS, AIR),
        interface("glass-liquid", wet, GLASS, WET),
        interface("liquid-air", vec![square(LEVEL, INNER, 1.0)], WET, AIR),
    ];
    assemble(shapes).expect("the regions agree")
}

/// What is where, by geometry alone.
fn content(p: DVec3) -> Content {
    let across = p.x.abs().max(p.y.abs());
    if across < INNER && p.z > 0.0 {
        if p.z < LEVEL { WET } else { AIR }
    } else if across < OUTER && p.z > BOTTOM && p.z < RIM {
        GLASS
    } else {
        AIR
    }
}

#[derive(Default)]
struct Watch {
    /// In liquid, air, glass.
    flights: [u32; 3],
    next_opl: f64,
}

impl PhotonVisitor<1> for Watch {
    fn emission(&mut self, photon: &Photon<1>, _: &mut Stream) {
        self.next_opl = photon.opl;
    }

    fn flight(
        &mut self,
        photon: &Photon<1>,
        free: &FreeFlight<'_, 1>,
        outcome: &Outcome<'_, 1>,
        _: &mut Stream,
    ) {
        let flight = free.flight();
        let end = flight.hit.map(|hit| hit.distance);
        let (eta, medium) = content(flight.at(0.5 * end.unwrap_or(1.0)));
        let region = photon.vertex.region;
        assert_eq!((region.eta, region.medium), (eta, medium), "from {}", flight.origin);
        assert!((photon.opl - self.next_opl).abs() < 1e-12);
        let length = outcome.collision().or(end).unwrap_or(0.0);
        self.next_opl = photon.opl + eta * length;
        let kind = if medium.is_some() { 0 } else { 1 + usize::from(eta == GLASS.0) };
        self.flights[kind] += 1;
    }
}

#[test]
fn every_flight_in_a_glass_of_liquid_is_in_its_region_and_takes_its_time() {
    let scene = cup();
    let integrator = IntegratorSpec { max_depth: Some(60), ..IntegratorSpec::default() };
    let tracer = PhotonTracer { scene: &scene, integrator, sampling: Sampling::default() };
    let batch = PhotonBatch { seed: 4, pass: 0, count: 3000 };
    let (seen, ledger) = tracer.trace::<1, _>(batch, |_| Watch::default());
    assert!(ledger.closure().abs() < 1e-9, "{ledger:?}");
    for kind in 0..3 {
        let flights: u32 = seen.iter().map(|watch| watch.flights[kind]).sum();
        assert!(flights > 1000, "{kind}: {flights}");
    }
}

/// Two surfaces where there should be one: which is met first?
#[test]
fn a_liquid_with_a_surface_of_its_own_upon_the_glass_is_refused() {
    let glass = interface("glass", vec![square(0.0, 1.0, 1.0)], GLASS, AIR);
    let liquid = interface("liquid", vec![square(0.0, 1.0, -1.0)], (1.33, None), AIR);
    let Err(error) = assemble(vec![glass, liquid]) else { panic!("they coincide") };
    assert!(error.to_string().contains("lies in the same place as"), "{error}");
}
