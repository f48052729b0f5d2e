//! The families: with which settings each is trained, and what is demanded of it.

use super::demand::Demand;
use super::measure::Measure;
use crate::run::compare::PlannedRun;
use snakes_core::check::Invalid;
use snakes_core::evolve::{RunPlan, Settings, with_fields};
use snakes_core::schema::{Choices, choices};
use snakes_core::score::ExamSuite;

choices! {
    /// A family: a controller with the method that trains it, on the stairs of the default world or on mixed ones.
    #[derive(PartialOrd, Ord)]
    pub enum Family {
        Gait = "gait", "Gait", "A gait without senses, by CMA-ES: what the others are compared with.";
        Reflex = "reflex", "Reflex", "A gait with reflexes, by CMA-ES.";
        Modular = "modular", "Modular", "The same small network in each joint, by CMA-ES.";
        Ctrnn = "ctrnn", "CTRNN", "Neurons with time constants in each joint, by CMA-ES.";
        Central = "central", "Central", "One network for all joints, by CMA-ES.";
        Neat = "neat", "NEAT", "Networks that grow.";
        QLearning = "q-learning", "Q-learning", "A table of what each posture is worth in each situation.";
        Xcs = "xcs", "XCS", "Rules that are kept for the accuracy of their predictions.";
        Zcs = "zcs", "ZCS", "Rules that are kept for their strength.";
        Rules = "rules", "Waves by rules", "Rules that choose among waves, by a genetic algorithm.";
        LimbNeurons = "limb-neurons", "Limb neurons", "Neurons in each limb, by a genetic algorithm.";
        JointXcs = "xcs-per-joint", "XCS per joint", "Rules of each joint, this project's own variant of XCS.";
        MixedGait = "mixed-gait", "Gait, mixed stairs", "The gait, on four other staircases in each generation.";
        MixedReflex = "mixed-reflex", "Reflex, mixed stairs", "The reflex gait, on four other staircases in each generation.";
        MixedModular = "mixed-modular", "Modular, mixed stairs", "The modular network, on four other staircases in each generation.";
        MixedLimbNeurons = "mixed-limb-neurons", "Limb neurons, mixed stairs", "Neurons in each limb, on four other staircases in each generation.";
        MixedRules = "mixed-rules", "Waves by rules, mixed stairs", "Rules that choose among waves, on four other staircases in each generation.";
    }
}

/// The stairs that a family is trained on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Training {
    /// Those of the default world. The exam examines the best champion of all seeds.
    Standard,
    /// Several staircases in each generation, others in the next. The exam examines the champion of every seed.
    Mixed,
}

/// A row of the list of families.
#[derive(Debug, Clone, Copy)]
pub struct FamilyInfo {
    /// Name of the preset with its world, its method and their settings.
    pub preset: &'static str,
    /// Changes of the preset's settings.
    pub changes: &'static [(&'static str, &'static str)],
    /// The stairs.
    pub training: Training,
    /// Whether a run ends with the generation that first lands, because nothing else is asked of it.
    pub stops_at_landing: bool,
    /// What is demanded of it; nothing of a family that is only reported.
    pub demands: &'static [Demand],
}

/// The suites of the exam unless others are named.
pub const DEFAULT_SUITES: [ExamSuite; 5] = [
    ExamSuite::StepRate,
    ExamSuite::Stairs,
    ExamSuite::Surprise,
    ExamSuite::Shove,
    ExamSuite::Lesion,
];

impl FamilyInfo {
    const STANDARD: Self = Self {
        preset: "climb",
        changes: &[],
        training: Training::Standard,
        stops_at_landing: false,
        demands: &[],
    };
    const MIXED: Self = Self { preset: "senses", training: Training::Mixed, ..Self::STANDARD };
    /// Of a family whose question is how soon it lands.
    const SOON: Self = Self {
        stops_at_landing: true,
        demands: &[
            Demand { measure: Measure::Landings, must: Some(10.0), hard: None },
            Demand { measure: Measure::FirstLanding, must: None, hard: Some(700.0) },
        ],
        ..Self::STANDARD
    };
    /// Demands on waves that rules choose.
    const SEVERAL_WAVES: Demand =
        Demand { measure: Measure::SeveralWaves, must: Some(7.0), hard: None };
    const BETTER_THAN_GAIT: Demand =
        Demand { measure: Measure::AboveGait(ExamSuite::Stairs), must: None, hard: Some(10.0) };
    /// Demands on a family that senses its stairs and was trained on mixed ones.
    const SENSING: &'static [Demand] = &[
        Demand { measure: Measure::Exam(ExamSuite::Stairs), must: Some(60.0), hard: Some(80.0) },
        Demand {
            measure: Measure::AboveGait(ExamSuite::Stairs),
            must: Some(10.0),
            hard: Some(20.0),
        },
        Demand { measure: Measure::SignTest(ExamSuite::Stairs), must: None, hard: Some(0.01) },
        Demand { measure: Measure::AboveGait(ExamSuite::Shove), must: Some(10.0), hard: None },
        Demand { measure: Measure::Exam(ExamSuite::Shove), must: None, hard: Some(80.0) },
        Demand { measure: Measure::LostWithoutSenses, must: Some(20.0), hard: Some(40.0) },
    ];
}

impl Family {
    /// Its row of the list.
    pub const fn info(self) -> FamilyInfo {
        let (standard, mixed, soon) = (FamilyInfo::STANDARD, FamilyInfo::MIXED, FamilyInfo::SOON);
        match self {
            Self::Gait => standard,
            Self::Reflex => FamilyInfo { changes: &[("genome.controller", "reflex")], ..soon },
            Self::Modular => FamilyInfo { changes: &[("genome.controller", "modular")], ..soon },
            Self::Ctrnn => FamilyInfo {
                changes: &[("genome.controller", "ctrnn")],
                demands: &[
                    Demand { measure: Measure::Landings, must: Some(5.0), hard: None },
                    Demand {
                        measure: Measure::Exam(ExamSuite::Shove),
                        must: None,
                        hard: Some(80.0),
                    },
                ],
                ..standard
            },
            Self::Central => {
                FamilyInfo { changes: &[("genome.controller", "central")], ..standard }
            }
            Self::Neat => FamilyInfo { preset: "neat", ..standard },
            Self::QLearning => FamilyInfo {
                preset: "q-learning",
                demands: &[
                    Demand { measure: Measure::Steps, must: Some(4.0), hard: None },
                    Demand { measure: Measure::Landings, must: None, hard: Some(6.0) },
                ],
                ..standard
            },
            Self::Xcs => FamilyInfo {
                preset: "xcs",
                demands: &[
                    Demand { measure: Measure::Steps, must: Some(4.0), hard: None },
                    Demand { measure: Measure::Rules, must: Some(300.0), hard: None },
                    Demand { measure: Measure::DecisionsOfTwenty, must: Some(80.0), hard: None },
                    Demand { measure: Measure::Landings, must: None, hard: Some(5.0) },
                ],
                ..standard
            },
            Self::Zcs => FamilyInfo {
                preset: "zcs",
                demands: &[Demand { measure: Measure::Steps, must: Some(2.0), hard: Some(4.0) }],
                ..standard
            },
            Self::Rules => FamilyInfo {
                preset: "waves-by-rules",
                demands: &[
                    Demand { measure: Measure::Landings, must: Some(5.0), hard: None },
                    FamilyInfo::SEVERAL_WAVES,
                    FamilyInfo::BETTER_THAN_GAIT,
                ],
                ..standard
            },
            Self::LimbNeurons => FamilyInfo {
                preset: "limb-neurons",
                demands: &[
                    Demand { measure: Measure::Steps, must: Some(5.0), hard: None },
                    Demand { measure: Measure::Landings, must: None, hard: Some(5.0) },
                ],
                ..standard
            },
            Self::JointXcs => FamilyInfo {
                preset: "xcs",
                // Four systems share the rules.
                changes: &[("genome.controller", "joint_decisions"), ("xcs.rules", "2400")],
                ..standard
            },
            Self::MixedGait => FamilyInfo { changes: &[("genome.controller", "gait")], ..mixed },
            Self::MixedReflex => FamilyInfo {
                changes: &[("genome.controller", "reflex")],
                demands: FamilyInfo::SENSING,
                ..mixed
            },
            Self::MixedModular => FamilyInfo {
                changes: &[("genome.controller", "modular")],
                demands: FamilyInfo::SENSING,
                ..mixed
            },
            Self::MixedLimbNeurons => {
                FamilyInfo { preset: "mixed-stairs", demands: FamilyInfo::SENSING, ..mixed }
            }
            Self::MixedRules => FamilyInfo {
                preset: "mixed-stairs",
                changes: &[("genome.controller", "rules")],
                demands: &[
                    FamilyInfo::SEVERAL_WAVES,
                    FamilyInfo::BETTER_THAN_GAIT,
                    Demand { measure: Measure::LostWithoutSenses, must: Some(20.0), hard: None },
                ],
                ..mixed
            },
        }
    }

    /// The name in flags and files; flags may write _ for -.
    pub fn name(self) -> &'static str {
        self.choice().name
    }

    /// The gait that was trained on the same stairs, with which it is compared.
    pub fn gait(self) -> Self {
        match self.info().training {
            Training::Standard => Self::Gait,
            Training::Mixed => Self::MixedGait,
        }
    }

    /// The plan of a run with this budget, from the settings of its preset: in the long trials of the exam, or in trials of
    /// `duration_s` if it is given.
    ///
    /// # Errors
    /// The budget is too small for one generation, or the settings do not fit together.
    pub fn plan(
        self,
        preset: &Settings,
        seed: u64,
        evaluations: u32,
        duration_s: Option<f32>,
    ) -> Result<RunPlan, Invalid> {
        let info = self.info();
        let mut settings = with_fields(preset, info.changes.iter().copied())?;
        settings.trial = ExamSuite::Stairs.undisturbed(&settings.trial).trial;
        settings.trial.duration_s = duration_s.unwrap_or(settings.trial.duration_s);
        let (strategy, controller) = (settings.evolution.strategy, settings.genome.controller);
        PlannedRun { strategy, controller, seed }.plan(info.preset, &settings, evaluations)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::families::PlannedFamilyRun;
    use snakes_core::save::load_preset;

    #[test]
    fn every_family_has_a_plan_in_trials_of_the_exams_length() {
        let mut protocols = Vec::new();
        for family in Family::OPTIONS.iter().copied() {
            let info = family.info();
            let preset = load_preset(info.preset).expect("shipped").settings;
            let plan = family.plan(&preset, 201, 6000, None).expect("allowed");
            let evolution = &plan.settings.evolution;
            assert!(evolution.strategy.improves(plan.settings.genome.controller), "{family:?}");
            assert_eq!(plan.settings.trial.duration_s, 30.0);
            let repeats = &plan.settings.trial.repeats;
            assert_eq!(repeats.trials > 1, info.training == Training::Mixed, "{family:?}");
            assert!((5900..=6000).contains(&plan.budget()), "{family:?}: {}", plan.budget());
            protocols.push(PlannedFamilyRun { family, plan }.protocol());
            let short = family.plan(&preset, 1, 6000, Some(1.0)).expect("allowed");
            assert_eq!(short.settings.trial.duration_s, 1.0);
            assert!(family.plan(&preset, 1, 3, None).is_err(), "{family:?}");
        }
        // No two families make the same runs.
        for (index, protocol) in protocols.iter().enumerate() {
            let twin = protocols[..index].iter().find(|other| other.settings == protocol.settings);
            assert_eq!(twin, None, "{protocol:?}");
        }
    }

    #[test]
    fn the_names_are_those_of_files_and_every_demand_demands_something() {
        for family in Family::OPTIONS {
            snakes_core::check::name("family", family.name()).expect("plain");
            let is_one = |demand: &Demand| demand.must.or(demand.hard).is_some();
            assert!(family.info().demands.iter().all(is_one), "{family:?}");
        }
    }
}
