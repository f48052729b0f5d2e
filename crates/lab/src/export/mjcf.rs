//! A body and its world as a model for MuJoCo (MJCF).
//!
//! A universal joint becomes two hinges of the rear limb, first the bend, then the twist. Lengths, masses, inertias, limits,
//! damping, torques, friction and stairs are preserved; [`left_out`] lists what MJCF cannot express. The joints of a branching body
//! are at 0 in the middle of their ranges; a key frame has the angles at the start.

mod tree;

use std::io;

use super::facts::{Fact, generator};
use super::xml_text::{XmlText, spaced};
use snakes_core::world::{BodyPlan, JointPlan, Rotation, Surface, WorldPlan};
use tree::{limbs, start};

/// Limit of a hinge that must not move, in rad. MuJoCo demands a range that is not empty.
const LOCKED_RAD: f32 = 1.0e-4;
/// Torque limit of a motor without torque, in N·m. MuJoCo demands a range that is not empty.
const POWERLESS_NM: f32 = 1.0e-6;
/// MuJoCo's default coefficients of torsional and rolling friction, which contacts of three dimensions ignore.
const OTHER_FRICTION: [f32; 2] = [0.005, 0.0001];

/// Colours of the limbs, which alternate, as red, green and blue from 0 to 1.
pub(super) const LIMB_COLORS: [[f32; 3]; 2] = [[0.86, 0.13, 0.12], [0.10, 0.27, 0.84]];
pub(super) const STEP_COLORS: [[f32; 3]; 2] = [[0.72, 0.70, 0.66], [0.62, 0.60, 0.57]];

/// Light, sky and material of the ground, whose squares have sides of one metre.
const LOOKS: &str = r#"
  <visual>
    <global offwidth="1920" offheight="1080"/>
    <headlight ambient="0.35 0.35 0.35" diffuse="0.25 0.25 0.25"/>
  </visual>
  <asset>
    <texture type="skybox" builtin="gradient" rgb1="0.75 0.83 0.9" rgb2="0.95 0.96 0.97" width="64" height="384"/>
    <texture name="squares" type="2d" builtin="checker" rgb1="0.80 0.80 0.78" rgb2="0.75 0.75 0.73" width="256" height="256"/>
    <material name="ground" texture="squares" texrepeat="0.5 0.5" texuniform="true"/>
  </asset>
"#;

/// Returns the model of a world: ground, stairs and snake, with facts about the champion.
///
/// # Errors
/// The XML library failed.
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

/// Lists the properties of a champion's world that a model for another engine lacks.
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
    xml.fixed(LOOKS);
    Ok(())
}

/// Returns the length of a step of MuJoCo, in s.
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
    // The camera looks at the middle of the way, with z upwards.
    let from = [reach_m, middle_y_m - 0.35 * reach_m, 0.55 * reach_m];
    xml.leaf(
        "camera",
        &[
            ("name", "overview".into()),
            ("pos", spaced(from)),
            ("xyaxes", "0.33 0.944 0 -0.4 0.14 0.905".into()),
        ],
    )?;
    // MuJoCo takes the greater friction of two surfaces. The limbs therefore have none, and the world has the product.
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
    // A step may consist of several solids. Only the first of them is named after the step alone.
    let mut last = None;
    for (index, solid) in plan.stairs.solids().iter().enumerate() {
        let number = solid.step + 1;
        let again = if last == Some(number) || solid.pose.rotation != Rotation::IDENTITY {
            format!(", solid {}", index + 1)
        } else {
            String::new()
        };
        last = Some(number);
        let [x, y, z, w] = solid.pose.rotation.to_array();
        let mut attributes = vec![
            ("name", format!("step {number}{again}")),
            ("type", "box".into()),
            ("pos", spaced(solid.pose.translation.to_array())),
            ("size", spaced(solid.half_m.to_array())),
            ("rgba", rgba(STEP_COLORS[solid.step as usize % 2])),
            friction(&plan.surface),
        ];
        if solid.pose.rotation != Rotation::IDENTITY {
            attributes.push(("quat", spaced([w, x, y, z])));
        }
        xml.leaf("geom", &attributes)?;
    }
    Ok(())
}

fn rgba([red, green, blue]: [f32; 3]) -> String {
    spaced([red, green, blue, 1.0])
}

/// Returns position (in m) and turn about z (in rad) of the head at the start. A straight snake has its middle at the start.
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

/// Returns the name of a part: its limb and, if the limb is soft, the part's number within the limb.
pub(super) fn part_name(body: &BodyPlan, index: usize) -> String {
    let limb = body.parts[index].limb;
    let parts = body.parts_of(limb);
    let of_limb = format!("limb {}", limb + 1);
    if parts.len() == 1 { of_limb } else { format!("{of_limb} part {}", index - parts.start + 1) }
}

/// Writes the contacts. Joined limbs, the parts of a soft limb, and contact-free pairs do not touch. All other pairs touch with the
/// friction of skin on skin.
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
        let joined = body.joints.iter().map(|joint| (joint.parent, joint.child));
        let free = pairs().filter(|&(a, b)| is_free(a, b) && !are_joined(a, b));
        for (a, b) in joined.chain(free) {
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

/// Writes the motors: bend and twist of the first joint, of the second joint, and so on.
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
