//! Cache of recent meshes, materials and textures, which lanes that look alike share.

/// Returns the value of a key from a cache, which has the oldest value first. If the value is not cached, calls `make`, and
/// removes the oldest value if there are `most` already.
pub(super) fn cached<K: Clone + PartialEq, V: Clone>(
    cache: &mut Vec<(K, V)>,
    key: &K,
    most: usize,
    make: impl FnOnce() -> V,
) -> V {
    if let Some((_, known)) = cache.iter().find(|(of, _)| of == key) {
        return known.clone();
    }
    if cache.len() == most {
        cache.remove(0);
    }
    let new = make();
    cache.push((key.clone(), new.clone()));
    new
}
