//! The genes of blocks: their ranges in a space, and the space that contains them.

use super::segment::Segment;
use super::space::BodySpace;
use crate::genome::gene::{GeneRange, Genes, widen};
use crate::genome::limits::{DENSITY, LIMIT, MODULUS, SHARE, SIZE};
use crate::genome::space::GenomeSpace;
use crate::world::{STIFFEST_M4_S2, modulus_at_pa};

impl Segment {
    /// Creates a block of a body without ancestors. `index` is its place from the head.
    pub(in crate::genome) fn newborn(index: usize, space: &BodySpace) -> Self {
        Self {
            id: index as u64 + 1,
            length_m: 0.0,
            width_m: 0.0,
            height_m: 0.0,
            density_kg_m3: 0.0,
            bend_limit_rad: (space.bend_limit_min_rad + space.bend_limit_max_rad) / 2.0,
            twist_limit_rad: (space.twist_limit_min_rad + space.twist_limit_max_rad) / 2.0,
            strength: 1.0,
            // The initial value of a gene.
            youngs_modulus_pa: space.soft.then_some(space.modulus_min_pa),
        }
    }

    /// Returns the block's Young's modulus, in Pa; for a rigid block, the least modulus at which a block is rigid.
    pub(in crate::genome) fn modulus_or_rigid_pa(&self) -> f32 {
        let sides_m = [self.width_m, self.height_m];
        let rigid_pa = modulus_at_pa(1.01 * STIFFEST_M4_S2, sides_m, self.density_kg_m3);
        self.youngs_modulus_pa.unwrap_or(rigid_pa)
    }

    /// Visits the genes of the block itself, without those of its joint.
    fn block_genes(&mut self, index: usize, space: &GenomeSpace, genes: &mut Genes<'_>) {
        let (field, name) =
            (format_args!("segments[{index}]."), format_args!("block {}, ", index + 1));
        genes.inside(field, name, |genes| {
            let bodies = &space.bodies;
            genes.gene("length_m", "length", SIZE, bodies.lengths(), &mut self.length_m);
            genes.gene("width_m", "width", SIZE, bodies.thicknesses(), &mut self.width_m);
            genes.gene("height_m", "height", SIZE, bodies.thicknesses(), &mut self.height_m);
            let density = &mut self.density_kg_m3;
            genes.gene("density_kg_m3", "density", DENSITY, space.densities(), density);
            if let Some(modulus_pa) = &mut self.youngs_modulus_pa {
                let range = GeneRange::Ratio(bodies.modulus_min_pa, bodies.modulus_max_pa);
                genes.gene("youngs_modulus_pa", "Young's modulus", MODULUS, range, modulus_pa);
            }
        });
    }

    /// Visits the genes of the joint in front of the block.
    fn joint_genes(&mut self, index: usize, space: &BodySpace, genes: &mut Genes<'_>) {
        let (field, name) = (format_args!("segments[{index}]."), format_args!("joint {index}, "));
        genes.inside(field, name, |genes| {
            let (bend, twist) = (&mut self.bend_limit_rad, &mut self.twist_limit_rad);
            genes.gene("bend_limit_rad", "bend limit", LIMIT, space.bend_limits(), bend);
            genes.gene("twist_limit_rad", "twist limit", LIMIT, space.twist_limits(), twist);
            genes.gene("strength", "strength", SHARE, space.strengths(), &mut self.strength);
        });
    }
}

/// Visits the genes of all blocks that have an effect, in order from the head.
pub fn segment_genes(segments: &mut [Segment], space: &GenomeSpace, genes: &mut Genes<'_>) {
    for (index, segment) in segments.iter_mut().enumerate() {
        segment.block_genes(index, space, genes);
        if index > 0 {
            segment.joint_genes(index, &space.bodies, genes);
        }
    }
}

/// Visits the genes of the joint of the head. They have no effect until a change of the body puts a block in front of the head.
pub fn waiting_genes(segments: &mut [Segment], space: &GenomeSpace, genes: &mut Genes<'_>) {
    if let Some(head) = segments.first_mut() {
        head.joint_genes(0, &space.bodies, genes);
    }
}

impl BodySpace {
    /// Widens the space so that it contains a body with these blocks.
    pub(in crate::genome) fn widen(&mut self, segments: &[Segment]) {
        let count = segments.len() as u32;
        (self.limbs_min, self.limbs_max) = (self.limbs_min.min(count), self.limbs_max.max(count));
        for segment in segments {
            self.widen_sizes([segment.width_m, segment.length_m, segment.height_m]);
            let limits_rad = [segment.bend_limit_rad, segment.twist_limit_rad];
            self.widen_joints(limits_rad, segment.strength);
        }
        self.soft = segments.iter().any(|segment| segment.youngs_modulus_pa.is_some());
        if self.soft {
            for segment in segments {
                let modulus_pa = segment.modulus_or_rigid_pa();
                widen([&mut self.modulus_min_pa, &mut self.modulus_max_pa], modulus_pa);
            }
        }
        self.volume_m3 = segments.iter().map(Segment::volume_m3).sum::<f64>() as f32;
        let length_m: f32 = segments.iter().map(|segment| segment.length_m).sum();
        self.longest_m = self.longest_m.max(length_m);
    }

    /// Widens the ranges of sizes so that they contain a part with this size across x, along y and along z, in metres.
    pub(in crate::genome) fn widen_sizes(&mut self, [width_m, length_m, height_m]: [f32; 3]) {
        widen([&mut self.length_min_m, &mut self.length_max_m], length_m);
        for side_m in [width_m, height_m] {
            widen([&mut self.thickness_min_m, &mut self.thickness_max_m], side_m);
        }
    }

    /// Widens the ranges of joints so that they contain a joint with these limits of bend and twist, in radians, and this strength.
    pub(in crate::genome) fn widen_joints(&mut self, [bend, twist]: [f32; 2], strength: f32) {
        widen([&mut self.bend_limit_min_rad, &mut self.bend_limit_max_rad], bend);
        widen([&mut self.twist_limit_min_rad, &mut self.twist_limit_max_rad], twist);
        self.strength_min = self.strength_min.min(strength);
    }
}
