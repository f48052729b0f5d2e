//! Which rows of the library are chosen, by clicks and by keys.

use std::collections::BTreeSet;

use crate::save::library::Place;

/// What is chosen.
#[derive(Debug, Default)]
pub struct Selection {
    chosen: BTreeSet<Place>,
    /// The row at which keys begin.
    cursor: Option<Place>,
    /// Where a range began.
    anchor: Option<Place>,
    changes: u64,
}

impl Selection {
    /// Whether it is chosen.
    pub fn has(&self, place: &Place) -> bool {
        self.chosen.contains(place)
    }

    /// What is chosen.
    pub fn places(&self) -> impl ExactSizeIterator<Item = &Place> {
        self.chosen.iter()
    }

    /// The row at which keys begin.
    pub fn cursor(&self) -> Option<&Place> {
        self.cursor.as_ref()
    }

    /// Changes whenever something else is chosen.
    pub fn changes(&self) -> u64 {
        self.changes
    }

    /// Chooses one alone.
    pub fn only(&mut self, place: &Place) {
        self.changes += 1;
        self.chosen = BTreeSet::from([place.clone()]);
        self.anchor = Some(place.clone());
        self.cursor = Some(place.clone());
    }

    /// Chooses one more, or one less.
    pub fn toggle(&mut self, place: &Place) {
        self.changes += 1;
        if !self.chosen.remove(place) {
            self.chosen.insert(place.clone());
        }
        self.anchor = Some(place.clone());
        self.cursor = Some(place.clone());
    }

    /// Chooses all rows from where the range began to this one.
    pub fn extend<'a>(&mut self, place: &Place, rows: impl Iterator<Item = &'a Place>) {
        let rows: Vec<&Place> = rows.collect();
        let row_of = |wanted: &Place| rows.iter().position(|row| *row == wanted);
        let ends = self.anchor.as_ref().and_then(row_of).zip(row_of(place));
        let Some((from, to)) = ends else { return self.only(place) };
        self.changes += 1;
        let range = &rows[from.min(to)..=from.max(to)];
        self.chosen = range.iter().map(|row| (*row).clone()).collect();
        self.cursor = Some(place.clone());
    }

    /// Chooses all rows.
    pub fn all<'a>(&mut self, rows: impl Iterator<Item = &'a Place>) {
        self.changes += 1;
        self.chosen = rows.cloned().collect();
    }

    /// Forgets what is not there any more.
    pub fn retain(&mut self, is_there: impl Fn(&Place) -> bool) {
        self.changes += 1;
        self.chosen.retain(&is_there);
        self.cursor = self.cursor.take().filter(&is_there);
        self.anchor = self.anchor.take().filter(&is_there);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: [&str; 5] = ["a", "b", "c", "d", "e"];

    fn chosen(selection: &Selection) -> String {
        selection.places().map(Place::name).collect()
    }

    #[test]
    fn clicks_choose_one_some_more_or_a_range() {
        let rows = NAMES.map(Place::Shipped);
        let mut selection = Selection::default();
        selection.only(&rows[1]);
        assert_eq!(chosen(&selection), "b");
        selection.extend(&rows[3], rows.iter());
        assert_eq!(chosen(&selection), "bcd");
        selection.extend(&rows[0], rows.iter());
        assert_eq!(chosen(&selection), "ab", "from where the range began");
        selection.extend(&rows[1], rows.iter());
        assert_eq!(chosen(&selection), "b");
        selection.toggle(&rows[4]);
        assert_eq!(chosen(&selection), "be");
        selection.toggle(&rows[1]);
        assert_eq!(chosen(&selection), "e");
        selection.all(rows.iter());
        assert_eq!(chosen(&selection), "abcde");
        selection.retain(|place| *place != rows[1]);
        assert_eq!((chosen(&selection), selection.cursor()), ("acde".to_owned(), None));
    }
}
