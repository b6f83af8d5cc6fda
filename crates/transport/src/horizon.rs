//! What can still arrive in time: the film's window, seen from the light's way.
//!
//! Light at a point x after the OPL t arrives at the eye e after t + η |x − e| at the earliest, η being
//! the least refractive index of the scene, whatever becomes of it on its way: OPL only grows, and no
//! way is shorter than the straight one. If that is after the window's end, nothing of it or its
//! descendants arrives within, and it may be ended without bias. Straight to the eye it arrives by
//! t + η' |x − e|, η' the largest index.
//!
//! Along a segment x(s) = x + s ω both bounds, t + η (s + |x(s) − e|), grow with s (triangle inequality):
//! what of it lies within the window is one interval. s + |x(s) − e| = L is, with p = x − e, the ellipsoid
//!
//! ```text
//! s = (L² − p²)/(2 (L + p·ω)),   L > |p|.
//! ```
//!
//! Estimators that blur find light within a `reach` of where it is, and earlier or later by as much:
//! bounds are that much wider.

use glam::DVec3;
use tpb_scene::Scene;

/// Relative allowance for rounding, here and where arrivals are computed.
const SLACK: f64 = 1e-9;

/// When light must arrive, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Horizon {
    eye: DVec3,
    /// Least and largest refractive index of the scene.
    eta: [f64; 2],
    /// First and last arrival that counts \[m\].
    window: [f64; 2],
    /// How far from its way light may be found \[m\].
    reach: f64,
}

impl Horizon {
    /// For arrivals within `window` \[m\], by estimators that find light within `reach` \[m\] of its
    /// way.
    pub fn new(scene: &Scene, window: [f64; 2], reach: f64) -> Self {
        let interfaces = scene.shapes.iter().filter_map(|shape| shape.bsdf.interface());
        let interfaces = interfaces.map(|glass| [glass.interior_eta, glass.exterior_eta]);
        let emitters = scene.emitters.iter().map(|emitter| emitter.region.eta);
        let all = interfaces.flatten().chain(emitters).chain([1.0, scene.sensor.region.eta]);
        let eta = all.fold([f64::INFINITY, 0.0], |[least, most], eta| {
            [f64::min(least, eta), f64::max(most, eta)]
        });
        Self { eye: scene.sensor.position, eta, window, reach }
    }

    /// Whether nothing of the light at `position` after `opl` can arrive before the window ends.
    #[inline]
    pub fn is_late(&self, position: DVec3, opl: f64) -> bool {
        let [least, most] = self.eta;
        let distance = (position - self.eye).length();
        let earliest = opl + least * (distance - self.reach) - most * self.reach;
        earliest > self.window[1] + SLACK * (opl + most * distance)
    }

    /// Whether a camera path can see nothing that arrives in time, `opl` from the eye, and `distance`
    /// at least from where the light comes from.
    #[inline]
    pub fn is_beyond(&self, opl: f64, distance: f64) -> bool {
        let [least, most] = self.eta;
        let earliest = opl + least * distance - 2.0 * most * self.reach;
        earliest > self.window[1] + SLACK * (opl + most * distance)
    }

    /// Whether the light at `position` after `opl` arrives before the window starts, if it goes
    /// straight to the eye.
    #[inline]
    pub fn is_early(&self, position: DVec3, opl: f64) -> bool {
        let distance = (position - self.eye).length();
        let latest = opl + self.eta[1] * (distance + 2.0 * self.reach);
        latest + SLACK * latest.abs() < self.window[0]
    }

    /// From where to where a segment \[m\] of some length, from `origin` on after `opl`, sends light
    /// that may arrive within the window if it goes straight to the eye; `None` if nowhere.
    #[inline]
    pub fn seen(
        &self,
        (origin, direction): (DVec3, DVec3),
        length: f64,
        opl: f64,
    ) -> Option<[f64; 2]> {
        let [least, most] = self.eta;
        let from_eye = origin - self.eye;
        let (distance, along) = (from_eye.length(), from_eye.dot(direction));
        let on_ellipsoid = |way: f64| (way - distance) * (way + distance) / (2.0 * (way + along));
        let rounding = SLACK * (distance + length + opl / least);
        let late = (self.window[1] - opl) / least + 2.0 * most / least * self.reach + rounding;
        if late <= distance {
            return None;
        }
        let early = (self.window[0] - opl) / most - 2.0 * self.reach - rounding;
        let first = if early > distance { on_ellipsoid(early) } else { 0.0 };
        let last = on_ellipsoid(late).min(length);
        (first < last).then_some([first, last])
    }
}

#[cfg(test)]
mod tests;
