//! Checks whether a creature can be built.

use super::genes::node_genes;
use super::growth::{bare_plan, grow};
use super::node::{BodyNode, MOST_NODES};
use crate::check::{Invalid, within};
use crate::genome::chain::{INERTIA_RATIO, check_pair, inertia_kg_m2};
use crate::genome::gene::check_limits;
use crate::genome::limits::SIZE_RANGE_M;
use crate::genome::space::GenomeSpace;
use crate::world::BodyPlan;

/// Greatest height of the centre of mass before a trial, in metres. A taller body could gain by falling over.
const HIGHEST_M: f32 = 1.5;

/// Checks every value of a graph.
///
/// # Errors
/// Returns the first value that is not allowed.
pub fn check_nodes(nodes: &[BodyNode]) -> Result<(), Invalid> {
    within("nodes", nodes.len(), 1..=MOST_NODES)?;
    for (index, node) in nodes.iter().enumerate() {
        node.check(nodes.len()).map_err(|error| error.inside(&format!("nodes[{index}]")))?;
    }
    check_limits(|genes| node_genes(&mut nodes.to_vec(), &GenomeSpace::default(), genes))
}

/// Checks every value of a graph, and that the creature that grows from it can be built.
///
/// # Errors
/// Returns the first violation.
pub fn check_creature(nodes: &[BodyNode]) -> Result<(), Invalid> {
    check_nodes(nodes)?;
    check_built(&bare_plan(nodes, &grow(nodes)), INERTIA_RATIO)
}

/// Checks that a grown body can be built: see `check_creature`.
///
/// # Errors
/// Returns an error if the body has a single part, if neighbours differ too much, or if the body is too tall.
pub(super) fn check_built(body: &BodyPlan, largest_inertia: f64) -> Result<(), Invalid> {
    if body.joints.is_empty() {
        return Err(Invalid::new("nodes", "a graph of which one part grows", "at least two parts"));
    }
    for (index, part) in body.parts.iter().enumerate() {
        for size_m in part.size_m() {
            within(&format!("size of part {}", index + 1), size_m, SIZE_RANGE_M)?;
        }
    }
    for joint in &body.joints {
        let ends = [joint.parent, joint.child];
        let masses = ends.map(|part| f64::from(body.parts[part].mass_kg()));
        let inertia = |end: usize| inertia_kg_m2(masses[end], body.parts[ends[end]].size_m());
        let names = format_args!("parts {} and {}", ends[0] + 1, ends[1] + 1);
        check_pair(names, [masses, [inertia(0), inertia(1)]], largest_inertia)?;
    }
    let poses = body.rest_poses();
    let moment: f32 =
        poses.iter().zip(&body.parts).map(|(pose, part)| pose.translation.z * part.mass_kg()).sum();
    let height_m = moment / body.mass_kg();
    if height_m > HIGHEST_M {
        let field = "height of the centre of mass";
        return Err(Invalid::new(field, format!("{height_m:.2} m"), format!("0 to {HIGHEST_M} m")));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::growth::tests::{node, to};
    use super::super::node::BodySide;
    use super::*;

    fn refusal(nodes: &[BodyNode]) -> String {
        check_creature(nodes).expect_err("refused").to_string()
    }

    #[test]
    fn what_cannot_be_built_is_refused_with_its_reason() {
        let leaf = || node(1, Vec::new());
        let pair = |side| vec![node(1, vec![to(1, side)]), leaf()];
        check_creature(&pair(BodySide::Rear)).expect("two parts in a row");
        assert!(refusal(&[leaf()]).starts_with("nodes is a graph of which one part grows"));
        assert!(refusal(&[]).starts_with("nodes is 0; allowed: 1 to 16"));
        let many = vec![leaf(); 17];
        assert!(refusal(&many).starts_with("nodes is 17; allowed: 1 to 16"));
        let tower = [node(5, vec![to(0, BodySide::Rear)]), leaf()];
        check_creature(&tower).expect("a chain");
        let mut tall = pair(BodySide::Rear);
        tall[0].height_m = 4.0;
        tall[1].height_m = 4.0;
        assert!(refusal(&tall).starts_with("height of the centre of mass is 2.00 m"));
        let mut light = pair(BodySide::Rear);
        light[0].connections[0].scale = 0.5;
        light[1].density_kg_m3 = 2.0;
        assert!(refusal(&light).starts_with("masses of parts 1 and 2 is in the ratio 10.0"));
    }

    #[test]
    fn hostile_values_are_refused_with_their_place() {
        let error = |change: fn(&mut Vec<BodyNode>)| {
            let mut nodes = vec![node(1, vec![to(1, BodySide::Rear)]), node(1, Vec::new())];
            change(&mut nodes);
            refusal(&nodes)
        };
        for (change, expected) in [
            (
                (|nodes| nodes[0].copies = 9) as fn(&mut Vec<BodyNode>),
                "nodes[0].copies is 9; allowed: 1 to 5",
            ),
            (
                |nodes| nodes[0].connections[0].to = 7,
                "nodes[0].connections[0].to is 7; allowed: 0 to 1",
            ),
            (
                |nodes| nodes[0].connections = vec![to(1, BodySide::Rear); 4],
                "nodes[0].connections is 4; allowed: 0 to 3",
            ),
        ] {
            assert_eq!(error(change), expected);
        }
    }
}
