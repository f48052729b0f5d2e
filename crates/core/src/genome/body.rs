//! The genes of the body. Every genome has them.

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3Default;

use super::chain::{Segment, check_segments, segment_genes, waiting_genes};
use super::creature::{BodyNode, check_creature, grow, hash_structure, joint_tree, node_genes};
use super::gene::{Gene, GeneRange, Genes, check_limits, widen};
use super::limits::{DENSITY, LIMIT};
use super::space::GenomeSpace;
use crate::check::{Invalid, within};

/// Genes of the body: either the limits of the joints and the density, or a whole body from the genome. Champion files store these fields
/// as they are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyGenes {
    /// Largest bend of every joint to either side, in radians.
    pub bend_limit_rad: f32,
    /// Largest twist of every joint to either side, in radians.
    pub twist_limit_rad: f32,
    /// Density of the material, in kg/m³.
    pub density_kg_m3: f32,
    /// Blocks of the body, from the head; empty if the trial determines the blocks. With blocks in the genome, the three genes above have
    /// no effect and are 0.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub segments: Vec<Segment>,
    /// Graph of a branching body; empty for all other bodies.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub nodes: Vec<BodyNode>,
}

impl BodyGenes {
    /// Genes that are all 0, for a body whose blocks the trial determines.
    pub(super) const ZEROED: Self = Self {
        bend_limit_rad: 0.0,
        twist_limit_rad: 0.0,
        density_kg_m3: 0.0,
        segments: Vec::new(),
        nodes: Vec::new(),
    };

    /// Returns whether these genes determine the blocks of the body. Otherwise the trial does.
    pub fn has_own_blocks(&self) -> bool {
        !self.segments.is_empty() || self.is_branching()
    }

    /// Returns whether the body grows from a graph and can branch.
    pub fn is_branching(&self) -> bool {
        !self.nodes.is_empty()
    }

    /// Returns the number of blocks or parts that the genes determine; 0 if the trial determines the blocks.
    pub fn block_count(&self) -> usize {
        if self.is_branching() { grow(&self.nodes).len() } else { self.segments.len() }
    }

    /// Returns the length of the chain of blocks in the genome, in metres; 0 without such a chain.
    pub fn chain_length_m(&self) -> f64 {
        self.segments.iter().map(|segment| f64::from(segment.length_m)).sum()
    }

    /// Returns ids which tell bodies of different structures apart: one id per block, or a single one for the tree of a branching body;
    /// empty if the trial determines the blocks.
    pub fn block_ids(&self) -> Vec<u64> {
        if self.is_branching() {
            return vec![xxhash_rust::xxh3::xxh3_64(joint_tree(&self.nodes).as_bytes())];
        }
        self.segments.iter().map(|segment| segment.id).collect()
    }

    /// Hashes the parts of a body in the genome that its genes do not contain: the ids and the graph, which show its descent, and the
    /// joint of its head, which has no effect as long as no block is in front of the head.
    pub(super) fn hash_descent(&self, hash: &mut Xxh3Default) {
        hash_structure(&self.nodes, hash);
        for segment in &self.segments {
            hash.update(&segment.id.to_le_bytes());
        }
        let mut add = |_: Gene<'_>, value: &mut f32| hash.update(&value.to_bits().to_le_bytes());
        self.clone().waiting_genes(&GenomeSpace::default(), &mut Genes::to(&mut add));
    }

    /// Returns the genes of a body with these blocks.
    pub fn of_blocks(segments: Vec<Segment>) -> Self {
        Self { segments, ..Self::ZEROED }
    }

    /// Returns the genes of a branching body with this graph.
    pub fn of_nodes(nodes: Vec<BodyNode>) -> Self {
        Self { nodes, ..Self::ZEROED }
    }

    /// Checks every gene against its limits.
    ///
    /// # Errors
    /// Returns the first value out of range.
    pub fn check(&self) -> Result<(), Invalid> {
        if self.has_own_blocks() {
            let unused = [
                ("bend_limit_rad", self.bend_limit_rad),
                ("twist_limit_rad", self.twist_limit_rad),
                ("density_kg_m3", self.density_kg_m3),
            ];
            for (field, value) in unused {
                if value != 0.0 {
                    let allowed = "0, because each part of the body has its own";
                    return Err(Invalid::new(field, value, allowed));
                }
            }
            return if self.is_branching() {
                within("segments", self.segments.len(), 0..=0)?;
                check_creature(&self.nodes)
            } else {
                check_segments(&self.segments)
            };
        }
        check_limits(|genes| self.clone().genes(&GenomeSpace::default(), genes))
    }

    /// Visits every gene, in a fixed order.
    pub(super) fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        if self.is_branching() {
            node_genes(&mut self.nodes, space, genes);
        } else if self.has_own_blocks() {
            segment_genes(&mut self.segments, space, genes);
        } else {
            let (bend, twist) = (&mut self.bend_limit_rad, &mut self.twist_limit_rad);
            let range = GeneRange::OneOf(&space.bend_limits_rad);
            genes.gene("bend_limit_rad", "bend limit", LIMIT, range, bend);
            let range = GeneRange::OneOf(&space.twist_limits_rad);
            genes.gene("twist_limit_rad", "twist limit", LIMIT, range, twist);
            let range = GeneRange::Between(space.density_min_kg_m3, space.density_max_kg_m3);
            genes.gene("density_kg_m3", "density", DENSITY, range, &mut self.density_kg_m3);
        }
    }

    /// Visits the genes that have no effect as long as no block is in front of the head: those of the joint of the head.
    pub(super) fn waiting_genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        waiting_genes(&mut self.segments, space, genes);
    }

    /// Gives every block the gene of its softness, as bodies need it whose softness evolves. A rigid block stays rigid.
    pub(super) fn with_softness(mut self) -> Self {
        for segment in &mut self.segments {
            segment.youngs_modulus_pa = Some(segment.modulus_or_rigid_pa());
        }
        self
    }

    /// Widens a space so that it contains these genes.
    pub(super) fn widen(&self, space: &mut GenomeSpace) {
        space.bodies.vary = self.has_own_blocks();
        if space.bodies.vary {
            if self.is_branching() {
                space.bodies.widen_for_creature(&self.nodes);
            } else {
                space.bodies.widen(&self.segments);
            }
            let of_segments = self.segments.iter().map(|segment| segment.density_kg_m3);
            let of_nodes = self.nodes.iter().map(|node| node.density_kg_m3);
            for density_kg_m3 in of_segments.chain(of_nodes) {
                widen([&mut space.density_min_kg_m3, &mut space.density_max_kg_m3], density_kg_m3);
            }
            return;
        }
        for (limits, limit) in [
            (&mut space.bend_limits_rad, self.bend_limit_rad),
            (&mut space.twist_limits_rad, self.twist_limit_rad),
        ] {
            if !limits.contains(&limit) {
                limits.push(limit);
            }
        }
        widen([&mut space.density_min_kg_m3, &mut space.density_max_kg_m3], self.density_kg_m3);
    }
}
