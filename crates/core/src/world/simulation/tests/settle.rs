//! Tests of coming to rest, and of limbs that pass through each other.

use super::*;
use crate::world::TouchedSurface;

/// Returns a snake of three limbs whose head is lower than the others, so that the head begins in the air.
fn uneven() -> WorldPlan {
    let mut plan = plan(3);
    plan.body.parts[0].height_m = 0.4;
    for joint in &mut plan.body.joints {
        joint.damping_nms_per_rad = 30.0;
    }
    plan
}

in_both_engines!(a_lower_limb_comes_to_rest_before_the_trial_and_costs_nothing);
fn a_lower_limb_comes_to_rest_before_the_trial_and_costs_nothing() {
    let mut simulation = Simulation::new(&uneven());
    simulation.settle().expect("it rests");
    assert_eq!(simulation.effort(), Effort::default());
    let [head, _, _] = simulation.poses().collect::<Vec<_>>()[..] else { panic!("three limbs") };
    let height_m = head.translation.z;
    assert!(height_m < 0.45, "it no longer hangs in front of its neighbour at 0.5 m: {height_m}");
    let fastest = simulation.velocities().map(|[linear, _]| linear.length()).fold(0.0, f32::max);
    assert!(fastest < 0.05, "{fastest} m/s");
}

in_both_engines!(all_damping_of_the_joints_acts_while_a_body_settles);
/// The part of the joints' damping that acts as a torque must act during settling, too.
fn all_damping_of_the_joints_acts_while_a_body_settles() {
    let places = |simulation: &Simulation| {
        simulation.poses().map(|pose| pose.translation).collect::<Vec<_>>()
    };
    let plan = uneven();
    assert!(plan.physics.joint_damping_in_solver() < 1.0, "a part acts as a torque");
    let mut settled = Simulation::new(&plan);
    settled.settle().expect("it rests");
    let mut stepped = Simulation::new(&plan);
    let passes_there = (0..120).any(|_| {
        stepped.step(&[JointTorque::default(); 2]).expect("healthy");
        places(&stepped) == places(&settled)
    });
    assert!(passes_there, "settling is stepping without commanded torques");
}

in_both_engines!(a_tower_that_falls_over_is_disqualified);
fn a_tower_that_falls_over_is_disqualified() {
    let mut plan = plan(2);
    plan.body.parts[0] = PartPlan { height_m: 6.0, length_m: 0.4, ..plan.body.parts[0].clone() };
    plan.body.parts[1] = PartPlan { height_m: 0.4, ..plan.body.parts[1].clone() };
    let mut simulation = Simulation::new(&plan);
    assert_eq!(simulation.settle(), Err(Disqualification::FellOver));
}

in_both_engines!(limbs_of_a_contact_free_pair_do_not_touch);
/// The neighbours of a short block touch each other when both of its joints bend, unless they are a contact-free pair.
fn limbs_of_a_contact_free_pair_do_not_touch() {
    let touches = |pairs: Vec<[usize; 2]>| {
        let (mut plan, _) = weightless(3);
        plan.body.parts[1].length_m = 0.4;
        plan.body.contact_free_pairs = pairs;
        let mut simulation = Simulation::new(&plan);
        let bend = [JointTorque { bend_nm: 300.0, twist_nm: 0.0 }; 2];
        (0..60).any(|_| {
            let _ = simulation.step(&bend);
            let mut patches = simulation.contact_patches().into_iter();
            patches.any(|patch| patch.touched == TouchedSurface::Limb(2))
        })
    };
    assert!(touches(Vec::new()));
    assert!(!touches(vec![[0, 2]]));
}
