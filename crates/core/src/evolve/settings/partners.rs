//! Compatibility of strategies with controllers, evolving bodies and ladders.
//!
//! Most strategies evolve the genes of any controller. A learner improves a policy instead, and a search of structure needs genomes that
//! grow: each works only with certain kinds of controllers, and these kinds work with no other strategies.

use super::{Settings, StrategyKind};
use crate::check::Invalid;
use crate::genome::ControllerKind;
use crate::schema::Choices;
use crate::score::{Fitness, StairsVariation};

impl StrategyKind {
    /// Returns whether the strategy can improve controllers of the kind `controller`.
    pub fn improves(self, controller: ControllerKind) -> bool {
        let of_chains = self.info().varies_bodies && self.info().only_controllers.is_empty();
        if of_chains && !BODY_CONTROLLERS.contains(&controller) {
            return false;
        }
        let is_partner = |kind: Self| kind.info().only_controllers.contains(&controller);
        is_partner(self)
            || self.info().only_controllers.is_empty() && !Self::ALL.into_iter().any(is_partner)
    }

    /// Returns whether the strategy compares only snakes of one generation, which have equal stairs on a ladder.
    pub fn climbs_ladders(self) -> bool {
        matches!(self, Self::CmaEs | Self::Ga)
    }

    /// Returns the kinds of controllers that the strategy can improve.
    pub fn controllers(self) -> impl Iterator<Item = ControllerKind> {
        ControllerKind::OPTIONS.iter().copied().filter(move |kind| self.improves(*kind))
    }
}

/// Controllers whose waves pass along a chain with any number of blocks.
const BODY_CONTROLLERS: [ControllerKind; 2] = [ControllerKind::Wave, ControllerKind::Gait];

impl Settings {
    /// Returns the further changes that keep the settings compatible after the change of `field` to `text`: of strategy, controller,
    /// evolution of bodies and repeated trials, as fields and texts. Empty if no further change is necessary.
    pub fn partner_changes(&self, field: &str, text: &str) -> Vec<(&'static str, &'static str)> {
        let mut changes: Vec<_> = self.partner_change(field, text).into_iter().collect();
        if field == "genome.bodies.vary" {
            let varies = text == "true";
            if varies != self.evolution.strategy.info().varies_bodies {
                let strategy = if varies { StrategyKind::Islands } else { StrategyKind::CmaEs };
                changes.push(("evolution.strategy", strategy.name()));
                if !strategy.improves(self.genome.controller) {
                    changes.push(("genome.controller", ControllerKind::Gait.name()));
                }
            }
            return changes;
        }
        let named = |text: &str| StrategyKind::named("evolution.strategy", text).ok();
        let partner = changes.iter().find(|(field, _)| *field == "evolution.strategy");
        let strategy = if field == "evolution.strategy" { named(text) } else { None };
        if let Some(strategy) = strategy.or_else(|| partner.and_then(|(_, text)| named(text))) {
            if strategy.info().evolves_stairs {
                let repeats = &self.trial.repeats;
                for (field, text, is_set) in [
                    ("trial.fitness", Fitness::Share.name(), self.trial.fitness == Fitness::Share),
                    ("trial.repeats.trials", "1", repeats.trials == 1),
                    ("trial.repeats.off.stairs", "own", repeats.off.stairs == StairsVariation::Own),
                ] {
                    if !is_set {
                        changes.push((field, text));
                    }
                }
            }
            let varies = strategy.info().varies_bodies;
            if varies != self.genome.bodies.vary {
                changes.push(("genome.bodies.vary", if varies { "true" } else { "false" }));
            }
        }
        changes
    }

    /// Changes the strategy if it is incompatible with the space of genomes, which may have been widened for a champion with another kind
    /// of body.
    pub fn suit_strategy_to_bodies(&mut self) {
        let varies = self.genome.bodies.vary;
        if self.evolution.strategy.info().varies_bodies != varies {
            self.evolution.strategy =
                if varies { StrategyKind::BodyGa } else { StrategyKind::CmaEs };
        }
        if self.genome.has_creatures() {
            self.evolution.strategy = StrategyKind::CreatureGa;
        }
    }

    fn partner_change(&self, field: &str, text: &str) -> Option<(&'static str, &'static str)> {
        match field {
            "evolution.strategy" => {
                let strategy = StrategyKind::named(field, text).ok()?;
                let fits = |kind: &ControllerKind| strategy.improves(*kind);
                let usual = Some(ControllerKind::Gait).filter(fits);
                let partner = || usual.or_else(|| strategy.controllers().next());
                let partner = (!fits(&self.genome.controller)).then(partner).flatten()?;
                Some(("genome.controller", partner.name()))
            }
            "genome.controller" => {
                let controller = ControllerKind::named(field, text).ok()?;
                let fits = |kind: &StrategyKind| kind.improves(controller);
                let usual = Some(StrategyKind::CmaEs).filter(fits);
                let partner = || usual.or_else(|| StrategyKind::ALL.into_iter().find(fits));
                let partner = (!fits(&self.evolution.strategy)).then(partner).flatten()?;
                Some(("evolution.strategy", partner.name()))
            }
            _ => None,
        }
    }

    /// Checks that snakes can be compared between stairs, if stairs evolve. The strategy adds perturbed trials itself.
    pub(super) fn check_trials_of_stairs(&self) -> Result<(), Invalid> {
        let (strategy, fitness) = (self.evolution.strategy, self.trial.fitness);
        if !strategy.info().evolves_stairs {
            return Ok(());
        }
        let repeats = &self.trial.repeats;
        let with = format!("with evolution.strategy {strategy}");
        if repeats.trials != 1 {
            let allowed = match strategy {
                StrategyKind::Mcc => format!("1 {with}, whose criterion is met in one trial"),
                _ => format!("1 {with}, which adds evolution.poet.perturbed trials itself"),
            };
            return Err(Invalid::new("trial.repeats.trials", repeats.trials, allowed));
        }
        if repeats.off.stairs != StairsVariation::Own {
            let allowed = format!("own {with}, whose snakes are measured on their own stairs");
            let name = repeats.off.stairs.choice().name;
            return Err(Invalid::new("trial.repeats.off.stairs", name, allowed));
        }
        if fitness == Fitness::Share {
            return Ok(());
        }
        let allowed = format!("share {with}, whose stairs have different lengths");
        Err(Invalid::new("trial.fitness", fitness, allowed))
    }

    /// Checks that the strategy can improve the controller.
    pub(super) fn check_partners(&self) -> Result<(), Invalid> {
        let (strategy, controller) = (self.evolution.strategy, self.genome.controller);
        if strategy.improves(controller) {
            return Ok(());
        }
        let names: Vec<&str> = strategy.controllers().map(|kind| kind.name()).collect();
        let allowed = format!("{} with evolution.strategy {strategy}", names.join(", "));
        Err(Invalid::new("genome.controller", controller, allowed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::with_fields;

    #[test]
    fn every_kind_of_controller_has_a_strategy_and_every_strategy_a_controller() {
        for controller in ControllerKind::OPTIONS {
            let strategies =
                StrategyKind::ALL.into_iter().filter(|kind| kind.improves(*controller));
            assert!(strategies.count() > 0, "{controller}");
        }
        for strategy in StrategyKind::ALL {
            assert!(strategy.controllers().count() > 0, "{strategy}");
        }
    }

    #[test]
    fn a_choice_brings_its_partner() {
        let mut settings = Settings::default();
        settings.genome.controller = ControllerKind::Gait;
        settings.evolution.strategy = StrategyKind::Ga;
        let partner = |settings: &Settings, field, text| settings.partner_change(field, text);
        let (strategy, controller) = ("evolution.strategy", "genome.controller");
        assert_eq!(partner(&settings, strategy, "xcs"), Some((controller, "decisions")));
        assert_eq!(partner(&settings, strategy, "neat"), Some((controller, "grown")));
        assert_eq!(partner(&settings, strategy, "novelty"), None);
        let all = |settings: &Settings, field, text| settings.partner_changes(field, text);
        let vary = "genome.bodies.vary";
        assert_eq!(all(&settings, strategy, "islands"), [(vary, "true")]);
        assert_eq!(all(&settings, strategy, "poet"), [("trial.fitness", "share")]);
        assert_eq!(all(&settings, vary, "true"), [(strategy, "islands")]);
        let bodies = with_fields(&settings, [(vary, "true"), (strategy, "body_ga")]);
        let bodies = bodies.expect("they go together");
        assert_eq!(all(&bodies, strategy, "islands"), []);
        assert_eq!(all(&bodies, strategy, "ga"), [(vary, "false")]);
        assert_eq!(all(&bodies, vary, "false"), [(strategy, "cma_es")]);
        let mut suited = bodies.clone();
        suited.suit_strategy_to_bodies();
        assert_eq!(suited, bodies, "they go together already");
        suited.genome.bodies.vary = false;
        suited.suit_strategy_to_bodies();
        assert_eq!(suited.evolution.strategy, StrategyKind::CmaEs);
        let sensing = [(strategy, "cma_es"), (vary, "false")];
        assert_eq!(all(&bodies, controller, "modular"), sensing);
        assert_eq!(partner(&settings, controller, "decisions"), Some((strategy, "q_learning")));
        assert_eq!(partner(&settings, controller, "reflex"), None);
        assert_eq!(partner(&settings, "trial.duration_s", "3"), None);
        settings.genome.controller = ControllerKind::Decisions;
        settings.evolution.strategy = StrategyKind::Zcs;
        assert_eq!(partner(&settings, strategy, "ga"), Some((controller, "gait")));
        assert_eq!(partner(&settings, strategy, "xcs"), None);
        assert_eq!(partner(&settings, controller, "gait"), Some((strategy, "cma_es")));
    }

    #[test]
    fn stairs_that_evolve_need_a_share_as_fitness_and_one_trial_on_the_own_stairs() {
        let mut settings = Settings::default();
        settings.evolution.strategy = StrategyKind::Poet;
        settings.genome.controller = ControllerKind::Gait;
        let refused = |settings: &Settings| settings.check().expect_err("refused").to_string();
        assert!(refused(&settings).starts_with("trial.fitness is centre; allowed: share with"));
        settings.trial.fitness = Fitness::Share;
        settings.check().expect("allowed");
        settings.trial.repeats.trials = 2;
        assert!(refused(&settings).starts_with("trial.repeats.trials is 2; allowed: 1 with"));
        settings.trial.repeats.trials = 1;
        settings.trial.repeats.off.stairs = StairsVariation::Drawn;
        assert!(refused(&settings).starts_with("trial.repeats.off.stairs is drawn; allowed: own"));
    }

    #[test]
    fn a_strategy_that_cannot_improve_the_controller_is_refused() {
        let mut settings = Settings::default();
        settings.evolution.strategy = StrategyKind::QLearning;
        let error = settings.check().expect_err("refused").to_string();
        let expected =
            "genome.controller is signal; allowed: decisions with evolution.strategy q_learning";
        assert_eq!(error, expected);
        settings.genome.controller = ControllerKind::Decisions;
        settings.check().expect("allowed");
        settings.evolution.strategy = StrategyKind::Ga;
        assert!(settings.check().is_err());
    }
}
