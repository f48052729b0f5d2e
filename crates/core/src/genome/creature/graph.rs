//! A creature's graph with its neurons, and the combination of the graphs of two parents.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::node::{BodyNode, MOST_NODES};
use crate::genome::body::BodyGenes;
use crate::genome::controllers::{ControllerGenes, NodeNeurons, PartNeuron, PartNeurons};
use crate::genome::individual::Genome;
use crate::rng::{drawn, uniform};

/// A node of the graph: the plan of a part, with the part's neurons.
#[derive(Debug, Clone)]
pub struct WholeNode {
    /// Plan of the node's part.
    pub body: BodyNode,
    /// Neurons of the node's part.
    pub neurons: NodeNeurons,
}

/// A creature's graph, with body and neurons of each node side by side.
#[derive(Debug, Clone)]
pub struct Graph {
    /// Nodes of the graph. Growth begins with the first one.
    pub nodes: Vec<WholeNode>,
    /// Neurons that belong to no part.
    pub shared: Vec<PartNeuron>,
}

impl Graph {
    /// Extracts the graph of a creature; empty for other genomes.
    pub fn of(genome: &Genome) -> Self {
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

    /// Converts the graph to the genome of a creature. `parts` is the number of parts that grow from the graph.
    pub fn into_genome(self, parts: usize) -> Genome {
        let (bodies, nodes): (Vec<_>, Vec<_>) =
            self.nodes.into_iter().map(|node| (node.body, node.neurons)).unzip();
        let joints = parts.saturating_sub(1) as u32;
        let controller = PartNeurons { joints, nodes, shared: self.shared };
        Genome {
            body: BodyGenes::of_nodes(bodies),
            controller: ControllerGenes::PartNeurons(controller),
        }
    }

    /// Removes the nodes that cannot be reached by connections from the first node.
    pub fn remove_unreachable(&mut self) {
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

    /// Returns the plans of the parts of all nodes.
    pub fn bodies(&self) -> Vec<BodyNode> {
        self.nodes.iter().map(|node| node.body.clone()).collect()
    }

    /// Replaces the plans of the parts of all nodes of the graph.
    pub fn take_bodies(&mut self, bodies: Vec<BodyNode>) {
        self.nodes.iter_mut().zip(bodies).for_each(|(node, body)| node.body = body);
    }
}

/// Crosses two graphs over. The nodes come from the first parent up to one place, from the second up to another, and then from the first
/// again. Connections to nodes that do not exist lead to random nodes instead.
pub fn crossed(first: &Graph, second: &Graph, rng: &mut ChaCha8Rng) -> Graph {
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
    let shared = if uniform(rng) < 0.5 { first } else { second }.shared.clone();
    Graph { nodes, shared }
}

/// Grafts the second graph onto the first: one connection of the first leads to a node of the second. `None` if the first graph has no
/// connection, or if both together have too many nodes.
pub fn grafted(mut graph: Graph, second: &Graph, rng: &mut ChaCha8Rng) -> Option<Graph> {
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
    use super::*;
    use crate::genome::creature::newborn::tests::{SHAPE, space};
    use crate::rng::{Purpose, stream};

    #[test]
    fn a_graft_brings_the_nodes_of_the_other_parent() {
        let (space, shape) = (space(), SHAPE);
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
