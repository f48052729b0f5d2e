//! Joints with places and axes of their own on their parents, compared with closed formulas.

use std::f32::consts::{FRAC_1_SQRT_2, TAU};

use super::*;
use crate::world::{Mount, Rotation};

/// Returns a mount that turns the rear of its child downwards.
fn below(at_m: Vector) -> Mount {
    let turn = Rotation::from_xyzw(FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2);
    Mount { at_m, turn, start_rad: [0.0; 2] }
}

/// Returns a mount that turns the rear of its child to the side: to +x for 1, to -x for -1.
fn beside(at_m: Vector, side: f32) -> Mount {
    let turn = Rotation::from_xyzw(0.0, 0.0, side * FRAC_1_SQRT_2, FRAC_1_SQRT_2);
    Mount { at_m, turn, start_rad: [0.0; 2] }
}

/// Returns a block with an arm at each of these mounts.
fn tree(mounts: &[Mount]) -> WorldPlan {
    let mut plan = plan(1 + mounts.len());
    for (joint, mount) in plan.body.joints.iter_mut().zip(mounts) {
        (joint.parent, joint.mount) = (0, Some(*mount));
    }
    plan
}

/// Returns the world of a tree, 30 m higher, whose first part is held in its place.
fn hanging(plan: &WorldPlan) -> Simulation {
    let mut simulation = lifted(plan);
    simulation.change_parts(|(index, part)| part.is_held = index == 0);
    simulation
}

in_both_engines!(a_hanging_arm_swings_with_the_period_of_a_pendulum);
fn a_hanging_arm_swings_with_the_period_of_a_pendulum() {
    let start_rad = 0.1;
    let mut plan = tree(&[below(Vector::new(0.3, 0.2, -0.5))]);
    plan.physics.steps_per_s = 240;
    if let Some(mount) = &mut plan.body.joints[0].mount {
        mount.start_rad = [start_rad, 0.0];
    }
    let mut simulation = hanging(&plan);
    let mut bends_rad = vec![start_rad];
    for _ in 0..240 * 6 {
        simulation.step(&[JointTorque::default()]).expect("healthy");
        let state = simulation.joint_states().next().expect("a joint");
        assert!(state.twist_rad.abs() < 1.0e-3, "it only bends: {state:?}");
        bends_rad.push(state.bend_rad);
    }
    let crossings_s = bends_rad.windows(2).enumerate().filter_map(|(step, of)| {
        let crosses = of[0].signum() != of[1].signum();
        crosses.then(|| (step as f32 + of[0] / (of[0] - of[1])) / 240.0)
    });
    let crossings_s: Vec<f32> = crossings_s.collect();
    // A box of 1 m by 2 m by 1 m turns about the middle of its end; a swing of 0.1 rad takes 0.06 % longer than the smallest.
    let inertia_m2: f32 = (4.0 + 1.0) / 12.0 + 1.0;
    let expected_s = TAU * (inertia_m2 / 9.81).sqrt() * (1.0 + start_rad * start_rad / 16.0);
    let found_s = crossings_s[4] - crossings_s[0];
    assert!((found_s / (2.0 * expected_s) - 1.0).abs() < 0.005, "{found_s} s for two periods");
    let furthest_rad = bends_rad.iter().copied().fold(0.0, f32::min);
    assert!((furthest_rad + start_rad).abs() < 0.003, "{furthest_rad}");
    assert!(simulation.effort().joint_drift_m < 1.0e-3, "{:?}", simulation.effort());
}

in_both_engines!(a_torque_twists_an_arm_about_its_own_length);
fn a_torque_twists_an_arm_about_its_own_length() {
    for side in [1.0, -1.0] {
        let mut plan = tree(&[beside(Vector::new(0.5 * side, 0.3, 0.1), side)]);
        plan.physics.gravity_m_s2 = 0.0;
        let mut simulation = hanging(&plan);
        simulation.take_steps(30, &[JointTorque { bend_nm: 0.0, twist_nm: 2.0 }]);
        let state = simulation.joint_states().next().expect("a joint");
        // The inertia of the arm about its length is 5 kg · (1 m² + 1 m²) / 12.
        let expected_rad_s = 2.0 * 0.5 / (5.0 / 6.0);
        assert!((state.twist_rad_s - expected_rad_s).abs() < 0.01, "{state:?}");
        assert!((state.twist_rad - expected_rad_s / 4.0).abs() < 0.01, "{state:?}");
        assert!(state.bend_rad.abs() < 1.0e-3, "{state:?}");
        let [_, angular] = simulation.velocities().last().expect("an arm");
        let expected = Vector::new(-side * expected_rad_s, 0.0, 0.0);
        assert!(angular.distance(expected) < 0.01, "{angular}");
    }
}

in_both_engines!(an_arm_stops_at_the_limits_of_its_joint);
fn an_arm_stops_at_the_limits_of_its_joint() {
    for (bend_nm, twist_nm) in [(9.0, 0.0), (-9.0, 0.0), (0.0, 5.0), (0.0, -5.0)] {
        let mut plan = tree(&[beside(Vector::new(0.5, -0.2, 0.3), 1.0)]);
        plan.physics.gravity_m_s2 = 0.0;
        plan.body.joints[0].damping_nms_per_rad = 4.0;
        let mut simulation = hanging(&plan);
        simulation.take_steps(300, &[JointTorque { bend_nm, twist_nm }]);
        let state = simulation.joint_states().next().expect("a joint");
        // The limits are 1 rad and 0.9 rad.
        let at_limit = |torque_nm: f32, limit_rad: f32| {
            if torque_nm == 0.0 { 0.0 } else { limit_rad.copysign(torque_nm) }
        };
        let off_rad =
            [state.bend_rad - at_limit(bend_nm, 1.0), state.twist_rad - at_limit(twist_nm, 0.9)];
        assert!(off_rad.iter().all(|off| off.abs() < 0.01), "{bend_nm} {twist_nm}: {state:?}");
    }
}

in_both_engines!(torques_between_parts_of_a_tree_leave_its_momentum_as_it_is);
fn torques_between_parts_of_a_tree_leave_its_momentum_as_it_is() {
    let mut plan = tree(&[
        beside(Vector::new(0.5, 0.4, 0.1), 1.0),
        beside(Vector::new(-0.5, 0.4, 0.0), -1.0),
        below(Vector::new(0.1, -0.6, -0.5)),
        below(Vector::new(0.0, -0.5, -0.5)),
    ]);
    // The last arm is on another arm.
    plan.body.joints[3].parent = 1;
    plan.physics.gravity_m_s2 = 0.0;
    let mut simulation = lifted(&plan);
    let torques: Vec<JointTorque> = (0..4)
        .map(|joint| JointTorque { bend_nm: 3.0 - joint as f32, twist_nm: joint as f32 - 1.0 })
        .collect();
    simulation.take_steps(30, &torques);
    let (momentum, mut turning, mut turned) = (momentum(&simulation), Vector::ZERO, 0.0);
    for (part, plan) in simulation.parts().iter().zip(&simulation.body().parts) {
        let rate = part.turn.inverse() * part.angular;
        let spin = part.turn * (Vector::new(25.0, 10.0, 25.0) / 12.0 * rate);
        turning += spin + part.at.cross(part.linear * plan.mass_kg());
        turned += spin.length();
    }
    assert!(turned > 1.0, "the parts turn: {turned} kg m²/s");
    assert!(momentum.length() < 0.01, "{momentum} kg m/s");
    assert!(turning.length() < 0.02 * turned, "{turning} of {turned} kg m²/s");
    let gap_m = simulation.effort().joint_drift_m;
    assert!(gap_m < 2.0e-3, "{gap_m} m");
}
