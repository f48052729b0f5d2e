//! A saved champion. An accepted one can also be simulated.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use snakes_core::save::parse_champion;
use snakes_core::score::Rollout;

fuzz_target!(|text: &str| {
    match parse_champion(Path::new("x"), text) {
        Ok(loaded) => {
            let mut rollout = Rollout::new(&loaded.champion.genome, &loaded.champion.trial);
            for _ in 0..3 {
                rollout.advance();
            }
            let _ = rollout.evaluation();
            let _ = loaded.champion.reached();
            let _ = loaded.recording.map(|recording| recording.at(7.5));
        }
        Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
    }
});
