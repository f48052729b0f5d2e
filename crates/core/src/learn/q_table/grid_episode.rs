//! Plays episodes in the grid worlds of the tests.

use rand::Rng;

use super::action_values::ActionValues;
use super::q_rule::QRule;
use super::transition::{Next, Transition};
use crate::learn::tasks::grid::GridWorld;

/// A table for a world, without experience.
pub fn table_for<W: GridWorld>() -> ActionValues {
    ActionValues::new(W::STATES as usize, usize::from(W::ACTIONS))
}

/// Plays from the start until the goal or for at most `cap` moves, and returns what happened. The table
/// learns from every move if there is a rule.
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
        let action = table.epsilon_greedy(state as usize, epsilon, random) as u16;
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

/// The moves from start to goal without exploration or learning; `None` if they do not arrive within
/// `cap` moves.
pub fn greedy_moves<W: GridWorld>(table: &ActionValues, cap: usize) -> Option<usize> {
    let mut state = W::state(W::START);
    for moves in 1..=cap {
        match W::act(state, table.greedy(state as usize) as u16).0 {
            Some(next) => state = next,
            None => return Some(moves),
        }
    }
    None
}

/// The sum of the rewards of an episode.
pub fn online_return(experience: &[Transition]) -> f64 {
    experience.iter().map(|transition| f64::from(transition.reward)).sum()
}
