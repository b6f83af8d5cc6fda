//! From parts to a scene: laid out, consistent, and with a region at the camera and every emitter
//! ([`crate::probe`]).

use tpb_accel::{Aabb, Bvh};
use tpb_optics::Rgb;

use crate::emitter::EmittingSurface;
use crate::packet::{self, Leaves};
use crate::probe::Probe;
use crate::world::Choice;
use crate::{
    Bsdf, Emitter, EmitterKind, FilmSpec, IntegratorSpec, Medium, MediumBoundary, MediumId,
    Primitive, Region, Scene, Sensor, Shape, Texture,
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
    /// Textures; [`TextureId`](crate::TextureId) is the index.
    pub textures: Vec<Texture>,
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
    /// The camera or an emitter stands exactly on a boundary, where two regions meet.
    #[error("{place}: it stands on '{shape}', where two regions meet")]
    OnBoundary {
        /// What stands there.
        place: String,
        /// The boundary.
        shape: String,
    },
    /// The camera or an emitter stands exactly on an opaque surface, on neither side of it.
    #[error("{place}: it stands on '{shape}', on neither side of it")]
    OnSurface {
        /// What stands there.
        place: String,
        /// The surface.
        shape: String,
    },
    /// The camera stands at a point emitter in a medium that scatters: it would see infinite
    /// radiance.
    #[error(
        "the camera stands at emitter '{emitter}' in a medium that scatters: infinite radiance"
    )]
    AtEmitter {
        /// The emitter.
        emitter: String,
    },
    /// Directional light in a scene without shapes: nobody can say what it should cover.
    #[error("directional emitter '{emitter}' covers the shapes of the scene, but there are none")]
    NothingToCover {
        /// The emitter.
        emitter: String,
    },
    /// Two surfaces in the same place, and light can tell them apart: which is met first, nobody
    /// can say.
    #[error("'{shape}' lies in the same place as '{other}'")]
    Coincident {
        /// The boundary.
        shape: String,
        /// The other surface.
        other: String,
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
            Self::AtEmitter { emitter } | Self::NothingToCover { emitter } => emitter,
            Self::OnBoundary { shape, .. }
            | Self::OnSurface { shape, .. }
            | Self::Coincident { shape, .. }
            | Self::NullBetweenUnequalIndices { shape, .. } => shape,
        }
    }
}

impl Scene {
    /// Puts the parts together, finds the region at every camera and emitter, and refuses
    /// contradictions.
    pub fn assemble(parts: SceneParts) -> Result<Self, AssembleError> {
        let media_eta = media_indices(&parts)?;
        let stated: Vec<_> = parts.emitters.iter().map(|e| e.stated_medium).collect();
        let mut scene = lay_out(cover_all(parts)?, &media_eta);
        check_null_boundaries(&scene, &media_eta)?;
        let probe = Probe::new(&scene, &media_eta);
        probe.check_surfaces()?;
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
        let (Some(d), Some(b)) = (shape.bsdf.interface(), shape.boundary) else { continue };
        for (side, eta) in [(b.interior, d.interior_eta), (b.exterior, d.exterior_eta)] {
            let Some(id) = side.map(MediumId::index) else { continue };
            let source = format!("shape '{}'", shape.name);
            match &found[id] {
                Some((first, first_source)) if *first != eta => {
                    return Err(AssembleError::MediumIndex {
                        medium: parts.media[id].name.clone(),
                        first: *first,
                        first_source: first_source.clone(),
                        second: eta,
                        second_source: source,
                    });
                }
                Some(_) => {}
                None => found[id] = Some((eta, source)),
            }
        }
    }
    Ok(found.into_iter().map(|f| f.map_or(1.0, |(eta, _)| eta)).collect())
}

/// The sphere around all shapes is larger than that around their box by this, so that no shape
/// touches the disc of directional light.
const COVER: f64 = 1.001;

/// Places the discs that directional light starts on.
fn cover_all(mut parts: SceneParts) -> Result<SceneParts, AssembleError> {
    let boxes = parts.shapes.iter().flat_map(|shape| &shape.primitives).map(Primitive::bounds);
    let bounds = boxes.fold(Aabb::EMPTY, Aabb::union);
    for emitter in &mut parts.emitters {
        if let EmitterKind::Directional { axis, position, radius, .. } = &mut emitter.kind {
            if parts.shapes.is_empty() {
                return Err(AssembleError::NothingToCover { emitter: emitter.name.clone() });
            }
            *radius = COVER * bounds.radius();
            *position = bounds.centre() - *radius * *axis;
        }
    }
    Ok(parts)
}

fn lay_out(parts: SceneParts, media_eta: &[f64]) -> Scene {
    let mut primitives = Vec::new();
    let mut shape_of = Vec::new();
    let mut shapes = Vec::new();
    let background = Region {
        medium: parts.background,
        eta: parts.background.map_or(1.0, |id| media_eta[id.index()]),
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
    let bvh = Bvh::build(&boxes, |index| packet::joins(&primitives[index]));
    Scene {
        leaves: Leaves::new(&bvh, &primitives),
        bvh,
        emission_choice: Choice::new(&all),
        connection_choice: Choice::new(&connectable),
        primitives,
        shapes,
        media: parts.media,
        textures: parts.textures,
        emitters,
        sensor: parts.sensor,
        film: parts.film,
        integrator: parts.integrator,
        background,
        shape_of,
        surfaces,
    }
}

/// Refuses a camera that looks around from a point emitter in fog: light that is scattered once
/// diverges there. (Scenes that are assembled for something else than their camera may do so.)
pub(crate) fn check_camera(scene: &Scene) -> Result<(), AssembleError> {
    let scatters = |region: Region| {
        region.medium.is_some_and(|medium| scene.medium(medium).coefficients.scatters())
    };
    let at_camera = |e: &&Emitter| match e.kind {
        EmitterKind::Point { position, .. } | EmitterKind::Spot { position, .. } => {
            position == scene.sensor.position && scatters(e.region)
        }
        _ => false,
    };
    match scene.emitters.iter().find(at_camera) {
        Some(emitter) => Err(AssembleError::AtEmitter { emitter: emitter.name.clone() }),
        None => Ok(()),
    }
}

/// Null boundaries that name media on both sides must not bend light.
fn check_null_boundaries(scene: &Scene, media_eta: &[f64]) -> Result<(), AssembleError> {
    for shape in scene.shapes.iter().filter(|shape| shape.bsdf.keeps_index()) {
        let Some(b) = shape.boundary else { continue };
        let (Some(i), Some(e)) = (b.interior, b.exterior) else { continue };
        let (interior, exterior) = (media_eta[i.index()], media_eta[e.index()]);
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
