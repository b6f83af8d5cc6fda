//! Integration without closed forms: which parts of a line are covered is found by looking at many
//! points of it, their ends by bisection, and the integral over a part by a composite rule.

use std::f64::consts::PI;

/// The runs of `candidates` that are covered, their ends found by bisection.
pub(super) fn covered_parts(covered: &impl Fn(f64) -> bool, candidates: &[f64]) -> Vec<(f64, f64)> {
    let mut parts = Vec::new();
    let mut open = candidates.first().copied().filter(|&u| covered(u));
    for ends in candidates.windows(2) {
        match (covered(ends[0]), covered(ends[1])) {
            (false, true) => open = Some(bisect(covered, ends[0], ends[1])),
            (true, false) => {
                let end = bisect(|u| !covered(u), ends[0], ends[1]);
                parts.extend(open.take().map(|start| (start, end)));
            }
            _ => {}
        }
    }
    parts.extend(open.zip(candidates.last().copied()));
    parts
}

/// Where `after` turns true between `low` and `high`; one of these if it does not turn.
pub(super) fn bisect(after: impl Fn(f64) -> bool, mut low: f64, mut high: f64) -> f64 {
    if after(low) {
        return low;
    }
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if after(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

/// Composite 3-point Gauss-Legendre over 200 panels.
pub(super) fn gauss(f: impl Fn(f64) -> f64, start: f64, end: f64) -> f64 {
    let (panels, node) = (200, 0.6_f64.sqrt());
    let half = 0.5 * (end - start) / f64::from(panels);
    (0..panels)
        .map(|i| {
            let middle = start + half * f64::from(2 * i + 1);
            let sides = f(middle - half * node) + f(middle + half * node);
            half * (5.0 * sides + 8.0 * f(middle)) / 9.0
        })
        .sum()
}

/// The midpoint rule in the angle θ of u = start + (end − start) sin²(θ/2), in which square roots at
/// the ends are smooth. Kinks inside cost (π/points)²/12 of themselves, 3e-10.
pub(super) fn midpoints(f: impl Fn(f64) -> f64, start: f64, end: f64) -> f64 {
    let points = 50_000;
    let step = PI / f64::from(points);
    (0..points)
        .map(|i| {
            let (sin, cos) = (0.5 * step * (f64::from(i) + 0.5)).sin_cos();
            f(start + (end - start) * sin * sin) * (end - start) * sin * cos * step
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_ellipses_with_a_kink_are_integrated_to_nine_digits() {
        let f = |u: f64| ((1.0 - u) * (1.0 + u)).sqrt().min(0.8);
        // Twice 0.8 · 0.6 and what is left of the circle beyond 0.6.
        let rest = 0.25 * PI - 0.5 * 0.6_f64.asin() - 0.24;
        let exact = 2.0 * (0.48 + rest);
        assert!((midpoints(f, -1.0, 1.0) / exact - 1.0).abs() < 1e-9);
    }

    #[test]
    fn parts_are_found_with_their_ends() {
        let covered = |u: f64| (0.2..0.35).contains(&u) || u > 0.9;
        let points: Vec<f64> = (0..=100).map(|i| f64::from(i) / 100.0).collect();
        let parts = covered_parts(&covered, &points);
        let expected = [(0.2, 0.35), (0.9, 1.0)];
        assert_eq!(parts.len(), 2);
        for (part, end) in parts.iter().zip(expected) {
            assert!((part.0 - end.0).abs() < 1e-12 && (part.1 - end.1).abs() < 1e-12);
        }
    }

    #[test]
    fn exponentials_are_integrated_to_rounding() {
        assert!(
            (gauss(|u| (-3.0 * u).exp(), 0.0, 2.0) * 3.0 / (1.0 - (-6.0_f64).exp()) - 1.0).abs()
                < 1e-13
        );
        assert_eq!(gauss(|_| 1.0, 1.0, 1.0), 0.0);
    }
}
