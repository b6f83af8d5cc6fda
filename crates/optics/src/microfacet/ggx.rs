//! The Trowbridge-Reitz distribution of microfacets ("GGX") with Smith's masking and shadowing.
//!
//! Directions are unit vectors in a frame whose +z is the surface's normal. With the
//! roughness α and
//!
//! ```text
//! r(w) = √(w_z² + α² (w_x² + w_y²))
//! D(h) = α² / (π (h_x² + h_y² + α² h_z²)²)                    normals (Trowbridge & Reitz 1975)
//! Λ(w) = (r/w_z − 1)/2        G1(w) = 1/(1 + Λ) = 2 w_z/(w_z + r)        (Smith 1967)
//! ```
//!
//! all of them without a tangent, so that nothing overflows at grazing angles. Microfacets of two
//! directions are hidden together according to their height (Heitz 2014, "Understanding the
//! Masking-Shadowing Function in Microfacet-Based BRDFs", section 5.3; for two sides of the surface
//! Heitz et al. 2016, "Multiple-Scattering Microfacet BSDFs with the Smith Model", section 3):
//!
//! ```text
//! same side:  G2 = 1/(1 + Λ_a + Λ_b)        two sides:  G2 = B(1 + Λ_a, 1 + Λ_b)
//! ```
//!
//! with Euler's B: the chance that a point at the surface's height is seen from both.
//!
//! Normals are drawn as they are seen from a direction (Heitz 2018), by the uniform cap of a sphere
//! (Dupuy & Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps").

use std::f64::consts::PI;
use std::ops::RangeInclusive;

use glam::DVec3;

/// The distribution for one roughness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx {
    alpha: f64,
}

impl Ggx {
    /// The roughnesses that it holds for: below, a surface is smooth but for rounding.
    pub const RANGE: RangeInclusive<f64> = 1e-4..=1.0;

    /// Of roughness `alpha`.
    ///
    /// # Panics
    /// If it is outside of [`Ggx::RANGE`].
    pub fn new(alpha: f64) -> Self {
        assert!(Self::RANGE.contains(&alpha), "a roughness within its range");
        Self { alpha }
    }

    /// The roughness α.
    pub const fn alpha(self) -> f64 {
        self.alpha
    }

    /// r of a direction: √(w_z² + α² (w_x² + w_y²)).
    #[inline]
    pub(super) fn stretched(self, w: DVec3) -> f64 {
        (w.z * w.z + self.alpha * self.alpha * (w.x * w.x + w.y * w.y)).sqrt()
    }

    /// Λ of a direction with positive z.
    #[inline]
    fn lambda(self, w: DVec3) -> f64 {
        let across = self.alpha * self.alpha * (w.x * w.x + w.y * w.y);
        // Below the range of f64 the direction lies in the surface, as good as.
        (across / (2.0 * w.z * (w.z + self.stretched(w)))).min(1e300)
    }

    /// D: area of microfacets with this normal per surface and steradian.
    #[inline]
    pub fn density(self, normal: DVec3) -> f64 {
        let squared = self.alpha * self.alpha;
        let DVec3 { x, y, z } = normal;
        let base = x * x + y * y + squared * z * z;
        squared / (PI * base * base)
    }

    /// G1: the share of microfacets turned to `w` (z > 0) that is seen from there.
    #[inline]
    pub fn masking(self, w: DVec3) -> f64 {
        2.0 * w.z / (w.z + self.stretched(w))
    }

    /// G2(a, b)/G1(a) for two directions on the same side, both with z > 0.
    #[inline]
    pub fn shadowing_same_side(self, a: DVec3, b: DVec3) -> f64 {
        let (ra, rb) = (self.stretched(a), self.stretched(b));
        b.z * (a.z + ra) / (b.z * ra + a.z * rb)
    }

    /// G2(a, b)/G1(a) for two directions on different sides, each given with z > 0 on its own.
    #[inline]
    pub fn shadowing_two_sides(self, a: DVec3, b: DVec3) -> f64 {
        let (a, b) = (self.lambda(a), self.lambda(b));
        (a.ln_1p() + ln_beta(1.0 + a, 1.0 + b)).exp()
    }

    /// A microfacet's normal as seen from `w` (z > 0): density [`Ggx::visible_density`].
    #[inline]
    pub fn sample_visible(self, w: DVec3, [u1, u2]: [f64; 2]) -> DVec3 {
        let stretched = DVec3::new(self.alpha * w.x, self.alpha * w.y, w.z).normalize();
        let (sin_phi, cos_phi) = (2.0 * PI * u1).sin_cos();
        let z = 1.0 - u2 * (1.0 + stretched.z);
        let sine = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
        let cap = DVec3::new(sine * cos_phi, sine * sin_phi, z) + stretched;
        // z = 0 is a normal across: it has no weight, and no length is lost with it.
        DVec3::new(self.alpha * cap.x, self.alpha * cap.y, cap.z.max(0.0)).normalize()
    }

    /// Density of [`Ggx::sample_visible`] per steradian of normals: G1 D (w·h)/w_z.
    #[inline]
    pub fn visible_density(self, w: DVec3, normal: DVec3) -> f64 {
        2.0 * w.dot(normal).max(0.0) * self.density(normal) / (w.z + self.stretched(w))
    }
}

/// Logarithm of Euler's beta function for arguments of at least 1.
fn ln_beta(a: f64, b: f64) -> f64 {
    let (less, more) = (a.min(b), a.max(b));
    libm::lgamma(less) + ln_gamma_step(more, less)
}

/// ln Γ(x) − ln Γ(x + y), for x ≥ y ≥ 1: for large x by Stirling's series, term by term, where the
/// difference of the two would cancel.
fn ln_gamma_step(x: f64, y: f64) -> f64 {
    if x < 30.0 {
        return libm::lgamma(x) - libm::lgamma(x + y);
    }
    let rest = |z: f64| (1.0 / 12.0 - (1.0 / 360.0 - 1.0 / (1260.0 * z * z)) / (z * z)) / z;
    y - (x - 0.5) * (y / x).ln_1p() - y * (x + y).ln() + rest(x) - rest(x + y)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALPHAS: [f64; 5] = [0.01, 0.1, 0.3, 0.6, 1.0];

    fn direction(cosine: f64) -> DVec3 {
        DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine)
    }

    /// ∫ f over the hemisphere of normals by midpoints, fine where D is and towards the horizon.
    fn over_normals(ggx: Ggx, f: impl Fn(DVec3) -> f64) -> f64 {
        let (n, m) = (2000, 256);
        let mut sum = 0.0;
        for i in 0..n {
            // t is the share of D's projected area: sin² = α² t/(1 − t (1 − α²)).
            let u = (f64::from(i) + 0.5) / f64::from(n);
            let (t, stretch) = (u * (2.0 - u), 2.0 * (1.0 - u));
            let a2 = ggx.alpha * ggx.alpha;
            let bottom = 1.0 - t * (1.0 - a2);
            let sin2 = a2 * t / bottom;
            let slope = stretch * a2 / (bottom * bottom);
            let (s, z) = (sin2.sqrt(), (1.0 - sin2).sqrt());
            for j in 0..m {
                let phi = 2.0 * PI * (f64::from(j) + 0.5) / f64::from(m);
                let h = DVec3::new(s * phi.cos(), s * phi.sin(), z);
                // dω = sinθ dθ dφ = d(sin²)/(2 cosθ) dφ.
                sum += f(h) * slope / (2.0 * z) * 2.0 * PI / f64::from(m) / f64::from(n);
            }
        }
        sum
    }

    #[test]
    fn microfacets_cover_the_surface_once_from_every_direction() {
        for alpha in ALPHAS {
            let ggx = Ggx::new(alpha);
            let whole = over_normals(ggx, |h| ggx.density(h) * h.z);
            assert!((whole - 1.0).abs() < 1e-6, "{alpha}: {whole}");
            for cosine in [0.1, 0.5, 0.9, 1.0] {
                let w = direction(cosine);
                let seen = over_normals(ggx, |h| ggx.visible_density(w, h));
                // The midpoint rule at the border of what is turned to w.
                assert!((seen - 1.0).abs() < 2e-4, "{alpha} {cosine}: {seen}");
                let by_parts = |h: DVec3| ggx.masking(w) * ggx.density(h) * w.dot(h).max(0.0) / w.z;
                let h = DVec3::new(0.3 * alpha, -0.2 * alpha, 1.0).normalize();
                assert!((by_parts(h) / ggx.visible_density(w, h) - 1.0).abs() < 1e-12);
            }
        }
    }

    /// The integral over the height's share that B abbreviates: ∫ C^Λa (1 − C)^Λb dC.
    #[test]
    fn two_sides_are_seen_from_a_height_by_both() {
        for (alpha, a, b) in [(0.5, 0.3, 0.7), (1.0, 0.05, 0.9), (0.2, 0.9, 0.02), (1.0, 1.0, 0.2)]
        {
            let ggx = Ggx::new(alpha);
            let (a, b) = (direction(a), direction(b));
            let (la, lb) = (ggx.lambda(a), ggx.lambda(b));
            assert!((1.0 / (1.0 + la) - ggx.masking(a)).abs() < 1e-14);
            let n = 200_000;
            let sum: f64 = (0..n)
                .map(|i| (f64::from(i) + 0.5) / f64::from(n))
                .map(|c| c.powf(la) * (1.0 - c).powf(lb) / f64::from(n))
                .sum();
            let ours = ggx.shadowing_two_sides(a, b) * ggx.masking(a);
            assert!((ours - sum).abs() < 1e-4, "{alpha}: {ours} {sum}");
            let same = ggx.shadowing_same_side(a, b) * ggx.masking(a);
            assert!((same - 1.0 / (1.0 + la + lb)).abs() < 1e-14);
            // Symmetric, and neither is more than all that is seen.
            let back = ggx.shadowing_two_sides(b, a) * ggx.masking(b);
            assert!((ours - back).abs() < 1e-12 && ours <= same + 1e-14);
        }
    }

    /// Γ(x)/Γ(x + y) of whole numbers is a product; across the border of the two forms, and far
    /// out.
    #[test]
    fn beta_is_right_for_small_and_large_arguments() {
        for (x, y) in [(1_u32, 1_u32), (4, 3), (29, 5), (30, 5), (31, 30), (1000, 7)] {
            let product: f64 = (0..y).map(|i| f64::from(x + i).ln()).sum();
            let ours = ln_gamma_step(f64::from(x), f64::from(y));
            assert!((ours + product).abs() < 1e-13 * product.max(1.0), "{x} {y}: {ours} {product}");
        }
        // B(x, 1) = 1/x, B(x, 2) = 1/(x (x + 1)).
        for x in [1.0, 1e3, 1e9, 1e100, 1e300] {
            assert!((ln_beta(x, 1.0) + x.ln()).abs() < 1e-12);
            assert!((ln_beta(2.0, x) + x.ln() + (x + 1.0).ln()).abs() < 1e-11, "{x}");
        }
    }

    #[test]
    fn grazing_directions_and_small_alphas_stay_finite() {
        for alpha in [1e-4, 1e-2, 1.0] {
            let ggx = Ggx::new(alpha);
            for cosine in [1e-300, 1e-12, 1e-4, 1.0] {
                let (w, o) = (direction(cosine), direction(0.5));
                for i in 0..100 {
                    let u = [f64::from(i) / 100.0, (f64::from(i) * 0.618).fract()];
                    let h = ggx.sample_visible(w, u);
                    assert!((h.length() - 1.0).abs() < 1e-12 && h.z >= 0.0);
                    assert!(ggx.visible_density(w, h).is_finite());
                    assert!(w.dot(h) >= -1e-15, "{alpha} {cosine}");
                }
                for value in [
                    ggx.shadowing_same_side(w, o),
                    ggx.shadowing_same_side(o, w),
                    ggx.shadowing_two_sides(w, o),
                    ggx.shadowing_two_sides(o, w),
                ] {
                    assert!((0.0..=1.0 + 1e-9).contains(&value), "{alpha} {cosine}: {value}");
                }
            }
        }
    }
}
