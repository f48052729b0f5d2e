//! The genes of a creature's body, and what else of it belongs to a genome's hash.

use xxhash_rust::xxh3::Xxh3Default;

use super::growth::{bare_plan, grow};
use super::node::{BodyNode, LARGEST_TILT_RAD, SCALE_RANGE};
use crate::genome::chain::BodySpace;
use crate::genome::gene::{Gene, GeneRange, GeneVisitor};
use crate::genome::limits::SIZE_RANGE_M;
use crate::genome::space::GenomeSpace;

/// Visits the genes of all nodes.
pub fn node_genes(nodes: &mut [BodyNode], space: &GenomeSpace, visit: GeneVisitor<'_>) {
    for (index, node) in nodes.iter_mut().enumerate() {
        genes_of(node, index, space, visit);
    }
}

fn genes_of(node: &mut BodyNode, index: usize, space: &GenomeSpace, visit: GeneVisitor<'_>) {
    let bodies = &space.bodies;
    let number = index + 1;
    // The space limits the sizes of parts, which the factors of size change.
    let range = GeneRange::Ratio(*SIZE_RANGE_M.start(), *SIZE_RANGE_M.end());
    let sizes = [
        ("length", &mut node.length_m),
        ("width", &mut node.width_m),
        ("height", &mut node.height_m),
    ];
    for (size, value) in sizes {
        let field = format_args!("nodes[{index}].{size}_m");
        visit(Gene { field, name: format_args!("node {number}, {size}"), unit: "m", range }, value);
    }
    let range = GeneRange::Ratio(space.density_min_kg_m3, space.density_max_kg_m3);
    let field = format_args!("nodes[{index}].density_kg_m3");
    let name = format_args!("node {number}, density");
    visit(Gene { field, name, unit: "kg/m³", range }, &mut node.density_kg_m3);
    let bend = GeneRange::Between(bodies.bend_limit_min_rad, bodies.bend_limit_max_rad);
    let twist = GeneRange::Between(bodies.twist_limit_min_rad, bodies.twist_limit_max_rad);
    for (axis, value, range) in
        [("bend", &mut node.bend_limit_rad, bend), ("twist", &mut node.twist_limit_rad, twist)]
    {
        let field = format_args!("nodes[{index}].{axis}_limit_rad");
        let name = format_args!("node {number}, {axis} limit");
        visit(Gene { field, name, unit: "rad", range }, value);
    }
    for (axis, value) in [("bend", &mut node.bend_start), ("twist", &mut node.twist_start)] {
        let range = GeneRange::Between(-1.0, 1.0);
        let field = format_args!("nodes[{index}].{axis}_start");
        let name = format_args!("node {number}, {axis} at the start");
        visit(Gene { field, name, unit: "", range }, value);
    }
    let range = GeneRange::Between(bodies.strength_min, 1.0);
    let field = format_args!("nodes[{index}].strength");
    let name = format_args!("node {number}, strength");
    visit(Gene { field, name, unit: "", range }, &mut node.strength);
    for (at, connection) in node.connections.iter_mut().enumerate() {
        let of = at + 1;
        for (axis, value) in connection.place.iter_mut().enumerate() {
            let range = GeneRange::Between(-1.0, 1.0);
            let field = format_args!("nodes[{index}].connections[{at}].place[{axis}]");
            let name = format_args!("node {number}, connection {of}, place {}", axis + 1);
            visit(Gene { field, name, unit: "", range }, value);
        }
        for (axis, value) in connection.turn_rad.iter_mut().enumerate() {
            let range = GeneRange::Between(-LARGEST_TILT_RAD, LARGEST_TILT_RAD);
            let field = format_args!("nodes[{index}].connections[{at}].turn_rad[{axis}]");
            let name = format_args!("node {number}, connection {of}, turn {}", axis + 1);
            visit(Gene { field, name, unit: "rad", range }, value);
        }
        let [least, most] = SCALE_RANGE;
        let field = format_args!("nodes[{index}].connections[{at}].scale");
        let name = format_args!("node {number}, connection {of}, scale");
        let range = GeneRange::Ratio(least, most);
        visit(Gene { field, name, unit: "", range }, &mut connection.scale);
    }
}

impl BodySpace {
    /// Widens the space so that it contains a creature.
    pub(in crate::genome) fn widen_for_creature(&mut self, nodes: &[BodyNode]) {
        let widen = |[least, most]: [&mut f32; 2], value: f32| {
            (*least, *most) = (least.min(value), most.max(value));
        };
        let grown = grow(nodes);
        for part in &grown {
            let [width_m, length_m, height_m] = part.size_m;
            widen([&mut self.length_min_m, &mut self.length_max_m], length_m);
            for side_m in [width_m, height_m] {
                widen([&mut self.thickness_min_m, &mut self.thickness_max_m], side_m);
            }
        }
        for node in nodes {
            let [bend, twist] = [node.bend_limit_rad, node.twist_limit_rad];
            widen([&mut self.bend_limit_min_rad, &mut self.bend_limit_max_rad], bend);
            widen([&mut self.twist_limit_min_rad, &mut self.twist_limit_max_rad], twist);
            self.strength_min = self.strength_min.min(node.strength);
        }
        let body = bare_plan(nodes, &grown);
        self.volume_m3 = body.volume_m3();
        self.longest_m = self.longest_m.max(body.length_m());
    }
}

/// Hashes what is not a number: joints, sides, and who grows from whom.
pub fn hash_structure(nodes: &[BodyNode], hash: &mut Xxh3Default) {
    for node in nodes {
        hash.update(&[node.joint as u8, node.copies as u8, node.connections.len() as u8]);
        for of in &node.connections {
            let flags = [of.is_mirrored, of.is_terminal].map(u8::from);
            hash.update(&[of.to as u8, of.side as u8, flags[0], flags[1]]);
        }
    }
}
