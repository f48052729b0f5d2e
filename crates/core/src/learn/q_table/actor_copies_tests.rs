//! Tests why actors learn in a copy of the table while they act, and why many small generations are better than few large ones.

use super::grid_episode::{explore, greedy_moves, table_for};
use super::q_rule::QRule;
use crate::learn::tasks::cliff::Cliff;
use crate::learn::tasks::grid::{GridWorld, shortest_path};
use crate::learn::tasks::windy::Windy;
use crate::rng::{Purpose, stream};

/// Number of independent repetitions of a task.
const REPETITIONS: u64 = 100;
/// Number of episodes of all generations together.
const EPISODES: u32 = 512;
/// Greatest number of moves of an episode.
const CAP: usize = 300;
/// Share of random actions of every actor.
const EPSILON: f32 = 0.1;

/// How actors use their copy of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ActorTable {
    /// Actors act by their copy, which does not change.
    Frozen,
    /// Actors learn in their copy while they act.
    Learning,
}

/// The outcome of the repetitions of a task.
#[derive(Debug, Clone, Copy)]
struct TaskOutcome {
    /// Mean number of moves over all episodes.
    moves: f64,
    /// Number of repetitions after which the table leads to the goal on a shortest path.
    shortest: u32,
}

/// Learns a task in generations of `actors` episodes.
fn learn_in_generations<W: GridWorld>(actors: u32, kind: ActorTable) -> TaskOutcome {
    let rule = QRule::with_constant_rate(0.5, 1.0);
    let (mut moves, mut arrived, mut shortest) = (0, 0, 0);
    for seed in 0..REPETITIONS {
        let mut master = table_for::<W>();
        for generation in 0..EPISODES / actors {
            let episode = |actor| {
                let mut random = stream(seed, generation, actor, Purpose::Birth);
                let learns = (kind == ActorTable::Learning).then_some(&rule);
                explore::<W>(&mut master.clone(), learns, EPSILON, CAP, &mut random)
            };
            let experience: Vec<_> = (0..actors).map(episode).collect();
            moves += experience.iter().map(Vec::len).sum::<usize>();
            // The table learns forwards in time and then backwards, which carries a reward back to the start of its episode.
            let transitions = experience.iter().flatten();
            for transition in transitions.clone().chain(transitions.rev()) {
                master.update(transition, &rule);
            }
        }
        let greedy = greedy_moves::<W>(&master, CAP);
        arrived += u32::from(greedy.is_some());
        shortest += u32::from(greedy == Some(shortest_path::<W>() as usize));
    }
    let moves = moves as f64 / REPETITIONS as f64;
    println!(
        "{actors} actors, {kind:?}: {moves:.0} moves, greedy arrives {arrived}/100, shortest {shortest}/100"
    );
    TaskOutcome { moves, shortest }
}

#[test]
fn copies_that_learn_solve_the_cliff_in_fewer_moves() {
    for actors in [8, 32] {
        let frozen = learn_in_generations::<Cliff>(actors, ActorTable::Frozen);
        let copies = learn_in_generations::<Cliff>(actors, ActorTable::Learning);
        assert_eq!(copies.shortest, 100, "{copies:?}");
        assert!(copies.moves < 0.6 * frozen.moves, "{copies:?} {frozen:?}");
    }
}

#[test]
#[ignore = "takes seconds: 204,800 episodes of up to 300 moves"]
fn copies_that_learn_solve_the_wind_even_in_few_generations() {
    for (actors, demand) in [(8, 100), (32, 85)] {
        let frozen = learn_in_generations::<Windy>(actors, ActorTable::Frozen);
        let copies = learn_in_generations::<Windy>(actors, ActorTable::Learning);
        assert!(copies.shortest >= demand, "{copies:?}");
        assert!(copies.moves < 0.6 * frozen.moves, "{copies:?} {frozen:?}");
    }
}
