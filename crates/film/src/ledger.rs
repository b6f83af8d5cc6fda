//! Where the light went: an energy balance of one render.
//!
//! emitted = absorbed in media + absorbed on surfaces + escaped + cut by depth + cut by window
//!         + (lost − gained by Russian roulette),
//!
//! all weighted to luminance: of light in watts (joules for pulses), where light is traced, or of
//! importance in camera paths, where paths start at the camera. Whoever traces fills it; [`Ledger::closure`] says how well it closes, 1e-9 being the aim.

use serde::{Deserialize, Serialize};

/// The balance; all entries are luminance-weighted, and of the same unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ledger {
    /// What the emitters gave.
    pub emitted: f64,
    /// Absorbed on the way through media.
    pub absorbed_in_media: f64,
    /// Absorbed by surfaces.
    pub absorbed_on_surfaces: f64,
    /// Left the scene.
    pub escaped: f64,
    /// Still alive when the depth limit ended its path.
    pub cut_by_depth: f64,
    /// Still alive when nothing of its path could arrive within the window any more; 0 where what
    /// arrives outside is kept.
    #[serde(default)]
    pub cut_by_window: f64,
    /// Of paths that Russian roulette ended.
    pub roulette_lost: f64,
    /// Added to paths that survived Russian roulette.
    pub roulette_gained: f64,
}

impl Ledger {
    /// Adds another balance, entry by entry.
    pub fn add(&mut self, other: &Self) {
        self.emitted += other.emitted;
        self.absorbed_in_media += other.absorbed_in_media;
        self.absorbed_on_surfaces += other.absorbed_on_surfaces;
        self.escaped += other.escaped;
        self.cut_by_depth += other.cut_by_depth;
        self.cut_by_window += other.cut_by_window;
        self.roulette_lost += other.roulette_lost;
        self.roulette_gained += other.roulette_gained;
    }

    /// The mean over so many balances that were added.
    #[must_use]
    pub fn mean(&self, count: u64) -> Self {
        let count = count.max(1) as f64;
        Self {
            emitted: self.emitted / count,
            absorbed_in_media: self.absorbed_in_media / count,
            absorbed_on_surfaces: self.absorbed_on_surfaces / count,
            escaped: self.escaped / count,
            cut_by_depth: self.cut_by_depth / count,
            cut_by_window: self.cut_by_window / count,
            roulette_lost: self.roulette_lost / count,
            roulette_gained: self.roulette_gained / count,
        }
    }

    /// Relative imbalance, (emitted − accounted for)/emitted; with nothing emitted, 0 if nothing
    /// is accounted for and infinite otherwise.
    pub fn closure(&self) -> f64 {
        let ended = self.absorbed_in_media
            + self.absorbed_on_surfaces
            + self.escaped
            + self.cut_by_depth
            + self.cut_by_window
            + (self.roulette_lost - self.roulette_gained);
        let gap = self.emitted - ended;
        if gap == 0.0 { 0.0 } else { gap / self.emitted }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_balance_closes_whatever_entry_the_light_went_to() {
        let mut sum = Ledger::default();
        for part in [
            Ledger { emitted: 4.0, absorbed_in_media: 3.0, escaped: 1.0, ..Ledger::default() },
            Ledger { emitted: 2.0, absorbed_on_surfaces: 2.5, roulette_gained: 0.5, ..sum },
            Ledger { emitted: 1.0, cut_by_depth: 0.25, roulette_lost: 0.75, ..sum },
            Ledger { emitted: 1.0, cut_by_window: 0.75, escaped: 0.25, ..sum },
        ] {
            assert!(part.closure() == 0.0, "{part:?}");
            sum.add(&part);
        }
        assert!(sum.emitted == 8.0 && sum.closure() == 0.0, "{sum:?}");
        let mean = sum.mean(2);
        assert!(mean.emitted == 4.0 && mean.closure() == 0.0, "{mean:?}");
        sum.escaped += 0.8;
        assert!((sum.closure() + 0.1).abs() < 1e-15, "light from nowhere shows");
        let nothing_emitted = Ledger { escaped: 1.0, ..Ledger::default() };
        assert!(nothing_emitted.closure().is_infinite());
    }

    #[test]
    fn it_survives_json() {
        let ledger = Ledger { emitted: 0.1, escaped: 0.3, ..Ledger::default() };
        let text = serde_json::to_string(&ledger).unwrap();
        assert_eq!(serde_json::from_str::<Ledger>(&text).unwrap(), ledger);
    }
}
