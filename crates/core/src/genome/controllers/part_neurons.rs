//! Neurons in the parts of a creature: a small graph in each node of its body, which grows with the node.

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3Default;

use super::encoding::{ControllerEncoding, ControllerInfo};
use super::neuron_function::NeuronFunction;
use crate::check::{Invalid, within};
use crate::genome::creature::MOST_NODES;
use crate::genome::gene::{Gene, GeneRange, GeneVisitor, GenomeShape};
use crate::genome::network_space::WEIGHT_RANGE;
use crate::genome::space::GenomeSpace;
use crate::genome::wave_space::FREQUENCY_RANGE_HZ;

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
    /// The neurons of each node of the body's graph.
    pub nodes: Vec<NodeNeurons>,
    /// Neurons that belong to no part, and that every neuron may read.
    pub shared: Vec<PartNeuron>,
}

/// The neurons that each part of a node has, and the inputs that drive its joint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NodeNeurons {
    /// The neurons.
    pub neurons: Vec<PartNeuron>,
    /// Share of the greatest torque about the bend axis.
    pub bend: PartInput,
    /// Share of the greatest torque about the twist axis.
    pub twist: PartInput,
}

/// A neuron.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartNeuron {
    /// Its function.
    pub function: NeuronFunction,
    /// Added to its first input.
    pub bias: f32,
    /// Frequency of an oscillator, in Hz; none of other neurons.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frequency_hz: Option<f32>,
    /// Its inputs, as many as the function has.
    pub inputs: Vec<PartInput>,
}

/// A weighted input.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartInput {
    /// The value that it reads.
    pub source: PartSource,
    /// Its factor.
    pub weight: f32,
}

/// A value that an input can read. The number of a neuron counts from 0; where there are fewer neurons it starts again from the first,
/// and without any the value is 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PartSource {
    /// A sense of the part.
    Sense(PartSense),
    /// A neuron of the same part.
    Own(u8),
    /// A neuron of the part that it has grown from.
    Parent(u8),
    /// The mean of a neuron of all parts that grow from it.
    Children(u8),
    /// A neuron that belongs to no part.
    Shared(u8),
}

/// A sense of a part: see the catalogue of senses in `control`. Those of a joint are of the joint that holds the part; the
/// first part has none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[expect(missing_docs, reason = "the catalogue of senses describes them")]
pub enum PartSense {
    Bend,
    Twist,
    BendRate,
    TwistRate,
    Touch,
    Load,
    Blocked,
    Pitch,
    Roll,
    Gap,
    StepUp,
    Yaw,
}

impl PartSense {
    /// All of them.
    pub const ALL: [Self; 12] = [
        Self::Bend,
        Self::Twist,
        Self::BendRate,
        Self::TwistRate,
        Self::Touch,
        Self::Load,
        Self::Blocked,
        Self::Pitch,
        Self::Roll,
        Self::Gap,
        Self::StepUp,
        Self::Yaw,
    ];
}

impl PartSource {
    /// The number of its neuron; none of a sense.
    fn neuron(self) -> Option<u8> {
        match self {
            Self::Sense(_) => None,
            Self::Own(index)
            | Self::Parent(index)
            | Self::Children(index)
            | Self::Shared(index) => Some(index),
        }
    }

    /// The bytes that stand for it in a hash.
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
        within("weight", self.weight, WEIGHT_RANGE)?;
        let most = MOST_PART_NEURONS as u8 - 1;
        self.source.neuron().map_or(Ok(()), |index| within("source", index, 0..=most))
    }

    fn gene(
        &mut self,
        field: std::fmt::Arguments<'_>,
        name: std::fmt::Arguments<'_>,
        space: &GenomeSpace,
        visit: GeneVisitor<'_>,
    ) {
        let field = format_args!("{field}.weight");
        let range = space.network.weights();
        visit(Gene { field, name, unit: "", range }, &mut self.weight);
    }
}

impl PartNeuron {
    fn check(&self) -> Result<(), Invalid> {
        within("bias", self.bias, WEIGHT_RANGE)?;
        let inputs = self.function.inputs();
        within("inputs", self.inputs.len(), inputs..=inputs)?;
        for (index, input) in self.inputs.iter().enumerate() {
            input.check().map_err(|error| error.inside(&format!("inputs[{index}]")))?;
        }
        match self.frequency_hz {
            Some(frequency_hz) if self.function.oscillates() => {
                within("frequency_hz", frequency_hz, FREQUENCY_RANGE_HZ)
            }
            None if !self.function.oscillates() => Ok(()),
            Some(frequency_hz) => Err(Invalid::new(
                "frequency_hz",
                frequency_hz,
                "none: this neuron does not oscillate",
            )),
            None => {
                Err(Invalid::new("frequency_hz", "not given", "the frequency of an oscillator"))
            }
        }
    }

    fn genes(
        &mut self,
        field: std::fmt::Arguments<'_>,
        name: std::fmt::Arguments<'_>,
        space: &GenomeSpace,
        visit: GeneVisitor<'_>,
    ) {
        let gene = Gene {
            field: format_args!("{field}.bias"),
            name: format_args!("{name}, bias"),
            unit: "",
            range: space.network.weights(),
        };
        visit(gene, &mut self.bias);
        if let Some(frequency_hz) = &mut self.frequency_hz {
            let gene = Gene {
                field: format_args!("{field}.frequency_hz"),
                name: format_args!("{name}, frequency"),
                unit: "Hz",
                range: GeneRange::Ratio(space.wave.frequency_min_hz, space.wave.frequency_max_hz),
            };
            visit(gene, frequency_hz);
        }
        for (index, input) in self.inputs.iter_mut().enumerate() {
            let field = format_args!("{field}.inputs[{index}]");
            input.gene(field, format_args!("{name}, weight {}", index + 1), space, visit);
        }
    }

    fn hash(&self, hash: &mut Xxh3Default) {
        hash.update(&[self.function as u8, self.inputs.len() as u8]);
        self.inputs.iter().for_each(|input| hash.update(&input.source.code()));
    }
}

/// Checks a list of neurons, which a message calls by this name.
fn check_neurons(name: &str, neurons: &[PartNeuron]) -> Result<(), Invalid> {
    within(name, neurons.len(), 0..=MOST_PART_NEURONS)?;
    neurons.iter().enumerate().try_for_each(|(index, neuron)| {
        neuron.check().map_err(|error| error.inside(&format!("{name}[{index}]")))
    })
}

impl NodeNeurons {
    fn check(&self) -> Result<(), Invalid> {
        check_neurons("neurons", &self.neurons)?;
        self.bend.check().map_err(|error| error.inside("bend"))?;
        self.twist.check().map_err(|error| error.inside("twist"))
    }
}

impl PartNeurons {
    /// All neurons, those of the nodes first.
    fn all(&self) -> impl Iterator<Item = &PartNeuron> {
        self.nodes.iter().flat_map(|node| &node.neurons).chain(&self.shared)
    }

    fn weights(&self) -> impl Iterator<Item = f32> {
        let of_neurons = self
            .all()
            .flat_map(|neuron| neuron.inputs.iter().map(|input| input.weight).chain([neuron.bias]));
        of_neurons.chain(self.nodes.iter().flat_map(|node| [node.bend.weight, node.twist.weight]))
    }
}

impl ControllerEncoding for PartNeurons {
    fn info() -> &'static ControllerInfo {
        &ControllerInfo {
            name: "part_neurons",
            title: "Part neurons",
            words: "Neurons in each part of a branching body, which grow with the part.",
            senses_surroundings: true,
            settings: &[
                "creatures.parts_min",
                "creatures.parts_max",
                "creatures.neurons",
                "network.weight_range",
                "wave.frequency_min_hz",
                "wave.frequency_max_hz",
            ],
        }
    }

    fn zeroed(_: &GenomeSpace, shape: GenomeShape) -> Self {
        Self { joints: shape.joints as u32, nodes: Vec::new(), shared: Vec::new() }
    }

    fn genes(&mut self, space: &GenomeSpace, visit: GeneVisitor<'_>) {
        for (node, of_node) in self.nodes.iter_mut().enumerate() {
            for (index, neuron) in of_node.neurons.iter_mut().enumerate() {
                let field = format_args!("nodes[{node}].neurons[{index}]");
                let name = format_args!("node {}, neuron {}", node + 1, index + 1);
                neuron.genes(field, name, space, visit);
            }
            let field = format_args!("nodes[{node}].bend");
            let name = format_args!("node {}, bend weight", node + 1);
            of_node.bend.gene(field, name, space, visit);
            let field = format_args!("nodes[{node}].twist");
            let name = format_args!("node {}, twist weight", node + 1);
            of_node.twist.gene(field, name, space, visit);
        }
        for (index, neuron) in self.shared.iter_mut().enumerate() {
            let field = format_args!("shared[{index}]");
            neuron.genes(field, format_args!("shared neuron {}", index + 1), space, visit);
        }
    }

    fn joints(&self) -> usize {
        self.joints as usize
    }

    /// The mean of its oscillators; 0 without one.
    fn frequency_hz(&self) -> f32 {
        let frequencies: Vec<f32> = self.all().filter_map(|neuron| neuron.frequency_hz).collect();
        frequencies.iter().sum::<f32>() / frequencies.len().max(1) as f32
    }

    fn check(&self) -> Result<(), Invalid> {
        let inside = |error: Invalid| error.inside("part_neurons");
        within("nodes", self.nodes.len(), 0..=MOST_NODES).map_err(inside)?;
        check_neurons("shared", &self.shared).map_err(inside)?;
        self.nodes.iter().enumerate().try_for_each(|(index, node)| {
            node.check().map_err(|error| inside(error.inside(&format!("nodes[{index}]"))))
        })
    }

    fn lengths(&self, visit: &mut dyn FnMut(&'static str, usize)) {
        visit("nodes with neurons", self.nodes.len());
    }

    fn widen(&self, space: &mut GenomeSpace) {
        let network = &mut space.network;
        network.weight_range = self.weights().map(f32::abs).fold(network.weight_range, f32::max);
        for frequency_hz in self.all().filter_map(|neuron| neuron.frequency_hz) {
            space.wave.widen_frequency(frequency_hz);
        }
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
