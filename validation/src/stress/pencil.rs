//! A laser far thinner than the kernel, seen by a telescope: beams from every side, with radii from
//! 1e-7 of the scene to ten times the scene.
//!
//! The laser's axis passes the origin under the angle ψ to the view, after one unit of length; the
//! camera stands one unit before the origin and looks at it. Eight pixels, one above the other,
//! cover four radii (or a fixed small angle, where the radius is large), so that half of the rays
//! meet the beam however thin it is. A pixel's exact value is the mean of the reference's pair of one
//! beam and one ray (`beam_ray_1d`,
//! `beam_ray_2d_bins`, `beam_ray_3d_bins`) over the pixel.
//!
//! Light of lasers cannot be found by paths from the camera: `path` takes no part. To `light` the
//! beam has no width but the laser's: all that it sees lies within one row, but across the beam it
//! adds up to what a 1D kernel that the film holds whole adds up to.

use serde_json::json;
use tpb_reference::beams::beam_ray::{BeamRay1d, BeamRay2dBin, beam_ray_1d, beam_ray_2d_bins};
use tpb_reference::beams::beam_ray_sphere::{BeamRay3dBin, beam_ray_3d_bins};

use crate::contrasts::LinearContrast;
use crate::error::Result;
use crate::stress::case::{Finding, Method, Work};
use crate::stress::laws::{Expected, agrees};
use crate::stress::shot::Shot;
use crate::stress::world::{Film, Fog, Point, Unit, World};

/// Why `path` is left out.
pub const NO_PATH: &str = "no path from the camera finds a laser's light (the plan says so)";

/// Rows of pixels.
const ROWS: usize = 8;
/// Midpoints along a row's height, and along its width: of spread arrivals, and of instants, which
/// bins cut anywhere.
const NODES: (usize, usize) = (64, 6);
const NODES_OF_INSTANTS: (usize, usize) = (64, 200);
/// Error of that rule: the kernel's edge lies on the pixels' to second order in the radius.
const RULE_ERROR: f64 = 1e-3;
/// No light is left in f64 beyond this optical depth.
const LONG: f64 = 745.0;
/// The one sum that all methods agree on.
const ALL_LIGHT: &str = "all light";
/// Bins of the window.
const BINS: usize = 4;

/// A pencil of light and a telescope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pencil {
    /// What its numbers are measured in.
    pub unit: Unit,
    /// The fog, per unit of length.
    pub fog: Fog,
    /// Angle between the light's direction and the view's \[rad\]: 0 along, π against.
    pub psi: f64,
    /// Radius of the kernel.
    pub radius: f64,
    /// Power of the laser.
    pub power: f64,
}

impl Pencil {
    /// Across the view, thin fog.
    pub const USUAL: Self = Self {
        unit: Unit::SI,
        fog: Fog { sigma_s: [0.4; 3], sigma_a: [0.1; 3], g: 0.0 },
        psi: std::f64::consts::FRAC_PI_2,
        radius: 1e-3,
        power: 1.0,
    };

    /// Renders and compares; exact values are multiplied by `factor` (1, but for sabotage).
    pub fn agrees(&self, method: Method, seed: u64, factor: f64) -> Result<Finding> {
        // Long beams of one laser are all alike; short ones end at random.
        // A pair costs the 3D kernel a quadrature.
        let (samples, photons) = match method {
            Method::Light => (1, 5000),
            Method::BeamsShort => (64, 4000),
            Method::Beams3d => (128, 1),
            Method::Path | Method::Beams1d | Method::Beams2d => (512, 1),
        };
        let work = Work { samples, photons, radius: Some(self.radius), surface_radius: None };
        let shot = Shot::new(&self.world(), method, &work)?;
        agrees(&shot, seed, 1, &self.expected(method)?.times(factor))
    }

    /// The scene.
    pub fn world(&self) -> World {
        let (start, bin) = self.window();
        let film = Film { width: 1, height: ROWS, start, bin, bins: BINS, rgb: false };
        let fov = 2.0 * self.half_height().atan().to_degrees();
        let world = World::new(self.unit).depths(2, 2);
        let fog = world.fog(self.fog, None);
        world
            .with("fog", fog)
            .with("background", json!({"type": "ref", "id": "fog"}))
            .camera(EYE, [0.0; 3], [0.0, 1.0, 0.0], fov, film)
            .laser(self.light().map(|x| -x), [0.0; 3], 1e-6 * self.radius, self.power)
    }

    /// Direction of the light.
    fn light(&self) -> Point {
        let (sin, cos) = self.psi.sin_cos();
        // Not almost along or against, but exactly.
        if sin.abs() < 1e-15 { [0.0, 0.0, cos] } else { [sin, 0.0, cos] }
    }

    /// Half the film's height over its distance.
    fn half_height(&self) -> f64 {
        if self.radius < 0.05 { 2.0 * self.radius } else { 0.01 }
    }

    /// First edge and width of the bins, around the arrival of light scattered at the origin.
    fn window(&self) -> (f64, f64) {
        let (sin, cos) = self.psi.sin_cos();
        let spread = (self.radius * (1.0 + cos) / sin.abs().max(0.1)).max(1e-9);
        (2.0 - 1.03 * spread, 0.51 * spread)
    }

    fn expected(&self, method: Method) -> Result<Expected> {
        let mut rows = Vec::with_capacity(ROWS);
        let who = if method == Method::Light { Method::Beams1d } else { method };
        for row in 0..ROWS {
            rows.push(self.row(who, row)?);
        }
        let all: Vec<usize> = (0..ROWS).collect();
        let inner: Vec<usize> = (ROWS / 4..3 * ROWS / 4).collect();
        let cells = BINS + 2;
        let sum = |pixels: &[usize], weights: &[f64]| -> f64 {
            let row = |&p: &usize| rows[p].iter().zip(weights).map(|(v, w)| v * w).sum::<f64>();
            pixels.iter().map(row).sum()
        };
        let early = |cell: usize| f64::from(u8::from(cell <= BINS / 2));
        let whole = vec![1.0; cells];
        let first: Vec<f64> = (0..cells).map(early).collect();
        let second: Vec<f64> = (0..cells).map(|cell| 1.0 - early(cell)).collect();
        let mut expected = Expected::grey(vec![], vec![]);
        let total = self.unit.light * self.power * sum(&all, &whole);
        let parts = [
            (ALL_LIGHT, &all, whole.clone()),
            ("light of the inner rows", &inner, whole),
            ("early light", &all, first),
            ("late light", &all, second),
        ];
        for (name, pixels, weights) in parts {
            let value = self.unit.light * self.power * sum(pixels, &weights);
            // Light that arrives at one instant has no halves, a line no inner rows.
            if value < 0.2 * total || (method == Method::Light && name != ALL_LIGHT) {
                continue;
            }
            let pixels = pixels.clone();
            expected.contrasts.push(LinearContrast { name: name.into(), pixels, weights });
            expected.channels.push(0);
            expected.values.push((value, RULE_ERROR * value));
        }
        Ok(expected)
    }

    /// Exact cells of one row of the film.
    fn row(&self, method: Method, row: usize) -> Result<Vec<f64>> {
        let half = self.half_height();
        let mut cells = vec![0.0; BINS + 2];
        let nodes = if method == Method::Beams1d { NODES_OF_INSTANTS } else { NODES };
        let share = 1.0 / (nodes.0 * nodes.1) as f64;
        for (i, j) in (0..nodes.0).flat_map(|i| (0..nodes.1).map(move |j| (i, j))) {
            let up = (i as f64 + 0.5) / nodes.0 as f64;
            let y = half * (2.0 * (row as f64 + up) / ROWS as f64 - 1.0);
            let x = half / ROWS as f64 * (2.0 * (j as f64 + 0.5) / nodes.1 as f64 - 1.0);
            if method == Method::Beams1d {
                let (value, opl) = self.instant([x, y, 1.0])?;
                cells[self.cell(opl)] += share * value;
            } else {
                for (cell, sum) in cells.iter_mut().enumerate() {
                    *sum += share * self.bin(method, [x, y, 1.0], cell)?;
                }
            }
        }
        Ok(cells)
    }

    /// Length of beams and rays, beyond which nothing is seen.
    fn length(&self) -> f64 {
        (LONG / (self.fog.sigma_s[0] + self.fog.sigma_a[0])).min(1e9)
    }

    /// The 1D kernel's value of a ray, and its arrival.
    fn instant(&self, ray_direction: Point) -> Result<(f64, f64)> {
        let (sigma_s, sigma_t) = (self.fog.sigma_s[0], self.fog.sigma_s[0] + self.fog.sigma_a[0]);
        let beam_origin = self.light().map(|x| -x);
        let value = beam_ray_1d(&BeamRay1d {
            sigma_s,
            sigma_t,
            g: self.fog.g,
            radius: self.radius,
            beam_origin,
            beam_direction: self.light(),
            beam_length: self.length(),
            ray_origin: EYE,
            ray_direction,
            ray_length: self.length(),
        })?;
        // Feet of the common perpendicular, by n = d × ω: nothing cancels for small angles.
        let (d, omega) = (self.light(), ray_direction);
        let n = cross(d, omega);
        let w = [0, 1, 2].map(|i| EYE[i] - beam_origin[i]);
        let on_ray = dot(cross(w, d), n) / dot(n, n) * dot(omega, omega).sqrt();
        let on_beam = dot(cross(w, omega), n) / dot(n, n);
        Ok((value, on_ray + on_beam))
    }

    /// Cell of an arrival.
    fn cell(&self, opl: f64) -> usize {
        let (start, width) = self.window();
        let bin = ((opl - start) / width).floor();
        if bin < 0.0 { 0 } else { (bin as usize).min(BINS) + 1 }
    }

    /// The 2D or 3D kernel's energy of a ray in a cell.
    fn bin(&self, method: Method, ray_direction: Point, cell: usize) -> Result<f64> {
        let (start, width) = self.window();
        let edge = |index: usize| start + index as f64 * width;
        let t0 = if cell == 0 { 0.0 } else { edge(cell - 1) };
        // Nothing arrives before it is emitted.
        if cell <= BINS && edge(cell) <= 0.0 {
            return Ok(0.0);
        }
        let t1 = if cell > BINS { 4.0 * self.length() } else { edge(cell) };
        let (energy, speed, g, radius) = (1.0, 1.0, self.fog.g, self.radius);
        let (sigma_s, sigma_t) = (self.fog.sigma_s[0], self.fog.sigma_s[0] + self.fog.sigma_a[0]);
        let (beam_direction, beam_origin) = (self.light(), self.light().map(|x| -x));
        let (beam_length, ray_length, ray_origin) = (self.length(), self.length(), EYE);
        let t0 = t0.max(0.0);
        Ok(if method == Method::Beams3d {
            beam_ray_3d_bins(&BeamRay3dBin {
                energy,
                sigma_s,
                sigma_t,
                g,
                speed,
                radius,
                beam_origin,
                beam_direction,
                beam_length,
                ray_origin,
                ray_direction,
                ray_length,
                t0,
                t1,
            })?
        } else {
            beam_ray_2d_bins(&BeamRay2dBin {
                energy,
                sigma_s,
                sigma_t,
                g,
                speed,
                radius,
                beam_origin,
                beam_direction,
                beam_length,
                ray_origin,
                ray_direction,
                ray_length,
                t0,
                t1,
            })?
        })
    }
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Point, b: Point) -> Point {
    [0, 1, 2].map(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

/// Where the camera stands.
const EYE: Point = [0.0, 0.0, -1.0];
