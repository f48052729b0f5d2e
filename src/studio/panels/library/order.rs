//! Sorted and filtered rows of the library, which are recomputed only after a change.

use std::cmp::Ordering;
use std::sync::Arc;

use crate::studio::state::library::{Library, LibraryItem};
use snakes_core::schema::named_values;

named_values! {
    /// A column by which the list can be sorted, in the order of the columns. Its name is its title.
    pub enum SortKey {
        /// Name of the save.
        Name = "Name";
        /// Part of the way to the landing that a champion, or the best of a run, covered.
        Way = "Way";
        /// Name of the preset of a champion or run.
        Preset = "Preset";
        /// Generation of a champion, or number of generations of a run.
        Generation = "Generation";
        /// Time of the last change of the save.
        Date = "Date";
    }
}

/// Sort key and direction of the list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SortOrder {
    /// Column by which the list is sorted.
    pub key: SortKey,
    /// Whether the largest value comes first in the list.
    pub is_descending: bool,
}

impl Default for SortOrder {
    /// Sorts by date, the newest first.
    fn default() -> Self {
        Self::by(SortKey::Date)
    }
}

impl SortOrder {
    /// Sorts by a key in its default direction: names and presets ascending; way, generation and date descending.
    pub fn by(key: SortKey) -> Self {
        Self {
            key,
            is_descending: matches!(key, SortKey::Way | SortKey::Generation | SortKey::Date),
        }
    }

    /// Returns the order after a click on a column: reversed if the column is the sort key already.
    pub fn clicked(self, key: SortKey) -> Self {
        if self.key == key { self.reversed() } else { Self::by(key) }
    }

    /// Returns this order in the opposite direction.
    pub fn reversed(self) -> Self {
        Self { is_descending: !self.is_descending, ..self }
    }

    /// Compares two items. Unknown values come last in both directions; equal values are ordered by name.
    fn compare(self, a: &LibraryItem, b: &LibraryItem) -> Ordering {
        fn known<T>(a: Option<T>, b: Option<T>, compare: impl Fn(&T, &T) -> Ordering) -> Ordering {
            match (a, b) {
                (Some(a), Some(b)) => compare(&a, &b),
                (a, b) => b.is_some().cmp(&a.is_some()),
            }
        }
        let turned = |order: Ordering| if self.is_descending { order.reverse() } else { order };
        let by_name = || a.sorted_as.cmp(&b.sorted_as);
        let by_key = match self.key {
            SortKey::Name => turned(by_name()),
            SortKey::Way => known(a.way(), b.way(), |a, b| turned(a.total_cmp(b))),
            SortKey::Preset => known(a.preset_title(), b.preset_title(), |a, b| turned(a.cmp(b))),
            SortKey::Generation => known(a.generation(), b.generation(), |a, b| turned(a.cmp(b))),
            SortKey::Date => {
                let date =
                    |item: &LibraryItem| Some(item.entry.modified).filter(|at| !at.is_zero());
                known(date(a), date(b), |a, b| turned(a.cmp(b)))
            }
        };
        by_key.then_with(by_name).then_with(|| a.place().cmp(b.place()))
    }
}

/// Sorted rows of the list, cached.
#[derive(Debug, Default)]
pub struct SortedItems {
    /// Index of each row's item among the library's items.
    pub rows: Arc<[usize]>,
    input: Option<SortInput>,
    sorted_at_s: f64,
}

#[derive(Debug, Clone, PartialEq)]
struct SortInput {
    listings: u64,
    sortings: u64,
    search: String,
    sort: SortOrder,
}

/// Minimum time between two sorts while entries are being read, in seconds.
const MIN_SORT_INTERVAL_S: f64 = 0.5;

impl SortedItems {
    /// Sorts and filters again if something has changed, and returns whether it has. `now_s` is the time of the frame, in
    /// seconds.
    pub fn update(&mut self, library: &Library, search: &str, sort: SortOrder, now_s: f64) -> bool {
        let input_now = SortInput {
            listings: library.listings,
            sortings: library.sortings,
            search: search.to_lowercase(),
            sort,
        };
        let is_current = self.input.as_ref().is_some_and(|input| {
            let only_read_on =
                SortInput { sortings: input_now.sortings, ..input.clone() } == input_now;
            let is_young = library.unread > 0 && now_s - self.sorted_at_s < MIN_SORT_INTERVAL_S;
            *input == input_now || (only_read_on && is_young)
        });
        if is_current {
            return false;
        }
        let words: Vec<&str> = input_now.search.split_whitespace().collect();
        let items = &library.items;
        // If only a few entries have changed, the existing rows are nearly sorted, and sorting them takes linear time.
        let are_same = self.input.as_ref().is_some_and(|of| of.listings == input_now.listings);
        let mut rows: Vec<usize> = if are_same && self.rows.len() == items.len() {
            self.rows.to_vec()
        } else {
            (0..items.len()).collect()
        };
        rows.retain(|index| items[*index].has_all(&words));
        rows.sort_by(|a, b| sort.compare(&items[*a], &items[*b]));
        self.rows = rows.into();
        (self.input, self.sorted_at_s) = (Some(input_now), now_s);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::save::SavesFolder;

    fn library() -> (tempfile::TempDir, Library) {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("Broken.ron"), "(").expect("written");
        let mut library = Library::new(SavesFolder::find(Some(folder.path())));
        library.read_all();
        (folder, library)
    }

    fn names(library: &Library, search: &str, sort: SortOrder) -> Vec<String> {
        let mut order = SortedItems::default();
        order.update(library, search, sort, 0.0);
        order.rows.iter().map(|row| library.items[*row].name().to_owned()).collect()
    }

    #[test]
    fn rows_are_sorted_in_both_directions_with_unknown_values_last() {
        let (_folder, library) = library();
        let by_name = names(&library, "", SortOrder::by(SortKey::Name));
        assert_eq!(by_name[..3], ["Broken", "by-heart", "climber"]);
        let best = names(&library, "", SortOrder::by(SortKey::Way));
        let worst = names(&library, "", SortOrder::by(SortKey::Way).reversed());
        assert_eq!(best[..2], ["by-heart", "climber"], "of equals the first by name");
        assert_eq!(worst[..2], ["first-climber", "learner"], "3 steps, and 14.22 m");
        assert_eq!((best.last(), worst.last()), (by_name.first(), by_name.first()));
        let by_date = names(&library, "", SortOrder::default());
        assert_eq!(by_date[0], "Broken", "the only one with a date");
    }

    #[test]
    fn a_search_must_match_all_words() {
        let (_folder, library) = library();
        assert_eq!(names(&library, "DAMAGED", SortOrder::default()), ["Broken"]);
        assert_eq!(names(&library, " climb  gait rob", SortOrder::default()), ["robust"]);
        assert!(names(&library, "climb nothing", SortOrder::default()).is_empty());
    }

    #[test]
    fn rows_are_sorted_again_only_after_a_change() {
        let (_folder, library) = library();
        let mut order = SortedItems::default();
        order.update(&library, "", SortOrder::default(), 1.0);
        order.update(&library, "", SortOrder::default(), 9.0);
        assert_eq!(order.sorted_at_s, 1.0);
        order.update(&library, "f", SortOrder::default(), 10.0);
        assert_eq!(order.sorted_at_s, 10.0);
    }
}
