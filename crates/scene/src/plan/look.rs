//! What a scene has that a plan depends on.

use tpb_optics::microfacet::Metal;
use tpb_optics::{Coefficients, Rgb};

use super::{Kernel, Media};
use crate::{Bsdf, EmitterKind, Reflector, Region, RoughMetal, Scene, Shape, Texture};

pub(super) fn media(scene: &Scene) -> Media {
    let scatters = scene.media.iter().any(|m| m.coefficients.scatters());
    let takes = scene.media.iter().any(|m| !m.coefficients.sigma_t.is_zero());
    match (scatters, takes) {
        (true, _) => Media::Scattering,
        (false, true) => Media::Absorbing,
        (false, false) => Media::None,
    }
}

pub(super) fn is_chromatic(scene: &Scene) -> bool {
    let media = scene.media.iter().flat_map(|m| [m.coefficients.sigma_s, m.coefficients.sigma_t]);
    let surfaces = scene.shapes.iter().flat_map(|s| s.bsdf.factors());
    let emitters = scene.emitters.iter().map(|e| e.kind.color());
    let plain = |c: Rgb| c.is_achromatic();
    !(media.chain(surfaces).chain(emitters).all(plain)
        && scene.textures.iter().all(Texture::is_achromatic))
}

/// Whether an emitter of some area gives light.
pub(super) fn has_lamps(scene: &Scene) -> bool {
    !emitters(scene, |kind| matches!(kind, EmitterKind::Area { .. })).is_empty()
}

/// Names of the emitters of some kind that give light.
pub(super) fn emitters(scene: &Scene, wanted: impl Fn(&EmitterKind) -> bool) -> Vec<String> {
    let found = scene.emitters.iter().filter(|e| wanted(&e.kind) && !e.kind.power().is_zero());
    found.map(|e| e.name.clone()).collect()
}

/// Reflectances and albedos that take nothing from some channel, and light that starts within the
/// denser side of glass: what is reflected there totally, may be so for ever. (Light that enters
/// from outside leaves again, for almost all its directions: flight between reflections keeps the
/// measure of places and directions, so that what came in by a way gets back to it.)
pub(super) fn endless(scene: &Scene) -> Vec<String> {
    let mut reasons = Vec::new();
    for shape in &scene.shapes {
        let Bsdf::Opaque { front, back } = shape.bsdf else { continue };
        let full = [front, back].iter().any(|side| match side {
            Reflector::Black => false,
            Reflector::Diffuse(_) | Reflector::Textured(_) | Reflector::Mirror(_) => {
                side.most_reflectance(&scene.textures).max_channel() >= 1.0
            }
            // Real metals absorb.
            Reflector::Rough(RoughMetal { surface, reflectance }) => {
                surface.metal == Metal::Perfect && reflectance.max_channel() >= 1.0
            }
        });
        if full {
            reasons.push(format!("shape '{}' reflects all light of a channel", shape.name));
        }
    }
    for medium in &scene.media {
        let Coefficients { sigma_s, sigma_t } = medium.coefficients;
        if (0..3).any(|c| sigma_t[c] > 0.0 && sigma_s[c] >= sigma_t[c]) {
            reasons
                .push(format!("medium '{}' absorbs nothing of a channel (albedo 1)", medium.name));
        }
    }
    reasons.extend(scene.shapes.iter().filter_map(|shape| trap(scene, shape)));
    reasons
}

/// Whether the camera or an emitter stands where this shape is the way out of something denser that
/// takes nothing of some channel.
fn trap(scene: &Scene, shape: &Shape) -> Option<String> {
    let Bsdf::Dielectric(glass) = shape.bsdf else { return None };
    if glass.interior_eta == glass.exterior_eta || glass.reflectance.max_channel() < 1.0 {
        return None;
    }
    let denser = glass.interior_eta.max(glass.exterior_eta);
    let takes = |region: Region| {
        let medium = region.medium.map(|id| scene.medium(id).coefficients);
        medium.is_some_and(|c| (0..3).all(|i| c.sigma_t[i] > c.sigma_s[i]))
    };
    let inside = |region: Region| region.eta == denser && !takes(region);
    let lamps = scene.emitters.iter().filter(|e| !e.kind.power().is_zero());
    let lamp = lamps.into_iter().find(|e| inside(e.region)).map(|e| format!("'{}'", e.name));
    let who = lamp.or_else(|| inside(scene.sensor.region).then(|| "the camera".to_owned()))?;
    let name = &shape.name;
    Some(format!("shape '{name}' may totally reflect light for ever: {who} is on its denser side"))
}

/// Collimated light along which the camera looks (either way) needs the 2D kernel.
pub(super) fn kernel(scene: &Scene) -> Kernel {
    let (w, h) = (scene.film.width as f64, scene.film.height as f64);
    let forward = scene.sensor.forward();
    // The cone around the view axis through the film's corners.
    let cos_corner = [(0.0, 0.0), (w, 0.0), (0.0, h), (w, h)]
        .map(|(x, y)| scene.sensor.direction(x, y).dot(forward))
        .into_iter()
        .fold(1.0, f64::min);
    let along_view = scene.emitters.iter().any(|e| match e.kind {
        EmitterKind::Laser { axis, .. } | EmitterKind::Directional { axis, .. } => {
            axis.dot(forward).abs() >= cos_corner
        }
        _ => false,
    });
    if along_view { Kernel::TwoD } else { Kernel::OneD }
}
