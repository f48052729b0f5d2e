//! A layer of neurons: weights of their inputs, and their biases.

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use super::encoding::LengthVisitor;
use super::tanh::tanh_each;
use crate::genome::gene::{GeneRange, Genes};
use crate::genome::network_space::WEIGHT;

/// Weights of a layer of neurons: one row per neuron, with a weight for each input, and the bias at the end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Layer {
    /// Rows of weights, one per neuron.
    pub rows: Vec<Vec<f32>>,
}

impl Layer {
    /// Creates a layer whose weights are zero.
    pub fn zeroed(neurons: usize, inputs: usize) -> Self {
        Self { rows: vec![vec![0.0; inputs + 1]; neurons] }
    }

    /// Returns the number of neurons.
    pub fn neurons(&self) -> usize {
        self.rows.len()
    }

    /// Returns the number of inputs, without the bias.
    pub fn inputs(&self) -> usize {
        self.rows.first().map_or(0, |row| row.len().saturating_sub(1))
    }

    /// Writes the output of each neuron: tanh of its weighted sum.
    pub fn respond(&self, inputs: &[f32], outputs: &mut [f32]) {
        self.weigh(inputs, outputs);
        tanh_each(outputs);
    }

    /// Writes the weighted sum of each neuron, added in the order of the inputs, with the bias last.
    pub fn weigh(&self, inputs: &[f32], sums: &mut [f32]) {
        for (result, row) in sums.iter_mut().zip(&self.rows) {
            let mut sum = 0.0;
            for (input, weight) in inputs.iter().zip(row) {
                sum += input * weight;
            }
            *result = sum + row.last().copied().unwrap_or(0.0);
        }
    }

    /// Visits the weights, all with the range ±`range`. `field` and `neuron` name the layer and its neurons, `input` the inputs.
    pub fn genes(
        &mut self,
        [field, neuron]: [&'static str; 2],
        range: f32,
        input: impl Fn(usize) -> String,
        genes: &mut Genes<'_>,
    ) {
        let range = GeneRange::around_zero(range);
        let names: Vec<String> = (0..self.inputs()).map(input).chain(["bias".to_owned()]).collect();
        for (index, row) in self.rows.iter_mut().enumerate() {
            for (input, (weight, name)) in row.iter_mut().zip(&names).enumerate() {
                let field = format_args!("{field}[{index}][{input}]");
                let name = format_args!("{neuron} {} from {name}", index + 1);
                genes.gene(field, name, WEIGHT, range, weight);
            }
        }
    }

    /// Visits the number of neurons, for which `neurons` are allowed, and the number of weights of each neuron. `field` names the layer.
    pub fn lengths(
        &self,
        field: &str,
        neurons: RangeInclusive<usize>,
        inputs: usize,
        visit: LengthVisitor<'_>,
    ) {
        visit(format_args!("{field}.neurons"), self.neurons(), neurons);
        for (index, row) in self.rows.iter().enumerate() {
            visit(format_args!("{field}[{index}].weights"), row.len(), inputs + 1..=inputs + 1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_neuron_responds_with_tanh_of_its_weighted_sum() {
        let layer = Layer { rows: vec![vec![1.0, -2.0, 0.5], vec![0.0, 0.0, -1.0]] };
        let mut outputs = [0.0; 2];
        layer.respond(&[0.5, 0.25], &mut outputs);
        assert_eq!(outputs, [libm::tanhf(0.5), libm::tanhf(-1.0)]);
    }
}
