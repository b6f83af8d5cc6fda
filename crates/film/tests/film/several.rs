//! Several deposits at once are those one by one.

use proptest::prelude::*;
use tpb_film::{
    Arrays, Arrival, Exponentials, FilmOptions, Grain, Instants, Layout, TemporalProfile, Tile,
    TimeAxis, TransientFilm,
};
use tpb_lanes::{Instructions, LANES, Simd, WithSimd, dispatch};
use tpb_optics::Spectrum;

use super::{AXIS, worst};

/// One group of deposits, of either kind.
enum Group<const C: usize> {
    Instants(Instants<C>),
    Exponentials(Exponentials<C>),
}

/// Deposits a group with the machine's vectors.
struct AtOnce<'a, 'b, const C: usize>(&'a Group<C>, &'a mut Tile<'b, C>);

impl<const C: usize> WithSimd for AtOnce<'_, '_, C> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        match self.0 {
            Group::Instants(given) => self.1.deposit_instants(simd, given),
            Group::Exponentials(given) => self.1.deposit_exponentials(simd, given),
        }
    }
}

impl<const C: usize> Group<C> {
    fn one_by_one(&self, tile: &mut Tile<'_, C>) {
        let lane_of = |values: &[[f64; LANES]; C], lane: usize| Spectrum(values.map(|v| v[lane]));
        for lane in 0..LANES {
            match self {
                Self::Instants(Instants { places, unwarp_opl, opl, energy }) => tile.deposit_at(
                    places[lane] as usize,
                    unwarp_opl[lane],
                    &Arrival::Instant(opl[lane]),
                    lane_of(energy, lane),
                ),
                Self::Exponentials(given) => {
                    let profile = TemporalProfile::Exponential {
                        start: given.start[lane],
                        end: given.end[lane],
                        depth: lane_of(&given.depth, lane),
                    };
                    tile.deposit_at(
                        given.places[lane] as usize,
                        given.unwarp_opl[lane],
                        &Arrival::Profile(profile),
                        lane_of(&given.energy, lane),
                    );
                }
            }
        }
    }
}

/// A film with a group deposited in its first tile, at once or one by one; and how many were not
/// finite.
fn film<const C: usize>(
    group: &Group<C>,
    (axis, options): (Option<TimeAxis>, FilmOptions),
    at_once: Option<Instructions>,
) -> (Arrays, u64) {
    let layout = Layout::new(64, 64, axis).unwrap();
    let mut film = TransientFilm::<C>::new(layout, options).unwrap();
    let refused = film.add_pass_by(Grain::Coarse, |tile| {
        if tile.pixels().next() == Some(0) {
            match at_once {
                Some(instructions) => instructions.dispatch(AtOnce(group, tile)),
                None => group.one_by_one(tile),
            }
        }
        tile.non_finite()
    });
    (film.develop(), refused.iter().sum())
}

/// The largest difference of a film's cells, relative to the largest cell.
fn difference(a: &Arrays, b: &Arrays) -> f64 {
    let bins =
        worst(a.transient.iter().map(|&x| f64::from(x)), b.transient.iter().map(|&x| f64::from(x)));
    let steady = worst(a.steady.iter().copied(), b.steady.iter().copied());
    if b.steady.iter().all(|&x| x == 0.0) { 0.0 } else { bins.max(steady) }
}

/// Times on and off the edges of bins, within the window and outside.
fn time() -> impl Strategy<Value = f64> {
    prop_oneof![
        0.0..9.0_f64,
        (0..40_i32).prop_map(|i| 1.0 + f64::from(i) * 0.2),
        Just(1e300),
        Just(-1e300),
    ]
}

fn lanes<T: std::fmt::Debug + Copy>(
    value: impl Strategy<Value = T>,
) -> impl Strategy<Value = [T; LANES]> {
    proptest::collection::vec(value, LANES).prop_map(|all| std::array::from_fn(|i| all[i]))
}

proptest! {
    #[test]
    fn instants(
        places in lanes((0..64_u32).prop_map(f64::from)), opl in lanes(time()),
        unwarp_opl in lanes(0.0..2.0_f64), red in lanes(0.0..1.0_f64), blue in lanes(-1.0..1.0_f64),
        unwarp: bool, bins: bool,
    ) {
        let group = Group::Instants(Instants { places, unwarp_opl, opl, energy: [red, red, blue] });
        let options = FilmOptions { unwarp, ..FilmOptions::default() };
        let kind = (AXIS.filter(|_| bins), options);
        let expected = film(&group, kind, None);
        for instructions in Instructions::available() {
            prop_assert!(film(&group, kind, Some(instructions)) == expected, "{instructions}");
        }
    }

    #[test]
    fn exponentials(
        places in lanes((0..64_u32).prop_map(f64::from)), start in lanes(0.0..9.0_f64),
        length in lanes(prop_oneof![Just(0.0), 1e-9..0.1_f64, 0.1..5.0_f64]),
        depth in lanes(prop_oneof![Just(0.0), 1e-12..0.1_f64, 0.1..50.0_f64]),
        unwarp_opl in lanes(0.0..2.0_f64), energy in lanes(0.1..1.0_f64), unwarp: bool, bins: bool,
    ) {
        let end = std::array::from_fn(|lane| start[lane] + length[lane]);
        let arrivals =
            Exponentials { places, unwarp_opl, start, end, depth: [depth], energy: [energy] };
        let options = FilmOptions { unwarp, ..FilmOptions::default() };
        let kind = (AXIS.filter(|_| bins), options);
        let group = Group::Exponentials(arrivals);
        let (a, _) = film(&group, kind, Some(Instructions::Scalar));
        for instructions in Instructions::available() {
            prop_assert!(film(&group, kind, Some(instructions)).0 == a, "{instructions}");
        }
        let (b, _) = film(&group, kind, None);
        // Bins are written as f32.
        prop_assert!(difference(&a, &b) < 2e-7, "{}", difference(&a, &b));
        let energy: f64 = energy.iter().sum();
        prop_assert!((a.steady.iter().sum::<f64>() / energy - 1.0).abs() < 1e-14);
    }
}

#[test]
fn what_is_not_finite_is_kept_out_and_counted() {
    let places: [f64; LANES] = std::array::from_fn(|lane| lane as f64);
    let (fine, mut energy) = ([2.0; LANES], [1.0; LANES]);
    let mut opl = fine;
    (opl[1], energy[2], opl[5]) = (f64::NAN, f64::INFINITY, f64::NEG_INFINITY);
    let unwarp_opl = [0.0; LANES];
    let instants = Group::Instants(Instants { places, unwarp_opl, opl, energy: [energy] });
    let depth = [[0.5; LANES]];
    let arrivals =
        Exponentials { places, unwarp_opl, start: fine, end: opl, depth, energy: [energy] };
    for group in [instants, Group::Exponentials(arrivals)] {
        for instructions in Instructions::available() {
            let of = |axis| film(&group, (axis, FilmOptions::default()), Some(instructions));
            let (arrays, refused) = of(AXIS);
            assert_eq!((refused, arrays.steady.iter().sum::<f64>()), (3, LANES as f64 - 3.0));
            // A film without bins does not look at times.
            let (arrays, refused) = of(None);
            assert_eq!((refused, arrays.steady.iter().sum::<f64>()), (1, LANES as f64 - 1.0));
        }
    }
}

#[test]
fn films_without_bins_keep_the_energy() {
    let places: [f64; LANES] = std::array::from_fn(|lane| lane as f64);
    let same = [1.5; LANES];
    let group = Instants { places, unwarp_opl: same, opl: same, energy: [same] };
    let layout = Layout::new(64, 64, None).unwrap();
    let mut film = TransientFilm::<1>::new(layout, FilmOptions::default()).unwrap();
    let group = Group::Instants(group);
    film.add_pass_by(Grain::Coarse, |tile| {
        if tile.pixels().next() == Some(0) {
            dispatch(AtOnce(&group, tile));
        }
    });
    assert_eq!(film.develop().steady.iter().sum::<f64>(), 1.5 * LANES as f64);
}
