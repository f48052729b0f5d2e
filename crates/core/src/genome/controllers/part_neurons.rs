//! Neurons in the parts of a creature: each node of the body's graph contains a small graph of neurons, which grows with the node.

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3Default;

use super::encoding::{
    ControllerEncoding, FREQUENCY_SETTINGS, LengthVisitor, SettingNames, widen_weights,
};
use super::neuron_function::NeuronFunction;
use crate::check::{Invalid, within};
use crate::genome::creature::MOST_NODES;
use crate::genome::gene::{GeneRange, Genes, GenomeShape};
use crate::genome::network_space::WEIGHT;
use crate::genome::space::GenomeSpace;
use crate::genome::wave_space::FREQUENCY;
use crate::schema::listed_values;

/// Largest number of neurons of a part.
pub const MOST_PART_NEURONS: usize = 12;
/// Largest number of neurons of a whole creature.
pub const MOST_CREATURE_NEURONS: usize = 96;

/// The neurons of a creature.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartNeurons {
    /// Number of joints of the body.
    pub joints: u32,
    /// Neurons and joint inputs of each node of the body's graph.
    pub nodes: Vec<NodeNeurons>,
    /// Neurons that belong to no part. Every neuron may read them.
    pub shared: Vec<PartNeuron>,
}

/// The neurons that each part of a node has, and the inputs that drive the part's joint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NodeNeurons {
    /// Neurons of the part.
    pub neurons: Vec<PartNeuron>,
    /// Input for the torque about the bend axis, as a share of the greatest torque.
    pub bend: PartInput,
    /// Input for the torque about the twist axis, as a share of the greatest torque.
    pub twist: PartInput,
}

/// A neuron of a part, or a shared one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartNeuron {
    /// Function of the neuron.
    pub function: NeuronFunction,
    /// Bias of the neuron, which is added to its first input.
    pub bias: f32,
    /// Frequency of an oscillator, in Hz; `None` for other neurons.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frequency_hz: Option<f32>,
    /// Inputs of the neuron, as many as its function has.
    pub inputs: Vec<PartInput>,
}

/// A weighted input of a neuron or of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartInput {
    /// Source of the input's value.
    pub source: PartSource,
    /// Factor by which the value is multiplied.
    pub weight: f32,
}

/// A source of an input. The index of a neuron counts from 0. If there are fewer neurons, counting continues from the first one; if there
/// are none, the value is 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PartSource {
    /// A sense of the part.
    Sense(PartSense),
    /// A neuron of the same part.
    Own(u8),
    /// A neuron of the part from which this part has grown.
    Parent(u8),
    /// The mean over all parts that grow from this part of their neurons with this index.
    Children(u8),
    /// A neuron that belongs to no part.
    Shared(u8),
}

listed_values! {
    /// A sense of a part: see the catalogue of senses in `control`. Senses of a joint are those of the joint that holds the part. The
    /// first part has no such joint.
    #[derive(Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    #[expect(missing_docs, reason = "the catalogue of senses describes them")]
    pub enum PartSense {
        Bend;
        Twist;
        BendRate;
        TwistRate;
        Touch;
        Load;
        Blocked;
        Pitch;
        Roll;
        Gap;
        StepUp;
        Yaw;
    }
}

impl PartSource {
    /// Returns the index of the neuron; `None` for a sense.
    fn neuron(self) -> Option<u8> {
        match self {
            Self::Sense(_) => None,
            Self::Own(index)
            | Self::Parent(index)
            | Self::Children(index)
            | Self::Shared(index) => Some(index),
        }
    }

    /// Returns the bytes that represent the source in a hash.
    fn code(self) -> [u8; 2] {
        match self {
            Self::Sense(sense) => [0, sense as u8],
            Self::Own(index) => [1, index],
            Self::Parent(index) => [2, index],
            Self::Children(index) => [3, index],
            Self::Shared(index) => [4, index],
        }
    }
}

impl PartInput {
    fn check(&self) -> Result<(), Invalid> {
        let most = MOST_PART_NEURONS as u8 - 1;
        self.source.neuron().map_or(Ok(()), |index| within("source", index, 0..=most))
    }
}

impl PartNeuron {
    fn check(&self) -> Result<(), Invalid> {
        for (index, input) in self.inputs.iter().enumerate() {
            input.check().map_err(|error| error.inside(&format!("inputs[{index}]")))?;
        }
        match self.frequency_hz {
            Some(frequency_hz) if !self.function.oscillates() => Err(Invalid::new(
                "frequency_hz",
                frequency_hz,
                "none: this neuron does not oscillate",
            )),
            None if self.function.oscillates() => {
                Err(Invalid::new("frequency_hz", "not given", "the frequency of an oscillator"))
            }
            _ => Ok(()),
        }
    }

    fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        let weights = space.network.weights();
        genes.gene("bias", "bias", WEIGHT, weights, &mut self.bias);
        if let Some(frequency_hz) = &mut self.frequency_hz {
            let range = GeneRange::Ratio(space.wave.frequency_min_hz, space.wave.frequency_max_hz);
            genes.gene("frequency_hz", "frequency", FREQUENCY, range, frequency_hz);
        }
        for (index, input) in self.inputs.iter_mut().enumerate() {
            let field = format_args!("inputs[{index}].weight");
            let name = format_args!("weight {}", index + 1);
            genes.gene(field, name, WEIGHT, weights, &mut input.weight);
        }
    }

    fn hash(&self, hash: &mut Xxh3Default) {
        hash.update(&[self.function as u8, self.inputs.len() as u8]);
        self.inputs.iter().for_each(|input| hash.update(&input.source.code()));
    }
}

impl PartNeurons {
    /// Returns the lists of neurons with their paths in saves, first those of the nodes.
    fn lists(&self) -> impl Iterator<Item = (String, &[PartNeuron])> {
        let of_nodes = self.nodes.iter().enumerate();
        let of_nodes =
            of_nodes.map(|(index, node)| (format!("nodes[{index}].neurons"), &node.neurons[..]));
        of_nodes.chain([("shared".to_owned(), &self.shared[..])])
    }

    /// Returns all neurons, first those of the nodes.
    fn all(&self) -> impl Iterator<Item = &PartNeuron> {
        self.nodes.iter().flat_map(|node| &node.neurons).chain(&self.shared)
    }
}

impl ControllerEncoding for PartNeurons {
    fn settings() -> SettingNames {
        &[
            FREQUENCY_SETTINGS,
            &[
                "creatures.parts_min",
                "creatures.parts_max",
                "creatures.neurons",
                "network.weight_range",
            ],
        ]
    }

    fn zeroed(_: &GenomeSpace, shape: GenomeShape) -> Self {
        Self { joints: shape.joints as u32, nodes: Vec::new(), shared: Vec::new() }
    }

    fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        let weights = space.network.weights();
        for (node, of_node) in self.nodes.iter_mut().enumerate() {
            let (field, name) =
                (format_args!("nodes[{node}]."), format_args!("node {}, ", node + 1));
            genes.inside(field, name, |genes| {
                for (index, neuron) in of_node.neurons.iter_mut().enumerate() {
                    let field = format_args!("neurons[{index}].");
                    let name = format_args!("neuron {}, ", index + 1);
                    genes.inside(field, name, |genes| neuron.genes(space, genes));
                }
                let NodeNeurons { bend, twist, .. } = of_node;
                genes.gene("bend.weight", "bend weight", WEIGHT, weights, &mut bend.weight);
                genes.gene("twist.weight", "twist weight", WEIGHT, weights, &mut twist.weight);
            });
        }
        for (index, neuron) in self.shared.iter_mut().enumerate() {
            let field = format_args!("shared[{index}].");
            let name = format_args!("shared neuron {}, ", index + 1);
            genes.inside(field, name, |genes| neuron.genes(space, genes));
        }
    }

    fn lengths(&self, visit: LengthVisitor<'_>) {
        visit(format_args!("nodes"), self.nodes.len(), 0..=MOST_NODES);
        for (list, neurons) in self.lists() {
            visit(format_args!("{list}"), neurons.len(), 0..=MOST_PART_NEURONS);
            for (index, neuron) in neurons.iter().enumerate() {
                let inputs = neuron.function.inputs();
                let name = format_args!("{list}[{index}].inputs");
                visit(name, neuron.inputs.len(), inputs..=inputs);
            }
        }
    }

    fn joints(&self) -> usize {
        self.joints as usize
    }

    /// Returns the mean frequency of the oscillators, in Hz; 0 without oscillators.
    fn estimated_frequency_hz(&self) -> Option<f32> {
        let frequencies: Vec<f32> = self.all().filter_map(|neuron| neuron.frequency_hz).collect();
        Some(frequencies.iter().sum::<f32>() / frequencies.len().max(1) as f32)
    }

    fn check_rest(&self) -> Result<(), Invalid> {
        for (list, neurons) in self.lists() {
            for (index, neuron) in neurons.iter().enumerate() {
                neuron.check().map_err(|error| error.inside(&format!("{list}[{index}]")))?;
            }
        }
        for (index, node) in self.nodes.iter().enumerate() {
            for (axis, input) in [("bend", &node.bend), ("twist", &node.twist)] {
                input.check().map_err(|error| error.inside(&format!("nodes[{index}].{axis}")))?;
            }
        }
        Ok(())
    }

    fn widen(&self, space: &mut GenomeSpace) {
        widen_weights(&mut space.network.weight_range, self);
    }

    fn hash_learned(&self, hash: &mut Xxh3Default) {
        for node in &self.nodes {
            hash.update(&[node.neurons.len() as u8]);
            node.neurons.iter().for_each(|neuron| neuron.hash(hash));
            hash.update(&node.bend.source.code());
            hash.update(&node.twist.source.code());
        }
        self.shared.iter().for_each(|neuron| neuron.hash(hash));
    }
}
