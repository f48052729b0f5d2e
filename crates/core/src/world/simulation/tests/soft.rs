//! Soft limbs compared with the theory of beams.

use super::*;
use crate::world::{Elasticity, STIFFEST_M4_S2, SpringPlan, modulus_at_pa};

/// Length of the limb, in m. Its cross-section is 1 m by 1 m.
const LENGTH_M: f32 = 2.0;
const LENGTH_CUBED: f32 = LENGTH_M * LENGTH_M * LENGTH_M;
/// Second moment of area of the cross-section, in m⁴.
const AREA_MOMENT_M4: f32 = 1.0 / 12.0;
/// Mass of the limb per length, in kg/m.
const LINE_KG_M: f32 = 2.5;

/// Returns a snake of one limb of this bending stiffness, in N·m², without gravity.
fn beam(bending_nm2: f32, parts: u32, damping_ratio: f32) -> WorldPlan {
    let mut plan = plan(1);
    plan.physics.gravity_m_s2 = 0.0;
    let youngs_modulus_pa = bending_nm2 / AREA_MOMENT_M4;
    let elasticity = Elasticity { youngs_modulus_pa, parts, damping_ratio };
    plan.body = plan.body.with_soft_limbs(|_| Some(elasticity));
    assert_eq!(
        (plan.body.parts.len(), plan.body.springs.len() as u32),
        (parts as usize, parts - 1)
    );
    plan
}

/// Returns the world of a beam whose front face is clamped, 30 m above the ground. Part 0 is a wall, to which a spring holds the beam that is
/// as stiff as half a piece of the beam.
fn clamped(plan: &WorldPlan) -> Simulation {
    let mut plan = plan.clone();
    let BodyPlan { parts, springs, .. } = &mut plan.body;
    for spring in springs.iter_mut() {
        (spring.parent, spring.child) = (spring.parent + 1, spring.child + 1);
    }
    let spring = springs[0].clone();
    let root = SpringPlan {
        parent: 0,
        child: 1,
        stiffness_nm_per_rad: spring.stiffness_nm_per_rad.map(|stiffness| 2.0 * stiffness),
        damping_nms_per_rad: spring.damping_nms_per_rad.map(|damping| 2.0 * damping),
        ..spring
    };
    springs.insert(0, root);
    parts.insert(0, parts[0].clone());
    let mut simulation = lifted(&plan);
    simulation.change_parts(|(index, part)| part.is_held = index == 0);
    simulation
}

/// Returns the place of the middle of a beam's rear face, in m.
fn tip(simulation: &Simulation) -> Vector {
    let last = simulation.parts().len() - 1;
    let half_m = simulation.body().parts[last].length_m / 2.0;
    simulation.parts()[last].pose() * Vector::new(0.0, -half_m, 0.0)
}

fn rest(simulation: &mut Simulation) {
    let step_s = simulation.plan.physics.step_s();
    (0..(20.0 / step_s) as u32).for_each(|_| simulation.advance());
}

/// Returns the deflection of the tip of a clamped beam under a load at the tip along an axis, relative to the formula for the chain of
/// hinges.
fn under_a_load(plan: &WorldPlan, bending_nm2: f32, axis: Vector) -> f32 {
    let mut simulation = clamped(plan);
    let before = tip(&simulation);
    let load_n = 0.04 * LENGTH_M * 3.0 * bending_nm2 / LENGTH_CUBED;
    let last = simulation.parts().len() - 1;
    simulation.change_parts(|(index, part)| {
        if index == last {
            part.force_n = axis * -load_n;
            part.torque_nm = (before - part.at).cross(part.force_n);
        }
    });
    rest(&mut simulation);
    let parts = plan.body.parts.len() as f32;
    let chain_m = load_n * LENGTH_CUBED / (3.0 * bending_nm2) * (1.0 + 0.5 / (parts * parts));
    (before - tip(&simulation)).dot(axis) / chain_m
}

/// Returns the deflection of the tip of a clamped beam under its own weight, relative to the formula for the chain of hinges.
fn under_its_weight(plan: &WorldPlan, bending_nm2: f32) -> f32 {
    let of_gravity = LINE_KG_M * LENGTH_M * LENGTH_CUBED / (8.0 * bending_nm2);
    let mut plan = plan.clone();
    plan.physics.gravity_m_s2 = 0.04 * LENGTH_M / of_gravity;
    let mut simulation = clamped(&plan);
    let before = tip(&simulation);
    rest(&mut simulation);
    let parts = plan.body.parts.len() as f32;
    let chain_m = plan.physics.gravity_m_s2 * of_gravity * (1.0 + 1.0 / (parts * parts));
    (before - tip(&simulation)).z / chain_m
}

in_both_engines!(a_clamped_limb_bends_like_a_beam);
/// Compares the deflections with the formulas for a chain of hinges, over the allowed range of stiffness, with four iterations for 2 and 3
/// parts and eight for 4.
fn a_clamped_limb_bends_like_a_beam() {
    let rates = [(60, 4), (240, 1)];
    let cases = [(2, 4, 0.03), (3, 4, 0.03), (4, 8, 0.05)];
    for ((steps_per_s, substeps), (parts, iterations, tolerance)) in
        rates.into_iter().flat_map(|rate| cases.map(|case| (rate, case)))
    {
        for bending_nm2 in [100.0, 500.0, 2000.0] {
            let mut plan = beam(bending_nm2, parts, 0.5);
            plan.physics =
                PhysicsSettings { steps_per_s, substeps, iterations, ..plan.physics.clone() };
            let found = [
                under_a_load(&plan, bending_nm2, Vector::Z),
                under_a_load(&plan, bending_nm2, Vector::X),
                under_its_weight(&plan, bending_nm2),
            ];
            println!("{parts} parts, EI {bending_nm2}: {found:?}");
            for ratio in found {
                assert!(
                    (ratio - 1.0).abs() < tolerance,
                    "{parts} parts, EI {bending_nm2}: {ratio}"
                );
            }
        }
    }
}

/// Returns the greatest mechanical energy of a free beam within 3 s after a kick, and the energy that is left after 3 s, as shares of the
/// energy at the start. The kick turns both ends in opposite directions: about the x axis for bending, about the y axis for torsion.
fn after_a_kick(plan: &WorldPlan, is_torsion: bool) -> [f64; 2] {
    let mut simulation = lifted(plan);
    let last = simulation.parts().len() - 1;
    let axis = if is_torsion { Vector::Y } else { Vector::X };
    for (part, side) in [(0, 1.0), (last, -1.0)] {
        simulation.engine.parts_mut()[part].angular = axis * (side * 0.8);
    }
    let start_j = simulation.mechanical_energy_j();
    let mut most_j = 0.0_f64;
    for _ in 0..180 {
        simulation.advance();
        most_j = most_j.max(simulation.mechanical_energy_j());
    }
    [most_j / start_j, simulation.mechanical_energy_j() / start_j]
}

in_both_engines!(a_kicked_limb_gains_no_energy);
/// Springs never supply energy, whether their own damping is 0 or not.
fn a_kicked_limb_gains_no_energy() {
    for parts in [2, 3, 4] {
        for bending_nm2 in [100.0, 500.0, 2000.0] {
            for damping_ratio in [0.0, 0.3] {
                for is_torsion in [false, true] {
                    let plan = beam(bending_nm2, parts, damping_ratio);
                    let [most, left] = after_a_kick(&plan, is_torsion);
                    let case = format!("{parts} parts, EI {bending_nm2}, torsion {is_torsion}");
                    assert!(most <= 1.001, "{case}: {most} of its energy");
                    assert!(left < 1.0, "{case}: vibrations fade");
                }
            }
        }
    }
}

in_both_engines!(shorter_substeps_lose_less_of_a_vibration);
/// The implicit springs take energy from vibrations even without damping, and the more, the longer a substep is.
fn shorter_substeps_lose_less_of_a_vibration() {
    let left = [2, 4, 8, 16].map(|substeps| {
        let mut plan = beam(100.0, 3, 0.0);
        plan.physics.substeps = substeps;
        after_a_kick(&plan, false)[1]
    });
    println!("of the energy left after 3 s: {left:?}");
    assert!(left.is_sorted_by(|longer, shorter| longer < shorter), "{left:?}");
}

in_both_engines!(the_stiffest_snake_moves_like_a_rigid_one_at_first);
/// Limbs of the stiffest material that still bends move like rigid ones, until small differences have grown. Full torque bends even these
/// limbs by a fifth of a radian at each spring, so gaits that strain against their joints diverge earlier.
fn the_stiffest_snake_moves_like_a_rigid_one_at_first() {
    let champions = crate::save::library::shipped_champions();
    for wanted in ["fast", "robust"] {
        let (_, loaded) = champions.iter().find(|(name, _)| *name == wanted).expect("shipped");
        let champion = &loaded.champion;
        let mut trial = champion.trial.clone();
        trial.physics.engine = ENGINE.get();
        (trial.physics.substeps, trial.physics.iterations) = (4, 4);
        let rigid = trial.clone();
        let density = rigid.agent.body_plan(&champion.genome).parts[0].density_kg_m3;
        let stiffest_pa = modulus_at_pa(STIFFEST_M4_S2, [1.0; 2], density);
        trial.agent.youngs_modulus_pa = Some((stiffest_pa * 0.999).into());
        let [rigid, soft] = [&rigid, &trial].map(|trial| {
            let mut rollout = crate::score::Rollout::new(&champion.genome, trial);
            let centre = |rollout: &crate::score::Rollout| {
                let body = rollout.body();
                let parts = rollout.poses().iter().zip(&body.parts);
                let moment: Vector =
                    parts.map(|(pose, part)| pose.translation * part.mass_kg()).sum();
                moment / body.mass_kg()
            };
            let path = (0..60).map(|_| rollout.advance().then(|| centre(&rollout)));
            let path: Vec<Vector> = path.map(|centre| centre.expect("healthy")).collect();
            (rollout.body().parts.len(), path)
        });
        assert_eq!((rigid.0, soft.0), (5, 15));
        let moved_m = rigid.1[0].distance(rigid.1[59]);
        let ways = rigid.1.iter().zip(&soft.1);
        let apart_m = ways.map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        println!("{wanted}: at most {apart_m} m apart within 1 s, of {moved_m} m");
        assert!(moved_m > 1.0 && apart_m < 0.25, "{wanted}: {apart_m} m apart of {moved_m} m");
    }
}
