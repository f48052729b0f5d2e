//! The genes of a creature's body, and the other data of the body that belongs to a genome's hash.

use xxhash_rust::xxh3::Xxh3Default;

use super::growth::{bare_plan, grow};
use super::node::{BodyNode, Connection};
use crate::genome::chain::BodySpace;
use crate::genome::gene::{GeneRange, Genes, Quantity};
use crate::genome::limits::{DENSITY, LIMIT, SHARE, SIDED_SHARE, SIZE, SIZE_RANGE_M};
use crate::genome::space::GenomeSpace;

/// Largest deviation from a right angle between a part and the side from which it grows, in radians.
const LARGEST_TILT_RAD: f32 = 1.2;
/// Quantity of a deviation from a right angle between a part and the side from which it grows.
const TILT: Quantity = Quantity::new("rad", -LARGEST_TILT_RAD..=LARGEST_TILT_RAD);
/// Quantity of the factor of size from a part to a part that grows from it.
const SCALE: Quantity = Quantity::pure(0.5..=1.5);

/// Visits the genes of all nodes.
pub fn node_genes(nodes: &mut [BodyNode], space: &GenomeSpace, genes: &mut Genes<'_>) {
    for (index, node) in nodes.iter_mut().enumerate() {
        let (field, name) = (format_args!("nodes[{index}]."), format_args!("node {}, ", index + 1));
        genes.inside(field, name, |genes| genes_of(node, space, genes));
    }
}

fn genes_of(node: &mut BodyNode, space: &GenomeSpace, genes: &mut Genes<'_>) {
    let bodies = &space.bodies;
    // The space limits the sizes of grown parts, which the factors of size change. The genes of sizes have the range of all files.
    let sizes = GeneRange::Ratio(*SIZE_RANGE_M.start(), *SIZE_RANGE_M.end());
    genes.gene("length_m", "length", SIZE, sizes, &mut node.length_m);
    genes.gene("width_m", "width", SIZE, sizes, &mut node.width_m);
    genes.gene("height_m", "height", SIZE, sizes, &mut node.height_m);
    genes.gene("density_kg_m3", "density", DENSITY, space.densities(), &mut node.density_kg_m3);
    let (bend, twist) = (&mut node.bend_limit_rad, &mut node.twist_limit_rad);
    genes.gene("bend_limit_rad", "bend limit", LIMIT, bodies.bend_limits(), bend);
    genes.gene("twist_limit_rad", "twist limit", LIMIT, bodies.twist_limits(), twist);
    let sided = GeneRange::around_zero(1.0);
    let (bend, twist) = (&mut node.bend_start, &mut node.twist_start);
    genes.gene("bend_start", "bend at the start", SIDED_SHARE, sided, bend);
    genes.gene("twist_start", "twist at the start", SIDED_SHARE, sided, twist);
    genes.gene("strength", "strength", SHARE, bodies.strengths(), &mut node.strength);
    for (index, connection) in node.connections.iter_mut().enumerate() {
        let field = format_args!("connections[{index}].");
        let name = format_args!("connection {}, ", index + 1);
        genes.inside(field, name, |genes| connection_genes(connection, genes));
    }
}

fn connection_genes(connection: &mut Connection, genes: &mut Genes<'_>) {
    for (axis, value) in connection.place.iter_mut().enumerate() {
        let (field, name) = (format_args!("place[{axis}]"), format_args!("place {}", axis + 1));
        genes.gene(field, name, SIDED_SHARE, GeneRange::around_zero(1.0), value);
    }
    for (axis, value) in connection.turn_rad.iter_mut().enumerate() {
        let (field, name) = (format_args!("turn_rad[{axis}]"), format_args!("turn {}", axis + 1));
        genes.gene(field, name, TILT, GeneRange::around_zero(LARGEST_TILT_RAD), value);
    }
    let [least, most] = SCALE.limits;
    genes.gene("scale", "scale", SCALE, GeneRange::Ratio(least, most), &mut connection.scale);
}

impl BodySpace {
    /// Widens the space so that it contains a creature with these nodes.
    pub(in crate::genome) fn widen_for_creature(&mut self, nodes: &[BodyNode]) {
        let grown = grow(nodes);
        grown.iter().for_each(|part| self.widen_sizes(part.size_m));
        for node in nodes {
            self.widen_joints([node.bend_limit_rad, node.twist_limit_rad], node.strength);
        }
        let body = bare_plan(nodes, &grown);
        self.volume_m3 = body.volume_m3();
        self.longest_m = self.longest_m.max(body.length_m());
    }
}

/// Hashes the data of a body that are not numbers: joints, sides, and the connections between nodes.
pub fn hash_structure(nodes: &[BodyNode], hash: &mut Xxh3Default) {
    for node in nodes {
        hash.update(&[node.joint as u8, node.copies as u8, node.connections.len() as u8]);
        for of in &node.connections {
            let flags = [of.is_mirrored, of.is_terminal].map(u8::from);
            hash.update(&[of.to as u8, of.side as u8, flags[0], flags[1]]);
        }
    }
}
