//! In which order the library is listed, and what of it: worked out when something has changed, not every frame.

use std::cmp::Ordering;
use std::sync::Arc;

use crate::studio::library::{Item, Library};

/// What the list is sorted by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Key {
    /// From A to Z.
    Name,
    /// What is reached.
    Fitness,
    /// Name of the preset.
    Preset,
    /// The generation, of a run how many there are.
    Generation,
    /// When it was last changed.
    Date,
}

impl Key {
    /// All, in the order of the columns.
    pub const ALL: [Self; 5] =
        [Self::Name, Self::Fitness, Self::Preset, Self::Generation, Self::Date];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Name => "Name",
            Self::Fitness => "Fitness",
            Self::Preset => "Preset",
            Self::Generation => "Generation",
            Self::Date => "Date",
        }
    }
}

/// By what, and from which end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sort {
    /// By what.
    pub key: Key,
    /// Whether the greatest is first.
    pub is_descending: bool,
}

impl Default for Sort {
    /// The newest first.
    fn default() -> Self {
        Self::by(Key::Date)
    }
}

impl Sort {
    /// As people want it first: names from A, the best and the newest on top.
    pub fn by(key: Key) -> Self {
        Self { key, is_descending: matches!(key, Key::Fitness | Key::Generation | Key::Date) }
    }

    /// After a click on a column: the other way round, if it is sorted by that already.
    pub fn clicked(self, key: Key) -> Self {
        if self.key == key { self.reversed() } else { Self::by(key) }
    }

    /// The other way round.
    pub fn reversed(self) -> Self {
        Self { is_descending: !self.is_descending, ..self }
    }

    /// What is not known is last in either direction; equals are in the order of their names.
    fn compare(self, a: &Item, b: &Item) -> Ordering {
        fn known<T>(a: Option<T>, b: Option<T>, compare: impl Fn(&T, &T) -> Ordering) -> Ordering {
            match (a, b) {
                (Some(a), Some(b)) => compare(&a, &b),
                (a, b) => b.is_some().cmp(&a.is_some()),
            }
        }
        let turned = |order: Ordering| if self.is_descending { order.reverse() } else { order };
        let by_name = || a.sorted_as().cmp(b.sorted_as());
        let by_key = match self.key {
            Key::Name => turned(by_name()),
            Key::Fitness => known(a.fitness(), b.fitness(), |a, b| turned(a.total_cmp(b))),
            Key::Preset => known(a.preset(), b.preset(), |a, b| turned(a.cmp(b))),
            Key::Generation => known(a.generation(), b.generation(), |a, b| turned(a.cmp(b))),
            Key::Date => {
                let date = |item: &Item| Some(item.entry().modified).filter(|at| !at.is_zero());
                known(date(a), date(b), |a, b| turned(a.cmp(b)))
            }
        };
        by_key.then_with(by_name).then_with(|| a.place().cmp(b.place()))
    }
}

/// The rows of the list.
#[derive(Debug, Default)]
pub struct Order {
    /// Indices into the library's items.
    rows: Arc<[usize]>,
    made_for: Option<MadeFor>,
    made_at_s: f64,
}

#[derive(Debug, PartialEq)]
struct MadeFor {
    listings: u64,
    sortings: u64,
    search: String,
    sort: Sort,
}

/// While entries are read the list is sorted anew no more often than this, in seconds.
const LEAST_AGE_S: f64 = 0.5;

impl Order {
    /// Sorts and filters anew, if something has changed. `now_s` is the time of the frame, in seconds.
    pub fn update(&mut self, library: &Library, search: &str, sort: Sort, now_s: f64) {
        let wanted = MadeFor {
            listings: library.listings(),
            sortings: library.sortings(),
            search: search.to_lowercase(),
            sort,
        };
        let is_good = self.made_for.as_ref().is_some_and(|made_for| {
            let only_read_on = MadeFor { sortings: wanted.sortings, ..made_for.copy() } == wanted;
            let is_young = library.unread() > 0 && now_s - self.made_at_s < LEAST_AGE_S;
            *made_for == wanted || (only_read_on && is_young)
        });
        if is_good {
            return;
        }
        let sought: Vec<&str> = wanted.search.split_whitespace().collect();
        let items = library.items();
        // Where the places are the same and few entries have changed, the rows are nearly in order already, and
        // sorting them takes no longer than looking at each once.
        let are_same = self.made_for.as_ref().is_some_and(|of| of.listings == wanted.listings);
        let mut rows: Vec<usize> = if are_same && self.rows.len() == items.len() {
            self.rows.to_vec()
        } else {
            (0..items.len()).collect()
        };
        rows.retain(|index| items[*index].has_all(&sought));
        rows.sort_by(|a, b| sort.compare(&items[*a], &items[*b]));
        self.rows = rows.into();
        (self.made_for, self.made_at_s) = (Some(wanted), now_s);
    }

    /// Indices into the library's items, row by row.
    pub fn rows(&self) -> Arc<[usize]> {
        Arc::clone(&self.rows)
    }
}

impl MadeFor {
    fn copy(&self) -> Self {
        Self { search: self.search.clone(), ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::SavesFolder;

    fn library() -> (tempfile::TempDir, Library) {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("Broken.ron"), "(").expect("written");
        let mut library = Library::new(SavesFolder::find(Some(folder.path())));
        library.read_all();
        (folder, library)
    }

    fn names(library: &Library, search: &str, sort: Sort) -> Vec<String> {
        let mut order = Order::default();
        order.update(library, search, sort, 0.0);
        order.rows().iter().map(|row| library.items()[*row].name().to_owned()).collect()
    }

    #[test]
    fn it_is_sorted_both_ways_and_what_is_not_known_is_last_in_both() {
        let (_folder, library) = library();
        let by_name = names(&library, "", Sort::by(Key::Name));
        assert_eq!(by_name[..3], ["Broken", "climber", "fast"]);
        let best = names(&library, "", Sort::by(Key::Fitness));
        let worst = names(&library, "", Sort::by(Key::Fitness).reversed());
        assert_eq!(best[..2], ["climber", "rearer"], "of equals the first by name");
        assert_eq!(worst[0], "first-climber");
        assert_eq!((best.last(), worst.last()), (by_name.first(), by_name.first()));
        assert_eq!(names(&library, "", Sort::default())[0], "Broken", "the only one with a date");
    }

    #[test]
    fn all_words_of_a_search_count() {
        let (_folder, library) = library();
        assert_eq!(names(&library, "DAMAGED", Sort::default()), ["Broken"]);
        assert_eq!(names(&library, " climb  gait rob", Sort::default()), ["robust"]);
        assert!(names(&library, "climb nothing", Sort::default()).is_empty());
    }

    #[test]
    fn nothing_is_sorted_again_as_long_as_nothing_changes() {
        let (_folder, library) = library();
        let mut order = Order::default();
        order.update(&library, "", Sort::default(), 1.0);
        order.update(&library, "", Sort::default(), 9.0);
        assert_eq!(order.made_at_s, 1.0);
        order.update(&library, "f", Sort::default(), 10.0);
        assert_eq!(order.made_at_s, 10.0);
    }
}
