//! Energy, reciprocity, the smooth limit, and samplers against values.

use std::f64::consts::PI;

use super::*;
use crate::{Rgb, Stream, fresnel};

const ALPHAS: [f64; 4] = [0.05, 0.2, 0.5, 1.0];
const COSINES: [f64; 4] = [0.08, 0.4, 0.8, 1.0];

fn direction(cosine: f64, azimuth: f64) -> DVec3 {
    let sine = ((1.0 - cosine) * (1.0 + cosine)).sqrt();
    DVec3::new(sine * azimuth.cos(), sine * azimuth.sin(), cosine)
}

fn glass(alpha: f64, into: bool) -> RoughDielectric {
    let (eta_before, eta_beyond) = if into { (1.0, 1.5) } else { (1.5, 1.0) };
    RoughDielectric { ggx: Ggx::new(alpha), eta_before, eta_beyond }
}

fn metal(alpha: f64) -> RoughConductor {
    RoughConductor { ggx: Ggx::new(alpha), metal: Metal::Perfect }
}

/// ∫ f dω over the whole sphere by midpoints in the polar angle and azimuth.
fn over_sphere(f: impl Fn(DVec3) -> f64) -> f64 {
    let (n, m) = (2000, 500);
    let mut sum = 0.0;
    for i in 0..n {
        let (sine, cosine) = (PI * (f64::from(i) + 0.5) / f64::from(n)).sin_cos();
        for j in 0..m {
            sum += sine * f(direction(cosine, PI * (f64::from(j) + 0.5) / f64::from(m)));
        }
    }
    // Symmetric about the plane of incidence: half of the azimuths, counted twice.
    sum * 2.0 * PI * PI / (f64::from(n) * f64::from(m))
}

/// The mean of the weights must be the integral of the value; the density must integrate to the
/// part of the draws that is not lost. 2·10⁵ draws with weights from 0 to 1: standard errors up to
/// 1.1e-3; six of them (false alarm 2e-9), and 1e-3 for the midpoint rule.
#[test]
fn samples_values_and_densities_agree() {
    let n = 200_000;
    for alpha in [0.2, 0.5, 1.0] {
        for cosine in COSINES {
            let from = direction(cosine, 0.0);
            for into in [true, false] {
                let glass = glass(alpha, into);
                let value = over_sphere(|to| glass.towards(from, to).value);
                let density = over_sphere(|to| glass.towards(from, to).density);
                let mut rng = Stream::new(11, 0, 0);
                let (mut weight, mut drawn) = (0.0, 0.0);
                for _ in 0..n {
                    let u = [rng.uniform(), rng.uniform()];
                    if let Some(draw) = glass.sample(from, u, rng.uniform()) {
                        weight += draw.weight / f64::from(n);
                        drawn += 1.0 / f64::from(n);
                    }
                }
                let near = |a: f64, b: f64| (a - b).abs() < 8e-3;
                assert!(near(value, weight), "{alpha} {cosine} {into}: {value} {weight}");
                assert!(near(density, drawn), "{alpha} {cosine} {into}: {density} {drawn}");
            }
        }
    }
}

/// What is drawn has the value and the density that evaluation states.
#[test]
fn draws_are_what_evaluation_says() {
    let mut rng = Stream::new(12, 0, 0);
    let mut refracted = 0;
    for i in 0..20_000 {
        let alpha = [1e-3, 0.05, 0.3, 1.0][i % 4];
        let from = direction(COSINES[(i / 4) % 4], 0.3);
        let u = [rng.uniform(), rng.uniform()];
        let surface = glass(alpha, i % 32 < 16);
        // Rounding of the half vector is magnified by 1/α².
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-7 * b.abs();
        if let Some(draw) = surface.sample(from, u, rng.uniform()) {
            let stated = surface.towards(from, draw.direction);
            refracted += u32::from(draw.direction.z < 0.0);
            assert!(near(stated.density, draw.density), "{alpha} {draw:?} {stated:?}");
            assert!(near(stated.value, draw.weight * draw.density), "{alpha} {draw:?} {stated:?}");
            assert!((0.0..=1.0 + 1e-12).contains(&draw.weight));
        }
        if let Some(draw) = metal(alpha).sample(from, u) {
            let stated = metal(alpha).towards(from, draw.direction);
            assert!(near(stated.density, draw.density), "{alpha} {draw:?} {stated:?}");
            assert!(near(stated.value[1], draw.weight[1] * draw.density));
        }
    }
    assert!(refracted > 5000);
}

/// A white furnace: nothing is won, and little is lost where microfacets do not see each other.
#[test]
fn energy_is_lost_by_single_scattering_only() {
    let mut rng = Stream::new(13, 0, 0);
    let n = 20_000;
    let mut albedo = |weight: &dyn Fn([f64; 2], f64) -> f64| {
        let draws = (0..n).map(|_| weight([rng.uniform(), rng.uniform()], rng.uniform()));
        draws.sum::<f64>() / f64::from(n)
    };
    for cosine in COSINES {
        let from = direction(cosine, 0.0);
        let mut before = (1.0, 1.0, 1.0);
        for alpha in [1e-4, 1e-3, 0.05, 0.3, 1.0] {
            let of_metal =
                albedo(&|u, _| metal(alpha).sample(from, u).map_or(0.0, |d| d.weight[0]));
            let weight = |into: bool| {
                move |u, choice| {
                    glass(alpha, into).sample(from, u, choice).map_or(0.0, |d| d.weight)
                }
            };
            let (into, out_of) = (albedo(&weight(true)), albedo(&weight(false)));
            for (now, before) in [(of_metal, before.0), (into, before.1), (out_of, before.2)] {
                assert!(now <= 1.0 + 1e-9 && now < before + 0.02, "{alpha} {cosine}: {now}");
                assert!(now > if alpha < 2e-3 { 0.98 } else { 0.1 }, "{alpha} {cosine}: {now}");
            }
            before = (of_metal, into, out_of);
        }
    }
}

/// The albedo of a perfect metal at normal incidence, by quadrature over normals: light from above
/// is reflected by h into the polar angle 2θ_h, and G2/G1 = 1/(1 + Λ_b·…) with Λ_a = 0.
#[test]
fn albedo_at_normal_incidence_is_that_of_quadrature() {
    for alpha in ALPHAS {
        let n = 400_000;
        let a2 = alpha * alpha;
        let mut sum = 0.0;
        for i in 0..n {
            // sin²θ_h = α² t/(1 − t (1 − α²)) makes D cosθ_h dω uniform in t.
            let t = (f64::from(i) + 0.5) / f64::from(n);
            let sin2 = a2 * t / (1.0 - t * (1.0 - a2));
            let cos_b = 1.0 - 2.0 * sin2;
            if cos_b > 0.0 {
                let tan2 = (1.0 - cos_b * cos_b) / (cos_b * cos_b);
                let lambda = 0.5 * ((1.0 + a2 * tan2).sqrt() - 1.0);
                sum += 1.0 / (1.0 + lambda) / f64::from(n);
            }
        }
        let ours = over_sphere(|to| metal(alpha).towards(DVec3::Z, to).value[0]);
        let tolerance = if alpha < 0.1 { 2e-3 } else { 1e-4 };
        assert!((ours - sum).abs() < tolerance, "{alpha}: {ours} {sum}");
    }
}

#[test]
fn values_are_reciprocal() {
    let mut rng = Stream::new(14, 0, 0);
    let mut draw = || direction(rng.uniform().max(1e-3), 2.0 * PI * rng.uniform());
    for alpha in ALPHAS {
        let (into, out_of) = (glass(alpha, true), glass(alpha, false));
        for _ in 0..1000 {
            let (a, b) = (draw(), draw());
            let near = |x: f64, y: f64| (x - y).abs() <= 1e-7 * (x.abs() + y.abs());
            // f = value/cosine; refracted, f/η² of the side that it goes to is symmetric.
            let forth = metal(alpha).towards(a, b).value[0] / b.z;
            let back = metal(alpha).towards(b, a).value[0] / a.z;
            assert!(near(forth, back) && forth > 0.0);
            let forth = into.towards(a, b).value / b.z;
            assert!(near(forth, into.towards(b, a).value / a.z));
            let forth = into.towards(a, -b).value / b.z / (1.5 * 1.5);
            // Seen from the other side, +z is where b is.
            let turned = |w: DVec3| DVec3::new(w.x, w.y, -w.z);
            let back = out_of.towards(turned(-b), turned(a)).value / a.z;
            assert!(near(forth, back), "{alpha} {a} {b}: {forth} {back}");
        }
    }
}

/// As α falls, directions close around those of smooth glass, and so do their shares.
#[test]
fn small_alphas_tend_to_the_smooth_interface() {
    let mut rng = Stream::new(15, 0, 0);
    for (into, cosine) in [(true, 0.3), (true, 0.9), (false, 0.9)] {
        let from = direction(cosine, 0.0);
        let surface = glass(1e-4, into);
        let smooth = fresnel::dielectric(cosine, surface.eta_before, surface.eta_beyond);
        let ratio = surface.eta_before / surface.eta_beyond;
        let refracted = fresnel::refract(-from, DVec3::Z, ratio, smooth.cos_transmitted);
        let mirrored = fresnel::reflect(-from, DVec3::Z);
        let (n, mut reflected, mut far) = (100_000, 0, 0);
        for _ in 0..n {
            let u = [rng.uniform(), rng.uniform()];
            let draw = surface.sample(from, u, rng.uniform()).expect("no other microfacet is met");
            let expected = if draw.direction.z > 0.0 { mirrored } else { refracted };
            reflected += u32::from(draw.direction.z > 0.0);
            // Tails of the slope fall as its square: 1e-4 of them are beyond 100 α.
            far += u32::from((draw.direction - expected).length() > 0.03);
        }
        let share = f64::from(reflected) / f64::from(n);
        // Standard error at most 1.6e-3; five of them.
        assert!((share - smooth.reflectance).abs() < 8e-3, "{into} {cosine}: {share}");
        assert!(far < 60, "{into} {cosine}: {far}");
    }
}

/// Fresnel's reflectance of metals: gold at normal incidence, and an index without absorption is
/// that of glass.
#[test]
fn metals_reflect_as_fresnel_says() {
    let at_normal =
        |eta: f64, k: f64| ((eta - 1.0).powi(2) + k * k) / ((eta + 1.0).powi(2) + k * k);
    let metal = Metal::Index { eta: Rgb::splat(0.2), k: Rgb::splat(3.4) };
    assert!((metal.reflectance(1.0)[0] - at_normal(0.2, 3.4)).abs() < 1e-14);
    for i in 1..=100 {
        let cosine = f64::from(i) / 100.0;
        for eta in [1.5, 0.7] {
            let glass = fresnel::dielectric(cosine, 1.0, eta).reflectance;
            assert!((fresnel::conductor(cosine, eta, 0.0) - glass).abs() < 1e-7, "{eta} {cosine}");
        }
        assert!((0.0..=1.0).contains(&fresnel::conductor(cosine, 1.3, 7.0)));
    }
    assert!((fresnel::conductor(0.0, 0.2, 3.4) - 1.0).abs() < 1e-12);
}
