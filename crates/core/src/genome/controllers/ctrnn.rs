//! A continuous-time recurrent neural network: three neurons at each joint, with the same weights at all joints.

use serde::{Deserialize, Serialize};

use super::encoding::{ControllerEncoding, ControllerInfo};
use super::servo::ServoGenes;
use crate::check::{Invalid, within};
use crate::genome::gene::{Gene, GeneRange, GeneVisitor, GenomeShape};
use crate::genome::network_space::WEIGHT_RANGE;
use crate::genome::space::GenomeSpace;

/// The inputs of a neuron, after the three neurons of its own joint.
pub const CTRNN_INPUTS: [&str; 13] = [
    "neuron 1 ahead",
    "neuron 1 behind",
    "own bend",
    "own bend rate",
    "front touch",
    "front blocked",
    "front pitch",
    "front gap",
    "front step up",
    "rear touch",
    "rear load",
    "rear pitch",
    "place along the body",
];

/// Neurons at each joint. The first drives the bend target and is read by the neighbours, the second drives the twist
/// target.
pub const CTRNN_NEURONS: usize = 3;

/// A network of leaky integrators, `τ dy/dt = -y + Σ w σ(y + θ) + Σ g s` with σ(x) = 1 / (1 + exp(-x)), after Beer,
/// Adaptive Behavior 3, 1995.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CtrnnGenes {
    /// Number of joints, each with its neurons.
    pub joints: u32,
    /// The servos that follow the targets.
    pub servo: ServoGenes,
    /// The neurons of each joint.
    pub neurons: [CtrnnNeuron; CTRNN_NEURONS],
}

/// One neuron.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CtrnnNeuron {
    /// Decimal logarithm of its time constant in s.
    pub log_time_constant: f32,
    /// Its bias θ.
    pub bias: f32,
    /// Weights of the outputs of the three neurons of its joint.
    pub own: [f32; CTRNN_NEURONS],
    /// Weights of [`CTRNN_INPUTS`].
    pub inputs: [f32; CTRNN_INPUTS.len()],
}

/// The range of the logarithms of time constants: 0.05 s to 2 s, rounded.
const LOG_TIME_CONSTANTS: [f32; 2] = [-1.3, 0.3];

impl CtrnnNeuron {
    const ZEROED: Self = Self {
        log_time_constant: 0.0,
        bias: 0.0,
        own: [0.0; CTRNN_NEURONS],
        inputs: [0.0; CTRNN_INPUTS.len()],
    };

    /// Its time constant, in s.
    pub fn time_constant_s(&self) -> f32 {
        libm::powf(10.0, self.log_time_constant)
    }

    fn weights(&self) -> impl Iterator<Item = f32> + '_ {
        [self.bias].into_iter().chain(self.own).chain(self.inputs)
    }
}

impl ControllerEncoding for CtrnnGenes {
    fn info() -> &'static ControllerInfo {
        &ControllerInfo {
            name: "ctrnn",
            title: "CTRNN",
            words: "Continuous-time recurrent network: three leaky neurons at each joint.",
            senses_surroundings: true,
            settings: &[
                "wave.angle_range_rad",
                "wave.twist_range_rad",
                "wave.stiffness_min_nm_per_rad",
                "wave.stiffness_max_nm_per_rad",
                "wave.servo_damping_nms_per_rad",
                "network.ctrnn_weight_range",
            ],
        }
    }

    fn zeroed(space: &GenomeSpace, shape: GenomeShape) -> Self {
        Self {
            joints: shape.joints as u32,
            servo: ServoGenes::zeroed(space),
            neurons: [CtrnnNeuron::ZEROED; CTRNN_NEURONS],
        }
    }

    fn genes(&mut self, space: &GenomeSpace, visit: GeneVisitor<'_>) {
        self.servo.genes(space, visit);
        let most = space.network.ctrnn_weight_range;
        let weights = GeneRange::Between(-most, most);
        for (index, neuron) in self.neurons.iter_mut().enumerate() {
            let number = index + 1;
            let [least, greatest] = LOG_TIME_CONSTANTS;
            let range = GeneRange::Between(least, greatest);
            let field = format_args!("neurons[{index}].log_time_constant");
            let name = format_args!("neuron {number}, time constant");
            visit(Gene { field, name, unit: "log s", range }, &mut neuron.log_time_constant);
            let field = format_args!("neurons[{index}].bias");
            let name = format_args!("neuron {number}, bias");
            visit(Gene { field, name, unit: "", range: weights }, &mut neuron.bias);
            for (from, weight) in neuron.own.iter_mut().enumerate() {
                let field = format_args!("neurons[{index}].own[{from}]");
                let name = format_args!("neuron {number} from neuron {}", from + 1);
                visit(Gene { field, name, unit: "", range: weights }, weight);
            }
            for (from, (weight, input)) in neuron.inputs.iter_mut().zip(CTRNN_INPUTS).enumerate() {
                let field = format_args!("neurons[{index}].inputs[{from}]");
                let name = format_args!("neuron {number} from {input}");
                visit(Gene { field, name, unit: "", range: weights }, weight);
            }
        }
    }

    fn joints(&self) -> usize {
        self.joints as usize
    }

    /// That of an oscillator with the mean of the time constants, as an estimate.
    fn frequency_hz(&self) -> f32 {
        let sum_s: f32 = self.neurons.iter().map(CtrnnNeuron::time_constant_s).sum();
        CTRNN_NEURONS as f32 / (std::f32::consts::TAU * sum_s)
    }

    fn check(&self) -> Result<(), Invalid> {
        let inside = |error: Invalid| error.inside("ctrnn");
        self.servo.check().map_err(inside)?;
        for (index, neuron) in self.neurons.iter().enumerate() {
            let place = format!("neurons[{index}]");
            let [least, most] = LOG_TIME_CONSTANTS;
            let field = format!("{place}.log_time_constant");
            within(&field, neuron.log_time_constant, least..=most).map_err(inside)?;
            within(&format!("{place}.bias"), neuron.bias, WEIGHT_RANGE).map_err(inside)?;
            let lists = [("own", &neuron.own[..]), ("inputs", &neuron.inputs[..])];
            for (list, weights) in lists {
                for (from, weight) in weights.iter().enumerate() {
                    let field = format!("{place}.{list}[{from}]");
                    within(&field, *weight, WEIGHT_RANGE).map_err(inside)?;
                }
            }
        }
        Ok(())
    }

    fn widen(&self, space: &mut GenomeSpace) {
        self.servo.widen(space);
        let weights = self.neurons.iter().flat_map(CtrnnNeuron::weights);
        let network = &mut space.network;
        network.ctrnn_weight_range =
            weights.map(|weight| weight.abs()).fold(network.ctrnn_weight_range, f32::max);
    }
}
