//! A body as a robot for ROS, Gazebo, Drake, Pinocchio and PyBullet (URDF). URDF cannot express stairs, friction or motors.

use std::io;

use super::facts::{Fact, generator};
use super::mjcf::{LIMB_COLORS, head_start, left_out};
use super::xml_text::{XmlText, spaced};
use snakes_core::world::{BodyPlan, Rotation, WorldPlan};

/// Mass in kg, and moment of inertia in kg·m², of the link between the two hinges of a universal joint.
const BETWEEN: f32 = 1.0e-6;
/// Velocity limit of a joint, in rad/s, which URDF demands. It is beyond all velocities that occur.
const FASTEST_RAD_S: f32 = 1000.0;

/// Returns the robot of a world's snake, with facts about the champion.
///
/// # Errors
/// The XML library failed.
pub fn urdf(name: &str, plan: &WorldPlan, facts: &[Fact]) -> io::Result<String> {
    XmlText::document(|xml| {
        xml.element("robot", &[("name", name.to_owned())], |xml| {
            xml.comment(&generator())?;
            for (fact, value) in facts {
                xml.comment(&format!("{fact}: {value}"))?;
            }
            xml.comment("Not in this model: ground, stairs and friction; export the same champion as .xml (MJCF) for them")?;
            xml.comment("Not in this model: joined limbs do not collide, which URDF cannot say")?;
            for note in left_out(plan) {
                xml.comment(&format!("Not in this model: {note}"))?;
            }
            for (color, [red, green, blue]) in ["red", "blue"].into_iter().zip(LIMB_COLORS) {
                xml.element("material", &[("name", color.to_owned())], |xml| {
                    xml.leaf("color", &[("rgba", spaced([red, green, blue, 1.0]))])
                })?;
            }
            // The robot has no floating joint to the world: only some programs support it, and PyBullet would fix the robot there.
            let body = &plan.body;
            if !body.springs.is_empty() {
                xml.comment("Not in this model: softness of the limbs, which are rigid here; export .xml (MJCF) for it")?;
            }
            for (number, joint) in (1..).zip(&body.joints) {
                let [bend, twist] = joint.mount.map_or([0.0; 2], |mount| mount.start_rad);
                if [bend, twist] != [0.0; 2] {
                    xml.comment(&format!("Start of bend_{number} and twist_{number}: {bend} {twist} rad"))?;
                }
            }
            let ([x_m, y_m, z_m], turn_rad) = head_start(plan);
            // The link of a soft head is as long as all parts of the head together.
            let behind_m = (body.limb_size_m(0)[1] - body.parts[0].length_m) / 2.0;
            let (sin, cos) = libm::sincosf(turn_rad);
            let at_m = [x_m + sin * behind_m, y_m - cos * behind_m, z_m];
            let (xyz, rpy) = (spaced(at_m), spaced([0.0, 0.0, turn_rad]));
            xml.comment(&format!("Start of limb_1 in the world: xyz {xyz}, rpy {rpy}"))?;
            for limb in 0..body.limbs() {
                link(xml, body, limb)?;
            }
            joints(xml, plan)
        })
    })
}

fn ends(xml: &mut XmlText, parent: &str, child: &str) -> io::Result<()> {
    xml.leaf("parent", &[("link", parent.to_owned())])?;
    xml.leaf("child", &[("link", child.to_owned())])
}

/// Writes a limb. The frame of the head is at its centre. The frame of every other limb is at the joint, in the middle of its front
/// face.
fn link(xml: &mut XmlText, body: &BodyPlan, index: usize) -> io::Result<()> {
    let size_m = body.limb_size_m(index);
    let back_m = if index == 0 { 0.0 } else { -size_m[1] / 2.0 };
    let origin = |xml: &mut XmlText| xml.leaf("origin", &[("xyz", spaced([0.0, back_m, 0.0]))]);
    let shape = |xml: &mut XmlText| {
        xml.element("geometry", &[], |xml| xml.leaf("box", &[("size", spaced(size_m))]))
    };
    xml.element("link", &[("name", format!("limb_{}", index + 1))], |xml| {
        xml.element("inertial", &[], |xml| {
            origin(xml)?;
            let [x, y, z] = size_m.map(f64::from);
            let density = f64::from(body.limb_density_kg_m3(index));
            let mass_kg = x * y * z * density;
            let about = |a: f64, b: f64| mass_kg * (a * a + b * b) / 12.0;
            inertia(xml, mass_kg, [about(y, z), about(x, z), about(x, y)])
        })?;
        xml.element("visual", &[], |xml| {
            origin(xml)?;
            shape(xml)?;
            let color = ["red", "blue"][index % 2];
            xml.leaf("material", &[("name", color.to_owned())])
        })?;
        xml.element("collision", &[], |xml| {
            origin(xml)?;
            shape(xml)
        })
    })
}

fn inertia(xml: &mut XmlText, mass_kg: f64, about_kg_m2: [f64; 3]) -> io::Result<()> {
    xml.leaf("mass", &[("value", mass_kg.to_string())])?;
    let none = || "0".to_owned();
    let [x, y, z] = about_kg_m2.map(|moment| moment.to_string());
    let moments =
        [("ixx", x), ("ixy", none()), ("ixz", none()), ("iyy", y), ("iyz", none()), ("izz", z)];
    xml.leaf("inertia", &moments)
}

/// Returns the angles of a rotation about the fixed axes x, y and z, in this order, in rad: roll, pitch and yaw of URDF.
fn roll_pitch_yaw(turn: Rotation) -> [f32; 3] {
    let [x, y, z, w] = turn.to_array();
    [
        libm::atan2f(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
        libm::asinf((2.0 * (w * y - z * x)).clamp(-1.0, 1.0)),
        libm::atan2f(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)),
    ]
}

/// Writes each universal joint as two joints: the bend between the front limb and a link of almost no mass, and the twist behind
/// it. A joint that cannot turn is fixed.
fn joints(xml: &mut XmlText, plan: &WorldPlan) -> io::Result<()> {
    for (index, joint) in plan.body.joints.iter().enumerate() {
        let number = index + 1;
        let between = format!("joint_{number}");
        xml.element("link", &[("name", between.clone())], |xml| {
            xml.element("inertial", &[], |xml| {
                inertia(xml, f64::from(BETWEEN), [f64::from(BETWEEN); 3])
            })
        })?;
        let [front, rear] = [joint.parent, joint.child].map(|part| plan.body.parts[part].limb);
        // Offset from the frame of the front limb to the joint. A soft limb is as long as all its parts together.
        let front_m = plan.body.limb_size_m(front)[1];
        let mut at_m = joint.anchor_m(front_m);
        if front > 0 {
            at_m.y -= front_m / 2.0;
        }
        let turn = joint.axes(Rotation::IDENTITY);
        let limb = |index: usize| format!("limb_{}", index + 1);
        let (limits, torques) = (
            [joint.bend_limit_rad, joint.twist_limit_rad],
            [joint.max_bend_torque_nm, joint.max_twist_torque_nm],
        );
        let here = (at_m.to_array(), roll_pitch_yaw(turn));
        let axes = [
            ("bend", "1 0 0", limb(front), between.clone(), here),
            ("twist", "0 1 0", between, limb(rear), ([0.0; 3], [0.0; 3])),
        ];
        for ((axis, limit_rad), torque_nm) in axes.into_iter().zip(limits).zip(torques) {
            let (name, direction, parent, child, (at_m, rpy_rad)) = axis;
            // Some programs, such as MuJoCo, ignore a range without width, and the joint would turn freely.
            let is_locked = limit_rad == 0.0;
            let kind = if is_locked { "fixed" } else { "revolute" };
            let head = [("name", format!("{name}_{number}")), ("type", kind.to_owned())];
            xml.element("joint", &head, |xml| {
                ends(xml, &parent, &child)?;
                let mut origin = vec![("xyz", spaced(at_m))];
                if rpy_rad != [0.0; 3] {
                    origin.push(("rpy", spaced(rpy_rad)));
                }
                xml.leaf("origin", &origin)?;
                if is_locked {
                    return Ok(());
                }
                xml.leaf("axis", &[("xyz", direction.to_owned())])?;
                xml.leaf("dynamics", &[("damping", joint.damping_nms_per_rad.to_string())])?;
                xml.leaf(
                    "limit",
                    &[
                        ("lower", (-limit_rad).to_string()),
                        ("upper", limit_rad.to_string()),
                        ("effort", torque_nm.to_string()),
                        ("velocity", FASTEST_RAD_S.to_string()),
                    ],
                )
            })?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::mjcf;
    use snakes_core::save::load_champion;

    /// Returns the values of an attribute, each as one or two numbers.
    fn values(text: &str, attribute: &str) -> Vec<Vec<f32>> {
        let start = format!(" {attribute}=\"");
        let found = text.split(&start).skip(1);
        let value = found.map(|rest| rest.split('"').next().unwrap_or_default());
        let numbers = |value: &str| {
            value.split(' ').map(|number| number.parse().expect("a number")).collect()
        };
        value.map(numbers).collect()
    }

    #[test]
    fn f10_every_exported_range_has_a_width_and_a_locked_joint_is_fixed() {
        let saves = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../saves");
        let mut locked = 0;
        for file in std::fs::read_dir(saves).expect("a folder") {
            let file = file.expect("a file").path();
            let name = &file.display().to_string();
            let champion = load_champion(&file).expect("well formed").champion;
            let plan = champion.trial.world_plan(&champion.genome);
            let text = urdf(name, &plan, &[]).expect("in memory");
            let ends = values(&text, "lower").into_iter().zip(values(&text, "upper"));
            assert!(ends.clone().all(|(lower, upper)| lower < upper), "{name}: {text}");
            let limits = plan
                .body
                .joints
                .iter()
                .flat_map(|joint| [joint.bend_limit_rad, joint.twist_limit_rad]);
            let (fixed, turning): (Vec<f32>, Vec<f32>) =
                limits.partition(|limit_rad| *limit_rad == 0.0);
            assert_eq!(text.matches("type=\"fixed\"").count(), fixed.len(), "{name}");
            assert_eq!(ends.count(), turning.len(), "{name}");
            locked += fixed.len();
            let text = mjcf(name, &plan, &[]).expect("in memory");
            for attribute in ["range", "ctrlrange"] {
                assert!(
                    values(&text, attribute).iter().all(|ends| ends[0] < ends[1]),
                    "{name}: {text}"
                );
            }
        }
        assert!(locked >= 4, "the first climber cannot twist");
    }
}
