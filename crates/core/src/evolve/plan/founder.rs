//! The founder of a run: an individual from which the first generation descends.

use crate::genome::Genome;

/// Maximum length of a founder's name, in characters.
const LONGEST_NAME: usize = 40;

/// An individual from which the first generation of a run descends.
#[derive(Debug, Clone)]
pub struct Founder {
    /// Name that is shown to people, at most `LONGEST_NAME` plain characters. It has no effect on a run.
    name: String,
    /// Genome of the founder.
    pub(super) genome: Genome,
}

impl PartialEq for Founder {
    /// Compares the genomes only, because the name has no effect on a run.
    fn eq(&self, other: &Self) -> bool {
        self.genome == other.genome
    }
}

impl Founder {
    /// Makes a founder. Characters that are not safe in titles and files are removed from the name.
    pub fn new(name: &str, genome: Genome) -> Self {
        let plain = |c: &char| c.is_alphanumeric() || " -_.,".contains(*c);
        let name: String = name.chars().filter(plain).take(LONGEST_NAME).collect();
        let name = name.trim().to_owned();
        Self { name: if name.is_empty() { "a champion".to_owned() } else { name }, genome }
    }

    /// Returns the name that is shown to people.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the genome of the founder.
    pub fn genome(&self) -> &Genome {
        &self.genome
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::{EvolutionSettings, RunPlan, Settings, StrategyKind, begin};
    use crate::genome::ControllerKind;
    use crate::rng::{Purpose, stream};

    fn settings(strategy: StrategyKind, controller: ControllerKind) -> Settings {
        let evolution = EvolutionSettings { strategy, population: 20, ..Default::default() };
        let mut settings = Settings { evolution, ..Default::default() };
        settings.genome.controller = controller;
        settings.trial.duration_s = 1.0;
        settings.suit_to_strategy();
        settings
    }

    fn founder_in(settings: &Settings) -> Genome {
        let mut rng = stream(77, 1, 0, Purpose::Birth);
        settings.genome.random_genome(settings.trial.genome_shape(), &mut rng)
    }

    /// Returns the genomes of the first generation.
    fn first_genomes(plan: &RunPlan) -> Vec<Genome> {
        begin(plan).ask().into_iter().map(|candidate| candidate.genome).collect()
    }

    /// Returns the largest difference between the coordinates of two genomes.
    fn distance(settings: &Settings, a: &Genome, b: &Genome) -> f64 {
        let (a, b) = (settings.genome.point_of(a), settings.genome.point_of(b));
        let off = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        off.map(|off| off.min(1.0 - off)).fold(0.0, f64::max)
    }

    /// Returns whether a genome is a mutant of another. A mutant with neurons in its limbs differs much in few genes.
    fn is_near(settings: &Settings, a: &Genome, b: &Genome) -> bool {
        if settings.genome.controller != ControllerKind::LimbNeurons {
            return distance(settings, a, b) < 0.45;
        }
        let (a, b) = (settings.genome.point_of(a), settings.genome.point_of(b));
        let far = a.iter().zip(&b).filter(|(a, b)| (*a - *b).abs() > 0.3).count();
        far * 4 < a.len()
    }

    #[test]
    fn the_first_individual_is_the_founder_and_others_descend_from_it() {
        for strategy in StrategyKind::ALL {
            for controller in strategy.controllers() {
                let settings = settings(strategy, controller);
                let genome = founder_in(&settings);
                let plan = RunPlan::new("test", 1, settings.clone());
                let random = first_genomes(&plan);
                let founded = plan.starting_from(Founder::new("x", genome.clone())).expect("fits");
                let asked = first_genomes(&founded);
                let what = format!("{strategy}, {controller}");
                match strategy {
                    StrategyKind::Poet => assert_eq!(asked.len(), 4, "no random genomes"),
                    StrategyKind::Mcc => assert_eq!(asked.len(), 30, "no random genomes"),
                    _ => assert_eq!(asked.len(), random.len()),
                }
                if strategy.info().varies_bodies && strategy != StrategyKind::Islands {
                    assert_eq!(asked[0], genome, "{what}");
                    let fresh = asked[1..].iter().filter(|other| random.contains(other)).count();
                    assert_eq!(fresh, asked.len() / 2, "every second one");
                    continue;
                }
                if strategy.info().is_budget_driven {
                    assert_ne!(asked, random, "{what}");
                    continue;
                }
                if strategy == StrategyKind::Neat || strategy == StrategyKind::QLearning {
                    assert!(asked[0] == genome, "{what}");
                }
                if !strategy.info().only_controllers.is_empty() {
                    // All learners have the founder's body; only the networks of NEAT may have other bodies.
                    let is_neat = strategy == StrategyKind::Neat;
                    let is_same = |other: &Genome| is_neat || other.body == genome.body;
                    assert!(asked.iter().all(is_same), "{what}");
                    continue;
                }
                assert_eq!(asked[0], genome, "{what}");
                let near = |other: &&Genome| is_near(&settings, other, &genome);
                let descended = asked[1..].iter().filter(near).count();
                assert!(descended >= 9, "{what}: {descended}");
                let fresh = asked[1..].iter().filter(|other| random.contains(other)).count();
                let all_descend = strategy == StrategyKind::Halving;
                assert_eq!(fresh > 0, !all_descend, "{what}: {fresh} random");
            }
        }
    }

    #[test]
    fn cma_es_begins_at_the_founder() {
        let mut settings = settings(StrategyKind::CmaEs, ControllerKind::Gait);
        settings.evolution.cma_es.step = 1.0e-6;
        settings.evolution.cma_es.newborns = 7;
        let genome = founder_in(&settings);
        let plan = RunPlan::new("test", 1, settings.clone());
        let plan = plan.starting_from(Founder::new("x", genome.clone())).expect("fits");
        let asked = first_genomes(&plan);
        assert_eq!(asked.len(), 20, "no random genomes");
        assert!(asked.iter().all(|other| distance(&settings, other, &genome) < 1.0e-4));
    }

    #[test]
    fn a_founder_that_does_not_fit_is_refused_with_the_reason() {
        let gait = founder_in(&settings(StrategyKind::Ga, ControllerKind::Gait));
        let signals = settings(StrategyKind::Ga, ControllerKind::Signal);
        let plan = RunPlan::new("test", 1, signals);
        let error = plan.starting_from(Founder::new("x", gait)).expect_err("refused").to_string();
        assert_eq!(error, "founder.controller is gait; allowed: signal");
    }

    #[test]
    fn a_name_keeps_only_characters_that_are_safe_in_titles() {
        let genome = founder_in(&settings(StrategyKind::Ga, ControllerKind::Gait));
        for (name, kept) in [
            ("climber", "climber"),
            ("\u{1b}[2Jüber\n\"x\"", "2Jüberx"),
            ("\u{202e}", "a champion"),
            (&"x".repeat(99), &"x".repeat(40)),
        ] {
            assert_eq!(Founder::new(name, genome.clone()).name(), kept);
        }
    }
}
