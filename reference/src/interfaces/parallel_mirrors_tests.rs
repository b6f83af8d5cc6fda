use super::*;
use proptest::prelude::*;

const SAMPLE: ParallelMirrors = ParallelMirrors {
    width: 2.0,
    source_x: 0.7,
    observer_x: 1.1,
    lateral: 1.5,
    image: 0,
    image_sign: 1,
    bounces_first: None,
    bounces_second: None,
    first_reflectance: 0.9,
    second_reflectance: 0.8,
    speed: 1.0,
};

/// Follows the light itself: its length along x and its reflections, after `count` reflections.
fn unfolded(of: &ParallelMirrors, towards_second: bool, count: u32) -> (f64, u32, u32) {
    let (mut x, mut up, mut length, mut bounces) = (of.source_x, towards_second, 0.0, [0, 0]);
    for _ in 0..count {
        let wall = if up { of.width } else { 0.0 };
        length += (wall - x).abs();
        bounces[usize::from(up)] += 1;
        (x, up) = (wall, !up);
    }
    let forward = if up { of.observer_x - x } else { x - of.observer_x };
    (length + forward, bounces[0], bounces[1])
}

#[test]
fn every_folded_path_is_an_image() {
    // Even numbers of reflections are the images of sign 1, odd ones those of sign −1.
    for (sign, count, towards_second, image) in [
        (1, 0, true, 0),
        (1, 2, false, 1),
        (1, 2, true, -1),
        (1, 6, true, -3),
        (-1, 1, false, 0),
        (-1, 1, true, 1),
        (-1, 3, true, 2),
        (-1, 3, false, -1),
        (-1, 5, false, -2),
    ] {
        let mut found = false;
        for image in [image, -image] {
            let of = ParallelMirrors { image, image_sign: sign, ..SAMPLE };
            let (along, first, second) = unfolded(&of, towards_second, count);
            let solved = Image::of(&of).unwrap();
            let same = (solved.distance - along.hypot(1.5)).abs() < 1e-13;
            found |= same && (solved.first, solved.second) == (first, second);
        }
        assert!(found, "{sign} {count} {towards_second}");
    }
}

#[test]
fn the_reflections_are_those_of_the_image_or_an_error() {
    let of = ParallelMirrors { image: -2, image_sign: -1, ..SAMPLE };
    let checked = ParallelMirrors { bounces_first: Some(3), bounces_second: Some(2), ..of };
    assert_eq!(parallel_mirrors_weight(&of).unwrap(), parallel_mirrors_weight(&checked).unwrap());
    let wrong = ParallelMirrors { bounces_first: Some(2), ..checked };
    assert!(parallel_mirrors_weight(&wrong).unwrap_err().to_string().contains("bounces_first"));
}

#[test]
fn on_the_image_itself_there_is_a_time_but_no_weight() {
    let of = ParallelMirrors { observer_x: 0.7, lateral: 0.0, ..SAMPLE };
    assert_eq!(parallel_mirrors_time(&of).unwrap(), 0.0);
    assert!(parallel_mirrors_weight(&of).is_err());
}

#[test]
fn inputs_without_meaning_are_errors() {
    for of in [
        ParallelMirrors { source_x: 2.1, ..SAMPLE },
        ParallelMirrors { observer_x: -0.1, ..SAMPLE },
        ParallelMirrors { image_sign: 0, ..SAMPLE },
        ParallelMirrors { image_sign: i32::MIN, ..SAMPLE },
        ParallelMirrors { first_reflectance: 1.1, ..SAMPLE },
        ParallelMirrors { width: 0.0, ..SAMPLE },
        ParallelMirrors { lateral: f64::NAN, ..SAMPLE },
    ] {
        assert!(parallel_mirrors_time(&of).is_err(), "{of:?}");
    }
}

proptest! {
    #[test]
    fn a_perfect_pair_is_symmetric(
        image in -1000..1000_i32, sign in prop::bool::ANY, x in 0.0..2.0_f64, y in 0.0..2.0_f64,
    ) {
        // Source and observer exchanged: the path is the same backwards.
        let sign = if sign { 1 } else { -1 };
        let (there, back) = (
            ParallelMirrors { image, image_sign: sign, source_x: x, observer_x: y, ..SAMPLE },
            ParallelMirrors {
                image: -sign * image, image_sign: sign, source_x: y, observer_x: x, ..SAMPLE
            },
        );
        let (a, b) = (Image::of(&there).unwrap(), Image::of(&back).unwrap());
        prop_assert!((a.distance / b.distance - 1.0).abs() < 1e-12);
        prop_assert_eq!((a.first, a.second), (b.first, b.second));
    }

    #[test]
    fn wild_inputs_give_a_value_or_an_error(
        exponents in prop::array::uniform3(-320.0..308.0_f64),
        fractions in prop::array::uniform4(0.0..1.0_f64),
        image in any::<i32>(),
    ) {
        let [width, lateral, speed] = exponents.map(|e| 10.0_f64.powf(e));
        let [source, observer, first_reflectance, second_reflectance] = fractions;
        let of = ParallelMirrors {
            width, lateral, speed, image, first_reflectance, second_reflectance,
            source_x: source * width, observer_x: observer * width, ..SAMPLE
        };
        for result in [parallel_mirrors_time(&of), parallel_mirrors_weight(&of)] {
            let fine = |v: &f64| v.is_finite() && *v >= 0.0;
            prop_assert!(result.as_ref().map_or(true, fine), "{of:?} {result:?}");
        }
    }
}
