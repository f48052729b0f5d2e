//! The registry of controllers: the genes of each kind, in a file of their own.
//!
//! A new kind is a variant of [`ControllerKind`], a line in `registry!` below, and the file that it names; what
//! moves the joints by these genes is registered in [`crate::control`].

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
mod reflex;
mod rules;
mod servo;
mod signal;
mod tanh;
mod wave;
mod wave_rule;

pub use central::{CentralNetwork, sense_count};
pub use ctrnn::{CTRNN_INPUTS, CTRNN_NEURONS, CtrnnGenes, CtrnnNeuron};
pub(crate) use decisions::shared;
pub use decisions::{
    DECISION_DISCOUNT, DECISIONS_PER_S, DecisionGenes, Explorer, POSTURES, Policy, SITUATION_BITS,
    TABLE_QUESTIONS, TABLE_STATES,
};
pub use encoding::{ControllerInfo, JointCommands};
pub use gait::Gait;
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
pub use reflex::{REFLEX_INPUTS, ReflexGait};
pub use rules::RuleGenes;
pub use servo::ServoGenes;
pub use signal::{JointSignals, TorqueSignals};
pub use tanh::tanh_each;
pub use wave::{Harmonic, JointWaves, Wave, Waves};
pub use wave_rule::{JointGroup, RULE_SENSES, RuleCondition, WaveRule};

use serde::{Deserialize, Serialize};

use super::gene::GenomeShape;
use super::kind::ControllerKind;
use super::space::GenomeSpace;
use crate::check::Invalid;
use crate::schema::named_by_info;
use encoding::ControllerEncoding;

/// Makes the enum of all kinds of genes from one line for each kind.
macro_rules! registry {
    ($($(#[$doc:meta])* $kind:ident($genes:ty),)*) => {
        /// The genes of a controller. Champion files store them as they stand here.
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        pub enum ControllerGenes { $($(#[$doc])* $kind($genes),)* }

        impl ControllerKind {
            fn info(self) -> &'static ControllerInfo {
                match self { $(Self::$kind => <$genes>::info(),)* }
            }

            /// Genes of zeros, in the layout that a space prescribes for a shape.
            pub(super) fn zeroed(self, space: &GenomeSpace, shape: GenomeShape) -> ControllerGenes {
                match self { $(Self::$kind => ControllerGenes::$kind(<$genes>::zeroed(space, shape)),)* }
            }
        }

        impl ControllerGenes {
            /// Its kind.
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
    /// Free torque signals, the report's: point after point, without a rule.
    Signal(TorqueSignals),
    /// Periodic torques. The waves are in N·m.
    Wave(Waves),
    /// Periodic joint angles, followed by a servo.
    Gait(Gait),
    /// A gait with reflexes.
    Reflex(ReflexGait),
    /// The same small network at each joint.
    Modular(ModularNetwork),
    /// One network for the whole snake.
    Central(CentralNetwork),
    /// A continuous-time recurrent neural network.
    Ctrnn(CtrnnGenes),
    /// Learned decisions among a few postures.
    Decisions(DecisionGenes),
    /// Learned decisions of each joint about its bend.
    JointDecisions(JointDecisionGenes),
    /// Rules that choose among waves.
    Rules(RuleGenes),
    /// A network that grew.
    Grown(GrownGenes),
    /// Neurons in the limbs.
    LimbNeurons(LimbNeurons),
    /// Neurons in the parts of a branching body.
    PartNeurons(PartNeurons),
}

named_by_info!(ControllerKind);

impl ControllerKind {
    /// Whether a setting below `genome`, by its path there, matters to this kind. Settings that no kind names
    /// matter to all.
    pub fn uses(self, setting: &str) -> bool {
        let names = |kind: Self| kind.info().settings.contains(&setting);
        names(self) || !Self::ALL.into_iter().any(names)
    }

    /// The settings below `genome` that matter to other kinds alone, by their paths there.
    pub fn unused_settings(self) -> Vec<&'static str> {
        let all = Self::ALL.into_iter().flat_map(|kind| kind.info().settings);
        all.copied().filter(|setting| !self.uses(setting)).collect()
    }

    /// Whether it senses contacts, attitude and the stairs ahead, beside its joints.
    pub fn senses_surroundings(self) -> bool {
        self.info().senses_surroundings
    }
}

impl ControllerGenes {
    /// Number of joints that it drives.
    pub fn joints(&self) -> usize {
        self.encoding().joints()
    }

    /// Frequency of the motion, in Hz. A signal has no period: half the number of sign changes of its torques
    /// per second, which is the same for a sine.
    pub fn frequency_hz(&self) -> f32 {
        self.encoding().frequency_hz()
    }

    /// Drops what was learned but changes nothing that the snake does: rules that no decision needs.
    pub fn compact(&mut self) {
        self.encoding_mut().compact();
    }

    /// Checks every value against the limits of all spaces.
    ///
    /// # Errors
    /// The first value that is not allowed.
    pub fn check(&self) -> Result<(), Invalid> {
        self.encoding().check()
    }

    /// The commands that the genes alone determine for a trial; none where they depend on senses.
    pub fn commands(&self, duration_s: f64) -> Option<JointCommands> {
        self.encoding().commands(duration_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_in_files_are_those_of_the_registry() {
        for kind in ControllerKind::ALL {
            assert_eq!(ron::to_string(&kind).expect("written"), kind.name());
            assert_eq!(kind.title().to_lowercase().replace(' ', "_"), kind.name());
        }
    }

    #[test]
    fn settings_of_other_kinds_do_not_matter_and_common_ones_do() {
        use ControllerKind::{Gait, Signal, Wave};
        for (setting, users) in [
            ("torque_range_nm", vec![Signal, Wave]),
            ("points_per_s", vec![Signal]),
            ("wave.harmonics", vec![Wave, Gait]),
            ("wave.angle_range_rad", vec![Gait]),
            ("density_min_kg_m3", vec![Signal, Wave, Gait]),
        ] {
            for kind in [Signal, Wave, Gait] {
                assert_eq!(kind.uses(setting), users.contains(&kind), "{setting} of {kind}");
            }
        }
    }
}
