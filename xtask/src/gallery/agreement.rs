//! `cargo xtask gallery --agreement`: what is compared, and what is told of it.

use tpb_validation::gallery::GalleryScene;
use tpb_validation::gallery::agreement::{Agreement, Terms, agreements};
use tpb_validation::measure::BatchPlan;
use tpb_validation::statistics::Finding;

use super::load;
use crate::workspace::{Outcome, say};

/// Columns of the film by which methods are compared.
const COLUMNS: u32 = 48;
/// What blur may take or give of a block's energy.
const BLUR: f64 = 0.02;
/// What else is too small to matter.
const MARGIN: f64 = 0.02;

/// Compares the methods on each scene; whether none disagrees.
pub(super) fn compare<'a>(scenes: impl Iterator<Item = &'a GalleryScene>, passes: u64) -> Outcome {
    let plan = BatchPlan { batches: 32, passes, seed: 1 };
    let terms = Terms { plan, blur: BLUR, margin: MARGIN };
    let mut agree = true;
    for scene in scenes {
        for found in agreements(&load(scene, Some(COLUMNS))?, &load(scene, None)?, &terms)? {
            agree &= tell(&scene.name, &found);
        }
    }
    Ok(agree)
}

/// Prints what was found; whether it is no disagreement.
fn tell(name: &str, found: &Agreement) -> bool {
    let Agreement { method, judged, .. } = found;
    let judgement = match &found.found {
        Err(reason) => {
            say(&format!("{name}: beams, {method}: not compared, {reason}"));
            return true;
        }
        Ok(judgement) => judgement,
    };
    let [low, high] = judgement.interval.map(|end| 100.0 * end);
    let verdict = match judgement.finding {
        Finding::Equivalent => "equivalent",
        Finding::Unresolved => "no difference seen, not all resolved",
        Finding::Different => "DIFFERENT",
    };
    say(&format!(
        "{name}: beams, {method}: {verdict} on {:.0} % of the pixels; widest interval \
         [{low:+.1} %, {high:+.1} %], worst p {:.1e}",
        100.0 * judged,
        judgement.worst_p
    ));
    for contrast in &judgement.contrasts {
        let [low, high] = contrast.interval.map(|end| 100.0 * end);
        let mark = if contrast.adjusted_p <= judgement.false_alarm { "  <-" } else { "" };
        say(&format!(
            "  {:<26} {:.4e} (beams {:.4e}) [{low:+.1} %, {high:+.1} %]{mark}",
            contrast.name, contrast.expected, contrast.mean
        ));
    }
    judgement.finding != Finding::Different
}
