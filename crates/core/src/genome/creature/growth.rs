//! Growth: from the graph of nodes to the tree of parts.

use super::node::{BodyNode, BodySide, Connection};
use super::overlap::{PlacedBox, overlap};
use crate::world::{
    BodyPlan, JointPlan, Mount, PartPlan, Pose, Rotation, Vector, joint_turn, neighbours_pass,
};

/// Largest number of parts of a creature. Growth stops at this number.
pub const MOST_PARTS: usize = 16;
/// Largest number of joints from the first part to any other.
pub const MOST_DEPTH: usize = 6;
/// Largest number of parts that grow from one part.
const MOST_CHILDREN: usize = 3;

/// A part that has grown from a graph.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GrownPart {
    /// Index of the node of which the part has grown.
    pub node: usize,
    /// Index of the part from which this part has grown; `None` for the first part.
    pub parent: Option<usize>,
    /// Size of the part across x, along y and along z, in metres.
    pub size_m: [f32; 3],
    /// Place on the parent at which the joint holds the part.
    pub mount: Mount,
    /// Whether the part is a mirror image of its node's plan.
    pub is_mirrored: bool,
}

/// A part from which others may still grow, with the state of its growth.
struct Bud {
    /// For each node, the number of its parts on the path from the first part to this one, both included.
    counts: Vec<u32>,
    scale: f32,
    depth: usize,
    /// Pose and size of the part, if the first part stands at the origin.
    placed: PlacedBox,
}

/// Grows the parts of a graph: parents before their children, and each generation in the order of the lists. A part of a node grows from
/// another part as long as the path to it has fewer parts of this node than the node allows. If none of a part's connections that are not
/// terminal can be followed any more, its terminal connections apply. Parts beyond the largest number do not grow, nor do parts that would
/// lie inside another part. Sims discarded creatures with such parts, but most random creatures have some.
pub fn grow(nodes: &[BodyNode]) -> Vec<GrownPart> {
    let Some(first) = nodes.first() else { return Vec::new() };
    let mut counts = vec![0; nodes.len()];
    counts[0] = 1;
    let pose = Pose::from_parts(Vector::ZERO, Rotation::IDENTITY);
    let first_box = PlacedBox { pose, size_m: first.size_m() };
    let mut buds = vec![Bud { counts, scale: 1.0, depth: 0, placed: first_box }];
    let mount = Mount { at_m: Vector::ZERO, turn: Rotation::IDENTITY, start_rad: [0.0; 2] };
    let size_m = first.size_m();
    let mut parts = vec![GrownPart { node: 0, parent: None, size_m, mount, is_mirrored: false }];
    let mut index = 0;
    while index < parts.len() {
        let (part, bud) = (parts[index], &buds[index]);
        let (scale, depth) = (bud.scale, bud.depth);
        let grows: Vec<&Connection> =
            if depth < MOST_DEPTH { followed(nodes, part.node, &bud.counts) } else { Vec::new() };
        let images = grows.into_iter().flat_map(|connection| {
            let images: &[bool] = if connection.is_mirrored { &[false, true] } else { &[false] };
            images.iter().map(move |image| (connection, *image))
        });
        let mut children = 0;
        for (connection, is_image) in images {
            if children == MOST_CHILDREN || parts.len() == MOST_PARTS {
                break;
            }
            let node = connection.to as usize;
            let mut counts = buds[index].counts.clone();
            counts[node] += 1;
            let scale = scale * connection.scale;
            let is_mirrored = part.is_mirrored != is_image;
            let child = GrownPart {
                node,
                parent: Some(index),
                size_m: nodes[node].size_m().map(|size_m| size_m * scale),
                mount: mount_of(connection, &part, &nodes[node], is_mirrored),
                is_mirrored,
            };
            let pose = child.mount.place(&buds[index].placed.pose, child.size_m[1]);
            let placed = PlacedBox { pose, size_m: child.size_m };
            let is_inside = |(other, bud): (usize, &Bud)| {
                other != index
                    && overlap([&bud.placed, &placed])
                    && !(part.parent == Some(other) && is_short(&parts[other], &part, &child))
            };
            if buds.iter().enumerate().any(is_inside) {
                continue;
            }
            children += 1;
            parts.push(child);
            buds.push(Bud { counts, scale, depth: depth + 1, placed });
        }
        index += 1;
    }
    parts
}

/// Returns the connections of a node that a part of it follows, given the number of parts of each node on the part's path.
fn followed<'a>(nodes: &'a [BodyNode], node: usize, counts: &[u32]) -> Vec<&'a Connection> {
    let all = nodes[node].connections.iter().filter(|connection| {
        let to = connection.to as usize;
        counts.get(to).is_some_and(|count| *count < nodes[to].copies)
    });
    let (terminal, inner): (Vec<_>, Vec<_>) = all.partition(|connection| connection.is_terminal);
    if inner.is_empty() { terminal } else { inner }
}

/// Computes where a part is held on its parent.
fn mount_of(
    connection: &Connection,
    parent: &GrownPart,
    node: &BodyNode,
    is_mirrored: bool,
) -> Mount {
    let [half_x, half_y, half_z] = parent.size_m.map(|size_m| size_m / 2.0);
    let [u, v] = connection.place;
    let half_turn = std::f32::consts::FRAC_1_SQRT_2;
    let about = |x: f32, z: f32| Rotation::from_xyzw(x, 0.0, z, half_turn);
    // The part extends backwards from its joint. The rotation of each side turns this direction outwards.
    let (at_m, side) = match connection.side {
        BodySide::Front if parent.parent.is_none() => {
            ([u * half_x, half_y, v * half_z], Rotation::from_xyzw(0.0, 0.0, 1.0, 0.0))
        }
        BodySide::Front | BodySide::Rear => ([u * half_x, -half_y, v * half_z], Rotation::IDENTITY),
        BodySide::Left => ([-half_x, u * half_y, v * half_z], about(0.0, -half_turn)),
        BodySide::Right => ([half_x, u * half_y, v * half_z], about(0.0, half_turn)),
        BodySide::Top => ([u * half_x, v * half_y, half_z], about(-half_turn, 0.0)),
        BodySide::Bottom => ([u * half_x, v * half_y, -half_z], about(half_turn, 0.0)),
    };
    let [up, aside, along] = connection.turn_rad.map(|turn_rad| {
        let (sin, cos) = libm::sincosf(turn_rad / 2.0);
        [sin, cos]
    });
    let turn = side
        * Rotation::from_xyzw(0.0, 0.0, aside[0], aside[1])
        * Rotation::from_xyzw(up[0], 0.0, 0.0, up[1])
        * Rotation::from_xyzw(0.0, along[0], 0.0, along[1]);
    let (mut at_m, mut turn) = (Vector::from(at_m), turn.normalize());
    let [bends, twists] = node.joint.turns();
    let start =
        |turns: bool, share: f32, limit_rad: f32| if turns { share * limit_rad } else { 0.0 };
    let bend_rad = start(bends, node.bend_start, node.bend_limit_rad);
    let mut twist_rad = start(twists, node.twist_start, node.twist_limit_rad);
    if is_mirrored {
        at_m.x = -at_m.x;
        turn = Rotation::from_xyzw(turn.x, -turn.y, -turn.z, turn.w);
        twist_rad = -twist_rad;
    }
    // The connection determines the rotation of the part in the built pose. The middle of the joint's range deviates from it.
    let start_rad = [bend_rad, twist_rad];
    Mount { at_m, turn: turn * joint_turn(start_rad).inverse(), start_rad }
}

/// Builds the body that has grown, with joints without torque and damping: its sizes, masses and places.
pub fn bare_plan(nodes: &[BodyNode], grown: &[GrownPart]) -> BodyPlan {
    let part = |(limb, part): (usize, &GrownPart)| {
        let [width_m, length_m, height_m] = part.size_m;
        let density_kg_m3 = nodes[part.node].density_kg_m3;
        PartPlan { limb, width_m, length_m, height_m, density_kg_m3 }
    };
    let parts: Vec<PartPlan> = grown.iter().enumerate().map(part).collect();
    let joint = |(child, part): (usize, &GrownPart)| {
        let node = &nodes[part.node];
        let [bends, twists] = node.joint.turns();
        let parent = part.parent?;
        Some(JointPlan {
            parent,
            child,
            mount: Some(part.mount),
            bend_limit_rad: if bends { node.bend_limit_rad } else { 0.0 },
            twist_limit_rad: if twists { node.twist_limit_rad } else { 0.0 },
            max_bend_torque_nm: 0.0,
            max_twist_torque_nm: 0.0,
            damping_nms_per_rad: 0.0,
            gap_scale: parts[child].smallest_side_m().min(parts[parent].smallest_side_m()),
            cfm_m_s_per_n: 0.0,
        })
    };
    let mut body = BodyPlan {
        joints: grown.iter().enumerate().filter_map(joint).collect(),
        contact_free_pairs: contact_free_pairs(grown),
        middle_part: 0,
        parts,
        springs: Vec::new(),
        angular_damping_per_s: 0.0,
        holding_w_per_n2m2: 0.0,
    };
    body.middle_part = body.branching_middle();
    body
}

/// Returns whether a part is so short that its neighbours pass through each other.
fn is_short(front: &GrownPart, middle: &GrownPart, rear: &GrownPart) -> bool {
    neighbours_pass(middle.size_m[1], [front.size_m[2], rear.size_m[2]])
}

/// Returns the pairs of parts that pass through each other, because a short part lies between them: a part and its grandchild.
fn contact_free_pairs(grown: &[GrownPart]) -> Vec<[usize; 2]> {
    let pairs = grown.iter().enumerate().filter_map(|(index, part)| {
        let middle = grown.get(part.parent?)?;
        let first = middle.parent?;
        is_short(&grown[first], middle, part).then_some([first, index])
    });
    pairs.collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::node::NodeJoint;
    use super::*;
    use crate::world::Pose;

    pub fn node(copies: u32, connections: Vec<Connection>) -> BodyNode {
        BodyNode {
            length_m: 2.0,
            width_m: 1.0,
            height_m: 0.5,
            density_kg_m3: 2.5,
            joint: NodeJoint::Universal,
            bend_limit_rad: 1.0,
            twist_limit_rad: 0.5,
            bend_start: 0.0,
            twist_start: 0.0,
            strength: 1.0,
            copies,
            connections,
        }
    }

    pub fn to(node: u32, side: BodySide) -> Connection {
        Connection {
            to: node,
            side,
            place: [0.0; 2],
            turn_rad: [0.0; 3],
            scale: 1.0,
            is_mirrored: false,
            is_terminal: false,
        }
    }

    fn poses(nodes: &[BodyNode]) -> Vec<Pose> {
        bare_plan(nodes, &grow(nodes)).rest_poses()
    }

    fn assert_near(found: Vector, expected: [f32; 3]) {
        let off = (found - Vector::from(expected)).length();
        assert!(off < 1e-5, "{found:?}, not {expected:?}");
    }

    #[test]
    fn a_node_that_follows_itself_grows_a_chain_with_a_hand_at_its_end() {
        let hand = Connection { is_terminal: true, scale: 0.5, ..to(1, BodySide::Rear) };
        let nodes = [node(4, vec![to(0, BodySide::Rear), hand]), node(1, Vec::new())];
        let grown = grow(&nodes);
        assert_eq!(grown.iter().map(|part| part.node).collect::<Vec<_>>(), [0, 0, 0, 0, 1]);
        let parents: Vec<_> = grown.iter().map(|part| part.parent).collect();
        assert_eq!(parents, [None, Some(0), Some(1), Some(2), Some(3)]);
        assert_eq!(grown[4].size_m, [0.5, 1.0, 0.25]);
        let poses = poses(&nodes);
        for (index, y_m) in [-1.0, -3.0, -5.0, -7.0, -8.5].into_iter().enumerate() {
            assert_near(poses[index].translation, [0.0, y_m, 0.25]);
        }
    }

    #[test]
    fn a_graph_without_recursion_grows_each_connection() {
        let nodes =
            [node(1, vec![to(1, BodySide::Left), to(1, BodySide::Right)]), node(1, Vec::new())];
        assert_eq!(grow(&nodes).len(), 3);
        let poses = poses(&nodes);
        assert_near(poses[1].translation, [-1.5, -1.0, 0.25]);
        assert_near(poses[2].translation, [1.5, -1.0, 0.25]);
        // The length of both parts lies across the body.
        assert_near(poses[1].rotation * Vector::Y, [1.0, 0.0, 0.0]);
        assert_near(poses[2].rotation * Vector::Y, [-1.0, 0.0, 0.0]);
    }

    #[test]
    fn a_mirrored_leg_stands_and_moves_as_the_mirror_image_of_the_first() {
        let mut leg = to(1, BodySide::Left);
        (leg.place, leg.turn_rad, leg.is_mirrored) = ([0.3, -0.2], [0.4, 0.3, 0.2], true);
        let mut foot = to(2, BodySide::Bottom);
        (foot.place, foot.turn_rad) = ([0.5, 0.1], [-0.3, 0.2, 0.6]);
        let mut nodes = [node(1, vec![leg]), node(1, vec![foot]), node(1, Vec::new())];
        (nodes[1].bend_start, nodes[1].twist_start) = (0.5, -0.5);
        (nodes[2].bend_start, nodes[2].twist_start) = (-0.2, 0.9);
        let poses = poses(&nodes);
        assert_eq!(poses.len(), 5);
        for [left, right] in [[1, 2], [3, 4]] {
            let [left, right] = [left, right].map(|part| &poses[part]);
            let mirrored = |at: Vector| [-at.x, at.y, at.z];
            assert_near(right.translation, mirrored(left.translation));
            for axis in [Vector::Y, Vector::Z] {
                assert_near(right.rotation * axis, mirrored(left.rotation * axis));
            }
        }
    }

    #[test]
    fn sides_face_outwards() {
        for (side, outwards) in [
            (BodySide::Rear, [0.0, -1.0, 0.0]),
            (BodySide::Front, [0.0, 1.0, 0.0]),
            (BodySide::Left, [-1.0, 0.0, 0.0]),
            (BodySide::Right, [1.0, 0.0, 0.0]),
            (BodySide::Top, [0.0, 0.0, 1.0]),
            (BodySide::Bottom, [0.0, 0.0, -1.0]),
        ] {
            let nodes = [node(1, vec![to(1, side)]), node(1, Vec::new())];
            let poses = poses(&nodes);
            assert_near(poses[1].rotation * -Vector::Y, outwards);
            let way = poses[1].translation - poses[0].translation;
            assert!(way.dot(Vector::from(outwards)) > 0.9, "{side:?}: {way:?}");
        }
    }

    #[test]
    fn an_asymmetric_joint_stands_as_its_connection_says() {
        let mut nodes = [node(1, vec![to(1, BodySide::Rear)]), node(1, Vec::new())];
        (nodes[1].bend_start, nodes[1].twist_start) = (0.8, -0.6);
        let poses = poses(&nodes);
        assert_near(poses[1].rotation * Vector::Y, [0.0, 1.0, 0.0]);
        assert_near(poses[1].translation, [0.0, -3.0, 0.25]);
    }

    #[test]
    fn what_would_lie_inside_another_part_does_not_grow() {
        let leaf = node(1, Vec::new());
        let twins = [node(1, vec![to(1, BodySide::Left), to(1, BodySide::Left)]), leaf.clone()];
        assert_eq!(grow(&twins).len(), 2);
        // The mirror image of a part in the middle would lie inside the part.
        let middle = Connection { is_mirrored: true, ..to(1, BodySide::Rear) };
        assert_eq!(grow(&[node(1, vec![middle]), leaf]).len(), 2);
        // Parts that grow in a square: the fifth one would lie inside the first.
        let mut around = to(0, BodySide::Left);
        around.place = [-1.0, 0.0];
        let mut square = node(5, vec![around]);
        (square.width_m, square.length_m) = (1.0, 2.0);
        assert!(grow(&[square]).len() < 5);
    }

    #[test]
    fn growth_is_bounded_whatever_the_graph() {
        let all = |side| Connection { is_mirrored: true, ..to(0, side) };
        let bomb = node(5, vec![all(BodySide::Left), all(BodySide::Rear), all(BodySide::Top)]);
        assert!((8..=MOST_PARTS).contains(&grow(&[bomb]).len()));
        let chain: Vec<_> =
            (0..16).map(|next| node(5, vec![to((next + 1) % 16, BodySide::Rear)])).collect();
        assert_eq!(grow(&chain).len(), MOST_DEPTH + 1);
        assert!(grow(&[]).is_empty());
    }
}
