//! A central network: all senses are inputs of a few hidden neurons, and these drive all joints.

use serde::{Deserialize, Serialize};

use super::encoding::{
    ControllerEncoding, FREQUENCY_SETTINGS, LengthVisitor, SERVO_SETTINGS, SettingNames,
    TWIST_SETTINGS, widen_weights,
};
use super::layer::Layer;
use super::servo::ServoGenes;
use crate::genome::gene::{Genes, GenomeShape};
use crate::genome::network_space::MOST_HIDDEN;
use crate::genome::space::GenomeSpace;

/// Returns the number of senses of a snake with this many joints: four per joint, eight per limb, and four for the whole snake.
pub const fn sense_count(joints: usize) -> usize {
    4 * joints + 8 * (joints + 1) + 4
}

/// One network of tanh neurons for the whole snake. Its inputs are all senses and a beat.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CentralNetwork {
    /// Number of joints that the network drives.
    pub joints: u32,
    /// Servos that turn the joints to their targets.
    pub servo: ServoGenes,
    /// Frequency of the beat, in Hz.
    pub frequency_hz: f32,
    /// Hidden neurons. Their inputs are the senses in their order, then the sine and the cosine of the beat.
    pub hidden: Layer,
    /// Output neurons: the bend targets of all joints from the head, then the twist targets, if joints can twist.
    pub outputs: Layer,
}

impl CentralNetwork {
    fn outputs_of(joints: usize, servo: &ServoGenes) -> usize {
        if servo.twists() { 2 * joints } else { joints }
    }
}

impl ControllerEncoding for CentralNetwork {
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
            hidden: Layer::zeroed(hidden, sense_count(shape.joints) + 2),
            outputs: Layer::zeroed(Self::outputs_of(shape.joints, &servo), hidden),
            servo,
        }
    }

    fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        self.servo.genes(space, genes);
        space.wave.frequency_gene(&mut self.frequency_hz, genes);
        let most = space.network.weight_range;
        let sense = |index: usize| format!("input {}", index + 1);
        self.hidden.genes(["hidden", "hidden"], most, sense, genes);
        let hidden = |index: usize| format!("hidden {}", index + 1);
        self.outputs.genes(["outputs", "output"], most, hidden, genes);
    }

    fn lengths(&self, visit: LengthVisitor<'_>) {
        let (joints, hidden) = (self.joints as usize, self.hidden.neurons());
        visit(format_args!("joints"), joints, 1..=MOST_JOINTS);
        let inputs = sense_count(joints.min(MOST_JOINTS)) + 2;
        self.hidden.lengths("hidden", 1..=MOST_HIDDEN as usize, inputs, visit);
        let outputs = Self::outputs_of(joints, &self.servo);
        self.outputs.lengths("outputs", outputs..=outputs, hidden, visit);
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

/// Greatest number of joints that a snake may have.
const MOST_JOINTS: usize = 11;
