//! Readings of contact patches compared with closed formulas for a single block.

use super::surface::{block, body, run};
use super::*;
use crate::world::{ContactPatch, TouchedSurface};

const WEIGHT_N: f32 = 5.0 * 9.81;

/// Returns the only patch of a world.
fn patch(simulation: &Simulation) -> ContactPatch {
    let patches = simulation.contact_patches();
    let [patch] = patches[..] else { panic!("one patch: {patches:?}") };
    patch
}

/// Returns the world of a block that a steady force pushes along y for this time, in seconds.
fn pushed(surface: Surface, push_n: f32, seconds: f32) -> Simulation {
    let mut simulation = Simulation::new(&block(surface));
    run(&mut simulation, 1.0);
    body(&mut simulation).force_n.y = push_n;
    run(&mut simulation, seconds);
    simulation
}

in_both_engines!(a_resting_block_presses_with_its_weight_and_uses_no_grip);
fn a_resting_block_presses_with_its_weight_and_uses_no_grip() {
    let mut simulation = Simulation::new(&block(Surface::default()));
    run(&mut simulation, 2.0);
    let patch = patch(&simulation);
    assert_eq!((patch.limb, patch.touched), (0, TouchedSurface::Ground));
    assert!((patch.normal_n / WEIGHT_N - 1.0).abs() < 0.01, "{patch:?}");
    assert!((patch.friction_limit_n - patch.normal_n).abs() < 1e-3, "friction 1: {patch:?}");
    assert!(patch.slip_m_s < 1e-3 && patch.grip_share < 0.01, "{patch:?}");
    assert!(patch.depth_m.abs() < 0.005 && patch.friction_w.abs() < 0.01, "{patch:?}");
}

in_both_engines!(a_sliding_block_uses_all_grip_slips_at_its_speed_and_loses_friction_times_speed);
fn a_sliding_block_uses_all_grip_slips_at_its_speed_and_loses_friction_times_speed() {
    for friction in [0.05, 0.5] {
        let surface = Surface { friction, ..Default::default() };
        let mut simulation = Simulation::new(&block(surface));
        run(&mut simulation, 1.0);
        body(&mut simulation).linear = Vector::new(0.0, -4.0, 0.0);
        run(&mut simulation, 0.5);
        let speed_m_s = -body(&mut simulation).linear.y;
        assert!((speed_m_s - (4.0 - friction * 9.81 * 0.5)).abs() < 0.05, "{speed_m_s}");
        let patch = patch(&simulation);
        assert!(patch.grip_share > 0.999, "{patch:?}");
        assert!((patch.slip_m_s / speed_m_s - 1.0).abs() < 0.02, "{patch:?} at {speed_m_s}");
        let power_w = friction * WEIGHT_N * speed_m_s;
        assert!((patch.friction_w / power_w - 1.0).abs() < 0.03, "{patch:?} for {power_w} W");
    }
}

in_both_engines!(a_block_pushed_below_the_limit_uses_the_pushs_share_of_the_grip);
fn a_block_pushed_below_the_limit_uses_the_pushs_share_of_the_grip() {
    for (friction, push_n) in [(1.0, 10.0), (0.5, 20.0), (2.0, 49.0)] {
        let surface = Surface { friction, ..Default::default() };
        let patch = patch(&pushed(surface, push_n, 2.0));
        let expected = push_n / (friction * WEIGHT_N);
        assert!((patch.grip_share - expected).abs() < 0.01, "{patch:?} for {expected}");
        assert!(patch.slip_m_s < 2e-3, "{patch:?}");
    }
}

in_both_engines!(a_creeping_block_slips_without_using_all_grip);
fn a_creeping_block_slips_without_using_all_grip() {
    let surface = Surface { slip_m_s_per_n: 0.01, ..Default::default() };
    let patch = patch(&pushed(surface, 20.0, 5.0));
    assert!((patch.slip_m_s / 0.2 - 1.0).abs() < 0.02, "slip times push: {patch:?}");
    assert!((patch.grip_share - 20.0 / WEIGHT_N).abs() < 0.02, "{patch:?}");
}

in_both_engines!(a_block_on_soft_ground_dents_it_by_its_weight_over_the_stiffness);
fn a_block_on_soft_ground_dents_it_by_its_weight_over_the_stiffness() {
    let surface = Surface { soft_erp: 0.2, soft_cfm_m_s_per_n: 0.01, ..Default::default() };
    let mut simulation = Simulation::new(&block(surface));
    run(&mut simulation, 20.0);
    let patch = patch(&simulation);
    // Each of the four corners is a spring of kp = ERP / (h CFM).
    let expected_m = WEIGHT_N / (0.2 * 60.0 / 0.01 * 4.0);
    assert!((patch.depth_m / expected_m - 1.0).abs() < 0.05, "{patch:?} for {expected_m} m");
}

in_both_engines!(
    a_block_that_spins_flat_on_the_ground_uses_all_grip_and_loses_its_rotation_to_friction
);
fn a_block_that_spins_flat_on_the_ground_uses_all_grip_and_loses_its_rotation_to_friction() {
    let mut simulation = Simulation::new(&block(Surface { friction: 0.2, ..Default::default() }));
    run(&mut simulation, 1.0);
    body(&mut simulation).angular = Vector::new(0.0, 0.0, 6.0);
    simulation.step(&[]).expect("healthy");
    let turning = patch(&simulation);
    assert!(turning.grip_share > 0.999, "{turning:?}");
    let corner_m_s = body(&mut simulation).angular.z * (0.5_f32 * 0.5 + 1.0).sqrt();
    assert!((turning.slip_m_s / corner_m_s - 1.0).abs() < 0.02, "{turning:?} for {corner_m_s}");
    let energy_j = kinetic_j(&simulation);
    let mut friction_j = 0.0;
    for _ in 0..120 {
        simulation.step(&[]).expect("healthy");
        friction_j += patch(&simulation).friction_w / 60.0;
    }
    assert!(kinetic_j(&simulation) < 1e-3, "it has stopped");
    assert!((friction_j / energy_j - 1.0).abs() < 0.1, "{friction_j} of {energy_j} J");
}

in_both_engines!(surface_damping_takes_the_energy_that_the_limb_loses);
fn surface_damping_takes_the_energy_that_the_limb_loses() {
    let surface = Surface { friction: 0.0, dampen_per_s: 2.0, ..Default::default() };
    let mut simulation = Simulation::new(&block(surface));
    run(&mut simulation, 0.5);
    body(&mut simulation).linear = Vector::new(0.0, 2.0, 0.0);
    let before_j = kinetic_j(&simulation);
    let mut damped_j = 0.0;
    for _ in 0..30 {
        simulation.step(&[]).expect("healthy");
        // The power is that of the second half of the step.
        let mean = (libm::expf(2.0 / 60.0) + 1.0) / 2.0;
        damped_j +=
            mean * simulation.surface_damping().map(|loss| loss.power_w).sum::<f32>() / 60.0;
        assert!(simulation.surface_damping().all(|loss| loss.touched == TouchedSurface::Ground));
    }
    let lost_j = before_j - kinetic_j(&simulation);
    assert!(lost_j > 5.0 && (damped_j / lost_j - 1.0).abs() < 0.01, "{damped_j} of {lost_j} J");
    assert_eq!(patch(&simulation).grip_share, 0.0, "there is no friction to use");
}

in_both_engines!(patches_tell_stairs_ground_and_limbs_apart_and_air_has_none);
fn patches_tell_stairs_ground_and_limbs_apart_and_air_has_none() {
    let mut plan = block(Surface::default());
    plan.start_y_m = plan.stairs.riser_y_m(10) + 5.0;
    let mut simulation = Simulation::new(&plan);
    let landing = body(&mut simulation).at + Vector::new(0.0, 0.0, 5.0);
    body(&mut simulation).at = landing + Vector::new(0.0, 0.0, 1.0);
    simulation.step(&[]).expect("healthy");
    assert_eq!(simulation.contact_patches(), []);
    body(&mut simulation).at = landing;
    run(&mut simulation, 0.5);
    assert_eq!(patch(&simulation).touched, TouchedSurface::Stairs);

    // Without its joints the tail can fall onto the head.
    let (mut plan, _) = weightless(3);
    plan.body.joints.clear();
    let mut simulation = lifted(&plan);
    let over = simulation.parts()[0].at;
    simulation.change_parts(|(index, part)| {
        if index == 2 {
            part.at = over + Vector::new(0.0, 0.0, 1.1);
            part.linear = Vector::new(0.0, 0.5, -2.0);
            // A force presses the tail on, because an impact is over before the last substep.
            part.force_n.z = -50.0;
        }
    });
    for _ in 0..8 {
        simulation.step(&[]).expect("healthy");
        if let [patch] = simulation.contact_patches()[..] {
            assert_eq!((patch.limb, patch.touched), (0, TouchedSurface::Limb(2)));
            return;
        }
    }
    panic!("the tail misses the head");
}
