//! What was asked for when a scene was rendered: kept as `NAME.json` beside its results.
//!
//! An order that was carried out is not carried out again: the same scene, methods, film, time and
//! sources make results that differ by the machine's moods alone. So a gallery that was interrupted
//! goes on where it was.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;
use tpb_film::atomic_write;

use crate::error::{Result, ValidationError};

/// Who is flipped with the method whose pictures are shown.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Beside {
    /// Another method.
    Method(String),
    /// None can render the scene; why.
    Nobody(String),
}

/// What is asked for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Order {
    /// Commit of the sources.
    pub commit: String,
    /// The scene, its film as it is rendered.
    pub scene: Value,
    /// The method whose pictures are shown.
    pub method: String,
    /// The other one.
    pub beside: Beside,
    /// Wall time of all renders \[s\].
    pub seconds: f64,
    /// Largest size of the viewer's page \[MB\].
    pub budget: f64,
    /// Whether its results are sound; those that are not are made again.
    pub sound: bool,
}

impl Order {
    /// The order that was carried out last for a scene; `None` if there is none, or not a sound one.
    pub fn read(name: &str, gallery: &Path) -> Option<Self> {
        serde_json::from_slice(&fs::read(file(name, gallery)).ok()?).ok()
    }

    /// Whether it was carried out already, and what came of it is there. Sources that differ from
    /// their commit are not known well enough.
    pub fn is_done(&self, name: &str, gallery: &Path) -> bool {
        let known = !self.commit.ends_with("-dirty") && self.commit != "unknown";
        let mut files = vec![gallery.join(format!("{name}.html")), report(&gallery.join(name))];
        if let Beside::Method(_) = self.beside {
            files.push(report(&beside(name, gallery)));
        }
        known
            && files.iter().all(|file| file.is_file())
            && Self::read(name, gallery).as_ref() == Some(self)
    }

    /// Forgets the last order, before its results are replaced.
    ///
    /// # Errors
    /// If the file cannot be removed.
    pub fn forget(name: &str, gallery: &Path) -> Result<()> {
        match fs::remove_file(file(name, gallery)) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                Err(ValidationError::io(file(name, gallery), error))
            }
            _ => Ok(()),
        }
    }

    /// Keeps it, once it is carried out.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn keep(&self, name: &str, gallery: &Path) -> Result<()> {
        let path = file(name, gallery);
        let text = serde_json::to_string_pretty(self)
            .map_err(|error| ValidationError::unusable(path.display().to_string(), error))?;
        Ok(atomic_write(&path, |file| file.write_all((text + "\n").as_bytes()))?)
    }
}

fn file(name: &str, gallery: &Path) -> PathBuf {
    gallery.join(format!("{name}.json"))
}

/// The result of the method beside.
pub fn beside(name: &str, gallery: &Path) -> PathBuf {
    gallery.join(format!("{name}-beside"))
}

fn report(folder: &Path) -> PathBuf {
    folder.join("report.json")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_same_order_with_its_results_is_done() {
        let folder = tempfile::tempdir().expect("a folder");
        let gallery = folder.path();
        let order = Order {
            commit: "abc".into(),
            scene: serde_json::json!({ "sensor": { "film": { "width": 8 } } }),
            method: "beams".into(),
            beside: Beside::Method("path".into()),
            seconds: 60.0,
            budget: 12.0,
            sound: true,
        };
        order.keep("window", gallery).expect("a file");
        assert!(!order.is_done("window", gallery), "nothing was rendered");
        for path in [gallery.join("window"), beside("window", gallery)] {
            fs::create_dir(&path).expect("a folder");
            fs::write(report(&path), "{}").expect("a file");
        }
        fs::write(gallery.join("window.html"), "").expect("a file");
        assert!(order.is_done("window", gallery) && !order.is_done("liquid", gallery));
        let nobody = Beside::Nobody("none".into());
        for other in [
            Order { seconds: 61.0, ..order.clone() },
            Order { sound: false, ..order.clone() },
            Order { beside: nobody, ..order.clone() },
            Order { scene: Value::Null, ..order.clone() },
            Order { commit: "abd".into(), ..order.clone() },
        ] {
            assert!(!other.is_done("window", gallery), "{other:?}");
        }
        let dirty = Order { commit: "abc-dirty".into(), ..order.clone() };
        dirty.keep("window", gallery).expect("a file");
        assert!(!dirty.is_done("window", gallery));
        Order::forget("window", gallery).expect("to forget");
        Order::forget("window", gallery).expect("nothing is left");
        assert_eq!(Order::read("window", gallery), None);
    }
}
