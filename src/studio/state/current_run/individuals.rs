//! Finds individuals of the current run by their place: generation and index.

use std::sync::Arc;

use super::CurrentRun;
use snakes_core::evolve::{Champion, IndividualId, Origin, Parents};
use snakes_core::genome::Genome;
use snakes_core::score::{Evaluation, Trial, evaluate};
use snakes_lab::run::{Ancestor, Generation, caught};

impl CurrentRun {
    /// Returns an individual of the latest generation, a champion, or an individual with descendants; `None` if the
    /// individual is not kept. An unknown evaluation is computed again.
    pub fn individual(&self, place: IndividualId) -> Option<Champion> {
        let genome = (*self.genome_of(place)?).clone();
        let latest = self.latest(place.generation);
        let of_latest = latest.and_then(|of| of.evaluations.get(place.individual as usize));
        let of_champion = || Some(self.champion_at(place)?.evaluation);
        let known = of_latest.copied().or_else(of_champion);
        self.found(place, genome, self.trial_of(place), known)
    }

    /// Returns the member of the Pareto front of distance and energy at this place.
    pub fn front_member(&self, place: IndividualId) -> Option<Champion> {
        let mut members = self.exploration()?.front.members();
        let IndividualId { generation, individual } = place;
        let member =
            members.find(|is| (is.generation, is.individual) == (generation, individual))?;
        let (genome, trial) = (member.genome.clone(), self.trial_in(generation));
        self.found(place, genome, trial, Some(member.evaluation))
    }

    /// Returns the elite of an archive cell. The archive keeps the elite's genes and fitness; the evaluation is computed again.
    pub fn elite(&self, cell: u32) -> Option<Champion> {
        let elite = self.exploration()?.archive.as_ref()?.elite(cell)?;
        let trial = self.trial_in(elite.generation);
        let genome = elite.genes.genome(&self.settings().genome, trial.genome_shape());
        self.found(elite.id(), genome, trial, None)
    }

    /// Returns the agent that is paired with evolved stairs. The tree of stairs keeps the agent's genes; the evaluation
    /// is computed again.
    pub fn stairs_agent(&self, node: u32) -> Option<Champion> {
        let tree = self.exploration()?.stairs.as_ref()?;
        let node = tree.nodes.get(node as usize)?;
        let agent = node.agent.as_ref()?;
        let place = IndividualId { generation: agent.generation, individual: agent.individual };
        self.found(place, agent.genome.clone(), node.trial(&self.settings().trial), None)
    }

    /// Builds the champion of a known genome. Computes an unknown evaluation again; returns `None` if the simulation panics.
    pub(super) fn found(
        &self,
        place: IndividualId,
        genome: Genome,
        trial: Trial,
        known: Option<Evaluation>,
    ) -> Option<Champion> {
        let evaluation = match known {
            Some(evaluation) => evaluation,
            None => caught(|| evaluate(&genome, &trial)).ok()?,
        };
        let IndividualId { generation, individual } = place;
        let (preset, seed) = (self.plan_now.preset.clone(), self.plan_now.seed);
        let origin = Origin { preset, seed, generation, individual };
        Some(Champion { genome, trial, evaluation, chosen_by: None, origin })
    }

    /// Returns the latest generation with all its individuals, if it has this number.
    pub(super) fn latest(&self, number: u32) -> Option<&Generation> {
        let latest = self.exploration()?.generation.as_deref()?;
        (latest.number == number).then_some(latest)
    }

    /// Returns the trial in which an individual was evaluated. Where stairs evolve, the trial has the individual's own
    /// stairs if they are known.
    pub(super) fn trial_of(&self, place: IndividualId) -> Trial {
        let trial = self.trial_in(place.generation);
        let latest = self.latest(place.generation);
        let own = latest.and_then(|latest| latest.stairs.get(place.individual as usize));
        let of_champion = || Some(self.champion_at(place)?.trial.clone());
        own.map(|own| own.on(&trial)).or_else(of_champion).unwrap_or(trial)
    }

    /// Returns the trial in which the individuals of a generation were evaluated.
    pub(super) fn trial_in(&self, generation: u32) -> Trial {
        let trial = self.plan_now.trial_in(generation);
        let index = generation.checked_sub(1).map(|index| index as usize);
        let report = index.and_then(|index| self.reports.get(index));
        match report.and_then(|report| report.rung) {
            Some(rung) => rung.on(trial),
            None => trial,
        }
    }

    /// Returns the genome of an individual, if it is kept.
    pub fn genome_of(&self, place: IndividualId) -> Option<Arc<Genome>> {
        let latest = self.latest(place.generation);
        let of_latest = latest.and_then(|latest| latest.genomes.get(place.individual as usize));
        let of_ancestor = || self.ancestor(place)?.genome.as_ref();
        let of_champion = || Some(Arc::new(self.champion_at(place)?.genome.clone()));
        of_latest.or_else(of_ancestor).cloned().or_else(of_champion)
    }

    /// Returns the parents of an individual, if they are kept.
    pub fn parents_of(&self, place: IndividualId) -> Option<Parents> {
        let latest = self.latest(place.generation);
        let of_latest = latest.and_then(|of| of.parents.get(place.individual as usize)).copied();
        of_latest.or_else(|| Some(self.ancestor(place)?.parents))
    }

    /// Returns an individual with descendants, if it is kept.
    fn ancestor(&self, place: IndividualId) -> Option<&Arc<Ancestor>> {
        let exploration = self.exploration()?;
        // A line of descent may have ten thousand generations, each of which is looked up, so a map is built once.
        let ancestors = self.ancestors.get_or_init(|| {
            let ancestry = &exploration.ancestry;
            let parents = exploration.parents.iter().map(|(parent, _)| parent);
            let all = parents.rev().chain(ancestry.others.iter().rev());
            let all = all.chain(ancestry.line.iter().rev());
            // If several ancestors share a place, the one of the line is inserted last and stays.
            all.map(|ancestor| (ancestor.place, Arc::clone(ancestor))).collect()
        });
        ancestors.get(&place)
    }

    fn champion_at(&self, place: IndividualId) -> Option<&Champion> {
        let champion = self.champion_of(place.generation)?;
        (champion.origin.individual == place.individual).then_some(champion)
    }
}
