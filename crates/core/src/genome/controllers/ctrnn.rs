//! A continuous-time recurrent neural network: three neurons at each joint, with the same weights at all joints.

use serde::{Deserialize, Serialize};

use super::encoding::{
    ControllerEncoding, SERVO_SETTINGS, SettingNames, TWIST_SETTINGS, widen_weights,
};
use super::servo::ServoGenes;
use crate::genome::gene::{GeneRange, Genes, GenomeShape, Quantity};
use crate::genome::network_space::WEIGHT;
use crate::genome::space::GenomeSpace;

/// Names of a neuron's inputs, besides the three neurons of its own joint.
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

/// Number of neurons at each joint. The first drives the bend target and is an input of the neighbours' neurons; the second drives the
/// twist target.
pub const CTRNN_NEURONS: usize = 3;

/// A network of leaky integrators, `τ dy/dt = -y + Σ w σ(y + θ) + Σ g s` with σ(x) = 1 / (1 + exp(-x)), after Beer,
/// Adaptive Behavior 3, 1995.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CtrnnGenes {
    /// Number of joints, each with its own copy of the neurons.
    pub joints: u32,
    /// Servos that turn the joints to their targets.
    pub servo: ServoGenes,
    /// Genes of the neurons of a joint, which are the same at all joints.
    pub neurons: [CtrnnNeuron; CTRNN_NEURONS],
}

/// Genes of one neuron.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CtrnnNeuron {
    /// Decimal logarithm of the neuron's time constant in s.
    pub log_time_constant: f32,
    /// Bias θ of the neuron.
    pub bias: f32,
    /// Weights of the outputs of the three neurons of the neuron's own joint.
    pub own: [f32; CTRNN_NEURONS],
    /// Weights of the neuron's inputs, in the order of [`CTRNN_INPUTS`].
    pub inputs: [f32; CTRNN_INPUTS.len()],
}

/// Range of the decimal logarithms of time constants: 0.05 s to 2 s, rounded.
const LOG_TIME_CONSTANTS: [f32; 2] = [-1.3, 0.3];
/// Quantity of the decimal logarithm of a time constant in s.
const LOG_TIME_CONSTANT: Quantity = Quantity { unit: "log s", limits: LOG_TIME_CONSTANTS };

impl CtrnnNeuron {
    const ZEROED: Self = Self {
        log_time_constant: 0.0,
        bias: 0.0,
        own: [0.0; CTRNN_NEURONS],
        inputs: [0.0; CTRNN_INPUTS.len()],
    };

    /// Returns the neuron's time constant, in s.
    pub fn time_constant_s(&self) -> f32 {
        libm::powf(10.0, self.log_time_constant)
    }

    fn genes(&mut self, weights: GeneRange<'_>, genes: &mut Genes<'_>) {
        let [least, most] = LOG_TIME_CONSTANTS;
        let (range, value) = (GeneRange::Between(least, most), &mut self.log_time_constant);
        genes.gene("log_time_constant", ", time constant", LOG_TIME_CONSTANT, range, value);
        genes.gene("bias", ", bias", WEIGHT, weights, &mut self.bias);
        for (from, weight) in self.own.iter_mut().enumerate() {
            let (field, name) =
                (format_args!("own[{from}]"), format_args!(" from neuron {}", from + 1));
            genes.gene(field, name, WEIGHT, weights, weight);
        }
        for (from, (weight, input)) in self.inputs.iter_mut().zip(CTRNN_INPUTS).enumerate() {
            let (field, name) = (format_args!("inputs[{from}]"), format_args!(" from {input}"));
            genes.gene(field, name, WEIGHT, weights, weight);
        }
    }
}

impl ControllerEncoding for CtrnnGenes {
    fn settings() -> SettingNames {
        &[SERVO_SETTINGS, TWIST_SETTINGS, &["network.ctrnn_weight_range"]]
    }

    fn zeroed(space: &GenomeSpace, shape: GenomeShape) -> Self {
        Self {
            joints: shape.joints as u32,
            servo: ServoGenes::zeroed(space),
            neurons: [CtrnnNeuron::ZEROED; CTRNN_NEURONS],
        }
    }

    fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        self.servo.genes(space, genes);
        let weights = GeneRange::around_zero(space.network.ctrnn_weight_range);
        for (index, neuron) in self.neurons.iter_mut().enumerate() {
            let (field, name) =
                (format_args!("neurons[{index}]."), format_args!("neuron {}", index + 1));
            genes.inside(field, name, |genes| neuron.genes(weights, genes));
        }
    }

    fn joints(&self) -> usize {
        self.joints as usize
    }

    /// Returns the frequency, in Hz, of an oscillator with the mean of the time constants.
    fn estimated_frequency_hz(&self) -> Option<f32> {
        let sum_s: f32 = self.neurons.iter().map(CtrnnNeuron::time_constant_s).sum();
        Some(CTRNN_NEURONS as f32 / (std::f32::consts::TAU * sum_s))
    }

    fn widen(&self, space: &mut GenomeSpace) {
        self.servo.widen(space);
        widen_weights(&mut space.network.ctrnn_weight_range, self);
    }
}
