//! A plane pulse through a clear slab with parallel faces: its train of transmitted echoes.
//!
//! The pulse comes under the cosine μ, crosses the slab (index η relative to its surroundings,
//! thickness d) and leaves in part; the rest runs to and fro. Echo m = 0, 1, … has crossed 2m + 1
//! times, each in the time η d / (c cos θt). With q = η cos θt = √(η² − 1 + μ²), the time inside is
//!
//! > t_m = (2m + 1) η² d / (c q)
//!
//! \[s\], c being the speed *outside*. Of the power that arrives, echo m carries (Airy 1833, without
//! interference, as for pulses shorter than the slab)
//!
//! > w_m = (1 − R)² R^(2m),   Σ_m w_m = (1 − R)/(1 + R).
//!
//! * [`slab_echo_weight_sp`] keeps the two polarisations apart through the slab, as nature does:
//!   the mean of w_m over s and p.
//! * [`slab_echo_weight_unpolarised`] has R the mean reflectance at every face, as a renderer does
//!   that forgets polarisation: equal at normal incidence, lower echoes at oblique ones.
//!
//! R and 1 − R are both computed without subtraction (`fresnel`). Domain: 0 < μ ≤ 1; below the
//! critical angle for η < 1.

use super::fresnel::Fresnel;
use crate::error::{Result, finite_result, non_negative, positive, require};
use serde::Deserialize;

/// Inputs of the echoes of a slab.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SlabEcho {
    /// Index η of the slab, relative to its surroundings.
    pub eta: f64,
    /// Cosine μ of the angle of incidence, above 0.
    pub cos_incidence: f64,
    /// Number m of the echo; 0 is the direct pulse.
    pub echo: u32,
    /// Thickness d \[m\].
    pub thickness: f64,
    /// Speed of light c outside the slab \[m/s\].
    pub speed: f64,
}

/// The time \[s\] that an echo has spent in the slab.
pub fn slab_echo_time(input: &SlabEcho) -> Result<f64> {
    let &SlabEcho { eta, echo, thickness, speed, .. } = input;
    let face = face(input)?;
    require(face.q > 0.0, "cos_incidence", input.cos_incidence, "below the critical angle")?;
    let crossings = 2.0 * f64::from(echo) + 1.0;
    finite_result("slab_echoes", crossings * eta * (eta / face.q) * (thickness / speed))
}

/// The fraction of the power in an echo, with the two polarisations kept apart.
pub fn slab_echo_weight_sp(input: &SlabEcho) -> Result<f64> {
    let face = face(input)?;
    let s = echo_weight(face.transmitted_s, face.reflected_s, input.echo);
    let p = echo_weight(face.transmitted_p, face.reflected_p, input.echo);
    finite_result("slab_echoes", 0.5 * (s + p))
}

/// The fraction of the power in an echo, if light is taken as unpolarised at every face.
pub fn slab_echo_weight_unpolarised(input: &SlabEcho) -> Result<f64> {
    let face = face(input)?;
    finite_result("slab_echoes", echo_weight(face.transmitted(), face.reflected(), input.echo))
}

/// (1 − R)² R^(2m).
fn echo_weight(transmitted: f64, reflected: f64, echo: u32) -> f64 {
    transmitted * transmitted * reflected.powf(2.0 * f64::from(echo))
}

fn face(input: &SlabEcho) -> Result<Fresnel> {
    let &SlabEcho { eta, cos_incidence, thickness, speed, .. } = input;
    positive("eta", eta)?;
    non_negative("thickness", thickness)?;
    positive("speed", speed)?;
    let allowed = cos_incidence > 0.0 && cos_incidence <= 1.0;
    require(allowed, "cos_incidence", cos_incidence, "above 0 and at most 1")?;
    let face = Fresnel::new(eta, cos_incidence);
    face.ok_or(crate::ReferenceError::Domain {
        input: "cos_incidence",
        value: cos_incidence,
        requirement: "below the critical angle",
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn echo(eta: f64, cos_incidence: f64, echo: u32) -> SlabEcho {
        SlabEcho { eta, cos_incidence, echo, thickness: 0.5, speed: 1.0 }
    }

    fn close(value: f64, expected: f64, relative: f64) {
        assert!((value - expected).abs() <= relative * expected.abs(), "{value} for {expected}");
    }

    #[test]
    fn equal_indices_are_no_slab() {
        for cosine in [1e-9, 0.3, 1.0] {
            assert_eq!(slab_echo_weight_unpolarised(&echo(1.0, cosine, 0)).unwrap(), 1.0);
            assert_eq!(slab_echo_weight_sp(&echo(1.0, cosine, 1)).unwrap(), 0.0);
            close(slab_echo_time(&echo(1.0, cosine, 0)).unwrap(), 0.5 / cosine, 1e-14);
            // The faintest of slabs: (Δη)² / 4 per reflection at normal incidence.
            let faint = slab_echo_weight_unpolarised(&echo(1.0 + 1e-12, 1.0, 1)).unwrap();
            close(faint, (2.5e-25_f64).powi(2), 1e-3);
        }
    }

    #[test]
    fn at_normal_incidence_polarisation_does_not_matter() {
        for m in [0, 1, 7] {
            let sp = slab_echo_weight_sp(&echo(1.7, 1.0, m)).unwrap();
            close(slab_echo_weight_unpolarised(&echo(1.7, 1.0, m)).unwrap(), sp, 1e-13);
        }
    }

    #[test]
    fn grazing_light_spends_the_time_of_the_critical_angle() {
        // cos θt = √(1 − 1/η²).
        let expected = 1.5 * 0.5 / (1.0 - 1.0 / 2.25_f64).sqrt();
        close(slab_echo_time(&echo(1.5, 1e-200, 0)).unwrap(), expected, 1e-14);
        assert!(slab_echo_weight_sp(&echo(1.5, 1e-200, 0)).unwrap() < 1e-300);
    }

    #[test]
    fn what_no_slab_passes_is_an_error() {
        assert!(slab_echo_time(&echo(1.5, 0.0, 0)).is_err());
        assert!(slab_echo_time(&echo(1.5, 1.1, 0)).is_err());
        assert!(slab_echo_weight_sp(&echo(0.5, 0.5, 0)).is_err());
        assert!(slab_echo_weight_sp(&echo(0.0, 0.5, 0)).is_err());
        assert!(slab_echo_time(&echo(f64::NAN, 0.5, 0)).is_err());
        assert!(slab_echo_time(&SlabEcho { speed: 0.0, ..echo(1.5, 0.5, 0) }).is_err());
    }

    proptest! {
        #[test]
        fn the_echoes_add_up(eta in 1.0..4.0_f64, cosine in 0.02..1.0_f64) {
            let face = Fresnel::new(eta, cosine).unwrap();
            let total = |r: f64| (1.0 - r) / (1.0 + r);
            let sum = |weight: fn(&SlabEcho) -> Result<f64>| -> f64 {
                (0..3000).map(|m| weight(&echo(eta, cosine, m)).unwrap()).sum()
            };
            close(sum(slab_echo_weight_unpolarised), total(face.reflected()), 1e-12);
            let expected = 0.5 * (total(face.reflected_s) + total(face.reflected_p));
            close(sum(slab_echo_weight_sp), expected, 1e-12);
        }

        #[test]
        fn echoes_are_equally_spaced(eta in 0.8..4.0_f64, cosine in 0.7..1.0_f64, m in 0..1000_u32) {
            let direct = slab_echo_time(&echo(eta, cosine, 0)).unwrap();
            let expected = direct * (2.0 * f64::from(m) + 1.0);
            close(slab_echo_time(&echo(eta, cosine, m)).unwrap(), expected, 1e-14);
        }

        #[test]
        fn wild_inputs_give_a_value_or_an_error(
            exponents in prop::array::uniform4(-320.0..308.0_f64),
            step in -20.0..1.0_f64,
            number in any::<u32>(),
        ) {
            let [eta, cosine, thickness, speed] = exponents.map(|e| 10.0_f64.powf(e));
            for eta in [eta, 1.0 + 10.0_f64.powf(step)] {
                for cos_incidence in [cosine, cosine.min(1.0)] {
                    let of = SlabEcho { eta, cos_incidence, echo: number, thickness, speed };
                    for result in [
                        slab_echo_time(&of),
                        slab_echo_weight_sp(&of),
                        slab_echo_weight_unpolarised(&of),
                    ] {
                        prop_assert!(
                            result.as_ref().map_or(true, |v| v.is_finite() && *v >= 0.0),
                            "{:?} {:?}", of, result
                        );
                    }
                }
            }
        }
    }
}
