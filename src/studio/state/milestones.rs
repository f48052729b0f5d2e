//! Generations of a run that were better than all earlier ones, with the snakes to show of each.

use std::sync::Arc;

use crate::studio::stage::{MAX_GENERATION, evenly};
use snakes_core::genome::Genome;
use snakes_core::score::Evaluation;
use snakes_lab::run::{Generation, GenerationReport};

/// A generation whose best snake beat all earlier ones.
#[derive(Debug, Clone)]
pub(crate) struct Milestone {
    /// Number of the generation; the first is 1.
    pub generation: u32,
    /// Height of the stairs of the generation, in metres.
    pub stairs_m: f32,
    /// Fitness of the generation's best snake.
    pub fitness: f32,
    /// Whether the generation's best snake ended on the landing.
    pub is_landed: bool,
    /// Snakes of the generation to show, the best first; empty if they are not kept.
    pub members: Arc<[GenerationMember]>,
    /// Number of snakes in the generation.
    pub size: u32,
}

/// A snake of a generation, without the trial that all the snakes share.
#[derive(Debug, Clone)]
pub(crate) struct GenerationMember {
    /// Index of the snake in its generation.
    pub individual: u32,
    /// Genome of the snake.
    pub genome: Arc<Genome>,
    /// Evaluation of the snake.
    pub evaluation: Evaluation,
}

/// Maximum number of milestones whose snakes are kept. Of older ones, only the champion can be shown.
const MAX_WHOLE: usize = 64;

impl Milestone {
    /// Returns whether the generation's snakes are kept, rather than only its champion.
    pub fn is_whole(&self) -> bool {
        !self.members.is_empty()
    }
}

/// Adds a finished generation to the milestones of a run if it is better than all earlier ones. `snakes` are all its snakes, if they are kept.
pub(crate) fn note(
    milestones: &mut Vec<Milestone>,
    report: &GenerationReport,
    snakes: Option<&Generation>,
) {
    let Some(champion) = &report.champion else { return };
    let fitness = champion.evaluation.fitness;
    let stairs_m = champion.trial.stairs.highest_m();
    // On a ladder, higher stairs rank before greater fitness. Where stairs evolve, all recorded champions are better ones.
    let is_no_better = |last: &Milestone| [stairs_m, fitness] <= [last.stairs_m, last.fitness];
    if report.stairs.is_none() && milestones.last().is_some_and(is_no_better) {
        return;
    }
    milestones.push(Milestone {
        generation: report.generation,
        stairs_m,
        fitness,
        // On a ladder, only a landing on its final stairs counts.
        is_landed: report.on_landing > 0
            && champion.evaluation.is_on_landing(&champion.trial.stairs),
        // Where stairs evolve, the members have different stairs and could not be shown on the same ones.
        members: match report.stairs {
            Some(_) => Arc::default(),
            None => snakes.map_or_else(Arc::default, members_to_show),
        },
        size: report.evaluations,
    });
    if milestones.iter().filter(|milestone| milestone.is_whole()).count() > MAX_WHOLE {
        // The first milestone keeps its snakes, because every story begins with it.
        let oldest = milestones.iter_mut().skip(1).find(|milestone| milestone.is_whole());
        oldest.into_iter().for_each(|oldest| oldest.members = Arc::default());
    }
}

/// Returns the snakes of a generation to show, the best first. Of many, some are chosen from the best to the worst.
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
