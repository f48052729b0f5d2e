//! The genes of blocks: their ranges in a space, and the space that contains them.

use super::segment::Segment;
use super::space::BodySpace;
use crate::genome::gene::{Gene, GeneRange, GeneVisitor};
use crate::world::{STIFFEST_M4_S2, modulus_at_pa};

impl Segment {
    /// A block of a body without ancestors, by its place from the head.
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
            // A gene fills it in.
            youngs_modulus_pa: space.soft.then_some(space.modulus_min_pa),
        }
    }

    /// Its Young's modulus, in Pa; of a rigid block the least at which a block is rigid.
    pub(in crate::genome) fn modulus_or_rigid_pa(&self) -> f32 {
        let sides_m = [self.width_m, self.height_m];
        let rigid_pa = modulus_at_pa(1.01 * STIFFEST_M4_S2, sides_m, self.density_kg_m3);
        self.youngs_modulus_pa.unwrap_or(rigid_pa)
    }

    /// Visits the genes that have an effect. The joint of the head has none.
    fn genes(
        &mut self,
        index: usize,
        space: &BodySpace,
        [density_min_kg_m3, density_max_kg_m3]: [f32; 2],
        visit: GeneVisitor<'_>,
    ) {
        let limb = index + 1;
        let thickness = GeneRange::Ratio(space.thickness_min_m, space.thickness_max_m);
        let sizes = [
            (
                "length",
                &mut self.length_m,
                GeneRange::Ratio(space.length_min_m, space.length_max_m),
            ),
            ("width", &mut self.width_m, thickness),
            ("height", &mut self.height_m, thickness),
        ];
        for (size, value, range) in sizes {
            let field = format_args!("segments[{index}].{size}_m");
            visit(
                Gene { field, name: format_args!("block {limb}, {size}"), unit: "m", range },
                value,
            );
        }
        let range = GeneRange::Ratio(density_min_kg_m3, density_max_kg_m3);
        let field = format_args!("segments[{index}].density_kg_m3");
        let name = format_args!("block {limb}, density");
        visit(Gene { field, name, unit: "kg/m³", range }, &mut self.density_kg_m3);
        if let Some(modulus_pa) = &mut self.youngs_modulus_pa {
            let range = GeneRange::Ratio(space.modulus_min_pa, space.modulus_max_pa);
            let field = format_args!("segments[{index}].youngs_modulus_pa");
            let name = format_args!("block {limb}, Young's modulus");
            visit(Gene { field, name, unit: "Pa", range }, modulus_pa);
        }
        if index == 0 {
            return;
        }
        let bend = GeneRange::Between(space.bend_limit_min_rad, space.bend_limit_max_rad);
        let twist = GeneRange::Between(space.twist_limit_min_rad, space.twist_limit_max_rad);
        for (axis, value, range) in
            [("bend", &mut self.bend_limit_rad, bend), ("twist", &mut self.twist_limit_rad, twist)]
        {
            let field = format_args!("segments[{index}].{axis}_limit_rad");
            let name = format_args!("joint {index}, {axis} limit");
            visit(Gene { field, name, unit: "rad", range }, value);
        }
        let range = GeneRange::Between(space.strength_min, 1.0);
        let field = format_args!("segments[{index}].strength");
        let name = format_args!("joint {index}, strength");
        visit(Gene { field, name, unit: "", range }, &mut self.strength);
    }
}

/// Visits the genes of all blocks, from the head.
pub fn segment_genes(
    segments: &mut [Segment],
    space: &BodySpace,
    densities: [f32; 2],
    visit: GeneVisitor<'_>,
) {
    for (index, segment) in segments.iter_mut().enumerate() {
        segment.genes(index, space, densities, visit);
    }
}

impl BodySpace {
    /// Widens the space so that it contains a body.
    pub(in crate::genome) fn widen(&mut self, segments: &[Segment]) {
        let count = segments.len() as u32;
        (self.limbs_min, self.limbs_max) = (self.limbs_min.min(count), self.limbs_max.max(count));
        let widen = |[least, most]: [&mut f32; 2], value: f32| {
            (*least, *most) = (least.min(value), most.max(value));
        };
        for segment in segments {
            widen([&mut self.length_min_m, &mut self.length_max_m], segment.length_m);
            for side in [segment.width_m, segment.height_m] {
                widen([&mut self.thickness_min_m, &mut self.thickness_max_m], side);
            }
            widen(
                [&mut self.bend_limit_min_rad, &mut self.bend_limit_max_rad],
                segment.bend_limit_rad,
            );
            widen(
                [&mut self.twist_limit_min_rad, &mut self.twist_limit_max_rad],
                segment.twist_limit_rad,
            );
            self.strength_min = self.strength_min.min(segment.strength);
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
}
