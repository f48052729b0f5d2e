//! Looks up individuals of the current run by their place.

use std::sync::Arc;

use super::CurrentRun;
use snakes_core::evolve::{Champion, IndividualId, Origin, Parents};
use snakes_core::genome::Genome;
use snakes_core::score::{Evaluation, Trial, evaluate};
use snakes_lab::run::{Ancestor, Generation, caught};

impl CurrentRun {
    /// An individual of the latest generation, a champion, or an individual with descendants; `None` if it is not kept.
    /// An unknown evaluation is computed again.
    pub fn individual(&self, place: IndividualId) -> Option<Champion> {
        let genome = (*self.genome_of(place)?).clone();
        self.found(place, genome, self.trial_of(place), self.evaluation_of(place))
    }

    /// A member of the Pareto front of distance and energy.
    pub fn front_member(&self, generation: u32, individual: u32) -> Option<Champion> {
        let mut members = self.exploration()?.front.members();
        let member =
            members.find(|is| (is.generation, is.individual) == (generation, individual))?;
        let (genome, trial) = (member.genome.clone(), self.trial_in(generation));
        let place = IndividualId { generation, individual };
        self.found(place, genome, trial, Some(member.evaluation))
    }

    /// The elite of an archive cell. The archive keeps genes and fitness; the evaluation is computed again.
    pub fn elite(&self, cell: u32) -> Option<Champion> {
        let elite = self.exploration()?.archive.as_ref()?.elite(cell)?;
        let trial = self.trial_in(elite.generation);
        let genome = elite.genes.genome(&self.settings().genome, trial.genome_shape());
        self.found(elite.id(), genome, trial, None)
    }

    /// The agent of stairs that evolved. The tree keeps its genes; the evaluation is computed again.
    pub fn stairs_agent(&self, node: u32) -> Option<Champion> {
        let tree = self.exploration()?.stairs.as_ref()?;
        let node = tree.nodes.get(node as usize)?;
        let agent = node.agent.as_ref()?;
        let (generation, individual) = (agent.generation, agent.individual);
        let place = IndividualId { generation, individual };
        self.found(place, agent.genome.clone(), node.trial(&self.settings().trial), None)
    }

    /// An individual of this run. An unknown evaluation is computed again; `None` if the simulation panics.
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
        let (preset, seed) = (self.preset().to_owned(), self.seed());
        let origin = Origin { preset, seed, generation, individual };
        Some(Champion { genome, trial, evaluation, chosen_by: None, origin })
    }

    /// The latest generation with all its individuals, if it has this number.
    pub(super) fn latest(&self, number: u32) -> Option<&Generation> {
        let latest = self.exploration()?.generation.as_deref()?;
        (latest.number == number).then_some(latest)
    }

    /// The trial in which an individual was evaluated: where stairs evolve, on its own, if they are known.
    pub(super) fn trial_of(&self, place: IndividualId) -> Trial {
        let trial = self.trial_in(place.generation);
        let latest = self.latest(place.generation);
        let own = latest.and_then(|latest| latest.stairs.get(place.individual as usize));
        let of_champion = || Some(self.champion_at(place)?.trial.clone());
        own.map(|own| own.on(&trial)).or_else(of_champion).unwrap_or(trial)
    }

    /// The trial in which the individuals of a generation were evaluated.
    pub(super) fn trial_in(&self, generation: u32) -> Trial {
        let trial = self.plan_now.trial_in(generation);
        let index = generation.checked_sub(1).map(|index| index as usize);
        let report = index.and_then(|index| self.reports.get(index));
        match report.and_then(|report| report.rung) {
            Some(rung) => rung.on(trial),
            None => trial,
        }
    }

    /// The genome of an individual, if it is kept.
    pub fn genome_of(&self, place: IndividualId) -> Option<Arc<Genome>> {
        let latest = self.latest(place.generation);
        let of_latest = latest.and_then(|latest| latest.genomes.get(place.individual as usize));
        let of_ancestor = || self.ancestor(place)?.genome.as_ref();
        let of_champion = || {
            let champion = self.champion_at(place)?;
            Some(Arc::new(champion.genome.clone()))
        };
        of_latest.or_else(of_ancestor).cloned().or_else(of_champion)
    }

    /// The parents of an individual, if they are kept.
    pub fn parents_of(&self, place: IndividualId) -> Option<Parents> {
        let latest = self.latest(place.generation);
        let of_latest = latest.and_then(|of| of.parents.get(place.individual as usize)).copied();
        of_latest.or_else(|| Some(self.ancestor(place)?.parents))
    }

    /// An individual with descendants.
    fn ancestor(&self, place: IndividualId) -> Option<&Arc<Ancestor>> {
        let exploration = self.exploration()?;
        // A line may have ten thousand generations, each of which is looked up, so build a map once.
        let ancestors = self.ancestors.get_or_init(|| {
            let ancestry = &exploration.ancestry;
            let parents = exploration.parents.iter().map(|(parent, _)| parent);
            let all = parents.rev().chain(ancestry.others.iter().rev());
            let all = all.chain(ancestry.line.iter().rev());
            // If several share a place, the first of the line wins, since it is inserted last.
            all.map(|ancestor| (ancestor.place, Arc::clone(ancestor))).collect()
        });
        ancestors.get(&place)
    }

    fn evaluation_of(&self, place: IndividualId) -> Option<Evaluation> {
        let latest = self.latest(place.generation);
        let of_latest = latest.and_then(|of| of.evaluations.get(place.individual as usize));
        of_latest.copied().or_else(|| Some(self.champion_at(place)?.evaluation))
    }

    fn champion_at(&self, place: IndividualId) -> Option<&Champion> {
        let champion = self.champion_of(place.generation)?;
        (champion.origin.individual == place.individual).then_some(champion)
    }
}
