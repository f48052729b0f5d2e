//! The interface of all strategies, and the ranking of a generation.

use ron::ser::{PrettyConfig, to_string_pretty};
use ron::value::RawValue;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::archives::Archive;
use super::candidate::Candidate;
use super::parents::IndividualId;
use super::plan::RunPlan;
use super::stairs_tree::StairsTree;
use crate::check::Invalid;
use crate::learn::Episode;
use crate::score::Evaluation;

/// A search strategy, which works generation by generation.
///
/// A strategy receives genomes and evaluations; it has no access to the world, a thread or a clock. The stream of each random number is
/// identified by the individual for which the number is drawn.
pub trait Strategy: Send {
    /// Begins the search of a new run.
    fn begin(plan: &RunPlan) -> Self
    where
        Self: Sized;

    /// Restores the search after the first `finished` generations of a run.
    ///
    /// # Errors
    /// Fails if the state is not a state of this strategy with this plan. An accepted state, even from an unknown file, needs no more
    /// memory and time than the settings allow.
    fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Result<Self, Invalid>
    where
        Self: Sized;

    /// Returns the candidates of the next generation, in the order of their indices. A second call returns equal candidates.
    fn ask(&self) -> Vec<Candidate>;

    /// Returns the number of candidates in the next generation.
    fn population(&self) -> usize;

    /// Learns from the candidates that the last call of `ask` returned and from their evaluations, in equal order.
    fn tell(&mut self, candidates: &[Candidate], evaluations: &[Evaluation]);

    /// Forgets the values of all generations so far. A ladder may put later generations on other stairs, where values are not comparable
    /// with earlier values; a search that ends when its values stagnate would end too early.
    fn forget_values(&mut self) {}

    /// Returns whether the strategy also learns from the experience of episodes, not only from evaluations.
    fn learns_from_episodes(&self) -> bool {
        false
    }

    /// Learns from the episodes of the candidates that the last call of `ask` returned, in equal order; the call of `tell` follows. An
    /// evaluation that failed has no episode.
    fn learn(&mut self, _episodes: Vec<Option<Episode>>) {}

    /// Returns the state of the strategy: everything that it has learned. With the settings, the seed and the number of finished
    /// generations, the state is enough to continue the run bit for bit.
    fn state(&self) -> StrategyState;

    /// Adopts a plan in which settings have changed that [`may_change_during_run`](super::may_change_during_run) allows. The new values
    /// apply from the next generation on.
    fn apply_settings(&mut self, plan: &RunPlan);

    /// Returns the individuals that may become parents from now on, in an order of the strategy's own.
    fn parent_pool(&self) -> Vec<IndividualId> {
        Vec::new()
    }

    /// Restores the ids of parents after [`Self::resume`], for a strategy whose state has only the parents' genes. `_pool` has the ids of
    /// [`Self::parent_pool`] that belong to the last generation; a strategy with older parents keeps ids in its state. Ids that do not fit
    /// the state are ignored, and those parents stay unknown.
    fn restore_parents(&mut self, _pool: &[IndividualId]) {}

    /// Returns a copy of the archive of elites. None if the strategy keeps none.
    fn archive(&self) -> Option<Archive> {
        None
    }

    /// Returns a copy of the tree of stairs. None unless stairs evolve.
    fn stairs_tree(&self) -> Option<StairsTree> {
        None
    }
}

/// State of a strategy, as a value of RON that only the strategy itself can read. Its numbers keep every bit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StrategyState {
    ron: String,
}

impl StrategyState {
    /// Maximum length of the parser's message in an error, in characters.
    const LONGEST_PROBLEM: usize = 200;

    /// Writes plain data as a state.
    pub fn of(data: &impl Serialize) -> Self {
        let layout = PrettyConfig::new().compact_arrays(true).struct_names(false);
        // Plain data can always be written. If it could not, the state is empty, and storing the empty state reports the error.
        Self { ron: to_string_pretty(data, layout).unwrap_or_default() }
    }

    /// Reads the data of the state.
    ///
    /// # Errors
    /// Fails if the state is damaged, or if another strategy wrote it.
    pub fn read<T: DeserializeOwned>(&self) -> Result<T, Invalid> {
        ron::from_str(&self.ron).map_err(|error| {
            let problem = error.code.to_string();
            let problem: String = problem.chars().take(Self::LONGEST_PROBLEM).collect();
            let value = format!("unreadable ({})", problem.escape_debug());
            Invalid::new("state", value, "the state of the run's strategy")
        })
    }
}

impl Serialize for StrategyState {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        RawValue::from_ron(&self.ron).map_err(serde::ser::Error::custom)?.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for StrategyState {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = Box::<RawValue>::deserialize(deserializer)?;
        Ok(Self { ron: value.get_ron().trim().to_owned() })
    }
}

/// Returns the indices of the individuals that are not disqualified, best first. Of individuals with equal fitness, the lower index comes
/// first.
pub fn ranking(evaluations: &[Evaluation]) -> Vec<usize> {
    let mut ranked: Vec<usize> =
        (0..evaluations.len()).filter(|&i| evaluations[i].disqualified.is_none()).collect();
    ranked.sort_by(|&a, &b| evaluations[b].fitness.total_cmp(&evaluations[a].fitness));
    ranked
}

/// Returns the indices of all individuals, best first: those of [`ranking`], then the disqualified, of which longer simulated ones come
/// first, so that a strategy that uses all ranks learns to avoid disqualification.
pub fn full_ranking(evaluations: &[Evaluation]) -> Vec<usize> {
    let mut ranked = ranking(evaluations);
    let mut others: Vec<usize> =
        (0..evaluations.len()).filter(|&i| evaluations[i].disqualified.is_some()).collect();
    others.sort_by_key(|&i| std::cmp::Reverse(evaluations[i].steps));
    ranked.append(&mut others);
    ranked
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::Disqualification;

    #[test]
    fn the_disqualified_rank_last_and_ties_go_to_the_lower_index() {
        let evaluation = |fitness, steps, disqualified| Evaluation {
            steps,
            disqualified,
            ..Evaluation::of_fitness(fitness)
        };
        let evaluations = [
            evaluation(1.0, 9, None),
            evaluation(180.0, 3, Some(Disqualification::TooFast)),
            evaluation(3.0, 9, None),
            evaluation(150.0, 7, Some(Disqualification::TooFast)),
            evaluation(1.0, 9, None),
        ];
        assert_eq!(ranking(&evaluations), [2, 0, 4]);
        assert_eq!(full_ranking(&evaluations), [2, 0, 4, 3, 1]);
    }

    #[test]
    fn a_state_keeps_every_bit_and_is_refused_as_another_type() {
        let numbers = [0.1, -0.0, 5e-324, f64::MAX, 1.0 / 3.0, f64::NEG_INFINITY];
        let singles = [0.1_f32, f32::MIN_POSITIVE, 16_777_216.0, f32::EPSILON];
        let state = StrategyState::of(&(numbers, singles));
        let file = ron::to_string(&state).expect("written");
        let state: StrategyState = ron::from_str(&file).expect("read");
        let (read, read_singles): ([f64; 6], [f32; 4]) = state.read().expect("the same type");
        assert_eq!(read.map(f64::to_bits), numbers.map(f64::to_bits));
        assert_eq!(read_singles.map(f32::to_bits), singles.map(f32::to_bits));
        let error = state.read::<Vec<f64>>().expect_err("another type").to_string();
        assert!(error.starts_with("state is unreadable ("), "{error}");
    }
}
