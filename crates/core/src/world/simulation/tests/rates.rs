//! Parameters whose unit contains time have the same effect at every step rate and with every number of substeps.

use super::surface::{block, body, run};
use super::*;
use crate::world::TESTED_RATES;

/// Calls a test with the engine's settings of each of [`TESTED_RATES`].
fn at_every_rate(test: impl Fn(&PhysicsSettings, &str)) {
    for (steps_per_s, substeps) in TESTED_RATES {
        let engine = ENGINE.get();
        let physics = PhysicsSettings { engine, steps_per_s, substeps, ..Default::default() };
        test(&physics, &format!("{steps_per_s} steps a second, {substeps} substeps"));
    }
}

fn assert_close(found: f32, expected: f32, tolerance: f32, case: &str) {
    assert!((found / expected - 1.0).abs() < tolerance, "{found} for {expected}: {case}");
}

in_both_engines!(air_takes_a_spin_at_its_rate);
fn air_takes_a_spin_at_its_rate() {
    at_every_rate(|physics, case| {
        for damping_per_s in [0.5, 2.0, 20.0, 88.0] {
            let mut simulation = floating_pair(physics, damping_per_s, 0.0);
            twist(&mut simulation, 1.0);
            let seconds = (60.0 / damping_per_s).round().max(1.0) / 60.0;
            run_with(&mut simulation, JointTorque::default(), seconds);
            let expected = libm::expf(-damping_per_s * seconds);
            assert_close(simulation.parts()[0].angular.y, expected, 0.02, case);
        }
    });
}

in_both_engines!(in_air_a_torque_turns_a_limb_at_torque_over_damping);
fn in_air_a_torque_turns_a_limb_at_torque_over_damping() {
    at_every_rate(|physics, case| {
        // In thick air, at 88 1/s, the bound is (d h)² / 24 = 9 % at 60 steps per second.
        for (damping_per_s, tolerance) in [(2.0, 0.02), (20.0, 0.02), (88.0, 0.1)] {
            let mut simulation = floating_pair(physics, damping_per_s, 0.0);
            let torque = JointTorque { bend_nm: 0.0, twist_nm: 0.2 };
            run_with(&mut simulation, torque, (8.0 / damping_per_s).max(0.5));
            // The joint turns at twice the rate of each limb, whose I = m (width² + height²) / 12 = 5/6 kg m².
            let expected = 2.0 * 0.2 / (damping_per_s * 5.0 / 6.0);
            let rate = simulation.joint_states().next().expect("a joint").twist_rad_s;
            assert_close(rate, expected, tolerance, case);
        }
    });
}

in_both_engines!(a_damping_surface_slows_a_limb_at_its_rate);
fn a_damping_surface_slows_a_limb_at_its_rate() {
    at_every_rate(|physics, case| {
        for dampen_per_s in [0.5, 2.0, 20.0] {
            let surface = Surface { friction: 0.0, dampen_per_s, ..Default::default() };
            let mut simulation =
                Simulation::new(&WorldPlan { physics: physics.clone(), ..block(surface) });
            run(&mut simulation, 0.5);
            body(&mut simulation).linear = Vector::new(0.0, 4.0, 0.0);
            run(&mut simulation, 0.2);
            let expected = 4.0 * libm::expf(-dampen_per_s * 0.2);
            assert_close(body(&mut simulation).linear.y, expected, 0.02, case);
        }
    });
}

in_both_engines!(on_a_damping_slope_a_limb_slides_at_gravity_over_damping);
fn on_a_damping_slope_a_limb_slides_at_gravity_over_damping() {
    at_every_rate(|physics, case| {
        for dampen_per_s in [2.0, 20.0] {
            let surface = Surface { friction: 0.0, dampen_per_s, ..Default::default() };
            let mut simulation =
                Simulation::new(&WorldPlan { physics: physics.clone(), ..block(surface) });
            run(&mut simulation, 0.5);
            body(&mut simulation).force_n.y = -0.5 * simulation.body().mass_kg();
            run(&mut simulation, 4.0);
            assert_close(-body(&mut simulation).linear.y, 0.5 / dampen_per_s, 0.02, case);
        }
    });
}

/// Returns the world of two limbs that float without weight in air that damps at the rate `angular_damping_per_s`. Their joint has the
/// damping `damping_nms_per_rad`.
fn floating_pair(
    physics: &PhysicsSettings,
    angular_damping_per_s: f32,
    damping_nms_per_rad: f32,
) -> Simulation {
    let (mut plan, _) = weightless(2);
    plan.body.angular_damping_per_s = angular_damping_per_s;
    plan.physics = PhysicsSettings { gravity_m_s2: 0.0, ..physics.clone() };
    plan.body.joints[0].damping_nms_per_rad = damping_nms_per_rad;
    plan.body.joints[0].twist_limit_rad = 3.0;
    lifted(&plan)
}

fn run_with(simulation: &mut Simulation, torque: JointTorque, seconds: f32) {
    let steps = (seconds / simulation.plan.physics.step_s()).round() as u32;
    simulation.take_steps(steps, &[torque]);
}

/// Makes the limbs of a pair spin in opposite directions about the long axis, at this rate in rad/s.
fn twist(simulation: &mut Simulation, rate_rad_s: f32) {
    simulation.change_parts(|(index, part)| {
        part.angular.y = if index == 0 { rate_rad_s } else { -rate_rad_s };
    });
}

in_both_engines!(joint_damping_slows_a_joint_at_its_rate);
fn joint_damping_slows_a_joint_at_its_rate() {
    at_every_rate(|physics, case| {
        for damping in [0.5, 2.0, 6.0] {
            let mut simulation = floating_pair(physics, 0.0, damping);
            twist(&mut simulation, 1.0);
            run_with(&mut simulation, JointTorque::default(), 0.1);
            let found = simulation.parts()[0].angular.y;
            // The joint rate is 2 w and the torque on each limb c * 2 w, so w decays with exp(-2 c t / I).
            let expected = libm::expf(-2.0 * damping * 0.1 / (5.0 / 6.0));
            assert_close(found, expected, 0.02, case);
        }
    });
}

in_both_engines!(a_torque_turns_a_damped_joint_at_torque_over_damping);
fn a_torque_turns_a_damped_joint_at_torque_over_damping() {
    at_every_rate(|physics, case| {
        let mut simulation = floating_pair(physics, 0.0, 30.0);
        let torque = JointTorque { bend_nm: 0.0, twist_nm: 15.0 };
        run_with(&mut simulation, torque, 0.5);
        let rate = simulation.joint_states().next().expect("a joint").twist_rad_s;
        assert_close(rate, 0.5, 0.02, case);
    });
}

/// Returns the heights of a block's centre above the ground after each step, from a drop with its underside at height 0.
fn on_springs(physics: &PhysicsSettings, surface: Surface, seconds: f32) -> Vec<f32> {
    let mut simulation = Simulation::new(&WorldPlan { physics: physics.clone(), ..block(surface) });
    let steps = (seconds * physics.steps_per_s as f32).round() as u32;
    let step = |_| {
        simulation.step(&[]).expect("healthy");
        body(&mut simulation).at.z - 0.5
    };
    (0..steps).map(step).collect()
}

in_both_engines!(soft_ground_carries_a_block_at_its_weight_over_the_stiffness);
fn soft_ground_carries_a_block_at_its_weight_over_the_stiffness() {
    at_every_rate(|physics, case| {
        for (soft_erp, soft_cfm_m_s_per_n) in [(0.2, 0.01), (0.8, 0.01), (0.2, 0.1)] {
            let surface = Surface { soft_erp, soft_cfm_m_s_per_n, ..Default::default() };
            let depths = on_springs(physics, surface, 12.0);
            let kp_n_per_m = soft_erp * 60.0 / soft_cfm_m_s_per_n;
            let expected_m = -5.0 * 9.81 / (kp_n_per_m * 4.0);
            assert_close(*depths.last().expect("steps"), expected_m, 0.02, case);
        }
    });
}

in_both_engines!(
    a_block_swings_on_soft_ground_with_the_period_and_the_decay_of_its_spring_and_damper
);
fn a_block_swings_on_soft_ground_with_the_period_and_the_decay_of_its_spring_and_damper() {
    at_every_rate(|physics, case| {
        // The damping ratios are 0.05, 0.1 and 0.3.
        for (soft_erp, soft_cfm_m_s_per_n) in [(0.988, 0.1), (0.975, 0.1), (0.9, 0.06)] {
            let surface = Surface { soft_erp, soft_cfm_m_s_per_n, ..Default::default() };
            let heights = on_springs(physics, surface, 1.2);
            let (k, c) = (
                4.0 * soft_erp * 60.0 / soft_cfm_m_s_per_n,
                4.0 * (1.0 - soft_erp) / soft_cfm_m_s_per_n,
            );
            let (rest_m, decay) = (-5.0 * 9.81 / k, c / 10.0);
            let angular = (k / 5.0 - decay * decay).sqrt();
            let mut turns = Vec::new();
            for (index, three) in heights.windows(3).enumerate() {
                let [a, b, c] = [three[0] - rest_m, three[1] - rest_m, three[2] - rest_m];
                if (b - a) * (c - b) < 0.0 {
                    // The vertex of the parabola through three heights is the turning point.
                    let shift = (a - c) / (2.0 * (a - 2.0 * b + c));
                    let height = b - (a - c) * shift / 4.0;
                    turns.push(((index as f32 + 2.0 + shift) * physics.step_s(), height));
                }
            }
            // Half a period lies between two turning points. In it, the swing loses the factor exp(-decay half).
            let half_s = (turns[2].0 - turns[0].0) / 2.0;
            assert_close(half_s, std::f32::consts::PI / angular, 0.02, case);
            let kept = (turns[2].1 / turns[0].1).abs();
            let expected = libm::expf(-decay * 2.0 * half_s);
            assert!((kept - expected).abs() < 0.02, "{kept} for {expected}: {case}");
        }
    });
}

in_both_engines!(a_hard_contact_corrects_its_share_of_a_penetration_in_a_sixtieth_of_a_second);
fn a_hard_contact_corrects_its_share_of_a_penetration_in_a_sixtieth_of_a_second() {
    at_every_rate(|physics, case| {
        for soft_erp in [0.1, 0.25, 0.6] {
            let surface = Surface { soft_erp, ..Default::default() };
            let mut simulation =
                Simulation::new(&WorldPlan { physics: physics.clone(), ..block(surface) });
            // Rapier corrects a penetration at 3 m/s at most.
            let sunk_m = 0.035;
            body(&mut simulation).at.z -= sunk_m;
            run(&mut simulation, 2.0 / 60.0);
            let left_m = 0.5 - body(&mut simulation).at.z;
            let expected_m = sunk_m * (1.0 - soft_erp) * (1.0 - soft_erp);
            assert_close(left_m, expected_m, 0.02, case);
        }
    });
}

in_both_engines!(a_pushed_block_creeps_at_slip_times_force);
fn a_pushed_block_creeps_at_slip_times_force() {
    at_every_rate(|physics, case| {
        for slip_m_s_per_n in [0.001, 0.01, 0.05] {
            let surface = Surface { slip_m_s_per_n, ..Default::default() };
            let mut simulation =
                Simulation::new(&WorldPlan { physics: physics.clone(), ..block(surface) });
            body(&mut simulation).force_n.y = 20.0;
            run(&mut simulation, 5.0);
            assert_close(body(&mut simulation).linear.y, slip_m_s_per_n * 20.0, 0.02, case);
        }
    });
}

in_both_engines!(an_impact_bounces_from_the_bounce_velocity_on);
fn an_impact_bounces_from_the_bounce_velocity_on() {
    at_every_rate(|physics, case| {
        let rebound_m_s = |bounce_velocity_m_s| {
            let surface = Surface { bounce: 0.8, bounce_velocity_m_s, ..Default::default() };
            let mut simulation =
                Simulation::new(&WorldPlan { physics: physics.clone(), ..block(surface) });
            body(&mut simulation).at.z += 1.0;
            let steps = (0.8 * physics.steps_per_s as f32) as u32;
            let speeds = (0..steps).map(|_| {
                simulation.step(&[]).expect("healthy");
                body(&mut simulation).linear.z
            });
            speeds.fold(0.0, f32::max)
        };
        // A fall of 1 m ends at a speed of sqrt(2 g) = 4.43 m/s.
        let impact_m_s = libm::sqrtf(2.0 * 9.81);
        for bounce_velocity_m_s in [0.0, impact_m_s * 0.95] {
            assert_close(rebound_m_s(bounce_velocity_m_s), 0.8 * impact_m_s, 0.05, case);
        }
        let below_m_s = rebound_m_s(impact_m_s * 1.05);
        assert!(below_m_s < 0.1 * impact_m_s, "{below_m_s}: {case}");
    });
}
