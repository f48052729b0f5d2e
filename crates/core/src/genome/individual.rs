//! One individual: the genes of its body and of its controller.

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3Default;

use super::body::BodyGenes;
use super::controllers::ControllerGenes;
use super::gene::{Gene, Genes};
use super::space::GenomeSpace;
use crate::check::{Invalid, within};

/// One individual. Champion files store these fields as they are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Genome {
    /// Genes of the body: the limits of the joints and the material, or a body of the individual's own.
    pub body: BodyGenes,
    /// Genes of the controller, which drives the joints.
    pub controller: ControllerGenes,
}

impl Genome {
    /// Visits every gene in a fixed order, with its range in `space`.
    pub(super) fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        self.body.genes(space, genes);
        self.controller.genes(space, genes);
    }

    /// Visits every gene in a fixed order, with its range in `space`.
    pub(super) fn visit(&mut self, space: &GenomeSpace, mut visit: impl FnMut(Gene<'_>, &mut f32)) {
        self.genes(space, &mut Genes::to(&mut visit));
    }

    /// Checks that a controller of the kind `part_neurons` has neurons for each node of a branching body, and that a branching body has a
    /// controller of this kind, or signals that a policy recorded.
    ///
    /// # Errors
    /// Returns the first of these two conditions that does not hold.
    pub fn check_neurons(&self) -> Result<(), Invalid> {
        let nodes = self.body.nodes.len();
        match &self.controller {
            ControllerGenes::PartNeurons(genes) => {
                within("part_neurons.nodes", genes.nodes.len(), nodes..=nodes)
            }
            ControllerGenes::Signal(_) | ControllerGenes::Targets(_) => Ok(()),
            other if nodes > 0 => {
                let allowed = "part_neurons, which grow with a branching body, or signal or targets, a recorded episode";
                Err(Invalid::new("controller", other.kind(), allowed))
            }
            _ => Ok(()),
        }
    }

    /// Counts the genes that the genome has in a space.
    pub fn gene_count(&self, space: &GenomeSpace) -> usize {
        let mut count = 0;
        self.clone().visit(space, |_, _| count += 1);
        count
    }

    /// Returns whether the controller senses contacts, attitude or the stairs ahead, besides its joints.
    pub fn senses_surroundings(&self) -> bool {
        let steers = match &self.controller {
            ControllerGenes::Gait(gait) => gait.steering.is_used(),
            _ => false,
        };
        steers || self.controller.kind().senses_surroundings()
    }

    /// Returns a hash (XXH3, 64 bits) over the bits of all genes. Equal genomes have equal hashes. The hash seeds repeated trials, so the
    /// order of genes influences the bits of a run.
    pub fn hash(&self) -> u64 {
        let mut hash = Xxh3Default::new();
        // Only values are hashed, not ranges, so any space will do.
        self.clone().visit(&GenomeSpace::default(), |_, value| {
            hash.update(&value.to_bits().to_le_bytes());
        });
        self.body.hash_descent(&mut hash);
        self.controller.encoding().hash_learned(&mut hash);
        hash.digest()
    }
}
