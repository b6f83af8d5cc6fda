//! The last renders of a run, kept for those who would make the very same ones again: the twins
//! whose defect acts on the finished estimate, and the partners of one method in comparisons of
//! methods.
//!
//! A render is a pure function of its key (scene, method, film, passes, seed), so that recalling it
//! and making it again are the same to the bit.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

use crate::cube::Cube;
use crate::error::Result;

/// Numbers that are kept at most, about 256 MB.
const MOST_VALUES: usize = 1 << 25;

/// A batch of each.
pub type Cubes = Arc<Vec<Cube>>;

/// Renders by their key, the oldest first.
#[derive(Debug, Default)]
pub struct Memory(Mutex<VecDeque<(String, Cubes)>>);

impl Memory {
    /// The cubes of this key: recalled, or made and kept as long as there is room.
    pub fn recall(&self, key: &str, make: impl FnOnce() -> Result<Vec<Cube>>) -> Result<Cubes> {
        let kept = |list: &VecDeque<(String, Cubes)>| {
            list.iter().find(|(known, _)| known == key).map(|(_, cubes)| cubes.clone())
        };
        if let Some(cubes) = kept(&self.0.lock().unwrap_or_else(PoisonError::into_inner)) {
            return Ok(cubes);
        }
        let cubes = Arc::new(make()?);
        let mut list = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        list.push_back((key.to_owned(), cubes.clone()));
        while list.iter().map(|(_, cubes)| size(cubes)).sum::<usize>() > MOST_VALUES {
            list.pop_front();
        }
        Ok(cubes)
    }
}

fn size(cubes: &[Cube]) -> usize {
    cubes.iter().map(|cube| cube.values.len()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_made_is_recalled_until_there_is_no_room() {
        let memory = Memory::default();
        let cube = || vec![Cube::zero(1 << 12, 1 << 11, 0)];
        let mut made = 0;
        let mut ask = |key: &str| {
            let made = &mut made;
            memory
                .recall(key, || {
                    *made += 1;
                    Ok(cube())
                })
                .unwrap();
            *made
        };
        assert_eq!((ask("a"), ask("a"), ask("b"), ask("a")), (1, 1, 2, 2));
        // Each has 2^24 values: the third does not fit beside the first two.
        assert_eq!((ask("c"), ask("c"), ask("a")), (3, 3, 4));
    }
}
