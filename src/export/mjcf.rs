//! The body and its world as a model for MuJoCo (MJCF).
//!
//! A universal joint becomes two hinges in the rear limb, first the bend, then the twist. Lengths, masses, inertias,
//! limits, damping, torques, friction and stairs are the same; [`left_out`] lists what MJCF cannot say. The joints of a
//! branching body are at 0 in the middle of their ranges; a key frame has the angles at the start.

use std::io;

use super::facts::{Fact, generator};
use super::xml_text::{XmlText, spaced};
use crate::world::{
    BodyPlan, JointPlan, PartPlan, Rotation, SpringPlan, Surface, Vector, WorldPlan,
};

/// Limit of a hinge that must not move, in rad: MuJoCo demands a range that is not empty.
const LOCKED_RAD: f32 = 1.0e-4;
/// Torque of a motor without torque, in N·m, for the same reason.
const POWERLESS_NM: f32 = 1.0e-6;
/// MuJoCo's own coefficients of torsional and rolling friction, which contacts of three dimensions ignore.
const OTHER_FRICTION: [f32; 2] = [0.005, 0.0001];

/// Colours of the limbs in turn, and of steps in turn.
pub(super) const LIMB_COLORS: [[f32; 3]; 2] = [[0.86, 0.13, 0.12], [0.10, 0.27, 0.84]];
pub(super) const STEP_COLORS: [[f32; 3]; 2] = [[0.72, 0.70, 0.66], [0.62, 0.60, 0.57]];

/// The model of a world: ground, stairs and snake, with facts about the champion.
///
/// # Errors
/// The XML library's.
pub fn mjcf(name: &str, plan: &WorldPlan, facts: &[Fact]) -> io::Result<String> {
    XmlText::document(|xml| {
        xml.element("mujoco", &[("model", name.to_owned())], |xml| {
            xml.comment(&generator())?;
            for note in left_out(plan) {
                xml.comment(&format!("Not in this model: {note}"))?;
            }
            settings(xml, plan, facts)?;
            xml.element("worldbody", &[], |xml| {
                surroundings(xml, plan)?;
                limbs(xml, plan)
            })?;
            contacts(xml, plan)?;
            motors(xml, &plan.body)?;
            start(xml, plan)
        })
    })
}

/// Properties of a champion's world that a model for another engine lacks.
pub(super) fn left_out(plan: &WorldPlan) -> Vec<String> {
    let mut notes = Vec::new();
    let mut note = |applies: bool, text: String| {
        if applies {
            notes.push(text);
        }
    };
    let body = &plan.body;
    let air = body.angular_damping_per_s;
    note(air > 0.0, format!("the air takes the limbs' angular velocity at a rate of {air} per s"));
    for (place, surface) in [("stairs", &plan.surface), ("ground", &plan.ground)] {
        let Surface { bounce, soft_cfm_m_s_per_n, slip_m_s_per_n, dampen_per_s, .. } = surface;
        note(*bounce > 0.0, format!("bounce of the {place}, {bounce}"));
        note(
            *soft_cfm_m_s_per_n > 0.0,
            format!("softness of the {place}, {soft_cfm_m_s_per_n} m/s per N"),
        );
        note(*slip_m_s_per_n > 0.0, format!("creep on the {place}, {slip_m_s_per_n} m/s per N"));
        note(*dampen_per_s > 0.0, format!("damping by the {place}, {dampen_per_s} per s"));
    }
    let skin = &plan.skin;
    note(skin.bounce > 0.0, format!("bounce of the skin, {}", skin.bounce));
    let soft = skin.soft_cfm_m_s_per_n;
    note(soft > 0.0, format!("softness of the skin, {soft} m/s per N"));
    let is_soft = |joint: &JointPlan| joint.cfm_m_s_per_n > 0.0;
    note(body.joints.iter().any(is_soft), "softness of the joints".to_owned());
    note(true, "limits beyond which a snake is disqualified".to_owned());
    notes
}

fn settings(xml: &mut XmlText, plan: &WorldPlan, facts: &[Fact]) -> io::Result<()> {
    let yes = || "true".to_owned();
    xml.leaf(
        "compiler",
        &[("angle", "radian".into()), ("autolimits", yes()), ("inertiafromgeom", yes())],
    )?;
    let steps = match plan.explicit_steps() == plan.physics.substeps {
        true => "A step of MuJoCo is a substep of the champion's world.",
        false => {
            "A step of MuJoCo is shorter than a substep of the champion's world, for the springs of its soft limbs."
        }
    };
    xml.comment(steps)?;
    xml.leaf(
        "option",
        &[
            ("timestep", step_s(plan).to_string()),
            ("integrator", "implicitfast".into()),
            ("cone", "elliptic".into()),
            ("gravity", spaced([0.0, 0.0, -plan.physics.gravity_m_s2])),
        ],
    )?;
    xml.element("custom", &[], |xml| {
        let steps = [plan.physics.steps_per_s, plan.explicit_steps()];
        for (name, number) in ["controls_per_s", "steps_per_control"].into_iter().zip(steps) {
            xml.leaf("numeric", &[("name", name.into()), ("data", number.to_string())])?;
        }
        facts.iter().try_for_each(|(name, value)| {
            xml.leaf("text", &[("name", (*name).into()), ("data", value.clone())])
        })
    })?;
    xml.element("visual", &[], |xml| {
        xml.leaf("global", &[("offwidth", "1920".into()), ("offheight", "1080".into())])?;
        xml.leaf(
            "headlight",
            &[("ambient", "0.35 0.35 0.35".into()), ("diffuse", "0.25 0.25 0.25".into())],
        )
    })?;
    xml.element("asset", &[], |xml| {
        xml.leaf(
            "texture",
            &[
                ("type", "skybox".into()),
                ("builtin", "gradient".into()),
                ("rgb1", "0.75 0.83 0.9".into()),
                ("rgb2", "0.95 0.96 0.97".into()),
                ("width", "64".into()),
                ("height", "384".into()),
            ],
        )?;
        xml.leaf(
            "texture",
            &[
                ("name", "squares".into()),
                ("type", "2d".into()),
                ("builtin", "checker".into()),
                ("rgb1", "0.80 0.80 0.78".into()),
                ("rgb2", "0.75 0.75 0.73".into()),
                ("width", "256".into()),
                ("height", "256".into()),
            ],
        )?;
        // Two squares in each direction have two metres.
        xml.leaf(
            "material",
            &[
                ("name", "ground".into()),
                ("texture", "squares".into()),
                ("texrepeat", "0.5 0.5".into()),
                ("texuniform", "true".into()),
            ],
        )
    })
}

/// Length of a step of MuJoCo, in s.
fn step_s(plan: &WorldPlan) -> f64 {
    1.0 / (f64::from(plan.physics.steps_per_s) * f64::from(plan.explicit_steps()))
}

fn surroundings(xml: &mut XmlText, plan: &WorldPlan) -> io::Result<()> {
    let middle_y_m = (plan.start_y_m + plan.stairs.landing_y_m()) / 2.0;
    let reach_m = (plan.stairs.landing_y_m() - plan.start_y_m).max(10.0);
    xml.leaf(
        "light",
        &[
            ("name", "sun".into()),
            ("type", "directional".into()),
            ("pos", spaced([reach_m / 2.0, middle_y_m - reach_m / 2.0, reach_m])),
            ("dir", "-0.5 0.5 -1".into()),
        ],
    )?;
    // It looks at the middle of the way, with z upwards.
    let from = [reach_m, middle_y_m - 0.35 * reach_m, 0.55 * reach_m];
    xml.leaf(
        "camera",
        &[
            ("name", "overview".into()),
            ("pos", spaced(from)),
            ("xyaxes", "0.33 0.944 0 -0.4 0.14 0.905".into()),
        ],
    )?;
    // MuJoCo takes the greater friction of two surfaces; the limbs have none, and the world has the product.
    let friction = |surface: &Surface| {
        let [torsional, rolling] = OTHER_FRICTION;
        ("friction", spaced([surface.friction * plan.skin.friction, torsional, rolling]))
    };
    xml.leaf(
        "geom",
        &[
            ("name", "ground".into()),
            ("type", "plane".into()),
            ("size", "0 0 1".into()),
            ("material", "ground".into()),
            friction(&plan.ground),
        ],
    )?;
    for (index, stair) in plan.stairs.boxes().iter().enumerate() {
        let ends = || stair.min_m.into_iter().zip(stair.max_m);
        xml.leaf(
            "geom",
            &[
                ("name", format!("step {}", index + 1)),
                ("type", "box".into()),
                ("pos", spaced(ends().map(|(min, max)| (min + max) / 2.0))),
                ("size", spaced(ends().map(|(min, max)| (max - min) / 2.0))),
                ("rgba", rgba(STEP_COLORS[index % 2])),
                friction(&plan.surface),
            ],
        )?;
    }
    Ok(())
}

fn rgba([red, green, blue]: [f32; 3]) -> String {
    spaced([red, green, blue, 1.0])
}

/// The position and rotation of the head at the start: the middle of the straight snake has the start's place.
pub(super) fn head_start(plan: &WorldPlan) -> ([f32; 3], f32) {
    let body = &plan.body;
    if body.is_branching() {
        let head_m = plan.start_poses()[0].translation;
        return (head_m.to_array(), plan.start_turn_rad);
    }
    let head_length_m = body.parts.first().map_or(0.0, |head| head.length_m);
    let ahead_m = (body.length_m() - head_length_m) / 2.0;
    let (sin, cos) = libm::sincosf(plan.start_turn_rad);
    let (x_m, y_m) = (plan.start_x_m - sin * ahead_m, plan.start_y_m + cos * ahead_m);
    ([x_m, y_m, body.axis_height_m()], plan.start_turn_rad)
}

/// The name of a part: that of its limb, and its number within a soft one.
pub(super) fn part_name(body: &BodyPlan, index: usize) -> String {
    let limb = body.parts[index].limb;
    let parts = body.parts_of(limb);
    let of_limb = format!("limb {}", limb + 1);
    if parts.len() == 1 { of_limb } else { format!("{of_limb} part {}", index - parts.start + 1) }
}

/// The parts within each other, from the head.
fn limbs(xml: &mut XmlText, plan: &WorldPlan) -> io::Result<()> {
    let name = part_name(&plan.body, 0);
    let (at_m, turn_rad) = head_start(plan);
    let (sin, cos) = libm::sincosf(turn_rad / 2.0);
    let place = [("pos", spaced(at_m)), ("quat", spaced([cos, 0.0, 0.0, sin]))];
    let [pos, quat] = place;
    xml.open("body", &[("name", name), pos, quat])?;
    xml.leaf("freejoint", &[("name", "free".into())])?;
    // It follows the snake from its right-hand side.
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

/// The box of a part, and all parts that are joined to it from behind, in the order of the plan.
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

/// The hinges of a universal joint at the front face of its rear limb.
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

/// The three elastic hinges at the front face of a part of a soft limb.
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

/// Joined limbs, the parts of a soft limb, and contact-free pairs do not touch; the others touch with the friction of skin on
/// skin.
fn contacts(xml: &mut XmlText, plan: &WorldPlan) -> io::Result<()> {
    let body = &plan.body;
    let are_joined =
        |a: usize, b: usize| body.joints.iter().any(|joint| (joint.parent, joint.child) == (a, b));
    let is_free = |a: usize, b: usize| {
        let limbs = [body.parts[a].limb, body.parts[b].limb];
        limbs[0] == limbs[1] || body.contact_free_pairs.contains(&limbs)
    };
    let pairs = || (0..body.parts.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
    let friction = plan.skin.friction * plan.skin.friction;
    let [torsional, rolling] = OTHER_FRICTION;
    xml.element("contact", &[], |xml| {
        for joint in &body.joints {
            let [front, rear] = [joint.parent, joint.child].map(|part| part_name(body, part));
            xml.leaf("exclude", &[("body1", front), ("body2", rear)])?;
        }
        for (a, b) in pairs().filter(|&(a, b)| is_free(a, b) && !are_joined(a, b)) {
            let [front, rear] = [a, b].map(|part| part_name(body, part));
            xml.leaf("exclude", &[("body1", front), ("body2", rear)])?;
        }
        for (a, b) in pairs().filter(|&(a, b)| !are_joined(a, b) && !is_free(a, b)) {
            xml.leaf(
                "pair",
                &[
                    ("geom1", part_name(body, a)),
                    ("geom2", part_name(body, b)),
                    ("friction", spaced([friction, friction, torsional, rolling, rolling])),
                ],
            )?;
        }
        Ok(())
    })
}

/// A key frame with the angles of the joints at the start, if they are not all 0.
fn start(xml: &mut XmlText, plan: &WorldPlan) -> io::Result<()> {
    let start_rad = |joint: &JointPlan| joint.mount.map_or([0.0; 2], |mount| mount.start_rad);
    if plan.body.joints.iter().all(|joint| start_rad(joint) == [0.0; 2]) {
        return Ok(());
    }
    let (at_m, turn_rad) = head_start(plan);
    let (sin, cos) = libm::sincosf(turn_rad / 2.0);
    let mut numbers = vec![at_m[0], at_m[1], at_m[2], cos, 0.0, 0.0, sin];
    // MuJoCo follows one branch to its end before the next.
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

/// The motors: bend and twist of the first joint, of the second, and so on.
fn motors(xml: &mut XmlText, body: &BodyPlan) -> io::Result<()> {
    xml.element("actuator", &[], |xml| {
        for (index, joint) in body.joints.iter().enumerate() {
            let ceilings =
                [("bend", joint.max_bend_torque_nm), ("twist", joint.max_twist_torque_nm)];
            for (axis, torque_nm) in ceilings {
                let name = format!("{axis} {}", index + 1);
                let most_nm = torque_nm.max(POWERLESS_NM);
                xml.leaf(
                    "motor",
                    &[
                        ("name", name.clone()),
                        ("joint", name),
                        ("gear", "1".into()),
                        ("ctrlrange", spaced([-most_nm, most_nm])),
                    ],
                )?;
            }
        }
        Ok(())
    })
}
