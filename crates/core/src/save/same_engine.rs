//! Comparison of engines: whether recorded results have the bits of this build of the program.

use crate::check::Invalid;
use crate::engine::{ENGINE_VERSION, Engine, Processors};
use crate::world::PhysicsEngine;

/// Returns the engine of this program for runs with a physics engine. Results of *lanes* are equal on all processors, so their engine has
/// the default processors.
pub fn engine_of(physics: PhysicsEngine) -> Engine {
    let processors = match physics {
        PhysicsEngine::Rapier => Processors::THIS,
        PhysicsEngine::Lanes => Processors::default(),
    };
    Engine { version: ENGINE_VERSION, processors }
}

/// Returns whether the engine `recorded` computes the same bits with a physics engine as this build of the program.
pub fn has_bits_of_this(recorded: Engine, physics: PhysicsEngine) -> bool {
    match physics {
        PhysicsEngine::Rapier => recorded == Engine::THIS,
        PhysicsEngine::Lanes => recorded.version == ENGINE_VERSION,
    }
}

/// Refuses a run that this build of the program would continue with other bits.
pub fn check_engine(recorded: Engine, physics: PhysicsEngine) -> Result<(), Invalid> {
    if has_bits_of_this(recorded, physics) {
        return Ok(());
    }
    let allowed =
        format!("{}; its champions can be replayed, but the run cannot continue", Engine::THIS);
    Err(Invalid::new("engine", recorded, allowed))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_of_lanes_are_those_of_all_processors_but_not_of_other_versions() {
        let of = |version, processors| Engine { version, processors };
        let others = [Processors::X86_64, Processors::Arm64]
            .into_iter()
            .filter(|processors| *processors != Processors::THIS);
        for processors in others {
            let other = of(ENGINE_VERSION, processors);
            assert!(!has_bits_of_this(other, PhysicsEngine::Rapier));
            check_engine(other, PhysicsEngine::Rapier).expect_err("other bits");
            check_engine(other, PhysicsEngine::Lanes).expect("the same bits");
        }
        let earlier = of(ENGINE_VERSION - 1, Processors::THIS);
        check_engine(earlier, PhysicsEngine::Lanes).expect_err("another version");
        assert_eq!(engine_of(PhysicsEngine::Lanes).to_string(), ENGINE_VERSION.to_string());
    }
}
