//! The generations of the current run that were better than all before them, with the snakes to show of each.

use std::sync::Arc;

use super::CurrentRun;
use crate::evolve::Champion;
use crate::genome::Genome;
use crate::run::{Generation, GenerationReport};
use crate::score::Evaluation;
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::stage::{MAX_GENERATION, Show, StageMode};
use crate::studio::state::lineup::evenly;

/// A generation whose best snake beat all earlier ones.
#[derive(Debug, Clone)]
pub(crate) struct Milestone {
    /// The first is 1.
    pub generation: u32,
    /// Fitness of its best snake.
    pub fitness: f32,
    /// Whether its best snake ended on the landing.
    pub is_landed: bool,
    /// The snakes to show, the best first; empty if an earlier session finished the generation.
    members: Arc<[Member]>,
    /// Number of snakes in the generation.
    size: u32,
}

/// A snake of a generation, without the trial that all of them share.
#[derive(Debug, Clone)]
struct Member {
    individual: u32,
    genome: Arc<Genome>,
    evaluation: Evaluation,
}

/// Maximum number of milestones whose snakes are kept; of the others only the best is.
const MAX_WHOLE: usize = 64;

/// The snakes of a generation to show, the best first: all, or of many some from the best to the worst.
fn members(generation: &Generation) -> Arc<[Member]> {
    let mut ranking: Vec<usize> = (0..generation.genomes.len()).collect();
    let key = |index: usize| {
        let evaluation = &generation.evaluations[index];
        (evaluation.disqualified.is_some(), -evaluation.fitness)
    };
    ranking.sort_by(|a, b| {
        let ((a_out, a_cost), (b_out, b_cost)) = (key(*a), key(*b));
        a_out.cmp(&b_out).then(a_cost.total_cmp(&b_cost))
    });
    let member = |rank: usize| {
        let index = ranking[rank];
        Member {
            individual: index as u32,
            genome: Arc::clone(&generation.genomes[index]),
            evaluation: generation.evaluations[index],
        }
    };
    evenly(ranking.len(), MAX_GENERATION, MAX_GENERATION).map(member).collect()
}

impl Milestone {
    /// Whether its snakes are kept, not only its best one.
    pub fn is_whole(&self) -> bool {
        !self.members.is_empty()
    }
}

impl CurrentRun {
    /// The generations that were better than all before them, the first first.
    pub fn milestones(&self) -> &[Milestone] {
        &self.milestones
    }

    /// Notes a finished generation if it is better than all before it. Returns whether it is.
    pub(super) fn note_milestone(&mut self, report: &GenerationReport) -> bool {
        let Some(champion) = &report.champion else { return false };
        let fitness = champion.evaluation.fitness;
        if self.milestones.last().is_some_and(|last| fitness <= last.fitness) {
            return false;
        }
        let generation = self.exploration().and_then(|explored| explored.generation.as_ref());
        let whole = generation.filter(|of| of.number == report.generation);
        let members = whole.map_or_else(Arc::default, |whole| members(whole));
        self.milestones.push(Milestone {
            generation: report.generation,
            fitness,
            is_landed: champion.evaluation.is_on_landing(&champion.trial.stairs),
            members,
            size: report.evaluations,
        });
        // The first is the beginning of every story, so the second is thinned out.
        let whole = self.milestones.iter().filter(|milestone| milestone.is_whole());
        if whole.count() > MAX_WHOLE
            && let Some(oldest) =
                self.milestones.iter_mut().skip(1).find(|milestone| milestone.is_whole())
        {
            oldest.members = Arc::default();
        }
        true
    }

    /// A generation for the stage: all its snakes if they are kept, else its best alone; none if it is unknown or all
    /// its snakes were disqualified.
    pub fn whole_generation(&self, number: u32) -> Option<Show> {
        let milestone = self.milestones.iter().find(|milestone| milestone.generation == number);
        let (kept, size) = match milestone.filter(|milestone| milestone.is_whole()) {
            Some(milestone) => (Arc::clone(&milestone.members), milestone.size),
            None => {
                let latest = self.exploration()?.generation.as_ref();
                match latest.filter(|latest| latest.number == number) {
                    Some(latest) => (members(latest), latest.genomes.len() as u32),
                    None => (Arc::default(), 0),
                }
            }
        };
        if kept.len() < 2 {
            let champion = self.champion_of(number)?;
            return Some(Show::solo(StagedChampion::from_run(champion, self.number())));
        }
        let champion = |member: &Member| Champion {
            genome: (*member.genome).clone(),
            trial: self.settings().trial.clone(),
            evaluation: member.evaluation,
            origin: self.origin(number, member.individual),
        };
        let champions = kept.iter().map(champion);
        let staged = champions.map(|champion| StagedChampion::from_run(&champion, self.number()));
        Some(Show { champions: staged.collect(), mode: StageMode::Generation { number, size } })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::state::current_run::explored_run;

    #[test]
    fn a_generation_is_shown_whole_with_its_best_first() {
        let run = explored_run();
        let latest = run.exploration().and_then(|explored| explored.generation.clone());
        let latest = latest.expect("explored");
        let show = run.whole_generation(latest.number).expect("known");
        let StageMode::Generation { number, size } = show.mode else { panic!("{:?}", show.mode) };
        assert_eq!((number, size as usize), (latest.number, latest.genomes.len()));
        assert_eq!(show.champions.len(), latest.genomes.len().min(MAX_GENERATION));
        let healthy = show.champions.iter().map(StagedChampion::champion);
        let fitness: Vec<f32> = healthy
            .map(|champion| champion.evaluation)
            .take_while(|evaluation| evaluation.disqualified.is_none())
            .map(|evaluation| evaluation.fitness)
            .collect();
        assert!(fitness.is_sorted_by(|a, b| a >= b), "{fitness:?}");
        assert!(run.whole_generation(latest.number + 1).is_none());
    }
}
