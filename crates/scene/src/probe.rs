//! Probe rays: which medium and which refractive index is where.
//!
//! A shape that names media fixes them on its two sides. The region at a camera or an emitter is
//! found by probe rays: each flies straight on to the first boundary that names media and reads
//! the side that it hit; rays that an opaque surface stops do not vote; no vote means background.
//! The same probes, from points on every boundary, find boundaries that contradict each other, and
//! surfaces that lie in the same place as another.
//!
//! **The same place.** Which of two surfaces in one place is met first, rounding decides, and a ray
//! that leaves one meets the other at once. With a boundary among them that is refused. Two opaque
//! surfaces are refused only where light can get to see the difference: both facing a side that is
//! *open*, or back to back with both sides open. A side is open if some probe from there meets
//! nothing, or something that sends light back. So a solid may stand on a floor: its inside is
//! closed. Likewise a camera, point, spot or laser on a surface is on neither side of it, and is
//! refused.

use std::f64::consts::PI;

use glam::DVec3;
use tpb_optics::{Stream, warp};

use crate::geometry::SurfacePoint;
use crate::{AssembleError, Bsdf, EmitterKind, MediumId, Reflector, Region, Scene, Shape, Vertex};

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
        if let Some(d) = bsdf.interface() {
            let eta = if front { d.exterior_eta } else { d.interior_eta };
            votes.eta.get_or_insert((eta, shape));
        }
        if let (Some(b), None) = (boundary, votes.medium) {
            let medium = b.side(front);
            votes.medium = Some((medium, shape));
            if let Some(id) = medium {
                votes.eta.get_or_insert((self.media_eta[id.index()], shape));
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
        let own = medium.map_or(self.scene.background.eta, |id| self.media_eta[id.index()]);
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

    /// Refuses a place on a surface.
    fn check_clear(&self, place: &str, position: DVec3) -> Result<(), AssembleError> {
        for direction in (0..PROBES_PER_PLACE).map(spread) {
            let before = position - self.near * direction;
            let start = Vertex { position: before, primitive: None, region: Region::VACUUM };
            if let Some((_, p)) = self.scene.nearest(&start, direction, 2.0 * self.near) {
                let (place, shape) = (place.to_owned(), self.scene.shape(p).name.clone());
                return Err(match self.scene.shape(p).bsdf {
                    Bsdf::Opaque { .. } => AssembleError::OnSurface { place, shape },
                    _ => AssembleError::OnBoundary { place, shape },
                });
            }
        }
        Ok(())
    }

    /// Refuses a shape with another surface in the same place, looked for at a few points.
    fn check_alone(&self, shape: usize) -> Result<(), AssembleError> {
        let Shape { name, primitives, bsdf, .. } = &self.scene.shapes[shape];
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
                let Some((_, met)) = met.filter(|&(_, other)| !primitives.contains(&other)) else {
                    continue;
                };
                let other = self.scene.shape(met);
                let matters = match (bsdf, other.bsdf) {
                    (Bsdf::Opaque { .. }, Bsdf::Opaque { .. }) => self.tells_apart(&p, met),
                    // The boundary says so itself.
                    (Bsdf::Opaque { .. }, _) => false,
                    _ => true,
                };
                if matters {
                    let (shape, other) = (name.clone(), other.name.clone());
                    return Err(AssembleError::Coincident { shape, other });
                }
            }
        }
        Ok(())
    }

    /// Whether light can tell which of two opaque surfaces in the place `p` it meets.
    fn tells_apart(&self, p: &SurfacePoint, other: u32) -> bool {
        let facing = self.scene.primitives[other as usize].normal(p.position).dot(p.normal);
        self.is_open(p, p.normal) && (facing > 0.0 || self.is_open(p, -p.normal))
    }

    /// Whether light can come to a surface from the side of `up`.
    fn is_open(&self, p: &SurfacePoint, up: DVec3) -> bool {
        let position = p.position + 2.0 * self.near * up;
        let start = Vertex { position, primitive: None, region: Region::VACUUM };
        let frame = tpb_optics::Frame::from_z(up);
        let mut rng = Stream::new(2, 0, 0);
        (0..PROBES_PER_BOUNDARY).any(|_| {
            let local = warp::cosine_hemisphere(rng.uniform(), rng.uniform());
            let direction = frame.to_world(local);
            let Some((t, met)) = self.scene.nearest(&start, direction, f64::INFINITY) else {
                return true;
            };
            let normal = self.scene.primitives[met as usize].normal(position + t * direction);
            let shape = self.scene.shape(met);
            let front = direction.dot(normal) < 0.0;
            match shape.bsdf.reflector(front) {
                None => true,
                Some(Reflector::Black) => front && shape.emitter.is_some(),
                Some(reflector) => !reflector.most_reflectance(&self.scene.textures).is_zero(),
            }
        })
    }

    pub(crate) fn camera_region(&self) -> Result<Region, AssembleError> {
        let sensor = &self.scene.sensor;
        let place = "the camera's surroundings";
        self.check_clear(place, sensor.position)?;
        match sensor.stated_medium {
            Some(medium) => Ok(self.stated(sensor.position, medium)),
            None => Ok(self.region(&self.around(place, sensor.position)?)),
        }
    }

    pub(crate) fn emitter_region(
        &self,
        index: usize,
        stated: Option<MediumId>,
    ) -> Result<Region, AssembleError> {
        let emitter = &self.scene.emitters[index];
        let place = format!("the surroundings of emitter '{}'", emitter.name);
        if let Some(position) = emitter.kind.position() {
            self.check_clear(&place, position)?;
            if let Some(medium) = stated {
                return Ok(self.stated(position, medium));
            }
        }
        let votes = match emitter.kind {
            EmitterKind::Point { position, .. } | EmitterKind::Spot { position, .. } => {
                self.around(&place, position)?
            }
            EmitterKind::Laser { position, axis, .. } => self.along(&place, position, axis)?,
            EmitterKind::Directional { position, axis, radius, .. } => {
                self.across(&place, position, axis, radius)?
            }
            EmitterKind::Area { shape, .. } => self.before(&place, shape, true)?,
        };
        Ok(self.region(&votes))
    }

    /// The region around a laser: what its light meets tells; if an opaque surface stops it first,
    /// all other directions do.
    fn along(&self, place: &str, position: DVec3, axis: DVec3) -> Result<Votes, AssembleError> {
        let mut votes = self.votes(position, None, axis);
        if votes.medium.is_none() {
            let around = self.around(place, position)?;
            votes.medium = around.medium;
            votes.eta = votes.eta.or(around.eta);
        }
        Ok(votes)
    }

    /// What boundaries say about the region before a disc that sends light along `axis`.
    fn across(
        &self,
        place: &str,
        centre: DVec3,
        axis: DVec3,
        radius: f64,
    ) -> Result<Votes, AssembleError> {
        let mut all = Votes::default();
        let frame = tpb_optics::Frame::from_z(axis);
        let mut rng = Stream::new(3, 0, 0);
        for _ in 0..PROBES_PER_PLACE {
            let disc = radius * warp::uniform_disc(rng.uniform(), rng.uniform());
            let position = centre + disc.x * frame.x + disc.y * frame.y;
            self.merge(place, &mut all, self.votes(position, None, axis))?;
        }
        Ok(all)
    }

    /// A stated medium needs no vote; the index still comes from boundaries, else from the medium.
    fn stated(&self, position: DVec3, medium: MediumId) -> Region {
        let votes = (0..PROBES_PER_PLACE).map(|i| self.votes(position, None, spread(i)));
        let voted = votes.into_iter().find_map(|votes| votes.eta);
        let eta = voted.map_or(self.media_eta[medium.index()], |(eta, _)| eta);
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

    /// No surface may lie in the place of another, and every boundary's two sides must agree with
    /// the boundaries that they face.
    pub(crate) fn check_surfaces(&self) -> Result<(), AssembleError> {
        for (index, shape) in self.scene.shapes.iter().enumerate() {
            self.check_alone(index)?;
            if matches!(shape.bsdf, Bsdf::Opaque { .. }) {
                continue;
            }
            let mut etas = [None; 2];
            for (front, side) in [(true, "in front of"), (false, "behind")] {
                let place = format!("the region {side} '{}'", shape.name);
                etas[usize::from(front)] = self.before(&place, index, front)?.eta;
            }
            if let (true, [Some((interior, _)), Some((exterior, _))]) =
                (shape.bsdf.keeps_index(), etas)
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
