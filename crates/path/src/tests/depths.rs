//! Depth limits isolate scattering orders, and the ledger says where the rest went.

use glam::DVec3;
use tpb_optics::Rgb;
use tpb_render::{Method, PassId};
use tpb_scene::Scene;

use super::cornell;
use super::stats::{estimate, film, image_and_blocks, pass};
use super::worlds::{FOG, ONE_RAY, camera, depths, lamp, medium, plate, tracer};

#[test]
fn depths_add_up() {
    let scene = cornell::blocks(4, 8);
    let whole = estimate(&tracer::<1>(&scene, depths(1, 5), 300), 51, 16, image_and_blocks(4));
    let mut sum = vec![0.0; whole.means.len()];
    let mut squares = vec![0.0; whole.means.len()];
    for depth in 1..=5 {
        let only = depths(depth, depth);
        let part =
            estimate(&tracer::<1>(&scene, only, 300), 51 + depth as u64, 16, image_and_blocks(4));
        for i in 0..sum.len() {
            sum[i] += part.means[i];
            squares[i] += part.errors[i] * part.errors[i];
        }
    }
    // Six means of 16 batches each, nearly normal: 6 standard errors for each of 5 contrasts have a
    // false-alarm probability below 1e-6.
    for (i, mean) in whole.means.iter().enumerate() {
        let error = squares[i].sqrt().hypot(whole.errors[i]);
        assert!((mean - sum[i]).abs() <= 6.0 * error, "{i}: {mean} {} ± {error}", sum[i]);
    }
}

#[test]
fn depth_one_is_the_emitter_alone_and_depth_zero_nothing() {
    let scene = cornell::blocks(16, 20);
    let lamp_only = pass::<1>(&tracer(&scene, depths(1, 1), 4), 58, 0);
    assert!(lamp_only.steady.contains(&0.0));
    let nothing = pass::<1>(&tracer(&scene, depths(1, 0), 4), 58, 0);
    assert!(nothing.steady.iter().all(|&v| v == 0.0));
}

#[test]
fn the_ledger_knows_fog_and_walls() {
    // A camera path of depth 2 in fog: absorbed (1 − albedo) of what collides, the rest is cut.
    let mut parts = camera(DVec3::ZERO, DVec3::Z, ONE_RAY);
    parts.media.push(medium(Rgb::splat(0.4), Rgb::splat(0.5), 0.0));
    parts.background = Some(FOG);
    parts.shapes.push(lamp(plate(DVec3::Z * -1.0, DVec3::X, DVec3::Y), 1.0));
    let scene = Scene::assemble(parts).unwrap();
    let tracer = tracer::<1>(&scene, depths(1, 2), 1000);
    let mut film = film(&tracer);
    let ledger = tracer.pass(PassId { seed: 59, index: 0 }, &mut film).ledger;
    assert!((ledger.emitted - 1000.0).abs() < 1e-9);
    assert!((ledger.absorbed_in_media - 200.0).abs() < 1e-9, "{ledger:?}");
    assert!((ledger.cut_by_depth - 800.0).abs() < 1e-9, "{ledger:?}");
}
