//! A tumbler with liquid, as the three interfaces that light needs (`docs/liquid-in-glass.md`):
//! surfaces of revolution about the y axis that meet in lines and nowhere else.
//!
//! A profile is a list of points (radius, height) with their normals. Where two surfaces meet,
//! their profiles end in the same point, so that the rings of vertices there are the same to the
//! bit. Heights start at 0, the underside of the glass.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DVec2, DVec3};

use super::Mesh;

/// Outer radius of the glass \[m\].
const RADIUS: f64 = 0.036;
/// Its height \[m\].
const HEIGHT: f64 = 0.095;
/// Thickness of its wall \[m\].
const WALL: f64 = 0.003;
/// Thickness of its bottom \[m\].
const BOTTOM: f64 = 0.008;
/// Height of the liquid's level \[m\].
const LEVEL: f64 = 0.066;
/// Rounding of the outer edge at the bottom \[m\].
const OUTER_EDGE: f64 = 0.008;
/// Rounding of the inner one \[m\].
const INNER_EDGE: f64 = 0.006;
/// Vertices of a ring.
const AROUND: usize = 96;

/// A point of a profile: (radius, height) and the normal there.
type Point = (DVec2, DVec2);

/// Outside, rim, and the dry part of the inner wall; normals into the air.
pub fn air_glass() -> Mesh {
    let rim = DVec2::new(RADIUS - 0.5 * WALL, HEIGHT - 0.5 * WALL);
    let mut profile = vec![(DVec2::ZERO, DVec2::NEG_Y)];
    let edge = DVec2::new(RADIUS - OUTER_EDGE, OUTER_EDGE);
    profile.extend(arc(edge, OUTER_EDGE, -FRAC_PI_2, 0.0, 8));
    profile.extend(arc(rim, 0.5 * WALL, 0.0, PI, 10));
    profile.push((DVec2::new(RADIUS - WALL, LEVEL), DVec2::NEG_X));
    revolve(&profile)
}

/// The wet part of the inner wall, and the bottom; normals into the liquid.
pub fn glass_liquid() -> Mesh {
    let mut profile = vec![(DVec2::new(RADIUS - WALL, LEVEL), DVec2::NEG_X)];
    let edge = DVec2::new(RADIUS - WALL - INNER_EDGE, BOTTOM + INNER_EDGE);
    let rounding = arc(edge, INNER_EDGE, 0.0, -FRAC_PI_2, 8);
    profile.extend(rounding.map(|(place, normal)| (place, -normal)));
    profile.push((DVec2::new(0.0, BOTTOM), DVec2::Y));
    revolve(&profile)
}

/// The liquid's level; normals into the air.
pub fn liquid_air() -> Mesh {
    revolve(&[(DVec2::new(RADIUS - WALL, LEVEL), DVec2::Y), (DVec2::new(0.0, LEVEL), DVec2::Y)])
}

/// Points of an arc, with normals away from its centre.
fn arc(centre: DVec2, radius: f64, from: f64, to: f64, steps: u32) -> impl Iterator<Item = Point> {
    (0..=steps).map(move |i| {
        let angle = from + (to - from) * f64::from(i) / f64::from(steps);
        let normal = DVec2::from_angle(angle);
        (centre + radius * normal, normal)
    })
}

/// Turns a profile about the y axis; points on the axis become one vertex.
fn revolve(profile: &[Point]) -> Mesh {
    let mut mesh = Mesh::default();
    let mut above: Option<Vec<u16>> = None;
    for (place, normal) in profile {
        let ring: Vec<u16> = if place.x == 0.0 {
            let only = mesh.push(DVec3::new(0.0, place.y, 0.0), DVec3::Y * normal.y);
            vec![only; AROUND]
        } else {
            let turned = |k: usize| {
                let (sin, cos) = (TAU * k as f64 / AROUND as f64).sin_cos();
                let turn = |v: &DVec2| DVec3::new(v.x * cos, v.y, v.x * sin);
                mesh.push(turn(place), turn(normal))
            };
            (0..AROUND).map(turned).collect()
        };
        if let Some(above) = above {
            mesh.strip(&above, &ring);
        }
        above = Some(ring);
    }
    mesh
}
