//! A node of the graph: the plan of a part, with the parts that grow from it.

use serde::{Deserialize, Serialize};

use crate::check::{Invalid, within};
use crate::schema::{listed_values, named_values};

/// Largest number of nodes of a graph: a part of its own for each.
pub const MOST_NODES: usize = 16;
/// Largest number of connections of a node.
pub const MOST_CONNECTIONS: usize = 3;
/// Largest number of parts of one node along a path from the first part.
pub const MOST_COPIES: u32 = 5;

/// The plan of a part.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyNode {
    /// Size along the part, away from its joint, in metres. Like the other sizes it is that of a part whose factor of size is 1.
    pub length_m: f32,
    /// Size across it, in metres.
    pub width_m: f32,
    /// Height, in metres.
    pub height_m: f32,
    /// Density, in kg/m³.
    pub density_kg_m3: f32,
    /// The axes about which its joint turns. The joint of the first part waits until the node grows from another.
    pub joint: NodeJoint,
    /// Largest bend to either side of the middle of the range, in radians.
    pub bend_limit_rad: f32,
    /// Largest twist to either side of the middle, in radians.
    pub twist_limit_rad: f32,
    /// Bend in the built pose, from -1 to 1 times the limit: at 0 the joint turns as far up as down.
    pub bend_start: f32,
    /// Twist in the built pose, likewise.
    pub twist_start: f32,
    /// Share of the torque that its joint could have by its cross-section, from 0 to 1.
    pub strength: f32,
    /// How many parts along a path from the first may be of this node.
    pub copies: u32,
    /// The parts that grow from it.
    pub connections: Vec<Connection>,
}

named_values! {
    /// The axes about which a joint turns. Universal, bend-twist and twist-bend joints of Sims are one here: the engine's joint
    /// locks the third axis and knows no order of the other two. His spherical joint is left out, because every joint of this
    /// program has two driven axes.
    #[derive(Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum NodeJoint {
        /// No axis: the joint holds the part in its place.
        Rigid = "rigid";
        /// It bends.
        Revolute = "revolute";
        /// It twists.
        Twist = "twist";
        /// It bends and twists.
        Universal = "universal";
    }
}

listed_values! {
    /// A side of a part.
    #[derive(Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum BodySide {
        /// Opposite its joint.
        Rear;
        /// At smaller x.
        Left;
        /// At larger x.
        Right;
        /// Above.
        Top;
        /// Below.
        Bottom;
        /// Where its joint is. Only the first part has room there; for others it counts as the rear.
        Front;
    }
}

/// A connection: where a part grows from another.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Connection {
    /// Index of the node of the part that grows.
    pub to: u32,
    /// The side that it grows from.
    pub side: BodySide,
    /// Place on that side, from its middle to an edge: -1 to 1 along x, on the left and right along y; and -1 to 1 along z, above
    /// and below along y.
    pub place: [f32; 2],
    /// Rotations of the part against the right angle that it would have with the side, in radians: upwards about its x axis,
    /// sideways about its z axis, and about its own length.
    pub turn_rad: [f32; 3],
    /// Factor of size, which all that grows from the part inherits.
    pub scale: f32,
    /// Whether a second part grows as the mirror image of the first, on the other side of the plane x = 0 of the part.
    pub is_mirrored: bool,
    /// Whether it only counts where no other connection of the part can be followed any more, as that of a hand at the end of an
    /// arm.
    pub is_terminal: bool,
}

impl NodeJoint {
    /// Whether it bends, and whether it twists.
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
    /// Size across x, along y and along z, in metres.
    pub fn size_m(&self) -> [f32; 3] {
        [self.width_m, self.length_m, self.height_m]
    }

    /// Its sizes across x, along y and along z, in metres, to be changed.
    pub(super) fn sizes_mut(&mut self) -> [&mut f32; 3] {
        [&mut self.width_m, &mut self.length_m, &mut self.height_m]
    }

    /// Checks all that is not a gene; the graph has this many nodes.
    ///
    /// # Errors
    /// The first value that is not allowed.
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
