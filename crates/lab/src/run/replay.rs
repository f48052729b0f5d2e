//! Replays a saved champion without a window and compares it with its record.

use std::io::Write;
use std::path::Path;

use serde_json::json;

use super::headless::HeadlessError;
use super::json::short;
use super::panics::caught;
use snakes_core::Engine;
use snakes_core::evolve::Champion;
use snakes_core::save::{LoadedChampion, load_champion};
use snakes_core::schema::Choices;
use snakes_core::score::{Ending, Evaluation, evaluate};
use snakes_core::world::{Effort, HealthLimits};

/// Re-simulates a saved champion and compares it with its record, bit for bit.
///
/// # Errors
/// The file cannot be used, its simulation panicked, or fitness or trace differ from the record.
pub fn replay(path: &Path, json: bool, out: &mut dyn Write) -> Result<(), HeadlessError> {
    let loaded = load_champion(path)?;
    let recorded = loaded.champion.evaluation;
    let trial = &loaded.champion.trial;
    let found = simulated(path, &loaded)?;
    let matches = found.agrees_with(&recorded);
    let meaning = trial.result_in_words(&loaded.champion.genome, &found);
    let ending = found.ending.unwrap_or(Ending::CRASHED);
    if json {
        let line = json!({
            "type": "replay",
            "fitness": short(found.fitness),
            "trace_hash": format!("{:016x}", found.trace_hash),
            "recorded_fitness": short(recorded.fitness),
            "recorded_trace_hash": format!("{:016x}", recorded.trace_hash),
            "steps": found.steps,
            "energy_j": found.effort.map(|effort| short(effort.energy_j)),
            "cost_of_transport": found.behaviour.and_then(|of| of.cost_of_transport).map(short),
            "climbing_efficiency": found.behaviour.and_then(|of| of.climbing_efficiency).map(short),
            "top_speed_m_s": found.effort.map(|effort| short(effort.top_speed_m_s)),
            "joint_drift_m": found.effort.map(|effort| short(effort.joint_drift_m)),
            "sideways_m": found.effort.map(|effort| short(effort.sideways_m)),
            "disqualified": found.disqualified.map(|reason| reason.words()),
            "meaning": meaning,
            "ending": ending.kind.choice().name,
            "ending_step": ending.step,
            "tricks": ending.used().map(|trick| trick.choice().name).collect::<Vec<_>>(),
            "engine": loaded.engine.version,
            "processors": loaded.engine.processors,
            "matches": matches,
        });
        writeln!(out, "{line}")?;
    } else {
        let unit = loaded.champion.trial.fitness.unit();
        writeln!(out, "fitness     {:.6}{unit}, {meaning}", found.fitness)?;
        writeln!(out, "ended       {}", ending.words())?;
        if let Some(reason) = found.disqualified {
            let words = reason.words();
            writeln!(out, "disqualified after {} steps: {words}", found.steps)?;
        }
        if let Some(effort) = &found.effort {
            writeln!(out, "{}", effort_lines(effort, &trial.health))?;
        }
        writeln!(out, "trace_hash  {:016x}", found.trace_hash)?;
        if matches {
            writeln!(out, "equal to the record, bit for bit")?;
        }
    }
    match difference(&loaded, &found) {
        None => Ok(()),
        Some(difference) => Err(HeadlessError::Differs { path: path.to_owned(), difference }),
    }
}

/// Compares a champion with its record, bit for bit, without printing results. Returns `None` if they are equal, otherwise the
/// difference in words.
///
/// # Errors
/// The simulation of the champion panicked.
pub fn difference_from_record(
    path: &Path,
    loaded: &LoadedChampion,
) -> Result<Option<String>, HeadlessError> {
    let found = simulated(path, loaded)?;
    Ok(difference(loaded, &found))
}

fn simulated(path: &Path, loaded: &LoadedChampion) -> Result<Evaluation, HeadlessError> {
    let Champion { genome, trial, .. } = &loaded.champion;
    caught(|| evaluate(genome, trial))
        .map_err(|message| HeadlessError::Crashed { path: path.to_owned(), message })
}

/// Describes the difference between the record and the simulation `found` in words; `None` if they are equal.
fn difference(loaded: &LoadedChampion, found: &Evaluation) -> Option<String> {
    let recorded = &loaded.champion.evaluation;
    if found.agrees_with(recorded) {
        return None;
    }
    let engine = if loaded.is_of_this_engine() {
        "the file was edited, or this machine computes different results".to_owned()
    } else {
        format!("recorded by engine {}, this is engine {}", loaded.engine, Engine::THIS)
    };
    Some(format!(
        "fitness {}, {} steps, trace {:016x}; recorded {}, {} steps, {:016x} ({engine})",
        found.fitness,
        found.steps,
        found.trace_hash,
        recorded.fitness,
        recorded.steps,
        recorded.trace_hash,
    ))
}

/// Describes the effort of a rollout, each value with the limit beyond which a snake is disqualified.
fn effort_lines(effort: &Effort, health: &HealthLimits) -> String {
    format!(
        "energy      {:.1} J\n\
         top speed   {:.2} m/s (limit {} m/s)\n\
         joint gap   {:.4} m (limit {} m)\n\
         sideways    {:.2} m (limit {} m)",
        effort.energy_j,
        effort.top_speed_m_s,
        health.speed_m_s,
        effort.joint_drift_m,
        health.joint_drift_m,
        effort.sideways_m,
        health.arena_half_width_m,
    )
}
