//! Random rows, trees and soft snakes on random surfaces under random torques: every number that is not finite must be detected.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::rng::{Purpose, stream};
use crate::world::{Elasticity, Mount, Rotation, SOFTEST_M4_S2, STIFFEST_M4_S2, modulus_at_pa};

/// Draws a number between two positive ones, with the same chance for each order of magnitude.
fn between(rng: &mut ChaCha8Rng, least: f32, most: f32) -> f32 {
    libm::expf(rng.random_range(libm::logf(least)..=libm::logf(most)))
}

/// Draws a number between two positive ones, or returns 0, each with a chance of one half.
fn or_none(rng: &mut ChaCha8Rng, least: f32, most: f32) -> f32 {
    if rng.random_bool(0.5) { 0.0 } else { between(rng, least, most) }
}

fn surface(rng: &mut ChaCha8Rng) -> Surface {
    Surface {
        friction: or_none(rng, 0.01, 1000.0),
        bounce: if rng.random_bool(0.5) { 0.0 } else { rng.random_range(0.0..=1.0) },
        bounce_velocity_m_s: or_none(rng, 0.01, 100.0),
        soft_erp: rng.random_range(0.01..=1.0),
        soft_cfm_m_s_per_n: or_none(rng, 1.0e-6, 1.0),
        slip_m_s_per_n: or_none(rng, 1.0e-4, 10.0),
        dampen_per_s: or_none(rng, 0.01, 20.0),
    }
}

/// Kinds of bodies: rigid limbs in a row, limbs in a tree, and soft limbs in a row.
#[derive(Debug, Clone, Copy)]
enum SnakeKind {
    Row,
    Tree,
    Soft,
}

/// Hangs each limb on a random one before it, at a random place and turned at random.
fn branch(plan: &mut WorldPlan, rng: &mut ChaCha8Rng, shape: &mut ChaCha8Rng) {
    for joint in &mut plan.body.joints {
        joint.parent = shape.random_range(0..joint.child);
        let half_m = Vector::from(plan.body.parts[joint.parent].size_m()) / 2.0;
        let mut share = || rng.random_range(-1.0_f32..=1.0);
        let at_m = Vector::new(share(), share(), share()) * half_m;
        let turn = Rotation::from_xyzw(share(), share(), share(), 1.1 + share()).normalize();
        joint.mount = Some(Mount { at_m, turn, start_rad: [share(), share()] });
    }
}

/// Divides limbs into parts with springs.
fn soften(plan: &mut WorldPlan, rng: &mut ChaCha8Rng, shape: &mut ChaCha8Rng) {
    let body = plan.body.clone();
    let elastic = body.parts.iter().map(|part| {
        let bending_m4_s2 = between(rng, SOFTEST_M4_S2, STIFFEST_M4_S2 * 0.999);
        let sides_m = [part.width_m, part.height_m];
        let youngs_modulus_pa = modulus_at_pa(bending_m4_s2, sides_m, part.density_kg_m3);
        let damping_ratio = or_none(rng, 0.01, 2.0);
        let parts = shape.random_range(1..=4);
        Elasticity { youngs_modulus_pa, parts, damping_ratio }
    });
    let elastic: Vec<Elasticity> = elastic.collect();
    plan.body = body.with_soft_limbs(|limb| Some(elastic[limb]));
}

/// Draws a world from nearly all numbers that settings and genomes allow. `shape` alone draws which parts the body has and how they are
/// joined.
fn random_plan(kind: SnakeKind, rng: &mut ChaCha8Rng, shape: &mut ChaCha8Rng) -> WorldPlan {
    let limbs = shape.random_range(1..=12);
    let mut plan = plan(limbs);
    for part in &mut plan.body.parts {
        part.width_m = between(rng, 0.1, 10.0);
        part.length_m = between(rng, 0.1, 10.0);
        part.height_m = between(rng, 0.1, 10.0);
        part.density_kg_m3 = between(rng, 0.1, 1000.0);
    }
    for joint in &mut plan.body.joints {
        joint.bend_limit_rad = rng.random_range(0.0..=std::f32::consts::PI);
        joint.twist_limit_rad = rng.random_range(0.0..=std::f32::consts::PI);
        joint.max_bend_torque_nm = or_none(rng, 1.0, 1.0e6);
        joint.max_twist_torque_nm = or_none(rng, 1.0, 1.0e6);
        joint.damping_nms_per_rad = or_none(rng, 0.01, 1.0e5);
        joint.cfm_m_s_per_n = or_none(rng, 1.0e-6, 0.1);
    }
    plan.body.angular_damping_per_s = or_none(rng, 0.01, 1000.0);
    plan.physics.steps_per_s = rng.random_range(20..=240);
    plan.physics.substeps = rng.random_range(1..=4);
    plan.physics.iterations = rng.random_range(1..=4);
    plan.physics.gravity_m_s2 = or_none(rng, 0.1, 100.0);
    (plan.surface, plan.ground) = (surface(rng), surface(rng));
    plan.skin.friction = between(rng, 0.01, 1000.0);
    plan.skin.bounce = or_none(rng, 0.01, 1.0);
    plan.skin.soft_cfm_m_s_per_n = or_none(rng, 1.0e-6, 1.0);
    plan.stairs.nosing_m = if rng.random_bool(0.5) { 0.0 } else { 0.3 };
    // Many snakes begin inside of the stairs.
    plan.start_y_m = rng.random_range(-20.0..=20.0);
    plan.start_turn_rad = rng.random_range(-3.2..=3.2);
    match kind {
        SnakeKind::Row => {}
        SnakeKind::Tree => branch(&mut plan, rng, shape),
        SnakeKind::Soft => soften(&mut plan, rng, shape),
    }
    plan
}

/// Steps random snakes with these numbers. Returns how many of their steps were healthy.
fn step_random_snakes(kind: SnakeKind, numbers: std::ops::Range<u32>) -> u32 {
    let mut healthy = 0;
    for number in numbers {
        let mut rng = stream(1, 0, number, Purpose::Perturbation);
        let plan = random_plan(kind, &mut rng, &mut stream(1, 1, number, Purpose::Perturbation));
        let mut simulation = Simulation::new(&plan);
        assert!(simulation.common().is_some());
        for step in 0..12 {
            let torques: Vec<JointTorque> = plan
                .body
                .joints
                .iter()
                .map(|_| JointTorque {
                    bend_nm: rng.random_range(-1.0e6..=1.0e6),
                    twist_nm: rng.random_range(-1.0e6..=1.0e6),
                })
                .collect();
            if simulation.step(&torques).is_err() {
                break;
            }
            healthy += 1;
            let poses = simulation.poses().zip(simulation.velocities());
            for (pose, [linear, angular]) in poses {
                let is_finite = pose.translation.is_finite()
                    && pose.rotation.is_finite()
                    && linear.is_finite()
                    && angular.is_finite();
                assert!(is_finite, "{kind:?} {number}, step {step}: {pose:?} {linear} {angular}");
            }
            let forces = simulation.contact_forces();
            let is_finite = forces.iter().all(|force| force.force_n.is_finite());
            assert!(is_finite, "snake {number}, step {step}: {forces:?}");
            assert!(simulation.effort().energy_j.is_finite(), "snake {number}, step {step}");
        }
    }
    healthy
}

#[test]
fn random_snakes_end_or_stay_finite() {
    ENGINE.set(PhysicsEngine::Lanes);
    for (kind, least) in
        [(SnakeKind::Row, 4_000), (SnakeKind::Tree, 1_000), (SnakeKind::Soft, 1_000)]
    {
        let healthy = step_random_snakes(kind, 0..2_000);
        assert!(healthy > least, "{kind:?}: {healthy} healthy steps");
    }
}

/// Runs the test with a million snakes of each kind: `cargo test --release -p snakes-core a_million_random_snakes -- --ignored`.
#[test]
#[ignore = "takes minutes"]
fn a_million_random_snakes_end_or_stay_finite() {
    let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get) as u32;
    std::thread::scope(|scope| {
        let each = 1_000_000 / threads + 1;
        let workers: Vec<_> = (0..threads)
            .map(|thread| {
                scope.spawn(move || {
                    ENGINE.set(PhysicsEngine::Lanes);
                    let numbers = thread * each..(thread + 1) * each;
                    [SnakeKind::Row, SnakeKind::Tree, SnakeKind::Soft]
                        .map(|kind| step_random_snakes(kind, numbers.clone()))
                        .iter()
                        .sum::<u32>()
                })
            })
            .collect();
        let healthy: u32 = workers.into_iter().map(|worker| worker.join().expect("finite")).sum();
        assert!(healthy > 2_000_000, "{healthy} healthy steps");
    });
}

/// Returns a state as bits, with the same bits for every NaN.
fn bits(simulation: &Simulation) -> Vec<u32> {
    let mut bits = Vec::new();
    for (pose, [linear, angular]) in simulation.poses().zip(simulation.velocities()) {
        let vectors = [pose.translation, linear, angular].into_iter();
        let numbers = vectors.flat_map(|of| of.to_array()).chain(pose.rotation.to_array());
        bits.extend(numbers.map(|of| if of.is_nan() { f32::NAN.to_bits() } else { of.to_bits() }));
    }
    bits
}

/// Steps healthy and broken snakes on all kinds of surfaces, each alone and in lock step with others. A broken snake stays in its lane.
#[test]
fn random_snakes_have_the_same_bits_in_lock_step() {
    ENGINE.set(PhysicsEngine::Lanes);
    let mut lock_step = LockStep::default();
    let (mut healthy, mut broken) = (0, 0);
    for group in 0..96_u32 {
        let mut rng = stream(2, 0, group, Purpose::Perturbation);
        let kind = [SnakeKind::Row, SnakeKind::Tree, SnakeKind::Soft][group as usize % 3];
        // All snakes of a group have the same shape.
        let shape = || stream(2, 1, group, Purpose::Perturbation);
        let mut plans = vec![random_plan(kind, &mut rng, &mut shape())];
        while plans.len() < 1 + group as usize / 3 % LANES {
            let mut plan = random_plan(kind, &mut rng, &mut shape());
            plan.physics = plans[0].physics.clone();
            plans.push(plan);
        }
        let mut together: Vec<Simulation> = plans.iter().map(Simulation::new).collect();
        let common = together[0].common();
        together.retain(|world| world.common() == common);
        let mut alone = together.clone();
        for _ in 0..12 {
            let joints = together[0].body().joints.len();
            let torques: Vec<Vec<JointTorque>> = together
                .iter()
                .map(|_| {
                    let mut torque_nm = || rng.random_range(-1.0e5..=1.0e5);
                    (0..joints)
                        .map(|_| JointTorque { bend_nm: torque_nm(), twist_nm: torque_nm() })
                        .collect()
                })
                .collect();
            let mut worlds: Vec<_> =
                together.iter_mut().zip(&torques).map(|(world, of)| (world, &of[..])).collect();
            let ends = lock_step.step(&mut worlds);
            for ((world, torques), end) in alone.iter_mut().zip(&torques).zip(ends) {
                assert_eq!(world.step(torques), end);
                if end.is_ok() { healthy += 1 } else { broken += 1 }
            }
            for (one, other) in together.iter().zip(&alone) {
                assert_eq!(bits(one), bits(other), "group {group}");
            }
        }
    }
    assert!(healthy > 200 && broken > 200, "{healthy} healthy steps, {broken} broken ones");
}
