//! The hierarchy never hides a box that the ray meets, at any scale and distance.

use glam::DVec3;
use proptest::prelude::*;
use tpb_accel::{Aabb, Bvh, Quality};

/// Whether the ray meets the closed box at a distance within 0..=t_max, in f64.
fn meets(b: &Aabb, o: DVec3, d: DVec3, t_max: f64) -> bool {
    let (mut near, mut far) = (0.0_f64, t_max);
    for axis in 0..3 {
        if d[axis] == 0.0 {
            if o[axis] < b.min[axis] || o[axis] > b.max[axis] {
                return false;
            }
            continue;
        }
        let (a, c) = ((b.min[axis] - o[axis]) / d[axis], (b.max[axis] - o[axis]) / d[axis]);
        near = near.max(a.min(c));
        far = far.min(a.max(c));
    }
    near <= far
}

fn vector(range: f64) -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-range..range).prop_map(DVec3::from_array)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]
    #[test]
    fn no_box_is_lost(
        corners in prop::collection::vec((vector(1.0), vector(0.2)), 1..60),
        origin in vector(3.0),
        towards in vector(1.0),
        axis in 0_usize..6,
        log_scale in -12.0_f64..15.0,
        log_far in 0.0_f64..8.0,
        t_max in prop_oneof![Just(f64::INFINITY), 0.0_f64..5.0],
    ) {
        let scale = 10_f64.powf(log_scale);
        let boxes: Vec<_> = corners
            .iter()
            .map(|&(a, size)| Aabb::around([a * scale, (a + size) * scale]))
            .collect();
        let origin = origin * scale * 10_f64.powf(log_far);
        // Axis-parallel directions, and directions at a box's corner: the hard cases.
        let mut direction = (towards * scale - origin).normalize();
        if axis < 3 {
            direction = DVec3::ZERO;
            direction[axis] = 1.0;
        }
        let t_max = t_max * scale;
        for quality in [Quality::FastBuild, Quality::FastQuery] {
            let mut seen = vec![false; boxes.len()];
            Bvh::build(&boxes, quality).visit(origin, direction, t_max, |i| {
                seen[i] = true;
                None
            });
            for (i, b) in boxes.iter().enumerate() {
                // Beyond 1e6 scene radii the f64 ray itself is coarser than the boxes' padding.
                prop_assert!(seen[i] || !meets(b, origin, direction, t_max), "box {i} lost");
            }
        }
    }
}

#[test]
fn an_empty_hierarchy_shows_nothing() {
    Bvh::build(&[], Quality::FastQuery)
        .visit(DVec3::ZERO, DVec3::X, f64::INFINITY, |_| panic!("nothing to show"));
}
