//! The choices of a neuron: what it computes, and what its inputs read.

use serde::{Deserialize, Serialize};

use crate::genome::gene::{Gene, GeneVisitor};

/// What a neuron makes of its sum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NeuronKind {
    /// Nothing: its output is 0.
    Off,
    /// The hyperbolic tangent of the sum.
    Tanh,
    /// 1 for a sum of at least 0, otherwise 0: the neuron of McCulloch and Pitts, whose threshold is minus the bias.
    Step,
    /// 1 / (1 + exp(-sum)).
    Sigmoid,
}

impl NeuronKind {
    /// All kinds. A gene has the place in this list as its value.
    pub const ALL: [Self; 4] = [Self::Off, Self::Tanh, Self::Step, Self::Sigmoid];

    /// Its name, in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Tanh => "tanh",
            Self::Step => "step",
            Self::Sigmoid => "sigmoid",
        }
    }

    pub(super) fn response(self, sum: f32) -> f32 {
        match self {
            Self::Off => 0.0,
            Self::Tanh => libm::tanhf(sum),
            Self::Step => f32::from(u8::from(sum >= 0.0)),
            Self::Sigmoid => 1.0 / (1.0 + libm::expf(-sum)),
        }
    }
}

/// A value that a neuron can read. Those of neurons are from the last step, those of senses and of the beat from this one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[expect(missing_docs, reason = "the names of neurons and senses say it")]
pub enum NeuronSource {
    Own1,
    Own2,
    Own3,
    Own4,
    Front1,
    Front2,
    Front3,
    Front4,
    Rear1,
    Rear2,
    Rear3,
    Rear4,
    Bend,
    BendRate,
    Touch,
    Load,
    Blocked,
    Pitch,
    Gap,
    StepUp,
    BeatSine,
    BeatCosine,
}

/// Number of values that a neuron can read.
pub const NEURON_SOURCES: usize = NeuronSource::ALL.len();

impl NeuronSource {
    /// All sources, in the order of a limb's values: the neurons of the limb itself, of the limb in front and of the limb
    /// behind, the limb's senses, the beat. A gene has the place in this list as its value.
    pub const ALL: [Self; 22] = [
        Self::Own1,
        Self::Own2,
        Self::Own3,
        Self::Own4,
        Self::Front1,
        Self::Front2,
        Self::Front3,
        Self::Front4,
        Self::Rear1,
        Self::Rear2,
        Self::Rear3,
        Self::Rear4,
        Self::Bend,
        Self::BendRate,
        Self::Touch,
        Self::Load,
        Self::Blocked,
        Self::Pitch,
        Self::Gap,
        Self::StepUp,
        Self::BeatSine,
        Self::BeatCosine,
    ];

    /// Its name, in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Own1 => "own neuron 1",
            Self::Own2 => "own neuron 2",
            Self::Own3 => "own neuron 3",
            Self::Own4 => "own neuron 4",
            Self::Front1 => "front neuron 1",
            Self::Front2 => "front neuron 2",
            Self::Front3 => "front neuron 3",
            Self::Front4 => "front neuron 4",
            Self::Rear1 => "rear neuron 1",
            Self::Rear2 => "rear neuron 2",
            Self::Rear3 => "rear neuron 3",
            Self::Rear4 => "rear neuron 4",
            Self::Bend => "bend",
            Self::BendRate => "bend rate",
            Self::Touch => "touch",
            Self::Load => "load",
            Self::Blocked => "blocked",
            Self::Pitch => "pitch",
            Self::Gap => "gap",
            Self::StepUp => "step up",
            Self::BeatSine => "beat, sine",
            Self::BeatCosine => "beat, cosine",
        }
    }
}

/// The values of a gene that is a kind.
pub(super) const KIND_CODES: [f32; NeuronKind::ALL.len()] = codes();
/// The values of a gene that is a source.
pub(super) const SOURCE_CODES: [f32; NEURON_SOURCES] = codes();

/// The values of a gene that chooses from a list of this length.
const fn codes<const N: usize>() -> [f32; N] {
    let mut codes = [0.0; N];
    let mut index = 0;
    while index < N {
        codes[index] = index as f32;
        index += 1;
    }
    codes
}

/// Visits a choice as a gene, whose value is the place of the choice in the list of all.
pub(super) fn visit_choice<T: Copy + PartialEq>(
    gene: Gene<'_>,
    all: &[T],
    choice: &mut T,
    visit: GeneVisitor<'_>,
) {
    let mut value = all.iter().position(|known| known == choice).unwrap_or(0) as f32;
    visit(gene, &mut value);
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
