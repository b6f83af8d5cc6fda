//! The assembled scene, as integrators see it.

use glam::DVec3;
use smallvec::SmallVec;
use tpb_accel::{Aabb, Bvh};
use tpb_optics::{Rgb, Spectrum, Stream};

use crate::emitter::EmittingSurface;
use crate::packet::Leaves;
use crate::query::{END_TOLERANCE, Nearest, Obstacle, Obstacles};
use crate::{
    Bsdf, Connection, Emission, Emitter, EmitterKind, FilmSpec, Flight, Hit, Incident,
    IntegratorSpec, LightPoint, Medium, MediumBoundary, MediumId, Primitive, Region, Sensor, Span,
    Texture, TextureId, Vertex,
};

/// Null boundaries that one flight may cross; more means surfaces that coincide without end.
const MAX_NULL_CROSSINGS: usize = 4096;

/// One shape: a run of primitives with one material.
#[derive(Clone, Debug)]
pub struct Shape {
    /// Its id in the scene file.
    pub name: String,
    /// Its material.
    pub bsdf: Bsdf,
    /// The media on its sides; `None` leaves a crossing ray's medium unchanged.
    pub boundary: Option<MediumBoundary>,
    /// Index into [`Scene::emitters`] if it emits.
    pub emitter: Option<usize>,
    /// Its primitives.
    pub primitives: std::ops::Range<u32>,
}

/// A complete, consistent scene.
#[derive(Clone)]
pub struct Scene {
    /// All primitives.
    pub primitives: Vec<Primitive>,
    /// All shapes.
    pub shapes: Vec<Shape>,
    /// All media.
    pub media: Vec<Medium>,
    /// All textures, each of one shape.
    pub textures: Vec<Texture>,
    /// All emitters.
    pub emitters: Vec<Emitter>,
    /// The camera.
    pub sensor: Sensor,
    /// The film that the scene asks for.
    pub film: FilmSpec,
    /// Depths and method that the scene asks for.
    pub integrator: IntegratorSpec,
    /// What fills space beyond all boundaries.
    pub background: Region,
    pub(crate) shape_of: Vec<u32>,
    pub(crate) surfaces: Vec<Option<EmittingSurface>>,
    pub(crate) emission_choice: Choice,
    pub(crate) connection_choice: Choice,
    pub(crate) bvh: Bvh,
    pub(crate) leaves: Leaves,
}

impl Scene {
    /// The shape that a primitive belongs to.
    #[inline]
    pub fn shape(&self, primitive: u32) -> &Shape {
        &self.shapes[self.shape_of[primitive as usize] as usize]
    }

    /// A medium.
    #[inline]
    pub fn medium(&self, id: MediumId) -> &Medium {
        &self.media[id.index()]
    }

    /// The value of a texture at a hit on its shape.
    pub fn textured(&self, TextureId(id): TextureId, hit: &Hit) -> Rgb {
        self.textures[id as usize].at(&self.primitives[hit.primitive as usize], hit.position)
    }

    /// The box around all surfaces (empty without surfaces).
    pub fn bounds(&self) -> Aabb {
        self.primitives.iter().fold(Aabb::EMPTY, |b, p| b.union(p.bounds()))
    }

    /// The vertex that camera rays start from.
    pub fn eye(&self) -> Vertex {
        let Sensor { position, region, .. } = self.sensor;
        Vertex { position, primitive: None, region }
    }

    /// The nearest surface within `t_max`: its distance and primitive.
    #[inline]
    pub fn nearest(&self, from: &Vertex, direction: DVec3, t_max: f64) -> Option<(f64, u32)> {
        tpb_lanes::dispatch(Nearest { scene: self, from, direction: &direction, end: t_max })
    }

    /// Flies on through null boundaries to the first surface that acts on light.
    #[inline]
    pub fn fly(&self, from: &Vertex, direction: DVec3) -> Flight {
        // In place: a flight is large.
        let mut flight =
            Flight { origin: from.position, direction, spans: SmallVec::new(), hit: None };
        flight.hit = self.follow(from, direction, f64::INFINITY, None, &mut flight.spans);
        flight
    }

    /// What lies on the way to a point at `distance`, if no surface but null boundaries does.
    /// `end_primitive` is the one that the point lies on.
    #[inline]
    pub fn connect<const C: usize>(
        &self,
        from: &Vertex,
        direction: DVec3,
        distance: f64,
        end_primitive: Option<u32>,
    ) -> Option<Connection<C>> {
        let (scene, end) = (self, distance);
        let obstacles = Obstacles { scene, from, direction: &direction, end, end_primitive };
        match tpb_lanes::dispatch(obstacles) {
            Obstacle::Surface => None,
            Obstacle::None => {
                let Region { medium, eta } = from.region;
                let depth = medium.map_or(Spectrum::ZERO, |medium| {
                    self.medium(medium).coefficients.channels().depth(distance)
                });
                Some(Connection { opl: eta * distance, depth })
            }
            Obstacle::Boundaries => self.across(from, direction, distance, end_primitive),
        }
    }

    /// A connection across null boundaries.
    fn across<const C: usize>(
        &self,
        from: &Vertex,
        direction: DVec3,
        distance: f64,
        end_primitive: Option<u32>,
    ) -> Option<Connection<C>> {
        let mut flight =
            Flight { origin: from.position, direction, spans: SmallVec::new(), hit: None };
        flight.hit = self.follow(from, direction, distance, end_primitive, &mut flight.spans);
        let (opl, depth) = (flight.opl(distance), flight.depth(self, distance));
        flight.hit.is_none().then_some(Connection { opl, depth })
    }

    /// Collects spans up to `length` or to the first non-null hit, which is returned.
    #[inline]
    fn follow(
        &self,
        from: &Vertex,
        direction: DVec3,
        length: f64,
        end_primitive: Option<u32>,
        spans: &mut SmallVec<[Span; 4]>,
    ) -> Option<Hit> {
        let (mut vertex, mut start) = (*from, 0.0);
        for _ in 0..MAX_NULL_CROSSINGS {
            let rest = length - start;
            let met = self.nearest(&vertex, direction, rest).filter(|&(t, primitive)| {
                end_primitive != Some(primitive) || t < rest * (1.0 - END_TOLERANCE)
            });
            let Some((t, primitive)) = met else {
                break;
            };
            let end = start + t;
            spans.push(Span { start, end, region: vertex.region });
            let position = vertex.position + t * direction;
            let normal = self.primitives[primitive as usize].normal(position);
            let shape = self.shape(primitive);
            if !matches!(shape.bsdf, Bsdf::Null) {
                return Some(Hit { distance: end, primitive, position, normal });
            }
            vertex.region = self.region_beyond(shape, direction.dot(normal) > 0.0, vertex.region);
            (vertex.position, vertex.primitive, start) = (position, Some(primitive), end);
        }
        spans.push(Span { start, end: length, region: vertex.region });
        None
    }

    /// The region that light enters through a shape that lets it pass: on the side of the normal
    /// if `to_front`.
    #[inline]
    pub fn region_beyond(&self, shape: &Shape, to_front: bool, before: Region) -> Region {
        let medium = shape.boundary.map_or(before.medium, |b| b.side(to_front));
        let eta = match shape.bsdf.interface() {
            Some(glass) if to_front => glass.exterior_eta,
            Some(glass) => glass.interior_eta,
            None => before.eta,
        };
        Region { medium, eta }
    }

    /// The normal that shading uses at a hit, where it is not the geometric one; on the same side.
    #[inline]
    pub fn shading_normal(&self, hit: &Hit) -> Option<DVec3> {
        self.primitives[hit.primitive as usize].shading_normal(hit.position)
    }

    /// Radiance that the surface at `hit` emits against `direction` (the propagation of the ray
    /// that met it), if it emits on that side.
    #[inline]
    pub fn emitted<const C: usize>(&self, hit: &Hit, direction: DVec3) -> Option<Spectrum<C>> {
        let emitter = self.shape(hit.primitive).emitter?;
        match self.emitters[emitter].kind {
            EmitterKind::Area { radiance, .. } if direction.dot(hit.normal) < 0.0 => {
                Some(Rgb::channels(radiance))
            }
            _ => None,
        }
    }

    /// Chooses a point on an emitter, by power and area; `None` without emitters to connect to.
    #[inline]
    pub fn sample_light(&self, rng: &mut Stream) -> Option<LightPoint> {
        let (emitter, probability) = self.connection_choice.pick(rng)?;
        Some(match self.emitters[emitter].kind {
            EmitterKind::Point { position, .. } | EmitterKind::Spot { position, .. } => {
                LightPoint {
                    emitter,
                    position,
                    primitive: None,
                    normal: None,
                    collimated: false,
                    pdf: probability,
                }
            }
            EmitterKind::Directional { position, .. } => LightPoint {
                emitter,
                position,
                primitive: None,
                normal: None,
                collimated: true,
                pdf: probability,
            },
            EmitterKind::Area { area, .. } => {
                let (primitive, p) = self.pick_on_surface(emitter, rng);
                LightPoint {
                    emitter,
                    position: p.position,
                    primitive: Some(primitive),
                    normal: Some(p.normal),
                    collimated: false,
                    pdf: probability / area,
                }
            }
            EmitterKind::Laser { .. } => return None,
        })
    }

    /// The density (per m²) with which [`Scene::sample_light`] chooses the point that was hit.
    #[inline]
    pub fn light_pdf(&self, hit: &Hit) -> f64 {
        self.shape(hit.primitive).emitter.map_or(0.0, |emitter| match self.emitters[emitter].kind {
            EmitterKind::Area { area, .. } => self.connection_choice.probability(emitter) / area,
            _ => 0.0,
        })
    }

    /// Light from a chosen point towards `receiver`; `None` where it sends none there.
    #[inline]
    pub fn incident<const C: usize>(
        &self,
        point: &LightPoint,
        receiver: DVec3,
    ) -> Option<Incident<C>> {
        self.emitters[point.emitter].kind.incident(point, receiver)
    }

    /// A photon; `None` in a scene without light. Its region is the emitter's.
    pub fn emit<const C: usize>(&self, rng: &mut Stream) -> Option<Emission<C>> {
        let (emitter, probability) = self.emission_choice.pick(rng)?;
        let kind = &self.emitters[emitter].kind;
        Some(kind.emit(emitter, probability, rng, |rng| self.pick_on_surface(emitter, rng)))
    }

    /// Total power of all emitters \[W\].
    pub fn power(&self) -> Rgb {
        self.emitters.iter().map(|e| e.kind.power()).sum()
    }

    #[inline]
    fn pick_on_surface(
        &self,
        emitter: usize,
        rng: &mut Stream,
    ) -> (u32, crate::geometry::SurfacePoint) {
        let surface = self.surfaces[emitter].as_ref().expect("area emitters have a surface");
        let primitive = surface.pick(rng);
        let (u1, u2) = (rng.uniform(), rng.uniform());
        (primitive, self.primitives[primitive as usize].sample(u1, u2))
    }
}

/// A discrete distribution over emitters.
#[derive(Clone, Debug)]
pub(crate) struct Choice {
    probabilities: Vec<f64>,
}

impl Choice {
    /// Proportional to `weights`; the choice of nothing if all are 0.
    pub(crate) fn new(weights: &[f64]) -> Self {
        let total: f64 = weights.iter().sum();
        let scale = if total > 0.0 { 1.0 / total } else { 0.0 };
        Self { probabilities: weights.iter().map(|w| w * scale).collect() }
    }

    fn probability(&self, index: usize) -> f64 {
        self.probabilities[index]
    }

    #[inline]
    fn pick(&self, rng: &mut Stream) -> Option<(usize, f64)> {
        if let [only] = self.probabilities[..] {
            return (only > 0.0).then_some((0, 1.0));
        }
        let last = self.probabilities.iter().rposition(|&p| p > 0.0)?;
        let mut rest = rng.uniform();
        for (index, &p) in self.probabilities[..last].iter().enumerate() {
            if rest < p {
                return Some((index, p));
            }
            rest -= p;
        }
        Some((last, self.probabilities[last]))
    }
}
