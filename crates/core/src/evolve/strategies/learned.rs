//! Knowledge that all episodes of a run share: a policy for the whole snake, or rules for each joint.

use std::sync::Arc;

use rand_chacha::ChaCha8Rng;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::check::Invalid;
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::{EvolutionSettings, StrategyKind};
use crate::genome::ControllerGenes;
use crate::genome::controllers::{
    Explorer, JointDecisionGenes, POSTURES, Policy, SITUATION_BITS, shared,
};
use crate::learn::Episode;
use crate::learn::classifiers::{Xcs, Zcs};
use crate::rng::{Purpose, stream};

/// Knowledge that is learned from episodes.
pub trait Learned: Clone + Send + Sync + Serialize + DeserializeOwned {
    /// Returns the knowledge at the beginning of a run.
    fn first(plan: &RunPlan) -> Self;

    /// Returns the knowledge in a controller's genes. None if the controller is of another kind.
    fn of(genes: &ControllerGenes) -> Option<Self>;

    /// Checks that the knowledge is what the run's strategy learns, for the run's snakes.
    ///
    /// # Errors
    /// Describes the first difference.
    fn check_fits(&self, plan: &RunPlan) -> Result<(), Invalid>;

    /// Puts the knowledge into a controller's genes, with a way to explore.
    fn give(&self, genes: &mut ControllerGenes, explorer: Option<Explorer>);

    /// Learns from episodes, in their order. Experience of another form than the knowledge, which no controller of the program produces, is
    /// ignored.
    fn learn(
        &mut self,
        episodes: Vec<Episode>,
        evolution: &EvolutionSettings,
        rng: &mut ChaCha8Rng,
    );

    /// Adopts changed settings of the strategy.
    fn apply(&mut self, evolution: &EvolutionSettings);
}

impl Learned for Policy {
    fn first(plan: &RunPlan) -> Self {
        let evolution = &plan.settings.evolution;
        let (bits, actions) = (SITUATION_BITS.len(), POSTURES.len());
        // The ranges of the settings exclude parameters that the learners refuse.
        let policy = match evolution.strategy {
            StrategyKind::Xcs => Xcs::new(evolution.xcs.parameters(), bits, actions)
                .map(|rules| Self::Xcs(Arc::new(rules))),
            StrategyKind::Zcs => {
                let mut rng = stream(plan.seed, 0, 0, Purpose::Learn);
                Zcs::new(evolution.zcs.parameters(), bits, actions, &mut rng)
                    .map(|rules| Self::Zcs(Arc::new(rules)))
            }
            _ => Ok(Self::default()),
        };
        policy.unwrap_or_default()
    }

    fn of(genes: &ControllerGenes) -> Option<Self> {
        match genes {
            ControllerGenes::Decisions(genes) => Some(genes.policy.clone()),
            _ => None,
        }
    }

    fn check_fits(&self, plan: &RunPlan) -> Result<(), Invalid> {
        self.check()?;
        let strategy = plan.settings.evolution.strategy;
        let is_fitting = match self {
            Self::Table(_) => strategy == StrategyKind::QLearning,
            Self::Xcs(_) => strategy == StrategyKind::Xcs,
            Self::Zcs(_) => strategy == StrategyKind::Zcs,
        };
        if is_fitting {
            return Ok(());
        }
        Err(Invalid::new("policy", "that of another strategy", format!("that of {strategy}")))
    }

    fn give(&self, genes: &mut ControllerGenes, explorer: Option<Explorer>) {
        if let ControllerGenes::Decisions(genes) = genes {
            genes.policy = self.clone();
            genes.explorer = explorer;
        }
    }

    fn learn(
        &mut self,
        episodes: Vec<Episode>,
        evolution: &EvolutionSettings,
        rng: &mut ChaCha8Rng,
    ) {
        let (mut transitions, mut decisions) = (Vec::new(), Vec::new());
        for episode in episodes {
            match episode {
                Episode::Table(of_one) => transitions.push(of_one),
                Episode::Rules(of_one, end) => decisions.push((of_one, end)),
                Episode::Joints(_) => {}
            }
        }
        match self {
            Self::Table(table) => {
                let trace = evolution.q_learning.trace;
                let rule = evolution.q_learning.rule();
                Arc::make_mut(table).learn_returns(&transitions, &rule, trace);
            }
            Self::Xcs(rules) => {
                let (rules, trace) = (Arc::make_mut(rules), evolution.xcs.trace);
                for (decisions, end) in &decisions {
                    let _ = rules.learn_returns(decisions, *end, trace, false, rng);
                }
            }
            Self::Zcs(rules) => {
                let (rules, trace) = (Arc::make_mut(rules), evolution.zcs.trace);
                for (decisions, end) in &decisions {
                    let _ = rules.learn_returns(decisions, *end, trace, rng);
                }
            }
        }
    }

    fn apply(&mut self, evolution: &EvolutionSettings) {
        // The ranges of the settings exclude parameters that the learners refuse.
        match self {
            Self::Table(_) => {}
            Self::Xcs(rules) => {
                let _ = Arc::make_mut(rules).set_settings(evolution.xcs.parameters());
            }
            Self::Zcs(rules) => {
                let _ = Arc::make_mut(rules).set_settings(evolution.zcs.parameters());
            }
        }
    }
}

/// The XCS rules of each joint.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(transparent)]
pub struct JointSystems(#[serde(with = "shared")] Arc<Vec<Xcs>>);

impl Learned for JointSystems {
    fn first(plan: &RunPlan) -> Self {
        let joints = plan.settings.trial.agent.joints();
        let parameters = plan.settings.evolution.xcs.of_each(joints);
        // The ranges of the settings exclude parameters that the learners refuse.
        let systems = JointDecisionGenes::empty_systems(&parameters, joints);
        Self(Arc::new(systems.unwrap_or_default()))
    }

    fn of(genes: &ControllerGenes) -> Option<Self> {
        match genes {
            ControllerGenes::JointDecisions(genes) => Some(Self(Arc::clone(&genes.systems))),
            _ => None,
        }
    }

    fn check_fits(&self, plan: &RunPlan) -> Result<(), Invalid> {
        JointDecisionGenes::check_systems(&self.0, plan.settings.trial.agent.joints())
    }

    fn give(&self, genes: &mut ControllerGenes, explorer: Option<Explorer>) {
        if let ControllerGenes::JointDecisions(genes) = genes {
            genes.systems = Arc::clone(&self.0);
            genes.explorer = explorer;
        }
    }

    fn learn(
        &mut self,
        episodes: Vec<Episode>,
        evolution: &EvolutionSettings,
        rng: &mut ChaCha8Rng,
    ) {
        let systems = Arc::make_mut(&mut self.0);
        for episode in episodes {
            let Episode::Joints(of_joints) = episode else { continue };
            for (system, (decisions, end)) in systems.iter_mut().zip(of_joints) {
                // The argument `true`: a joint may keep its bend, as it does in most decisions.
                let _ = system.learn_returns(&decisions, end, evolution.xcs.trace, true, rng);
            }
        }
    }

    fn apply(&mut self, evolution: &EvolutionSettings) {
        let parameters = evolution.xcs.of_each(self.0.len());
        for system in Arc::make_mut(&mut self.0) {
            let _ = system.set_settings(parameters.clone());
        }
    }
}
