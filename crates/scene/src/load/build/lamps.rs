//! Emitters that are no shapes.

use glam::DVec3;

use super::Builder;
use super::shapes::within_limits;
use crate::description as words;
use crate::load::transform;
use crate::load::tree::{Member, Node};
use crate::load::trouble::{Outcome, Trouble};
use crate::{EmitterKind, EmitterPart};

impl<'a> Builder<'a> {
    /// An emitter with its placement, and the medium that it names.
    pub(super) fn emitter(
        &mut self,
        emitter: &words::Emitter,
        member: &'a Member,
    ) -> Outcome<EmitterPart> {
        let node = &member.value;
        let (kind, medium) = match emitter {
            words::Emitter::Point(lamp) => (point(lamp, node)?, &lamp.medium),
            words::Emitter::Spot(lamp) => (spot(lamp, node)?, &lamp.medium),
            words::Emitter::Directional(lamp) => (directional(lamp, node)?, &None),
            words::Emitter::Laser(lamp) => (laser(lamp, node)?, &lamp.medium),
        };
        let stated_medium = medium
            .as_ref()
            .map(|medium| {
                let name = || format!("{}.medium", member.key);
                self.medium(medium, node.get_or_self("medium"), name)
            })
            .transpose()?;
        Ok(EmitterPart { name: member.key.clone(), kind, stated_medium })
    }
}

fn point(lamp: &words::Point, node: &Node) -> Outcome<EmitterKind> {
    let position = match (lamp.position, &lamp.to_world) {
        (Some(position), None) => DVec3::from(position),
        (None, Some(steps)) => {
            transform::to_affine(steps, node.get_or_self("to_world"))?.translation
        }
        (None, None) => DVec3::ZERO,
        (Some(_), Some(_)) => {
            return Err(Trouble::new("`position` and `to_world` exclude each other")
                .at(node.get_or_self("to_world")));
        }
    };
    within_limits(&[position], &[], node)?;
    Ok(EmitterKind::Point { position, intensity: lamp.intensity.rgb() })
}

fn spot(lamp: &words::Spot, node: &Node) -> Outcome<EmitterKind> {
    let (position, axis) = placed(&lamp.to_world, node)?;
    let cutoff = lamp.cutoff_angle.get();
    let beam = lamp.beam_width.map_or(0.75 * cutoff, words::NonNegative::get);
    if beam > cutoff {
        return Err(Trouble::new(format!("`beam_width` {beam} exceeds `cutoff_angle` {cutoff}"))
            .at(node.get_or_self("beam_width"))
            .hint("both are angles from the axis in degrees; the light falls off in between"));
    }
    Ok(EmitterKind::Spot {
        position,
        axis,
        intensity: lamp.intensity.rgb(),
        cos_cutoff: cutoff.to_radians().cos(),
        cos_beam: beam.to_radians().cos(),
    })
}

fn directional(lamp: &words::Directional, node: &Node) -> Outcome<EmitterKind> {
    let axis = match (lamp.direction, &lamp.to_world) {
        (None, None) => DVec3::Z,
        (Some(direction), None) => DVec3::from(direction).try_normalize().ok_or_else(|| {
            Trouble::new("`direction` has no length").at(node.get_or_self("direction"))
        })?,
        (None, Some(steps)) => placed(steps, node)?.1,
        (Some(_), Some(_)) => {
            return Err(Trouble::new("`direction` and `to_world` exclude each other")
                .at(node.get_or_self("to_world")));
        }
    };
    let irradiance = lamp.irradiance.rgb();
    // Its disc is found when all shapes are known.
    Ok(EmitterKind::Directional { axis, irradiance, position: DVec3::ZERO, radius: 0.0 })
}

fn laser(lamp: &words::Laser, node: &Node) -> Outcome<EmitterKind> {
    let (position, axis) = placed(&lamp.to_world, node)?;
    let radius = lamp.radius.get();
    within_limits(&[], &[radius], node.get_or_self("radius"))?;
    Ok(EmitterKind::Laser { position, axis, radius, power: lamp.power.rgb() })
}

/// Where the local origin and the local +z axis go.
fn placed(steps: &words::Transform, node: &Node) -> Outcome<(DVec3, DVec3)> {
    let place = node.get_or_self("to_world");
    let to_world = transform::to_rigid(steps, place)?;
    within_limits(&[to_world.translation], &[], place)?;
    Ok((to_world.translation, to_world.transform_vector3(DVec3::Z).normalize()))
}
