//! A node of the graph: the plan of a part, with connections to the parts that grow from it.

use serde::{Deserialize, Serialize};

use crate::check::{Invalid, within};
use crate::schema::{listed_values, named_values};

/// Largest number of nodes of a graph, so that each node can have a part.
pub const MOST_NODES: usize = 16;
/// Largest number of connections of a node.
pub const MOST_CONNECTIONS: usize = 3;
/// Largest number of parts of one node along a path from the first part.
pub const MOST_COPIES: u32 = 5;

/// The plan of a part of a creature.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyNode {
    /// Size along the part, away from its joint, in metres. All three sizes are those of a part whose factor of size is 1.
    pub length_m: f32,
    /// Size across the part, in metres.
    pub width_m: f32,
    /// Height of the part, in metres.
    pub height_m: f32,
    /// Density of the part, in kg/m³.
    pub density_kg_m3: f32,
    /// Axes about which the part's joint turns. For the first part, the joint has no effect until the node also grows from another part.
    pub joint: NodeJoint,
    /// Largest bend of the joint to either side of the middle of its range, in radians.
    pub bend_limit_rad: f32,
    /// Largest twist to either side of the middle of the range, in radians.
    pub twist_limit_rad: f32,
    /// Bend in the built pose, from -1 to 1 times the limit. With 0, the joint can turn as far up as down.
    pub bend_start: f32,
    /// Twist in the built pose, from -1 to 1 times the limit.
    pub twist_start: f32,
    /// Strength of the part's joint, from 0 to 1, as a share of the torque that its cross-section allows.
    pub strength: f32,
    /// Largest number of parts of this node along a path from the first part.
    pub copies: u32,
    /// Connections to the parts that grow from the node's parts.
    pub connections: Vec<Connection>,
}

named_values! {
    /// The axes about which a joint turns. Universal, bend-twist and twist-bend joints of Sims are one kind in this program: the engine's
    /// joint locks the third axis and has no order of the other two. His spherical joint is left out, because every joint of this program
    /// has at most two driven axes.
    #[derive(Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum NodeJoint {
        /// The joint has no axis and holds the part in its place.
        Rigid = "rigid";
        /// The joint bends.
        Revolute = "revolute";
        /// The joint twists.
        Twist = "twist";
        /// The joint bends and twists.
        Universal = "universal";
    }
}

listed_values! {
    /// The side of a part from which another part grows.
    #[derive(Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum BodySide {
        /// The side opposite the part's joint.
        Rear;
        /// The side at smaller x.
        Left;
        /// The side at larger x.
        Right;
        /// The upper side.
        Top;
        /// The lower side.
        Bottom;
        /// The side of the part's joint. Only the first part has room on this side; for other parts it counts as the rear.
        Front;
    }
}

/// A connection of the graph: where one part grows from another.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Connection {
    /// Index of the node to which the growing part belongs.
    pub to: u32,
    /// Side of the parent from which the part grows.
    pub side: BodySide,
    /// Place on the side, from -1 to 1 between two edges; 0 is the middle. The first number is along x, but on the left and right along y.
    /// The second is along z, but above and below along y.
    pub place: [f32; 2],
    /// Rotations of the part away from a right angle to the side, in radians: upwards about its x axis, sideways about its z axis, and
    /// about its own length.
    pub turn_rad: [f32; 3],
    /// Factor of size. All parts that grow from the part inherit it.
    pub scale: f32,
    /// Whether a second part grows as the mirror image of the first, on the other side of the parent's plane x = 0.
    pub is_mirrored: bool,
    /// Whether the connection only counts where no other connection of the part can be followed any more, as for a hand at the end of an
    /// arm.
    pub is_terminal: bool,
}

impl NodeJoint {
    /// Returns whether the joint bends, and whether it twists.
    pub fn turns(self) -> [bool; 2] {
        match self {
            Self::Rigid => [false, false],
            Self::Revolute => [true, false],
            Self::Twist => [false, true],
            Self::Universal => [true, true],
        }
    }
}

impl BodyNode {
    /// Returns the sizes across x, along y and along z, in metres.
    pub fn size_m(&self) -> [f32; 3] {
        [self.width_m, self.length_m, self.height_m]
    }

    /// Returns the sizes across x, along y and along z, in metres, for changes.
    pub(super) fn sizes_mut(&mut self) -> [&mut f32; 3] {
        [&mut self.width_m, &mut self.length_m, &mut self.height_m]
    }

    /// Checks the values of the node that are not genes, for a graph with this many nodes.
    ///
    /// # Errors
    /// Returns the first value that is not allowed.
    pub(super) fn check(&self, nodes: usize) -> Result<(), Invalid> {
        within("copies", self.copies, 1..=MOST_COPIES)?;
        within("connections", self.connections.len(), 0..=MOST_CONNECTIONS)?;
        for (index, connection) in self.connections.iter().enumerate() {
            let most = nodes.saturating_sub(1);
            within(&format!("connections[{index}].to"), connection.to as usize, 0..=most)?;
        }
        Ok(())
    }
}
