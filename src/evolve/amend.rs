//! Settings that change while a run goes on: which may, from when on, and what that means.
//!
//! A change takes effect at the beginning of a generation. A run is then determined by the plan it began with and
//! its changes: whoever begins with the one and makes the others at their generations gets the same bits.

use super::{HalvingSettings, RunPlan, Settings, StrategyKind, fields, with_field};
use crate::check::{Invalid, within};

/// A change of one setting of a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SettingChange {
    /// The first generation that it concerns; the first of a run is 1.
    pub generation: u32,
    /// The full dotted name of the setting: see [`fields`].
    pub field: String,
    /// Its value from then on, as text.
    pub value: String,
}

/// What was changed of a run since it began, and what has to be known of how it was before.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Changes {
    /// The earliest first.
    made: Vec<SettingChange>,
    range: Option<RangeChange>,
    /// The latest change of the population: the generation, and what those before it were to cost, in evaluations.
    population: Option<(u32, u64)>,
}

/// The latest change of the range of mutation of the report's method, or of how it decays.
#[derive(Debug, Clone, Copy, PartialEq)]
struct RangeChange {
    generation: u32,
    /// From when on it is this and decays, in N·m.
    range_nm: f32,
    /// The range of the generation before, in N·m; none if the range was set, not only its decay.
    before_nm: Option<f32>,
}

/// A run keeps so many changes; nobody makes that many by hand.
pub const MOST_CHANGES: usize = 2000;
/// The longest value of a setting that may change, in bytes.
const LONGEST_VALUE: usize = 60;

const WORLD: &str =
    "Fitness of earlier generations could not be compared any more; the next run takes it.";
const GENOME: &str =
    "Who was found so far would not fit the other genomes any more; the next run takes it.";
const STRATEGY: &str =
    "What was learned so far means nothing to another method; the next run takes it.";
const UNUSED: &str = "The method of this run does not use it; the next run takes it.";
const CMA_ES: &str = "What CMA-ES has learned depends on it; the next run takes it.";
const LAYOUT: &str = "The method has laid out its archive by it; the next run takes it.";
const INHERITED: &str =
    "Only the first generation takes it, the others inherit it; the next run takes it.";
const UNKNOWN: &str = "There is no such setting.";

/// Whether a setting, by its full dotted name, may change while a run of these settings goes on. The error is a
/// sentence for a person.
///
/// # Errors
/// It may not; why.
pub fn may_change_during_run(field: &str, settings: &Settings) -> Result<(), &'static str> {
    use StrategyKind::{CmaEs, Ga, Halving, MapElites, Novelty};
    let used_by = settings.evolution.strategy;
    let by = |users: &[StrategyKind], then: Result<(), &'static str>| {
        if users.contains(&used_by) { then } else { Err(UNUSED) }
    };
    let Some(name) = field.strip_prefix("evolution.") else {
        let is_of = |part: &str| field.starts_with(part);
        return Err(match () {
            () if is_of("trial.") => WORLD,
            () if is_of("genome.") => GENOME,
            () => UNKNOWN,
        });
    };
    match name {
        "strategy" => Err(STRATEGY),
        "generations" => Ok(()),
        "population" if used_by == CmaEs => Err(CMA_ES),
        "population" => Ok(()),
        "halving.parents" | "halving.mutation_range_nm" | "halving.mutation_decay" => {
            by(&[Halving], Ok(()))
        }
        "ga.step" => by(&[Ga, Novelty], Err(INHERITED)),
        "ga.selection" | "ga.tournament" | "ga.crossover" | "ga.crossover_share"
        | "ga.mutation" | "ga.cooling" | "ga.elites" => by(&[Ga, Novelty], Ok(())),
        "cma_es.step" | "cma_es.active" | "cma_es.restarts" | "cma_es.newborns" => {
            by(&[CmaEs], Err(CMA_ES))
        }
        "map_elites.x" | "map_elites.y" | "map_elites.cells" => by(&[MapElites], Err(LAYOUT)),
        "map_elites.step" | "map_elites.line" | "map_elites.cma_share" | "map_elites.cma_step" => {
            by(&[MapElites], Ok(()))
        }
        "novelty.first" | "novelty.second" => by(&[Novelty], Err(LAYOUT)),
        "novelty.weight"
        | "novelty.neighbours"
        | "novelty.remembered"
        | "novelty.archive_limit" => by(&[Novelty], Ok(())),
        _ => Err(UNKNOWN),
    }
}

impl Changes {
    /// What was changed, the earliest first.
    pub fn made(&self) -> &[SettingChange] {
        &self.made
    }
}

impl RunPlan {
    /// The change of a setting, from a generation on, that a person means by a text; none if that changes nothing.
    /// The plan stays as it is.
    ///
    /// # Errors
    /// As [`Self::change`].
    pub fn proposed(
        &self,
        generation: u32,
        field: &str,
        text: &str,
    ) -> Result<Option<SettingChange>, Invalid> {
        allow(field, text, &self.settings)?;
        let changed = with_field(&self.settings, field, text)?;
        // As it stands in the list of all settings, whatever was typed.
        let value = fields(&changed).into_iter().find(|(name, _)| name == field);
        let value = value.map_or_else(|| text.to_owned(), |(_, value)| value);
        let change = SettingChange { generation, field: field.to_owned(), value };
        let mut plan = self.clone();
        plan.change(&change)?;
        Ok((plan.settings != self.settings).then_some(change))
    }

    /// Makes a change: the plan is then that of the generation from which on it counts, until the next change.
    ///
    /// The range of mutation of the report's method becomes, in that generation, what is set, and decays from there.
    /// If it is the decay that is set, the range of that generation is already that of the one before, decayed anew.
    ///
    /// # Errors
    /// The setting may not change during a run, its value is not allowed, or the generation is earlier than that of
    /// the change before, or after the end. The plan is then as it was.
    pub fn change(&mut self, change: &SettingChange) -> Result<(), Invalid> {
        let SettingChange { generation, field, value } = change;
        let latest = self.changes.made.last().map_or(1, |last| last.generation);
        // A run may be made longer even when all its generations are finished.
        let is_length = field == "evolution.generations";
        let last = self.settings.evolution.generations + u32::from(is_length);
        within("generation", *generation, latest..=last.max(latest))?;
        within("changes", self.changes.made.len() + 1, 1..=MOST_CHANGES)?;
        allow(field, value, &self.settings)?;
        let settings = with_field(&self.settings, field, value)?;
        // What is finished or under way cannot be taken back.
        within("evolution.generations", settings.evolution.generations, *generation..=10_000)?;
        let before = &self.settings.evolution;
        match field.as_str() {
            "evolution.population" => {
                let (since, spent) = self.changes.population.unwrap_or((1, 0));
                let generations = u64::from(generation.saturating_sub(since));
                let spent = spent + u64::from(before.population) * generations;
                self.changes.population = Some((*generation, spent));
            }
            // Up to the second generation the range is the one that is set, anyway.
            "evolution.halving.mutation_range_nm" if *generation > 2 => {
                let range_nm = settings.evolution.halving.mutation_range_nm;
                let generation = *generation;
                self.changes.range = Some(RangeChange { generation, range_nm, before_nm: None });
            }
            "evolution.halving.mutation_decay" if *generation > 2 => {
                let decay = settings.evolution.halving.mutation_decay;
                self.decay_anew(*generation, decay);
            }
            _ => {}
        }
        self.settings = settings;
        self.changes.made.push(change.clone());
        Ok(())
    }

    fn decay_anew(&mut self, generation: u32, decay: f32) {
        let before_nm = match self.changes.range {
            // Set for this very generation: only later ones decay.
            Some(RangeChange { generation: of, before_nm: None, .. }) if of == generation => return,
            Some(RangeChange { generation: of, before_nm, .. }) if of == generation => before_nm,
            _ => Some(self.mutation_range_nm(generation - 1)),
        };
        let range_nm = before_nm.unwrap_or_default() * decay;
        self.changes.range = Some(RangeChange { generation, range_nm, before_nm });
    }

    /// The range of mutation of the report's method in a generation that comes after all changes so far, in N·m.
    pub fn mutation_range_nm(&self, generation: u32) -> f32 {
        let HalvingSettings { mutation_range_nm, mutation_decay, .. } =
            self.settings.evolution.halving;
        let (from, range_nm) = match self.changes.range {
            Some(change) => (change.generation, change.range_nm),
            None => (2, mutation_range_nm),
        };
        // Repeated multiplication instead of a power: its bits are the same everywhere.
        (from..generation).fold(range_nm, |range, _| range * mutation_decay)
    }

    /// How many evaluations the run may cost.
    pub fn budget(&self) -> u64 {
        let evolution = &self.settings.evolution;
        let (since, spent) = self.changes.population.unwrap_or((1, 0));
        let generations = (u64::from(evolution.generations) + 1).saturating_sub(since.into());
        spent + u64::from(evolution.population) * generations
    }

    /// The plan of a run's generation: this one with those changes that count by then.
    ///
    /// # Errors
    /// One of them is not allowed.
    pub fn in_generation(
        &self,
        generation: u32,
        changes: &[SettingChange],
    ) -> Result<Self, Invalid> {
        let mut plan = self.clone();
        let mut due = changes.iter().take_while(|change| change.generation <= generation);
        due.try_for_each(|change| plan.change(change))?;
        Ok(plan)
    }
}

fn allow(field: &str, value: &str, settings: &Settings) -> Result<(), Invalid> {
    let short = |text: &str| text.chars().take(LONGEST_VALUE).collect::<String>();
    if value.len() > LONGEST_VALUE {
        let allowed = format!("up to {LONGEST_VALUE} bytes");
        return Err(Invalid::new(short(field), format!("{:?}", short(value)), allowed));
    }
    may_change_during_run(field, settings).map_err(|reason| {
        let reason = reason.trim_end_matches('.');
        Invalid::new("a change during a run", format!("{:?}", short(field)), reason)
    })
}

#[cfg(test)]
mod tests;
