//! A modular network: the same small network at each joint, which exchanges messages with its neighbours.

use serde::{Deserialize, Serialize};

use super::encoding::{ControllerEncoding, ControllerInfo};
use super::layer::Layer;
use super::servo::ServoGenes;
use crate::check::{Invalid, within};
use crate::genome::gene::{Gene, GeneRange, GeneVisitor, GenomeShape};
use crate::genome::network_space::MOST_HIDDEN;
use crate::genome::space::GenomeSpace;
use crate::genome::wave_space::FREQUENCY_RANGE_HZ;

/// The inputs of a joint's module.
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

/// The outputs of a joint's module. The last is there only where twists have targets.
pub const MODULE_OUTPUTS: [&str; 3] = ["bend target", "message", "twist target"];

/// One small network of tanh neurons for all joints.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModularNetwork {
    /// Number of joints, each with a module.
    pub joints: u32,
    /// The servos that follow the targets.
    pub servo: ServoGenes,
    /// Frequency of the beat, in Hz.
    pub frequency_hz: f32,
    /// Delay of the beat from each joint to the next, in radians.
    pub lag_rad: f32,
    /// The hidden neurons: their inputs are [`MODULE_INPUTS`].
    pub hidden: Layer,
    /// The output neurons: see [`MODULE_OUTPUTS`].
    pub outputs: Layer,
}

impl ControllerEncoding for ModularNetwork {
    fn info() -> &'static ControllerInfo {
        &ControllerInfo {
            name: "modular",
            title: "Modular",
            words: "The same small network at each joint; neighbours exchange messages.",
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
            lag_rad: 0.0,
            hidden: Layer::zeroed(hidden, MODULE_INPUTS.len()),
            outputs: Layer::zeroed(if servo.twists() { 3 } else { 2 }, hidden),
            servo,
        }
    }

    fn genes(&mut self, space: &GenomeSpace, visit: GeneVisitor<'_>) {
        self.servo.genes(space, visit);
        space.wave.frequency_gene(&mut self.frequency_hz, visit);
        let (field, name) = (format_args!("lag_rad"), format_args!("lag per joint"));
        visit(Gene { field, name, unit: "rad", range: GeneRange::Turn }, &mut self.lag_rad);
        let most = space.network.weight_range;
        let input = |index: usize| MODULE_INPUTS.get(index).copied().unwrap_or("").to_owned();
        self.hidden.genes(["hidden", "hidden"], most, input, visit);
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
        let inside = |error: Invalid| error.inside("modular");
        self.servo.check().map_err(inside)?;
        within("frequency_hz", self.frequency_hz, FREQUENCY_RANGE_HZ).map_err(inside)?;
        within("lag_rad", self.lag_rad, -10.0..=10.0).map_err(inside)?;
        let hidden = self.hidden.neurons();
        within("hidden.neurons", hidden, 1..=MOST_HIDDEN as usize).map_err(inside)?;
        self.hidden.check("hidden", hidden, MODULE_INPUTS.len()).map_err(inside)?;
        let outputs = if self.servo.twists() { 3 } else { 2 };
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
