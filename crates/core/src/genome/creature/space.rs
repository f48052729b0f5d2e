//! The space of branching bodies, besides the sizes and limits that branching bodies have in common with chains.

use super::growth::{MOST_DEPTH, MOST_PARTS};
use crate::check::{Invalid, within};
use crate::genome::controllers::NeuronFunction;
use crate::genome::kind::ControllerKind;
use crate::genome::space::GenomeSpace;
use crate::schema::{choice, choices, setting_group, whole};

setting_group! {
    /// Ranges of the parts and neurons of a creature.
    pub struct CreatureSpace in "Creatures":
        "Parts and neurons of branching bodies. Their sizes, joints and volume are those of evolving bodies."
    {
        /// Least number of parts. It is at most seven, the length of the longest chain.
        parts_min: u32 = 2,
            whole("Minimum parts", 2..=MOST_DEPTH as u32 + 1)
                .hint("Smallest number of parts that a creature may have")
                .slider(2.0, 7.0);

        /// Greatest number of parts of a creature.
        parts_max: u32 = MOST_PARTS as u32,
            whole("Maximum parts", 2..=MOST_PARTS as u32)
                .hint("Largest number of parts that a creature may have")
                .slider(2.0, 16.0);

        /// Functions that the neurons of a creature may have.
        neurons: NeuronSet = NeuronSet::Standard,
            choice("Neurons")
                .hint("Functions that neurons compute");
    }

    fn check_together(&self) -> Result<(), Invalid> {
        within("parts_max", self.parts_max, self.parts_min..=MOST_PARTS as u32)
    }
}

choices! {
    /// A set of functions of neurons.
    pub enum NeuronSet {
        Standard = "standard", "Standard", "Neurons with a smooth step, and oscillators (Miconi and Channon 2005).";
        Sims = "sims", "Sims", "The 23 functions of Karl Sims (1994): sums, products, comparisons, memories, oscillators.";
    }
}

impl GenomeSpace {
    /// Returns whether genomes of this space are creatures.
    pub fn has_creatures(&self) -> bool {
        self.bodies.vary && self.controller == ControllerKind::PartNeurons
    }
}

impl CreatureSpace {
    /// Returns the range of the number of parts that a creature may have.
    pub fn parts(&self) -> std::ops::RangeInclusive<usize> {
        self.parts_min as usize..=self.parts_max as usize
    }
}

impl NeuronSet {
    /// Returns the functions of the set.
    pub fn functions(self) -> &'static [NeuronFunction] {
        match self {
            Self::Standard => &NeuronFunction::STANDARD,
            Self::Sims => &NeuronFunction::ALL,
        }
    }
}
