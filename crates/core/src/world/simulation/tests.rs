//! The world compared with the report and with closed formulas.

use std::cell::Cell;

use crate::world::PhysicsEngine;

thread_local! {
    /// The engine in which the plans of this thread's test are built.
    static ENGINE: Cell<PhysicsEngine> = const { Cell::new(PhysicsEngine::Rapier) };
}

/// Runs a test with the plans' engine set to `engine`.
fn run_in(engine: PhysicsEngine, test: fn()) {
    ENGINE.set(engine);
    test();
}

/// Makes two tests of a function, one per engine, with the same bounds.
macro_rules! in_both_engines {
    ($test:ident) => {
        mod $test {
            use crate::world::PhysicsEngine;

            #[test]
            fn in_rapier() {
                crate::world::simulation::tests::run_in(PhysicsEngine::Rapier, super::$test);
            }

            #[test]
            fn in_lanes() {
                crate::world::simulation::tests::run_in(PhysicsEngine::Lanes, super::$test);
            }
        }
    };
}

mod energy;
mod newborns;
mod observe;
mod patches;
mod random;
mod rates;
mod settle;
mod soft;
mod surface;
mod trees;

use super::super::{HealthLimits, JointPlan, PhysicsSettings, Skin, Stairs, Surface};
use super::*;

/// Returns a snake of `limbs` blocks without damping, in the world of the report.
fn plan(limbs: usize) -> WorldPlan {
    let limb =
        |limb| PartPlan { limb, width_m: 1.0, length_m: 2.0, height_m: 1.0, density_kg_m3: 2.5 };
    let joint = |parent| JointPlan {
        parent,
        child: parent + 1,
        mount: None,
        bend_limit_rad: 1.0,
        twist_limit_rad: 0.9,
        max_bend_torque_nm: 1000.0,
        max_twist_torque_nm: 1000.0,
        damping_nms_per_rad: 0.0,
        gap_scale: 1.0,
        cfm_m_s_per_n: 0.0,
    };
    WorldPlan {
        physics: PhysicsSettings { engine: ENGINE.get(), ..Default::default() },
        stairs: Stairs::default(),
        surface: Surface::default(),
        ground: Surface::default(),
        skin: Skin::default(),
        health: HealthLimits::default(),
        body: BodyPlan {
            parts: (0..limbs).map(limb).collect(),
            joints: (0..limbs - 1).map(joint).collect(),
            springs: Vec::new(),
            contact_free_pairs: Vec::new(),
            middle_part: limbs / 2,
            angular_damping_per_s: 0.0,
            holding_w_per_n2m2: 0.0,
        },
        settles: false,
        start_y_m: -7.23,
        start_x_m: 0.0,
        start_turn_rad: 0.0,
    }
}

/// Returns a snake of [`plan`] without gravity, far above the ground.
fn weightless(limbs: usize) -> (WorldPlan, Simulation) {
    let mut plan = plan(limbs);
    plan.physics.gravity_m_s2 = 0.0;
    let simulation = lifted(&plan);
    (plan, simulation)
}

/// Returns the world of a plan with all parts 30 m higher.
fn lifted(plan: &WorldPlan) -> Simulation {
    let mut simulation = Simulation::new(plan);
    simulation.change_parts(|(_, part)| part.at.z += 30.0);
    simulation
}

impl Simulation {
    /// Takes this number of steps with the same torques, in which nothing may disqualify the snake.
    fn take_steps(&mut self, count: u32, torques: &[JointTorque]) {
        for _ in 0..count {
            self.step(torques).expect("healthy");
        }
    }
}

/// Returns the kinetic energy of all parts, in J.
fn kinetic_j(simulation: &Simulation) -> f32 {
    let parts = simulation.parts().iter().zip(&simulation.body().parts);
    parts.map(|(part, plan)| part.kinetic_energy_j(plan.mass_kg(), plan.inertia_kg_m2())).sum()
}

/// Returns the momentum of all parts, in kg m/s.
fn momentum(simulation: &Simulation) -> Vector {
    let parts = simulation.parts().iter().zip(&simulation.body().parts);
    parts.map(|(part, plan)| part.linear * plan.mass_kg()).sum()
}

/// Returns the bend, the twist and the locked angle of a joint, in radians, by the formulas of [`universal_joint`].
fn angles(simulation: &Simulation, joint: usize) -> [f32; 3] {
    let rotation = |part: usize| simulation.parts()[part].turn;
    let relative = rotation(joint).inverse() * rotation(joint + 1);
    [relative.x, relative.y, relative.z].map(|part| 2.0 * libm::atanf(part / relative.w))
}

in_both_engines!(the_straight_snake_starts_at_the_position_of_table_1);
fn the_straight_snake_starts_at_the_position_of_table_1() {
    let simulation = Simulation::new(&plan(5));
    let centres: Vec<Vector> = simulation.poses().map(|pose| pose.translation).collect();
    assert_eq!(centres[2], Vector::new(0.0, -7.23, 0.5));
    let head_to_stairs = 3.0 - (centres[0].y + 1.0);
    assert!((head_to_stairs - 5.23).abs() < 1e-5, "{head_to_stairs}");
    assert!((centres[0].y - centres[4].y - 8.0).abs() < 1e-5);
}

#[test]
fn both_engines_have_the_mass_and_the_inertia_of_the_plan() {
    let (plan, rapier) = (plan(2), RapierWorld::new(&plan(2)));
    let (mass_kg, inertia) = (plan.body.parts[0].mass_kg(), plan.body.parts[0].inertia_kg_m2());
    let body = &rapier.physics().bodies[rapier.bodies()[0]];
    let in_rapier = body.mass_properties().local_mprops.principal_inertia();
    assert!((mass_kg - 5.0).abs() < 1e-4, "{mass_kg} kg");
    assert!((mass_kg - body.mass()).abs() < 1e-4 && inertia.distance(in_rapier) < 1e-4);
}

in_both_engines!(joint_torques_do_not_accelerate_the_snake_as_a_whole);
fn joint_torques_do_not_accelerate_the_snake_as_a_whole() {
    let (_, mut simulation) = weightless(5);
    let torques: Vec<JointTorque> = (0..4)
        .map(|joint| JointTorque { bend_nm: 3.0 - joint as f32, twist_nm: joint as f32 })
        .collect();
    simulation.take_steps(30, &torques);
    let momentum = momentum(&simulation);
    let fastest = simulation.speeds_m_s().fold(0.0, f32::max);
    assert!(fastest > 0.1, "it moves: {fastest} m/s");
    assert!(momentum.length() < 0.01, "but not away: {momentum} kg m/s");
}

in_both_engines!(each_torque_turns_its_joint_about_its_own_axis_only);
fn each_torque_turns_its_joint_about_its_own_axis_only() {
    for (torque, moved) in [
        (JointTorque { bend_nm: 2.0, twist_nm: 0.0 }, 0),
        (JointTorque { bend_nm: 0.0, twist_nm: 2.0 }, 1),
    ] {
        let (_, mut simulation) = weightless(2);
        simulation.take_steps(20, &[torque]);
        let angles = angles(&simulation, 0);
        for (axis, angle) in angles.into_iter().enumerate() {
            if axis == moved {
                assert!(angle > 0.05, "axis {axis} of {angles:?}");
            } else {
                assert!(angle.abs() < 1e-3, "axis {axis} of {angles:?}");
            }
        }
    }
}

in_both_engines!(a_joint_pushed_into_its_limits_stops_there);
fn a_joint_pushed_into_its_limits_stops_there() {
    let tolerance_rad = 0.03;
    for sign in [1.0, -1.0] {
        let (plan, mut simulation) = weightless(2);
        let push = JointTorque { bend_nm: 20.0 * sign, twist_nm: 20.0 * sign };
        simulation.take_steps(240, &[push]);
        let joint = &plan.body.joints[0];
        let [bend, twist, third] = angles(&simulation, 0);
        assert!((bend * sign - joint.bend_limit_rad).abs() < tolerance_rad, "bend {bend}");
        assert!((twist * sign - joint.twist_limit_rad).abs() < tolerance_rad, "twist {twist}");
        assert!(third.abs() < tolerance_rad, "the locked axis turned by {third}");
    }
}

in_both_engines!(a_torque_beyond_the_joints_limit_is_clamped);
fn a_torque_beyond_the_joints_limit_is_clamped() {
    let turned_by = |bend_nm| {
        let (mut plan, _) = weightless(2);
        plan.body.joints[0].max_bend_torque_nm = 2.0;
        let mut simulation = Simulation::new(&plan);
        simulation.step(&[JointTorque { bend_nm, twist_nm: 0.0 }]).expect("healthy");
        angles(&simulation, 0)[0]
    };
    assert!(turned_by(2.0) > 0.0);
    assert_eq!(turned_by(2.0), turned_by(5000.0));
    assert!(turned_by(1.0) < turned_by(2.0));
}

in_both_engines!(joint_damping_slows_the_joint_as_its_formula_says);
fn joint_damping_slows_the_joint_as_its_formula_says() {
    let decay = |damping_nms_per_rad: f32| {
        let (mut plan, _) = weightless(2);
        plan.body.joints[0].damping_nms_per_rad = damping_nms_per_rad;
        plan.physics.steps_per_s = 1000;
        let mut simulation = lifted(&plan);
        simulation.change_parts(|(index, part)| {
            part.angular.y = if index == 0 { 1.0 } else { -1.0 };
        });
        simulation.take_steps(100, &[JointTorque::default()]);
        simulation.parts()[0].angular.y
    };
    // For twist, the joint rate is 2 w and the torque on each limb c * 2 w, so w decays with exp(-2 c t / I), where I = m (width² +
    // height²) / 12 = 5/6 kg m².
    let expected = |c: f32| libm::expf(-2.0 * c * 0.1 / (5.0 / 6.0));
    for c in [0.5, 1.0, 2.0] {
        let (found, expected) = (decay(c), expected(c));
        assert!((found / expected - 1.0).abs() < 0.02, "c = {c}: {found} for {expected}");
    }
}

in_both_engines!(a_soft_joint_stretches_by_the_pull_over_its_stiffness);
fn a_soft_joint_stretches_by_the_pull_over_its_stiffness() {
    let stretch_m = |cfm_m_s_per_n, pull_n: f32| {
        let (mut plan, _) = weightless(2);
        plan.body.joints[0].cfm_m_s_per_n = cfm_m_s_per_n;
        plan.health.joint_drift_m = 10.0;
        let mut simulation = Simulation::new(&plan);
        simulation.change_parts(|(index, part)| {
            part.force_n.y = if index == 0 { pull_n } else { -pull_n };
        });
        simulation.take_steps(1200, &[JointTorque::default()]);
        simulation.parts()[0].at.y - simulation.parts()[1].at.y - 2.0
    };
    assert!(stretch_m(0.0, 50.0).abs() < 0.001, "rigid");
    for (cfm_m_s_per_n, pull_n) in [(0.01, 50.0), (0.01, 100.0), (0.03, 50.0)] {
        // The stiffness is kp = ERP / (h CFM) with an ERP of 0.2 and 60 steps per second.
        let expected_m = pull_n / (0.2 * 60.0 / cfm_m_s_per_n);
        let found_m = stretch_m(cfm_m_s_per_n, pull_n);
        assert!((found_m / expected_m - 1.0).abs() < 0.03, "{found_m} m for {expected_m} m");
    }
}

in_both_engines!(the_energy_spent_by_the_joints_is_the_energy_gained_by_the_limbs);
fn the_energy_spent_by_the_joints_is_the_energy_gained_by_the_limbs() {
    for torque in
        [JointTorque { bend_nm: 1.0, twist_nm: 0.0 }, JointTorque { bend_nm: 0.0, twist_nm: 0.25 }]
    {
        let (_, mut simulation) = weightless(2);
        assert_eq!(simulation.effort(), Effort::default());
        simulation.take_steps(40, &[torque]);
        let (spent, gained) = (simulation.effort().energy_j, kinetic_j(&simulation));
        assert!(gained > 0.01 && (spent / gained - 1.0).abs() < 0.01, "{spent} J for {gained} J");
        // Held back by the opposite torque, the joints spend as much energy again.
        let back = JointTorque { bend_nm: -torque.bend_nm, twist_nm: -torque.twist_nm };
        simulation.take_steps(40, &[back]);
        let both = simulation.effort().energy_j;
        assert!((both / (2.0 * gained) - 1.0).abs() < 0.02, "{both} J for twice {gained} J");
    }
}

in_both_engines!(a_turned_start_turns_and_moves_the_whole_snake);
fn a_turned_start_turns_and_moves_the_whole_snake() {
    let turned = WorldPlan { start_x_m: 0.3, start_turn_rad: 0.5, ..plan(5) };
    let mut simulation = Simulation::new(&turned);
    let centres: Vec<Vector> = simulation.poses().map(|pose| pose.translation).collect();
    assert_eq!(centres[2], Vector::new(0.3, -7.23, 0.5));
    let along = (centres[0] - centres[4]).normalize();
    let expected = Vector::new(-libm::sinf(0.5), libm::cosf(0.5), 0.0);
    assert!((along - expected).length() < 1e-5, "{along}");
    let heading = simulation.poses().next().expect("a head").rotation * Vector::Y;
    assert!((heading - expected).length() < 1e-5, "{heading}");
    // The joints of the turned snake fit together: no constraint moves it.
    simulation.take_steps(60, &[JointTorque::default(); 4]);
    assert!(simulation.effort().joint_drift_m < 1e-3 && simulation.effort().top_speed_m_s < 0.1);
}

in_both_engines!(the_effort_of_a_thrown_snake_holds_its_maxima);
fn the_effort_of_a_thrown_snake_holds_its_maxima() {
    let (_, mut simulation) = weightless(3);
    simulation.change_parts(|(_, part)| part.linear = Vector::new(3.0, 0.0, 4.0));
    simulation.take_steps(60, &[JointTorque::default(); 2]);
    let Effort { energy_j, top_speed_m_s, joint_drift_m, sideways_m } = simulation.effort();
    assert!(energy_j == 0.0 && joint_drift_m < 1e-3, "{energy_j} J, {joint_drift_m} m");
    assert!((top_speed_m_s - 5.0).abs() < 0.01 && (sideways_m - 3.0).abs() < 0.01);
}

in_both_engines!(a_free_limb_swings_with_the_period_of_the_physical_pendulum);
fn a_free_limb_swings_with_the_period_of_the_physical_pendulum() {
    let (plan, mut simulation) = weightless(2);
    let (speed, lever, weight_n) = (0.2, 1.0, 9.81 * plan.body.parts[1].mass_kg());
    simulation.change_parts(|(index, part)| {
        part.is_held = index == 0;
        if index == 1 {
            // Its weight points backwards along the snake, so that the straight snake is at rest.
            part.force_n.y = -weight_n;
            part.angular.x = speed;
            part.linear.z = -speed * lever;
        }
    });
    let mut crossings_s = Vec::new();
    let mut previous = 0.0;
    for step in 1..=1800 {
        simulation.step(&[JointTorque::default()]).expect("healthy");
        let angle = angles(&simulation, 0)[0];
        if previous < 0.0 && angle >= 0.0 {
            crossings_s.push((step as f32 - angle / (angle - previous)) / 60.0);
        }
        previous = angle;
    }
    let swings = crossings_s.len() as f32 - 1.0;
    let found_s = (crossings_s[crossings_s.len() - 1] - crossings_s[0]) / swings;
    // For small swings, the period is T = 2 pi sqrt(I / (m g d)) with I = m (l² + h²) / 12 + m d².
    let limb = &plan.body.parts[1];
    let own = (limb.length_m * limb.length_m + limb.height_m * limb.height_m) / 12.0;
    let expected_s = std::f32::consts::TAU * ((own + lever * lever) / (9.81 * lever)).sqrt();
    assert!((found_s / expected_s - 1.0).abs() < 0.01, "{found_s} s for {expected_s} s");
}

/// Returns the drift over 10 s of a weightless snake of `limbs` that waves and turns without any contact: of its momentum in kg m/s, and
/// of its energy relative to the initial energy.
fn drift(limbs: usize) -> (f32, f32) {
    let (mut plan, _) = weightless(limbs);
    for joint in &mut plan.body.joints {
        (joint.bend_limit_rad, joint.twist_limit_rad) = (3.0, 3.0);
    }
    let mut simulation = lifted(&plan);
    simulation.change_parts(|(_, part)| part.linear.x = 0.4);
    // The joints start the wave, so that the initial motion satisfies every joint.
    for step in 0..30 {
        let push = |joint: usize| JointTorque {
            bend_nm: if (step + 10 * joint) % 40 < 20 { 0.3 } else { -0.3 },
            twist_nm: if joint.is_multiple_of(2) { 0.1 } else { -0.1 },
        };
        let torques: Vec<JointTorque> = (0..limbs - 1).map(push).collect();
        simulation.step(&torques).expect("healthy");
    }
    let still = vec![JointTorque::default(); limbs - 1];
    simulation.step(&still).expect("healthy");
    let (momentum_before, energy_before_j) = (momentum(&simulation), kinetic_j(&simulation));
    simulation.take_steps(600, &still);
    let is_free = |joint| angles(&simulation, joint).iter().all(|angle| angle.abs() < 2.9);
    assert!((0..limbs - 1).all(is_free), "a joint that hits its limit loses energy, as it should");
    let lost = (momentum(&simulation) - momentum_before).length();
    (lost, kinetic_j(&simulation) / energy_before_j - 1.0)
}

in_both_engines!(a_snake_without_external_forces_keeps_its_momentum_and_energy);
fn a_snake_without_external_forces_keeps_its_momentum_and_energy() {
    for limbs in [2, 5, 12] {
        let (momentum, energy) = drift(limbs);
        assert!(momentum < 1.0e-4, "{limbs} limbs: {momentum} kg m/s");
        assert!(energy.abs() < 1.0e-3, "{limbs} limbs: {energy} of the energy");
    }
}

in_both_engines!(a_fall_follows_the_gravity_of_the_settings);
fn a_fall_follows_the_gravity_of_the_settings() {
    let fallen_m = |gravity_m_s2| {
        let mut plan = plan(2);
        plan.physics.gravity_m_s2 = gravity_m_s2;
        let mut simulation = lifted(&plan);
        simulation.take_steps(60, &[JointTorque::default()]);
        30.5 - simulation.parts()[0].at.z
    };
    for gravity in [1.62, 9.81] {
        let (fallen, expected) = (fallen_m(gravity), gravity / 2.0);
        assert!((fallen / expected - 1.0).abs() < 0.02, "{fallen} m for {expected} m");
    }
}

in_both_engines!(each_exceeded_health_limit_disqualifies);
fn each_exceeded_health_limit_disqualifies() {
    let broken_by = |speed_limit_m_s, break_it: fn(&mut PartState)| {
        let mut plan = plan(5);
        plan.health.speed_m_s = speed_limit_m_s;
        let mut simulation = Simulation::new(&plan);
        break_it(&mut simulation.engine.parts_mut()[0]);
        let still = [JointTorque::default(); 4];
        (0..600).find_map(|_| simulation.step(&still).err())
    };
    let poison = |head: &mut PartState| head.linear = Vector::splat(f32::NAN);
    assert_eq!(broken_by(25.0, poison), Some(Disqualification::NotFinite));
    let shoot = |head: &mut PartState| head.linear = Vector::new(0.0, 0.0, 500.0);
    assert_eq!(broken_by(25.0, shoot), Some(Disqualification::TooFast));
    let tear = |head: &mut PartState| head.at += Vector::new(0.0, 30.0, 10.0);
    // Rapier pulls a torn joint together at once, at up to 400 m/s. With the default limit, the reason would be the speed.
    assert_eq!(broken_by(1000.0, tear), Some(Disqualification::JointBroke));
    assert_eq!(broken_by(25.0, |_| ()), None, "a snake that lies still is healthy");

    let mut beyond = plan(5);
    beyond.health.arena_back_m = 10.0;
    let mut simulation = Simulation::new(&beyond);
    let result = simulation.step(&[JointTorque::default(); 4]);
    assert_eq!(result, Err(Disqualification::LeftArena), "the tail lies at -11.23");
}
