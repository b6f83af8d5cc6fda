//! The perspective camera, the film that the scene asks for, and the integrator's defaults.
//!
//! Mitsuba's conventions: the camera looks along its local +z with +y up, and its local +x is on
//! the *left* of the image; row 0 of the film is at the top. A pixel's value is the mean radiance
//! over its area on the image plane (box filter).

use glam::{DAffine3, DVec3};

use crate::Region;

/// Which image extent `fov` measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FovAxis {
    /// Horizontal.
    X,
    /// Vertical.
    Y,
    /// Corner to corner.
    Diagonal,
    /// The smaller of horizontal and vertical.
    Smaller,
    /// The larger of horizontal and vertical.
    Larger,
}

/// A pinhole camera.
#[derive(Clone, Debug)]
pub struct Sensor {
    /// The pinhole \[m\].
    pub position: DVec3,
    /// What surrounds the pinhole; found when the scene is assembled.
    pub region: Region,
    /// The medium that the scene file names for the camera, if it does.
    pub stated_medium: Option<crate::MediumId>,
    left: DVec3,
    up: DVec3,
    forward: DVec3,
    half_width: f64,
    half_height: f64,
    film: (usize, usize),
}

impl Sensor {
    /// `fov_degrees` in (0, 180) along `axis`; `to_world` is rigid up to a uniform scale.
    pub fn perspective(
        to_world: DAffine3,
        fov_degrees: f64,
        axis: FovAxis,
        width: usize,
        height: usize,
    ) -> Self {
        let tangent = (0.5 * fov_degrees.to_radians()).tan();
        let (w, h) = (width as f64, height as f64);
        let extent = match axis {
            FovAxis::X => w,
            FovAxis::Y => h,
            FovAxis::Diagonal => w.hypot(h),
            FovAxis::Smaller => w.min(h),
            FovAxis::Larger => w.max(h),
        };
        Self {
            position: to_world.translation,
            region: Region::VACUUM,
            stated_medium: None,
            left: to_world.matrix3.x_axis.normalize(),
            up: to_world.matrix3.y_axis.normalize(),
            forward: to_world.matrix3.z_axis.normalize(),
            half_width: tangent * w / extent,
            half_height: tangent * h / extent,
            film: (width, height),
        }
    }

    /// Unit direction away from the camera through the film position (`x`, `y`) in pixels, from
    /// the top left corner.
    #[inline]
    pub fn direction(&self, x: f64, y: f64) -> DVec3 {
        let (w, h) = (self.film.0 as f64, self.film.1 as f64);
        let a = self.half_width * (1.0 - 2.0 * x / w);
        let b = self.half_height * (1.0 - 2.0 * y / h);
        (self.forward + a * self.left + b * self.up).normalize()
    }

    /// Unit direction of the optical axis.
    pub fn forward(&self) -> DVec3 {
        self.forward
    }

    /// Width of a pixel on a plane at distance 1 along the axis \[m/m\].
    pub fn pixel_width(&self) -> f64 {
        2.0 * self.half_width / self.film.0 as f64
    }
}

/// What the scene's film asks for.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmSpec {
    /// Pixels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Channels of the arrays.
    pub pixel_format: PixelFormat,
    /// The time axis, or steady state only.
    pub time: Option<TimeSpec>,
}

/// Channels of the film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PixelFormat {
    /// One channel.
    Luminance,
    /// Three channels, linear Rec. 709.
    Rgb,
}

/// Uniform bins of optical path length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeSpec {
    /// First edge \[m\].
    pub start_opl: f64,
    /// Width of a bin \[m\], positive.
    pub bin_width_opl: f64,
    /// Number of bins, at least 1.
    pub bins: usize,
}

/// Method names that a scene or the command line may give.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MethodName {
    /// The path tracer.
    Path,
    /// Photon beams.
    Beams,
}

/// Defaults for depths and method; scattering events are counted as in Mitsuba: depth 1 is an
/// emitter seen directly, 2 one scattering event (medium or surface); null crossings do not count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntegratorSpec {
    /// The method that the scene names, if any.
    pub method: Option<MethodName>,
    /// Deepest paths counted; `None` is unlimited.
    pub max_depth: Option<u32>,
    /// Shallowest paths counted (extension, to isolate scattering orders).
    pub min_depth: u32,
    /// Depth from which Russian roulette may end a path.
    pub rr_depth: u32,
}

impl Default for IntegratorSpec {
    /// Mitsuba's defaults: unlimited depth, roulette from depth 5.
    fn default() -> Self {
        Self { method: None, max_depth: None, min_depth: 1, rr_depth: 5 }
    }
}

impl IntegratorSpec {
    /// Whether paths of this depth contribute.
    #[inline]
    pub fn counts(&self, depth: u32) -> bool {
        depth >= self.min_depth && self.reaches(depth)
    }

    /// Whether paths may become this deep.
    #[inline]
    pub fn reaches(&self, depth: u32) -> bool {
        self.max_depth.is_none_or(|max| depth <= max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plus_x_is_on_the_left_and_row_zero_at_the_top() {
        let sensor = Sensor::perspective(DAffine3::IDENTITY, 90.0, FovAxis::X, 200, 100);
        let top_left = sensor.direction(0.0, 0.0);
        assert!(top_left.x > 0.0 && top_left.y > 0.0 && top_left.z > 0.0);
        assert!(
            (sensor.direction(0.0, 50.0) - DVec3::new(1.0, 0.0, 1.0).normalize()).length() < 1e-15
        );
        assert!((sensor.direction(100.0, 50.0) - DVec3::Z).length() < 1e-15);
        assert!((sensor.pixel_width() - 0.01).abs() < 1e-15);
    }
}
