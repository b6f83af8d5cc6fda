//! From the objects of a scene file to the parts of a scene.
//!
//! Here references are followed and values are checked against each other; what a single value
//! may be, its type has said already. Every function gets the struct and, beside it, the node
//! that it was read from, to point at in errors.

mod camera;
mod lamps;
mod materials;
mod rough;
mod shapes;
mod textures;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::dictionary::{Dictionary, Object};
use super::tree::{Member, Node};
use super::trouble::{Outcome, Trouble};
use crate::description::Kind;
use crate::texture::Bitmap;
use crate::{AssembleError, IntegratorSpec, Medium, MediumId, SceneParts, Texture};

/// A scene being built.
pub(crate) struct Builder<'a> {
    dictionary: &'a Dictionary<'a>,
    /// Where the names of meshes and images start from.
    directory: &'a Path,
    media: Vec<Medium>,
    /// Where each medium stands.
    medium_nodes: Vec<&'a Node>,
    /// The media that stand in the scene itself, by the index of their entry.
    shared_media: BTreeMap<usize, MediumId>,
    background: Option<MediumId>,
    textures: Vec<Texture>,
    /// Images by file, raw or not.
    images: BTreeMap<(PathBuf, bool), Arc<Bitmap>>,
}

impl<'a> Builder<'a> {
    pub(crate) fn new(dictionary: &'a Dictionary<'a>, directory: &'a Path) -> Self {
        Self {
            dictionary,
            directory,
            media: Vec::new(),
            medium_nodes: Vec::new(),
            shared_media: BTreeMap::new(),
            background: None,
            textures: Vec::new(),
            images: BTreeMap::new(),
        }
    }

    /// Builds everything.
    pub(crate) fn parts(&mut self) -> Outcome<SceneParts> {
        let dictionary = self.dictionary;
        self.check_shared_materials()?;
        if let Some((medium, node)) = &dictionary.background {
            self.background = Some(self.medium(medium, node, || "background".to_owned())?);
        }
        let (sensor, film) = self.sensor()?;
        let integrator = self.integrator()?;
        let (mut shapes, mut emitters) = (Vec::new(), Vec::new());
        for entry in &dictionary.entries {
            match &entry.object {
                Object::Shape(shape) => shapes.push(self.shape(shape, entry.member)?),
                Object::Emitter(emitter) => emitters.push(self.emitter(emitter, entry.member)?),
                _ => {}
            }
        }
        Ok(SceneParts {
            shapes,
            media: self.media.clone(),
            textures: std::mem::take(&mut self.textures),
            emitters,
            background: self.background,
            sensor,
            film,
            integrator,
        })
    }

    fn integrator(&self) -> Outcome<IntegratorSpec> {
        let entry = self.dictionary.at_most_one(Kind::Integrator)?;
        match entry.map(|entry| (&entry.object, entry.member)) {
            Some((Object::Integrator(integrator), member)) => {
                camera::integrator(integrator, &member.value)
            }
            _ => Ok(IntegratorSpec::default()),
        }
    }

    /// Points at the part that an error of the assembly is about.
    pub(crate) fn blame(&self, error: &AssembleError) -> Trouble {
        let trouble = Trouble::new(error.to_string()).hint(match error {
            AssembleError::Disagreement { .. } => {
                "`interior` is the medium opposite to the normal, `exterior` the one on its side; \
                 on a shape with only one of them the other side is vacuum, or the `background`"
            }
            AssembleError::MediumIndex { .. } => {
                "`int_ior` is the index opposite to the normal, `ext_ior` the one on its side"
            }
            AssembleError::OnBoundary { .. } | AssembleError::OnSurface { .. } => {
                "move it to one side, by more than 1e-9 of the size of the scene"
            }
            AssembleError::AtEmitter { .. } => "move one of them",
            AssembleError::NothingToCover { .. } => "a `laser` has a size and a place of its own",
            AssembleError::Coincident { .. } => {
                "move or shrink one of them; a sheet with two sides is one shape with a `twosided` \
                 BSDF; a liquid that touches glass has one `dielectric` between the two; a medium that walls close in needs no boundary of its own: make it the \
                 `background`"
            }
            AssembleError::NullBetweenUnequalIndices { .. } => {
                "light bends where the index changes: use a `dielectric` there"
            }
        });
        let subject = error.subject();
        let medium = self.media.iter().position(|medium| medium.name == subject);
        if let (AssembleError::MediumIndex { .. }, Some(index)) = (error, medium) {
            return trouble.at(self.medium_nodes[index]);
        }
        let by_id = |member: &&Member| member.key == subject;
        let entries = self.dictionary.root.members().unwrap_or_default();
        match entries.iter().find(by_id) {
            Some(member) => trouble.at_key(member),
            None => trouble.at(self.dictionary.root),
        }
    }
}
