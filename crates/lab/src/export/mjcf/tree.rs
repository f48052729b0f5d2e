//! The tree of a body's parts, with their hinges.

use std::io;

use super::super::xml_text::{XmlText, spaced};
use super::{LIMB_COLORS, LOCKED_RAD, OTHER_FRICTION, head_start, part_name, rgba};
use snakes_core::world::{JointPlan, PartPlan, Rotation, SpringPlan, Vector, WorldPlan};

/// Writes the parts, each within its parent, beginning with the head.
pub(super) fn limbs(xml: &mut XmlText, plan: &WorldPlan) -> io::Result<()> {
    let name = part_name(&plan.body, 0);
    let (at_m, turn_rad) = head_start(plan);
    let (sin, cos) = libm::sincosf(turn_rad / 2.0);
    let place = [("pos", spaced(at_m)), ("quat", spaced([cos, 0.0, 0.0, sin]))];
    let [pos, quat] = place;
    xml.open("body", &[("name", name), pos, quat])?;
    xml.leaf("freejoint", &[("name", "free".into())])?;
    // The camera follows the snake from its right-hand side.
    xml.leaf(
        "camera",
        &[
            ("name", "follow".into()),
            ("mode", "trackcom".into()),
            ("pos", "13 -9 6".into()),
            ("xyaxes", "0.33 0.944 0 -0.4 0.14 0.905".into()),
        ],
    )?;
    part(xml, plan, 0)?;
    xml.close("body")
}

/// Writes the box of a part, and within it all parts that are joined to it from behind, in the order of the plan.
fn part(xml: &mut XmlText, plan: &WorldPlan, index: usize) -> io::Result<()> {
    let body = &plan.body;
    let part_plan = &body.parts[index];
    xml.leaf(
        "geom",
        &[
            ("name", part_name(body, index)),
            ("type", "box".into()),
            ("size", spaced(part_plan.size_m().map(|size_m| size_m / 2.0))),
            ("density", part_plan.density_kg_m3.to_string()),
            ("friction", spaced([0.0, OTHER_FRICTION[0], OTHER_FRICTION[1]])),
            ("rgba", rgba(LIMB_COLORS[part_plan.limb % 2])),
        ],
    )?;
    for (number, joint) in (1..).zip(&body.joints).filter(|(_, joint)| joint.parent == index) {
        let child = &body.parts[joint.child];
        let half = Vector::new(0.0, child.length_m / 2.0, 0.0);
        let turn = joint.axes(Rotation::IDENTITY);
        let pos = joint.anchor_m(part_plan.length_m) - turn * half;
        let mut place =
            vec![("name", part_name(body, joint.child)), ("pos", spaced(pos.to_array()))];
        if joint.mount.is_some() {
            place.push(("quat", spaced([turn.w, turn.x, turn.y, turn.z])));
        }
        xml.open("body", &place)?;
        hinges(xml, number, joint, child)?;
        part(xml, plan, joint.child)?;
        xml.close("body")?;
    }
    for spring in body.springs.iter().filter(|spring| spring.parent == index) {
        let child = &body.parts[spring.child];
        let name = part_name(body, spring.child);
        let pos = spaced([0.0, -(part_plan.length_m + child.length_m) / 2.0, 0.0]);
        xml.open("body", &[("name", name.clone()), ("pos", pos)])?;
        spring_hinges(xml, &name, spring, child)?;
        part(xml, plan, spring.child)?;
        xml.close("body")?;
    }
    Ok(())
}

/// Writes the two hinges of a universal joint, at the front face of its rear limb.
fn hinges(xml: &mut XmlText, number: usize, joint: &JointPlan, limb: &PartPlan) -> io::Result<()> {
    let axes = [("bend", "1 0 0", joint.bend_limit_rad), ("twist", "0 1 0", joint.twist_limit_rad)];
    axes.into_iter().try_for_each(|(name, axis, limit_rad)| {
        let limit_rad = limit_rad.max(LOCKED_RAD);
        xml.leaf(
            "joint",
            &[
                ("name", format!("{name} {number}")),
                ("type", "hinge".into()),
                ("axis", axis.into()),
                ("pos", spaced([0.0, limb.length_m / 2.0, 0.0])),
                ("range", spaced([-limit_rad, limit_rad])),
                ("damping", joint.damping_nms_per_rad.to_string()),
            ],
        )
    })
}

/// Writes the three elastic hinges at the front face of a part of a soft limb.
fn spring_hinges(
    xml: &mut XmlText,
    of_part: &str,
    spring: &SpringPlan,
    part: &PartPlan,
) -> io::Result<()> {
    let values = spring.stiffness_nm_per_rad.into_iter().zip(spring.damping_nms_per_rad);
    let axes = [("x", "1 0 0"), ("y", "0 1 0"), ("z", "0 0 1")];
    axes.into_iter().zip(values).try_for_each(|((name, axis), (stiffness, damping))| {
        xml.leaf(
            "joint",
            &[
                ("name", format!("spring {name} {of_part}")),
                ("type", "hinge".into()),
                ("axis", axis.into()),
                ("pos", spaced([0.0, part.length_m / 2.0, 0.0])),
                ("stiffness", stiffness.to_string()),
                ("damping", damping.to_string()),
            ],
        )
    })
}

/// Writes a key frame with the angles of the joints at the start, if they are not all 0.
pub(super) fn start(xml: &mut XmlText, plan: &WorldPlan) -> io::Result<()> {
    let start_rad = |joint: &JointPlan| joint.mount.map_or([0.0; 2], |mount| mount.start_rad);
    if plan.body.joints.iter().all(|joint| start_rad(joint) == [0.0; 2]) {
        return Ok(());
    }
    let (at_m, turn_rad) = head_start(plan);
    let (sin, cos) = libm::sincosf(turn_rad / 2.0);
    let mut numbers = vec![at_m[0], at_m[1], at_m[2], cos, 0.0, 0.0, sin];
    // MuJoCo lists one branch to its end before the next.
    let mut left = vec![0];
    while let Some(part) = left.pop() {
        let of_part = plan.body.joints.iter().find(|joint| joint.child == part);
        numbers.extend(of_part.map(start_rad).into_iter().flatten());
        let children = plan.body.joints.iter().filter(|joint| joint.parent == part);
        left.extend(children.rev().map(|joint| joint.child));
    }
    xml.element("keyframe", &[], |xml| {
        xml.leaf("key", &[("name", "start".into()), ("qpos", spaced(numbers))])
    })
}
