//! Repairs the sizes of a varied creature so that it meets its limits: the exact volume, parts that are neither too thin nor too large,
//! and neighbours that the engine can hold together.

use super::check::{check_built, check_nodes};
use super::growth::{GrownPart, bare_plan, grow};
use super::node::BodyNode;
use crate::genome::chain::{BodySpace, EVOLVED_INERTIA_RATIO, MASS_RATIO, inertia_kg_m2, ratio};
use crate::genome::space::GenomeSpace;

/// Number of attempts to meet the limits by changing only sizes that exceed them, before all parts become equal cubes.
const PASSES: usize = 12;
/// Relative tolerance of a body's total volume.
const VOLUME_TOLERANCE: f64 = 1.0e-3;

pub(super) fn volume_m3(grown: &[GrownPart]) -> f64 {
    grown.iter().map(|part| part.size_m.into_iter().map(f64::from).product::<f64>()).sum()
}

/// Scales all sizes so that the creature has this volume, and returns the parts that then grow.
fn fill_volume(nodes: &mut [BodyNode], wanted_m3: f64) -> Vec<GrownPart> {
    let grown_m3 = volume_m3(&grow(nodes));
    let factor = libm::cbrt(wanted_m3 / grown_m3);
    for size_m in nodes.iter_mut().flat_map(BodyNode::sizes_mut) {
        *size_m = (f64::from(*size_m) * factor) as f32;
    }
    grow(nodes)
}

impl BodySpace {
    /// Returns the least and the greatest size of a part across x, along y and along z, in metres.
    fn part_sizes_m(&self) -> [[f32; 2]; 3] {
        let thickness = [self.thickness_min_m, self.thickness_max_m];
        [thickness, [self.length_min_m, self.length_max_m], thickness]
    }
}

impl GenomeSpace {
    /// Changes the sizes of nodes as little as necessary, so that the parts that grow keep the limits of sizes and volume.
    pub(super) fn repair_creature(&self, nodes: &mut [BodyNode]) {
        let wanted_m3 = f64::from(self.bodies.volume_m3);
        for _ in 0..PASSES {
            let grown = fill_volume(nodes, wanted_m3);
            if grown.len() < 2 || !self.bring_closer(nodes, &grown) {
                return;
            }
        }
        for node in nodes.iter_mut() {
            node.sizes_mut().into_iter().for_each(|size_m| *size_m = 1.0);
            node.connections.iter_mut().for_each(|connection| connection.scale = 1.0);
            node.density_kg_m3 = (self.density_min_kg_m3 + self.density_max_kg_m3) / 2.0;
        }
        fill_volume(nodes, wanted_m3);
    }

    /// Moves the sizes of nodes whose parts exceed a limit towards the limit. Returns whether there were such nodes.
    fn bring_closer(&self, nodes: &mut [BodyNode], grown: &[GrownPart]) -> bool {
        let mut is_beyond = false;
        let ranges_m = self.bodies.part_sizes_m();
        for part in grown {
            let sides = nodes[part.node].sizes_mut().into_iter().zip(part.size_m).zip(ranges_m);
            for ((of_node, of_part), [least_m, most_m]) in sides {
                if !(least_m..=most_m).contains(&of_part) {
                    is_beyond = true;
                    // The size moves a little beyond the limit, because filling the volume moves it back.
                    *of_node *= if of_part < least_m {
                        1.05 * least_m / of_part
                    } else {
                        0.95 * most_m / of_part
                    };
                }
            }
        }
        for part in grown {
            let Some(parent) = part.parent.map(|parent| grown[parent]) else { continue };
            let mass = |of: &GrownPart| {
                let density = f64::from(nodes[of.node].density_kg_m3);
                of.size_m.into_iter().map(f64::from).product::<f64>() * density
            };
            let masses = [mass(&parent), mass(part)];
            let inertias =
                [inertia_kg_m2(masses[0], parent.size_m), inertia_kg_m2(masses[1], part.size_m)];
            let is_fine = ratio(masses[0], masses[1]) <= MASS_RATIO
                && ratio(inertias[0], inertias[1]) <= EVOLVED_INERTIA_RATIO;
            if is_fine {
                continue;
            }
            is_beyond = true;
            let (front, rear) = (nodes[parent.node].size_m(), nodes[part.node].size_m());
            let means: [f32; 3] = std::array::from_fn(|axis| (front[axis] * rear[axis]).sqrt());
            for node in [parent.node, part.node] {
                for (size_m, mean_m) in nodes[node].sizes_mut().into_iter().zip(means) {
                    *size_m = (*size_m * mean_m).sqrt();
                }
            }
            for connection in &mut nodes[parent.node].connections {
                if connection.to as usize == part.node {
                    connection.scale = connection.scale.sqrt();
                }
            }
        }
        is_beyond
    }

    /// Returns whether these nodes and the parts that have grown from them keep all limits of this space.
    pub(in crate::genome) fn allows_creature(
        &self,
        nodes: &[BodyNode],
        grown: &[GrownPart],
    ) -> bool {
        let wanted_m3 = f64::from(self.bodies.volume_m3);
        if !self.creatures.parts().contains(&grown.len())
            || (volume_m3(grown) - wanted_m3).abs() > VOLUME_TOLERANCE * wanted_m3
        {
            return false;
        }
        let ranges_m = self.bodies.part_sizes_m();
        if check_nodes(nodes).is_err() {
            return false;
        }
        let fits = |part: &GrownPart| {
            let mut sides = part.size_m.into_iter().zip(ranges_m);
            // The tolerance is for sizes that are rounded to 32 bits.
            sides.all(|(size_m, [least_m, most_m])| {
                (least_m * 0.9999..=most_m * 1.0001).contains(&size_m)
            })
        };
        let body = bare_plan(nodes, grown);
        grown.iter().all(fits)
            && body.length_m() <= self.bodies.longest_m
            && check_built(&body, EVOLVED_INERTIA_RATIO).is_ok()
    }
}
