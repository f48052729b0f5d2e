//! Selection of rows in the library by clicks and keys.

use std::collections::BTreeSet;

use snakes_core::save::library::SavePlace;

/// The selected saves, with cursor and anchor.
#[derive(Debug, Default)]
pub struct ChosenSaves {
    /// The selected saves.
    pub chosen: BTreeSet<SavePlace>,
    /// Row from which keys move the cursor.
    pub cursor: Option<SavePlace>,
    /// Row at which a range of selected rows starts.
    anchor: Option<SavePlace>,
    /// Counter that every change of the selection increments.
    pub changes: u64,
}

impl ChosenSaves {
    /// Selects one save only.
    pub fn only(&mut self, place: &SavePlace) {
        self.chosen.clear();
        self.toggle(place);
    }

    /// Adds a save to the selection, or removes it if it is selected.
    pub fn toggle(&mut self, place: &SavePlace) {
        self.changes += 1;
        if !self.chosen.remove(place) {
            self.chosen.insert(place.clone());
        }
        self.anchor = Some(place.clone());
        self.cursor = Some(place.clone());
    }

    /// Selects all rows from the anchor to the row of this save.
    pub fn extend<'a>(&mut self, place: &SavePlace, rows: impl Iterator<Item = &'a SavePlace>) {
        let rows: Vec<&SavePlace> = rows.collect();
        let row_of = |wanted: &SavePlace| rows.iter().position(|row| *row == wanted);
        let ends = self.anchor.as_ref().and_then(row_of).zip(row_of(place));
        let Some((from, to)) = ends else { return self.only(place) };
        self.changes += 1;
        let range = &rows[from.min(to)..=from.max(to)];
        self.chosen = range.iter().map(|row| (*row).clone()).collect();
        self.cursor = Some(place.clone());
    }

    /// Selects all rows.
    pub fn all<'a>(&mut self, rows: impl Iterator<Item = &'a SavePlace>) {
        self.changes += 1;
        self.chosen = rows.cloned().collect();
    }

    /// Removes saves that do not exist any more from the selection.
    pub fn retain(&mut self, exists: impl Fn(&SavePlace) -> bool) {
        self.changes += 1;
        self.chosen.retain(&exists);
        self.cursor = self.cursor.take().filter(&exists);
        self.anchor = self.anchor.take().filter(&exists);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: [&str; 5] = ["a", "b", "c", "d", "e"];

    fn chosen(selection: &ChosenSaves) -> String {
        selection.chosen.iter().map(SavePlace::name).collect()
    }

    #[test]
    fn clicks_select_one_row_several_rows_or_a_range() {
        let rows = NAMES.map(SavePlace::Shipped);
        let mut selection = ChosenSaves::default();
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
        assert_eq!((chosen(&selection), selection.cursor), ("acde".to_owned(), None));
    }
}
