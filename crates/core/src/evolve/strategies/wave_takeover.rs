//! Wave takeover: a child replaces its parent's least used wave by a much used wave of another good individual.
//!
//! Only the genetic algorithm uses it, and only where genomes have a library of waves.

use std::ops::Range;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::ga::GaMember;
use crate::check::{Invalid, within};
use crate::control::WaveUses;
use crate::evolve::plan::RunPlan;
use crate::score::Evaluation;

/// Number of best individuals whose waves may be taken over.
const DONORS: usize = 4;

/// Positions of a library's waves among the coordinates of a genome's point.
#[derive(Debug, Clone)]
pub struct WaveTakeover {
    /// Ranges of the coordinates of each wave; empty without a library.
    library: Vec<Range<usize>>,
}

impl WaveTakeover {
    /// Makes the wave takeover of a run.
    pub fn new(plan: &RunPlan) -> Self {
        let settings = &plan.settings;
        Self { library: settings.genome.library_coordinates(settings.trial.genome_shape()) }
    }

    /// Checks the wave uses of a member from a file.
    pub fn check(&self, member: &GaMember) -> Result<(), Invalid> {
        let Some(uses) = &member.uses else { return Ok(()) };
        let waves = self.library.len();
        within("number of wave uses", uses.counts().len(), waves..=waves)
    }

    /// Stores the wave uses of a generation in its members; `order` has the index of each member in the generation.
    pub fn learn(&self, members: &mut [GaMember], order: &[usize], evaluations: &[Evaluation]) {
        for (member, &index) in members.iter_mut().zip(order) {
            let behaviour = evaluations.get(index).and_then(|evaluation| evaluation.behaviour);
            let uses = behaviour.and_then(|behaviour| behaviour.wave_uses);
            member.uses = uses.filter(|uses| uses.counts().len() == self.library.len());
        }
    }

    /// Returns, with probability `share`, the index of another of the best members, whose wave a child of member `first` takes over. Draws
    /// no random number where there is no library.
    pub fn donor(
        &self,
        members: &[GaMember],
        first: usize,
        share: f32,
        rng: &mut ChaCha8Rng,
    ) -> Option<usize> {
        members.get(first)?.uses?;
        let is_other =
            |&(index, member): &(usize, &GaMember)| index != first && member.uses.is_some();
        let best = members.iter().enumerate().take(DONORS);
        let others: Vec<usize> = best.filter(is_other).map(|(index, _)| index).collect();
        if others.is_empty() || rng.random_range(0.0..1.0) >= f64::from(share) {
            return None;
        }
        others.get(rng.random_range(0..others.len())).copied()
    }

    /// Copies the most used wave of a donor to the coordinates of the wave that the child's parent used least.
    pub fn take_over(&self, child: &mut [f64], parent: &GaMember, donor: &GaMember) {
        let block = |member: &GaMember, index: fn(&WaveUses) -> usize| {
            member.uses.as_ref().and_then(|uses| self.library.get(index(uses))).cloned()
        };
        let to = block(parent, WaveUses::least_used).and_then(|place| child.get_mut(place));
        let from = block(donor, WaveUses::most_used).and_then(|place| donor.point.get(place));
        if let (Some(to), Some(from)) = (to, from) {
            to.copy_from_slice(from);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::StrategyKind;
    use crate::evolve::strategies::breeder::Breeder;
    use crate::evolve::strategies::fixtures;
    use crate::evolve::strategies::ga::Ga;
    use crate::evolve::strategy::Strategy;
    use crate::genome::ControllerKind;
    use crate::rng::{Purpose, stream};
    use crate::score::Behaviour;

    fn plan(controller: ControllerKind, wave_takeover: f32) -> RunPlan {
        fixtures::plan(StrategyKind::Ga, |settings| {
            settings.evolution.population = 100;
            settings.genome.controller = controller;
            settings.evolution.ga.wave_takeover = wave_takeover;
            // Without crossover, and with the smallest step, children differ from their parents by hardly more than the wave.
            settings.evolution.ga.crossover_share = 0.0;
            settings.evolution.ga.step = 1.0e-4;
        })
    }

    fn uses(counts: [u32; 4]) -> WaveUses {
        counts.to_vec().try_into().expect("allowed")
    }

    /// Returns the evaluations of a generation in which the first individual is the best. Each individual has chosen another wave most.
    fn evaluations(count: usize) -> Vec<Evaluation> {
        let evaluation = |index: usize| {
            let mut counts = [5; 4];
            (counts[index % 4], counts[(index + 1) % 4]) = (20, 0);
            let behaviour = Behaviour { wave_uses: Some(uses(counts)), ..Behaviour::default() };
            let fitness = -(index as f32);
            Evaluation { behaviour: Some(behaviour), ..Evaluation::of_fitness(fitness) }
        };
        (0..count).map(evaluation).collect()
    }

    fn after_one(plan: &RunPlan) -> Ga {
        let mut ga = Ga::begin(plan);
        ga.tell(&ga.ask(), &evaluations(ga.population()));
        ga
    }

    #[test]
    fn a_fifth_of_the_children_replaces_its_parents_least_used_wave_by_the_most_used_of_a_donor() {
        let ga = after_one(&plan(ControllerKind::Rules, 0.2));
        let takeover = WaveTakeover::new(&plan(ControllerKind::Rules, 0.2));
        let (members, mut taken) = (ga.members(), 0);
        let is_near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.002);
        for child in &ga.ask()[2..] {
            let child = &child.heritage;
            let changed = |parent: &GaMember| -> Vec<usize> {
                let is_changed = |place: &Range<usize>| {
                    !is_near(&child.point[place.clone()], &parent.point[place.clone()])
                };
                (0..4).filter(|&wave| is_changed(&takeover.library[wave])).collect()
            };
            let parent = members.iter().min_by_key(|parent| changed(parent).len()).expect("some");
            let Some(&wave) = changed(parent).first() else { continue };
            taken += 1;
            assert_eq!(changed(parent), [wave]);
            assert_eq!(wave, parent.uses.expect("noted").least_used());
            let new = &child.point[takeover.library[wave].clone()];
            let is_donor = |donor: &&GaMember| {
                let most = donor.uses.expect("noted").most_used();
                is_near(new, &donor.point[takeover.library[most].clone()])
            };
            let donor = members[..DONORS].iter().find(is_donor).expect("one of the best four");
            assert_ne!(donor, parent);
        }
        assert!((10..=30).contains(&taken), "{taken} of 98");
    }

    #[test]
    fn without_a_library_or_a_share_nothing_is_taken_over() {
        let gaits = after_one(&plan(ControllerKind::Gait, 1.0));
        assert!(gaits.members().iter().all(|member| member.uses.is_none()));
        let none = after_one(&plan(ControllerKind::Gait, 0.0));
        assert_eq!(gaits.ask(), none.ask());
        let never = after_one(&plan(ControllerKind::Rules, 0.0));
        assert!(never.ask().iter().all(|of| of.parents.ids().count() == 1));
        let always = after_one(&plan(ControllerKind::Rules, 1.0));
        let two = always.ask().iter().filter(|of| of.parents.ids().count() == 2).count();
        assert_eq!(two, 98, "the donor of a wave is a parent, too");
    }

    #[test]
    fn a_resumed_search_takes_over_the_same_waves_and_a_hostile_state_is_refused() {
        let plan = plan(ControllerKind::Rules, 0.5);
        let ga = after_one(&plan);
        let resumed = Ga::resume(&plan, 1, &ga.state()).expect("its own state");
        let genomes = |of: &Ga| of.ask().into_iter().map(|of| of.genome).collect::<Vec<_>>();
        assert_eq!(genomes(&resumed), genomes(&ga));
        let mut members = ga.members().to_vec();
        members[3].uses = Some(WaveUses::new(3));
        let error = Ga::resume_with(&plan, 1, members).expect_err("three waves").to_string();
        assert_eq!(error, "number of wave uses is 3; allowed: 4 to 4");
    }

    #[test]
    fn the_first_parent_is_no_donor() {
        let takeover = WaveTakeover::new(&plan(ControllerKind::Rules, 1.0));
        let member = GaMember { step: 0.1, point: Vec::new(), uses: Some(uses([1, 2, 3, 4])) };
        let unknown = GaMember { uses: None, ..member.clone() };
        let mut rng = stream(1, 1, 1, Purpose::Mutation);
        let mut donors = |members: &[GaMember], first| {
            let mut all: Vec<_> =
                (0..100).map(|_| takeover.donor(members, first, 1.0, &mut rng)).collect();
            all.sort();
            all.dedup();
            all
        };
        let members = vec![member.clone(); 6];
        assert_eq!(donors(&members, 1), [Some(0), Some(2), Some(3)]);
        assert_eq!(donors(&members, 5), [Some(0), Some(1), Some(2), Some(3)]);
        assert_eq!(donors(&[member.clone(), unknown.clone()], 0), [None]);
        assert_eq!(donors(&[unknown, member], 0), [None]);
    }
}
