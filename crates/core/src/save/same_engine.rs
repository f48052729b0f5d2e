//! Comparison of engines: whether recorded results have the bits of this build of the program.

use crate::check::Invalid;
use crate::engine::{ENGINE_VERSION, Engine, Processors};
use crate::world::PhysicsEngine;

/// Returns whether results with a physics engine are equal on all processors. Those of *lanes* are, unless bodies branch: a branching body
/// grows with the rotations of rapier's library, whose bits differ between processors.
fn is_equal_everywhere(physics: PhysicsEngine, branches: bool) -> bool {
    physics == PhysicsEngine::Lanes && !branches
}

/// Returns the engine of this program for runs with a physics engine, whose bodies branch or not. Where results are equal on all
/// processors, it has the default processors.
pub fn engine_of(physics: PhysicsEngine, branches: bool) -> Engine {
    let is_equal = is_equal_everywhere(physics, branches);
    let processors = if is_equal { Processors::default() } else { Processors::THIS };
    Engine { version: ENGINE_VERSION, processors }
}

/// Returns whether the engine `recorded` computes the same bits with a physics engine as this build of the program, for bodies that branch
/// or do not.
pub fn has_bits_of_this(recorded: Engine, physics: PhysicsEngine, branches: bool) -> bool {
    if is_equal_everywhere(physics, branches) {
        recorded.version == ENGINE_VERSION
    } else {
        recorded == Engine::THIS
    }
}

/// Refuses a run that this build of the program would continue with other bits.
pub fn check_engine(
    recorded: Engine,
    physics: PhysicsEngine,
    branches: bool,
) -> Result<(), Invalid> {
    if has_bits_of_this(recorded, physics, branches) {
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
            assert!(!has_bits_of_this(other, PhysicsEngine::Rapier, false));
            check_engine(other, PhysicsEngine::Rapier, false).expect_err("other bits");
            check_engine(other, PhysicsEngine::Lanes, false).expect("the same bits");
            check_engine(other, PhysicsEngine::Lanes, true).expect_err("other creatures");
        }
        let earlier = of(ENGINE_VERSION - 1, Processors::THIS);
        check_engine(earlier, PhysicsEngine::Lanes, false).expect_err("another version");
        assert_eq!(engine_of(PhysicsEngine::Lanes, false).to_string(), ENGINE_VERSION.to_string());
        assert_eq!(engine_of(PhysicsEngine::Lanes, true), Engine::THIS);
    }
}
