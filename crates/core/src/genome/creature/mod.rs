//! Branching bodies after Sims (1994): a directed graph of nodes, which grows into a tree of parts.
//!
//! A node is a plan for a part, and a connection tells where another part grows from it. Several connections may lead to a node, also from
//! the node itself, so that a small graph can have many legs.

mod check;
mod genes;
mod graph;
mod growth;
mod newborn;
mod node;
mod overlap;
mod repair;
mod space;
mod tree;
mod variation;

pub(super) use check::check_creature;
pub(super) use genes::{hash_structure, node_genes};
pub use growth::{GrownPart, MOST_PARTS, bare_plan, grow};
pub use node::{BodyNode, BodySide, Connection, MOST_NODES, NodeJoint};
pub use space::{CreatureSpace, NeuronSet};
pub use tree::joint_tree;
pub use variation::CreatureChange;
