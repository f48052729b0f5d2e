//! Records of generations: the numbers that the log of a run has of each generation.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3Default;

use super::plan::RunPlan;
use super::stairs_tree::StairsCount;
use crate::check::{Invalid, hex_hash, within};
use crate::score::{EndingKind, Evaluation, FITNESS_RANGE, Trial};

/// Record of a finished generation.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GenerationRecord {
    /// Number of the generation; the first is 1.
    pub generation: u32,
    /// Number of individuals that were evaluated.
    pub evaluations: u32,
    /// Number of simulated trials: repeats and the trials that chose the champion count, too. None in logs of earlier versions of the program.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub simulations: Option<u64>,
    /// Number of evaluated individuals that were disqualified, for any reason.
    pub disqualified: u32,
    /// Number of evaluated individuals whose simulation panicked.
    pub crashed: u32,
    /// Number of healthy individuals that ended on the landing: of the stairs of their rung on a ladder, of their own stairs where stairs
    /// evolve.
    pub on_landing: u32,
    /// Index of the first individual on the landing. None if there is none.
    pub first_on_landing: Option<u32>,
    /// Statistics of the fitness of the healthy individuals. None if all individuals were disqualified.
    pub statistics: Option<Statistics>,
    /// Fitness of the champion over the varied trials on which the run chose it. None if the run chose by the trial alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chosen_by: Option<f64>,
    /// The largest species, at most [`MOST_SPECIES_RECORDED`], in ascending order of their numbers. Where bodies evolve, species are
    /// numbers of blocks. Empty for other strategies, and in logs of earlier versions of the program.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub species: Vec<SpeciesCount>,
    /// Ways in which the trials of the individuals ended, in the order of [`EndingKind`]. Empty in logs of earlier versions of the program.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub endings: Vec<BandCount<EndingKind>>,
    /// Rung of the ladder on which the generation was evaluated. None without a ladder.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rung: Option<Rung>,
    /// Numbers of stairs after the generation. None unless stairs evolve.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stairs: Option<StairsCount>,
    /// Hash over the bits of every evaluation, in the order of the individuals. Files have its 16 hexadecimal digits.
    #[serde(with = "hex_hash")]
    pub hash: u64,
    /// Wall-clock time since the generation began or the program was started, in seconds. No hash includes it.
    pub elapsed_s: f64,
}

/// Statistics of the fitness of the healthy individuals of one generation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Statistics {
    /// Mean fitness.
    pub mean: f64,
    /// Greatest fitness.
    pub best: f64,
    /// Median; of an even number of individuals, the mean of the two middle values.
    pub median: f64,
    /// Standard deviation of the fitness over all healthy individuals (divided by n).
    pub std: f64,
    /// Least fitness.
    pub worst: f64,
    /// Mean final y of the individuals' centres, in m, whatever the fitness measures.
    pub mean_centre_y_m: f64,
    /// Lower quartile of the fitness. None in logs of earlier versions of the program.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower_quartile: Option<f64>,
    /// Upper quartile of the fitness. None in logs of earlier versions of the program.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub upper_quartile: Option<f64>,
}

/// A rung of a ladder of stairs, and the successes of a generation on it. The rung of the next generation follows from the records of all
/// earlier generations.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rung {
    /// Rise of a step of the stairs, in m.
    pub rise_m: f32,
    /// Number of individuals that succeeded on the rung.
    pub successes: u32,
}

/// Maximum number of trials of a snake: one, and the varied trials of the settings `trials` or `champion_trials`. Two candidates for champion
/// are simulated beside the evaluations of a generation.
const MOST_TRIALS: u64 = 101;

/// Maximum number of species in the record of a generation. It limits the size of a log, so that the log of the longest run can be read.
pub const MOST_SPECIES_RECORDED: usize = 24;

/// Number and best fitness of those individuals of a generation that share a species, a number of blocks or an ending. Files have it as a list
/// of id, size and best fitness.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(
    into = "(Id, u32, Option<f32>)",
    from = "(Id, u32, Option<f32>)",
    bound(serialize = "Id: Copy + Serialize", deserialize = "Id: Deserialize<'de>")
)]
pub struct BandCount<Id> {
    /// Shared species, number of blocks or ending.
    pub id: Id,
    /// Number of these individuals, at least 1.
    pub size: u32,
    /// Best fitness of the healthy ones. None if all of them were disqualified.
    pub best: Option<f32>,
}

/// A species in a generation. The ids of species ascend in the order of appearance.
pub type SpeciesCount = BandCount<u32>;

impl<Id> From<BandCount<Id>> for (Id, u32, Option<f32>) {
    fn from(BandCount { id, size, best }: BandCount<Id>) -> Self {
        (id, size, best)
    }
}

impl<Id> From<(Id, u32, Option<f32>)> for BandCount<Id> {
    fn from((id, size, best): (Id, u32, Option<f32>)) -> Self {
        Self { id, size, best }
    }
}

impl<Id: Copy + Ord + Serialize> BandCount<Id> {
    /// Counts individuals by their ids, in ascending order. `ids` has the id of each individual.
    pub fn of(ids: impl IntoIterator<Item = Id>, evaluations: &[Evaluation]) -> Vec<Self> {
        let mut counts: BTreeMap<Id, Self> = BTreeMap::new();
        for (id, evaluation) in ids.into_iter().zip(evaluations) {
            let count = counts.entry(id).or_insert(Self { id, size: 0, best: None });
            count.size += 1;
            if evaluation.disqualified.is_none() {
                let fitness = evaluation.fitness;
                count.best = Some(count.best.map_or(fitness, |best| best.max(fitness)));
            }
        }
        counts.into_values().collect()
    }

    /// Checks that the ids ascend and that all counts together have at most as many members as the generation has individuals.
    fn check(counts: &[Self], evaluations: u32) -> Result<(), Invalid> {
        within("number of counts", counts.len(), 0..=MOST_SPECIES_RECORDED)?;
        if let Some([before, wrong]) = counts.array_windows().find(|[a, b]| a.id >= b.id) {
            let name = |of: &Self| serde_json::to_string(&of.id).unwrap_or_default();
            return Err(Invalid::new("id", name(wrong), format!("one after {}", name(before))));
        }
        let (mut members, evaluations) = (0, u64::from(evaluations));
        for Self { size, best, .. } in counts {
            within("size", u64::from(*size), 1..=evaluations)?;
            best.map_or(Ok(()), |best| within("best", best, FITNESS_RANGE))?;
            members += u64::from(*size);
            within("sum of size", members, 0..=evaluations)?;
        }
        Ok(())
    }
}

impl Statistics {
    /// Returns the lower and the upper quartile. None in logs of earlier versions of the program.
    pub fn quartiles(&self) -> Option<(f64, f64)> {
        self.lower_quartile.zip(self.upper_quartile)
    }
}

impl Rung {
    /// Returns `trial` with the stairs of this rung.
    pub fn on(&self, mut trial: Trial) -> Trial {
        trial.stairs.rise_m = self.rise_m.into();
        trial
    }
}

/// Returns the hash of a run: the hash over the hashes of all its generations.
pub fn run_hash(records: &[GenerationRecord]) -> u64 {
    let mut hash = Xxh3Default::new();
    records.iter().for_each(|record| hash.update(&record.hash.to_le_bytes()));
    hash.digest()
}

impl GenerationRecord {
    /// Checks that the record can be number `generation` of a run. `plan` is the plan of the run after all its changes.
    ///
    /// # Errors
    /// Names the first value that is not allowed.
    pub fn check(&self, generation: u32, plan: &RunPlan) -> Result<(), Invalid> {
        let most = u32::try_from(plan.budget()).unwrap_or(u32::MAX);
        within("generation", self.generation, generation..=generation)?;
        within("generation", generation, 1..=plan.settings.evolution.generations)?;
        within("evaluations", self.evaluations, 0..=most)?;
        if let Some(simulations) = self.simulations {
            let most = MOST_TRIALS * (u64::from(self.evaluations) + 2);
            within("simulations", simulations, 0..=most)?;
        }
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
        let of_species = BandCount::check(&self.species, self.evaluations);
        of_species.map_err(|error| error.inside("species"))?;
        let of_endings = BandCount::check(&self.endings, self.evaluations);
        of_endings.map_err(|error| error.inside("endings"))?;
        if let Some(Rung { rise_m, successes }) = self.rung {
            within("rung.rise_m", rise_m, 0.0..=5.0)?;
            within("rung.successes", successes, 0..=self.evaluations)?;
        }
        self.stairs.map_or(Ok(()), StairsCount::check)
    }

    /// Makes a record of healthy individuals without statistics, for tests.
    pub fn of_test(generation: u32, evaluations: u32) -> Self {
        let hash = 0x0123_4567_89ab_cdef;
        Self { generation, evaluations, hash, elapsed_s: 1.0, ..Self::default() }
    }
}
