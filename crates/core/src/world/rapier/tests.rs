//! If no body is marked as changed, the engine may skip work. Skipping changes no bit.

use super::*;
use crate::world::Pose;

/// Number of steps before the middle of the test, and after it.
const STEPS: usize = 200;

/// Returns the poses after each step of a snake that bends and twists at the stairs, under another plan from the middle on. If `marked`,
/// the engine processes all bodies as changed in each step.
fn poses(plan: &WorldPlan, then: &WorldPlan, marked: bool) -> Vec<Pose> {
    let mut world = RapierWorld::new(plan);
    let mut poses = Vec::new();
    for step in 0..2 * STEPS {
        if step == STEPS {
            let mut continued = RapierWorld::new(then);
            continued.continue_from(&world);
            world = continued;
        }
        world.is_changed |= marked;
        let torque = Vector::new(1.0, 0.1, 0.0) * (300.0 * libm::sinf(step as f32 / 12.0));
        let joints = [1.0, -1.0, 0.5, 1.0].into_iter().enumerate();
        world.parts.iter_mut().for_each(|part| part.torque_nm = Vector::ZERO);
        for (front, share) in joints {
            let couple = world.parts[front].turn * torque * share;
            world.parts[front].torque_nm -= couple;
            world.parts[front + 1].torque_nm += couple;
        }
        let earlier = world.parts.clone();
        world.step();
        world.bounce(&earlier);
        poses.extend(world.parts.iter().map(PartState::pose));
    }
    poses
}

#[test]
fn without_marks_of_changed_bodies_the_engine_computes_the_same_bits() {
    let champion = crate::save::shipped_champion().expect("shipped").champion;
    let mut hard = champion.trial.world_plan(&champion.genome);
    hard.start_y_m = -5.1;
    let mut soft = hard.clone();
    soft.surface.soft_cfm_m_s_per_n = 1e-4;
    soft.ground.soft_cfm_m_s_per_n = 1e-4;
    let mut bouncing = hard.clone();
    bouncing.skin.bounce = 0.6;
    let mut heavy = hard.clone();
    heavy.body.parts.iter_mut().for_each(|limb| limb.density_kg_m3 *= 3.0);
    let plans = [&hard, &soft, &bouncing, &heavy];
    for (index, plan) in plans.into_iter().enumerate() {
        for then in plans {
            assert!(poses(plan, then, false) == poses(plan, then, true), "plan {index}: {then:?}");
        }
    }
}
