//! Facts about a champion that are written into files for other programs.

use serde_json::{Map, Value};

use super::ExportedChampion;
use snakes_core::Engine;

/// A fact about a champion: its name, and its value as text.
pub(super) type Fact = (&'static str, String);

/// Returns origin and results of a champion. Seed and hash are text, because not every program reads integers of 64 bits.
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

/// Returns the facts about each champion as a JSON list of objects.
pub(super) fn facts_as_json(champions: &[ExportedChampion]) -> Value {
    let each = champions.iter().map(|champion| {
        let facts = facts(champion).into_iter();
        facts.map(|(name, value)| (name.to_owned(), value.into())).collect::<Map<_, _>>()
    });
    each.map(Value::from).collect()
}

/// Names this program, its version and its engine.
pub(super) fn generator() -> String {
    format!("snakes-and-stairs {} (engine {})", env!("CARGO_PKG_VERSION"), Engine::THIS)
}
