//! The facts about a champion that stand in the files of other programs.

use super::ExportedChampion;
use crate::engine::Engine;

/// A fact: its name, and its value as text.
pub(super) type Fact = (&'static str, String);

/// Origin and results of a champion. The seed and the hash are text: not every program reads 64 bits.
pub(super) fn facts(ExportedChampion { name, loaded, .. }: &ExportedChampion) -> Vec<Fact> {
    let champion = &loaded.champion;
    let (origin, evaluation) = (&champion.origin, &champion.evaluation);
    vec![
        ("champion", name.clone()),
        ("preset", origin.preset.clone()),
        ("seed", origin.seed.to_string()),
        ("generation", origin.generation.to_string()),
        ("individual", origin.individual.to_string()),
        ("controller", champion.genome.controller.kind().to_string()),
        ("fitness", evaluation.fitness.to_string()),
        ("reached", champion.reached()),
        ("trace_hash", format!("{:016x}", evaluation.trace_hash)),
        ("engine", loaded.engine.to_string()),
        ("generator", generator()),
    ]
}

/// The program and its version.
pub(super) fn generator() -> String {
    format!("snakes-and-stairs {} (engine {})", env!("CARGO_PKG_VERSION"), Engine::THIS)
}
