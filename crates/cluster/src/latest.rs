//! A cache of the values that were used last, by hash.

use std::sync::{Mutex, PoisonError};

/// Values by hash. When the cache is full, the value that was used least recently is removed.
#[derive(Debug)]
pub struct Latest<T> {
    most: usize,
    /// Hashes and values, the most recently used last.
    kept: Mutex<Vec<(u64, T)>>,
}

impl<T: Clone> Latest<T> {
    /// Creates an empty cache for at most this number of values.
    pub fn new(most: usize) -> Self {
        Self { most, kept: Mutex::default() }
    }

    /// Keeps a value. If the cache is full, it replaces the value that was used least recently.
    pub fn keep(&self, hash: u64, value: T) {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.retain(|(of, _)| *of != hash);
        if kept.len() >= self.most {
            kept.remove(0);
        }
        kept.push((hash, value));
    }

    /// Returns the value with this hash, if it is kept, and marks it as used.
    pub fn get(&self, hash: u64) -> Option<T> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let at = kept.iter().position(|(of, _)| *of == hash)?;
        let found = kept.remove(at);
        let value = found.1.clone();
        kept.push(found);
        Some(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_value_that_was_used_least_recently_gives_way() {
        let latest = Latest::new(2);
        latest.keep(1, "one");
        latest.keep(2, "two");
        assert_eq!(latest.get(1), Some("one"));
        latest.keep(3, "three");
        latest.keep(3, "three again");
        assert_eq!(
            [1, 2, 3].map(|hash| latest.get(hash)),
            [Some("one"), None, Some("three again")]
        );
    }
}
