//! The registry of controllers. The genes of each kind are in a file of their own.
//!
//! A new kind needs a variant of [`ControllerKind`], a line in `registry!` below, and the file that this line names. The code that moves
//! the joints by these genes is registered in [`crate::control`].

mod bit_names;
mod central;
mod ctrnn;
mod decisions;
mod encoding;
mod gait;
mod grown;
mod joint_decisions;
mod layer;
mod limb_neurons;
mod modular;
mod neuron;
mod neuron_choices;
mod neuron_function;
mod part_neurons;
mod recorded;
mod reflex;
mod rules;
mod servo;
mod signal;
mod tanh;
mod targets;
mod wave;
mod wave_rule;

pub use bit_names::{BitNames, bits_in_words, bits_of};
pub use central::{CentralNetwork, sense_count};
pub use ctrnn::{CTRNN_INPUTS, CTRNN_NEURONS, CtrnnGenes, CtrnnNeuron};
pub(crate) use decisions::shared;
pub use decisions::{
    DECISION_DISCOUNT, DECISIONS_PER_S, DecisionGenes, Explorer, POSTURES, Policy, SITUATION_BITS,
    TABLE_QUESTIONS, TABLE_STATES,
};
pub use encoding::JointCommands;
pub use gait::{Gait, Steering};
pub use grown::{GROWN_INPUTS, GrownGenes};
pub use joint_decisions::{JOINT_BENDS, JOINT_BITS, JointDecisionGenes};
pub use layer::Layer;
pub use limb_neurons::{LIMB_NEURONS, LimbNeurons};
pub use modular::{MODULE_INPUTS, MODULE_OUTPUTS, ModularNetwork};
pub use neuron::{LimbNeuron, NEURON_INPUTS, NeuronInput};
pub use neuron_choices::{NEURON_SOURCES, NeuronKind, NeuronSource};
pub use neuron_function::{NeuronFunction, NeuronMoment, NeuronState};
pub use part_neurons::{
    MOST_CREATURE_NEURONS, MOST_PART_NEURONS, NodeNeurons, PartInput, PartNeuron, PartNeurons,
    PartSense, PartSource,
};
pub use recorded::RecordedActions;
pub use reflex::{REFLEX_INPUTS, ReflexGait};
pub use rules::RuleGenes;
pub use servo::ServoGenes;
pub use signal::{JointSignals, TorqueSignals};
pub(crate) use signal::{held_value, point_at};
pub use tanh::tanh_each;
pub use targets::{JointTargets, TargetSignals};
pub use wave::{Harmonic, JointWaves, Wave, Waves};
pub use wave_rule::{JointGroup, RULE_SENSES, WaveRule};

use serde::{Deserialize, Serialize};

use super::gene::{Gene, Genes, GenomeShape, Quantity, check_limits, widen};
use super::kind::ControllerKind;
use super::space::GenomeSpace;
use super::wave_space::{FREQUENCY, SERVO_DAMPING, STIFFNESS};
use crate::check::{Invalid, within};
use encoding::{ControllerEncoding, SettingNames};

/// Generates the enum `ControllerGenes` and its match expressions from one line for each kind.
macro_rules! registry {
    ($($(#[$doc:meta])* $kind:ident($genes:ty),)*) => {
        /// The genes of a controller. Champion files store these fields as they are.
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        pub enum ControllerGenes { $($(#[$doc])* $kind($genes),)* }

        impl ControllerKind {
            fn settings(self) -> SettingNames {
                match self { $(Self::$kind => <$genes>::settings(),)* }
            }

            /// Returns genes that are all zero, in the layout that a space prescribes for a shape.
            pub(super) fn zeroed(self, space: &GenomeSpace, shape: GenomeShape) -> ControllerGenes {
                match self { $(Self::$kind => ControllerGenes::$kind(<$genes>::zeroed(space, shape)),)* }
            }
        }

        impl ControllerGenes {
            /// Returns the kind of the controller.
            pub fn kind(&self) -> ControllerKind {
                match self { $(Self::$kind(_) => ControllerKind::$kind,)* }
            }

            pub(super) fn encoding(&self) -> &dyn ControllerEncoding {
                match self { $(Self::$kind(genes) => genes,)* }
            }

            pub(super) fn encoding_mut(&mut self) -> &mut dyn ControllerEncoding {
                match self { $(Self::$kind(genes) => genes,)* }
            }
        }
    };
}

registry! {
    /// Free torque signals, as in the report: each point has a torque of its own, without a rule.
    Signal(TorqueSignals),
    /// Periodic torques, as waves in N·m.
    Wave(Waves),
    /// Periodic joint angles, followed by a servo.
    Gait(Gait),
    /// Free target angles, followed by a servo.
    Targets(TargetSignals),
    /// A gait whose targets and phases are changed by reflexes.
    Reflex(ReflexGait),
    /// One small network, which is applied at each joint.
    Modular(ModularNetwork),
    /// One network for the whole snake.
    Central(CentralNetwork),
    /// A continuous-time recurrent neural network at each joint.
    Ctrnn(CtrnnGenes),
    /// Learned decisions among a few postures.
    Decisions(DecisionGenes),
    /// Learned decisions of each joint among a few bends.
    JointDecisions(JointDecisionGenes),
    /// Rules that choose among waves.
    Rules(RuleGenes),
    /// A network that grew by mutations.
    Grown(GrownGenes),
    /// Neurons in the limbs.
    LimbNeurons(LimbNeurons),
    /// Neurons in the parts of a branching body.
    PartNeurons(PartNeurons),
}

impl ControllerKind {
    /// Returns whether a setting matters to this kind, given its path below `genome`. A setting that no kind names matters to all.
    pub fn uses(self, setting: &str) -> bool {
        let names = |kind: &Self| kind.settings().iter().any(|group| group.contains(&setting));
        names(&self) || !Self::ALL.iter().any(names)
    }

    /// Returns the paths below `genome` of the settings that matter to other kinds only.
    pub fn unused_settings(self) -> Vec<&'static str> {
        let all = Self::ALL.iter().flat_map(|kind| kind.settings());
        all.copied().flatten().copied().filter(|setting| !self.uses(setting)).collect()
    }
}

impl ControllerGenes {
    /// Returns the number of joints that the controller drives.
    pub fn joints(&self) -> usize {
        self.encoding().joints()
    }

    /// Returns the frequency of the motion, in Hz. A signal has no period. For it, the frequency is half the number of sign changes of its
    /// torques per second, as for a sine.
    pub fn frequency_hz(&self) -> f32 {
        let of_gene = || self.values().into_iter().find(|(quantity, _)| *quantity == FREQUENCY);
        let estimated_hz = self.encoding().estimated_frequency_hz();
        estimated_hz.or_else(|| of_gene().map(|(_, value)| value)).unwrap_or(0.0)
    }

    /// Removes learned data that has no effect on what the snake does, such as rules that no decision needs.
    pub fn compact(&mut self) {
        self.encoding_mut().compact();
    }

    /// Checks every value against the limits of all spaces.
    ///
    /// # Errors
    /// Returns the first value that is not allowed.
    pub fn check(&self) -> Result<(), Invalid> {
        // The values of genes are checked first, because a servo's genes decide how many outputs a network has.
        let check = || {
            check_limits(|genes| self.clone().genes(&GenomeSpace::default(), genes))?;
            let mut lengths = Ok(());
            self.encoding().lengths(&mut |name, length, allowed| {
                if lengths.is_ok() {
                    lengths = within(&name.to_string(), length, allowed);
                }
            });
            lengths.and_then(|()| self.encoding().check_rest())
        };
        check().map_err(|error| error.inside(self.kind().name()))
    }

    /// Widens a space so that it contains these genes, where their ranges are settings.
    pub(super) fn widen(&self, space: &mut GenomeSpace) {
        let wave = &mut space.wave;
        for (quantity, value) in self.values() {
            match quantity {
                FREQUENCY => widen([&mut wave.frequency_min_hz, &mut wave.frequency_max_hz], value),
                STIFFNESS => {
                    let least = &mut wave.stiffness_min_nm_per_rad;
                    widen([least, &mut wave.stiffness_max_nm_per_rad], value);
                }
                SERVO_DAMPING => wave.servo_damping_nms_per_rad = value,
                _ => {}
            }
        }
        self.encoding().widen(space);
    }

    /// Returns the values of all genes, with their quantities.
    fn values(&self) -> Vec<(Quantity, f32)> {
        let mut values = Vec::new();
        let mut add = |gene: Gene<'_>, value: &mut f32| values.push((gene.quantity, *value));
        self.clone().genes(&GenomeSpace::default(), &mut Genes::to(&mut add));
        values
    }

    /// Visits every gene in a fixed order, with its range in `space`.
    pub(super) fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        self.encoding_mut().genes(space, genes);
    }

    /// Returns the commands that the genes alone determine for a trial of this length, in seconds; `None` where they depend on senses.
    pub fn commands(&self, duration_s: f64) -> Option<JointCommands> {
        self.encoding().commands(duration_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learn::classifiers::Condition;

    #[test]
    fn names_in_files_are_those_of_the_registry() {
        for &kind in ControllerKind::ALL {
            assert_eq!(ron::to_string(&kind).expect("written"), kind.name());
            assert_eq!(kind.title().to_lowercase().replace(' ', "_"), kind.name());
        }
    }

    #[test]
    fn lists_of_the_wrong_length_are_refused_with_their_place() {
        let (space, shape) = (GenomeSpace::default(), GenomeShape { joints: 4, duration_s: 2.0 });
        let refusal = |genes: ControllerGenes| genes.check().expect_err("refused").to_string();
        let modular = |change: fn(&mut Layer)| {
            let mut genes = ModularNetwork::zeroed(&space, shape);
            change(&mut genes.hidden);
            refusal(ControllerGenes::Modular(genes))
        };
        let message = modular(|hidden| hidden.rows[1].push(0.0));
        assert_eq!(message, "modular.hidden[1].weights is 20; allowed: 19 to 19");
        let message = modular(|hidden| hidden.rows.clear());
        assert_eq!(message, "modular.hidden.neurons is 0; allowed: 1 to 32");
        let message = modular(|hidden| drop(hidden.rows.pop()));
        assert_eq!(message, "modular.outputs[0].weights is 5; allowed: 4 to 4");
        let limbs = |count| {
            let mut genes = LimbNeurons::zeroed(&space, shape);
            genes.limbs = vec![genes.limbs[0]; count];
            refusal(ControllerGenes::LimbNeurons(genes))
        };
        assert_eq!(limbs(0), "limb_neurons.limbs is 0; allowed: 1 to 5");
        assert_eq!(limbs(3), "limb_neurons.limbs is 3; allowed: 1 or 5");
        let rules = |change: fn(&mut RuleGenes)| {
            let mut genes = RuleGenes::zeroed(&space, shape);
            change(&mut genes);
            refusal(ControllerGenes::Rules(genes))
        };
        let message = rules(|genes| genes.rules.clear());
        assert_eq!(message, "rules.number of rules is 0; allowed: 1 to 64");
        let message = rules(|genes| genes.library.clear());
        assert_eq!(message, "rules.library waves is 0; allowed: 1 to 8");
        let message = rules(|genes| drop(genes.library[2].joints.pop()));
        assert_eq!(message, "rules.library[2].joints is 3; allowed: 4 to 4");
        let message = rules(|genes| genes.library[1].joints[0].bend.harmonics.clear());
        assert_eq!(message, "rules.library[1].joints[0].bend.harmonics is 0; allowed: 1 to 5");
        let message = rules(|genes| genes.rules[2].condition = Condition::any(9));
        assert_eq!(message, "rules.rules[2].condition is 9; allowed: 10 to 10");
        let message = rules(|genes| genes.rules[3].wave = 5);
        assert_eq!(message, "rules.rules[3].wave is 5; allowed: 1 to 4");
    }
}
