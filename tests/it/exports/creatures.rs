//! Creatures as models for MuJoCo and URDF.

use serde_json::json;
use snakes_core::genome::NodeJoint;
use snakes_core::save::load_preset;
use snakes_core::world::JointPlan;

use super::models::{champion_of, compare_in_other_engines, description, export};

/// The creatures have joints about a single axis, for which both engines have the same coordinates.
#[test]
fn a_hundred_random_creatures_move_in_other_engines_as_here() {
    let test = "a_hundred_random_creatures_move_in_other_engines_as_here";
    let mut settings = load_preset("creatures").expect("shipped").settings;
    settings.trial.duration_s = 0.1;
    settings.trial.agent.angular_damping_per_s = 0.0;
    (settings.trial.physics.substeps, settings.trial.physics.iterations) = (4, 16);
    let said = compare_in_other_engines(test, 3, |name, path, rng| {
        let trial = settings.trial.clone();
        let mut genome = settings.genome.random_genome(trial.genome_shape(), rng);
        for node in &mut genome.body.nodes {
            node.joint = NodeJoint::Revolute;
            // Half of the joint's range is left on either side for the motion.
            node.bend_start *= 0.5;
        }
        let champion = champion_of(genome, trial);
        let plan = champion.trial.world_plan(&champion.genome);
        export(name, &champion, &path(".xml"));
        export(name, &champion, &path(".urdf"));
        let mut expected = description(&plan, &plan, rng);
        let start = |joint: &JointPlan| joint.mount.map_or(0.0, |mount| mount.start_rad[0]);
        let starts: Vec<f32> = plan.body.joints.iter().map(start).collect();
        expected["start_rad"] = json!(starts);
        expected
    });
    println!("{said}");
}
