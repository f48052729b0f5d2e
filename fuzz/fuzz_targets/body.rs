//! The blocks of a body, in a champion whose gait has waves for the joints of five. An accepted body can be simulated, and
//! changed in every way.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use snakes_core::genome::{BodyChange, GenomeSpace, MOST_SEGMENTS};
use snakes_core::rng::{Purpose, stream};
use snakes_core::save::parse_champion;
use snakes_core::score::Rollout;

const CHAMPION: &str = include_str!("../corpus/champion/bodies");

fuzz_target!(|blocks: &str| {
    let Some((before, rest)) = CHAMPION.split_once("segments: [(") else { return };
    let Some((_, behind)) = rest.split_once(")],") else { return };
    match parse_champion(Path::new("x"), &format!("{before}segments: {blocks},{behind}")) {
        Ok(loaded) => {
            let genome = &loaded.champion.genome;
            let mut rollout = Rollout::new(genome, &loaded.champion.trial);
            assert!(rollout.body().limbs() <= MOST_SEGMENTS as usize);
            assert!(rollout.body().parts.len() <= 4 * MOST_SEGMENTS as usize);
            for _ in 0..3 {
                rollout.advance();
            }
            let space = GenomeSpace::default().widened_for(genome);
            for (number, (change, _)) in (0..).zip(BodyChange::RATES) {
                let mut rng = stream(1, 1, number, Purpose::Mutation);
                if let Some(child) = space.with_body_change(genome, change, &mut rng) {
                    assert!(child.body.check().is_ok());
                }
            }
        }
        Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
    }
});
