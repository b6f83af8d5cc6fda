//! From parts to a scene: which medium and which refractive index is where.
//!
//! A shape that names media fixes them on its two sides. The region at a camera or an emitter is
//! found by probe rays: each flies straight on to the first boundary that names media and reads
//! the side that it hit; rays that an opaque surface stops do not vote; no vote means background.
//! The same probes, from points on every boundary, find boundaries that contradict each other.

use std::f64::consts::PI;

use glam::DVec3;
use tpb_accel::{Bvh, Quality};
use tpb_optics::{Rgb, Stream, warp};

use crate::emitter::EmittingSurface;
use crate::world::Choice;
use crate::{
    Bsdf, Emitter, EmitterKind, FilmSpec, IntegratorSpec, Medium, MediumBoundary, MediumId,
    Primitive, Region, Scene, Sensor, Shape, Vertex,
};

/// A shape as the loader hands it over.
#[derive(Clone, Debug)]
pub struct ShapePart {
    /// Its id in the scene file.
    pub name: String,
    /// Its pieces; at least one.
    pub primitives: Vec<Primitive>,
    /// Its material.
    pub bsdf: Bsdf,
    /// The media on its sides, if it bounds media; a side that the file omits is the background.
    pub boundary: Option<MediumBoundary>,
    /// Radiance of its area emitter \[W m⁻² sr⁻¹\].
    pub radiance: Option<Rgb>,
}

/// An emitter that is no shape.
#[derive(Clone, Debug)]
pub struct EmitterPart {
    /// Its id in the scene file.
    pub name: String,
    /// What it is (not an area emitter).
    pub kind: EmitterKind,
    /// The medium that the scene file names for it, if it does; otherwise probes find it.
    pub stated_medium: Option<MediumId>,
}

/// All that a scene file says.
#[derive(Clone, Debug)]
pub struct SceneParts {
    /// Shapes.
    pub shapes: Vec<ShapePart>,
    /// Media; [`MediumId`] is the index.
    pub media: Vec<Medium>,
    /// Emitters that are no shapes.
    pub emitters: Vec<EmitterPart>,
    /// The medium beyond all boundaries (extension).
    pub background: Option<MediumId>,
    /// The camera.
    pub sensor: Sensor,
    /// Its film.
    pub film: FilmSpec,
    /// Depths and method.
    pub integrator: IntegratorSpec,
}

/// Contradictions between parts.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AssembleError {
    /// Two boundaries put different media (or indices) into the same region.
    #[error("{place}: '{first}' puts {first_says} there, but '{second}' puts {second_says}")]
    Disagreement {
        /// What the region belongs to.
        place: String,
        /// One shape.
        first: String,
        /// What it says.
        first_says: String,
        /// The other shape.
        second: String,
        /// What that says.
        second_says: String,
    },
    /// A medium gets different refractive indices.
    #[error(
        "medium '{medium}' has refractive index {first} by {first_source} but {second} by {second_source}"
    )]
    MediumIndex {
        /// The medium.
        medium: String,
        /// One index.
        first: f64,
        /// Who says so.
        first_source: String,
        /// The other index.
        second: f64,
        /// Who says so.
        second_source: String,
    },
    /// A null boundary between unequal refractive indices.
    #[error("null boundary '{shape}' lies between refractive indices {interior} and {exterior}")]
    NullBetweenUnequalIndices {
        /// The shape.
        shape: String,
        /// Index opposite to the normal.
        interior: f64,
        /// Index on the side of the normal.
        exterior: f64,
    },
}

impl AssembleError {
    /// The shape, medium or other part that the error is about first.
    pub fn subject(&self) -> &str {
        match self {
            Self::Disagreement { first, .. } => first,
            Self::MediumIndex { medium, .. } => medium,
            Self::NullBetweenUnequalIndices { shape, .. } => shape,
        }
    }
}

const PROBES_PER_PLACE: usize = 64;
const PROBES_PER_BOUNDARY: usize = 32;

impl Scene {
    /// Puts the parts together, finds the region at every camera and emitter, and refuses
    /// contradictions.
    pub fn assemble(parts: SceneParts) -> Result<Self, AssembleError> {
        let media_eta = media_indices(&parts)?;
        let stated: Vec<_> = parts.emitters.iter().map(|e| e.stated_medium).collect();
        let mut scene = lay_out(parts, &media_eta);
        check_null_boundaries(&scene, &media_eta)?;
        let probe = Probe { scene: &scene, media_eta: &media_eta };
        probe.check_boundaries()?;
        let eye = probe.camera_region()?;
        let regions = (0..scene.emitters.len())
            .map(|e| probe.emitter_region(e, stated.get(e).copied().flatten()))
            .collect::<Result<Vec<_>, _>>()?;
        scene.sensor.region = eye;
        for (emitter, region) in scene.emitters.iter_mut().zip(regions) {
            emitter.region = region;
        }
        Ok(scene)
    }
}

/// The refractive index that dielectric boundaries, or the media themselves, give each medium.
fn media_indices(parts: &SceneParts) -> Result<Vec<f64>, AssembleError> {
    let mut found: Vec<Option<(f64, String)>> =
        parts.media.iter().map(|m| m.eta.map(|eta| (eta, "its own 'eta'".to_owned()))).collect();
    for shape in &parts.shapes {
        let (Bsdf::Dielectric(d), Some(b)) = (shape.bsdf, shape.boundary) else { continue };
        for (side, eta) in [(b.interior, d.interior_eta), (b.exterior, d.exterior_eta)] {
            let Some(MediumId(id)) = side else { continue };
            let source = format!("shape '{}'", shape.name);
            match &found[id as usize] {
                Some((first, first_source)) if *first != eta => {
                    return Err(AssembleError::MediumIndex {
                        medium: parts.media[id as usize].name.clone(),
                        first: *first,
                        first_source: first_source.clone(),
                        second: eta,
                        second_source: source,
                    });
                }
                Some(_) => {}
                None => found[id as usize] = Some((eta, source)),
            }
        }
    }
    Ok(found.into_iter().map(|f| f.map_or(1.0, |(eta, _)| eta)).collect())
}

fn lay_out(parts: SceneParts, media_eta: &[f64]) -> Scene {
    let mut primitives = Vec::new();
    let mut shape_of = Vec::new();
    let mut shapes = Vec::new();
    let background = Region {
        medium: parts.background,
        eta: parts.background.map_or(1.0, |id| media_eta[id.0 as usize]),
    };
    let mut emitters: Vec<_> = parts
        .emitters
        .into_iter()
        .map(|e| Emitter { name: e.name, kind: e.kind, region: background })
        .collect();
    let mut surfaces: Vec<Option<EmittingSurface>> = vec![None; emitters.len()];
    for part in parts.shapes {
        let (shape, first) = (shapes.len(), primitives.len() as u32);
        shape_of.extend(part.primitives.iter().map(|_| shape as u32));
        let emitter = part.radiance.map(|radiance| {
            let surface = EmittingSurface::new(first, &part.primitives);
            let kind = EmitterKind::Area { shape, radiance, area: surface.area() };
            emitters.push(Emitter { name: part.name.clone(), kind, region: background });
            surfaces.push(Some(surface));
            emitters.len() - 1
        });
        primitives.extend(part.primitives);
        shapes.push(Shape {
            name: part.name,
            bsdf: part.bsdf,
            boundary: part.boundary,
            emitter,
            primitives: first..primitives.len() as u32,
        });
    }
    let weight = |e: &Emitter| e.kind.power().luminance();
    let all: Vec<_> = emitters.iter().map(weight).collect();
    let connectable: Vec<_> =
        emitters.iter().map(|e| if e.kind.can_be_connected() { weight(e) } else { 0.0 }).collect();
    let boxes: Vec<_> = primitives.iter().map(Primitive::bounds).collect();
    Scene {
        bvh: Bvh::build(&boxes, Quality::FastQuery),
        emission_choice: Choice::new(&all),
        connection_choice: Choice::new(&connectable),
        primitives,
        shapes,
        media: parts.media,
        emitters,
        sensor: parts.sensor,
        film: parts.film,
        integrator: parts.integrator,
        background,
        shape_of,
        surfaces,
    }
}

/// Null boundaries that name media on both sides must not bend light.
fn check_null_boundaries(scene: &Scene, media_eta: &[f64]) -> Result<(), AssembleError> {
    for shape in &scene.shapes {
        let (Bsdf::Null, Some(b)) = (shape.bsdf, shape.boundary) else { continue };
        let (Some(i), Some(e)) = (b.interior, b.exterior) else { continue };
        let (interior, exterior) = (media_eta[i.0 as usize], media_eta[e.0 as usize]);
        if interior != exterior {
            return Err(AssembleError::NullBetweenUnequalIndices {
                shape: shape.name.clone(),
                interior,
                exterior,
            });
        }
    }
    Ok(())
}

/// What boundaries say about a region; each with the shape that says it.
#[derive(Clone, Copy, Default)]
struct Votes {
    medium: Option<(Option<MediumId>, usize)>,
    eta: Option<(f64, usize)>,
}

struct Probe<'a> {
    scene: &'a Scene,
    media_eta: &'a [f64],
}

impl Probe<'_> {
    /// Flies straight on and reads the first boundary that names media, and the first that tells
    /// the refractive index, on the sides that it meets.
    fn votes(&self, position: DVec3, primitive: Option<u32>, direction: DVec3) -> Votes {
        let mut votes = Votes::default();
        let mut vertex = Vertex { position, primitive, region: Region::VACUUM };
        for _ in 0..64 {
            let Some((t, p)) = self.scene.nearest(&vertex, direction, f64::INFINITY) else { break };
            let position = vertex.position + t * direction;
            let front = direction.dot(self.scene.primitives[p as usize].normal(position)) < 0.0;
            let shape = self.scene.shape(p);
            let index = self.scene.shape_of[p as usize] as usize;
            if matches!(shape.bsdf, Bsdf::Opaque { .. }) {
                break;
            }
            self.read(&mut votes, index, front);
            if votes.medium.is_some() && votes.eta.is_some() {
                break;
            }
            vertex = Vertex { position, primitive: Some(p), region: Region::VACUUM };
        }
        votes
    }

    /// Adds what one side of a shape says.
    fn read(&self, votes: &mut Votes, shape: usize, front: bool) {
        let Shape { bsdf, boundary, .. } = &self.scene.shapes[shape];
        if let Bsdf::Dielectric(d) = bsdf {
            let eta = if front { d.exterior_eta } else { d.interior_eta };
            votes.eta.get_or_insert((eta, shape));
        }
        if let (Some(b), None) = (boundary, votes.medium) {
            let medium = b.side(front);
            votes.medium = Some((medium, shape));
            if let Some(MediumId(id)) = medium {
                votes.eta.get_or_insert((self.media_eta[id as usize], shape));
            }
        }
    }

    /// Merges further votes about the same region; a disagreement is an error.
    fn merge(&self, place: &str, all: &mut Votes, more: Votes) -> Result<(), AssembleError> {
        let disagreement = |first: usize, first_says, second: usize, second_says| {
            Err(AssembleError::Disagreement {
                place: place.to_owned(),
                first: self.scene.shapes[first].name.clone(),
                first_says,
                second: self.scene.shapes[second].name.clone(),
                second_says,
            })
        };
        if let (Some((a, from_a)), Some((b, from_b))) = (all.medium, more.medium)
            && a != b
        {
            return disagreement(from_a, self.medium_name(a), from_b, self.medium_name(b));
        }
        if let (Some((a, from_a)), Some((b, from_b))) = (all.eta, more.eta)
            && a != b
        {
            let says = |eta: f64| format!("refractive index {eta}");
            return disagreement(from_a, says(a), from_b, says(b));
        }
        all.medium = all.medium.or(more.medium);
        all.eta = all.eta.or(more.eta);
        Ok(())
    }

    fn medium_name(&self, medium: Option<MediumId>) -> String {
        medium.map_or_else(
            || "vacuum".to_owned(),
            |id| format!("medium '{}'", self.scene.medium(id).name),
        )
    }

    /// No vote means background.
    fn region(&self, votes: &Votes) -> Region {
        let medium = votes.medium.map_or(self.scene.background.medium, |(medium, _)| medium);
        let own = medium.map_or(self.scene.background.eta, |id| self.media_eta[id.0 as usize]);
        Region { medium, eta: votes.eta.map_or(own, |(eta, _)| eta) }
    }

    /// The region around a point in free space.
    fn around(&self, place: &str, position: DVec3) -> Result<Votes, AssembleError> {
        let mut all = Votes::default();
        for i in 0..PROBES_PER_PLACE {
            self.merge(place, &mut all, self.votes(position, None, spread(i)))?;
        }
        Ok(all)
    }

    fn camera_region(&self) -> Result<Region, AssembleError> {
        let sensor = &self.scene.sensor;
        match sensor.stated_medium {
            Some(medium) => Ok(self.stated(sensor.position, medium)),
            None => Ok(self.region(&self.around("the camera's surroundings", sensor.position)?)),
        }
    }

    fn emitter_region(
        &self,
        index: usize,
        stated: Option<MediumId>,
    ) -> Result<Region, AssembleError> {
        let emitter = &self.scene.emitters[index];
        let place = format!("the surroundings of emitter '{}'", emitter.name);
        if let (Some(position), Some(medium)) = (emitter.kind.position(), stated) {
            return Ok(self.stated(position, medium));
        }
        let votes = match emitter.kind {
            EmitterKind::Point { position, .. } | EmitterKind::Spot { position, .. } => {
                self.around(&place, position)?
            }
            EmitterKind::Laser { position, axis, .. } => self.votes(position, None, axis),
            EmitterKind::Area { shape, .. } => self.before(&place, shape, true)?,
        };
        Ok(self.region(&votes))
    }

    /// A stated medium needs no vote; the index still comes from boundaries, else from the medium.
    fn stated(&self, position: DVec3, medium: MediumId) -> Region {
        let votes = (0..PROBES_PER_PLACE).map(|i| self.votes(position, None, spread(i)));
        let voted = votes.into_iter().find_map(|votes| votes.eta);
        let eta = voted.map_or(self.media_eta[medium.0 as usize], |(eta, _)| eta);
        Region { medium: Some(medium), eta }
    }

    /// What boundaries say about the region before one side of a shape, the shape included.
    fn before(&self, place: &str, shape: usize, front: bool) -> Result<Votes, AssembleError> {
        let mut all = Votes::default();
        self.read(&mut all, shape, front);
        let Shape { primitives, boundary, emitter, .. } = &self.scene.shapes[shape];
        // A shape that names no media may reach through several; an emitter must lie in one.
        let one_medium = boundary.is_some() || emitter.is_some();
        let mut rng = Stream::new(0, 0, shape as u64);
        for _ in 0..PROBES_PER_BOUNDARY {
            let primitive = primitives.start + rng.index(primitives.len()) as u32;
            let p = self.scene.primitives[primitive as usize].sample(rng.uniform(), rng.uniform());
            let up = if front { p.normal } else { -p.normal };
            let local = warp::cosine_hemisphere(rng.uniform(), rng.uniform());
            let direction = tpb_optics::Frame::from_z(up).to_world(local);
            let mut votes = self.votes(p.position, Some(primitive), direction);
            if !one_medium {
                votes.medium = None;
            }
            self.merge(place, &mut all, votes)?;
        }
        Ok(all)
    }

    /// Every boundary's two sides must agree with the boundaries that they face.
    fn check_boundaries(&self) -> Result<(), AssembleError> {
        for (index, shape) in self.scene.shapes.iter().enumerate() {
            if matches!(shape.bsdf, Bsdf::Opaque { .. }) {
                continue;
            }
            let mut etas = [None; 2];
            for (front, side) in [(true, "in front of"), (false, "behind")] {
                let place = format!("the region {side} '{}'", shape.name);
                etas[usize::from(front)] = self.before(&place, index, front)?.eta;
            }
            if let (Bsdf::Null, [Some((interior, _)), Some((exterior, _))]) = (shape.bsdf, etas)
                && interior != exterior
            {
                let shape = shape.name.clone();
                return Err(AssembleError::NullBetweenUnequalIndices { shape, interior, exterior });
            }
        }
        Ok(())
    }
}

/// Directions spread evenly over the sphere (a Fibonacci lattice), none along an axis.
fn spread(i: usize) -> DVec3 {
    let golden = 0.5 * (5_f64.sqrt() - 1.0);
    let u1 = (i as f64 + 0.5) / PROBES_PER_PLACE as f64;
    warp::uniform_sphere(u1, (0.1 / PI + i as f64 * golden).fract())
}
