//! How an action is chosen from the values of a state, while the table learns and afterwards.

use rand::Rng;

use super::action_values::ActionValues;

impl ActionValues {
    /// The action of the largest value in a state, of equal ones the first; 0 if there is no such state.
    /// This is how a table acts that no longer learns.
    pub fn greedy(&self, state: usize) -> usize {
        let values = self.values(state).iter().enumerate();
        let best =
            values.reduce(|best, next| if next.1.total_cmp(best.1).is_gt() { next } else { best });
        best.map_or(0, |(action, _)| action)
    }

    /// The action of the largest value in a state, a random one of equal ones; 0 if there is no such state.
    ///
    /// A table that learns needs this: with the first of equal values it would try the same
    /// action again and again wherever it knows nothing. It draws exactly one number, also where
    /// only one action is best, so that the numbers drawn later do not depend on the last bits of
    /// values.
    pub fn greedy_among_ties(&self, state: usize, random: &mut impl Rng) -> usize {
        let best = self.largest(state);
        let is_best = |value: &f32| value.total_cmp(&best).is_eq();
        let ties = self.values(state).iter().filter(|value| is_best(value)).count();
        let chosen = index_below(ties, random);
        let actions = self.values(state).iter().enumerate().filter(|(_, value)| is_best(value));
        actions.map(|(action, _)| action).nth(chosen).unwrap_or(0)
    }

    /// Any action with probability `epsilon` (0 to 1), otherwise [`Self::greedy_among_ties`]. It draws
    /// exactly two numbers.
    pub fn epsilon_greedy(&self, state: usize, epsilon: f32, random: &mut impl Rng) -> usize {
        if unit(random) < f64::from(epsilon) {
            index_below(self.actions, random)
        } else {
            self.greedy_among_ties(state, random)
        }
    }

    /// The largest value in a state; 0 if there is no such state.
    pub(super) fn largest(&self, state: usize) -> f32 {
        self.values(state).get(self.greedy(state)).copied().unwrap_or(0.0)
    }
}

/// An index below `count`, or 0 if `count` is 0, from exactly one number: the upper half of its product
/// with `count`. One index is likelier than another by at most `count` / 2⁶⁴.
fn index_below(count: usize, random: &mut impl Rng) -> usize {
    ((u128::from(random.next_u64()) * count as u128) >> 64) as usize
}

/// A number from 0 to below 1, from exactly one number.
fn unit(random: &mut impl Rng) -> f64 {
    (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learn::q_table::{Next, QRule, Transition};
    use crate::rng::{Purpose, stream};

    /// A table in which one pair has a value.
    fn table(states: usize, actions: usize, state: u32, action: u16, value: f32) -> ActionValues {
        let mut table = ActionValues::new(states, actions);
        teach(&mut table, state, action, value);
        table
    }

    fn teach(table: &mut ActionValues, state: u32, action: u16, reward: f32) {
        let transition = Transition { state, action, reward, ticks: 1, next: Next::Terminal };
        table.update(&transition, &QRule::with_constant_rate(1.0, 1.0));
    }

    #[test]
    fn equal_values_are_chosen_equally_often_while_learning_and_the_first_afterwards() {
        let mut table = table(1, 4, 0, 2, -1.0);
        assert_eq!(table.greedy(0), 0);
        let mut random = stream(1, 0, 0, Purpose::Birth);
        let mut counts = [0; 4];
        (0..3000).for_each(|_| counts[table.greedy_among_ties(0, &mut random)] += 1);
        assert_eq!(counts[2], 0);
        assert!([0, 1, 3].into_iter().all(|i| (900..1100).contains(&counts[i])), "{counts:?}");
        teach(&mut table, 0, 3, 1.0);
        assert_eq!(table.greedy(0), 3);
        assert!((0..100).all(|_| table.greedy_among_ties(0, &mut random) == 3));
    }

    #[test]
    fn a_choice_always_draws_equally_many_numbers() {
        let table = table(2, 3, 1, 1, 1.0);
        // A tie, a single best action, and a state that does not exist.
        for state in [0, 1, 2] {
            let mut reference = stream(1, 0, 0, Purpose::Birth);
            let mut random = reference.clone();
            table.greedy_among_ties(state, &mut random);
            reference.next_u64();
            assert_eq!(random, reference, "state {state}");
            for epsilon in [0.0, 0.5, 1.0] {
                table.epsilon_greedy(state, epsilon, &mut random);
                reference.next_u64();
                reference.next_u64();
                assert_eq!(random, reference, "state {state}, epsilon {epsilon}");
            }
        }
    }

    #[test]
    fn epsilon_is_the_share_of_choices_that_ignore_the_values() {
        let table = table(1, 4, 0, 1, 1.0);
        let mut random = stream(2, 0, 0, Purpose::Birth);
        let mut others = |epsilon| {
            (0..4000).filter(|_| table.epsilon_greedy(0, epsilon, &mut random) != 1).count()
        };
        assert_eq!(others(0.0), 0);
        // Three of four random actions are not the best one: 0.4 · 3/4 and 3/4 of 4000.
        let (some, all) = (others(0.4), others(1.0));
        assert!((1100..1300).contains(&some) && (2880..3120).contains(&all), "{some}, {all}");
    }

    #[test]
    fn a_state_outside_the_table_has_action_0() {
        let mut random = stream(1, 0, 0, Purpose::Birth);
        let known = table(2, 2, 1, 1, 1.0);
        assert_eq!((known.greedy(7), known.greedy_among_ties(usize::MAX, &mut random)), (0, 0));
        let empty = ActionValues::new(3, 0);
        assert_eq!((empty.greedy(0), empty.epsilon_greedy(0, 1.0, &mut random)), (0, 0));
    }
}
