//! How the master table learns from the experience of all actors of a generation.

use super::action_values::ActionValues;
use super::q_rule::QRule;
use super::transition::Transition;

impl ActionValues {
    /// Learns from all transitions in the order of (actor, time), then once more from the last to the
    /// first. Returns the mean size of the errors in the first pass, 0 if there was no transition.
    ///
    /// The second pass carries a reward back to the first state of its episode, which takes the first pass as
    /// many episodes as the reward is actions away. It counts no visits, as it contains no new
    /// experience, and its errors say nothing about how surprising the experience was.
    ///
    /// `experience` holds the transitions of actor 0, then those of actor 1, and so on; the caller puts them
    /// in this order, not in that of their arrival.
    pub fn replay(&mut self, experience: &[Vec<Transition>], rule: &QRule) -> f32 {
        let mut sum = 0.0;
        let mut count = 0.0;
        for transition in experience.iter().flatten() {
            sum += f64::from(self.update(transition, rule).abs());
            count += 1.0;
        }
        for transition in experience.iter().flatten().rev() {
            self.learn(transition, rule);
        }
        if count > 0.0 { (sum / count) as f32 } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learn::q_table::Next;

    const RULE: QRule =
        QRule { discount_per_tick: 0.5, rate_scale: 1.0, rate_power: 0.0, rate_floor: 0.0 };

    fn step(state: u32, reward: f32, next: Next) -> Transition {
        Transition { state, action: 0, reward, ticks: 1, next }
    }

    #[test]
    fn a_reward_at_the_end_reaches_the_start_in_one_replay() {
        let episode = vec![
            step(0, 0.0, Next::State(1)),
            step(1, 0.0, Next::State(2)),
            step(2, 8.0, Next::Terminal),
        ];
        let mut table = ActionValues::new(3, 1);
        // The first pass meets errors 0, 0 and 8.
        assert_eq!(table.replay(&[episode], &RULE), 8.0 / 3.0);
        assert_eq!([0, 1, 2].map(|state| table.values(state)[0]), [2.0, 4.0, 8.0]);
        assert_eq!([0, 1, 2].map(|state| table.visits(state)[0]), [1, 1, 1]);
    }

    #[test]
    fn actors_are_replayed_in_their_order() {
        let [first, second] =
            [vec![step(0, 1.0, Next::Terminal)], vec![step(0, 3.0, Next::Terminal)]];
        let half = QRule { rate_scale: 0.5, ..RULE };
        let mut table = ActionValues::new(1, 1);
        table.replay(&[first, Vec::new(), second], &half);
        // 0 -> 0.5 -> 1.75 forwards, then 2.375 -> 1.6875 backwards.
        assert_eq!(table.values(0), [1.6875]);
    }

    #[test]
    fn no_experience_teaches_nothing() {
        let mut table = ActionValues::new(2, 2);
        assert_eq!(table.replay(&[], &RULE), 0.0);
        assert_eq!(table.replay(&[Vec::new(), Vec::new()], &RULE), 0.0);
        assert_eq!(table, ActionValues::new(2, 2));
    }
}
