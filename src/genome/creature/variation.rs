//! Creatures that are new, mutated, crossed and grafted, in the order and by the operators of Sims (1994).

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::growth::grow;
use super::node::{
    BodyNode, BodySide, Connection, MOST_CONNECTIONS, MOST_COPIES, MOST_NODES, NodeJoint,
};
use crate::genome::body::BodyGenes;
use crate::genome::controllers::{
    ControllerGenes, MOST_CREATURE_NEURONS, MOST_PART_NEURONS, NodeNeurons, PartInput, PartNeuron,
    PartNeurons, PartSense, PartSource,
};
use crate::genome::gene::GeneRange;
use crate::genome::individual::Genome;
use crate::genome::space::GenomeSpace;
use crate::rng::uniform;

/// Attempts to draw a creature that can be built, before a plain one takes its place.
const ATTEMPTS: usize = 100;
/// Largest number of parts that is drawn for a creature without parents; more can evolve.
const LARGEST_RANDOM: usize = 10;
/// Chance that a choice of a node, of a connection or of a neuron is drawn anew in a mutation.
const REDRAWN: f64 = 0.04;
/// Chance that a node gets another connection, and that a connection goes.
const CONNECTED: f64 = 0.08;
/// Chance that a node gets another neuron, and that a neuron goes.
const GROWN_NEURON: f64 = 0.05;
/// Share of these chances, and of the steps of numbers, in a child of two parents.
const AFTER_MATING: f64 = 0.3;

/// How a creature is made from its parents.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CreatureChange {
    /// Of one parent, with mutations.
    Mutation,
    /// Nodes of both parents in a row, switching between them.
    Crossover,
    /// A connection of the first parent leads to a node of the second, and all that grows from it.
    Grafting,
}

impl CreatureChange {
    /// Draws one: 40 % mutation, 30 % crossover, 30 % grafting, the shares of Sims (1994).
    pub fn draw(rng: &mut ChaCha8Rng) -> Self {
        match uniform(rng) {
            share if share < 0.4 => Self::Mutation,
            share if share < 0.7 => Self::Crossover,
            _ => Self::Grafting,
        }
    }
}

/// A node with its neurons.
#[derive(Debug, Clone)]
struct WholeNode {
    body: BodyNode,
    neurons: NodeNeurons,
}

/// A creature's graph, with bodies and neurons side by side.
#[derive(Debug, Clone)]
struct Graph {
    nodes: Vec<WholeNode>,
    shared: Vec<PartNeuron>,
}

fn chance(share: f64, rng: &mut ChaCha8Rng) -> bool {
    uniform(rng) < share
}

/// One of a list, all equally likely.
fn drawn<T: Copy>(all: &[T], rng: &mut ChaCha8Rng) -> T {
    all[rng.random_range(0..all.len())]
}

impl Graph {
    fn of(genome: &Genome) -> Self {
        let ControllerGenes::PartNeurons(genes) = &genome.controller else {
            return Self { nodes: Vec::new(), shared: Vec::new() };
        };
        let whole = |(body, neurons): (&BodyNode, &NodeNeurons)| WholeNode {
            body: body.clone(),
            neurons: neurons.clone(),
        };
        let nodes = genome.body.nodes.iter().zip(&genes.nodes).map(whole).collect();
        Self { nodes, shared: genes.shared.clone() }
    }

    fn into_genome(self) -> Genome {
        let (bodies, nodes): (Vec<_>, Vec<_>) =
            self.nodes.into_iter().map(|node| (node.body, node.neurons)).unzip();
        let joints = grow(&bodies).len().saturating_sub(1) as u32;
        let controller = PartNeurons { joints, nodes, shared: self.shared };
        Genome {
            body: BodyGenes::of_nodes(bodies),
            controller: ControllerGenes::PartNeurons(controller),
        }
    }

    /// Removes the nodes that no connection leads to from the first.
    fn remove_unreachable(&mut self) {
        let mut reached = vec![false; self.nodes.len()];
        let mut left = vec![0];
        while let Some(index) = left.pop() {
            let Some(node) = self.nodes.get(index) else { continue };
            if !std::mem::replace(&mut reached[index], true) {
                left.extend(node.body.connections.iter().map(|of| of.to as usize));
            }
        }
        let new_index: Vec<u32> = reached
            .iter()
            .scan(0, |next, reached| {
                let index = *next;
                *next += u32::from(*reached);
                Some(index)
            })
            .collect();
        let mut kept = reached.into_iter();
        self.nodes.retain(|_| kept.next().unwrap_or(false));
        for connection in self.nodes.iter_mut().flat_map(|node| &mut node.body.connections) {
            connection.to = new_index[connection.to as usize];
        }
    }
}

impl GenomeSpace {
    /// Whether genomes of this space are creatures.
    pub fn has_creatures(&self) -> bool {
        self.bodies.vary && self.controller == crate::genome::ControllerKind::PartNeurons
    }

    /// A random creature.
    pub(in crate::genome) fn random_creature(&self, rng: &mut ChaCha8Rng) -> Genome {
        // Small creatures lie apart more often than large ones, so the number of parts is drawn first.
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
            let Some(genome) = self.finished(Graph { nodes, shared }) else { continue };
            if genome.body.block_count() == wanted {
                return genome;
            }
            fallback = fallback.or(Some(genome));
        }
        fallback.unwrap_or_else(|| self.plain_creature(rng))
    }

    /// A straight creature of equal parts, as few as may be, which every space allows: a node that follows itself, and another at
    /// its end if its copies are too few.
    fn plain_creature(&self, rng: &mut ChaCha8Rng) -> Genome {
        let rear = |to| Connection {
            to,
            side: BodySide::Rear,
            place: [0.0; 2],
            turn_rad: [0.0; 3],
            scale: 1.0,
            is_mirrored: false,
            is_terminal: to > 0,
        };
        let parts = self.creatures.parts_min;
        let copies = [parts.min(MOST_COPIES), parts.saturating_sub(MOST_COPIES)];
        let mut nodes = Vec::new();
        for (index, copies) in copies.into_iter().enumerate().filter(|(_, copies)| *copies > 0) {
            let mut node = self.new_node(rng);
            (node.body.width_m, node.body.length_m, node.body.height_m) = (1.0, 1.0, 1.0);
            node.body.density_kg_m3 = self.density_min_kg_m3;
            node.body.copies = copies;
            node.body.connections.push(rear(0));
            if let Some(earlier) = nodes.last_mut() {
                let earlier: &mut WholeNode = earlier;
                earlier.body.connections.push(rear(1));
                node.body.connections[0] = Connection { is_terminal: false, ..rear(index as u32) };
            }
            nodes.push(node);
        }
        let mut bodies: Vec<_> = nodes.iter().map(|node| node.body.clone()).collect();
        self.repair_creature(&mut bodies);
        nodes.iter_mut().zip(bodies).for_each(|(node, body)| node.body = body);
        Graph { nodes, shared: Vec::new() }.into_genome()
    }

    /// A child of one or two creatures, or none if what was drawn cannot be built. Numbers take normally distributed steps of
    /// this standard deviation, as a share of their ranges.
    pub fn changed_creature(
        &self,
        [first, second]: [&Genome; 2],
        change: CreatureChange,
        step: f64,
        rng: &mut ChaCha8Rng,
    ) -> Option<Genome> {
        let parent = Graph::of(first);
        let (mut graph, rate) = match change {
            CreatureChange::Mutation => (parent, 1.0),
            CreatureChange::Crossover => (crossed(&parent, &Graph::of(second), rng), AFTER_MATING),
            CreatureChange::Grafting => (grafted(parent, &Graph::of(second), rng)?, AFTER_MATING),
        };
        // Half of the children keep their structure, so that a body has time to learn to move.
        if chance(0.5, rng) {
            self.mutate_graph(&mut graph, rate, rng);
            graph.remove_unreachable();
        }
        let genome = self.with_small_changes(&graph.into_genome(), step * rate, rng);
        self.finished(Graph::of(&genome))
    }

    /// The genome of a graph, repaired; none if it cannot be built.
    fn finished(&self, mut graph: Graph) -> Option<Genome> {
        graph.remove_unreachable();
        if graph.nodes.is_empty() || graph.nodes.len() > MOST_NODES {
            return None;
        }
        let mut bodies: Vec<_> = graph.nodes.iter().map(|node| node.body.clone()).collect();
        self.repair_creature(&mut bodies);
        let neurons: usize =
            grow(&bodies).iter().map(|part| graph.nodes[part.node].neurons.neurons.len()).sum();
        if neurons + graph.shared.len() > MOST_CREATURE_NEURONS || !self.allows_creature(&bodies) {
            return None;
        }
        graph.nodes.iter_mut().zip(bodies).for_each(|(node, body)| node.body = body);
        Some(graph.into_genome())
    }

    /// A new node without connections. Its neurons are wired at random, with a path to the joint (Miconi and Channon 2005).
    fn new_node(&self, rng: &mut ChaCha8Rng) -> WholeNode {
        let bodies = &self.bodies;
        let size = |[least, most]: [f32; 2], rng: &mut ChaCha8Rng| {
            GeneRange::Ratio(least, most).random(rng)
        };
        let thickness = [bodies.thickness_min_m, bodies.thickness_max_m];
        let body = BodyNode {
            length_m: size([bodies.length_min_m, bodies.length_max_m], rng),
            width_m: size(thickness, rng),
            height_m: size(thickness, rng),
            density_kg_m3: size([self.density_min_kg_m3, self.density_max_kg_m3], rng),
            joint: drawn(&NodeJoint::ALL[1..], rng),
            bend_limit_rad: GeneRange::Between(
                bodies.bend_limit_min_rad,
                bodies.bend_limit_max_rad,
            )
            .random(rng),
            twist_limit_rad: GeneRange::Between(
                bodies.twist_limit_min_rad,
                bodies.twist_limit_max_rad,
            )
            .random(rng),
            bend_start: GeneRange::Between(-1.0, 1.0).random(rng),
            twist_start: GeneRange::Between(-1.0, 1.0).random(rng),
            strength: GeneRange::Between(bodies.strength_min, 1.0).random(rng),
            copies: if chance(0.5, rng) { 1 } else { rng.random_range(2..=MOST_COPIES) },
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
        let most = self.network.weight_range;
        GeneRange::Between(-most, most).random(rng)
    }

    fn new_input(&self, rng: &mut ChaCha8Rng) -> PartInput {
        PartInput { source: new_source(rng), weight: self.new_weight(rng) }
    }

    /// A neuron of any function of the set.
    fn new_neuron(&self, rng: &mut ChaCha8Rng) -> PartNeuron {
        let function = drawn(self.creatures.neurons.functions(), rng);
        let mut neuron = PartNeuron { function, bias: 0.0, frequency_hz: None, inputs: Vec::new() };
        self.suit_inputs(&mut neuron, rng);
        neuron
    }

    /// An oscillator: every set of functions has one.
    fn new_oscillator(&self, rng: &mut ChaCha8Rng) -> PartNeuron {
        let all = self.creatures.neurons.functions().iter().copied();
        let oscillators: Vec<_> = all.filter(|function| function.oscillates()).collect();
        let mut neuron = self.new_neuron(rng);
        neuron.function = drawn(&oscillators, rng);
        neuron.bias = GeneRange::Between(-3.0, 3.0).random(rng);
        self.suit_inputs(&mut neuron, rng);
        // A steady beat to begin with.
        neuron.inputs.iter_mut().for_each(|input| input.weight = 0.0);
        neuron
    }

    /// Gives a neuron as many inputs as its function has, and a frequency if it oscillates.
    fn suit_inputs(&self, neuron: &mut PartNeuron, rng: &mut ChaCha8Rng) {
        neuron.inputs.truncate(neuron.function.inputs());
        while neuron.inputs.len() < neuron.function.inputs() {
            neuron.inputs.push(self.new_input(rng));
        }
        let frequencies = [self.wave.frequency_min_hz, self.wave.frequency_max_hz];
        neuron.frequency_hz = neuron.function.oscillates().then(|| {
            let [least, most] = frequencies;
            neuron.frequency_hz.unwrap_or_else(|| GeneRange::Ratio(least, most).random(rng))
        });
    }

    /// Mutates all that is not a number, at this share of the usual rates: first the parameters of nodes, then a new node that
    /// connections may lead to, then connections, and last the neurons.
    fn mutate_graph(&self, graph: &mut Graph, rate: f64, rng: &mut ChaCha8Rng) {
        for node in &mut graph.nodes {
            if chance(REDRAWN * rate, rng) {
                node.body.joint = drawn(&NodeJoint::ALL, rng);
            }
            if chance(REDRAWN * rate, rng) {
                let up = chance(0.5, rng);
                let copies = node.body.copies;
                let copies = if up { copies + 1 } else { copies.saturating_sub(1) };
                node.body.copies = copies.clamp(1, MOST_COPIES);
            }
        }
        if graph.nodes.len() < MOST_NODES {
            let node = self.new_node(rng);
            graph.nodes.push(node);
        }
        let count = graph.nodes.len();
        for node in &mut graph.nodes {
            let connections = &mut node.body.connections;
            for connection in connections.iter_mut() {
                if chance(REDRAWN * rate, rng) {
                    connection.to = rng.random_range(0..count) as u32;
                }
                if chance(REDRAWN * rate, rng) {
                    connection.side = drawn(&BodySide::ALL, rng);
                }
                if chance(REDRAWN * rate, rng) {
                    connection.is_mirrored = !connection.is_mirrored;
                }
                if chance(REDRAWN * rate, rng) {
                    connection.is_terminal = !connection.is_terminal;
                }
            }
            connections.retain(|_| !chance(CONNECTED * rate, rng));
            if connections.len() < MOST_CONNECTIONS && chance(CONNECTED * rate, rng) {
                connections.push(new_connection(count, rng));
            }
        }
        for node in &mut graph.nodes {
            let of_node = &mut node.neurons;
            self.mutate_neurons(&mut of_node.neurons, rate, rng);
            for effector in [&mut of_node.bend, &mut of_node.twist] {
                if chance(REDRAWN * rate, rng) {
                    effector.source = new_source(rng);
                }
            }
        }
        self.mutate_neurons(&mut graph.shared, rate, rng);
    }

    fn mutate_neurons(&self, neurons: &mut Vec<PartNeuron>, rate: f64, rng: &mut ChaCha8Rng) {
        for neuron in neurons.iter_mut() {
            if chance(REDRAWN * rate, rng) {
                neuron.function = drawn(self.creatures.neurons.functions(), rng);
                self.suit_inputs(neuron, rng);
            }
            for input in &mut neuron.inputs {
                if chance(REDRAWN * rate, rng) {
                    input.source = new_source(rng);
                }
            }
        }
        neurons.retain(|_| !chance(GROWN_NEURON * rate, rng));
        if neurons.len() < MOST_PART_NEURONS && chance(GROWN_NEURON * rate, rng) {
            neurons.push(self.new_neuron(rng));
        }
    }
}

/// A connection to any of this many nodes.
fn new_connection(nodes: usize, rng: &mut ChaCha8Rng) -> Connection {
    let mut within = |most: f32| GeneRange::Between(-most, most).random(rng);
    let (place, turn_rad) = ([within(1.0), within(1.0)], [within(0.6), within(0.6), within(0.6)]);
    Connection {
        to: rng.random_range(0..nodes) as u32,
        side: drawn(&BodySide::ALL, rng),
        place,
        turn_rad,
        scale: GeneRange::Ratio(0.7, 1.2).random(rng),
        is_mirrored: chance(0.4, rng),
        is_terminal: chance(0.1, rng),
    }
}

/// A source of any kind: the kinds are equally likely.
fn new_source(rng: &mut ChaCha8Rng) -> PartSource {
    let index = rng.random_range(0..MOST_PART_NEURONS as u8);
    match rng.random_range(0..5) {
        0 => PartSource::Sense(drawn(&PartSense::ALL, rng)),
        1 => PartSource::Own(index),
        2 => PartSource::Parent(index),
        3 => PartSource::Children(index),
        _ => PartSource::Shared(index),
    }
}

/// The nodes of both parents in a row, from the first up to a place, from the second up to another, and from the first again.
/// Connections beyond the nodes that there are lead to random ones.
fn crossed(first: &Graph, second: &Graph, rng: &mut ChaCha8Rng) -> Graph {
    let longest = first.nodes.len().max(second.nodes.len());
    let (a, b) = (rng.random_range(0..=longest), rng.random_range(0..=longest));
    let (from, to) = (a.min(b), a.max(b));
    let source = |index: usize| if (from..to).contains(&index) { second } else { first };
    let mut nodes: Vec<WholeNode> =
        (0..longest).map_while(|index| source(index).nodes.get(index).cloned()).collect();
    let count = nodes.len();
    for connection in nodes.iter_mut().flat_map(|node| &mut node.body.connections) {
        if connection.to as usize >= count {
            connection.to = rng.random_range(0..count.max(1)) as u32;
        }
    }
    let shared = if chance(0.5, rng) { first } else { second }.shared.clone();
    Graph { nodes, shared }
}

/// The first parent, of which one connection leads to a node of the second. None if it has no connection, or if the nodes of
/// both would be too many.
fn grafted(mut graph: Graph, second: &Graph, rng: &mut ChaCha8Rng) -> Option<Graph> {
    let offset = graph.nodes.len() as u32;
    let all: Vec<(usize, usize)> = graph
        .nodes
        .iter()
        .enumerate()
        .flat_map(|(node, of)| (0..of.body.connections.len()).map(move |place| (node, place)))
        .collect();
    if all.is_empty() || second.nodes.is_empty() {
        return None;
    }
    let (node, place) = drawn(&all, rng);
    let target = rng.random_range(0..second.nodes.len()) as u32;
    graph.nodes[node].body.connections[place].to = offset + target;
    graph.nodes.extend(second.nodes.iter().cloned().map(|mut node| {
        node.body.connections.iter_mut().for_each(|connection| connection.to += offset);
        node
    }));
    graph.remove_unreachable();
    (graph.nodes.len() <= MOST_NODES).then_some(graph)
}

#[cfg(test)]
mod tests {
    use super::super::check::check_creature;
    use super::*;
    use crate::genome::{ControllerKind, GenomeShape};
    use crate::rng::{Purpose, stream};

    fn space() -> GenomeSpace {
        let controller = ControllerKind::PartNeurons;
        let mut space = GenomeSpace { controller, ..GenomeSpace::default() };
        space.bodies.vary = true;
        space
    }

    fn volume_m3(genome: &Genome) -> f64 {
        let parts = grow(&genome.body.nodes);
        parts.iter().map(|part| part.size_m.into_iter().map(f64::from).product::<f64>()).sum()
    }

    #[test]
    fn every_creature_that_is_made_can_be_built_and_has_the_volume() {
        let space = space();
        let shape = GenomeShape { joints: 4, duration_s: 15.0 };
        let mut made = [0; 3];
        for seed in 0..300 {
            let mut rng = stream(seed, 1, 0, Purpose::Birth);
            let [first, second] = [(), ()].map(|()| space.random_genome(shape, &mut rng));
            let changes =
                [CreatureChange::Mutation, CreatureChange::Crossover, CreatureChange::Grafting];
            let children = changes.into_iter().enumerate().filter_map(|(index, change)| {
                let child = space.changed_creature([&first, &second], change, 0.1, &mut rng);
                made[index] += usize::from(child.is_some());
                child
            });
            for genome in children.collect::<Vec<_>>().iter().chain([&first, &second]) {
                check_creature(&genome.body.nodes).expect("it can be built");
                genome.controller.check().expect("its neurons can be wired");
                assert!((volume_m3(genome) - 10.0).abs() < 0.01, "{}", volume_m3(genome));
                space.check_genome(genome, shape).expect("of this space");
                let joints = grow(&genome.body.nodes).len() - 1;
                assert_eq!(genome.controller.joints(), joints);
            }
        }
        // Bodies whose parts lie in each other are drawn again.
        assert!(made.iter().all(|count| *count > 60), "{made:?} of 300");
    }

    #[test]
    fn a_plain_creature_has_the_least_number_of_parts() {
        for parts in 2..=7 {
            let mut space = space();
            space.creatures.parts_min = parts;
            let genome = space.plain_creature(&mut stream(1, 1, 0, Purpose::Birth));
            let shape = GenomeShape { joints: 4, duration_s: 15.0 };
            space.check_genome(&genome, shape).expect("of this space");
            assert_eq!(grow(&genome.body.nodes).len(), parts as usize);
        }
    }

    #[test]
    fn creatures_differ_in_their_numbers_of_parts() {
        let (space, shape) = (space(), GenomeShape { joints: 4, duration_s: 15.0 });
        let mut counts = [0; 17];
        for seed in 0..400 {
            let genome = space.random_genome(shape, &mut stream(seed, 1, 0, Purpose::Birth));
            counts[grow(&genome.body.nodes).len()] += 1;
        }
        // Many trees of many parts lie in themselves.
        assert!(counts[2..8].iter().all(|count| *count > 15), "{counts:?}");
    }

    #[test]
    fn equal_streams_give_equal_creatures_and_others_differ() {
        let (space, shape) = (space(), GenomeShape { joints: 4, duration_s: 15.0 });
        let genome = |seed| space.random_genome(shape, &mut stream(seed, 1, 0, Purpose::Birth));
        assert_eq!(genome(1), genome(1));
        assert_eq!(genome(1).hash(), genome(1).hash());
        let mut other = genome(1);
        other.body.nodes[0].copies ^= 1;
        assert_ne!(other.hash(), genome(1).hash());
        let mut rewired = genome(1);
        let ControllerGenes::PartNeurons(genes) = &mut rewired.controller else {
            panic!("neurons")
        };
        genes.nodes[0].bend.source = PartSource::Shared(9);
        assert_ne!(rewired.hash(), genome(1).hash());
    }

    #[test]
    fn a_graft_brings_the_nodes_of_the_other_parent() {
        let (space, shape) = (space(), GenomeShape { joints: 4, duration_s: 15.0 });
        let mut rng = stream(5, 1, 0, Purpose::Birth);
        let mut marked = 0;
        for _ in 0..100 {
            let [first, mut second] = [(), ()].map(|()| space.random_genome(shape, &mut rng));
            second.body.nodes.iter_mut().for_each(|node| node.strength = 0.777);
            let Some(graph) = grafted(Graph::of(&first), &Graph::of(&second), &mut rng) else {
                continue;
            };
            marked += usize::from(graph.nodes.iter().any(|node| node.body.strength == 0.777));
            let count = graph.nodes.len() as u32;
            let all = graph.nodes.iter().flat_map(|node| &node.body.connections);
            assert!(all.into_iter().all(|connection| connection.to < count));
        }
        assert!(marked > 80, "{marked}");
    }
}
