//! A layer of neurons: weights of its inputs, and a bias.

use serde::{Deserialize, Serialize};

use super::tanh::tanh_each;
use crate::check::{Invalid, within};
use crate::genome::gene::{Gene, GeneRange, GeneVisitor};
use crate::genome::network_space::WEIGHT_RANGE;

/// The weights of a layer of neurons: one row for each neuron, with a weight for each input and its bias at the end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Layer {
    /// The rows.
    pub rows: Vec<Vec<f32>>,
}

impl Layer {
    /// A layer of zeros.
    pub fn zeroed(neurons: usize, inputs: usize) -> Self {
        Self { rows: vec![vec![0.0; inputs + 1]; neurons] }
    }

    /// Number of neurons.
    pub fn neurons(&self) -> usize {
        self.rows.len()
    }

    /// Number of inputs, without the bias.
    pub fn inputs(&self) -> usize {
        self.rows.first().map_or(0, |row| row.len().saturating_sub(1))
    }

    /// Writes the output of each neuron, tanh of its weighted sum.
    pub fn respond(&self, inputs: &[f32], outputs: &mut [f32]) {
        self.weigh(inputs, outputs);
        tanh_each(outputs);
    }

    /// Writes the weighted sum of each neuron, in the order of the inputs, the bias last.
    pub fn weigh(&self, inputs: &[f32], sums: &mut [f32]) {
        for (result, row) in sums.iter_mut().zip(&self.rows) {
            let mut sum = 0.0;
            for (input, weight) in inputs.iter().zip(row) {
                sum += input * weight;
            }
            *result = sum + row.last().copied().unwrap_or(0.0);
        }
    }

    /// Visits the weights, all in ±`range`; `field` and `neuron` name the layer and its neurons, `input` the inputs.
    pub fn genes(
        &mut self,
        [field, neuron]: [&'static str; 2],
        range: f32,
        input: impl Fn(usize) -> String,
        visit: GeneVisitor<'_>,
    ) {
        let inputs = self.inputs();
        let names: Vec<String> = (0..inputs).map(input).chain(["bias".to_owned()]).collect();
        for (index, row) in self.rows.iter_mut().enumerate() {
            for (input, (weight, name)) in row.iter_mut().zip(&names).enumerate() {
                let field = format_args!("{field}[{index}][{input}]");
                let name = format_args!("{neuron} {} from {name}", index + 1);
                let range = GeneRange::Between(-range, range);
                visit(Gene { field, name, unit: "", range }, weight);
            }
        }
    }

    /// Checks the shape and every weight; `field` names the layer.
    ///
    /// # Errors
    /// The first that is not allowed.
    pub fn check(&self, field: &str, neurons: usize, inputs: usize) -> Result<(), Invalid> {
        let neurons_allowed = neurons..=neurons;
        within(&format!("{field}.neurons"), self.neurons(), neurons_allowed)?;
        for (index, row) in self.rows.iter().enumerate() {
            let place = format!("{field}[{index}]");
            within(&format!("{place}.weights"), row.len(), inputs + 1..=inputs + 1)?;
            for (input, weight) in row.iter().enumerate() {
                within(&format!("{place}[{input}]"), *weight, WEIGHT_RANGE)?;
            }
        }
        Ok(())
    }

    /// The greatest size of its weights, at least `range`.
    pub fn needed_range(&self, range: f32) -> f32 {
        self.rows.iter().flatten().map(|weight| weight.abs()).fold(range, f32::max)
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

    #[test]
    fn a_hostile_layer_is_refused_with_its_place() {
        let refusal = |layer: &Layer| layer.check("hidden", 2, 3).expect_err("refused").to_string();
        let mut layer = Layer::zeroed(2, 3);
        layer.check("hidden", 2, 3).expect("allowed");
        layer.rows[1][2] = f32::NAN;
        assert_eq!(refusal(&layer), "hidden[1][2] is NaN; allowed: -100 to 100");
        layer.rows[1].push(0.0);
        assert_eq!(refusal(&layer), "hidden[1].weights is 5; allowed: 4 to 4");
        layer.rows.pop();
        assert_eq!(refusal(&layer), "hidden.neurons is 1; allowed: 2 to 2");
    }
}
