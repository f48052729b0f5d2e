//! Historical markings: the numbers of new links and nodes.
//!
//! Equal structural changes get the same numbers wherever they occur within a generation. Children are therefore made without numbers, and
//! get them in their order when all children of the generation exist. Threads cannot change the numbers.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::genome::{LARGEST_NUMBER, LinkGene, NetworkGenome};
use crate::check::{Invalid, within};

/// The next numbers for new links and nodes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Innovations {
    next_link: u32,
    next_node: u32,
}

/// A child whose structural change has no numbers yet.
#[derive(Debug, Clone, PartialEq)]
pub struct Newborn {
    /// Genome without the structural change.
    pub genome: NetworkGenome,
    /// Structural change that [`Innovations::settle`] will add to the genome; `None` without one.
    pub novelty: Option<StructuralNovelty>,
}

/// A change of a network's structure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StructuralNovelty {
    /// A new link between two nodes of the genome.
    Link {
        /// Id of the node where the link begins.
        from: u32,
        /// Id of the node where the link ends.
        to: u32,
        /// Weight of the link.
        weight: f32,
    },
    /// A new node in the middle of the link with this innovation number, which is switched off. The link into the node has the weight 1,
    /// and the link out of it the old weight, so the function of the network changes little.
    Split {
        /// Innovation number of the split link.
        innovation: u32,
    },
}

/// The identity of a structural change. Within a generation, changes with equal keys get equal numbers.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
enum NoveltyKey {
    Link(u32, u32),
    Split(u32),
}

impl Innovations {
    /// Returns the numbers after those of every genome of a first generation, which has one link from each input to each output.
    pub fn first(inputs: u16, outputs: u16) -> Self {
        let (inputs, outputs) = (u32::from(inputs), u32::from(outputs));
        Self { next_link: inputs * outputs, next_node: inputs + outputs }
    }

    /// Returns the numbers after those of a genome.
    pub fn after(genome: &NetworkGenome) -> Self {
        let first = Self::first(genome.inputs, genome.outputs);
        let next_link = genome.links.last().map_or(0, |link| link.innovation.saturating_add(1));
        let next_node = genome.hidden().last().map_or(0, |node| node.saturating_add(1));
        Self {
            next_link: first.next_link.max(next_link),
            next_node: first.next_node.max(next_node),
        }
    }

    /// Adds the structural changes of one generation to its children and numbers them, in the order of the children.
    pub fn settle(&mut self, children: &mut [Newborn]) {
        let mut numbers = BTreeMap::new();
        for child in children {
            let Some(novelty) = child.novelty.take() else { continue };
            // The numbers are sufficient for 100 million generations. If none are left, genomes keep their structure.
            if self.next_link >= LARGEST_NUMBER - 1 || self.next_node >= LARGEST_NUMBER {
                continue;
            }
            let key = match novelty {
                StructuralNovelty::Link { from, to, .. } => NoveltyKey::Link(from, to),
                StructuralNovelty::Split { innovation } => NoveltyKey::Split(innovation),
            };
            let (link, node) = *numbers.entry(key).or_insert_with(|| self.hand_out(novelty));
            child.genome.add(novelty, link, node);
        }
    }

    /// Checks that all numbers of a genome have been assigned.
    ///
    /// # Errors
    /// Returns the first number that has not been assigned.
    pub fn check(&self, genome: &NetworkGenome) -> Result<(), Invalid> {
        within("innovations.next_link", self.next_link, 1..=LARGEST_NUMBER)?;
        within("innovations.next_node", self.next_node, genome.first_hidden()..=LARGEST_NUMBER)?;
        for link in &genome.links {
            within("links.innovation", link.innovation, 0..=self.next_link - 1)?;
            within("links.from", link.from, 0..=self.next_node - 1)?;
            within("links.to", link.to, 0..=self.next_node - 1)?;
        }
        Ok(())
    }

    /// Returns the number of the first new link, and the id of a new node, and advances the counters by what the change needs.
    fn hand_out(&mut self, novelty: StructuralNovelty) -> (u32, u32) {
        let numbers = (self.next_link, self.next_node);
        match novelty {
            StructuralNovelty::Link { .. } => self.next_link += 1,
            StructuralNovelty::Split { .. } => {
                self.next_link += 2;
                self.next_node += 1;
            }
        }
        numbers
    }
}

impl NetworkGenome {
    fn add(&mut self, novelty: StructuralNovelty, innovation: u32, node: u32) {
        match novelty {
            StructuralNovelty::Link { from, to, weight } => {
                self.links.push(LinkGene { from, to, weight, enabled: true, innovation });
            }
            StructuralNovelty::Split { innovation: split } => {
                let Some(old) = self.links.iter_mut().find(|link| link.innovation == split) else {
                    return;
                };
                old.enabled = false;
                let LinkGene { from, to, weight, .. } = *old;
                let first = LinkGene { from, to: node, weight: 1.0, enabled: true, innovation };
                let innovation = innovation + 1;
                self.links.push(first);
                self.links.push(LinkGene { from: node, to, weight, enabled: true, innovation });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::genome::link;
    use super::*;

    fn newborn(novelty: Option<StructuralNovelty>) -> Newborn {
        let links = vec![link(0, 2, 0.5, 0), link(1, 2, -0.5, 1)];
        Newborn {
            genome: NetworkGenome { inputs: 2, outputs: 1, parameters: vec![], links },
            novelty,
        }
    }

    fn split(innovation: u32) -> Option<StructuralNovelty> {
        Some(StructuralNovelty::Split { innovation })
    }

    #[test]
    fn a_split_link_is_off_and_two_links_take_its_place() {
        let mut children = [newborn(split(1))];
        Innovations::first(2, 1).settle(&mut children);
        let off = LinkGene { enabled: false, ..link(1, 2, -0.5, 1) };
        let expected = [link(0, 2, 0.5, 0), off, link(1, 3, 1.0, 2), link(3, 2, -0.5, 3)];
        assert_eq!(children[0].genome.links, expected);
        assert_eq!(children[0].novelty, None);
    }

    #[test]
    fn equal_novelty_of_a_generation_gets_equal_numbers_whatever_the_order_of_children() {
        let kinds = [split(0), None, split(1), split(0)];
        // For each child: number of the first new link, which depends on the first child with this change.
        for (order, expected) in [
            ([0, 1, 2, 3], [2, 0, 4, 2]),
            ([2, 3, 0, 1], [2, 4, 4, 0]),
            ([1, 0, 3, 2], [0, 2, 2, 4]),
        ] {
            let mut children = order.map(|kind| newborn(kinds[kind]));
            Innovations::first(2, 1).settle(&mut children);
            let number =
                |child: &Newborn| child.genome.links.get(2).map_or(0, |link| link.innovation);
            assert_eq!(children.each_ref().map(number), expected, "order {order:?}");
            let nodes = |kind| {
                let place = order.iter().position(|&other| other == kind).unwrap();
                children[place].genome.hidden()
            };
            assert_eq!(nodes(0), nodes(3), "order {order:?}");
            assert_ne!(nodes(0), nodes(2), "order {order:?}");
        }
    }

    #[test]
    fn the_next_generation_gets_new_numbers_for_the_same_novelty() {
        let mut innovations = Innovations::first(2, 1);
        let mut first = [newborn(split(0))];
        innovations.settle(&mut first);
        let mut second = [newborn(split(0))];
        innovations.settle(&mut second);
        assert_eq!((first[0].genome.hidden(), second[0].genome.hidden()), (vec![3], vec![4]));
    }

    #[test]
    fn a_number_that_was_not_handed_out_is_refused() {
        let innovations = Innovations::first(2, 1);
        assert_eq!(innovations.check(&newborn(None).genome), Ok(()));
        let mut children = [newborn(split(0))];
        innovations.clone().settle(&mut children);
        let error = innovations.check(&children[0].genome).unwrap_err();
        assert_eq!(error.to_string(), "links.innovation is 2; allowed: 0 to 1");
    }
}
