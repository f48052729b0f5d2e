//! Cache of recent meshes, materials and textures, which lanes that look alike share.

/// Cached values by key, the oldest first.
#[derive(Debug)]
pub(crate) struct SceneCache<K, V>(Vec<(K, V)>);

impl<K, V> Default for SceneCache<K, V> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<K: Clone + PartialEq, V: Clone> SceneCache<K, V> {
    /// Returns the value of a key. If it is not cached, calls `make`, and removes the oldest value if there are `most` already.
    pub fn get(&mut self, key: &K, most: usize, make: impl FnOnce() -> V) -> V {
        if let Some((_, known)) = self.0.iter().find(|(of, _)| of == key) {
            return known.clone();
        }
        if self.0.len() == most {
            self.0.remove(0);
        }
        let new = make();
        self.0.push((key.clone(), new.clone()));
        new
    }

    /// Returns all cached values.
    pub fn values(&self) -> impl Iterator<Item = &V> {
        self.0.iter().map(|(_, value)| value)
    }
}
