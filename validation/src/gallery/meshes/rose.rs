//! A rose window: a wall with a round opening, its glass in four colours, and the bars between them.
//!
//! All lie about the plane z = 0, the middle of the window at the origin; what is outdoors is at
//! positive z. Glass and wall share the vertices of the opening to the bit, so that nothing passes
//! between them; the bars stand before the joints of the glass, outdoors.
//!
//! The glass: a disc in the middle, and two rings of [`SECTORS`] panes each.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::Mesh;

/// Radius of the middle, of the inner ring, and of the opening \[m\].
const RADII: [f64; 3] = [0.18, 0.54, 0.95];
/// Panes of a ring.
const SECTORS: usize = 12;
/// Vertices along a pane's arc, its ends not both.
const STEPS: usize = 4;
/// Vertices of a circle.
const AROUND: usize = SECTORS * STEPS;
/// Half the width of a bar \[m\].
const BAR: f64 = 0.018;
/// How far outdoors the bars are \[m\].
const BARS_AT: f64 = 0.02;
/// The wall's left, lower, right and upper edge \[m\].
const WALL: [f64; 4] = [-1.3, -1.35, 1.3, 1.05];

/// The point of a circle in place `k` of [`AROUND`].
fn on_circle(radius: f64, k: usize) -> DVec2 {
    radius * DVec2::from_angle(TAU * (k % AROUND) as f64 / AROUND as f64)
}

/// Every second pane of the inner ring.
pub(super) fn inner_even() -> Mesh {
    panes([RADII[0], RADII[1]], 0)
}

/// The other panes of the inner ring.
pub(super) fn inner_odd() -> Mesh {
    panes([RADII[0], RADII[1]], 1)
}

/// Every second pane of the outer ring, and the middle.
pub(super) fn outer_even() -> Mesh {
    let mut mesh = panes([RADII[1], RADII[2]], 0);
    let centre = mesh.push(DVec3::ZERO, DVec3::Z);
    let ring = ring(&mut mesh, RADII[0]);
    mesh.strip(&[centre; AROUND], &ring);
    mesh
}

/// The other panes of the outer ring.
pub(super) fn outer_odd() -> Mesh {
    panes([RADII[1], RADII[2]], 1)
}

/// The wall around the opening; normals indoors.
pub(super) fn wall() -> Mesh {
    let mut mesh = Mesh::default();
    let mut push = |place: DVec2| mesh.push(place.extend(0.0), DVec3::NEG_Z);
    let opening: Vec<u16> = (0..AROUND).map(|k| push(on_circle(RADII[2], k))).collect();
    let edge: Vec<u16> = (0..AROUND).map(|k| push(on_edge(on_circle(1.0, k)))).collect();
    let [left, low, right, high] = WALL;
    let corners = [(right, high), (left, high), (left, low), (right, low)];
    let corners = corners.map(|(x, y)| (x, y, push(DVec2::new(x, y))));
    mesh.strip(&opening, &edge);
    for (x, y, corner) in corners {
        let angle = y.atan2(x).rem_euclid(TAU);
        let before = (angle / TAU * AROUND as f64) as usize;
        mesh.triangle([edge[before], corner, edge[(before + 1) % AROUND]]);
    }
    mesh
}

/// The bars before the joints: spokes, and circles that hide the panes' arcs; normals outdoors.
pub(super) fn bars() -> Mesh {
    let mut mesh = Mesh::default();
    for radius in RADII {
        let inner = bar_ring(&mut mesh, radius - BAR);
        let outer = bar_ring(&mut mesh, radius + BAR);
        mesh.strip(&inner, &outer);
    }
    for sector in 0..SECTORS {
        let along = on_circle(1.0, sector * STEPS);
        let across = BAR * along.perp();
        let corners = [(RADII[0], -1.0), (RADII[2], -1.0), (RADII[2], 1.0), (RADII[0], 1.0)];
        let [a, b, c, d] = corners.map(|(radius, side)| {
            mesh.push((radius * along + side * across).extend(BARS_AT), DVec3::Z)
        });
        mesh.triangle([a, b, c]);
        mesh.triangle([a, c, d]);
    }
    mesh
}

/// Panes between two circles, every second one from `first` on; normals outdoors.
fn panes([inner, outer]: [f64; 2], first: usize) -> Mesh {
    let mut mesh = Mesh::default();
    for sector in (first..SECTORS).step_by(2) {
        let arc = |mesh: &mut Mesh, radius: f64| -> Vec<u16> {
            let place = |step| on_circle(radius, sector * STEPS + step).extend(0.0);
            (0..=STEPS).map(|step| mesh.push(place(step), DVec3::Z)).collect()
        };
        let (inner, outer) = (arc(&mut mesh, inner), arc(&mut mesh, outer));
        for step in 0..STEPS {
            mesh.triangle([inner[step], outer[step], outer[step + 1]]);
            mesh.triangle([inner[step], outer[step + 1], inner[step + 1]]);
        }
    }
    mesh
}

/// The vertices of a circle in the plane of the glass.
fn ring(mesh: &mut Mesh, radius: f64) -> Vec<u16> {
    (0..AROUND).map(|k| mesh.push(on_circle(radius, k).extend(0.0), DVec3::Z)).collect()
}

/// The vertices of a circle in the plane of the bars.
fn bar_ring(mesh: &mut Mesh, radius: f64) -> Vec<u16> {
    (0..AROUND).map(|k| mesh.push(on_circle(radius, k).extend(BARS_AT), DVec3::Z)).collect()
}

/// Where a ray from the middle leaves the wall.
fn on_edge(direction: DVec2) -> DVec2 {
    let [left, low, right, high] = WALL;
    let reach = |along: f64, low: f64, high: f64| match along {
        0.0 => f64::INFINITY,
        along if along > 0.0 => high / along,
        along => low / along,
    };
    direction * reach(direction.x, left, right).min(reach(direction.y, low, high))
}
