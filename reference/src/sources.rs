//! What each solution rests on, in a line or two, and the units of its inputs: for people who ask a
//! program. The documentation of the modules has the derivations, stable forms and domains.

use crate::registry::Solution;

/// Where a solution comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Source {
    /// Solutions that share the formula; bins integrate it over t0 ≤ t < t1.
    pub solutions: &'static [&'static str],
    /// The formula, in the symbols of the inputs; x = v t and σt = `sigma_t`.
    pub formula: &'static str,
    /// Author, year and, where there is one, the equation; or that the derivation is ours.
    pub origin: &'static str,
}

const OWN: &str = "own derivation (documentation of the crate), checked by brute force";
const GANAPOL: &str = "Ganapol 2001, LA-UR-01-1854 (AZURV1)";
const JAROSZ: &str = "Jarosz, Nowrouzezahrai, Sadeghi, Jensen 2011, section 5, with time kept";
const CONTINI: &str = "Contini, Martelli, Zaccanti 1997, eq. 36 and 39";

/// Every source; each solution is named once.
static SOURCES: &[Source] = &[
    Source {
        solutions: &["ballistic_point_fluence", "ballistic_pulse_shapes"],
        formula: "Q e^(-σt r)/(4π r²), times the share of the emission that arrives in the bin",
        origin: "Beer, Lambert, Bouguer 1729",
    },
    Source {
        solutions: &["ballistic_disc_bins"],
        formula: "Q d/2 ∫ e^(-σt s)/s² ds over the paths of the bin",
        origin: "Beer, Lambert, Bouguer 1729, and the cosine law",
    },
    Source {
        solutions: &["single_scatter_radiance", "single_scatter_radiance_bins"],
        formula: "Q σs v p(θ) e^(-σt x)/(2π (q² + b²)), q = x - D cos α, b = D sin α, θ = 2 atan(q/b)",
        origin: "substitution of Kulla and Fajardo 2012 with time as the variable",
    },
    Source {
        solutions: &["single_scatter_pencil_irradiance", "single_scatter_pencil_irradiance_bins"],
        formula: "2 Φ σs v p(θ) e^(-σt x)/(q² + b²)",
        origin: OWN,
    },
    Source {
        solutions: &["once_scattered_fluence", "once_scattered_fluence_bins"],
        formula: "Q σs v e^(-σt x)/(4π r x) ln((x + r)/(x - r))",
        origin: "Ganapol 2001, first collision",
    },
    Source {
        solutions: &["once_scattered_fluence_hg"],
        formula: "Q σs v e^(-σt x)/(r x) ∫ p(θ) dy, |y| < atanh(r/x), sin²(θ/2) = (1 - r²/x²) cosh² y",
        origin: OWN,
    },
    Source {
        solutions: &["once_scattered_fluence_steady"],
        formula: "σs e^(-σt r)/(4π r) ∫ z/sinh z e^(-2σt r/(e^z - 1)) dz, z > 0",
        origin: "Ganapol 2001, first collision, integrated over time",
    },
    Source {
        solutions: &["once_scattered_shell_energy", "once_scattered_shell_energy_bins"],
        formula: "σs x e^(-σt x) [G(r1/x) - G(r0/x)], G(ρ) = ρ - (1 - ρ²) atanh ρ",
        origin: "Ganapol 2001, first collision, integrated over the shell",
    },
    Source {
        solutions: &["infinite_medium_energy"],
        formula: "alive: e^(-σa x); order n: e^(-σt x) (σs x)ⁿ/n!",
        origin: "Beer, Lambert, Bouguer 1729; Poisson's law of the number of collisions",
    },
    Source {
        solutions: &["infinite_medium_sinc_moment"],
        formula: "[exp(t M)]₀₀ of the P_N equations in Fourier space",
        origin: "Case and Zweifel 1967; exponential after Tal-Ezer and Kosloff 1984",
    },
    Source {
        solutions: &["infinite_medium_moments"],
        formula: "inverse Laplace transforms of rational functions of λ1 = σs (1 - g), λ2 = σs (1 - g²)",
        origin: "Case and Zweifel 1967 (r2, z); the same expansion further (r4, z2)",
    },
    Source {
        solutions: &[
            "point_pulse_fluence",
            "point_pulse_fluence_bins",
            "point_pulse_fluence_by_order",
        ],
        formula: "-1/(2πr) d/dx of the plane pulse at x = r, along a saddle contour",
        origin: GANAPOL,
    },
    Source {
        solutions: &["plane_pulse_fluence", "plane_pulse_fluence_by_order", "plane_pulse_cells"],
        formula: "c m e^(-t)/(4π) ∫ Re ξ² e^(c t m ξ/2) ds, m = 1 - (x/t)²",
        origin: GANAPOL,
    },
    Source {
        solutions: &["scattered_energy_within_radius"],
        formula: "sine series of the sinc moment on an interval longer than t, filtered",
        origin: "Liemert and Kienle 2012; filter of Vandeven 1991 and Boyd 1996",
    },
    Source {
        solutions: &["scattered_shell_energy"],
        formula: "∫ 4πr² φ dr of the point pulse over the shell",
        origin: GANAPOL,
    },
    Source {
        solutions: &["paasschens_2d_4d", "paasschens_3d"],
        formula: "2D: e^(√(t² - r²) - t)/(2πt √(1 - r²/t²)); 4D likewise; 3D interpolates between both",
        origin: "Paasschens 1997, Phys. Rev. E 56, 1135",
    },
    Source {
        solutions: &["diffusion_infinite"],
        formula: "v (k/π)^(3/2) e^(-k r² - μa x), k = 3 μs'/(4x)",
        origin: "Patterson, Chance, Wilson 1989",
    },
    Source {
        solutions: &["diffusion_semi_infinite"],
        formula: "v z0/x (k/π)^(3/2) e^(-k (ρ² + z0²) - μa x), z0 = 1/μs'",
        origin: "Patterson, Chance, Wilson 1989, eq. 7",
    },
    Source {
        solutions: &["diffusion_slab", "diffusion_slab_total"],
        formula: "image sources about planes 2 A D/v outside both faces, v = speed/eta",
        origin: CONTINI,
    },
    Source {
        solutions: &["diffusion_boundary_parameter"],
        formula: "A = (1 + 3 ∫ R μ² dμ)/(1 - 2 ∫ R μ dμ), R of Fresnel, unpolarised",
        origin: "Haskell et al. 1994, section 2.3; Contini, Martelli, Zaccanti 1997, eq. 27",
    },
    Source {
        solutions: &["sphere_chords", "sphere_centre_radiance_bins"],
        formula: "f_n: n-fold convolution of the chord density 2x; L_k = Q ρ^k/(4π²R²) f_(k-1)",
        origin: "uniform irradiance in a diffuse sphere (Ulbricht 1900), with times: own derivation",
    },
    Source {
        solutions: &["sphere_chords_absorbing", "sphere_centre_radiance_absorbing_bins"],
        formula: "∫ f_n(u) e^(-a u) du, a = 2R σa",
        origin: OWN,
    },
    Source {
        solutions: &["sphere_decay_rate"],
        formula: "κ of ρ F(-κ) = 1, F the Laplace transform of the chord density",
        origin: "renewal equation (Feller, vol. II, section XI.6)",
    },
    Source {
        solutions: &["sphere_two_hop_local", "sphere_two_hop_density"],
        formula: "complete elliptic integral of the two chords' sum, by the arithmetic-geometric mean",
        origin: OWN,
    },
    Source {
        solutions: &["sphere_spot_irradiance_bins", "sphere_spot_mean_irradiance_bins"],
        formula: "Q ρ^k/(4πR²) v/(2R) times the law of k chords: exact as a mean; at a point for k <= 2",
        origin: OWN,
    },
    Source {
        solutions: &["slab_echoes"],
        formula: "t_m = (2m + 1) η² d/(c q), w_m = (1 - R)² R^(2m), q² = η² - 1 + cos²",
        origin: "Airy 1833, without interference; Fresnel 1823",
    },
    Source {
        solutions: &["point_through_slab"],
        formula: "Snell's path through a slab; (1 - R)² Q sin θ1/(4π ρ dρ/dθ1)",
        origin: "Snell's law and energy between two cones: own derivation",
    },
    Source {
        solutions: &["ball_lens"],
        formula: "deviation 2(θi - θt), chord 2R cos θt",
        origin: "Descartes 1637",
    },
    Source {
        solutions: &["parallel_mirrors"],
        formula: "r0^a rW^b/(4πr²) from images at 2jW ± x_s",
        origin: "method of images",
    },
    Source {
        solutions: &["beam_ray_1d"],
        formula: "Φ σs p(θ) e^(-σt S)/(2R sin ψ)",
        origin: JAROSZ,
    },
    Source {
        solutions: &["beam_ray_2d_bins"],
        formula: "Φ σs p(θ) v/(πR²κ) ∫ e^(-σt v t) dt, κ = 1 + d·ω",
        origin: JAROSZ,
    },
    Source {
        solutions: &["beam_ray_3d", "beam_ray_3d_bins"],
        formula: "3Φ σs p(θ)/(4πR³) ∫∫ e^(-σt (s_b + s_r)) ds_b ds_r over points closer than R",
        origin: JAROSZ,
    },
    Source {
        solutions: &["even_vs_exact_spread"],
        formula: "first quarter (1 - e^(-X/2))/(1 - e^(-2X)); shift 1/X - coth X; total sinh X/X",
        origin: OWN,
    },
    Source {
        solutions: &["expected_blur_1d", "expected_blur_1d_bins"],
        formula: "mean of the single scattering over a segment of sources, across the plane of the ray",
        origin: OWN,
    },
    Source {
        solutions: &[
            "expected_blur_2d",
            "expected_blur_2d_bins",
            "expected_blur_2d_hg",
            "expected_blur_2d_hg_bins",
        ],
        formula: "mean of the single scattering over a disc of sources across the ray",
        origin: OWN,
    },
    Source {
        solutions: &["expected_blur_3d", "expected_blur_3d_bins"],
        formula: "mean of the single scattering over a ball of sources",
        origin: OWN,
    },
    Source {
        solutions: &["dwell_flight_fraction"],
        formula: "(1 + a e^(-(λ + 1/τ) t))/(1 + a), a = λτ; order n by Poisson's and Gamma's laws",
        origin: OWN,
    },
    Source {
        solutions: &["dwell_mean_square_distance"],
        formula: "L⟨r²⟩ = 2v² (s + μ)²/(s² (s + λ + μ)(s + p)(s + q)), μ = 1/τ",
        origin: OWN,
    },
    Source {
        solutions: &["dwell_single_scatter_radiance"],
        formula: "single scattering convolved with e^(-t/τ)/τ",
        origin: OWN,
    },
    Source {
        solutions: &["dwell_sphere_cdf"],
        formula: "∫ f_n(u) P(n, (x - u)/τ) du, P the law of Gamma",
        origin: OWN,
    },
];

/// Units of inputs by their keys; lengths in m unless a solution says otherwise.
static UNITS: &[(&str, &[&str])] = &[
    ("J", &["energy"]),
    ("1/m", &["sigma_s", "sigma_t", "sigma_a", "mu_a", "mu_s_prime"]),
    ("m/s", &["speed"]),
    ("s", &["time", "t0", "t1", "box_width", "rms_width", "mean_dwell"]),
    ("1/s", &["scattering_rate"]),
    ("rad", &["alpha"]),
    ("rad/m", &["k"]),
    (
        "m",
        &[
            "r",
            "r0",
            "r1",
            "rho",
            "radius",
            "thickness",
            "air_gap",
            "lateral",
            "distance",
            "impact",
            "width",
            "source_x",
            "observer_x",
            "source_distance",
            "source_z",
            "ray_offset",
            "disc_distance",
            "disc_radius",
            "beam_origin",
            "beam_length",
            "ray_origin",
            "ray_length",
        ],
    ),
    (
        "1",
        &[
            "g",
            "albedo",
            "eta",
            "order",
            "chords",
            "echo",
            "scatterings",
            "image",
            "image_sign",
            "bounces_first",
            "bounces_second",
            "first_reflectance",
            "second_reflectance",
            "cos_gamma",
            "cos_incidence",
            "absorption",
            "optical_half_width",
            "beam_direction",
            "ray_direction",
        ],
    ),
];

/// Inputs in mean free paths, and in mean free times.
pub(crate) const FREE_PATHS: &[(&str, &str)] = &[
    ("r", "mfp"),
    ("r0", "mfp"),
    ("r1", "mfp"),
    ("x", "mfp"),
    ("x0", "mfp"),
    ("x1", "mfp"),
    ("time", "mfp/v"),
    ("t0", "mfp/v"),
    ("t1", "mfp/v"),
];

/// Inputs where a path length takes the place of the time (v = 1).
pub(crate) const PATH_LENGTH: &[(&str, &str)] = &[("time", "m")];

/// Inputs in units of a sphere: its diameter, and the time that light takes for it.
pub(crate) const DIAMETERS: &[(&str, &str)] = &[("x", "2R"), ("mean_dwell", "2R/v")];

/// Inputs of a sphere of radius 1.
pub(crate) const RADII: &[(&str, &str)] = &[("t0", "R/v"), ("t1", "R/v")];

impl Solution {
    /// Its formula and where it comes from.
    pub fn source(&self) -> Option<&'static Source> {
        SOURCES.iter().find(|source| source.solutions.contains(&self.name))
    }

    /// The unit of an input, "1" for a pure number; `None` for keys that no solution has.
    pub fn unit_of_input(&self, key: &str) -> Option<&'static str> {
        let own = self.input_units.iter().find(|(name, _)| *name == key).map(|&(_, unit)| unit);
        own.or_else(|| UNITS.iter().find(|(_, keys)| keys.contains(&key)).map(|&(unit, _)| unit))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::solutions;

    #[test]
    fn every_solution_has_one_source_and_every_source_its_solutions() {
        for solution in solutions() {
            let named = |source: &&Source| source.solutions.contains(&solution.name);
            assert_eq!(SOURCES.iter().filter(named).count(), 1, "{}", solution.name);
        }
        for name in SOURCES.iter().flat_map(|source| source.solutions) {
            assert!(solutions().any(|solution| solution.name == *name), "{name}");
        }
    }

    #[test]
    fn every_input_has_a_unit() {
        for solution in solutions() {
            for key in solution.quantities.iter().flat_map(|quantity| (quantity.keys)()) {
                assert!(solution.unit_of_input(key).is_some(), "{}: {key}", solution.name);
            }
            for (key, _) in solution.input_units {
                let known = |table: &[(&str, &str)]| table.iter().any(|(name, _)| name == key);
                let shared = [FREE_PATHS, PATH_LENGTH, DIAMETERS, RADII].into_iter().any(known);
                assert!(shared, "{}: {key}", solution.name);
            }
        }
    }

    #[test]
    fn units_follow_the_solution() {
        let unit = |name, key| crate::registry::find(name).unwrap().unit_of_input(key);
        assert_eq!(unit("once_scattered_fluence", "time"), Some("s"));
        assert_eq!(unit("point_pulse_fluence", "time"), Some("mfp/v"));
        assert_eq!(unit("infinite_medium_moments", "time"), Some("m"));
        assert_eq!(unit("dwell_sphere_cdf", "mean_dwell"), Some("2R/v"));
        assert_eq!(unit("dwell_sphere_cdf", "colour"), None);
    }
}
