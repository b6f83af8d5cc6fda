//! BSDFs, phase functions and media.

use tpb_optics::{Coefficients, Phase, Rgb};

use super::{Builder, rough};
use crate::description::{self as words, Homogeneous, Kind, Reference};
use crate::load::dictionary::Object;
use crate::load::tree::Node;
use crate::load::trouble::{Outcome, Trouble};
use crate::texture::Coordinates;
use crate::{Bsdf, Dielectric, Medium, MediumId, Reflector};

/// A BSDF, before it is known on which side of which surface it acts.
enum Surface {
    Passes(Bsdf),
    Reflects(Reflector),
    Twosided(Bsdf),
}

/// What is known on the way to a BSDF.
struct Way<'w> {
    /// The entries that references have led through.
    entries: Vec<usize>,
    /// Texture coordinates of the shape that it is for.
    coordinates: Option<&'w Coordinates>,
}

impl<'a> Builder<'a> {
    /// The material of a shape with these texture coordinates, or one that no shape has yet.
    pub(super) fn bsdf(
        &mut self,
        bsdf: &words::Bsdf,
        node: &Node,
        coordinates: Option<&Coordinates>,
    ) -> Outcome<Bsdf> {
        Ok(match self.surface(bsdf, node, &mut Way { entries: Vec::new(), coordinates })? {
            Surface::Passes(bsdf) | Surface::Twosided(bsdf) => bsdf,
            Surface::Reflects(front) => Bsdf::Opaque { front, back: Reflector::Black },
        })
    }

    fn surface(&mut self, bsdf: &words::Bsdf, node: &Node, way: &mut Way) -> Outcome<Surface> {
        Ok(match bsdf {
            words::Bsdf::Diffuse(d) => {
                let place = node.get_or_self("reflectance");
                Surface::Reflects(self.diffuse(&d.reflectance, place, way.coordinates)?)
            }
            words::Bsdf::Conductor(c) => {
                Surface::Reflects(Reflector::Mirror(c.specular_reflectance.rgb()))
            }
            words::Bsdf::Dielectric(d) => Surface::Passes(Bsdf::Dielectric(Dielectric {
                interior_eta: d.int_ior.get(),
                exterior_eta: d.ext_ior.get(),
                reflectance: d.specular_reflectance.rgb(),
                transmittance: d.specular_transmittance.rgb(),
            })),
            words::Bsdf::Roughconductor(c) => {
                Surface::Reflects(Reflector::Rough(rough::metal(c, node)?))
            }
            words::Bsdf::Roughdielectric(d) => Surface::Passes(rough::glass(d, node)?),
            words::Bsdf::Thindielectric(d) => Surface::Passes(Bsdf::ThinDielectric(Dielectric {
                interior_eta: d.int_ior.get(),
                exterior_eta: d.ext_ior.get(),
                reflectance: d.specular_reflectance.rgb(),
                transmittance: d.specular_transmittance.rgb(),
            })),
            words::Bsdf::Null(_) => Surface::Passes(Bsdf::Null),
            words::Bsdf::Twosided(sides) => {
                let front = self.side(&sides.bsdf, node.get_or_self("bsdf"), way)?;
                let back = match &sides.back {
                    Some(back) => self.side(back, node.get_or_self("back"), way)?,
                    None => front,
                };
                Surface::Twosided(Bsdf::Opaque { front, back })
            }
            words::Bsdf::Ref(reference) => return self.referenced_surface(reference, node, way),
        })
    }

    fn referenced_surface(
        &mut self,
        reference: &Reference,
        node: &Node,
        way: &mut Way,
    ) -> Outcome<Surface> {
        let dictionary = self.dictionary;
        let index = dictionary.index(reference, node, Kind::Bsdf)?;
        if way.entries.contains(&index) {
            return Err(Trouble::new(format!("`{}` refers to itself", reference.id))
                .at(node.get_or_self("id"))
                .hint("a chain of references must end at a BSDF that has none"));
        }
        let entry = &dictionary.entries[index];
        let Object::Bsdf(bsdf) = &entry.object else {
            return Err(Trouble::new(format!("`{}` is not a BSDF", reference.id)).at(node));
        };
        way.entries.push(index);
        let surface = self.surface(bsdf, &entry.member.value, way)?;
        way.entries.pop();
        Ok(surface)
    }

    /// One side of a `twosided`.
    fn side(&mut self, bsdf: &words::Bsdf, node: &Node, way: &mut Way) -> Outcome<Reflector> {
        match self.surface(bsdf, node, way)? {
            Surface::Reflects(reflector) => Ok(reflector),
            Surface::Passes(_) | Surface::Twosided(_) => {
                let opaque = "`diffuse`, `conductor` and `roughconductor`";
                Err(Trouble::new(format!("`twosided` can hold only {opaque}"))
                    .at(node)
                    .hint("all others act on both sides without it"))
            }
        }
    }

    /// A medium; `name` is used if it has no id of its own.
    pub(super) fn medium(
        &mut self,
        medium: &words::Medium,
        node: &'a Node,
        name: impl FnOnce() -> String,
    ) -> Outcome<MediumId> {
        let reference = match medium {
            words::Medium::Homogeneous(inline) => {
                let built = self.homogeneous(inline, node, name())?;
                return self.add_medium(built, node);
            }
            words::Medium::Ref(reference) => reference,
        };
        let index = self.dictionary.index(reference, node, Kind::Medium)?;
        if let Some(&known) = self.shared_media.get(&index) {
            return Ok(known);
        }
        let member = self.dictionary.entries[index].member;
        match &self.dictionary.entries[index].object {
            Object::Medium(words::Medium::Homogeneous(shared)) => {
                let built = self.homogeneous(shared, &member.value, member.key.clone())?;
                let id = self.add_medium(built, &member.value)?;
                self.shared_media.insert(index, id);
                Ok(id)
            }
            _ => Err(Trouble::new(format!("`{}` is not a medium", reference.id)).at(node)),
        }
    }

    fn add_medium(&mut self, medium: Medium, node: &'a Node) -> Outcome<MediumId> {
        let without =
            || Trouble::new("this program was built without media (feature `vacuum`)").at(node);
        let id = MediumId::of_index(self.media.len()).ok_or_else(without)?;
        self.media.push(medium);
        self.medium_nodes.push(node);
        Ok(id)
    }

    fn homogeneous(&self, medium: &Homogeneous, node: &Node, name: String) -> Outcome<Medium> {
        Ok(Medium {
            name,
            coefficients: coefficients(medium, node)?,
            phase: match &medium.phase {
                Some(phase) => self.phase(phase, node.get_or_self("phase"))?,
                None => Phase::Isotropic,
            },
            eta: medium.eta.map(words::Index::get),
        })
    }

    fn phase(&self, phase: &words::Phase, node: &Node) -> Outcome<Phase> {
        match phase {
            words::Phase::Isotropic(_) => Ok(Phase::Isotropic),
            words::Phase::Hg(hg) => Ok(Phase::with_mean_cosine(hg.g.get())),
            words::Phase::Ref(reference) => {
                let index = self.dictionary.index(reference, node, Kind::Phase)?;
                match &self.dictionary.entries[index].object {
                    Object::Phase(phase @ (words::Phase::Isotropic(_) | words::Phase::Hg(_))) => {
                        self.phase(phase, node)
                    }
                    _ => Err(Trouble::new("this is not a phase function").at(node)),
                }
            }
        }
    }

    /// BSDFs and media that nothing uses are to be right as well.
    pub(super) fn check_shared_materials(&mut self) -> Outcome<()> {
        let dictionary = self.dictionary;
        for entry in &dictionary.entries {
            let node = &entry.member.value;
            match &entry.object {
                Object::Bsdf(bsdf) => drop(self.bsdf(bsdf, node, None)?),
                Object::Medium(words::Medium::Homogeneous(medium)) => {
                    self.homogeneous(medium, node, String::new())?;
                }
                _ => {}
            }
        }
        Ok(())
    }
}

/// Coefficients must not exceed this \[1/m\], so that optical depths and their squares stay finite.
const LARGEST_SIGMA: f64 = 1e100;

/// Nor be below this \[1/m\], so that mean free paths and the lengths of beams do.
const SMALLEST_SIGMA: f64 = 1e-100;

/// sigma_t and albedo, or sigma_s and sigma_a; with the scale.
fn coefficients(medium: &Homogeneous, node: &Node) -> Outcome<Coefficients<3>> {
    let (sigma_s, sigma_t) = match (medium.sigma_s, medium.sigma_a) {
        (None, None) => {
            let sigma_t = medium.sigma_t.map_or(Rgb::ONE, words::Colour::rgb);
            let albedo = medium.albedo.map_or(Rgb::splat(0.75), words::Colour::rgb);
            (sigma_t * albedo, sigma_t)
        }
        (Some(scattering), Some(absorption)) => {
            if let Some(member) = node.member("sigma_t").or_else(|| node.member("albedo")) {
                let message = format!("`{}` contradicts `sigma_s` and `sigma_a`", member.key);
                return Err(Trouble::new(message).at_key(member).hint(TWO_WAYS));
            }
            (scattering.rgb(), scattering.rgb() + absorption.rgb())
        }
        (Some(_), None) => return Err(incomplete(node, "sigma_s", "sigma_a")),
        (None, Some(_)) => return Err(incomplete(node, "sigma_a", "sigma_s")),
    };
    let scale = medium.scale.get();
    let coefficients = Coefficients { sigma_s: sigma_s * scale, sigma_t: sigma_t * scale };
    let sound = |sigma: &f64| *sigma == 0.0 || (SMALLEST_SIGMA..=LARGEST_SIGMA).contains(sigma);
    let Coefficients { sigma_s, sigma_t } = coefficients;
    if !sigma_s.0.iter().chain(&sigma_t.0).all(sound) {
        let message = format!(
            "a coefficient of this medium is neither 0 nor between {SMALLEST_SIGMA:e} and \
             {LARGEST_SIGMA:e} per metre"
        );
        return Err(Trouble::new(message).at(node).hint("lengths are in metres"));
    }
    Ok(coefficients)
}

const TWO_WAYS: &str = "write `sigma_t` and `albedo`, or `sigma_s` and `sigma_a`";

fn incomplete(node: &Node, given: &str, missing: &str) -> Trouble {
    let trouble = Trouble::new(format!("`{given}` is given without `{missing}`")).hint(TWO_WAYS);
    match node.member(given) {
        Some(member) => trouble.at_key(member),
        None => trouble.at(node),
    }
}
