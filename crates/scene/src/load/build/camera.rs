//! The camera, its film and the integrator.

use super::Builder;
use super::shapes::within_limits;
use crate::description::{self as words, Kind};
use crate::load::dictionary::Object;
use crate::load::transform;
use crate::load::tree::Node;
use crate::load::trouble::{Outcome, Trouble};
use crate::{FilmSpec, FovAxis, IntegratorSpec, MethodName, PixelFormat, Sensor, TimeSpec};

/// Films with more values than this (pixels × bins × channels) are refused: 32 GiB in f64.
const MOST_VALUES: u64 = 1 << 32;

impl<'a> Builder<'a> {
    pub(super) fn sensor(&mut self) -> Outcome<(Sensor, FilmSpec)> {
        let dictionary = self.dictionary;
        let entry = dictionary.at_most_one(Kind::Sensor)?;
        match entry.map(|entry| (&entry.object, entry.member)) {
            Some((Object::Sensor(words::Sensor::Perspective(camera)), member)) => {
                self.perspective(camera, &member.value)
            }
            _ => Err(Trouble::new("the scene has no sensor").at(dictionary.root).hint(
                "add `\"sensor\": {\"type\": \"perspective\", \"fov\": 40, \"film\": {...}}`",
            )),
        }
    }

    fn perspective(
        &mut self,
        camera: &words::Perspective,
        node: &'a Node,
    ) -> Outcome<(Sensor, FilmSpec)> {
        let place = node.get_or_self("to_world");
        let to_world = transform::to_rigid(&camera.to_world, place)?;
        within_limits(&[to_world.translation], &[], place)?;
        let film = film(&camera.film, node.get_or_self("film"))?;
        let axis = match camera.fov_axis {
            words::FovAxis::X => FovAxis::X,
            words::FovAxis::Y => FovAxis::Y,
            words::FovAxis::Diagonal => FovAxis::Diagonal,
            words::FovAxis::Smaller => FovAxis::Smaller,
            words::FovAxis::Larger => FovAxis::Larger,
        };
        let mut sensor =
            Sensor::perspective(to_world, camera.fov.get(), axis, film.width, film.height);
        if let Some(medium) = &camera.medium {
            let name = || "sensor.medium".to_owned();
            let id = self.medium(medium, node.get_or_self("medium"), name)?;
            sensor.stated_medium = Some(id);
        }
        Ok((sensor, film))
    }
}

fn film(film: &words::Film, node: &Node) -> Outcome<FilmSpec> {
    let (width, height, format, time) = match film {
        words::Film::TransientHdrFilm(f) => {
            (f.width, f.height, f.pixel_format, time_axis(f, node)?)
        }
        words::Film::Hdrfilm(f) => (f.width, f.height, f.pixel_format, None),
    };
    let (pixel_format, channels) = match format {
        words::PixelFormat::Luminance => (PixelFormat::Luminance, 1),
        words::PixelFormat::Rgb => (PixelFormat::Rgb, 3),
    };
    let bins = time.as_ref().map_or(1, |time| time.bins as u64);
    let values = u64::from(width.get()) * u64::from(height.get()) * channels;
    if values.checked_mul(bins).is_none_or(|values| values > MOST_VALUES) {
        return Err(Trouble::new(format!(
            "a film of {} x {} pixels, {bins} bins and {channels} channels does not fit memory",
            width.get(),
            height.get(),
        ))
        .at(node)
        .hint(format!("at most {MOST_VALUES} values are allowed")));
    }
    let (width, height) = (width.get() as usize, height.get() as usize);
    Ok(FilmSpec { width, height, pixel_format, time })
}

/// No bins, no time axis.
fn time_axis(film: &words::TransientHdrFilm, node: &Node) -> Outcome<Option<TimeSpec>> {
    let bins = film.temporal_bins as usize;
    if bins == 0 {
        return Ok(None);
    }
    let (start_opl, bin_width_opl) = (film.start_opl, film.bin_width_opl.get());
    let end = start_opl + bin_width_opl * bins as f64;
    // The narrowest bin must still be told apart at either end of the axis.
    if !end.is_finite() || start_opl + bin_width_opl == start_opl || end - bin_width_opl == end {
        return Err(Trouble::new("the bins are too narrow for where they stand on the time axis")
            .at(node.get_or_self("bin_width_opl"))
            .hint("`start_opl` and `bin_width_opl` are optical path lengths in metres"));
    }
    Ok(Some(TimeSpec { start_opl, bin_width_opl, bins }))
}

pub(super) fn integrator(integrator: &words::Integrator, node: &Node) -> Outcome<IntegratorSpec> {
    use words::Integrator as I;
    let (method, depths) = match integrator {
        I::Path(d)
        | I::Volpath(d)
        | I::TransientPath(d)
        | I::TransientVolpath(d)
        | I::TransientPrbvolpath(d) => (MethodName::Path, d),
        I::PhotonBeams(d) | I::TransientPhotonBeams(d) => (MethodName::Beams, d),
        I::Ptracer(d) | I::TransientPtracer(d) => (MethodName::Light, d),
    };
    let (max_depth, min_depth) = (depths.max_depth.0, depths.min_depth.get());
    if max_depth.is_some_and(|max| max < min_depth) {
        return Err(Trouble::new("`max_depth` is less than `min_depth`: no path would count")
            .at(node.get_or_self("max_depth"))
            .hint(
                "depth 1 is an emitter seen directly, 2 has one scattering event; -1 is no limit",
            ));
    }
    let rr_depth = depths.rr_depth.get();
    Ok(IntegratorSpec { method: Some(method), max_depth, min_depth, rr_depth })
}
