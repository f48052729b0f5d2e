//! The learner on the tasks of Sutton & Barto ("Reinforcement Learning", 2nd edition, 2018), compared with the figures of the book.

use super::grid_episode::{explore, greedy_moves, online_return, table_for};
use super::q_rule::QRule;
use crate::learn::tasks::cliff::Cliff;
use crate::learn::tasks::dyna_maze::DynaMaze;
use crate::learn::tasks::windy::Windy;
use crate::rng::{Purpose, stream};

/// Number of independent repetitions of a task.
const REPETITIONS: u32 = 100;
/// Share of random actions in all tasks.
const EPSILON: f32 = 0.1;
/// Limit of the moves of an episode, more than any episode needs.
const CAP: usize = 100_000;

#[test]
fn on_the_cliff_exploration_is_costly_and_the_greedy_way_is_shortest() {
    let rule = QRule::with_constant_rate(0.5, 1.0);
    let (mut sum, mut shortest) = (0.0, 0);
    for repetition in 0..REPETITIONS {
        let mut random = stream(1, repetition, 0, Purpose::Birth);
        let mut table = table_for::<Cliff>();
        for episode in 0..500 {
            let moves = explore::<Cliff>(&mut table, Some(&rule), EPSILON, CAP, &mut random);
            if episode >= 400 {
                sum += online_return(&moves);
            }
        }
        shortest += u32::from(greedy_moves::<Cliff>(&table, CAP) == Some(13));
    }
    let mean = sum / (100.0 * f64::from(REPETITIONS));
    println!("cliff: mean return of episodes 401 to 500 {mean:.2}; greedy 13 moves {shortest}/100");
    // The book's figure shows about -50 for Q-learning, against about -25 for Sarsa.
    assert!((-54.0..=-47.0).contains(&mean), "{mean}");
    assert_eq!(shortest, REPETITIONS);
}

#[test]
fn in_the_wind_170_episodes_take_about_as_many_moves_as_in_the_book() {
    let rule = QRule::with_constant_rate(0.5, 1.0);
    let (mut sum, mut shortest) = (0, 0);
    for repetition in 0..REPETITIONS {
        let mut random = stream(2, repetition, 0, Purpose::Birth);
        let mut table = table_for::<Windy>();
        for episode in 0..500 {
            let moves = explore::<Windy>(&mut table, Some(&rule), EPSILON, CAP, &mut random);
            if episode < 170 {
                sum += moves.len();
            }
        }
        shortest += u32::from(greedy_moves::<Windy>(&table, CAP) == Some(15));
    }
    let mean = sum as f64 / f64::from(REPETITIONS);
    println!("windy: 170 episodes in {mean:.0} moves; greedy 15 moves {shortest}/100");
    // The book's figure shows about 170 episodes in 8,000 moves, for Sarsa.
    assert!((6800.0..=8000.0).contains(&mean), "{mean}");
    assert_eq!(shortest, REPETITIONS);
}

#[test]
fn the_maze_is_nearly_solved_after_thirty_episodes_without_planning() {
    let rule = QRule::with_constant_rate(0.1, 0.95);
    let (mut first, mut last) = (0, 0);
    for repetition in 0..REPETITIONS {
        let mut random = stream(3, repetition, 0, Purpose::Birth);
        let mut table = table_for::<DynaMaze>();
        for episode in 0..50 {
            let moves = explore::<DynaMaze>(&mut table, Some(&rule), EPSILON, CAP, &mut random);
            first += if episode == 0 { moves.len() } else { 0 };
            last += if episode >= 30 { moves.len() } else { 0 };
        }
    }
    let first = first as f64 / f64::from(REPETITIONS);
    let last = last as f64 / (20.0 * f64::from(REPETITIONS));
    println!("Dyna maze: episode 1 {first:.0} moves; episodes 31 to 50 {last:.2} moves");
    assert!(last <= 19.0, "{last}");
    // The first episode, without learning, is a random walk.
    assert!(first > 20.0 * last, "{first}");
}
