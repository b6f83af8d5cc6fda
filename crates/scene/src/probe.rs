//! Probe rays: which medium and which refractive index is where.
//!
//! A shape that names media fixes them on its two sides. The region at a camera or an emitter is
//! found by probe rays: each flies straight on to the first boundary that names media and reads
//! the side that it hit; rays that an opaque surface stops do not vote; no vote means background.
//! The same probes, from points on every boundary, find boundaries that contradict each other, and
//! boundaries that lie in the same place as another surface.

use std::f64::consts::PI;

use glam::DVec3;
use tpb_optics::{Stream, warp};

use crate::{AssembleError, Bsdf, EmitterKind, MediumId, Region, Scene, Shape, Vertex};

const PROBES_PER_PLACE: usize = 64;
const PROBES_PER_BOUNDARY: usize = 32;

/// Surfaces nearer than this, in sizes of the scene, are in the same place.
const SAME_PLACE: f64 = 1e-9;

/// What boundaries say about a region; each with the shape that says it.
#[derive(Clone, Copy, Default)]
pub(crate) struct Votes {
    medium: Option<(Option<MediumId>, usize)>,
    eta: Option<(f64, usize)>,
}

/// Asks boundaries which region is where.
pub(crate) struct Probe<'a> {
    scene: &'a Scene,
    media_eta: &'a [f64],
    /// What is nearer is in the same place \[m\].
    near: f64,
}

impl<'a> Probe<'a> {
    /// For a scene that is laid out, and the refractive index of each of its media.
    pub(crate) fn new(scene: &'a Scene, media_eta: &'a [f64]) -> Self {
        let bounds = scene.bounds();
        let extent = bounds.centre().abs().max_element() + bounds.radius();
        Self { scene, media_eta, near: SAME_PLACE * extent }
    }

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
            self.check_clear(place, position, spread(i))?;
            self.merge(place, &mut all, self.votes(position, None, spread(i)))?;
        }
        Ok(all)
    }

    /// Refuses a place on a boundary.
    fn check_clear(
        &self,
        place: &str,
        position: DVec3,
        direction: DVec3,
    ) -> Result<(), AssembleError> {
        let before = position - self.near * direction;
        let start = Vertex { position: before, primitive: None, region: Region::VACUUM };
        let Some((_, p)) = self.scene.nearest(&start, direction, 2.0 * self.near) else {
            return Ok(());
        };
        let Shape { name, bsdf, boundary, .. } = self.scene.shape(p);
        if boundary.is_none() && !matches!(bsdf, Bsdf::Dielectric(_)) {
            return Ok(());
        }
        Err(AssembleError::OnBoundary { place: place.to_owned(), shape: name.clone() })
    }

    /// Refuses a boundary with another surface in the same place, looked for at a few points.
    fn check_alone(&self, shape: usize) -> Result<(), AssembleError> {
        let Shape { name, primitives, .. } = &self.scene.shapes[shape];
        let mut rng = Stream::new(1, 0, shape as u64);
        for _ in 0..PROBES_PER_BOUNDARY {
            let own = primitives.start + rng.index(primitives.len()) as u32;
            let p = self.scene.primitives[own as usize].sample(rng.uniform(), rng.uniform());
            for direction in [p.normal, -p.normal] {
                // From just behind the surface, so that what lies exactly in it is met.
                let behind = Vertex {
                    position: p.position - self.near * direction,
                    primitive: Some(own),
                    region: Region::VACUUM,
                };
                let met = self.scene.nearest(&behind, direction, 2.0 * self.near);
                if let Some((_, other)) = met.filter(|&(_, other)| !primitives.contains(&other)) {
                    let other = self.scene.shape(other).name.clone();
                    return Err(AssembleError::Coincident { shape: name.clone(), other });
                }
            }
        }
        Ok(())
    }

    pub(crate) fn camera_region(&self) -> Result<Region, AssembleError> {
        let sensor = &self.scene.sensor;
        match sensor.stated_medium {
            Some(medium) => Ok(self.stated(sensor.position, medium)),
            None => Ok(self.region(&self.around("the camera's surroundings", sensor.position)?)),
        }
    }

    pub(crate) fn emitter_region(
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
    pub(crate) fn check_boundaries(&self) -> Result<(), AssembleError> {
        for (index, shape) in self.scene.shapes.iter().enumerate() {
            if matches!(shape.bsdf, Bsdf::Opaque { .. }) {
                continue;
            }
            self.check_alone(index)?;
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
