//! The generations of a run that were better than all before them, with the snakes to show of each.

use std::sync::Arc;

use crate::studio::stage::{MAX_GENERATION, evenly};
use snakes_core::genome::Genome;
use snakes_core::score::Evaluation;
use snakes_lab::run::{Generation, GenerationReport};

/// A generation whose best snake beat all earlier ones.
#[derive(Debug, Clone)]
pub(crate) struct Milestone {
    /// The first is 1.
    pub generation: u32,
    /// Height of its stairs, in metres.
    pub stairs_m: f32,
    /// Fitness of its best snake.
    pub fitness: f32,
    /// Whether its best snake ended on the landing.
    pub is_landed: bool,
    /// The snakes to show, the best first; empty if an earlier session finished the generation.
    pub members: Arc<[GenerationMember]>,
    /// Number of snakes in the generation.
    pub size: u32,
}

/// A snake of a generation, without the trial that all of them share.
#[derive(Debug, Clone)]
pub(crate) struct GenerationMember {
    /// Its index in the generation.
    pub individual: u32,
    /// Its genome.
    pub genome: Arc<Genome>,
    /// Its evaluation.
    pub evaluation: Evaluation,
}

/// The milestones of a run, the first first.
#[derive(Debug, Default)]
pub(crate) struct Milestones(Vec<Milestone>);

/// Maximum number of milestones whose snakes are kept; of the others only the best is.
const MAX_WHOLE: usize = 64;

impl Milestone {
    /// Whether its snakes are kept, not only its best one.
    pub fn is_whole(&self) -> bool {
        !self.members.is_empty()
    }
}

impl Milestones {
    /// All of them.
    pub fn all(&self) -> &[Milestone] {
        &self.0
    }

    /// Notes a finished generation if it is better than all before it. `snakes` are all its snakes, if they are kept.
    pub fn note(&mut self, report: &GenerationReport, snakes: Option<&Generation>) {
        let Some(champion) = &report.champion else { return };
        let fitness = champion.evaluation.fitness;
        let stairs_m = champion.trial.stairs.highest_m();
        // On a ladder, higher stairs come before greater fitness. Where stairs evolve, only better champions are kept.
        let is_no_better = |last: &Milestone| [stairs_m, fitness] <= [last.stairs_m, last.fitness];
        if report.stairs.is_none() && self.0.last().is_some_and(is_no_better) {
            return;
        }
        self.0.push(Milestone {
            generation: report.generation,
            stairs_m,
            fitness,
            // On a ladder, only on the stairs to which it leads.
            is_landed: report.on_landing > 0
                && champion.evaluation.is_on_landing(&champion.trial.stairs),
            // Members on stairs of their own would be shown on the stairs of the run.
            members: match report.stairs {
                Some(_) => Arc::default(),
                None => snakes.map_or_else(Arc::default, members_to_show),
            },
            size: report.evaluations,
        });
        if self.0.iter().filter(|milestone| milestone.is_whole()).count() > MAX_WHOLE {
            // The first is the beginning of every story, so it stays.
            let oldest = self.0.iter_mut().skip(1).find(|milestone| milestone.is_whole());
            oldest.into_iter().for_each(|oldest| oldest.members = Arc::default());
        }
    }
}

/// The snakes of a generation to show, the best first: all, or of many some from the best to the worst.
pub(crate) fn members_to_show(generation: &Generation) -> Arc<[GenerationMember]> {
    let mut ranking: Vec<usize> = (0..generation.genomes.len()).collect();
    ranking.sort_by(|a, b| {
        let [a, b] = [a, b].map(|index| &generation.evaluations[*index]);
        let is_out = |evaluation: &Evaluation| evaluation.disqualified.is_some();
        is_out(a).cmp(&is_out(b)).then(b.fitness.total_cmp(&a.fitness))
    });
    let member = |rank: usize| {
        let index = ranking[rank];
        GenerationMember {
            individual: index as u32,
            genome: Arc::clone(&generation.genomes[index]),
            evaluation: generation.evaluations[index],
        }
    };
    evenly(ranking.len(), MAX_GENERATION, MAX_GENERATION).map(member).collect()
}
