//! Both gathers of beams, by bundles of rays and drawn over the image, against brute force over all beams: the same set of pairs,
//! each once.

use glam::DVec3;
use tpb_beams::Temporal;
use tpb_beams::beam::{Attenuation, Beam, CameraRay};
use tpb_beams::beam_map::BeamMap;
use tpb_beams::kernel::RayBeamKernel;
use tpb_beams::kernel1d::Kernel1d;
use tpb_beams::kernel2d::Kernel2d;
use tpb_beams::kernel3d::Kernel3d;
use tpb_beams::scan::Lattice;
use tpb_beams::sight::Sights;
use tpb_beams::splat::{Splat, TileRays};
use tpb_film::Grain;
use tpb_optics::{Coefficients, Phase, Spectrum, Stream, warp};
use tpb_render::{FilmSetup, RenderOptions};
use tpb_scene::{Flight, MediumId, Region, Scene, Span, Transport};

use crate::scenes;

fn direction(rng: &mut Stream) -> DVec3 {
    // Some along axes, where boxes are thin and inverse directions infinite.
    match rng.index(8) {
        0 => DVec3::AXES[rng.index(3)],
        1 => -DVec3::AXES[rng.index(3)],
        _ => warp::uniform_sphere(rng.uniform(), rng.uniform()),
    }
}

fn position(scale: f64, rng: &mut Stream) -> DVec3 {
    scale * DVec3::new(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5)
}

fn beams(scale: f64, count: u32, rng: &mut Stream) -> Vec<Beam<1>> {
    (0..count)
        .map(|index| Beam {
            origin: position(scale, rng),
            direction: direction(rng),
            // A few are as long as in fog without walls.
            length: if index % 50 == 0 { 700.0 * scale } else { scale * rng.uniform() },
            opl: f64::from(index),
            power: Spectrum([1.0]),
            attenuation: Attenuation::Explicit,
            medium: MediumId(index % 2),
            depth: 2,
        })
        .collect()
}

fn rays(scale: f64, count: u32, rng: &mut Stream) -> Vec<CameraRay<1>> {
    (0..count)
        .map(|index| {
            let far = if index % 5 == 0 { 100.0 } else { 1.0 };
            let length = if index % 3 == 0 { f64::INFINITY } else { scale * far };
            let origin = position(scale * far, rng);
            let aim = position(scale, rng);
            let direction =
                if index % 2 == 0 { (aim - origin).normalize() } else { direction(rng) };
            CameraRay {
                origin,
                direction,
                length,
                opl: 0.0,
                throughput: Spectrum([1.0]),
                coefficients: Coefficients {
                    sigma_s: Spectrum([1.0]),
                    sigma_t: Spectrum([0.1 / scale]),
                },
                phase: Phase::Isotropic,
                eta: 1.0,
            }
        })
        .collect()
}

fn joins<K: RayBeamKernel>(kernel: K, beam: &Beam<1>, ray: &CameraRay<1>) -> bool {
    let of_beam = (beam.origin, beam.direction, beam.length);
    let of_ray = (ray.origin, ray.direction, ray.length);
    kernel.meet(of_beam.0, of_beam.1, of_beam.2, of_ray.0, of_ray.1, of_ray.2).is_some()
}

fn check<K: RayBeamKernel>(kernel: K, scale: f64, seed: u64) -> usize {
    let mut rng = Stream::new(seed, 0, 0);
    let beams = beams(scale, 600, &mut rng);
    let rays = rays(scale, 400, &mut rng);
    let map = BeamMap::new(kernel, &beams);
    let mut pairs = 0;
    let rays: Vec<_> = rays.into_iter().map(|ray| (MediumId(1), ray)).collect();
    // Numbers of rays that do and do not fill bundles.
    let mut rest = &rays[..];
    while !rest.is_empty() {
        let query;
        (query, rest) = rest.split_at(rest.len().min(1 + rng.index(180)));
        let mut found = vec![vec![]; query.len()];
        let count = map.query(kernel, query, |lane, beam, _| found[lane].push(beam.opl as usize));
        assert_eq!(count.accepted as usize, found.iter().map(Vec::len).sum::<usize>());
        for (found, (_, ray)) in found.iter_mut().zip(query) {
            found.sort_unstable();
            let all = beams.iter().enumerate();
            let brute: Vec<usize> = all
                .filter(|(_, b)| b.medium == MediumId(1) && joins(kernel, b, ray))
                .map(|(index, _)| index)
                .collect();
            assert_eq!(*found, brute, "scale {scale}");
            pairs += found.len();
        }
    }
    pairs
}

#[test]
fn bundles_find_exactly_the_pairs_of_brute_force() {
    for (seed, scale) in [1e-3, 1.0, 1e3].into_iter().enumerate() {
        for relative in [0.002, 0.05] {
            let radius = relative * scale;
            let one = check(Kernel1d { radius }, scale, seed as u64);
            let two = check(Kernel2d { radius }, scale, seed as u64);
            let three = check(Kernel3d { radius }, scale, seed as u64);
            assert!(one > 50 && two >= one, "pairs to compare: {one}, {two}");
            assert!(three >= two && (three > two || relative < 0.01), "{two}, {three}");
        }
    }
}

/// In thin fog without walls beams and rays are far longer than the scene.
#[test]
fn lines_of_a_thousand_kilometres_are_told_apart() {
    let mut rng = Stream::new(5, 0, 0);
    let mut beams = beams(1.0, 600, &mut rng);
    for beam in &mut beams {
        (beam.length, beam.medium) = (1e9, MediumId(1));
    }
    beams[300].origin *= 1e8;
    let mut rays = rays(1.0, 400, &mut rng);
    for ray in &mut rays {
        ray.length = 1e9;
    }
    let kernel = Kernel1d { radius: 0.02 };
    let expected: usize =
        rays.iter().map(|ray| beams.iter().filter(|b| joins(kernel, b, ray)).count()).sum();
    let map = BeamMap::new(kernel, &beams);
    let rays: Vec<_> = rays.into_iter().map(|ray| (MediumId(1), ray)).collect();
    let pairs = map.query(kernel, &rays, |_, _, _| ());
    assert_eq!(pairs.accepted as usize, expected);
    // Lines are told apart; rays and beams are half of theirs.
    assert!(expected > 500 && pairs.tested < 6 * pairs.accepted, "{pairs:?}");
}

/// Flights from an eye amid the beams, over the whole image: through one medium from the eye, from
/// farther on, through two media, through none.
fn flights(scene: &Scene, lattice: &Lattice, scale: f64, rng: &mut Stream) -> Vec<Flight> {
    let region = |medium: Option<u32>| Region { medium: medium.map(MediumId), eta: 1.0 };
    let span = |start, end, medium| Span { start, end, region: region(medium) };
    let flight = |(index, direction): (usize, DVec3)| {
        let (a, b) = (0.3 * scale * rng.uniform(), 0.3 * scale + scale * rng.uniform());
        let spans = match index % 5 {
            0 => vec![span(0.0, f64::INFINITY, Some(1))],
            1 => vec![span(0.0, a, None), span(a, b, Some(1))],
            2 => vec![span(0.0, a, Some(1)), span(a, b, Some(0))],
            3 => vec![
                span(0.0, a, Some(1)),
                span(a, 0.3 * scale, None),
                span(0.3 * scale, b, Some(1)),
            ],
            _ => vec![span(0.0, b, Some(0))],
        };
        let origin = scene.sensor.position;
        Flight { origin, direction, spans: spans.into(), hit: None }
    };
    lattice.directions().enumerate().map(flight).collect()
}

/// Every beam has a bin of its own, so that pixel and bin tell the pair.
fn check_splat<K: RayBeamKernel>(
    kernel: K,
    relative: f64,
    scale: f64,
    fov: f64,
    seed: u64,
) -> usize {
    let mut rng = Stream::new(seed, 1, 0);
    let mut beams = beams(scale, 400, &mut rng);
    let bin = 1e4 * scale;
    for (index, beam) in beams.iter_mut().enumerate() {
        beam.opl = (index as f64 + 0.25) * bin;
    }
    // Also an image of several bands of rows.
    let (width, height) = if scale == 1.0 { (6, 140) } else { (37, 22) };
    let eye = position(0.5 * scale, &mut rng);
    let sensor = scenes::camera(eye, direction(&mut rng), fov, (width, height));
    let light = scenes::point(DVec3::ZERO, tpb_optics::Rgb::ONE);
    let film = scenes::film(width, height, bin, beams.len());
    let thin = scenes::fog(1.0, 1e-4 / scale, 0.0);
    let mut parts = scenes::infinite(thin, light, sensor, film);
    parts.media.push(scenes::fog(0.5, 2e-4 / scale, 0.6));
    let scene = Scene::assemble(parts).expect("the scene is consistent");
    let layout = FilmSetup::new(&scene.film, Transport::Mono, &RenderOptions::default()).unwrap();
    let mut film = layout.film::<1>().unwrap();
    let edge = film.tile_edge(Grain::Coarse);
    assert!(edge > 4 && edge < 22, "several tiles of several pixels: {edge}");
    let sights = Sights::new(&scene.sensor, &beams, (kernel.radius(), None), (height, edge));
    let (offset, draw) = ([rng.uniform(), rng.uniform()], Stream::new(seed, 2, 0));
    let tiles = film.add_pass_by(Grain::Coarse, |tile| {
        let lattice = Lattice::new(&scene.sensor, tile, offset);
        let flights = flights(&scene, &lattice, scale, &mut draw.clone());
        let rays = TileRays::new(&scene, lattice, &flights);
        let splat = Splat {
            kernel,
            beams: &beams,
            sights: &sights,
            rays: &rays,
            temporal: Temporal::Exact,
            share: 1.0,
            instructions: tpb_lanes::Instructions::widest(),
        };
        let pairs = splat.draw(|_| true, tile);
        (tile.pixels().collect::<Vec<_>>(), flights, pairs)
    });
    let arrays = film.develop();
    let (mut joined, mut tested) = (0, 0);
    for (pixels, flights, pairs) in tiles {
        let before = joined;
        for (pixel, flight) in pixels.into_iter().zip(flights) {
            let spans = flight.spans.iter();
            let rays: Vec<_> =
                spans.filter_map(|span| CameraRay::<1>::of_span(&scene, &flight, span)).collect();
            for (beam, &found) in beams.iter().zip(arrays.pixel(pixel)) {
                let rays = rays.iter().filter(|(medium, _)| *medium == beam.medium);
                let met: Vec<_> = rays.filter_map(|(_, ray)| kernel.evaluate(beam, ray)).collect();
                let expected: f64 = met.iter().map(|met| met.energy[0]).sum();
                let error = (f64::from(found) - expected).abs();
                assert!(error <= 1e-6 * expected, "{found} {expected}, scale {scale}, fov {fov}");
                joined += met.len();
            }
        }
        assert_eq!(pairs.accepted as usize, joined - before);
        tested += pairs.tested;
    }
    assert!(relative > 0.01 || tested as usize <= 8 * joined + 1000, "{tested} for {joined}");
    joined
}

#[test]
fn drawn_beams_meet_exactly_the_rays_of_brute_force() {
    let mut joined = [0; 3];
    for (seed, scale) in [1e-3, 1.0, 1e3].into_iter().enumerate() {
        for fov in [0.01, 40.0, 170.0] {
            for relative in [0.002, 0.05, 2.0] {
                let (radius, seed) = (relative * scale, seed as u64);
                let one = check_splat(Kernel1d { radius }, relative, scale, fov, seed);
                let two = check_splat(Kernel2d { radius }, relative, scale, fov, seed);
                let three = check_splat(Kernel3d { radius }, relative, scale, fov, seed);
                assert!(one > 0 || fov < 1.0, "pairs to compare");
                joined.iter_mut().zip([one, two, three]).for_each(|(sum, count)| *sum += count);
            }
        }
    }
    assert!(joined[0] > 10_000 && joined.is_sorted_by(|a, b| a < b), "{joined:?}");
}
