//! A central network: all senses lead to a few hidden neurons, and these to all joints.

use serde::{Deserialize, Serialize};

use super::encoding::{ControllerEncoding, ControllerInfo};
use super::layer::Layer;
use super::servo::ServoGenes;
use crate::check::{Invalid, within};
use crate::genome::gene::{GeneVisitor, GenomeShape};
use crate::genome::network_space::MOST_HIDDEN;
use crate::genome::space::GenomeSpace;
use crate::genome::wave_space::FREQUENCY_RANGE_HZ;

/// Number of senses of a snake with this many joints: four of each joint, eight of each limb, four of the whole.
pub const fn sense_count(joints: usize) -> usize {
    4 * joints + 8 * (joints + 1) + 4
}

/// One network of tanh neurons for the whole snake. Its inputs are all senses and a beat.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CentralNetwork {
    /// Number of joints.
    pub joints: u32,
    /// The servos that follow the targets.
    pub servo: ServoGenes,
    /// Frequency of the beat, in Hz.
    pub frequency_hz: f32,
    /// The hidden neurons: their inputs are the senses in their order, then sine and cosine of the beat.
    pub hidden: Layer,
    /// The output neurons: the bend targets of all joints from the head, then the twist targets, if there are any.
    pub outputs: Layer,
}

impl CentralNetwork {
    fn outputs_of(joints: usize, servo: &ServoGenes) -> usize {
        if servo.twists() { 2 * joints } else { joints }
    }
}

impl ControllerEncoding for CentralNetwork {
    fn info() -> &'static ControllerInfo {
        &ControllerInfo {
            name: "central",
            title: "Central",
            words: "One network for the whole snake, from all senses to all joints.",
            senses_surroundings: true,
            settings: &[
                "wave.frequency_min_hz",
                "wave.frequency_max_hz",
                "wave.angle_range_rad",
                "wave.twist_range_rad",
                "wave.stiffness_min_nm_per_rad",
                "wave.stiffness_max_nm_per_rad",
                "wave.servo_damping_nms_per_rad",
                "network.weight_range",
                "network.hidden",
            ],
        }
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

    fn genes(&mut self, space: &GenomeSpace, visit: GeneVisitor<'_>) {
        self.servo.genes(space, visit);
        space.wave.frequency_gene(&mut self.frequency_hz, visit);
        let most = space.network.weight_range;
        let sense = |index: usize| format!("input {}", index + 1);
        self.hidden.genes(["hidden", "hidden"], most, sense, visit);
        let hidden = |index: usize| format!("hidden {}", index + 1);
        self.outputs.genes(["outputs", "output"], most, hidden, visit);
    }

    fn lengths(&self, visit: &mut dyn FnMut(&'static str, usize)) {
        visit("hidden neurons", self.hidden.neurons());
        visit("outputs", self.outputs.neurons());
    }

    fn joints(&self) -> usize {
        self.joints as usize
    }

    fn frequency_hz(&self) -> f32 {
        self.frequency_hz
    }

    fn check(&self) -> Result<(), Invalid> {
        let inside = |error: Invalid| error.inside("central");
        self.servo.check().map_err(inside)?;
        within("frequency_hz", self.frequency_hz, FREQUENCY_RANGE_HZ).map_err(inside)?;
        within("joints", self.joints, 1..=MOST_JOINTS).map_err(inside)?;
        let (joints, hidden) = (self.joints as usize, self.hidden.neurons());
        within("hidden.neurons", hidden, 1..=MOST_HIDDEN as usize).map_err(inside)?;
        self.hidden.check("hidden", hidden, sense_count(joints) + 2).map_err(inside)?;
        let outputs = Self::outputs_of(joints, &self.servo);
        self.outputs.check("outputs", outputs, hidden).map_err(inside)
    }

    fn widen(&self, space: &mut GenomeSpace) {
        self.servo.widen(space);
        space.wave.widen_frequency(self.frequency_hz);
        let network = &mut space.network;
        network.hidden = self.hidden.neurons() as u32;
        network.weight_range =
            self.outputs.needed_range(self.hidden.needed_range(network.weight_range));
    }
}

/// The most joints that a snake may have.
const MOST_JOINTS: u32 = 11;
