//! Generations that the stage can show with all their snakes.

use std::sync::Arc;

use super::CurrentRun;
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::stage::{Show, StageMode};
use crate::studio::state::milestones::{GenerationMember, members_to_show, note};
use snakes_core::evolve::IndividualId;
use snakes_lab::run::GenerationReport;

impl CurrentRun {
    /// Records a finished generation as a milestone if it is better than all earlier ones.
    pub(super) fn note_milestone(&mut self, report: &GenerationReport) {
        let explored = self.exploration.as_deref();
        let latest = explored.and_then(|explored| explored.generation.as_deref());
        let snakes = latest.filter(|of| of.number == report.generation);
        note(&mut self.milestones, report, snakes);
    }

    /// Returns a generation to show on the stage: all its snakes if they are kept, or else its champion alone. `None`
    /// if the generation is unknown or all its snakes were disqualified.
    pub fn whole_generation(&self, number: u32) -> Option<Show> {
        let milestone = self.milestones.iter().find(|milestone| milestone.generation == number);
        let whole = milestone.filter(|milestone| milestone.is_whole());
        let (kept, size) = match (whole, self.latest(number)) {
            (Some(milestone), _) => (Arc::clone(&milestone.members), milestone.size),
            (None, Some(latest)) => (members_to_show(latest), latest.genomes.len() as u32),
            (None, None) => (Arc::default(), 0),
        };
        if kept.len() < 2 {
            let champion = self.champion_of(number)?;
            return Some(Show::solo(StagedChampion::from_run(champion, self.number)));
        }
        let staged = |member: &GenerationMember| {
            let place = IndividualId { generation: number, individual: member.individual };
            let (genome, trial) = ((*member.genome).clone(), self.trial_of(place));
            let champion = self.found(place, genome, trial, Some(member.evaluation))?;
            Some(StagedChampion::from_run(&champion, self.number))
        };
        let champions = kept.iter().filter_map(staged).collect();
        Some(Show { champions, mode: StageMode::Generation { number, size } })
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
        let evaluations = show.champions.iter().map(|staged| staged.champion().evaluation);
        let healthy = evaluations.take_while(|evaluation| evaluation.disqualified.is_none());
        let fitness: Vec<f32> = healthy.map(|evaluation| evaluation.fitness).collect();
        assert!(fitness.is_sorted_by(|a, b| a >= b), "{fitness:?}");
        assert!(run.whole_generation(latest.number + 1).is_none());
    }
}
