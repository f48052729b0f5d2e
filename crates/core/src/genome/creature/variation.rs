//! Children of creatures: mutated, crossed and grafted, in the order and by the operators of Sims (1994).

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::graph::{Graph, crossed, grafted};
use super::newborn::{new_connection, new_source};
use super::node::{BodySide, MOST_CONNECTIONS, MOST_COPIES, MOST_NODES, NodeJoint};
use crate::genome::controllers::{MOST_PART_NEURONS, PartNeuron};
use crate::genome::individual::Genome;
use crate::genome::space::GenomeSpace;
use crate::rng::{drawn, uniform};

/// Chance that a choice of a node, of a connection or of a neuron is drawn anew in a mutation.
const REDRAWN: f64 = 0.04;
/// Chance that a mutation adds a connection to a node, and that it removes a connection.
const CONNECTED: f64 = 0.08;
/// Chance that a mutation adds a neuron to a node, and that it removes a neuron.
const GROWN_NEURON: f64 = 0.05;
/// Factor on the chances and the steps of a mutation in a child of two parents.
const AFTER_MATING: f64 = 0.3;

/// The operator by which a creature is made from its parents.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CreatureChange {
    /// The creature is a mutant of one parent.
    Mutation,
    /// The creature has nodes of both parents in a row, switching between the parents.
    Crossover,
    /// A connection of the first parent leads to a node of the second parent, and to all that grows from it.
    Grafting,
}

impl CreatureChange {
    /// Draws an operator: 40 % mutation, 30 % crossover, 30 % grafting, as in Sims (1994).
    pub fn draw(rng: &mut ChaCha8Rng) -> Self {
        match uniform(rng) {
            share if share < 0.4 => Self::Mutation,
            share if share < 0.7 => Self::Crossover,
            _ => Self::Grafting,
        }
    }
}

fn chance(share: f64, rng: &mut ChaCha8Rng) -> bool {
    uniform(rng) < share
}

impl GenomeSpace {
    /// Returns a child of one or two creatures; `None` if the child cannot be built. Numbers take normally distributed steps with the
    /// standard deviation `step`, as a share of their ranges.
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
        // The number of joints is only known after the numbers have changed, so it is 0 until then.
        let genome = self.with_small_changes(&graph.into_genome(0), step * rate, rng);
        self.finished_creature(Graph::of(&genome))
    }

    /// Mutates everything that is not a number, at this share of the usual rates: first the parameters of nodes, then a new node to which
    /// connections may lead, then connections, and last the neurons.
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

#[cfg(test)]
mod tests {
    use super::super::check::check_creature;
    use super::super::repair::volume_m3;
    use super::*;
    use crate::genome::ControllerGenes;
    use crate::genome::controllers::PartSource;
    use crate::genome::creature::grow;
    use crate::genome::creature::newborn::tests::{SHAPE, space};
    use crate::rng::{Purpose, stream};

    #[test]
    fn every_creature_that_is_made_can_be_built_and_has_the_volume() {
        let space = space();
        let shape = SHAPE;
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
                let grown = grow(&genome.body.nodes);
                assert!((volume_m3(&grown) - 10.0).abs() < 0.01, "{}", volume_m3(&grown));
                space.check_genome(genome, shape).expect("of this space");
                assert_eq!(genome.controller.joints(), grown.len() - 1);
            }
        }
        // Bodies whose parts overlap are drawn again, so not every attempt gives a creature.
        assert!(made.iter().all(|count| *count > 60), "{made:?} of 300");
    }

    #[test]
    fn equal_streams_give_equal_creatures_and_others_differ() {
        let (space, shape) = (space(), SHAPE);
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
}
