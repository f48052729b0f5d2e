//! The experience of an actor with one action, from which a table learns.

use serde::{Deserialize, Serialize};

use crate::check::Invalid;
use crate::check::within;

/// Largest absolute value of a reward that [`Transition::check`] accepts.
pub const LARGEST_REWARD: f32 = 1e6;

/// One action of an actor, with its outcome.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Transition {
    /// State in which the action was chosen, from 0.
    pub state: u32,
    /// Number of the action, from 0.
    pub action: u16,
    /// Sum of the rewards of all ticks of the action. The reward of tick i (from 0) is multiplied by the discount per tick to the power of
    /// i.
    pub reward: f32,
    /// Duration of the action in ticks, at least 1.
    pub ticks: u16,
    /// State that followed, or the end of the episode.
    pub next: Next,
}

/// The state after an action, or the end of the episode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Next {
    /// The state in which the next action is chosen, from 0. It also stands for the end of an episode whose time is up: the world would
    /// have continued, so the value of the state still counts. If the end of time counted as an end, the table would learn that time is a
    /// danger, although the state does not contain the time (Pardo and others, "Time limits in reinforcement learning", ICML 2018).
    State(u32),
    /// The episode ended for good, as by success or disqualification: no more rewards are possible.
    Terminal,
}

impl Transition {
    /// Checks every number against a table of `states` times `actions`.
    ///
    /// # Errors
    /// Returns the first field that is not allowed.
    /// Returns the first field that is not allowed.
    pub fn check(&self, states: usize, actions: usize) -> Result<(), Invalid> {
        check_index("state", self.state as usize, states)?;
        check_index("action", usize::from(self.action), actions)?;
        within("reward", self.reward, -LARGEST_REWARD..=LARGEST_REWARD)?;
        within("ticks", self.ticks, 1..=u16::MAX)?;
        match self.next {
            Next::State(next) => check_index("next", next as usize, states),
            Next::Terminal => Ok(()),
        }
    }
}

/// Checks that an index is below `count`.
pub(super) fn check_index(field: &str, index: usize, count: usize) -> Result<(), Invalid> {
    match count.checked_sub(1) {
        Some(last) => within(field, index, 0..=last),
        None => Err(Invalid::new(field, index, "nothing, for there is none")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: Transition =
        Transition { state: 9, action: 3, reward: -1.5, ticks: 15, next: Next::State(0) };

    #[test]
    fn a_transition_outside_its_table_is_refused() {
        assert_eq!(GOOD.check(10, 4), Ok(()));
        assert_eq!(Transition { next: Next::Terminal, ..GOOD }.check(10, 4), Ok(()));
        let message = |bad: Transition| bad.check(10, 4).unwrap_err().to_string();
        let pairs = [
            (Transition { state: 10, ..GOOD }, "state is 10; allowed: 0 to 9"),
            (Transition { action: 4, ..GOOD }, "action is 4; allowed: 0 to 3"),
            (
                Transition { reward: f32::NAN, ..GOOD },
                "reward is NaN; allowed: -1000000 to 1000000",
            ),
            (
                Transition { reward: -2e6, ..GOOD },
                "reward is -2000000; allowed: -1000000 to 1000000",
            ),
            (Transition { ticks: 0, ..GOOD }, "ticks is 0; allowed: 1 to 65535"),
            (Transition { next: Next::State(10), ..GOOD }, "next is 10; allowed: 0 to 9"),
        ];
        for (bad, expected) in pairs {
            assert_eq!(message(bad), expected);
        }
        assert!(GOOD.check(0, 4).is_err() && GOOD.check(10, 0).is_err());
    }

    #[test]
    fn a_transition_survives_being_written_as_text() {
        for next in [Next::State(7), Next::Terminal] {
            let transition = Transition { reward: 0.1 + 0.2, next, ..GOOD };
            let text = ron::to_string(&transition).unwrap();
            assert_eq!(ron::from_str::<Transition>(&text).unwrap(), transition);
        }
    }
}
