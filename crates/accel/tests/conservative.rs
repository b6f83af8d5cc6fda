//! The hierarchy never hides a box that the ray meets, at any scale and distance.

use glam::DVec3;
use proptest::prelude::*;
use tpb_accel::{Aabb, Bvh, Next, Visitor};

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

/// Leaves that were met, the walk's end after so many of them, and a distance to end it at.
#[derive(Default)]
struct Seen {
    leaves: Vec<usize>,
    most: Option<usize>,
    until: Option<f64>,
}

impl Visitor for Seen {
    fn meet(&mut self, leaf: usize) -> Next {
        self.leaves.push(leaf);
        if self.most == Some(self.leaves.len()) {
            Next::Stop
        } else {
            self.until.map_or(Next::On, Next::Until)
        }
    }
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
        // All apart, all together, and some of each.
        for joins in [|_| false, |_| true, |i| i % 3 > 0] {
            let bvh = Bvh::build(&boxes, joins);
            let leaves: Vec<_> = bvh.leaves().map(<[u32]>::to_vec).collect();
            let mut members = leaves.concat();
            members.sort_unstable();
            prop_assert!(members.into_iter().eq(0..boxes.len() as u32), "each is in one leaf");
            let single = |leaf: &Vec<u32>| leaf.len() == 1 || leaf.iter().all(|&i| joins(i as usize));
            prop_assert!(leaves.iter().all(single));
            // The whole way, and to where a visitor ends it.
            for shorter in [t_max, 0.5 * t_max.min(4.0 * scale)] {
                let mut seen = Seen { until: Some(shorter).filter(|&t| t < t_max), ..Seen::default() };
                bvh.walk(origin, direction, t_max, &mut seen);
                for (leaf, members) in leaves.iter().enumerate() {
                    for &i in members {
                        // Beyond 1e6 scene radii the f64 ray itself is coarser than the boxes' padding.
                        let meets = meets(&boxes[i as usize], origin, direction, shorter);
                        prop_assert!(seen.leaves.contains(&leaf) || !meets, "box {i} lost");
                    }
                }
                let most = seen.leaves.len().saturating_sub(1).max(1);
                let mut fewer = Seen { most: Some(most), until: seen.until, ..Seen::default() };
                bvh.walk(origin, direction, t_max, &mut fewer);
                prop_assert!(fewer.leaves.iter().eq(seen.leaves.iter().take(most)));
            }
        }
    }
}

#[test]
fn an_empty_hierarchy_shows_nothing() {
    let (empty, mut seen) = (Bvh::build(&[], |_| true), Seen::default());
    empty.walk(DVec3::ZERO, DVec3::X, f64::INFINITY, &mut seen);
    assert!(seen.leaves.is_empty() && empty.leaves().count() == 0);
}
