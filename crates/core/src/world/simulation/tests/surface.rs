//! The seven surface parameters compared with closed formulas.

use rapier3d::prelude::CoefficientCombineRule;

use super::*;

/// Returns the world of one block, 1 by 2 by 1 m and 5 kg, that lies on the ground far from the stairs.
pub(super) fn block(surface: Surface) -> WorldPlan {
    WorldPlan { ground: surface.clone(), surface, start_y_m: -20.0, ..plan(1) }
}

/// Returns the only part of a world, to read or to change it. From then on the energy balance is meaningless.
pub(super) fn body(simulation: &mut Simulation) -> &mut PartState {
    simulation.balance.has_unknown_work = true;
    &mut simulation.engine.parts_mut()[0]
}

/// Returns the world of a block on a slope with this tangent. Tilted gravity stands for the slope, in the frame of the slope.
fn on_slope(mut plan: WorldPlan, tangent: f32) -> Simulation {
    let (sin, cos) = libm::sincosf(libm::atanf(tangent));
    plan.physics.gravity_m_s2 = 9.81 * cos;
    let mut simulation = Simulation::new(&plan);
    body(&mut simulation).force_n.y = -9.81 * sin * plan.body.mass_kg();
    simulation
}

pub(super) fn run(simulation: &mut Simulation, seconds: f32) {
    let steps = (seconds / simulation.plan.physics.step_s()).round() as u32;
    simulation.take_steps(steps, &[]);
}

/// Returns the height that the underside of a block reaches after its first impact, in metres, when the block falls flat from `height_m`.
fn rebound_m(surface: Surface, height_m: f32) -> f32 {
    let mut plan = block(surface);
    plan.physics.steps_per_s = 240;
    let mut simulation = Simulation::new(&plan);
    body(&mut simulation).at.z += height_m;
    let fall_s = (2.0 * height_m / 9.81).sqrt();
    run(&mut simulation, fall_s + 0.02);
    let mut highest_m = 0.0_f32;
    for _ in 0..(2.0 * fall_s * 240.0) as u32 {
        simulation.step(&[]).expect("healthy");
        highest_m = highest_m.max(body(&mut simulation).at.z - 0.5);
    }
    highest_m
}

in_both_engines!(a_block_slides_only_past_the_friction_angle);
fn a_block_slides_only_past_the_friction_angle() {
    for friction in [0.2, 0.5, 1.0] {
        let slid_m = |tangent: f32| {
            let plan = block(Surface { friction, ..Default::default() });
            let mut simulation = on_slope(plan, tangent);
            run(&mut simulation, 2.0);
            -20.0 - body(&mut simulation).at.y
        };
        let held_m = slid_m(friction * 0.97);
        assert!(held_m.abs() < 0.005, "friction {friction}: held, but moved {held_m} m");
        // The block slides s = g (sin a - friction cos a) t² / 2.
        let tangent = friction * 1.1;
        let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
        let expected_m = 9.81 * (tangent - friction) * cosine * 2.0;
        let found_m = slid_m(tangent);
        assert!((found_m / expected_m - 1.0).abs() < 0.05, "{found_m} m for {expected_m} m");
    }
}

in_both_engines!(a_dropped_block_rebounds_to_the_square_of_its_bounce);
fn a_dropped_block_rebounds_to_the_square_of_its_bounce() {
    for bounce in [0.3, 0.6, 0.9] {
        let found_m = rebound_m(Surface { bounce, ..Default::default() }, 1.0);
        let expected_m = bounce * bounce;
        assert!((found_m - expected_m).abs() < 0.03, "{found_m} m for {expected_m} m");
    }
}

in_both_engines!(an_impact_below_the_bounce_velocity_does_not_rebound);
fn an_impact_below_the_bounce_velocity_does_not_rebound() {
    // A fall of 1 m ends at a speed of sqrt(2 g) = 4.43 m/s.
    let rebound_m = |bounce_velocity_m_s| {
        rebound_m(Surface { bounce: 0.8, bounce_velocity_m_s, ..Default::default() }, 1.0)
    };
    let impact_m_s = libm::sqrtf(2.0 * 9.81);
    let without_m = rebound_m(0.0);
    assert!(without_m > 0.6, "{without_m} m");
    assert_eq!(rebound_m(impact_m_s * 0.97), without_m, "a faster impact bounces as ever");
    let below_m = rebound_m(impact_m_s * 1.03);
    assert!(below_m < 0.01, "{below_m} m");
}

in_both_engines!(a_resting_block_sinks_by_its_weight_over_the_stiffness_of_its_contacts);
fn a_resting_block_sinks_by_its_weight_over_the_stiffness_of_its_contacts() {
    for (soft_erp, soft_cfm_m_s_per_n) in [(0.2, 0.01), (0.8, 0.01), (0.2, 0.1), (0.9, 0.2)] {
        let surface = Surface { soft_erp, soft_cfm_m_s_per_n, ..Default::default() };
        let mut simulation = Simulation::new(&block(surface));
        run(&mut simulation, 20.0);
        let sunk_m = 0.5 - body(&mut simulation).at.z;
        let kp_n_per_m = soft_erp * 60.0 / soft_cfm_m_s_per_n;
        let expected_m = 5.0 * 9.81 / (kp_n_per_m * 4.0);
        assert!((sunk_m / expected_m - 1.0).abs() < 0.03, "{sunk_m} m for {expected_m} m");
    }
}

in_both_engines!(ground_and_stairs_have_independent_softness);
fn ground_and_stairs_have_independent_softness() {
    let sunk_m = |on_stairs: bool, stairs_cfm, ground_cfm| {
        let soft = |soft_cfm_m_s_per_n| Surface { soft_cfm_m_s_per_n, ..Default::default() };
        let mut plan = block(soft(stairs_cfm));
        plan.ground = soft(ground_cfm);
        let top_m = if on_stairs {
            plan.start_y_m = plan.stairs.riser_y_m(10) + 5.0;
            5.0
        } else {
            0.0
        };
        let mut simulation = Simulation::new(&plan);
        body(&mut simulation).at.z += top_m;
        run(&mut simulation, 20.0);
        top_m + 0.5 - body(&mut simulation).at.z
    };
    let expected_m = |cfm: f32| 5.0 * 9.81 / (0.25 * 60.0 / cfm * 4.0);
    for (on_stairs, found_m, cfm) in [
        (true, sunk_m(true, 0.02, 0.05), 0.02),
        (false, sunk_m(false, 0.02, 0.05), 0.05),
        (true, sunk_m(true, 0.02, 0.0), 0.02),
        (false, sunk_m(false, 0.0, 0.05), 0.05),
    ] {
        let expected_m = expected_m(cfm);
        let place = if on_stairs { "stairs" } else { "ground" };
        assert!((found_m / expected_m - 1.0).abs() < 0.03, "{place}: {found_m} for {expected_m}");
    }
    let hard_m = sunk_m(true, 0.0, 0.05);
    assert!(hard_m.abs() < 0.001, "hard stairs beside soft ground: {hard_m} m");
}

in_both_engines!(a_soft_skin_on_hard_ground_sinks_as_soft_ground_does);
fn a_soft_skin_on_hard_ground_sinks_as_soft_ground_does() {
    let mut plan = block(Surface::default());
    plan.skin = Skin { soft_erp: 0.4, soft_cfm_m_s_per_n: 0.02, ..Default::default() };
    let mut simulation = Simulation::new(&plan);
    run(&mut simulation, 20.0);
    let sunk_m = 0.5 - body(&mut simulation).at.z;
    let expected_m = 5.0 * 9.81 / (0.4 * 60.0 / 0.02 * 4.0);
    assert!((sunk_m / expected_m - 1.0).abs() < 0.03, "{sunk_m} m for {expected_m} m");
}

/// Returns the speed at which a block creeps under a steady push, in m/s.
fn creep_m_s(surface: Surface, push_n: f32) -> f32 {
    let mut simulation = Simulation::new(&block(surface));
    body(&mut simulation).force_n.y = push_n;
    run(&mut simulation, 7.0);
    body(&mut simulation).linear.y
}

in_both_engines!(creep_is_proportional_to_slip_and_to_force);
fn creep_is_proportional_to_slip_and_to_force() {
    // The friction cone ends at 49 N.
    for slip_m_s_per_n in [0.001, 0.01, 0.05] {
        for push_n in [-10.0, 20.0, 40.0] {
            let surface = Surface { slip_m_s_per_n, ..Default::default() };
            let (found, expected) = (creep_m_s(surface, push_n), slip_m_s_per_n * push_n);
            assert!((found / expected - 1.0).abs() < 0.02, "{found} m/s for {expected} m/s");
        }
    }
    assert!(creep_m_s(Surface::default(), 40.0).abs() < 1e-4, "without slip it holds");
}

in_both_engines!(soft_ground_slips_as_hard_ground_does);
fn soft_ground_slips_as_hard_ground_does() {
    let surface = Surface { slip_m_s_per_n: 0.01, soft_cfm_m_s_per_n: 0.001, ..Default::default() };
    let found = creep_m_s(surface, 20.0);
    assert!((found / 0.2 - 1.0).abs() < 0.05, "{found} m/s for 0.2 m/s");
}

in_both_engines!(dampen_halves_a_sliding_blocks_speed_in_the_computed_time);
fn dampen_halves_a_sliding_blocks_speed_in_the_computed_time() {
    for dampen_per_s in [0.5, 2.0] {
        let surface = Surface { friction: 0.0, dampen_per_s, ..Default::default() };
        let mut simulation = Simulation::new(&block(surface));
        run(&mut simulation, 0.5);
        body(&mut simulation).linear = Vector::new(0.0, 2.0, 0.0);
        // Half the speed is left when exp(-dampen t) = 1/2.
        let half_life_s = libm::logf(2.0) / dampen_per_s;
        run(&mut simulation, half_life_s);
        let speed_m_s = body(&mut simulation).linear.y;
        assert!((speed_m_s - 1.0).abs() < 0.02, "{speed_m_s} m/s after {half_life_s} s");
        // In the air nothing slows the block, from the first whole step on.
        body(&mut simulation).at.z += 20.0;
        run(&mut simulation, 0.1);
        let speed_m_s = body(&mut simulation).linear.y;
        run(&mut simulation, 1.0);
        assert_eq!(body(&mut simulation).linear.y, speed_m_s);
    }
}

in_both_engines!(the_frictions_of_surface_and_skin_multiply_and_the_larger_bounce_counts);
fn the_frictions_of_surface_and_skin_multiply_and_the_larger_bounce_counts() {
    let slides = |skin_friction, tangent: f32| {
        let mut plan = block(Surface { friction: 0.5, ..Default::default() });
        plan.skin.friction = skin_friction;
        let mut simulation = on_slope(plan, tangent);
        run(&mut simulation, 2.0);
        body(&mut simulation).at.y < -20.02
    };
    assert!(!slides(0.6, 0.29) && slides(0.6, 0.31), "0.5 times 0.6 is 0.3");

    let bounces = |surface_bounce, skin_bounce| {
        let mut plan = block(Surface { bounce: surface_bounce, ..Default::default() });
        plan.skin.bounce = skin_bounce;
        let world = RapierWorld::new(&plan);
        let colliders = &world.physics().colliders;
        let limb = &colliders[world.physics().bodies[world.bodies()[0]].colliders()[0]];
        let (_, ground) = colliders.iter().next().expect("the ground comes first");
        assert_eq!(limb.restitution_combine_rule(), CoefficientCombineRule::Max);
        assert_eq!(ground.restitution_combine_rule(), CoefficientCombineRule::Max);
        limb.restitution().max(ground.restitution())
    };
    assert_eq!((bounces(0.2, 0.7), bounces(0.7, 0.2)), (0.7, 0.7));
}

#[test]
fn contacts_pass_the_hooks_only_where_a_parameter_needs_them() {
    let hooked = |surface: Surface| {
        let world = RapierWorld::new(&block(surface));
        let colliders = world.physics().colliders.iter();
        colliders.filter(|(_, collider)| !collider.active_hooks().is_empty()).count()
    };
    assert_eq!(
        hooked(Surface { friction: 3.0, bounce: 0.5, soft_erp: 0.9, ..Default::default() }),
        0
    );
    let slip = Surface { slip_m_s_per_n: 0.1, ..Default::default() };
    assert_eq!(hooked(slip), 11, "ten steps and the ground, and no limb");
}

/// Returns the largest rise of the mechanical energy of a thrown, limp snake above any earlier value, in J, and the snake's initial
/// energy, in J.
fn energy_gained_j(surface: Surface) -> (f32, f32) {
    let mut plan = WorldPlan { ground: surface.clone(), surface, start_y_m: -20.0, ..plan(5) };
    plan.health.arena_back_m = 1000.0;
    plan.health.arena_half_width_m = 1000.0;
    plan.health.joint_drift_m = 10.0;
    plan.health.speed_m_s = 1000.0;
    let mut simulation = Simulation::new(&plan);
    simulation.change_parts(|(index, part)| {
        part.at.z += 1.0;
        part.linear = Vector::new(1.0, 6.0, 2.0);
        part.angular = Vector::new(3.0, 2.0, if index > 2 { 1.0 } else { -1.0 });
    });
    let energy_j = |simulation: &Simulation| -> f32 {
        let parts = simulation.parts().iter().zip(&simulation.body().parts);
        let heights_j = parts.map(|(part, plan)| plan.mass_kg() * 9.81 * part.at.z);
        kinetic_j(simulation) + heights_j.sum::<f32>()
    };
    let still = [JointTorque::default(); 4];
    simulation.take_steps(3, &still);
    let first_j = energy_j(&simulation);
    let (mut least_j, mut gained_j) = (first_j, 0.0_f32);
    for _ in 0..300 {
        simulation.step(&still).expect("healthy");
        let now_j = energy_j(&simulation);
        gained_j = gained_j.max(now_j - least_j);
        least_j = least_j.min(now_j);
    }
    (gained_j, first_j)
}

in_both_engines!(no_surface_adds_energy);
fn no_surface_adds_energy() {
    let slippery = Surface { friction: 2.0, slip_m_s_per_n: 0.1, ..Default::default() };
    let soft = Surface { soft_cfm_m_s_per_n: 0.01, ..Default::default() };
    for surface in [
        Surface::default(),
        Surface { slip_m_s_per_n: 0.01, ..slippery.clone() },
        Surface { slip_m_s_per_n: 0.5, ..slippery.clone() },
        Surface { slip_m_s_per_n: 0.1, ..soft.clone() },
        Surface { bounce: 0.5, ..Default::default() },
        Surface { dampen_per_s: 2.0, ..Default::default() },
        slippery,
        soft,
    ] {
        let (gained_j, first_j) = energy_gained_j(surface.clone());
        assert!(gained_j < 0.02 * first_j, "{gained_j} of {first_j} J on {surface:?}");
    }
}
