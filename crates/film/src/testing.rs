//! For tests: plain quadrature, independent of the film's own.

/// Composite three-point Gauss-Legendre rule.
pub(crate) fn integrate(f: impl Fn(f64) -> f64, from: f64, to: f64, panels: u32) -> f64 {
    let width = (to - from) / f64::from(panels);
    let node = 0.5 * width * 0.6_f64.sqrt();
    let panel = |i: u32| {
        let centre = from + (f64::from(i) + 0.5) * width;
        width / 18.0 * (5.0 * f(centre - node) + 8.0 * f(centre) + 5.0 * f(centre + node))
    };
    (0..panels).map(panel).sum()
}
