//! The table: the learned value of each action in each state.
//!
//! Every method accepts any numbers. A state or an action outside the table must not end a program that reads an old save. Nothing is
//! learned from such a transition.

use serde::{Deserialize, Serialize};

use super::q_rule::QRule;
use super::sparse_values::SparseValues;
use super::transition::{Next, Transition};
use crate::check::Invalid;

/// Largest absolute value of an entry. Values are clamped to it, so that a table can always be read back, even if rewards without discount
/// grow without limit.
pub const LARGEST_VALUE: f32 = 1e9;

/// The values of all actions in all states, with the number of visits of each pair. All values are 0 at first.
///
/// A save contains only the visited states ([`SparseValues`]).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(into = "SparseValues", try_from = "SparseValues")]
pub struct ActionValues {
    /// Number of states.
    pub(crate) states: usize,
    /// Number of actions in each state.
    pub(crate) actions: usize,
    /// Values state by state, one per action.
    pub(super) values: Vec<f32>,
    /// Number of experiences with each pair of state and action. It stays at its maximum once it is reached.
    pub(super) visits: Vec<u16>,
}

impl ActionValues {
    /// Creates a table without experience. The caller keeps `states` times `actions` within [`MOST_PAIRS`](super::MOST_PAIRS), because a
    /// larger table could not be read back from a save.
    pub fn new(states: usize, actions: usize) -> Self {
        let pairs = states.saturating_mul(actions);
        Self { states, actions, values: vec![0.0; pairs], visits: vec![0; pairs] }
    }

    /// Returns the values of all actions in a state; empty if there is no such state.
    pub fn values(&self, state: usize) -> &[f32] {
        row(&self.values, state, self.actions)
    }

    /// Returns the visits of all actions in a state; empty if there is no such state.
    pub fn visits(&self, state: usize) -> &[u16] {
        row(&self.visits, state, self.actions)
    }

    /// Checks that the table has this number of states and of actions.
    ///
    /// # Errors
    ///
    /// Returns the number that differs.
    pub fn check(&self, states: usize, actions: usize) -> Result<(), Invalid> {
        for (field, count, expected) in
            [("states", self.states, states), ("actions", self.actions, actions)]
        {
            if count != expected {
                return Err(Invalid::new(field, count, expected.to_string()));
            }
        }
        Ok(())
    }

    /// Moves the value of a transition's pair towards its outcome and counts the visit, unless the value would not be finite. The outcome
    /// is the reward plus the discounted value that `worth` returns for the next state. Returns the outcome; `None` if the transition does
    /// not fit the table.
    pub(super) fn learn(
        &mut self,
        transition: &Transition,
        rule: &QRule,
        worth: impl FnOnce(&Self, usize) -> f32,
    ) -> Option<f32> {
        transition.check(self.states, self.actions).ok()?;
        let future = match transition.next {
            Next::Terminal => 0.0,
            Next::State(next) => rule.discount(transition.ticks) * worth(self, next as usize),
        };
        let outcome = transition.reward + future;
        let pair = transition.state as usize * self.actions + usize::from(transition.action);
        let value = self.values[pair];
        let moved = value + rule.rate(self.visits[pair]) * (outcome - value);
        if moved.is_finite() {
            self.values[pair] = moved.clamp(-LARGEST_VALUE, LARGEST_VALUE);
            self.visits[pair] = self.visits[pair].saturating_add(1);
        }
        Some(outcome)
    }
}

/// Returns the entries of one state; empty if there is no such state.
fn row<T>(entries: &[T], state: usize, actions: usize) -> &[T] {
    let start = state.saturating_mul(actions);
    entries.get(start..start.saturating_add(actions)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learn::q_table::LARGEST_REWARD;

    const HALF: QRule =
        QRule { discount_per_tick: 0.5, rate_scale: 0.5, rate_power: 0.0, rate_floor: 0.0 };

    fn transition(state: u32, action: u16, reward: f32, next: Next) -> Transition {
        Transition { state, action, reward, ticks: 2, next }
    }

    #[test]
    fn an_update_moves_the_value_by_the_rate_times_the_error() {
        let mut table = ActionValues::new(3, 2);
        table.update(&transition(1, 0, 8.0, Next::Terminal), &HALF);
        assert_eq!(table.values(1), [4.0, 0.0]);
        // Two ticks are discounted by 0.5 each: the target is 1 + 0.25 · 4 = 2, and half of it is learned.
        table.update(&transition(0, 1, 1.0, Next::State(1)), &HALF);
        assert_eq!(table.values(0), [0.0, 1.0]);
        table.update(&transition(0, 1, 1.0, Next::State(1)), &HALF);
        assert_eq!(table.values(0), [0.0, 1.5]);
        assert_eq!(
            (table.visits(0), table.visits(1), table.visits(2)),
            (&[0, 2][..], &[1, 0][..], &[0, 0][..])
        );
    }

    #[test]
    fn the_rate_of_an_update_is_that_of_the_visits_before_it() {
        let rule = QRule { rate_power: 1.0, rate_scale: 1.0, ..HALF };
        let mut table = ActionValues::new(1, 1);
        // With the rates 1, 1/2, 1/3, the value is the mean of the rewards.
        for (reward, mean) in [(6.0, 6.0), (2.0, 4.0), (1.0, 3.0)] {
            table.update(&transition(0, 0, reward, Next::Terminal), &rule);
            assert!((table.values(0)[0] - mean).abs() < 1e-6, "{:?}", table.values(0));
        }
    }

    #[test]
    fn the_end_of_time_counts_the_state_in_which_it_came_and_a_terminal_one_does_not() {
        let mut table = ActionValues::new(2, 1);
        table.update(&transition(1, 0, 8.0, Next::Terminal), &HALF);
        let (mut out_of_time, mut ended) = (table.clone(), table);
        out_of_time.update(&transition(0, 0, 0.0, Next::State(1)), &HALF);
        ended.update(&transition(0, 0, 0.0, Next::Terminal), &HALF);
        assert_eq!((out_of_time.values(0), ended.values(0)), (&[0.5][..], &[0.0][..]));
    }

    #[test]
    fn numbers_outside_the_table_do_no_harm() {
        let mut table = ActionValues::new(2, 2);
        let untouched = table.clone();
        for bad in [
            transition(2, 0, 1.0, Next::Terminal),
            transition(u32::MAX, u16::MAX, 1.0, Next::Terminal),
            transition(0, 2, 1.0, Next::Terminal),
            transition(0, 0, 1.0, Next::State(2)),
            transition(0, 0, f32::NAN, Next::Terminal),
            transition(0, 0, f32::INFINITY, Next::State(1)),
        ] {
            table.update(&bad, &HALF);
            assert_eq!(table, untouched, "{bad:?}");
        }
        let unchecked = QRule { rate_scale: f32::INFINITY, ..HALF };
        table.update(&transition(0, 0, 1.0, Next::Terminal), &unchecked);
        assert_eq!(table, untouched);
        assert_eq!((table.values(2).len(), table.visits(usize::MAX).len()), (0, 0));
        assert_eq!(table.check(2, 12).unwrap_err().to_string(), "actions is 2; allowed: 12");
    }

    #[test]
    fn values_and_visits_stay_within_their_limits() {
        let mut table = ActionValues::new(1, 1);
        let rule = QRule::with_constant_rate(1.0, 1.0);
        let gain = transition(0, 0, LARGEST_REWARD, Next::State(0));
        for _ in 0..70_000 {
            table.update(&gain, &rule);
        }
        assert_eq!((table.values(0), table.visits(0)), (&[LARGEST_VALUE][..], &[u16::MAX][..]));
    }
}
