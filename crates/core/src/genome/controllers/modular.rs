//! A modular network: the same small network at each joint. Each module exchanges messages with the modules of the neighbouring joints.

use serde::{Deserialize, Serialize};

use super::encoding::{
    ControllerEncoding, FREQUENCY_SETTINGS, LengthVisitor, SERVO_SETTINGS, SettingNames,
    TWIST_SETTINGS, widen_weights,
};
use super::layer::Layer;
use super::servo::ServoGenes;
use crate::genome::gene::{GeneRange, Genes, GenomeShape};
use crate::genome::limits::PHASE;
use crate::genome::network_space::MOST_HIDDEN;
use crate::genome::space::GenomeSpace;

/// Names of the inputs of a joint's module.
pub const MODULE_INPUTS: [&str; 18] = [
    "own bend",
    "own bend rate",
    "own twist",
    "bend ahead",
    "bend behind",
    "front touch",
    "front blocked",
    "front pitch",
    "front gap",
    "front step up",
    "rear touch",
    "rear load",
    "rear pitch",
    "place along the body",
    "message from ahead",
    "message from behind",
    "beat, sine",
    "beat, cosine",
];

/// Names of the outputs of a joint's module. The last one exists only if twists have targets.
pub const MODULE_OUTPUTS: [&str; 3] = ["bend target", "message", "twist target"];

/// One small network of tanh neurons for all joints.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModularNetwork {
    /// Number of joints, each with a module.
    pub joints: u32,
    /// Servos that turn the joints to their targets.
    pub servo: ServoGenes,
    /// Frequency of the beat, in Hz.
    pub frequency_hz: f32,
    /// Delay of the beat from each joint to the next, in radians.
    pub lag_rad: f32,
    /// Hidden neurons, whose inputs are [`MODULE_INPUTS`].
    pub hidden: Layer,
    /// Output neurons, whose outputs are [`MODULE_OUTPUTS`].
    pub outputs: Layer,
}

impl ModularNetwork {
    fn outputs_of(servo: &ServoGenes) -> usize {
        if servo.twists() { 3 } else { 2 }
    }
}

impl ControllerEncoding for ModularNetwork {
    fn settings() -> SettingNames {
        &[
            FREQUENCY_SETTINGS,
            SERVO_SETTINGS,
            TWIST_SETTINGS,
            &["network.weight_range", "network.hidden"],
        ]
    }

    fn zeroed(space: &GenomeSpace, shape: GenomeShape) -> Self {
        let (servo, hidden) = (ServoGenes::zeroed(space), space.network.hidden as usize);
        Self {
            joints: shape.joints as u32,
            frequency_hz: 1.0,
            lag_rad: 0.0,
            hidden: Layer::zeroed(hidden, MODULE_INPUTS.len()),
            outputs: Layer::zeroed(Self::outputs_of(&servo), hidden),
            servo,
        }
    }

    fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        self.servo.genes(space, genes);
        space.wave.frequency_gene(&mut self.frequency_hz, genes);
        genes.gene("lag_rad", "lag per joint", PHASE, GeneRange::Turn, &mut self.lag_rad);
        let most = space.network.weight_range;
        let input = |index: usize| MODULE_INPUTS.get(index).copied().unwrap_or("").to_owned();
        self.hidden.genes(["hidden", "hidden"], most, input, genes);
        let hidden = |index: usize| format!("hidden {}", index + 1);
        self.outputs.genes(["outputs", "output"], most, hidden, genes);
    }

    fn lengths(&self, visit: LengthVisitor<'_>) {
        self.hidden.lengths("hidden", 1..=MOST_HIDDEN as usize, MODULE_INPUTS.len(), visit);
        let outputs = Self::outputs_of(&self.servo);
        self.outputs.lengths("outputs", outputs..=outputs, self.hidden.neurons(), visit);
    }

    fn joints(&self) -> usize {
        self.joints as usize
    }

    fn widen(&self, space: &mut GenomeSpace) {
        self.servo.widen(space);
        space.network.hidden = self.hidden.neurons() as u32;
        widen_weights(&mut space.network.weight_range, self);
    }
}
