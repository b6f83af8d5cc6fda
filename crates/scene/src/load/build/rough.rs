//! Rough metal and rough glass.

use tpb_optics::microfacet::{Ggx, Metal, RoughConductor};

use crate::description::{self as words, Colour, Roughness};
use crate::load::tree::Node;
use crate::load::trouble::{Outcome, Trouble};
use crate::{Bsdf, Dielectric, RoughMetal};

/// Indices of rough glass must differ by more than this part: nearer ones bend light by less than
/// rounding tells.
const LEAST_DIFFERENCE: f64 = 1e-4;

pub(super) fn metal(c: &words::RoughConductor, node: &Node) -> Outcome<RoughMetal> {
    let metal = match (c.material, c.eta, c.k) {
        (Some(words::Metal::None), None, None) => Metal::Perfect,
        (None, Some(eta), Some(k)) => Metal::Index { eta: eta.rgb(), k: k.rgb() },
        _ => {
            return Err(Trouble::new("what is this metal made of?").at(node).hint(
                "write `eta` and `k`, its refractive index, or `\"material\": \"none\"` for one that \
                 reflects everything",
            ));
        }
    };
    let ggx = microfacets([c.alpha, c.alpha_u, c.alpha_v], node)?;
    let surface = RoughConductor { ggx, metal };
    Ok(RoughMetal { surface, reflectance: Colour::rgb(c.specular_reflectance) })
}

pub(super) fn glass(d: &words::RoughDielectric, node: &Node) -> Outcome<Bsdf> {
    let ggx = microfacets([d.alpha, d.alpha_u, d.alpha_v], node)?;
    let (interior_eta, exterior_eta) = (d.int_ior.get(), d.ext_ior.get());
    if (interior_eta / exterior_eta - 1.0).abs() < LEAST_DIFFERENCE {
        return Err(Trouble::new("rough glass needs two refractive indices that differ")
            .at(node.get_or_self("int_ior"))
            .hint("use `null` between equal ones, `dielectric` between nearly equal ones"));
    }
    let glass = Dielectric {
        interior_eta,
        exterior_eta,
        reflectance: d.specular_reflectance.rgb(),
        transmittance: d.specular_transmittance.rgb(),
    };
    Ok(Bsdf::RoughDielectric(glass, ggx))
}

/// From `alpha`, or `alpha_u` and `alpha_v`.
fn microfacets([both, u, v]: [Option<Roughness>; 3], node: &Node) -> Outcome<Ggx> {
    let alpha = match (both, u, v) {
        (both, None, None) => both.unwrap_or(Roughness::MITSUBA),
        (None, Some(u), Some(v)) if u == v => u,
        (None, Some(_), Some(_)) => {
            return Err(Trouble::new(
                "`alpha_u` and `alpha_v` differ: brushed surfaces are not supported",
            )
            .at(node.get_or_self("alpha_v")));
        }
        _ => {
            return Err(
                Trouble::new("the roughness is `alpha`, or `alpha_u` and `alpha_v`").at(node)
            );
        }
    };
    Ok(Ggx::new(alpha.get()))
}
