//! Plays episodes in the grid worlds of the tests.

use rand::Rng;

use super::action_values::ActionValues;
use super::q_rule::QRule;
use super::transition::{Next, Transition};
use crate::learn::tasks::grid::GridWorld;

/// Creates a table for a world, without experience.
pub fn table_for<W: GridWorld>() -> ActionValues {
    ActionValues::new(W::STATES as usize, usize::from(W::ACTIONS))
}

impl ActionValues {
    /// Learns from one transition as Watkins does, and counts the visit. The outcome is the reward plus the discounted largest value of
    /// the next state. A transition that [`Transition::check`] refuses changes nothing.
    pub fn update(&mut self, transition: &Transition, rule: &QRule) {
        self.learn(transition, rule, |table, next| {
            table.values(next).iter().copied().reduce(f32::max).unwrap_or(0.0)
        });
    }
}

/// Returns the action of the largest value in a state; of equal values, the first.
fn greedy(table: &ActionValues, state: u32) -> u16 {
    let values = table.values(state as usize).iter().zip(0..);
    let best =
        values.reduce(|best, next| if next.0.total_cmp(best.0).is_gt() { next } else { best });
    best.expect("a state of the table").1
}

/// Draws any action with probability `epsilon` (0 to 1), otherwise one of the largest value in a state, a random one of equal ones. With
/// the first of equal values, a table that learns would try the same action again and again wherever it has no experience.
fn epsilon_greedy(table: &ActionValues, state: u32, epsilon: f32, random: &mut impl Rng) -> u16 {
    let share = (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let mut below = |count: usize| ((u128::from(random.next_u64()) * count as u128) >> 64) as usize;
    if share < f64::from(epsilon) {
        return below(table.actions) as u16;
    }
    let values = table.values(state as usize);
    let best = values[usize::from(greedy(table, state))];
    let is_best = |action: &u16| values[usize::from(*action)].total_cmp(&best).is_eq();
    let ties: Vec<u16> = (0..table.actions as u16).filter(is_best).collect();
    ties[below(ties.len())]
}

/// Plays from the start until the goal, or for at most `cap` moves, and returns the transitions. With a rule, the table learns from every
/// move.
pub fn explore<W: GridWorld>(
    table: &mut ActionValues,
    rule: Option<&QRule>,
    epsilon: f32,
    cap: usize,
    random: &mut impl Rng,
) -> Vec<Transition> {
    let mut state = W::state(W::START);
    let mut experience = Vec::new();
    while experience.len() < cap {
        let action = epsilon_greedy(table, state, epsilon, random);
        let (arrived, reward) = W::act(state, action);
        let next = arrived.map_or(Next::Terminal, Next::State);
        let transition = Transition { state, action, reward, ticks: 1, next };
        if let Some(rule) = rule {
            table.update(&transition, rule);
        }
        experience.push(transition);
        match arrived {
            Some(next) => state = next,
            None => break,
        }
    }
    experience
}

/// Counts the moves from start to goal without exploration or learning; `None` if they do not reach the goal within `cap` moves.
pub fn greedy_moves<W: GridWorld>(table: &ActionValues, cap: usize) -> Option<usize> {
    let mut state = W::state(W::START);
    for moves in 1..=cap {
        match W::act(state, greedy(table, state)).0 {
            Some(next) => state = next,
            None => return Some(moves),
        }
    }
    None
}

/// Returns the sum of the rewards of an episode.
pub fn online_return(experience: &[Transition]) -> f64 {
    experience.iter().map(|transition| f64::from(transition.reward)).sum()
}
