//! A neuron of a limb: its inputs and its function.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::neuron_choices::{
    KIND_CODES, NEURON_SOURCES, NeuronKind, NeuronSource, SOURCE_CODES, choice_gene,
};
use crate::genome::gene::{GeneRange, Genes};
use crate::genome::network_space::WEIGHT;
use crate::rng::drawn;

/// Number of inputs of a neuron.
pub const NEURON_INPUTS: usize = 3;

/// Chance with which a mutation changes a gene of a neuron. If all genes changed at once, most of a network would be rewired in every
/// child.
const MUTATION_CHANCE: f64 = 0.1;

/// A neuron: a function of the weighted sum of a few values, and of a bias.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LimbNeuron {
    /// Function that the neuron applies to its weighted sum.
    pub kind: NeuronKind,
    /// Bias of the neuron, which is added to the weighted sum.
    pub bias: f32,
    /// Inputs of the neuron.
    pub inputs: [NeuronInput; NEURON_INPUTS],
}

/// An input of a neuron, with its weight.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NeuronInput {
    /// Source of the input's value.
    pub source: NeuronSource,
    /// Factor of the value in the weighted sum.
    pub weight: f32,
}

/// Draws whether a gene mutates.
fn mutates(rng: &mut ChaCha8Rng) -> bool {
    rng.random_range(0.0..1.0) < MUTATION_CHANCE
}

/// Returns a choice after a mutation: with a small chance a new one from `all`, otherwise the one before.
fn mutated<T: Copy>(before: T, all: &[T], rng: &mut ChaCha8Rng) -> T {
    if mutates(rng) { drawn(all, rng) } else { before }
}

impl LimbNeuron {
    /// A neuron that is switched off.
    pub(super) const ZEROED: Self = Self {
        kind: NeuronKind::Off,
        bias: 0.0,
        inputs: [NeuronInput { source: NeuronSource::Own1, weight: 0.0 }; NEURON_INPUTS],
    };

    /// Returns the neuron's output for these values of all sources. The sum is computed in the order of the inputs, with the bias last.
    pub fn respond(&self, values: &[f32; NEURON_SOURCES]) -> f32 {
        let mut sum = 0.0;
        for input in &self.inputs {
            sum += values[input.source as usize] * input.weight;
        }
        self.kind.response(sum + self.bias)
    }

    /// Visits the neuron's genes. Weights and bias have this range.
    pub(super) fn genes(&mut self, weights: GeneRange<'_>, genes: &mut Genes<'_>) {
        choice_gene("kind", "kind", &NeuronKind::ALL, &KIND_CODES, &mut self.kind, genes);
        genes.gene("bias", "bias", WEIGHT, weights, &mut self.bias);
        for (index, input) in self.inputs.iter_mut().enumerate() {
            let number = index + 1;
            let field = format_args!("inputs[{index}].source");
            let name = format_args!("source {number}");
            let source = &mut input.source;
            choice_gene(field, name, &NeuronSource::ALL, &SOURCE_CODES, source, genes);
            let field = format_args!("inputs[{index}].weight");
            let name = format_args!("weight {number}");
            genes.gene(field, name, WEIGHT, weights, &mut input.weight);
        }
    }

    /// Completes the mutation of a neuron after all its numbers have taken a step; `before` is the neuron before the step. Each gene keeps
    /// its change with a small chance, in which case a choice is drawn anew; otherwise it returns to its value before. The inputs of a
    /// neuron that has just been switched on are drawn anew, with weights within ±`most`, because there was no selection of them while it
    /// was off.
    pub(super) fn mutate(&mut self, before: &Self, most: f32, rng: &mut ChaCha8Rng) {
        self.kind = mutated(before.kind, &NeuronKind::ALL, rng);
        if !mutates(rng) {
            self.bias = before.bias;
        }
        let was_off = before.kind == NeuronKind::Off;
        let is_new = was_off && self.kind != NeuronKind::Off;
        for (input, before) in self.inputs.iter_mut().zip(&before.inputs) {
            if is_new {
                input.source = drawn(&NeuronSource::ALL, rng);
                input.weight = GeneRange::Between(-most, most).random(rng);
                continue;
            }
            input.source = mutated(before.source, &NeuronSource::ALL, rng);
            if !mutates(rng) {
                input.weight = before.weight;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::NeuronSource::{Blocked, Own1, Own2, Own3, Touch};
    use super::*;
    use crate::rng::{Purpose, stream};

    fn neuron(kind: NeuronKind, bias: f32, inputs: [(NeuronSource, f32); 3]) -> LimbNeuron {
        LimbNeuron {
            kind,
            bias,
            inputs: inputs.map(|(source, weight)| NeuronInput { source, weight }),
        }
    }

    fn values(known: &[(NeuronSource, f32)]) -> [f32; NEURON_SOURCES] {
        let mut values = [0.0; NEURON_SOURCES];
        known.iter().for_each(|&(source, value)| values[source as usize] = value);
        values
    }

    #[test]
    fn step_neurons_compute_and_or_and_not() {
        let step = |bias, inputs| neuron(NeuronKind::Step, bias, inputs);
        // A sum of exactly 0 reaches the threshold.
        let and = step(-2.0, [(Touch, 1.0), (Blocked, 1.0), (Own1, 0.0)]);
        let or = step(-1.0, [(Touch, 1.0), (Blocked, 1.0), (Own1, 0.0)]);
        let not = step(0.0, [(Touch, -1.0), (Blocked, 0.0), (Own1, 0.0)]);
        for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let values = values(&[(Touch, a as f32), (Blocked, b as f32)]);
            let expected = [a & b, a | b, 1 - a].map(|bit| bit as f32);
            assert_eq!([and, or, not].map(|of| of.respond(&values)), expected, "{a} and {b}");
        }
    }

    #[test]
    fn the_kinds_respond_with_their_functions() {
        let response = |kind| {
            neuron(kind, 0.5, [(Touch, 2.0), (Touch, -1.0), (Own1, 9.0)])
                .respond(&values(&[(Touch, 0.25)]))
        };
        assert_eq!(response(NeuronKind::Off), 0.0);
        assert_eq!(response(NeuronKind::Tanh), libm::tanhf(0.75));
        assert_eq!(response(NeuronKind::Step), 1.0);
        assert_eq!(response(NeuronKind::Sigmoid), 1.0 / (1.0 + libm::expf(-0.75)));
    }

    #[test]
    fn a_ring_of_three_neurons_oscillates() {
        // Each neuron excites itself and is inhibited by the one before it.
        let ring = [(Own1, Own3), (Own2, Own1), (Own3, Own2)].map(|(own, before)| {
            neuron(NeuronKind::Tanh, 0.0, [(own, 2.0), (before, -2.0), (Touch, 0.0)])
        });
        let mut state = values(&[(Own1, 0.1)]);
        let mut signs = Vec::new();
        for _ in 0..400 {
            let next = ring.map(|neuron| neuron.respond(&state));
            state[..3].copy_from_slice(&next);
            signs.push(next[0] > 0.0);
        }
        let late = &signs[200..];
        let changes = late.windows(2).filter(|pair| pair[0] != pair[1]).count();
        assert!(changes >= 10, "{changes} changes of sign in 200 steps");
        assert!(state[..3].iter().any(|value| value.abs() > 0.5), "{:?}", &state[..3]);
    }

    #[test]
    fn genes_mutate_by_chance_and_a_neuron_switched_on_has_new_inputs() {
        let before = neuron(NeuronKind::Off, 0.25, [(Touch, 1.0), (Blocked, 2.0), (Own1, 3.0)]);
        // Here all numbers have taken a step.
        let mut stepped = LimbNeuron { bias: 0.5, ..before };
        stepped.inputs.iter_mut().for_each(|input| input.weight += 0.5);
        let mut rng = stream(1, 1, 0, Purpose::Mutation);
        let (mut on, mut off, mut sources, mut weights) = (0.0, 0.0, 0.0, 0.0);
        for _ in 0..4000 {
            let mut after = stepped;
            after.mutate(&before, 4.0, &mut rng);
            let pairs = after.inputs.iter().zip(&before.inputs);
            if after.kind == NeuronKind::Off {
                off += 1.0;
                for (input, before) in pairs {
                    sources += f64::from(u8::from(input.source != before.source));
                    weights += f64::from(u8::from(input.weight != before.weight));
                }
            } else {
                on += 1.0;
                assert!(after.inputs.iter().all(|input| input.weight.abs() <= 4.0));
                assert!(pairs.clone().all(|(input, before)| input.weight != before.weight));
            }
        }
        for (found, expected) in [
            (on / 4000.0, 3.0 / 4.0 * MUTATION_CHANCE),
            (sources / (3.0 * off), 21.0 / 22.0 * MUTATION_CHANCE),
            (weights / (3.0 * off), MUTATION_CHANCE),
        ] {
            assert!((found - expected).abs() < 0.015, "{found}, not {expected}");
        }
    }
}
