//! Soft bodies as models for MuJoCo.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use snakes_core::evolve::{Settings, with_fields};
use snakes_core::score::Trial;
use snakes_core::world::{SOFTEST_M4_S2, STIFFEST_M4_S2, WorldPlan, modulus_at_pa};

use super::models::{
    champion, compare_in_other_engines, description, export, log_between, random_trial,
};

/// Returns the trial with soft limbs, each with a random modulus from the softest allowed to rigid.
fn softened(trial: &Trial, rng: &mut ChaCha8Rng) -> Trial {
    let agent = &trial.agent;
    let modulus = |limb: usize| {
        let sides_m = [agent.limb_width_m.at(limb), agent.limb_height_m.at(limb)];
        let density = agent.density_kg_m3.as_ref().map_or(2.5, |density| density.at(limb));
        let bending_m4_s2 = log_between(rng, [SOFTEST_M4_S2 * 1.01, STIFFEST_M4_S2 * 1.5]);
        modulus_at_pa(bending_m4_s2, sides_m, density)
    };
    let moduli: Vec<f32> = (0..agent.limbs as usize).map(modulus).collect();
    let settings = Settings { trial: trial.clone(), ..Settings::default() };
    let moduli = format!("{moduli:?}");
    let parts = rng.random_range(2..=4).to_string();
    let fields = [("youngs_modulus_pa", moduli.as_str()), ("soft_parts", parts.as_str())];
    with_fields(&settings, fields).expect("allowed").trial
}

/// Returns the expected model of a body with soft limbs, and its motion in this engine without gravity.
fn soft_description(plan: &WorldPlan, rng: &mut ChaCha8Rng) -> Value {
    let body = &plan.body;
    let names: Vec<String> = (0..body.parts.len())
        .map(|index| {
            let limb = body.parts[index].limb;
            let parts = body.parts_of(limb);
            match parts.len() {
                1 => format!("limb {}", limb + 1),
                _ => format!("limb {} part {}", limb + 1, index - parts.start + 1),
            }
        })
        .collect();
    let hinges = body.parts.iter().enumerate().flat_map(|(index, part)| {
        let spring = body.springs.iter().find(|spring| spring.child == index);
        let of_spring = spring.into_iter().flat_map(|spring| {
            let name = &names[index];
            ["x", "y", "z"].into_iter().enumerate().map(move |(axis, letter)| {
                let [stiffness, damping] =
                    [spring.stiffness_nm_per_rad[axis], spring.damping_nms_per_rad[axis]];
                json!([format!("spring {letter} {name}"), stiffness, damping])
            })
        });
        let joint = body.joints.iter().find(|joint| joint.child == index);
        let of_joint = joint.into_iter().flat_map(|joint| {
            ["bend", "twist"].map(|axis| {
                json!([format!("{axis} {}", part.limb), 0.0, joint.damping_nms_per_rad])
            })
        });
        of_joint.chain(of_spring).collect::<Vec<_>>()
    });
    let hinges: Vec<Value> = hinges.collect();
    let apart = |a: usize, b: usize| {
        let is_joined = body.joints.iter().any(|joint| (joint.parent, joint.child) == (a, b));
        let limbs = [body.parts[a].limb, body.parts[b].limb];
        limbs[0] != limbs[1] && !is_joined && !body.contact_free_pairs.contains(&limbs)
    };
    let count = body.parts.len();
    let pairs = (0..count).flat_map(|b| (0..b).map(move |a| (a, b)));
    let mut expected = description(plan, plan, rng);
    expected["substeps"] = json!(plan.explicit_steps());
    expected["bodies"] = json!(names);
    expected["hinges"] = json!(hinges);
    expected["pairs"] = json!(pairs.filter(|&(a, b)| apart(a, b)).count());
    expected
}

#[test]
fn a_hundred_random_soft_bodies_move_in_other_engines_as_here() {
    let test = "a_hundred_random_soft_bodies_move_in_other_engines_as_here";
    let said = compare_in_other_engines(test, 2, |name, path, rng| {
        let rigid = random_trial(rng);
        let champion = champion(softened(&rigid, rng), rng);
        export(name, &champion, &path(".xml"));
        soft_description(&champion.trial.world_plan(&champion.genome), rng)
    });
    println!("{said}");
}
