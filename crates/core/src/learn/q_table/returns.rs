//! How a table learns from whole episodes, where situations show only a part of the world.
//!
//! Two situations that look alike may have different values. The estimate for the next situation is then poor, and an update that relies
//! on it alone passes its error on. An outcome is therefore a mixture of this estimate and of the rewards that actually came later: the
//! λ-return (Watkins, "Learning from delayed rewards", 1989), without a cut at random actions (Peng and Williams, "Incremental multi-step
//! Q-learning", Machine Learning 22, 1996).
//!
//! No action follows itself: a decision always takes another action than the one before.

use super::action_values::ActionValues;
use super::q_rule::QRule;
use super::transition::Transition;

impl ActionValues {
    /// Learns from all episodes in the order of their actors, from each episode backwards in time, so that a reward reaches the beginning
    /// of its episode at once. `trace` is the share of later rewards in an outcome, from 0 (only the estimate counts) to 1 (only later
    /// rewards count).
    pub fn learn_returns(&mut self, experience: &[Vec<Transition>], rule: &QRule, trace: f32) {
        for episode in experience {
            let mut later = None;
            for transition in episode.iter().rev() {
                later = self.learn_return(transition, rule, later, trace);
            }
        }
    }

    /// Learns from one transition while the episode continues, without later rewards.
    pub fn learn_next(&mut self, transition: &Transition, rule: &QRule) {
        self.learn_return(transition, rule, None, 0.0);
    }

    /// Learns from one transition and returns its outcome; `None` if nothing can be learned from the transition. `later` is the outcome of
    /// the transition that followed.
    fn learn_return(
        &mut self,
        transition: &Transition,
        rule: &QRule,
        later: Option<f32>,
        trace: f32,
    ) -> Option<f32> {
        self.learn(transition, rule, |table, next| {
            let guess = table.largest_beside(next, usize::from(transition.action));
            later.map_or(guess, |later| (1.0 - trace) * guess + trace * later)
        })
    }

    /// Returns the largest value in a state of the actions other than `action`; 0 if there is none.
    fn largest_beside(&self, state: usize, action: usize) -> f32 {
        let others = self.values(state).iter().enumerate().filter(|(other, _)| *other != action);
        others.map(|(_, value)| *value).reduce(f32::max).unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learn::q_table::Next;

    const RULE: QRule =
        QRule { discount_per_tick: 0.5, rate_scale: 1.0, rate_power: 0.0, rate_floor: 0.0 };

    fn step(state: u32, action: u16, reward: f32, next: Next) -> Transition {
        Transition { state, action, reward, ticks: 1, next }
    }

    /// Returns an episode of two steps, of which the second earns 8.
    fn episode() -> Vec<Transition> {
        vec![step(0, 0, 1.0, Next::State(1)), step(1, 1, 8.0, Next::Terminal)]
    }

    #[test]
    fn an_outcome_mixes_what_came_later_with_the_guess() {
        // The estimate in state 1 is 20, the value of action 2 from an earlier episode.
        for (trace, expected) in [(0.0, 11.0), (0.5, 1.0 + 0.5 * 14.0), (1.0, 5.0)] {
            let mut table = ActionValues::new(2, 3);
            table.learn_next(&step(1, 2, 20.0, Next::Terminal), &RULE);
            table.learn_returns(&[episode()], &RULE, trace);
            assert_eq!(table.values(0), [expected, 0.0, 0.0], "{trace}");
            assert_eq!(table.values(1), [0.0, 8.0, 20.0]);
            assert_eq!((table.visits(0), table.visits(1)), (&[1, 0, 0][..], &[0, 1, 1][..]));
        }
    }

    #[test]
    fn an_action_is_not_expected_to_follow_itself() {
        let mut table = ActionValues::new(2, 2);
        table.learn_next(&step(1, 0, 8.0, Next::Terminal), &RULE);
        table.learn_next(&step(0, 0, 1.0, Next::State(1)), &RULE);
        table.learn_next(&step(0, 1, 1.0, Next::State(1)), &RULE);
        assert_eq!(table.values(0), [1.0, 5.0]);
    }

    #[test]
    fn the_end_of_time_counts_the_guess_and_hostile_steps_teach_nothing() {
        let mut table = ActionValues::new(2, 2);
        table.learn_next(&step(1, 1, 8.0, Next::Terminal), &RULE);
        table.learn_returns(&[vec![step(0, 0, 0.0, Next::State(1))]], &RULE, 1.0);
        assert_eq!(table.values(0), [4.0, 0.0]);
        let before = table.clone();
        for bad in [
            step(2, 0, 1.0, Next::Terminal),
            step(0, 2, 1.0, Next::Terminal),
            step(0, 0, 1.0, Next::State(2)),
            step(0, 0, f32::NAN, Next::Terminal),
        ] {
            table.learn_returns(&[vec![bad]], &RULE, 0.5);
        }
        assert_eq!(table, before);
    }
}
