//! Results of a generation in numbers, as the log of its run has them.

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3Default;

use super::plan::RunPlan;
use super::stairs_tree::StairsCount;
use crate::check::{Invalid, hex_hash, within};
use crate::score::{FITNESS_RANGE, Trial};

/// The numbers of a finished generation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GenerationRecord {
    /// Its number; the first is 1.
    pub generation: u32,
    /// Number of individuals that were evaluated.
    pub evaluations: u32,
    /// Number of these that were disqualified, for any reason.
    pub disqualified: u32,
    /// Number of these whose simulation panicked.
    pub crashed: u32,
    /// Number of healthy individuals that ended on the landing; on a ladder, of the stairs to which it leads, and where stairs
    /// evolve, of their own.
    pub on_landing: u32,
    /// The index of the first of them.
    pub first_on_landing: Option<u32>,
    /// Fitness statistics of the healthy individuals; none if all were disqualified.
    pub statistics: Option<Statistics>,
    /// The champion's fitness over the varied trials on which the run chose it; none if it chose by the trial alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chosen_by: Option<f64>,
    /// The largest species, [`MOST_SPECIES_RECORDED`] at most, in ascending order of their numbers; of evolving bodies the
    /// numbers of blocks. Empty for a strategy without both, and in logs of earlier versions of the program.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub species: Vec<SpeciesCount>,
    /// The rung of the ladder on which it was evaluated; none without a ladder.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rung: Option<Rung>,
    /// Numbers of the stairs after it; none unless stairs evolve.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stairs: Option<StairsCount>,
    /// Hash over the bits of every evaluation, in the order of the individuals. Files have its 16 hexadecimal digits.
    #[serde(with = "hex_hash")]
    pub hash: u64,
    /// Wall-clock time since the generation began or the program was started, in seconds. Not part of any hash.
    pub elapsed_s: f64,
}

/// Statistics over the fitness of the healthy individuals of one generation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Statistics {
    /// Arithmetic mean.
    pub mean: f64,
    /// Greatest fitness.
    pub best: f64,
    /// Median; of an even number, the mean of the two middle ones.
    pub median: f64,
    /// Standard deviation of the whole population (divided by n).
    pub std: f64,
    /// Least fitness.
    pub worst: f64,
    /// Mean final y of the centre, in m, independent of what is rewarded.
    pub mean_centre_y_m: f64,
    /// Lower quartile; none in logs of earlier versions of the program.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower_quartile: Option<f64>,
    /// Upper quartile; none in logs of earlier versions of the program.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub upper_quartile: Option<f64>,
}

/// A rung of a ladder of stairs, and the success of a generation on it. The ladder's next rung follows from these of all
/// generations.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rung {
    /// Rise of the stairs, in m.
    pub rise_m: f32,
    /// Number of individuals that succeeded.
    pub successes: u32,
}

/// Maximum number of species that the log has of a generation, so that the log of the longest run can be read again.
pub const MOST_SPECIES_RECORDED: usize = 24;

/// A species in a generation. Files have it as a list: number, size, best fitness.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(into = "(u32, u32, Option<f32>)", from = "(u32, u32, Option<f32>)")]
pub struct SpeciesCount {
    /// Number of the species; ascending in the order of appearance.
    pub id: u32,
    /// Number of its individuals, at least 1.
    pub size: u32,
    /// The best fitness of its healthy individuals; none if all were disqualified.
    pub best: Option<f32>,
}

impl From<SpeciesCount> for (u32, u32, Option<f32>) {
    fn from(SpeciesCount { id, size, best }: SpeciesCount) -> Self {
        (id, size, best)
    }
}

impl From<(u32, u32, Option<f32>)> for SpeciesCount {
    fn from((id, size, best): (u32, u32, Option<f32>)) -> Self {
        Self { id, size, best }
    }
}

impl Statistics {
    /// Lower and upper quartile; none in logs of earlier versions of the program.
    pub fn quartiles(&self) -> Option<(f64, f64)> {
        self.lower_quartile.zip(self.upper_quartile)
    }
}

impl Rung {
    /// A trial on the stairs of this rung.
    pub fn on(&self, mut trial: Trial) -> Trial {
        trial.stairs.rise_m = self.rise_m.into();
        trial
    }
}

/// Hash over the hashes of all generations: that of a run.
pub fn run_hash(records: &[GenerationRecord]) -> u64 {
    let mut hash = Xxh3Default::new();
    records.iter().for_each(|record| hash.update(&record.hash.to_le_bytes()));
    hash.digest()
}

impl GenerationRecord {
    /// Checks that it can be generation number `generation` of a run; `plan` is that of the run after all its changes.
    ///
    /// # Errors
    /// The first value that is not allowed.
    pub fn check(&self, generation: u32, plan: &RunPlan) -> Result<(), Invalid> {
        let most = u32::try_from(plan.budget()).unwrap_or(u32::MAX);
        within("generation", self.generation, generation..=generation)?;
        within("generation", generation, 1..=plan.settings.evolution.generations)?;
        within("evaluations", self.evaluations, 0..=most)?;
        within("disqualified", self.disqualified, 0..=self.evaluations)?;
        within("crashed", self.crashed, 0..=self.disqualified)?;
        within("on_landing", self.on_landing, 0..=self.evaluations)?;
        if let Some(first) = self.first_on_landing {
            within("first_on_landing", first, 0..=self.evaluations.saturating_sub(1))?;
        }
        within("elapsed_s", self.elapsed_s, 0.0..=1.0e9)?;
        let fitness = f64::from(*FITNESS_RANGE.start())..=f64::from(*FITNESS_RANGE.end());
        if let Some(chosen_by) = self.chosen_by {
            within("chosen_by", chosen_by, fitness.clone())?;
        }
        if let Some(of) = self.statistics {
            let values = [of.mean, of.best, of.median, of.std, of.worst, of.mean_centre_y_m];
            let quartiles = of.lower_quartile.into_iter().chain(of.upper_quartile);
            let mut values = values.into_iter().chain(quartiles);
            values.try_for_each(|value| within("statistics", value, fitness.clone()))?;
        }
        self.check_species()?;
        if let Some(Rung { rise_m, successes }) = self.rung {
            within("rung.rise_m", rise_m, 0.0..=5.0)?;
            within("rung.successes", successes, 0..=self.evaluations)?;
        }
        self.stairs.map_or(Ok(()), StairsCount::check)
    }

    /// Checks the species: each individual belongs to one at most.
    fn check_species(&self) -> Result<(), Invalid> {
        let evaluations = u64::from(self.evaluations);
        within("number of species", self.species.len(), 0..=MOST_SPECIES_RECORDED)?;
        let (mut members, mut least_id) = (0, 0);
        for SpeciesCount { id, size, best } in &self.species {
            within("species.id", u64::from(*id), least_id..=u64::from(u32::MAX))?;
            within("species.size", u64::from(*size), 1..=evaluations)?;
            if let Some(best) = best {
                within("species.best", *best, FITNESS_RANGE)?;
            }
            least_id = u64::from(*id) + 1;
            members += u64::from(*size);
            within("sum of species.size", members, 0..=evaluations)?;
        }
        Ok(())
    }

    /// A generation of this number of healthy individuals, of which nothing else is known; for tests.
    pub fn of_test(generation: u32, evaluations: u32) -> Self {
        Self {
            generation,
            evaluations,
            disqualified: 0,
            crashed: 0,
            on_landing: 0,
            first_on_landing: None,
            statistics: None,
            chosen_by: None,
            species: Vec::new(),
            rung: None,
            stairs: None,
            hash: 0x0123_4567_89ab_cdef,
            elapsed_s: 1.0,
        }
    }
}
