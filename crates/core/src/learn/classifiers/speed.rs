//! How long matching and learning take with as many rules as the snake's learner has.

use std::time::Instant;

use rand::RngExt;

use super::{EpisodeEnd, RecordedDecision, ReplayReport, Xcs, XcsSettings};
use crate::rng::{Purpose, stream};

/// Decisions of an episode.
const DECISIONS: u32 = 60;
/// Episodes of a generation.
const EPISODES: u32 = 32;

/// Situations of 24 bits that come back, the share `noisy` of them with two bits flipped, and rewards that depend on
/// them.
fn generation(number: u32, noisy: f64) -> Vec<Vec<RecordedDecision>> {
    let mut rng = stream(1, 0, 0, Purpose::Birth);
    let prototypes: Vec<u32> = (0..40).map(|_| rng.random_range(0..1 << 24)).collect();
    let mut rng = stream(1, 1 + number, 0, Purpose::Birth);
    let mut decide = |_| {
        let mut bits = prototypes[rng.random_range(0..prototypes.len())];
        if rng.random_range(0.0..1.0) < noisy {
            bits ^= 1 << rng.random_range(0..24) | 1 << rng.random_range(0..24);
        }
        let action = rng.random_range(0..12);
        let reward = if bits >> action & 1 == 1 { 1000.0 } else { 0.0 };
        RecordedDecision { bits, action, reward }
    };
    (0..EPISODES).map(|_| (0..DECISIONS).map(&mut decide).collect()).collect()
}

/// Microseconds per match and per learned decision, after ten generations.
fn measured_us(noisy: f64) -> (f64, f64) {
    let settings = XcsSettings { wildcard_share: 0.5, ga_interval: 50.0, ..XcsSettings::default() };
    let mut xcs = Xcs::new(settings, 24, 12).unwrap();
    let mut report = ReplayReport::default();
    let mut seconds = 0.0;
    for number in 0..20 {
        let episodes = generation(number, noisy);
        let mut rng = stream(2, number, 0, Purpose::Birth);
        let start = Instant::now();
        for decisions in &episodes {
            let episode = xcs.learn(decisions, EpisodeEnd::Terminal, &mut rng).unwrap();
            if number >= 10 {
                report.add(episode);
            }
        }
        seconds += if number < 10 { 0.0 } else { start.elapsed().as_secs_f64() };
    }
    let learned_us = 1.0e6 * seconds / f64::from(report.decisions);
    let asked: Vec<u32> = generation(99, noisy).concat().iter().map(|seen| seen.bits).collect();
    let start = Instant::now();
    let matched: usize = (0..50).flat_map(|_| &asked).map(|&bits| xcs.match_set(bits).len()).sum();
    let matches = 50.0 * asked.len() as f64;
    let match_us = 1.0e6 * start.elapsed().as_secs_f64() / matches;
    println!(
        "noise {noisy}: {} rules, {:.0} % covered, {:.1} match; match {match_us:.2} us, learned \
         decision {learned_us:.2} us",
        xcs.rules().len(),
        100.0 * report.covering_share(),
        matched as f64 / matches
    );
    (match_us, learned_us)
}

#[test]
#[ignore = "measures time: run it in a release build on a quiet machine"]
fn two_thousand_rules_match_and_learn_in_microseconds() {
    for (noisy, most_learned_us) in [(0.0, 15.0), (0.3, 25.0), (1.0, 50.0)] {
        let (match_us, learned_us) = measured_us(noisy);
        assert!(match_us < 5.0 && learned_us < most_learned_us);
    }
}
