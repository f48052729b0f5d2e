//! `snakes show body`: the body of a champion in numbers.

use std::path::Path;

use serde_json::json;

use super::error::CliError;
use super::output::{print, print_json};
use snakes_core::genome::joint_tree;
use snakes_core::save::load_champion;
use snakes_core::world::BodyPlan;

/// Prints the blocks and joints of a champion, from the head.
pub fn body(file: &Path, json: bool) -> Result<(), CliError> {
    let champion = load_champion(file)?.champion;
    let (body, genes) = (champion.body(), &champion.genome.body);
    let is_own = genes.has_own_blocks();
    let tree = genes.is_branching().then(|| joint_tree(&genes.nodes));
    if json { print_lines(&body, is_own, tree) } else { print(&table(&body, is_own, tree)) }
}

fn print_lines(body: &BodyPlan, is_own: bool, tree: Option<String>) -> Result<(), CliError> {
    for index in 0..body.limbs() {
        let joint = body.joint_before(index);
        let [width_m, length_m, height_m] = body.limb_size_m(index);
        let spring = body.spring_of(index);
        print_json(&json!({
            "type": "block",
            "block": index + 1,
            "joined_to": joint.map(|joint| body.parts[joint.parent].limb + 1),
            "length_m": length_m,
            "width_m": width_m,
            "height_m": height_m,
            "density_kg_m3": body.limb_density_kg_m3(index),
            "mass_kg": body.limb_mass_kg(index),
            "parts": body.parts_of(index).len(),
            "spring_nm_per_rad": spring.map(|spring| spring.stiffness_nm_per_rad),
            "spring_damping_nms_per_rad": spring.map(|spring| spring.damping_nms_per_rad),
            "bend_limit_rad": joint.map(|joint| joint.bend_limit_rad),
            "twist_limit_rad": joint.map(|joint| joint.twist_limit_rad),
            "max_bend_torque_nm": joint.map(|joint| joint.max_bend_torque_nm),
            "max_twist_torque_nm": joint.map(|joint| joint.max_twist_torque_nm),
        }))?;
    }
    print_json(&json!({
        "type": "done",
        "blocks": body.limbs(),
        "parts": body.parts.len(),
        "evolved": is_own,
        "tree": tree,
        "length_m": body.length_m(),
        "mass_kg": body.mass_kg(),
        "volume_m3": body.volume_m3(),
        "torque_nm": body.torque_nm(),
    }))
}

fn table(body: &BodyPlan, is_own: bool, tree: Option<String>) -> String {
    let origin = match (&tree, is_own) {
        // A letter stands for the joint of each part: F fixed, R revolute, T twisting, U universal.
        (Some(tree), _) => format!("a creature with the joints {tree}"),
        (None, true) => "a body of its own".to_owned(),
        (None, false) => "the body of its trial".to_owned(),
    };
    let mut text = format!(
        "{} blocks, {origin}: {:.2} m long, {:.1} kg, {:.2} m³, {:.0} N·m of torque in all joints\n\n",
        body.limbs(),
        body.length_m(),
        body.mass_kg(),
        body.volume_m3(),
        body.torque_nm(),
    );
    let to = |text: &str| if body.is_branching() { format!("{text:>9}  ") } else { String::new() };
    text += &format!(
        "block  length  width  height    mass  {}joint in front: bend, twist   torque: bend, twist\n",
        to("joined to")
    );
    for index in 0..body.limbs() {
        let joint = body.joint_before(index);
        let joined_to = joint.map_or(String::new(), |joint| (joint.parent + 1).to_string());
        let joint = joint.map(|joint| {
            let [bend, twist] =
                [joint.bend_limit_rad, joint.twist_limit_rad].map(|limit| limit.to_degrees());
            format!(
                "{:>15}±{bend:>3.0}°  ±{twist:>3.0}°  {:>9.0} {:>5.0} N·m",
                "", joint.max_bend_torque_nm, joint.max_twist_torque_nm
            )
        });
        let [width_m, length_m, height_m] = body.limb_size_m(index);
        let soft = body.spring_of(index).map(|spring| {
            let [bending, torsion, sideways] = spring.stiffness_nm_per_rad;
            format!(
                "\n       soft: {} parts, springs of {bending:.0} N·m/rad (bend), {torsion:.0} (twist), {sideways:.0} (sideways)",
                body.parts_of(index).len()
            )
        });
        let line = format!(
            "{:>5}  {length_m:>4.2} m {width_m:>4.2} m  {height_m:>4.2} m {:>4.1} kg  {}{}",
            index + 1,
            body.limb_mass_kg(index),
            to(&joined_to),
            joint.unwrap_or_default(),
        );
        text += line.trim_end();
        text += &soft.unwrap_or_default();
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_is_a_line_of_sums_and_a_line_for_each_block() {
        let champion = snakes_core::save::shipped_champion().expect("well formed").champion;
        let text = table(&champion.body(), false, None);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 3 + 5, "{text}");
        assert!(lines[0].starts_with("5 blocks, the body of its trial: 10.00 m long, "), "{text}");
        assert!(lines[0].contains("10.00 m³, 8000 N·m"), "{text}");
        assert!(!lines[3].contains('°') && lines[4].contains('°'), "the head has no joint: {text}");
    }
}
