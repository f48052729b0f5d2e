//! Learning from the recorded play of a frozen rule set, generation by generation, as in the snake's learners.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::xcs_textbook::settings_for_woods;
use super::{EpisodeEnd, RecordedDecision, Xcs, Zcs, ZcsSettings};
use crate::learn::tasks::woods::{DIRECTIONS, FOOD, MOST_STEPS, Woods};
use crate::rng::{Purpose, stream};

/// Number of generations, of [`ACTORS`] episodes each.
const GENERATIONS: u32 = 160;
const ACTORS: u32 = 32;
/// Number of runs, each with other random numbers.
const RUNS: u64 = 5;

/// Plays the episode of an actor and returns its record. The actor takes a random action with probability `random_share`, and where the
/// frozen rules know no action.
fn recorded(
    woods: &Woods,
    frozen: impl Fn(u32) -> Option<usize>,
    random_share: f64,
    rng: &mut ChaCha8Rng,
) -> (Vec<RecordedDecision>, EpisodeEnd) {
    let mut cell = woods.draw(rng);
    let mut decisions = Vec::new();
    for _ in 0..MOST_STEPS {
        let bits = woods.situation(cell);
        let random = rng.random_range(0..DIRECTIONS);
        let explores = rng.random_range(0.0..1.0) < random_share;
        let action = frozen(bits).filter(|_| !explores).unwrap_or(random);
        let (next, is_food) = woods.after(cell, action);
        let reward = if is_food { FOOD } else { 0.0 };
        decisions.push(RecordedDecision { bits, action: action as u16, reward });
        if is_food {
            return (decisions, EpisodeEnd::Terminal);
        }
        cell = next;
    }
    (decisions, EpisodeEnd::TimeOut { bits: woods.situation(cell) })
}

/// Runs generations of actors, and passes the experience of each generation to `learn`. The first actor takes no random actions, the last
/// one almost only random actions.
fn generations<L>(
    learner: &mut L,
    run: u64,
    frozen: fn(&L, u32) -> Option<usize>,
    learn: fn(&mut L, &[RecordedDecision], EpisodeEnd, &mut ChaCha8Rng),
) {
    let woods = Woods::woods1();
    for generation in 0..GENERATIONS {
        let play = |actor| {
            let mut rng = stream(10 + run, generation, actor, Purpose::Birth);
            let random_share = f64::from(actor) / f64::from(ACTORS);
            recorded(&woods, |bits| frozen(learner, bits), random_share, &mut rng)
        };
        let episodes: Vec<_> = (0..ACTORS).map(play).collect();
        let mut rng = stream(20 + run, generation, 0, Purpose::Birth);
        for (decisions, end) in episodes {
            learn(learner, &decisions, end, &mut rng);
        }
    }
}

#[test]
fn xcs_learns_woods1_from_recorded_play() {
    let woods = Woods::woods1();
    let learn = |xcs: &mut Xcs, decisions: &[RecordedDecision], end, rng: &mut ChaCha8Rng| {
        xcs.learn(decisions, end, rng).unwrap();
    };
    let mut sum = 0.0;
    for run in 0..RUNS {
        let mut xcs = Xcs::new(settings_for_woods(400), woods.bits(), DIRECTIONS).unwrap();
        generations(&mut xcs, run, Xcs::frozen_action, learn);
        assert_eq!(xcs.check(), Ok(()));
        let steps = woods.mean_steps(|bits| xcs.frozen_action(bits).unwrap_or_default());
        println!("frozen XCS takes {steps:.3} steps, {} rules", xcs.rules.len());
        sum += steps;
    }
    assert!((1.6875..=1.75).contains(&(sum / RUNS as f64)), "{sum}");
}

/// ZCS is meant to act by roulette. Frozen, it may run in circles from one or two of the 16 cells, which costs three steps on average for
/// each. A random walk takes 29 steps.
#[test]
fn zcs_learns_woods1_from_recorded_play() {
    let woods = Woods::woods1();
    let learn = |zcs: &mut Zcs, decisions: &[RecordedDecision], end, rng: &mut ChaCha8Rng| {
        zcs.learn(decisions, end, rng).unwrap();
    };
    let mut sum = 0.0;
    for run in 0..RUNS {
        let mut rng = stream(3, 0, run as u32, Purpose::Birth);
        let settings = ZcsSettings::default();
        let mut zcs = Zcs::new(settings, woods.bits(), DIRECTIONS, &mut rng).unwrap();
        generations(&mut zcs, run, Zcs::frozen_action, learn);
        assert_eq!(zcs.check(), Ok(()));
        let steps = woods.mean_steps(|bits| zcs.frozen_action(bits).unwrap_or_default());
        println!("frozen ZCS takes {steps:.3} steps");
        sum += steps;
    }
    assert!((1.6875..=8.0).contains(&(sum / RUNS as f64)), "{sum}");
}
