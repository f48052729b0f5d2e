//! The graph of a creature, in a champion whose neurons belong to three nodes and four joints. An accepted one can be
//! simulated, and has children.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use snakes_core::genome::{CreatureChange, GenomeSpace, MOST_PARTS};
use snakes_core::rng::{Purpose, stream};
use snakes_core::save::parse_champion;
use snakes_core::score::Rollout;

const CHAMPION: &str = include_str!("../corpus/champion/creatures");

fuzz_target!(|nodes: &str| {
    let Some((before, rest)) = CHAMPION.split_once("nodes: [") else { return };
    let Some((_, behind)) = rest.split_once("        controller:") else { return };
    let text = format!("{before}nodes: {nodes},\n),\ncontroller:{behind}");
    match parse_champion(Path::new("x"), &text) {
        Ok(loaded) => {
            let genome = &loaded.champion.genome;
            let mut rollout = Rollout::new(genome, &loaded.champion.trial);
            assert!(rollout.body().parts.len() <= MOST_PARTS);
            for _ in 0..3 {
                rollout.advance();
            }
            let space = GenomeSpace::default().widened_for(genome);
            for number in 0..6 {
                let mut rng = stream(1, 1, number, Purpose::Mutation);
                let change = CreatureChange::draw(&mut rng);
                if let Some(child) = space.changed_creature([genome; 2], change, 0.2, &mut rng) {
                    assert!(child.body.check().is_ok());
                }
            }
        }
        Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
    }
});
