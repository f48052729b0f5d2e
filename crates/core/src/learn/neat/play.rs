//! The computation of a network's outputs.

use super::genome::NetworkGenome;

/// Steepness of the activation 1 / (1 + exp(-4.9 x)) of Stanley & Miikkulainen 2002.
pub const STEEPNESS: f64 = 4.9;

/// A network with the activations of its nodes.
///
/// In each tick every node is computed from the inputs of this tick and the values of the other nodes in the last tick. Cycles are
/// therefore allowed, and the order of nodes does not matter. A signal through d links needs d ticks.
#[derive(Debug, Clone, PartialEq)]
pub struct NetworkPlay {
    inputs: usize,
    outputs: usize,
    /// Ids of all nodes, in ascending order: inputs, outputs, hidden nodes.
    nodes: Vec<u32>,
    /// For each node that is not an input, the index of its first link in `sources`, and at the end the length of `sources`.
    starts: Vec<usize>,
    /// The enabled links, ordered by the node where they end and then by innovation number: the index of the node where they begin, and
    /// the weight.
    sources: Vec<(usize, f64)>,
    /// Activation of each node.
    values: Vec<f64>,
    /// Memory for the next activations of the nodes that are not inputs.
    next: Vec<f64>,
}

impl NetworkPlay {
    /// Builds the network of a genome, with all activations 0.
    pub fn new(genome: &NetworkGenome) -> Self {
        let mut nodes: Vec<u32> = (0..genome.first_hidden()).collect();
        nodes.extend(genome.hidden());
        let inputs = usize::from(genome.inputs);
        let (mut starts, mut sources) = (vec![0], Vec::new());
        // The links are sorted by their end. The sort is stable, so links into the same node stay in order.
        let mut links: Vec<_> = genome.links.iter().filter(|link| link.enabled).collect();
        links.sort_by_key(|link| link.to);
        let mut links = links.into_iter().skip_while(|link| link.to < u32::from(genome.inputs));
        let mut waiting = links.next();
        for &node in nodes.iter().skip(inputs) {
            while let Some(link) = waiting.filter(|link| link.to == node) {
                // The node where a link begins is always among the nodes.
                if let Ok(from) = nodes.binary_search(&link.from) {
                    sources.push((from, f64::from(link.weight)));
                }
                waiting = links.next();
            }
            starts.push(sources.len());
        }
        Self {
            inputs,
            outputs: usize::from(genome.outputs),
            values: vec![0.0; nodes.len()],
            next: vec![0.0; nodes.len() - inputs],
            nodes,
            starts,
            sources,
        }
    }

    /// Sets all activations to 0.
    pub fn reset(&mut self) {
        self.values.fill(0.0);
    }

    /// Computes every node once and returns the outputs, each from 0 to 1. Inputs that are missing stay as they are, and inputs beyond the
    /// last are ignored.
    pub fn tick(&mut self, inputs: &[f64]) -> &[f64] {
        for (value, input) in self.values.iter_mut().take(self.inputs).zip(inputs) {
            *value = *input;
        }
        for (next, range) in self.next.iter_mut().zip(self.starts.windows(2)) {
            let links = self.sources.get(range[0]..range[1]).unwrap_or_default();
            let signal = |&(from, weight): &(usize, f64)| self.values[from] * weight;
            *next = sigmoid(links.iter().map(signal).fold(0.0, |sum, x| sum + x));
        }
        self.values[self.inputs..].copy_from_slice(&self.next);
        self.outputs()
    }

    /// Returns the outputs of the last tick.
    pub fn outputs(&self) -> &[f64] {
        &self.values[self.inputs..self.inputs + self.outputs]
    }

    /// Returns the ids of all nodes with their activations, in ascending order: inputs, outputs, hidden nodes.
    pub fn activations(&self) -> impl Iterator<Item = (u32, f64)> {
        self.nodes.iter().copied().zip(self.values.iter().copied())
    }
}

fn sigmoid(x: f64) -> f64 {
    1.0 / (1.0 + libm::exp(-STEEPNESS * x))
}

#[cfg(test)]
mod tests {
    use super::super::genome::{LinkGene, link};
    use super::*;

    fn play(links: Vec<LinkGene>) -> NetworkPlay {
        NetworkPlay::new(&NetworkGenome { inputs: 2, outputs: 1, parameters: vec![], links })
    }

    #[test]
    fn a_signal_passes_one_link_per_tick() {
        let off = LinkGene { enabled: false, ..link(1, 2, 9.0, 1) };
        // The hidden node has a large id, as in an old population.
        let mut play =
            play(vec![link(0, 2, 0.5, 0), off, link(0, 900, 2.0, 5), link(900, 2, 1.0, 6)]);
        assert_eq!(play.tick(&[1.0, 1.0]), [sigmoid(0.5)]);
        assert_eq!(play.tick(&[1.0, 1.0]), [sigmoid(0.5 + sigmoid(2.0))]);
        let ids: Vec<u32> = play.activations().map(|(id, _)| id).collect();
        assert_eq!(ids, [0, 1, 2, 900]);
        play.reset();
        assert_eq!(play.tick(&[1.0, 0.0]), [sigmoid(0.5)]);
    }

    #[test]
    fn a_node_can_feel_its_own_last_value() {
        let mut play = play(vec![link(2, 2, 1.0, 3)]);
        assert_eq!(play.tick(&[]), [0.5]);
        assert_eq!(play.tick(&[]), [sigmoid(0.5)]);
        assert_eq!(play.tick(&[]), [sigmoid(sigmoid(0.5))]);
    }

    #[test]
    fn activation_is_the_published_one() {
        assert_eq!(sigmoid(0.0), 0.5);
        assert!((sigmoid(1.0) - 0.992_608_5).abs() < 1e-6);
        assert_eq!((sigmoid(-1000.0), sigmoid(1000.0)), (0.0, 1.0));
    }

    #[test]
    fn links_that_lead_nowhere_do_no_harm() {
        let links = vec![link(0, 1, 1.0, 0), link(5, 6, 1.0, 1), link(6, 2, 1.0, 2)];
        let mut play = play(links);
        play.tick(&[1.0]);
        play.tick(&[1.0, 2.0, 3.0]);
        assert_eq!(play.tick(&[1.0]), [sigmoid(sigmoid(0.5))]);
    }
}
