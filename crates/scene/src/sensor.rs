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

/// The film on the plane at distance 1 along the axis, as directions from the pinhole.
#[derive(Clone, Copy, Debug)]
pub struct ImagePlane {
    /// Towards the top left corner of the film.
    pub corner: DVec3,
    /// From a pixel to its right neighbour.
    pub column: DVec3,
    /// From a pixel to the one below it.
    pub row: DVec3,
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

    /// The direction through the film position (`x`, `y`), not normalised: `corner + x column +
    /// y row`, of component 1 along the axis. Columns and rows are perpendicular.
    #[inline]
    pub fn plane(&self) -> ImagePlane {
        let (w, h) = (self.film.0 as f64, self.film.1 as f64);
        ImagePlane {
            corner: self.forward + self.half_width * self.left + self.half_height * self.up,
            column: -2.0 * self.half_width / w * self.left,
            row: -2.0 * self.half_height / h * self.up,
        }
    }

    /// Where a ball at `from_eye` from the pinhole is seen, were nothing in between: its first and
    /// last column and its first and last row, beyond the film too; `None` unless it lies in front
    /// of the pinhole by more than its radius.
    #[inline]
    pub fn extent(&self, from_eye: DVec3, radius: f64) -> Option<[(f64, f64); 2]> {
        let along = from_eye.dot(self.forward);
        let scale = (along - radius) * (along + radius);
        if along <= radius || scale <= 0.0 {
            return None;
        }
        let tangents = |across: f64, half: f64, pixels: f64| {
            // Slopes of the tangents in the plane of axis and film's edge.
            let spread = radius * (across * across + scale).sqrt();
            let at = |slope: f64| 0.5 * pixels * (1.0 - slope / (scale * half));
            (at(across * along + spread), at(across * along - spread))
        };
        let (w, h) = (self.film.0 as f64, self.film.1 as f64);
        let columns = tangents(from_eye.dot(self.left), self.half_width, w);
        Some([columns, tangents(from_eye.dot(self.up), self.half_height, h)])
    }

    /// Tangents of half the field of view, along columns and rows of the film.
    pub fn half_extents(&self) -> [(DVec3, f64); 2] {
        [(self.left, self.half_width), (self.up, self.half_height)]
    }

    /// Where light that travels against `direction` (away from the pinhole) meets the film; `None`
    /// where it misses it. The inverse of [`Sensor::direction`].
    #[inline]
    pub fn project(&self, direction: DVec3) -> Option<FilmPoint> {
        let along = direction.dot(self.forward);
        if along <= 0.0 {
            return None;
        }
        let (w, h) = (self.film.0 as f64, self.film.1 as f64);
        let x = 0.5 * w * (1.0 - direction.dot(self.left) / (along * self.half_width));
        let y = 0.5 * h * (1.0 - direction.dot(self.up) / (along * self.half_height));
        let on_film = (0.0..w).contains(&x) && (0.0..h).contains(&y);
        on_film.then(|| FilmPoint { x, y, cosine: along / direction.length() })
    }

    /// The part of `start..end` (which may be infinite) of a ray that the camera has in view, were
    /// nothing in between; `None` if it sees nothing of it.
    #[inline]
    pub fn in_view(
        &self,
        origin: DVec3,
        direction: DVec3,
        (mut start, mut end): (f64, f64),
    ) -> Option<(f64, f64)> {
        let from_eye = origin - self.position;
        // Inward normals of the pyramid's sides.
        let (w, h) = (self.half_width * self.forward, self.half_height * self.forward);
        for normal in [w - self.left, w + self.left, h - self.up, h + self.up] {
            let (height, slope) = (from_eye.dot(normal), direction.dot(normal));
            let crossing = -height / slope;
            if slope > 0.0 {
                start = start.max(crossing);
            } else if slope < 0.0 {
                end = end.min(crossing);
            } else if height < 0.0 {
                return None;
            }
        }
        (start < end).then_some((start, end))
    }

    /// What a unit of intensity \[W/sr\] at distance 1 m, were nothing in between, adds to the
    /// pixel that it is seen in at cosine `cosine` to the axis: 1/(A cos³θ) \[m⁻² sr⁻¹ per W/sr\],
    /// A being the pixel's area on the plane at unit distance. (The pixel's value is
    /// (1/A) ∫ L dA over that area, and dω = cos³θ dA there.)
    #[inline]
    pub fn importance(&self, cosine: f64) -> f64 {
        1.0 / (self.pixel_area() * cosine * cosine * cosine)
    }

    /// Area of a pixel on a plane at distance 1 along the axis \[m²/m²\].
    #[inline]
    pub fn pixel_area(&self) -> f64 {
        let pixels = self.film.0 as f64 * self.film.1 as f64;
        4.0 * self.half_width * self.half_height / pixels
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

/// A point of the film, seen from the pinhole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmPoint {
    /// Column from the left edge \[pixels\].
    pub x: f64,
    /// Row from the top edge \[pixels\].
    pub y: f64,
    /// Cosine of the angle to the optical axis.
    pub cosine: f64,
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
    /// The light tracer.
    Light,
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
        assert!((sensor.pixel_area() - 1e-4).abs() < 1e-18);
    }

    /// A camera of 12 x 5 pixels, turned and away from the origin.
    fn turned() -> Sensor {
        let rotation = glam::DMat3::from_euler(glam::EulerRot::XYZ, 0.4, -1.1, 2.0);
        let to_world = DAffine3::from_mat3_translation(rotation, DVec3::new(3.0, -1.0, 0.5));
        Sensor::perspective(to_world, 100.0, FovAxis::X, 12, 5)
    }

    #[test]
    fn projection_inverts_the_direction() {
        let sensor = turned();
        for (x, y) in [(0.1, 0.2), (11.9, 4.9), (6.0, 2.5), (3.3, 0.01)] {
            let direction = sensor.direction(x, y);
            let found = sensor.project(2.5 * direction).expect("on the film");
            assert!((found.x - x).abs() < 1e-12 && (found.y - y).abs() < 1e-12, "{found:?}");
            assert!((found.cosine - direction.dot(sensor.forward())).abs() < 1e-14);
            assert!(sensor.project(-direction).is_none(), "behind");
        }
        for (x, y) in [(-0.1, 2.0), (12.1, 2.0), (6.0, -0.1), (6.0, 5.1)] {
            assert!(sensor.project(sensor.direction(x, y)).is_none(), "{x} {y}");
        }
    }

    /// Pixels of cosine⁻³ importance cover the film's solid angle: Ω/(A cos³θ) of uniform directions
    /// is the number of pixels. A rectangle of half edges a, b at distance 1 has
    /// Ω = 4 asin(ab/√((1 + a²)(1 + b²))).
    #[test]
    fn importance_is_that_of_the_area_on_the_image_plane() {
        let sensor = turned();
        let (n, mut omega) = (400, 0.0);
        for i in 0..n * n {
            let (x, y) = (f64::from(i % n) + 0.5, f64::from(i / n) + 0.5);
            let (x, y) = (12.0 * x / f64::from(n), 5.0 * y / f64::from(n));
            let cosine = sensor.direction(x, y).dot(sensor.forward());
            omega += 60.0 / f64::from(n * n) / sensor.importance(cosine);
        }
        let (a, b) = (sensor.half_width, sensor.half_height);
        let expected = 4.0 * (a * b / ((1.0 + a * a) * (1.0 + b * b)).sqrt()).asin();
        assert!((omega / expected - 1.0).abs() < 1e-5, "{omega} {expected}");
    }

    #[test]
    fn the_part_in_view_is_where_points_project_onto_the_film() {
        let sensor = turned();
        let mut rng = tpb_optics::Stream::new(1, 2, 3);
        let mut draw = || tpb_optics::warp::uniform_sphere(rng.uniform(), rng.uniform());
        let mut seen = 0;
        for _ in 0..400 {
            let origin = sensor.position + 2.0 * draw();
            let direction = draw();
            let part = sensor.in_view(origin, direction, (0.5, f64::INFINITY));
            seen += u32::from(part.is_some());
            for i in 0..200 {
                let t = 0.5 + 0.031 * f64::from(i);
                let visible = sensor.project(origin + t * direction - sensor.position).is_some();
                let inside = part.is_some_and(|(start, end)| start <= t && t <= end);
                assert_eq!(visible, inside, "{t} {part:?}");
            }
        }
        assert!((40..360).contains(&seen), "{seen}");
        let backwards = sensor.in_view(sensor.position, -sensor.forward(), (0.0, 9.0));
        assert!(backwards.is_none());
    }
}
