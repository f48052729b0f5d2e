//! Creatures without parents, and the nodes, connections and neurons of which they are made.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::graph::{Graph, WholeNode};
use super::growth::{GrownPart, grow};
use super::node::{BodyNode, BodySide, Connection, MOST_COPIES, MOST_NODES, NodeJoint};
use crate::genome::controllers::{
    MOST_CREATURE_NEURONS, MOST_PART_NEURONS, NodeNeurons, PartInput, PartNeuron, PartSense,
    PartSource,
};
use crate::genome::gene::GeneRange;
use crate::genome::individual::Genome;
use crate::genome::space::GenomeSpace;
use crate::rng::{drawn, uniform};

/// Number of attempts to draw a creature that can be built, before a plain creature takes its place.
const ATTEMPTS: usize = 100;
/// Largest number of parts that is drawn for a creature without parents. Evolution can add more.
const LARGEST_RANDOM: usize = 10;

impl GenomeSpace {
    /// Draws a random creature.
    pub(in crate::genome) fn random_creature(&self, rng: &mut ChaCha8Rng) -> Genome {
        // Parts of small creatures overlap less often than those of large ones. The number of parts is therefore drawn first, so that
        // large creatures are not rare.
        let parts = self.creatures.parts();
        let wanted = rng.random_range(*parts.start()..=(*parts.end()).min(LARGEST_RANDOM));
        let mut fallback = None;
        for _ in 0..ATTEMPTS {
            let count = rng.random_range(1..=3);
            let mut nodes: Vec<_> = (0..count).map(|_| self.new_node(rng)).collect();
            for node in &mut nodes {
                for _ in 0..rng.random_range(1..=2) {
                    node.body.connections.push(new_connection(count, rng));
                }
            }
            let shared = vec![self.new_oscillator(rng)];
            let Some(genome) = self.finished_creature(Graph { nodes, shared }) else { continue };
            if genome.controller.joints() + 1 == wanted {
                return genome;
            }
            fallback = fallback.or(Some(genome));
        }
        fallback.unwrap_or_else(|| self.plain_creature(rng))
    }

    /// Returns a straight creature of equal parts, as few as possible, which every space allows: a node that follows itself, and another
    /// node at its end if its copies are too few.
    fn plain_creature(&self, rng: &mut ChaCha8Rng) -> Genome {
        let rear = |to, is_terminal| Connection {
            to,
            side: BodySide::Rear,
            place: [0.0; 2],
            turn_rad: [0.0; 3],
            scale: 1.0,
            is_mirrored: false,
            is_terminal,
        };
        let parts = self.creatures.parts_min;
        let copies = [parts.min(MOST_COPIES), parts.saturating_sub(MOST_COPIES)];
        let copies = copies.into_iter().filter(|copies| *copies > 0);
        let node = |(index, copies): (u32, u32)| {
            let mut node = self.new_node(rng);
            (node.body.width_m, node.body.length_m, node.body.height_m) = (1.0, 1.0, 1.0);
            node.body.density_kg_m3 = self.density_min_kg_m3;
            node.body.copies = copies;
            node.body.connections = vec![rear(index, false)];
            node
        };
        let mut nodes: Vec<_> = (0..).zip(copies).map(node).collect();
        if nodes.len() > 1 {
            nodes[0].body.connections.push(rear(1, true));
        }
        let mut graph = Graph { nodes, shared: Vec::new() };
        let mut bodies = graph.bodies();
        self.repair_creature(&mut bodies);
        graph.take_bodies(bodies);
        graph.into_genome(parts as usize)
    }

    /// Repairs a graph and converts it to a creature; `None` if it cannot be built.
    pub(super) fn finished_creature(&self, mut graph: Graph) -> Option<Genome> {
        graph.remove_unreachable();
        if graph.nodes.is_empty() || graph.nodes.len() > MOST_NODES {
            return None;
        }
        let mut bodies = graph.bodies();
        self.repair_creature(&mut bodies);
        let grown = grow(&bodies);
        let of_part = |part: &GrownPart| graph.nodes[part.node].neurons.neurons.len();
        let neurons = grown.iter().map(of_part).sum::<usize>() + graph.shared.len();
        if neurons > MOST_CREATURE_NEURONS || !self.allows_creature(&bodies, &grown) {
            return None;
        }
        graph.take_bodies(bodies);
        Some(graph.into_genome(grown.len()))
    }

    /// Draws a node without connections. Its neurons are wired at random, with a path to the joint (Miconi and Channon 2005).
    pub(super) fn new_node(&self, rng: &mut ChaCha8Rng) -> WholeNode {
        let bodies = &self.bodies;
        let sided = GeneRange::around_zero(1.0);
        let body = BodyNode {
            length_m: bodies.lengths().random(rng),
            width_m: bodies.thicknesses().random(rng),
            height_m: bodies.thicknesses().random(rng),
            density_kg_m3: self.densities().random(rng),
            joint: drawn(&NodeJoint::ALL[1..], rng),
            bend_limit_rad: bodies.bend_limits().random(rng),
            twist_limit_rad: bodies.twist_limits().random(rng),
            bend_start: sided.random(rng),
            twist_start: sided.random(rng),
            strength: bodies.strengths().random(rng),
            copies: if uniform(rng) < 0.5 { 1 } else { rng.random_range(2..=MOST_COPIES) },
            connections: Vec::new(),
        };
        let neurons = vec![self.new_oscillator(rng), self.new_neuron(rng)];
        let effector = |rng: &mut ChaCha8Rng| PartInput {
            source: PartSource::Own(rng.random_range(0..2)),
            weight: self.new_weight(rng),
        };
        let (bend, twist) = (effector(rng), effector(rng));
        WholeNode { body, neurons: NodeNeurons { neurons, bend, twist } }
    }

    fn new_weight(&self, rng: &mut ChaCha8Rng) -> f32 {
        self.network.weights().random(rng)
    }

    fn new_input(&self, rng: &mut ChaCha8Rng) -> PartInput {
        PartInput { source: new_source(rng), weight: self.new_weight(rng) }
    }

    /// Draws a neuron with any function of the set.
    pub(super) fn new_neuron(&self, rng: &mut ChaCha8Rng) -> PartNeuron {
        let function = drawn(self.creatures.neurons.functions(), rng);
        let mut neuron = PartNeuron { function, bias: 0.0, frequency_hz: None, inputs: Vec::new() };
        self.suit_inputs(&mut neuron, rng);
        neuron
    }

    /// Draws an oscillator. Every set of functions has one.
    fn new_oscillator(&self, rng: &mut ChaCha8Rng) -> PartNeuron {
        let all = self.creatures.neurons.functions().iter().copied();
        let oscillators: Vec<_> = all.filter(|function| function.oscillates()).collect();
        let mut neuron = self.new_neuron(rng);
        neuron.function = drawn(&oscillators, rng);
        neuron.bias = GeneRange::around_zero(3.0).random(rng);
        self.suit_inputs(&mut neuron, rng);
        // Weights of 0 give it a steady beat to begin with.
        neuron.inputs.iter_mut().for_each(|input| input.weight = 0.0);
        neuron
    }

    /// Gives a neuron as many inputs as its function has, and a frequency if it oscillates.
    pub(super) fn suit_inputs(&self, neuron: &mut PartNeuron, rng: &mut ChaCha8Rng) {
        neuron.inputs.truncate(neuron.function.inputs());
        while neuron.inputs.len() < neuron.function.inputs() {
            neuron.inputs.push(self.new_input(rng));
        }
        let range = GeneRange::Ratio(self.wave.frequency_min_hz, self.wave.frequency_max_hz);
        let frequency_hz = neuron.frequency_hz;
        neuron.frequency_hz =
            neuron.function.oscillates().then(|| frequency_hz.unwrap_or_else(|| range.random(rng)));
    }
}

/// Draws a connection to any of this many nodes.
pub fn new_connection(nodes: usize, rng: &mut ChaCha8Rng) -> Connection {
    let mut within = |most: f32| GeneRange::around_zero(most).random(rng);
    let (place, turn_rad) = ([within(1.0), within(1.0)], [within(0.6), within(0.6), within(0.6)]);
    Connection {
        to: rng.random_range(0..nodes) as u32,
        side: drawn(&BodySide::ALL, rng),
        place,
        turn_rad,
        scale: GeneRange::Ratio(0.7, 1.2).random(rng),
        is_mirrored: uniform(rng) < 0.4,
        is_terminal: uniform(rng) < 0.1,
    }
}

/// Draws a source. The kinds of sources are equally likely.
pub fn new_source(rng: &mut ChaCha8Rng) -> PartSource {
    let index = rng.random_range(0..MOST_PART_NEURONS as u8);
    match rng.random_range(0..5) {
        0 => PartSource::Sense(drawn(&PartSense::ALL, rng)),
        1 => PartSource::Own(index),
        2 => PartSource::Parent(index),
        3 => PartSource::Children(index),
        _ => PartSource::Shared(index),
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::genome::{ControllerKind, GenomeShape};
    use crate::rng::{Purpose, stream};

    pub const SHAPE: GenomeShape = GenomeShape { joints: 4, duration_s: 15.0 };

    /// Returns a space of creatures.
    pub fn space() -> GenomeSpace {
        let controller = ControllerKind::PartNeurons;
        let mut space = GenomeSpace { controller, ..GenomeSpace::default() };
        space.bodies.vary = true;
        space
    }

    #[test]
    fn a_plain_creature_has_the_least_number_of_parts() {
        for parts in 2..=7 {
            let mut space = space();
            space.creatures.parts_min = parts;
            let genome = space.plain_creature(&mut stream(1, 1, 0, Purpose::Birth));
            space.check_genome(&genome, SHAPE).expect("of this space");
            assert_eq!(grow(&genome.body.nodes).len(), parts as usize);
        }
    }

    #[test]
    fn creatures_differ_in_their_numbers_of_parts() {
        let (space, shape) = (space(), SHAPE);
        let mut counts = [0; 17];
        for seed in 0..400 {
            let genome = space.random_genome(shape, &mut stream(seed, 1, 0, Purpose::Birth));
            counts[grow(&genome.body.nodes).len()] += 1;
        }
        // Creatures with many parts are rarer, because many of their trees overlap themselves.
        assert!(counts[2..8].iter().all(|count| *count > 15), "{counts:?}");
    }
}
