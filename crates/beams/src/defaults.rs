//! Default radii: what a coarse grid of camera rays finds.
//!
//! A radius of about a pixel at the distance of what is looked at blurs no more than the image
//! does; but not more than a small part of what is looked at, or a coarse film would blur it all.
//! The rays follow mirrors, glass and rough surfaces. Those that see nothing that the radius is for
//! do not count, so that a large ground plane or a distant wall matters as much as the image shows
//! of it.

use std::collections::BTreeMap;

use tpb_optics::Stream;
use tpb_scene::{Flight, Hit, Medium, Scene, Vertex};
use tpb_transport::{Carrier, Encounter, Lobe, Response};

use crate::stream_item;

/// Rays along an edge of the film.
const GRID: usize = 16;
/// Surfaces that turn it which a ray follows at most.
const MOST_TURNS: usize = 8;
/// Beams' radius over the median chord of scattering media at most.
const MOST_OF_CHORD: f64 = 0.04;
/// Beams' radius over the smallest mean free path at most.
const MOST_OF_FREE_PATH: f64 = 0.1;
/// Disc's radius over the pixel's width.
const DISC_PIXELS: f64 = 2.5;
/// Disc's radius over the root of the shape's area at most.
const MOST_OF_SHAPE: f64 = 0.05;

/// Default radii of beams and of surface photons' discs \[m\]: positive and finite.
pub(crate) fn radii(scene: &Scene) -> (f64, f64) {
    let seen = Seen::new(scene);
    let pixel = scene.sensor.pixel_width();
    let sound = |radius: f64| if radius > 0.0 && radius.is_finite() { radius } else { pixel };
    let elsewhere = distance_of_all(scene);
    let beams = (pixel * median(seen.media).unwrap_or(elsewhere))
        .min(MOST_OF_CHORD * median(seen.chords).unwrap_or(f64::INFINITY))
        .min(MOST_OF_FREE_PATH * seen.free_path);
    let disc = (DISC_PIXELS * pixel * median(seen.surfaces).unwrap_or(elsewhere))
        .min(MOST_OF_SHAPE * median(seen.sizes).unwrap_or(f64::INFINITY));
    (sound(beams), sound(disc))
}

/// What the rays found, in metres.
struct Seen {
    /// Distances at which they look into scattering media.
    media: Vec<f64>,
    /// Lengths of their spans of these.
    chords: Vec<f64>,
    /// The smallest mean free path of these; of all media if none was seen.
    free_path: f64,
    /// Distances of diffuse surfaces.
    surfaces: Vec<f64>,
    /// Roots of the areas of the shapes hit.
    sizes: Vec<f64>,
}

impl Seen {
    fn new(scene: &Scene) -> Self {
        let (media, chords, surfaces, sizes) = (vec![], vec![], vec![], vec![]);
        let mut seen = Self { media, chords, free_path: f64::INFINITY, surfaces, sizes };
        let mut sizes = BTreeMap::new();
        for ray in 0..GRID * GRID {
            seen.look(scene, ray, &mut sizes);
        }
        if seen.media.is_empty() {
            let all = scene.media.iter().filter(|m| m.coefficients.scatters());
            seen.free_path = all.map(free_path).fold(f64::INFINITY, f64::min);
        }
        seen
    }

    /// Follows one ray; `sizes` remembers those of shapes, by their first primitive.
    fn look(&mut self, scene: &Scene, ray: usize, sizes: &mut BTreeMap<u32, f64>) {
        let on_film =
            |index: usize, pixels: usize| (index as f64 + 0.5) / GRID as f64 * pixels as f64;
        let (x, y) =
            (on_film(ray % GRID, scene.film.width), on_film(ray / GRID, scene.film.height));
        let mut direction = scene.sensor.direction(x, y);
        let mut vertex = scene.eye();
        let mut way = 0.0;
        let mut rng = Stream::new(0, 0, stream_item::pixel(ray));
        for _ in 0..=MOST_TURNS {
            let flight = scene.fly(&vertex, direction);
            self.look_into_media(scene, &flight, way);
            let Some(hit) = flight.hit else { return };
            way += hit.distance;
            let encounter = Encounter::new(scene, &flight, &hit, Carrier::Importance);
            let region = match encounter.respond(&mut rng) {
                Response::Absorbed => return,
                Response::Turned(turn) => {
                    direction = turn.direction;
                    turn.region
                }
                Response::Diffuse(lobe) => {
                    if !lobe.factor.is_zero() {
                        self.surfaces.push(way);
                        self.sizes.push(size(scene, &hit, sizes));
                    }
                    return;
                }
                Response::Rough(lobe) => {
                    let Some(drawn) = Lobe::<1>::sample(&lobe, &mut rng) else { return };
                    direction = drawn.direction;
                    drawn.region
                }
            };
            vertex = Vertex { position: hit.position, primitive: Some(hit.primitive), region };
        }
    }

    /// The spans of scattering media along a flight that starts `way` from the eye.
    fn look_into_media(&mut self, scene: &Scene, flight: &Flight, way: f64) {
        for span in &flight.spans {
            let Some(medium) = span.region.medium.map(|id| scene.medium(id)) else { continue };
            let chord = span.end - span.start;
            if medium.coefficients.scatters() && chord > 0.0 {
                let free_path = free_path(medium);
                self.media.push(way + span.start + 0.5 * chord.min(free_path));
                self.chords.push(chord);
                self.free_path = self.free_path.min(free_path);
            }
        }
    }
}

/// The mean free path of the channel where it is smallest.
fn free_path(medium: &Medium) -> f64 {
    1.0 / medium.coefficients.sigma_t.max_channel()
}

/// The root of the area of the shape that was hit.
fn size(scene: &Scene, hit: &Hit, known: &mut BTreeMap<u32, f64>) -> f64 {
    let range = scene.shape(hit.primitive).primitives.clone();
    let area = || range.clone().map(|p| scene.primitives[p as usize].area()).sum::<f64>();
    *known.entry(range.start).or_insert_with(|| area().sqrt())
}

/// Distance of the middle of all surfaces, for what no ray of the grid sees.
fn distance_of_all(scene: &Scene) -> f64 {
    if scene.primitives.is_empty() {
        return 1.0;
    }
    let bounds = scene.bounds();
    (bounds.centre() - scene.sensor.position).length().max(0.5 * bounds.radius())
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
