//! Fresnel's equations (1823) for lossless dielectrics, without cancellation.
//!
//! Light meets the boundary under the cosine μ and enters a medium of the relative index η. With
//! q = η cos θt = √(η² − 1 + μ²), the fractions of the power that is polarised across (s) and in
//! (p) the plane of incidence are
//!
//! > Ts = 4 μ q / (μ + q)²,   Tp = 4 η² μ q / (η² μ + q)²,
//! > √Rs = (η² − 1) / (μ + q)²,   √Rp = (η² − 1) |(η² + 1) μ² − 1| / (η² μ + q)².
//!
//! The amplitudes of reflection are the usual differences, (μ − q)/(μ + q) and
//! (η² μ − q)/(η² μ + q), multiplied out: they keep their digits as η → 1.

/// What happens to the power of light that enters another medium.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Fresnel {
    /// q, the index times the cosine behind the boundary.
    pub(crate) q: f64,
    pub(crate) transmitted_s: f64,
    pub(crate) transmitted_p: f64,
    pub(crate) reflected_s: f64,
    pub(crate) reflected_p: f64,
}

impl Fresnel {
    /// For a relative index and a cosine of incidence, neither negative nor both those of grazing
    /// light at equal indices; `None` where all light is reflected.
    pub(crate) fn new(eta: f64, cosine: f64) -> Option<Self> {
        let difference = (eta - 1.0) * (eta + 1.0);
        let square = difference + cosine * cosine;
        // Also refuses a NaN.
        if !(square >= 0.0 && cosine + square > 0.0) {
            return None;
        }
        let q = square.sqrt();
        let (sum_s, scaled) = (cosine + q, eta * eta * cosine);
        let sum_p = scaled + q;
        let amplitude_s = difference / sum_s / sum_s;
        let brewster = (eta * eta + 1.0) * cosine * cosine - 1.0;
        let amplitude_p = (difference / sum_p) * (brewster / sum_p);
        Some(Self {
            q,
            transmitted_s: 4.0 * (cosine / sum_s) * (q / sum_s),
            transmitted_p: 4.0 * (scaled / sum_p) * (q / sum_p),
            reflected_s: amplitude_s * amplitude_s,
            reflected_p: amplitude_p * amplitude_p,
        })
    }

    /// The transmitted fraction of unpolarised light.
    pub(crate) fn transmitted(&self) -> f64 {
        0.5 * (self.transmitted_s + self.transmitted_p)
    }

    /// The reflected fraction of unpolarised light.
    pub(crate) fn reflected(&self) -> f64 {
        0.5 * (self.reflected_s + self.reflected_p)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_reflected_is_transmitted() {
        for eta in [0.5, 0.9, 1.0, 1.0 + 1e-12, 1.33, 2.4, 1e3] {
            for cosine in [1e-9, 0.01, 0.3, 0.7, 1.0] {
                let Some(f) = Fresnel::new(eta, cosine) else {
                    assert!(eta < 1.0 && cosine * cosine < 1.0 - eta * eta);
                    continue;
                };
                assert!((f.transmitted_s + f.reflected_s - 1.0).abs() < 1e-14, "{eta} {cosine}");
                assert!((f.transmitted_p + f.reflected_p - 1.0).abs() < 1e-14, "{eta} {cosine}");
            }
        }
    }

    #[test]
    fn known_angles() {
        let normal = Fresnel::new(1.5, 1.0).unwrap();
        assert!((normal.reflected() - 0.04).abs() < 1e-16);
        assert!((normal.reflected_s - normal.reflected_p).abs() < 1e-16);
        let brewster = Fresnel::new(1.5, 1.0 / (1.0 + 1.5_f64 * 1.5).sqrt()).unwrap();
        assert!(brewster.reflected_p < 1e-31);
        let grazing = Fresnel::new(1.5, 0.0).unwrap();
        assert_eq!((grazing.transmitted(), grazing.reflected()), (0.0, 1.0));
        // Almost equal indices: R = (Δη/2)² at normal incidence.
        let faint = Fresnel::new(1.0 + 1e-12, 1.0).unwrap();
        let step = (1.0 + 1e-12) - 1.0;
        assert!((faint.reflected() / (step * step / 4.0) - 1.0).abs() < 1e-11);
        assert_eq!(Fresnel::new(1.0, 0.2).unwrap().reflected(), 0.0);
    }

    #[test]
    fn both_sides_of_a_boundary_transmit_alike() {
        // Helmholtz: the same ray backwards.
        for (eta, cosine) in [(1.5, 0.2), (2.4, 0.9), (1.01, 0.05)] {
            let there = Fresnel::new(eta, cosine).unwrap();
            let back = Fresnel::new(1.0 / eta, there.q / eta).unwrap();
            assert!((there.transmitted_s / back.transmitted_s - 1.0).abs() < 1e-13);
            assert!((there.transmitted_p / back.transmitted_p - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn no_light_passes_where_there_is_no_angle() {
        assert!(Fresnel::new(0.5, 0.5).is_none());
        assert!(Fresnel::new(1.0, 0.0).is_none());
        assert!(Fresnel::new(f64::NAN, 0.5).is_none());
    }
}
