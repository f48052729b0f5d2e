//! The choices of a neuron: its function, and the sources of its inputs.

use std::fmt::Display;

use serde::{Deserialize, Serialize};

use crate::genome::gene::{GeneRange, Genes, Quantity};
use crate::schema::named_values;

named_values! {
    /// The function that a neuron applies to its sum. The value of its gene is the index in the list of all functions.
    #[derive(Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum NeuronKind {
        /// The output is always 0: the neuron is switched off.
        Off = "off";
        /// The output is the hyperbolic tangent of the sum.
        Tanh = "tanh";
        /// The output is 1 for a sum of at least 0, otherwise 0: the neuron of McCulloch and Pitts, whose threshold is minus the bias.
        Step = "step";
        /// The logistic function, 1 / (1 + exp(-sum)).
        Sigmoid = "sigmoid";
    }
}

impl NeuronKind {
    pub(super) fn response(self, sum: f32) -> f32 {
        match self {
            Self::Off => 0.0,
            Self::Tanh => libm::tanhf(sum),
            Self::Step => f32::from(u8::from(sum >= 0.0)),
            Self::Sigmoid => 1.0 / (1.0 + libm::expf(-sum)),
        }
    }
}

named_values! {
    /// A value that a neuron can read. Outputs of neurons are those of the last step; senses and the beat are those of the present step.
    ///
    /// The order is that of a limb's values: the neurons of the limb itself, of the limb in front and of the limb behind, the limb's
    /// senses, the beat. The value of a gene is the index in the list of all sources.
    #[derive(Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum NeuronSource {
        Own1 = "own neuron 1";
        Own2 = "own neuron 2";
        Own3 = "own neuron 3";
        Own4 = "own neuron 4";
        Front1 = "front neuron 1";
        Front2 = "front neuron 2";
        Front3 = "front neuron 3";
        Front4 = "front neuron 4";
        Rear1 = "rear neuron 1";
        Rear2 = "rear neuron 2";
        Rear3 = "rear neuron 3";
        Rear4 = "rear neuron 4";
        Bend = "bend";
        BendRate = "bend rate";
        Touch = "touch";
        Load = "load";
        Blocked = "blocked";
        Pitch = "pitch";
        Gap = "gap";
        StepUp = "step up";
        BeatSine = "beat, sine";
        BeatCosine = "beat, cosine";
    }
}

/// Number of values that a neuron can read.
pub const NEURON_SOURCES: usize = NeuronSource::ALL.len();

/// Values of a gene that chooses the kind of a neuron.
pub(super) const KIND_CODES: [f32; NeuronKind::ALL.len()] = codes();
/// Values of a gene that chooses a source.
pub(super) const SOURCE_CODES: [f32; NEURON_SOURCES] = codes();

/// Returns the values of a gene that chooses from a list of this length: 0, 1, 2, ...
const fn codes<const N: usize>() -> [f32; N] {
    let mut codes = [0.0; N];
    let mut index = 0;
    while index < N {
        codes[index] = index as f32;
        index += 1;
    }
    codes
}

/// Visits a choice as a gene, whose value is the index of the choice in the list of all.
pub(super) fn choice_gene<T: Copy + PartialEq>(
    field: impl Display,
    name: impl Display,
    all: &[T],
    codes: &[f32],
    choice: &mut T,
    genes: &mut Genes<'_>,
) {
    let mut value = all.iter().position(|known| known == choice).unwrap_or(0) as f32;
    let quantity = Quantity::pure(0.0..=all.len() as f32);
    genes.gene(field, name, quantity, GeneRange::OneOf(codes), &mut value);
    if let Some(chosen) = all.get(value as usize) {
        *choice = *chosen;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_are_in_the_order_of_their_values() {
        for (index, source) in NeuronSource::ALL.into_iter().enumerate() {
            assert_eq!(source as usize, index, "{source:?}");
        }
        assert_eq!(KIND_CODES, [0.0, 1.0, 2.0, 3.0]);
    }
}
