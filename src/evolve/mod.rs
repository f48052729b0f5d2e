//! Strategies: who is asked for the next genomes, and told how they did.
//!
//! A strategy sees genomes and evaluations, never the world, a thread or a clock. All its randomness
//! comes from streams named after the individual it is for.

mod champion;
mod field;
mod halving;
mod settings;

pub use champion::{Champion, Origin};
pub use field::{fields, with_field, with_fields};
pub use halving::{Halving, HalvingSettings, LARGEST_POPULATION};
pub use settings::{RunPlan, Settings};

use crate::genome::Genome;
use crate::score::Evaluation;

/// A way to search, one generation at a time.
pub trait Strategy {
    /// The genomes of the next generation, in the order of their indices.
    fn ask(&self) -> Vec<Genome>;

    /// How the genomes of the last `ask` did, in the same order.
    fn tell(&mut self, genomes: &[Genome], evaluations: &[Evaluation]);

    /// All that it has learned: together with settings, seed and the number of finished generations,
    /// enough to go on bit for bit.
    fn state(&self) -> StrategyState;
}

/// What a strategy has learned.
#[derive(Debug, Clone, PartialEq)]
pub enum StrategyState {
    /// Of [`Halving`].
    Halving {
        /// The parents of the next generation, best first.
        parents: Vec<Genome>,
    },
}

/// The indices of the agents that may become parents, best first. Disqualified ones may not; of equals
/// the one with the lower index is first.
pub fn ranking(evaluations: &[Evaluation]) -> Vec<usize> {
    let mut ranked: Vec<usize> =
        (0..evaluations.len()).filter(|&i| evaluations[i].disqualified.is_none()).collect();
    ranked.sort_by(|&a, &b| evaluations[b].fitness.total_cmp(&evaluations[a].fitness));
    ranked
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::Disqualification;

    #[test]
    fn the_disqualified_are_not_ranked_and_ties_go_to_the_first() {
        let evaluation = |fitness, disqualified| Evaluation {
            fitness,
            centre_y_m: fitness,
            disqualified,
            trace_hash: 0,
            steps: 0,
            effort: None,
        };
        let evaluations = [
            evaluation(1.0, None),
            evaluation(180.0, Some(Disqualification::TooFast)),
            evaluation(3.0, None),
            evaluation(1.0, None),
        ];
        assert_eq!(ranking(&evaluations), [2, 0, 3]);
    }
}
