//! The tree of joints of a creature, as a text that distinguishes shapes.

use super::growth::grow;
use super::node::{BodyNode, NodeJoint};

/// Returns the tree of joints that grows from a graph as a text: for each part a letter for its joint, and in parentheses the parts that
/// grow from it, in an order that does not depend on the graph. The first part is O; F is a rigid joint, R a revolute one, T one that
/// twists, U a universal one. Two creatures have the same text if their parts are joined alike, wherever the joints are.
pub fn joint_tree(nodes: &[BodyNode]) -> String {
    let grown = grow(nodes);
    let mut texts: Vec<String> = vec![String::new(); grown.len()];
    let mut children: Vec<Vec<String>> = vec![Vec::new(); grown.len()];
    // Children come after their parents, so that their texts are complete when the parent's is made.
    for (index, part) in grown.iter().enumerate().rev() {
        let letter = match part.parent.map(|_| nodes[part.node].joint) {
            None => 'O',
            Some(NodeJoint::Rigid) => 'F',
            Some(NodeJoint::Revolute) => 'R',
            Some(NodeJoint::Twist) => 'T',
            Some(NodeJoint::Universal) => 'U',
        };
        let mut inner = std::mem::take(&mut children[index]);
        inner.sort();
        let inner = if inner.is_empty() { String::new() } else { format!("({})", inner.join(" ")) };
        texts[index] = format!("{letter}{inner}");
        if let Some(parent) = part.parent {
            children[parent].push(texts[index].clone());
        }
    }
    texts.into_iter().next().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::super::growth::tests::{node, to};
    use super::super::node::BodySide;
    use super::*;

    #[test]
    fn the_order_of_connections_does_not_change_the_tree() {
        let mut hinge = node(1, Vec::new());
        hinge.joint = NodeJoint::Revolute;
        let arm = node(1, vec![to(2, BodySide::Rear)]);
        let tree = |connections| joint_tree(&[node(1, connections), arm.clone(), hinge.clone()]);
        let one = tree(vec![to(1, BodySide::Left), to(2, BodySide::Right)]);
        assert_eq!(one, "O(R U(R))");
        assert_eq!(tree(vec![to(2, BodySide::Left), to(1, BodySide::Rear)]), one);
        assert_ne!(tree(vec![to(2, BodySide::Left)]), one);
        assert_eq!(joint_tree(&[]), "");
    }
}
