//! The form in which a table is saved: only the visited states.
//!
//! A snake visits perhaps a tenth of its states, so most of a table is zeros. Each table has exactly one saved form: rows in ascending
//! order, none without a visit. Equal tables are therefore equal as text.

use serde::{Deserialize, Serialize};

use super::action_values::{ActionValues, LARGEST_VALUE};
use super::transition::check_index;
use crate::check::Invalid;
use crate::check::within;

/// Greatest number of pairs of state and action of a table that is read, which takes 6 MiB. Without a limit, a short text could request
/// any amount of memory.
pub const MOST_PAIRS: usize = 1 << 20;

/// A table as it is saved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SparseValues {
    /// Number of states of the table, visited or not.
    pub states: usize,
    /// Number of actions in each state.
    pub actions: usize,
    /// Visited states, in ascending order.
    pub rows: Vec<SparseRow>,
}

/// A visited state: its number, the values and the visits of all its actions. A value without a visit is 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SparseRow(pub usize, pub Vec<f32>, pub Vec<u16>);

impl SparseValues {
    /// Checks that this is a table that could have been learned and saved.
    ///
    /// # Errors
    ///
    /// Returns the first number that is not allowed.
    pub fn check(&self) -> Result<(), Invalid> {
        within("actions", self.actions, 1..=usize::from(u16::MAX) + 1)?;
        within("states", self.states, 1..=MOST_PAIRS / self.actions)?;
        let mut least = 0;
        for (index, row) in self.rows.iter().enumerate() {
            let parent = format!("rows[{index}]");
            self.check_row(row, least).map_err(|error| error.inside(&parent))?;
            least = row.0 + 1;
        }
        Ok(())
    }

    /// Checks one row, whose state must be `least` or a later one.
    fn check_row(&self, row: &SparseRow, least: usize) -> Result<(), Invalid> {
        let SparseRow(state, values, visits) = row;
        check_index("state", *state, self.states)?;
        if *state < least {
            return Err(Invalid::new("state", state, "states in rising order"));
        }
        for (field, length) in [("values", values.len()), ("visits", visits.len())] {
            if length != self.actions {
                let expected = self.actions.to_string();
                return Err(Invalid::new(field, format!("{length} numbers"), expected));
            }
        }
        for (&value, &visits) in values.iter().zip(visits) {
            within("values", value, -LARGEST_VALUE..=LARGEST_VALUE)?;
            if visits == 0 && value.to_bits() != 0 {
                return Err(Invalid::new("values", value, "0 for an action without a visit"));
            }
        }
        if visits.iter().all(|&visits| visits == 0) {
            return Err(Invalid::new("visits", "0 for every action", "rows with a visit"));
        }
        Ok(())
    }
}

impl From<ActionValues> for SparseValues {
    fn from(table: ActionValues) -> Self {
        let row =
            |state| SparseRow(state, table.values(state).to_vec(), table.visits(state).to_vec());
        let visited = |state: &usize| table.visits(*state).iter().any(|&visits| visits > 0);
        let rows = (0..table.states).filter(visited).map(row).collect();
        Self { states: table.states, actions: table.actions, rows }
    }
}

impl TryFrom<SparseValues> for ActionValues {
    type Error = Invalid;

    fn try_from(sparse: SparseValues) -> Result<Self, Invalid> {
        sparse.check()?;
        let mut table = Self::new(sparse.states, sparse.actions);
        for SparseRow(state, values, visits) in &sparse.rows {
            let pairs = state * sparse.actions..(state + 1) * sparse.actions;
            table.values[pairs.clone()].copy_from_slice(values);
            table.visits[pairs].copy_from_slice(visits);
        }
        Ok(table)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learn::q_table::{Next, QRule, Transition};

    fn learned() -> ActionValues {
        let mut table = ActionValues::new(1728, 12);
        for i in 0..200_u16 {
            let state = u32::from(i) * 37 % 1728;
            let next = if i % 9 == 0 { Next::Terminal } else { Next::State(state / 2) };
            let reward = f32::from(i) / 7.0 - 10.0;
            let transition = Transition { state, action: i % 12, reward, ticks: 15, next };
            table.update(&transition, &QRule::default());
        }
        table
    }

    fn saved() -> SparseValues {
        let row = |state| SparseRow(state, vec![0.5, 0.0], vec![3, 0]);
        SparseValues { states: 10, actions: 2, rows: vec![row(2), row(7)] }
    }

    #[test]
    fn a_save_holds_only_visited_states_and_every_bit_of_them() {
        let table = learned();
        let sparse = SparseValues::from(table.clone());
        assert!(
            sparse.rows.len() <= 200 && sparse.rows.windows(2).all(|pair| pair[0].0 < pair[1].0)
        );
        let ron = ron::to_string(&table).unwrap();
        let json = serde_json::to_string(&table).unwrap();
        let bits = |table: &ActionValues| -> Vec<u32> {
            table.values.iter().map(|value| value.to_bits()).collect()
        };
        let read: [ActionValues; 2] =
            [ron::from_str(&ron).unwrap(), serde_json::from_str(&json).unwrap()];
        for read in read {
            assert_eq!(read, table);
            assert_eq!(bits(&read), bits(&table));
        }
    }

    #[test]
    fn a_row_is_written_as_state_values_and_visits() {
        let text = serde_json::to_string(&saved()).unwrap();
        let expected =
            r#"{"states":10,"actions":2,"rows":[[2,[0.5,0.0],[3,0]],[7,[0.5,0.0],[3,0]]]}"#;
        assert_eq!(text, expected);
        assert_eq!(SparseValues::from(ActionValues::try_from(saved()).unwrap()), saved());
    }

    #[test]
    fn hostile_tables_are_refused_with_field_value_and_range() {
        type Damage = fn(&mut SparseValues);
        let damages: [(Damage, &str); 14] = [
            (|t| t.actions = 0, "actions is 0; allowed: 1 to 65536"),
            (
                |t| t.actions = usize::MAX,
                &format!("actions is {}; allowed: 1 to 65536", usize::MAX),
            ),
            (|t| t.states = 0, "states is 0; allowed: 1 to 524288"),
            (|t| t.states = 524_289, "states is 524289; allowed: 1 to 524288"),
            (|t| t.rows[1].0 = 10, "rows[1].state is 10; allowed: 0 to 9"),
            (
                |t| t.rows[1].0 = usize::MAX,
                &format!("rows[1].state is {}; allowed: 0 to 9", usize::MAX),
            ),
            (|t| t.rows[1].0 = 2, "rows[1].state is 2; allowed: states in rising order"),
            (|t| t.rows.swap(0, 1), "rows[1].state is 2; allowed: states in rising order"),
            (|t| t.rows[0].1.push(0.0), "rows[0].values is 3 numbers; allowed: 2"),
            (|t| t.rows[0].2.clear(), "rows[0].visits is 0 numbers; allowed: 2"),
            (
                |t| t.rows[1].1[0] = f32::NAN,
                "rows[1].values is NaN; allowed: -1000000000 to 1000000000",
            ),
            (
                |t| t.rows[1].1[0] = f32::NEG_INFINITY,
                "rows[1].values is -inf; allowed: -1000000000 to 1000000000",
            ),
            (
                |t| t.rows[0].1[1] = 1.0,
                "rows[0].values is 1; allowed: 0 for an action without a visit",
            ),
            (
                |t| (t.rows[0].1[0], t.rows[0].2[0]) = (0.0, 0),
                "rows[0].visits is 0 for every action; allowed: rows with a visit",
            ),
        ];
        assert_eq!(saved().check(), Ok(()));
        for (damage, message) in damages {
            let mut hostile = saved();
            damage(&mut hostile);
            assert_eq!(ActionValues::try_from(hostile.clone()).unwrap_err().to_string(), message);
            // Reading the table from text makes the same check.
            let text = ron::to_string(&hostile).unwrap();
            let error = ron::from_str::<ActionValues>(&text).unwrap_err().to_string();
            assert!(error.contains(message), "{error}");
        }
    }
}
