//! The energy balance compared with closed formulas.

use super::surface::{block, body, run};
use super::*;

in_both_engines!(a_block_that_slides_to_rest_loses_its_kinetic_energy);
fn a_block_that_slides_to_rest_loses_its_kinetic_energy() {
    let mut simulation = Simulation::new(&block(Surface { friction: 0.5, ..Default::default() }));
    run(&mut simulation, 1.0);
    body(&mut simulation).linear = Vector::new(0.0, -4.0, 0.0);
    let before_j = simulation.energy_lost().total_j;
    run(&mut simulation, 2.0);
    let lost_j = simulation.energy_lost().total_j - before_j;
    assert!((lost_j - 0.5 * 5.0 * 16.0).abs() < 0.5, "{lost_j} J");
}

in_both_engines!(a_dropped_block_loses_in_the_air_nothing_and_at_the_impact_what_its_bounce_leaves);
fn a_dropped_block_loses_in_the_air_nothing_and_at_the_impact_what_its_bounce_leaves() {
    for bounce in [0.0, 0.6] {
        let mut plan = block(Surface { bounce, ..Default::default() });
        plan.physics.steps_per_s = 240;
        let mut simulation = Simulation::new(&plan);
        body(&mut simulation).at.z += 1.0;
        let before_j = simulation.energy_lost().total_j;
        run(&mut simulation, 0.4);
        let falling_j = simulation.energy_lost().total_j - before_j;
        assert!(falling_j.abs() < 0.1, "{falling_j} J in the air");
        run(&mut simulation, 0.1);
        let lost_j = simulation.energy_lost().total_j - before_j;
        // The loss is (1 - bounce²) m g h.
        let expected_j = (1.0 - bounce * bounce) * 5.0 * 9.81;
        assert!((lost_j - expected_j).abs() < 1.5, "{lost_j} J for {expected_j} J");
    }
}

in_both_engines!(frictionless_joints_lose_nothing_of_the_work_that_drives_them);
fn frictionless_joints_lose_nothing_of_the_work_that_drives_them() {
    let (_, mut simulation) = weightless(2);
    simulation.take_steps(20, &[JointTorque { bend_nm: 4.0, twist_nm: 0.0 }]);
    let work_j = simulation.balance.joint_work_j as f32;
    let lost_j = simulation.energy_lost().total_j;
    assert!(work_j > 0.5, "{work_j} J");
    assert!(lost_j.abs() < 0.02 * work_j, "{lost_j} of {work_j} J");
}

in_both_engines!(holding_power_counts_the_square_of_each_torque_and_never_as_work);
fn holding_power_counts_the_square_of_each_torque_and_never_as_work() {
    let spent = |power_w: f32, bend_nm: f32, twist_nm: f32| {
        let (_, mut simulation) = weightless(2);
        simulation.plan.body.holding_w_per_n2m2 = power_w / 1.0e6;
        simulation.take_steps(120, &[JointTorque { bend_nm, twist_nm }]);
        (simulation.effort().energy_j, simulation.balance.motion_j, simulation.poses().last())
    };
    let without = spent(0.0, 4.0, 0.0);
    assert_eq!(without.0, without.1);
    for (power_w, bend_nm, twist_nm) in [(1.0e6, 4.0, 0.0), (1.0e6, 2.0, 2.0), (5.0e5, 4.0, 0.0)] {
        let (energy_j, motion_j, end) = spent(power_w, bend_nm, twist_nm);
        let seconds = 120.0 * weightless(2).0.physics.step_s();
        let expected_j = (bend_nm * bend_nm + twist_nm * twist_nm) * power_w / 1.0e6 * seconds;
        let held_j = energy_j - motion_j;
        assert!((held_j - expected_j).abs() < 1.0e-3 * expected_j, "{held_j}, not {expected_j} J");
        assert_eq!(
            (motion_j, end),
            (spent(0.0, bend_nm, twist_nm).1, spent(0.0, bend_nm, twist_nm).2)
        );
    }
}

in_both_engines!(a_joint_stopped_by_its_limits_loses_the_work_that_drove_it);
fn a_joint_stopped_by_its_limits_loses_the_work_that_drove_it() {
    let (_, mut simulation) = weightless(2);
    simulation.take_steps(240, &[JointTorque { bend_nm: 4.0, twist_nm: 0.0 }]);
    // The torque drives the joint to its limit of 1 rad, where it rests.
    let lost = simulation.energy_lost();
    assert!((lost.total_j - 4.0).abs() < 0.2 && lost.elsewhere_j() == lost.total_j, "{lost:?}");
}

in_both_engines!(
    without_contacts_and_stops_the_damping_of_joints_and_of_rotation_is_all_that_is_lost
);
fn without_contacts_and_stops_the_damping_of_joints_and_of_rotation_is_all_that_is_lost() {
    for (damping_nms_per_rad, angular_damping_per_s) in
        [(30.0, 0.0), (5.0, 0.0), (5.0, 2.0), (0.0, 2.0)]
    {
        let (mut plan, _) = weightless(5);
        plan.body.angular_damping_per_s = angular_damping_per_s;
        for joint in &mut plan.body.joints {
            joint.damping_nms_per_rad = damping_nms_per_rad;
        }
        let mut simulation = lifted(&plan);
        for step in 0..300 {
            let phase_rad = step as f32 * 0.2;
            let torques = [0.0, 1.2, 2.4, 3.6].map(|behind_rad| JointTorque {
                bend_nm: 10.0 * libm::sinf(phase_rad - behind_rad),
                twist_nm: 0.0,
            });
            simulation.step(&torques).expect("healthy");
        }
        let lost = simulation.energy_lost();
        let work_j = simulation.balance.joint_work_j as f32;
        let case =
            format!("{damping_nms_per_rad}, {angular_damping_per_s}: {lost:?} of {work_j} J");
        assert!(lost.total_j > 1.0, "{case}");
        assert!(lost.elsewhere_j().abs() < 0.05 * work_j, "{case}");
        assert_eq!(lost.joint_damping_j > 0.5, damping_nms_per_rad > 0.0, "{case}");
        assert_eq!(lost.rotation_damping_j > 0.5, angular_damping_per_s > 0.0, "{case}");
    }
}

in_both_engines!(a_snake_that_gains_energy_without_its_joints_is_disqualified);
fn a_snake_that_gains_energy_without_its_joints_is_disqualified() {
    let (plan, mut simulation) = weightless(2);
    let still = vec![JointTorque::default(); plan.body.joints.len()];
    simulation.begin_balance();
    simulation.step(&still).expect("nothing moves");
    // A mass of 5 kg at 1 m/s has 2.5 J, more than the limit of 1 J; at 0.5 m/s it has 0.6 J.
    for (speed_m_s, expected) in [(0.5, Ok(())), (1.0, Err(Disqualification::EnergyFromNothing))] {
        let mut pushed = simulation.clone();
        pushed.engine.parts_mut()[0].linear.x = speed_m_s;
        assert_eq!(pushed.step(&still), expected, "{speed_m_s} m/s");
    }
}
