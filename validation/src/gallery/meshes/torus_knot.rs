//! A trefoil: the torus knot that winds twice around the axis while it goes three times through the
//! hole, as a tube.
//!
//! Centre line `c(t) = ((2 + cos 3t) cos 2t, (2 + cos 3t) sin 2t, sin 3t)`, `t` from 0 to 2π, on a
//! torus of radii 2 and 1 about the z axis; all scaled so that the tube reaches to radius 1 from
//! the axis. The frame across the tube is the direction away from the torus' core circle, made
//! perpendicular to the tangent, and their cross product: it closes on itself.

use std::f64::consts::TAU;

use glam::DVec3;

use super::Mesh;

/// Radius of the tube, in the units of the centre line; strands touch beyond about 0.8.
const TUBE: f64 = 0.56;
/// Vertices along the tube.
const ALONG: usize = 320;
/// Vertices around it.
const AROUND: usize = 24;

/// The tube, with normals outwards.
pub fn torus_knot() -> Mesh {
    let mut mesh = Mesh::default();
    let ring = |mesh: &mut Mesh, i: usize| -> Vec<u16> {
        let (centre, frame) = centre_line(TAU * i as f64 / ALONG as f64);
        let vertex = |j: usize| {
            let (sin, cos) = (TAU * j as f64 / AROUND as f64).sin_cos();
            let normal = cos * frame[0] + sin * frame[1];
            mesh.push((centre + TUBE * normal) / (3.0 + TUBE), normal)
        };
        (0..AROUND).map(vertex).collect()
    };
    let rings: Vec<_> = (0..ALONG).map(|i| ring(&mut mesh, i)).collect();
    for (i, this) in rings.iter().enumerate() {
        mesh.strip(this, &rings[(i + 1) % ALONG]);
    }
    mesh
}

/// A point of the centre line, and two unit vectors across it.
fn centre_line(t: f64) -> (DVec3, [DVec3; 2]) {
    let ((sin2, cos2), (sin3, cos3)) = ((2.0 * t).sin_cos(), (3.0 * t).sin_cos());
    let radial = DVec3::new(cos2, sin2, 0.0);
    let turning = DVec3::new(-sin2, cos2, 0.0);
    let centre = (2.0 + cos3) * radial + sin3 * DVec3::Z;
    let tangent =
        (-3.0 * sin3 * radial + 2.0 * (2.0 + cos3) * turning + 3.0 * cos3 * DVec3::Z).normalize();
    let away = (centre - 2.0 * radial).reject_from_normalized(tangent).normalize();
    (centre, [away, tangent.cross(away)])
}
