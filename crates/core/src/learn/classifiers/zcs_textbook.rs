//! ZCS compared with the published result of its author.

use super::experience::EpisodeEnd;
use super::textbook::ActionChoice;
use super::zcs::Zcs;
use super::zcs_rules::ZcsSettings;
use crate::learn::tasks::woods::{DIRECTIONS, FOOD, MOST_STEPS, Woods};
use crate::rng::{Purpose, stream};

#[test]
fn woods1_is_learned_in_5000_problems_but_not_beyond_the_optimum() {
    let woods = Woods::woods1();
    let (mut steps, mut early, mut frozen) = (0, 0, 0.0);
    for run in 0..20 {
        let mut rng = stream(1, 0, run, Purpose::Birth);
        let mut zcs = Zcs::new(ZcsSettings::default(), woods.bits(), DIRECTIONS, &mut rng).unwrap();
        for problem in 0..5_000 {
            let mut cell = woods.draw(&mut rng);
            let mut episode = zcs.episode();
            let mut taken = 0;
            let end = loop {
                let situation = woods.situation(cell);
                if taken == MOST_STEPS {
                    break EpisodeEnd::TimeOut { bits: situation };
                }
                let action = episode.decide(situation, ActionChoice::Explore, &mut rng);
                let (next, is_food) = woods.after(cell, action);
                (cell, taken) = (next, taken + 1);
                if is_food {
                    episode.reward(FOOD);
                    break EpisodeEnd::Terminal;
                }
            };
            episode.finish(end);
            early += if problem < 1_000 { taken } else { 0 };
            steps += if problem >= 4_500 { taken } else { 0 };
        }
        assert_eq!(zcs.check(), Ok(()));
        frozen += woods.mean_steps(|bits| zcs.frozen_action(bits).unwrap_or_default()) / 20.0;
    }
    let (early, steps) = (f64::from(early) / 20_000.0, f64::from(steps) / 10_000.0);
    println!("{early:.2} steps at first, {steps:.3} at 5,000 problems; frozen {frozen:.3}");
    assert!((1.6875..=3.3).contains(&steps), "{steps}");
}
