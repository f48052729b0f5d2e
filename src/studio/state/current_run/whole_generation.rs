//! The generations that the stage shows whole.

use std::sync::Arc;

use super::CurrentRun;
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::stage::{Show, StageMode};
use crate::studio::state::milestones::{GenerationMember, Milestone, members_to_show};
use snakes_core::evolve::{Champion, IndividualId};
use snakes_lab::run::GenerationReport;

impl CurrentRun {
    /// The generations that were better than all before them, the first first.
    pub fn milestones(&self) -> &[Milestone] {
        self.milestones.all()
    }

    /// Notes a finished generation if it is better than all before it.
    pub(super) fn note_milestone(&mut self, report: &GenerationReport) {
        let latest = self.exploration.as_ref().and_then(|explored| explored.generation.as_ref());
        let snakes = latest.filter(|of| of.number == report.generation);
        self.milestones.note(report, snakes.map(|snakes| &**snakes));
    }

    /// A generation for the stage: all its snakes if they are kept, else its best alone; none if it is unknown or all
    /// its snakes were disqualified.
    pub fn whole_generation(&self, number: u32) -> Option<Show> {
        let milestone = self.milestones().iter().find(|milestone| milestone.generation == number);
        let latest = self.exploration().and_then(|explored| explored.generation.as_ref());
        let latest = latest.filter(|latest| latest.number == number);
        let (kept, size) = match (milestone.filter(|milestone| milestone.is_whole()), latest) {
            (Some(milestone), _) => (Arc::clone(&milestone.members), milestone.size),
            (None, Some(latest)) => (members_to_show(latest), latest.genomes.len() as u32),
            (None, None) => (Arc::default(), 0),
        };
        if kept.len() < 2 {
            let champion = self.champion_of(number)?;
            return Some(Show::solo(StagedChampion::from_run(champion, self.number())));
        }
        let champion = |member: &GenerationMember| Champion {
            genome: (*member.genome).clone(),
            trial: self
                .trial_of(IndividualId { generation: number, individual: member.individual }),
            evaluation: member.evaluation,
            chosen_by: None,
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
    use crate::studio::stage::MAX_GENERATION;
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
