//! Which medium is where, and flights through it.

use glam::{DAffine3, DQuat, DVec3};
use tpb_optics::{Coefficients, Phase, Rgb};
use tpb_scene::geometry::{Outline, Planar, Sphere};
use tpb_scene::{
    AssembleError, Bsdf, Dielectric, EmitterKind, EmitterPart, FilmSpec, FovAxis, IntegratorSpec,
    Medium, MediumBoundary, MediumId, PixelFormat, Primitive, Reflector, Region, Scene, SceneParts,
    Sensor, ShapePart, Vertex,
};

const FOG: MediumId = MediumId(0);
const WATER: MediumId = MediumId(1);

fn medium(name: &str, sigma: f64) -> Medium {
    let coefficients =
        Coefficients { sigma_s: Rgb::splat(0.5 * sigma), sigma_t: Rgb::splat(sigma) };
    Medium { name: name.into(), coefficients, phase: Phase::Isotropic, eta: None }
}

fn sphere(name: &str, centre: DVec3, radius: f64, bsdf: Bsdf) -> ShapePart {
    let primitives = vec![Primitive::Sphere(Sphere { centre, radius, flipped: false })];
    ShapePart { name: name.into(), primitives, bsdf, boundary: None, radiance: None }
}

fn inside(mut part: ShapePart, interior: MediumId, exterior: Option<MediumId>) -> ShapePart {
    part.boundary = Some(MediumBoundary { interior: Some(interior), exterior });
    part
}

fn glass(interior_eta: f64, exterior_eta: f64) -> Bsdf {
    Bsdf::Dielectric(Dielectric {
        interior_eta,
        exterior_eta,
        reflectance: Rgb::ONE,
        transmittance: Rgb::ONE,
    })
}

const WALL: Bsdf = Bsdf::Opaque { front: Reflector::Black, back: Reflector::Black };

/// The camera at `eye`, a lamp at `lamp`, and these shapes.
fn assemble(eye: DVec3, lamp: DVec3, shapes: Vec<ShapePart>) -> Result<Scene, AssembleError> {
    let kind = EmitterKind::Point { position: lamp, intensity: Rgb::ONE };
    Scene::assemble(SceneParts {
        shapes,
        media: vec![medium("fog", 0.5), medium("water", 0.25)],
        textures: vec![],
        emitters: vec![EmitterPart { name: "lamp".into(), kind, stated_medium: None }],
        background: None,
        sensor: Sensor::perspective(DAffine3::from_translation(eye), 40.0, FovAxis::X, 4, 4),
        film: FilmSpec { width: 4, height: 4, pixel_format: PixelFormat::Luminance, time: None },
        integrator: IntegratorSpec::default(),
    })
}

fn region(medium: Option<MediumId>, eta: f64) -> Region {
    Region { medium, eta }
}

#[test]
fn camera_and_lamp_find_their_medium_through_nested_boundaries() {
    // Fog in a null ball; in it a bowl of glass (no medium of its own named) with water inside.
    let shapes = vec![
        inside(sphere("fog ball", DVec3::ZERO, 4.0, Bsdf::Null), FOG, None),
        inside(sphere("water", DVec3::ZERO, 1.0, glass(1.33, 1.0)), WATER, Some(FOG)),
        sphere("stone", DVec3::new(0.0, 2.0, 0.0), 0.5, WALL),
    ];
    let at = |eye, lamp| {
        let scene = assemble(eye, lamp, shapes.clone()).unwrap();
        (scene.sensor.region, scene.emitters[0].region)
    };
    let (outside, within) = (DVec3::new(0.0, 0.0, 9.0), DVec3::new(0.1, 0.2, 2.5));
    assert_eq!(at(outside, within), (Region::VACUUM, region(Some(FOG), 1.0)));
    let wet = DVec3::new(0.3, 0.1, -0.2);
    assert_eq!(at(wet, outside), (region(Some(WATER), 1.33), Region::VACUUM));
}

#[test]
fn a_glass_ball_without_media_is_a_region_of_its_index() {
    let ball = sphere("ball", DVec3::ZERO, 1.0, glass(1.5, 1.0));
    let scene = assemble(DVec3::new(0.0, 0.0, 3.0), DVec3::new(0.2, 0.0, 0.0), vec![ball]).unwrap();
    assert_eq!(scene.emitters[0].region, region(None, 1.5));
    assert_eq!(scene.sensor.region, Region::VACUUM);
}

#[test]
fn a_surface_that_names_no_media_may_reach_through_several() {
    let fog_ball = inside(sphere("fog ball", DVec3::ZERO, 2.0, Bsdf::Null), FOG, None);
    let screen = ShapePart {
        primitives: vec![Primitive::Planar(Planar::new(
            DVec3::new(0.0, 0.0, 0.5),
            3.0 * DVec3::X,
            3.0 * DVec3::Y,
            Outline::Parallelogram,
        ))],
        ..sphere("screen", DVec3::ZERO, 1.0, Bsdf::Null)
    };
    let eye = DVec3::new(0.0, 0.0, 9.0);
    assert!(assemble(eye, eye, vec![fog_ball, screen]).is_ok());
}

#[test]
fn contradictions_are_refused() {
    let eye = DVec3::new(0.0, 0.0, 9.0);
    let fog_ball = inside(sphere("fog ball", DVec3::ZERO, 4.0, Bsdf::Null), FOG, None);
    // The inner ball puts water where the outer one puts fog.
    let wrong = inside(sphere("inner", DVec3::ZERO, 1.0, Bsdf::Null), FOG, Some(WATER));
    let Err(error) = assemble(eye, eye, vec![fog_ball.clone(), wrong]) else {
        panic!("water and fog in one place")
    };
    assert!(matches!(error, AssembleError::Disagreement { .. }), "{error}");
    // One medium, two indices.
    let a = inside(sphere("a", DVec3::X * 6.0, 1.0, glass(1.33, 1.0)), WATER, None);
    let b = inside(sphere("b", DVec3::X * -6.0, 1.0, glass(1.4, 1.0)), WATER, None);
    let Err(error) = assemble(eye, eye, vec![a.clone(), b]) else { panic!("two indices") };
    assert!(matches!(error, AssembleError::MediumIndex { .. }), "{error}");
    // A null boundary between water (1.33 by the glass) and fog (1).
    let c = inside(sphere("c", DVec3::X * -6.0, 1.0, Bsdf::Null), WATER, Some(FOG));
    let around = inside(sphere("around", DVec3::X * -6.0, 2.0, Bsdf::Null), FOG, None);
    let Err(error) = assemble(eye, eye, vec![a, c, around]) else { panic!("null bends light") };
    assert!(matches!(error, AssembleError::NullBetweenUnequalIndices { .. }), "{error}");
}

#[test]
fn a_place_on_a_boundary_has_no_region() {
    let fog_ball = || inside(sphere("fog ball", DVec3::ZERO, 2.0, Bsdf::Null), FOG, None);
    let on = DVec3::new(0.0, 0.0, 2.0);
    for (eye, lamp) in [(on, DVec3::ZERO), (DVec3::ZERO, on)] {
        let Err(error) = assemble(eye, lamp, vec![fog_ball()]) else { panic!("on the boundary") };
        assert!(matches!(error, AssembleError::OnBoundary { .. }), "{error}");
    }
    let beside = on * (1.0 + 1e-6);
    let scene = assemble(beside, beside / 1.000_002, vec![fog_ball()]).unwrap();
    assert_eq!(scene.sensor.region, Region::VACUUM);
    assert_eq!(scene.emitters[0].region.medium, Some(FOG));
}

#[test]
fn a_boundary_in_the_same_place_as_a_wall_is_refused() {
    let plate = |name: &str, bsdf, z: f64| ShapePart {
        primitives: vec![Primitive::Planar(Planar::new(
            DVec3::new(0.0, 0.0, z),
            DVec3::X,
            DVec3::Y,
            Outline::Parallelogram,
        ))],
        ..sphere(name, DVec3::ZERO, 1.0, bsdf)
    };
    let eye = DVec3::new(0.0, 0.0, 9.0);
    let fog = |z| inside(plate("fog", Bsdf::Null, z), FOG, None);
    let Err(error) = assemble(eye, eye, vec![fog(1.0), plate("wall", WALL, 1.0)]) else {
        panic!("which is first?")
    };
    assert!(matches!(error, AssembleError::Coincident { .. }), "{error}");
    assert!(assemble(eye, eye, vec![fog(1.0), plate("wall", WALL, 0.999)]).is_ok());
    // Two balls of the same surface.
    let ball = |name: &str, bsdf| sphere(name, DVec3::ZERO, 2.0, bsdf);
    let Err(error) = assemble(eye, eye, vec![ball("a", glass(1.5, 1.0)), ball("b", WALL)]) else {
        panic!("which is first?")
    };
    assert!(matches!(error, AssembleError::Coincident { .. }), "{error}");
}

/// A plate with its normal along ±z, turned about an axis of no symmetry.
fn turned(name: &str, front: Reflector, z: f64, up: f64) -> ShapePart {
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7);
    let (centre, u, v) = (DVec3::new(0.1, 0.2, z), DVec3::X, up * DVec3::Y);
    let plate = Planar::new(turn * centre, turn * u, turn * v, Outline::Parallelogram);
    let bsdf = Bsdf::Opaque { front, back: Reflector::Black };
    let primitives = vec![Primitive::Planar(plate)];
    ShapePart { name: name.into(), primitives, bsdf, boundary: None, radiance: None }
}

/// Regression: half of a lamp's light was lost where it lay in the plane of a wall.
#[test]
fn opaque_surfaces_in_the_same_place_are_refused_where_light_tells_them_apart() {
    let eye = DVec3::new(0.0, 0.0, 9.0);
    let white = Reflector::Diffuse(Rgb::splat(0.5));
    let wall = || turned("wall", white, 1.0, 1.0);
    let lamp =
        |z| ShapePart { radiance: Some(Rgb::ONE), ..turned("lamp", Reflector::Black, z, 1.0) };
    let Err(error) = assemble(eye, eye, vec![wall(), lamp(1.0)]) else { panic!("one plane") };
    assert!(matches!(error, AssembleError::Coincident { .. }), "{error}");
    assert!(assemble(eye, eye, vec![wall(), lamp(1.0 + 1e-6)]).is_ok());
    // Back to back in free space.
    let back = turned("back", white, 1.0, -1.0);
    let Err(error) = assemble(eye, eye, vec![wall(), back.clone()]) else { panic!("two backs") };
    assert!(matches!(error, AssembleError::Coincident { .. }), "{error}");
    // Nothing sees the underside of a solid that stands on a floor, and so on nothing else.
    let lid = turned("lid", white, 1.0 + 1e-3, 1.0);
    let underside = turned("underside", white, 1.0, -1.0);
    assert!(assemble(eye, eye, vec![wall(), underside, lid]).is_ok());
}

/// Regression: rounding decided which part of the light of a point on a wall was lost.
#[test]
fn a_place_on_an_opaque_surface_is_on_neither_side_of_it() {
    let (away, white) = (DVec3::new(0.0, 0.0, 9.0), Reflector::Diffuse(Rgb::splat(0.5)));
    let wall = turned("wall", white, 1.0, 1.0);
    let Primitive::Planar(plate) = &wall.primitives[0] else { panic!("a plate") };
    let on = plate.parallelogram().map_or(away, |corners| 0.3 * corners[0] + 0.7 * corners[2]);
    for (eye, lamp) in [(on, away), (away, on)] {
        let Err(error) = assemble(eye, lamp, vec![wall.clone()]) else { panic!("on the wall") };
        assert!(matches!(error, AssembleError::OnSurface { .. }), "{error}");
        let above = 1e-6 * plate.normal;
        assert!(assemble(eye + above, lamp + above, vec![wall.clone()]).is_ok());
    }
}

#[test]
fn a_flight_keeps_every_span_and_its_optical_length() {
    let fog_ball = inside(sphere("fog ball", DVec3::ZERO, 2.0, Bsdf::Null), FOG, None);
    let wall = ShapePart {
        primitives: vec![Primitive::Planar(Planar::new(
            DVec3::new(0.0, 0.0, 5.0),
            DVec3::X,
            DVec3::Y,
            Outline::Parallelogram,
        ))],
        ..sphere("wall", DVec3::ZERO, 1.0, WALL)
    };
    let start = DVec3::new(0.0, 0.0, -3.0);
    let scene = assemble(start, start, vec![fog_ball, wall]).unwrap();
    let flight = scene.fly(&scene.eye(), DVec3::Z);
    let spans: Vec<_> = flight.spans.iter().map(|s| (s.start, s.end, s.region.medium)).collect();
    assert_eq!(spans, [(0.0, 1.0, None), (1.0, 5.0, Some(FOG)), (5.0, 8.0, None)]);
    assert!((flight.opl(8.0) - 8.0).abs() < 1e-15);
    assert!((flight.depth::<1>(&scene, 3.0)[0] - 1.0).abs() < 1e-15, "2 m at 0.5 per metre");
    assert!((flight.depth::<1>(&scene, 8.0)[0] - 2.0).abs() < 1e-15);
    assert!(flight.hit.is_some());
    // A connection ends before the wall, sees the wall in its way, and may end on the wall.
    let eye = scene.eye();
    assert!(scene.connect::<1>(&eye, DVec3::Z, 7.9, None).is_some());
    assert!(scene.connect::<1>(&eye, DVec3::Z, 8.1, None).is_none());
    let hit = flight.hit.unwrap();
    assert!(scene.connect::<1>(&eye, DVec3::Z, 8.0, Some(hit.primitive)).is_some());
    // From the fog's own boundary inwards: the far side of the ball is met, the near one not.
    let on_ball = Vertex {
        position: DVec3::new(0.0, 0.0, -2.0),
        primitive: Some(0),
        region: region(Some(FOG), 1.0),
    };
    let inner = scene.fly(&on_ball, DVec3::Z);
    assert!((inner.spans[0].end - 4.0).abs() < 1e-15);
}

#[test]
fn photons_carry_the_power_of_their_emitters() {
    // Mean over 2e5 photons of a spot whose sampling is not proportional to its profile. The
    // relative deviation of one weight is below 0.7, that of the mean below 0.0016: 1 % is more
    // than 6 sigma, a false alarm below 2e-9 (seed fixed).
    let (cos_cutoff, cos_beam) = (0.7_f64.cos(), 0.2_f64.cos());
    let spot = EmitterKind::Spot {
        position: DVec3::ZERO,
        axis: DVec3::Z,
        intensity: Rgb::splat(2.0),
        cos_cutoff,
        cos_beam,
    };
    let expected = spot.power()[0];
    let mut scene = assemble(DVec3::ZERO, DVec3::ZERO, vec![]).unwrap();
    scene.emitters[0].kind = spot;
    let mut rng = tpb_optics::Stream::new(1, 0, 0);
    let n = 200_000;
    let sum: f64 = (0..n).map(|_| scene.emit::<1>(&mut rng).unwrap().power[0]).sum();
    assert!(
        (sum / f64::from(n) / expected - 1.0).abs() < 0.01,
        "{} {expected}",
        sum / f64::from(n)
    );
}
