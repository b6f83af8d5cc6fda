use glam::DVec3;
use proptest::prelude::*;

use super::*;

fn vector() -> impl Strategy<Value = DVec3> {
    [-3.0..3.0_f64, -3.0..3.0_f64, -3.0..3.0_f64].prop_map(DVec3::from_array)
}

proptest! {
    /// What of a segment may arrive within the window is seen, and what is seen arrives hardly beyond.
    #[test]
    fn segments_are_seen_where_they_arrive_within_the_window(
        eye in vector(), origin in vector(), towards in vector(), length in 1e-3..9.0_f64,
        opl in 0.0..12.0_f64, start in 0.0..12.0_f64, width in 0.01..4.0_f64,
        most in 1.0..1.6_f64, reach in 0.0..0.1_f64, aimed in any::<bool>(),
    ) {
        // Along the line to the eye, arrival does not grow before the eye.
        let direction = if aimed { eye - origin } else { towards };
        prop_assume!(direction.length() > 1e-3);
        let direction = direction.normalize();
        let window = [start, start + width];
        let horizon = Horizon { eye, eta: [1.0, most], window, reach };
        let seen = horizon.seen((origin, direction), length, opl);
        for step in 0..=40_u32 {
            let s = length * f64::from(step) / 40.0;
            let point = origin + s * direction;
            let distance = (point - eye).length();
            let (earliest, latest) = (opl + s + distance - reach, opl + most * (s + distance + reach));
            let within = earliest < window[1] && latest > window[0];
            let found = seen.is_some_and(|[first, last]| first - 1e-9 <= s && s <= last + 1e-9);
            prop_assert!(found || !within, "{s} of {seen:?}");
            let slack = 4.0 * most * (reach + 1e-6);
            let far = earliest - slack > window[1] || latest + slack * most < window[0];
            let inside = seen.is_some_and(|[first, last]| first + 1e-9 < s && s < last - 1e-9);
            prop_assert!(!(far && inside), "{s} of {seen:?}");
            // What a photon does later is later: points of its way are bounded by its vertices.
            if horizon.is_late(origin, opl) {
                prop_assert!(!within, "{s}");
            }
            if horizon.is_early(point, opl + most * s) {
                prop_assert!(opl + most * s + most * (distance + reach) <= window[0]);
            }
        }
    }
}

#[test]
fn the_straight_way_decides() {
    let horizon = Horizon { eye: DVec3::ZERO, eta: [1.0, 1.5], window: [2.0, 3.0], reach: 0.0 };
    let place = DVec3::new(0.0, 0.0, 1.0);
    assert!(!horizon.is_late(place, 1.999) && horizon.is_late(place, 2.001));
    assert!(horizon.is_early(place, 0.499) && !horizon.is_early(place, 0.501));
    assert!(!horizon.is_beyond(2.0, 0.999) && horizon.is_beyond(2.0, 1.001));
    // Away from the eye: s + |x(s)| = 1 + 2 s after 0.5, so that it is late from s = 0.75 on; early,
    // at 1.5 times as much at most, before 2 s = 0.
    let seen = horizon.seen((place, DVec3::Z), 10.0, 0.5).unwrap();
    assert!((seen[0] - 0.0).abs() < 1e-8 && (seen[1] - 0.75).abs() < 1e-8, "{seen:?}");
    let seen = horizon.seen((place, DVec3::Z), 10.0, -0.5).unwrap();
    let early = 0.5 * (2.5 / 1.5 - 1.0);
    assert!((seen[0] - early).abs() < 1e-8 && (seen[1] - 1.25).abs() < 1e-8, "{seen:?}");
    assert!(horizon.seen((place, DVec3::Z), 10.0, 2.5).is_none());
}
