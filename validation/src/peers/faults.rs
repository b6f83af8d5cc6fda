//! What mitransient 1.3.1 is known to get wrong, by what a scene has: measured or read in its
//! sources, and said beside its numbers. What makes a comparison meaningless is refused in
//! [`super::translate`].

use tpb_scene::{EmitterKind, Plan, Scene, Transport};

/// The faults that concern this scene, one line each.
pub fn known(scene: &Scene) -> Vec<String> {
    let plan = Plan::new(scene, &scene.integrator);
    let mut faults = Vec::new();
    if scene.sensor.region.medium.is_some() {
        faults.push(
            "camera inside a medium: it starts in vacuum there, what scatters before the first \
             boundary is missing"
                .to_owned(),
        );
    }
    let pointed =
        |kind: &EmitterKind| matches!(kind, EmitterKind::Point { .. } | EmitterKind::Spot { .. });
    let specular = !(plan.mirrors.is_empty() && plan.refracting.is_empty());
    if specular && scene.emitters.iter().any(|emitter| pointed(&emitter.kind)) {
        faults.push("caustics of point and spot lamps are missing, without a warning".to_owned());
    }
    let coloured = |sigma_t: tpb_optics::Rgb| !sigma_t.is_achromatic();
    if plan.transport == Transport::Rgb
        && scene.media.iter().any(|medium| coloured(medium.coefficients.sigma_t))
    {
        faults.push(
            "coloured media: each path samples its flights by one channel, without weights that \
             combine the channels: noise, not bias"
                .to_owned(),
        );
    }
    faults.push("energy outside the window is dropped from its cube".to_owned());
    faults
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::scenes::shipped;

    fn faults(name: &str) -> String {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
        known(&shipped(&path).unwrap().scene).join("\n")
    }

    #[test]
    fn faults_are_those_of_what_the_scene_has() {
        let all = ["camera inside", "caustics", "coloured media", "outside the window"];
        for (scene, expected) in [
            ("scenes/cornell-blocks.json", [false, false, false, true]),
            ("scenes/mirror-caustic.json", [false, false, false, true]),
            ("scenes/mirror-caustic-point.json", [false, true, false, true]),
            ("scenes/infinite-point.json", [true, false, false, true]),
            ("../scenes/fog-only.json", [false, false, true, true]),
        ] {
            let found = faults(scene);
            assert_eq!(all.map(|fault| found.contains(fault)), expected, "{scene}: {found}");
        }
    }
}
