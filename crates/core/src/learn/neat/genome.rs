//! The genome of a network: its links, and real parameters.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use super::rules::NeatRules;
use crate::check::{Invalid, within};

/// Greatest allowed number of links of a genome.
pub const MOST_LINKS: u32 = 10_000;
/// Greatest allowed number of hidden nodes of a genome.
pub const MOST_HIDDEN: u32 = 2_000;
/// Greatest allowed number of inputs, of outputs, and of parameters.
pub const MOST_ENDS: u16 = 1_000;
/// Greatest allowed id of a node and innovation number. Numbers are assigned in order, a few per generation.
pub const LARGEST_NUMBER: u32 = 1 << 30;

/// The genome of a network.
///
/// Nodes have ids: first the inputs, then the outputs, then the hidden nodes. A node is hidden if its id is none of the first two and a
/// link begins or ends at it. Links can be switched off, but are never removed. A constant input (bias) is an input like the others.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NetworkGenome {
    /// Number of inputs, including a constant one.
    pub inputs: u16,
    /// Number of outputs of the network.
    pub outputs: u16,
    /// Numbers from 0 to 1 that evolve together with the network. The caller determines their meaning.
    pub parameters: Vec<f32>,
    /// Links in ascending order of their innovation numbers.
    pub links: Vec<LinkGene>,
}

/// A link from one node to another. It is saved as a tuple in the order of the fields, to keep saves short.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "LinkTuple", into = "LinkTuple")]
pub struct LinkGene {
    /// Id of the node where the link begins.
    pub from: u32,
    /// Id of the node where the link ends; never an input.
    pub to: u32,
    /// Factor on the signal.
    pub weight: f32,
    /// Whether the network has this link. If not, only the genome contains it.
    pub enabled: bool,
    /// Innovation number, the historical marking: links with the same number descend from the same mutation.
    pub innovation: u32,
}

/// A link as it is saved. The fourth number is 1 for a link that is enabled, otherwise 0.
type LinkTuple = (u32, u32, f32, u8, u32);

impl TryFrom<LinkTuple> for LinkGene {
    type Error = Invalid;

    fn try_from((from, to, weight, enabled, innovation): LinkTuple) -> Result<Self, Invalid> {
        within("links.enabled", enabled, 0..=1)?;
        Ok(Self { from, to, weight, enabled: enabled == 1, innovation })
    }
}

impl From<LinkGene> for LinkTuple {
    fn from(link: LinkGene) -> Self {
        (link.from, link.to, link.weight, u8::from(link.enabled), link.innovation)
    }
}

impl NetworkGenome {
    /// Returns the id of the first hidden node, which is also the number of inputs and outputs.
    pub fn first_hidden(&self) -> u32 {
        u32::from(self.inputs) + u32::from(self.outputs)
    }

    /// Returns the ids of the hidden nodes, in ascending order.
    pub fn hidden(&self) -> Vec<u32> {
        let ends = self.links.iter().flat_map(|link| [link.from, link.to]);
        let hidden: BTreeSet<u32> = ends.filter(|&id| id >= self.first_hidden()).collect();
        hidden.into_iter().collect()
    }

    /// Counts the links that are enabled.
    pub fn enabled_links(&self) -> usize {
        self.links.iter().filter(|link| link.enabled).count()
    }

    /// Returns whether a link, enabled or not, leads from one node to the other.
    pub fn joins(&self, from: u32, to: u32) -> bool {
        self.links.iter().any(|link| link.from == from && link.to == to)
    }

    /// Checks a genome that was read from a file.
    ///
    /// # Errors
    /// Returns an error if there are too many inputs, outputs, parameters, links or hidden nodes; if a number is not finite or out of its
    /// range; if an id belongs to no node; or if the links are not in order, or two are equal.
    pub fn check(&self, rules: &NeatRules) -> Result<(), Invalid> {
        within("inputs", self.inputs, 1..=MOST_ENDS)?;
        within("outputs", self.outputs, 1..=MOST_ENDS)?;
        within("parameters", self.parameters.len(), 0..=usize::from(MOST_ENDS))?;
        for &parameter in &self.parameters {
            within("parameters", parameter, 0.0..=1.0)?;
        }
        within("links", self.links.len(), 0..=rules.most_links as usize)?;
        for link in &self.links {
            link.check(self.inputs, rules.weight_limit)?;
        }
        for pair in self.links.windows(2) {
            let (before, after) = (pair[0].innovation, pair[1].innovation);
            if before >= after {
                return Err(Invalid::new("links.innovation", after, format!("above {before}")));
            }
        }
        let mut joined = BTreeSet::new();
        for link in &self.links {
            if !joined.insert((link.from, link.to)) {
                let value = format!("{} to {} twice", link.from, link.to);
                return Err(Invalid::new("links", value, "one link from a node to another"));
            }
        }
        within("hidden nodes", self.hidden().len(), 0..=rules.most_hidden as usize)
    }
}

impl LinkGene {
    fn check(&self, inputs: u16, weight_limit: f32) -> Result<(), Invalid> {
        within("links.from", self.from, 0..=LARGEST_NUMBER)?;
        within("links.to", self.to, u32::from(inputs)..=LARGEST_NUMBER)?;
        within("links.innovation", self.innovation, 0..=LARGEST_NUMBER)?;
        within("links.weight", self.weight, -weight_limit..=weight_limit)
    }
}

/// Returns a link that is enabled, for tests.
#[cfg(test)]
pub fn link(from: u32, to: u32, weight: f32, innovation: u32) -> LinkGene {
    LinkGene { from, to, weight, enabled: true, innovation }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn genome(links: Vec<LinkGene>) -> NetworkGenome {
        NetworkGenome { inputs: 2, outputs: 1, parameters: vec![0.5], links }
    }

    #[test]
    fn hidden_nodes_are_those_at_the_ends_of_links() {
        let genome = genome(vec![link(0, 2, 1.0, 0), link(0, 9, 1.0, 4), link(9, 2, 1.0, 5)]);
        assert_eq!(genome.hidden(), [9]);
        assert_eq!(genome.check(&NeatRules::default()), Ok(()));
    }

    #[test]
    fn hostile_genomes_are_refused_with_field_value_and_range() {
        let rules = NeatRules { most_links: 3, most_hidden: 1, ..NeatRules::default() };
        let refusal = |genome: NetworkGenome| genome.check(&rules).unwrap_err().to_string();
        let number = LARGEST_NUMBER;
        for (links, message) in [
            (vec![link(0, 1, 1.0, 0)], format!("links.to is 1; allowed: 2 to {number}")),
            (
                vec![link(u32::MAX, 2, 1.0, 0)],
                format!("from is 4294967295; allowed: 0 to {number}"),
            ),
            (vec![link(0, 2, f32::NAN, 0)], "links.weight is NaN; allowed: -8 to 8".into()),
            (vec![link(0, 2, -8.5, 0)], "links.weight is -8.5; allowed: -8 to 8".into()),
            (
                vec![link(0, 2, 1.0, 7), link(1, 2, 1.0, 7)],
                "links.innovation is 7; allowed: above 7".into(),
            ),
            (vec![link(0, 2, 1.0, 0), link(0, 2, 1.0, 1)], "links is 0 to 2 twice".into()),
            (vec![link(0, 2, 1.0, 0); 4], "links is 4; allowed: 0 to 3".into()),
            (
                vec![link(0, 5, 1.0, 0), link(0, 6, 1.0, 1)],
                "hidden nodes is 2; allowed: 0 to 1".into(),
            ),
        ] {
            let refusal = refusal(genome(links));
            assert!(refusal.contains(&message), "{refusal}, not {message}");
        }
        let hostile = NetworkGenome { parameters: vec![f32::INFINITY], ..genome(vec![]) };
        assert_eq!(refusal(hostile), "parameters is inf; allowed: 0 to 1");
        let hostile = NetworkGenome { outputs: 0, ..genome(vec![]) };
        assert_eq!(refusal(hostile), "outputs is 0; allowed: 1 to 1000");
    }

    #[test]
    fn a_link_is_saved_as_a_short_tuple() {
        let text = ron::to_string(&link(3, 71, -1.25, 12)).unwrap();
        assert_eq!(text, "(3,71,-1.25,1,12)");
        assert_eq!(ron::from_str::<LinkGene>(&text), Ok(link(3, 71, -1.25, 12)));
        let refusal = ron::from_str::<LinkGene>("(3,71,-1.25,7,12)").unwrap_err().to_string();
        assert!(refusal.contains("links.enabled is 7; allowed: 0 to 1"), "{refusal}");
    }
}
