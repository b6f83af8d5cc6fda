//! The speed of the gather on one core, in accepted pairs per CPU second: each way of gathering, each
//! radius, taken in turns so that a busy machine slows all alike. The best of the turns counts.
//!
//! `cargo run --release -p tpb-benches --example gather [PHOTONS [TURNS]]`

use cpu_time::ProcessTime;
use tpb_beams::kernel1d::Kernel1d;
use tpb_beams::kernel2d::Kernel2d;
use tpb_benches::gathers::Gathers;
use tpb_benches::one_thread;

/// Radii of beams \[m\].
const RADII: [f64; 2] = [0.005, 0.02];

#[expect(clippy::print_stdout, reason = "a program that prints a table")]
fn main() {
    let given: Vec<u64> = std::env::args().skip(1).filter_map(|n| n.parse().ok()).collect();
    let (photons, turns) = (given.first().copied(), given.get(1).copied());
    let mut gathers = Gathers::new(photons.unwrap_or(100_000));
    println!("{} beams, 128 x 128 pixels, 200 bins, one core", gathers.beams());
    println!(
        "{:<10} {:>6} {:>8} {:>8} {:>12} {:>9}",
        "way", "R", "CPU s", "set-up", "pairs", "M pairs/s"
    );
    let mut best = [[(f64::INFINITY, 0.0, 0); 3]; RADII.len()];
    one_thread(|| {
        for _ in 0..turns.unwrap_or(3) {
            for (radius, best) in RADII.into_iter().zip(&mut best) {
                let (one, two) = (Kernel1d { radius }, Kernel2d { radius });
                let turn = [
                    timed(&mut gathers, |g| g.seen(one), |g| g.drawn(one)),
                    timed(&mut gathers, |g| g.seen(two), |g| g.drawn(two)),
                    timed(&mut gathers, |g| g.listed(one), |g| g.bundled(one)),
                ];
                for (best, turn) in best.iter_mut().zip(turn) {
                    if turn.0 < best.0 {
                        *best = turn;
                    }
                }
            }
        }
    });
    for (radius, best) in RADII.into_iter().zip(best) {
        for (way, (seconds, setup, pairs)) in
            ["drawn 1D", "drawn 2D", "bundled 1D"].iter().zip(best)
        {
            let rate = pairs as f64 / seconds / 1e6;
            println!("{way:<10} {radius:>6} {seconds:>8.3} {setup:>8.3} {pairs:>12} {rate:>9.1}");
        }
    }
}

/// CPU seconds of all and of the set-up alone \[s\], and pairs.
fn timed(
    gathers: &mut Gathers,
    setup: impl Fn(&Gathers),
    work: impl Fn(&mut Gathers) -> u64,
) -> (f64, f64, u64) {
    let start = ProcessTime::now();
    setup(gathers);
    let setup = start.elapsed().as_secs_f64();
    let start = ProcessTime::now();
    let pairs = work(gathers);
    (start.elapsed().as_secs_f64(), setup, pairs)
}
