//! The objects of a scene by their ids, and what a reference refers to.

use std::collections::BTreeMap;

use super::de::read;
use super::names;
use super::tree::{Member, Node, Value};
use super::trouble::{Outcome, Trouble};
use super::vocabulary;
use crate::description::{
    Bsdf, Emitter, Integrator, Kind, Medium, Phase, Reference, Sensor, Shape,
};

/// One object of the scene.
pub(crate) struct Entry<'a> {
    /// Its id and its place.
    pub(crate) member: &'a Member,
    pub(crate) object: Object,
}

/// What the object is.
pub(crate) enum Object {
    Integrator(Integrator),
    Sensor(Sensor),
    Shape(Shape),
    Emitter(Emitter),
    Bsdf(Bsdf),
    Medium(Medium),
    Phase(Phase),
}

/// All objects of a scene in the order of the file.
pub(crate) struct Dictionary<'a> {
    pub(crate) root: &'a Node,
    pub(crate) entries: Vec<Entry<'a>>,
    by_id: BTreeMap<&'a str, usize>,
    /// The medium outside of all others; not an object of its own, since no id refers to it.
    pub(crate) background: Option<(Medium, &'a Node)>,
}

/// The key of the scene-level medium.
const BACKGROUND: &str = "background";

impl<'a> Dictionary<'a> {
    /// Reads every object of a scene.
    pub(crate) fn read(root: &'a Node) -> Outcome<Self> {
        let Value::Object(members) = &root.value else {
            return Err(
                Trouble::new("a scene is a JSON object: {\"type\": \"scene\", ...}").at(root)
            );
        };
        require_scene(root)?;
        let (entries, by_id) = (Vec::new(), BTreeMap::new());
        let mut dictionary = Self { root, entries, by_id, background: None };
        for member in members.iter().filter(|member| member.key != "type") {
            if member.key == BACKGROUND {
                dictionary.background = Some((read(&member.value)?, &member.value));
                continue;
            }
            dictionary.by_id.insert(&member.key, dictionary.entries.len());
            dictionary.entries.push(Entry { member, object: object(member)? });
        }
        Ok(dictionary)
    }

    /// The index of the object that a reference means.
    pub(crate) fn index(&self, reference: &Reference, node: &Node, kind: Kind) -> Outcome<usize> {
        let place = node.get_or_self("id");
        let id = names::shortened(&reference.id);
        let Some(&index) = self.by_id.get(reference.id.as_str()) else {
            let same_kind = self.entries.iter().filter(|e| e.kind() == kind);
            let ids = || same_kind.clone().map(|e| e.member.key.as_str());
            let known: Vec<_> = ids().take(12).collect();
            let trouble = Trouble::new(format!("the scene has no object `{id}`")).at(place);
            return Err(match names::did_you_mean(&reference.id, ids()) {
                Some(hint) => trouble.hint(hint),
                None if known.is_empty() => trouble.hint(format!("the scene does not hold {kind}")),
                None => trouble.hint(format!("{kind} can be {}", names::one_of(&known))),
            });
        };
        let found = self.entries[index].kind();
        if found != kind {
            let message = format!("`{id}` is {found}, but {kind} is expected here");
            return Err(Trouble::new(message).at(place));
        }
        Ok(index)
    }

    /// The only object of its kind, if there is one; a second one is an error.
    pub(crate) fn at_most_one(&self, kind: Kind) -> Outcome<Option<&Entry<'a>>> {
        let mut found = self.entries.iter().filter(|entry| entry.kind() == kind);
        let first = found.next();
        if let (Some(first), Some(second)) = (first, found.next()) {
            let message = format!(
                "a scene has at most one {}, but `{}` is one already",
                kind.key(),
                names::shortened(&first.member.key)
            );
            return Err(Trouble::new(message).at_key(second.member));
        }
        Ok(first)
    }
}

impl Entry<'_> {
    /// Its kind.
    pub(crate) fn kind(&self) -> Kind {
        match self.object {
            Object::Integrator(_) => Kind::Integrator,
            Object::Sensor(_) => Kind::Sensor,
            Object::Shape(_) => Kind::Shape,
            Object::Emitter(_) => Kind::Emitter,
            Object::Bsdf(_) => Kind::Bsdf,
            Object::Medium(_) => Kind::Medium,
            Object::Phase(_) => Kind::Phase,
        }
    }
}

fn require_scene(root: &Node) -> Outcome<()> {
    let Some(node) = root.get("type") else {
        return Err(
            Trouble::new("`type` is missing: a scene begins with `\"type\": \"scene\"`").at(root)
        );
    };
    match node.as_str() {
        Some("scene") => Ok(()),
        _ => Err(Trouble::new("the `type` of a scene is `scene`").at(node)),
    }
}

fn object(member: &Member) -> Outcome<Object> {
    let node = &member.value;
    Ok(match vocabulary::kind_of_object(member)? {
        Kind::Integrator => Object::Integrator(read(node)?),
        Kind::Sensor => Object::Sensor(read(node)?),
        Kind::Shape => Object::Shape(read(node)?),
        Kind::Emitter => Object::Emitter(read(node)?),
        Kind::Bsdf => Object::Bsdf(read(node)?),
        Kind::Medium => Object::Medium(read(node)?),
        Kind::Phase => Object::Phase(read(node)?),
        kind @ (Kind::Film | Kind::Rfilter | Kind::ShapeEmitter) => {
            return Err(Trouble::new(format!("{kind} cannot stand in the scene itself")).at(node));
        }
    })
}
