//! Checks of settings that depend on whether bodies evolve.

use super::{Settings, StrategyKind};
use crate::check::Invalid;
use crate::score::Fitness;
use crate::world::{SOFTEST_M4_S2, modulus_at_pa};

/// Length of the landing in addition to the longest body, in metres.
const LANDING_ROOM_M: f32 = 2.0;

impl Settings {
    /// Checks that strategy, controller and trial are compatible with evolving bodies, or with a given body if bodies do not evolve.
    pub(super) fn check_bodies(&self) -> Result<(), Invalid> {
        let (strategy, varies) = (self.evolution.strategy, self.genome.bodies.vary);
        if strategy.info().varies_bodies != varies {
            let names = StrategyKind::ALL.into_iter();
            let fitting: Vec<&str> = names
                .filter(|kind| kind.info().varies_bodies == varies)
                .map(StrategyKind::name)
                .collect();
            let state =
                if varies { "while bodies evolve" } else { "unless genome.bodies.vary is true" };
            let allowed = format!("{} {state}", fitting.join(", "));
            return Err(Invalid::new("evolution.strategy", strategy, allowed));
        }
        if !varies {
            let agent = &self.trial.agent;
            return agent
                .check_softness(self.genome.density_max_kg_m3)
                .map_err(|error| error.inside("trial.agent"));
        }
        if self.genome.has_creatures() && self.genome.bodies.soft {
            let allowed =
                "false with genome.controller part_neurons: the parts of creatures are rigid";
            return Err(Invalid::new("genome.bodies.soft", true, allowed));
        }
        self.trial.check_own_bodies().map_err(|error| error.inside("trial"))?;
        if self.genome.bodies.soft {
            let sides_m = [self.genome.bodies.thickness_min_m; 2];
            let least_pa = modulus_at_pa(SOFTEST_M4_S2, sides_m, self.genome.density_max_kg_m3);
            if self.genome.bodies.modulus_max_pa < least_pa {
                let (field, found) =
                    ("genome.bodies.modulus_max_pa", self.genome.bodies.modulus_max_pa);
                let allowed =
                    format!("{:.0} or more, which the thinnest blocks need", least_pa.ceil());
                return Err(Invalid::new(field, found, allowed));
            }
        }
        // On a shorter landing the longest body could not arrive as a whole.
        let least_m = self.genome.bodies.longest_m + LANDING_ROOM_M;
        if self.trial.fitness == Fitness::Share && self.trial.stairs.landing_m < least_m {
            let (field, found) = ("trial.stairs.landing_m", self.trial.stairs.landing_m);
            let allowed = format!("{least_m} or more, for the longest body");
            return Err(Invalid::new(field, found, allowed));
        }
        Ok(())
    }

    /// Lets bodies evolve if the strategy varies bodies, and makes the search small enough for a test.
    pub fn suit_to_strategy(&mut self) {
        self.genome.bodies.vary = self.evolution.strategy.info().varies_bodies;
        self.genome.bodies.limbs_max = 3;
        self.evolution.islands.candidates = 4;
        if !self.genome.bodies.vary {
            self.genome.bodies = Default::default();
            self.evolution.islands = Default::default();
        }
        if self.evolution.strategy.info().evolves_stairs {
            self.trial.fitness = Fitness::Share;
            let poet = &mut self.evolution.poet;
            (poet.pair_candidates, poet.learn_generations, poet.transfers) = (4, 1, 1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::with_fields;
    use crate::genome::ControllerKind;

    #[test]
    fn what_does_not_go_with_evolving_bodies_is_refused_before_a_run() {
        let mut settings = Settings::default();
        settings.genome.bodies.vary = true;
        let said = |settings: &Settings| settings.check().expect_err("refused").to_string();
        let error = said(&settings);
        assert!(error.starts_with("evolution.strategy is halving; allowed: "), "{error}");
        assert!(error.ends_with(" while bodies evolve"), "{error}");
        settings.evolution.strategy = StrategyKind::BodyGa;
        let expected =
            "genome.controller is signal; allowed: wave, gait with evolution.strategy body_ga";
        assert_eq!(said(&settings), expected);
        settings.genome.controller = ControllerKind::Gait;
        settings.trial.stairs.landing_m = 13.0;
        settings.check().expect("allowed");
        for (field, value, expected) in [
            (
                "max_bend_torque_nm",
                "[1, 2, 3, 4]",
                "a list of 4; allowed: one value while bodies evolve",
            ),
            ("surface.soft_cfm_m_s_per_n", "0.001", "0.001; allowed: 0 while bodies evolve"),
            ("skin.soft_cfm_m_s_per_n", "0.001", "0.001; allowed: 0 while bodies evolve"),
            ("joint_cfm_m_s_per_n", "0.001", "0.001; allowed: 0 while bodies evolve"),
            (
                "trial.fitness",
                "share",
                "landing_m is 13; allowed: 14 or more, for the longest body",
            ),
        ] {
            let error = with_fields(&settings, [(field, value)]).expect_err("refused").to_string();
            assert!(error.ends_with(expected), "{error}");
        }
        settings.evolution.strategy = StrategyKind::Islands;
        settings.evolution.generations = 1;
        settings.evolution.population = 131;
        let error = said(&settings);
        assert_eq!(
            error,
            "evolution.generations is 1; allowed: at least 2 at this population: one generation of islands has 132 evaluations"
        );
        settings.evolution.population = 132;
        settings.check().expect("allowed");
        settings.genome.bodies.vary = false;
        let error = said(&settings);
        assert!(error.ends_with(" unless genome.bodies.vary is true"), "{error}");
    }

    #[test]
    fn a_limb_that_is_too_soft_is_named() {
        let error = |modulus: &str| {
            let changes = [("agent.density_kg_m3", "9"), ("youngs_modulus_pa", modulus)];
            with_fields(&Settings::default(), changes).expect_err("too soft").to_string()
        };
        let of_list = error("[40000, 50, 40000, 40000, 40000]");
        assert!(of_list.starts_with("trial.agent.youngs_modulus_pa[1] is 50;"), "{of_list}");
        let of_all = error("60");
        assert!(of_all.starts_with("trial.agent.youngs_modulus_pa is 60;"), "{of_all}");
    }
}
