//! Which strategies go with which controllers.
//!
//! Most strategies evolve the genes of any controller. A learner improves a policy instead, and a search of structure
//! needs genomes that grow: each of these goes with certain kinds of controllers, and these kinds with nothing else.

use super::{Settings, StrategyKind};
use crate::check::Invalid;
use crate::genome::ControllerKind;
use crate::schema::Choices;

impl StrategyKind {
    /// Whether the strategy can improve controllers of this kind.
    pub fn improves(self, controller: ControllerKind) -> bool {
        let is_partner = |kind: Self| kind.info().only_controllers.contains(&controller);
        is_partner(self)
            || self.info().only_controllers.is_empty() && !Self::ALL.into_iter().any(is_partner)
    }

    /// The kinds of controllers that the strategy can improve.
    pub fn controllers(self) -> impl Iterator<Item = ControllerKind> {
        ControllerKind::OPTIONS.iter().copied().filter(move |kind| self.improves(*kind))
    }
}

impl Settings {
    /// The change of strategy or controller that a change of the other calls for, as field and text: without it they would
    /// not go together. None if they do, or if the field is another one.
    pub fn partner_change(&self, field: &str, text: &str) -> Option<(&'static str, &'static str)> {
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
