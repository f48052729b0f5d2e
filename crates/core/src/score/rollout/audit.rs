//! The energy balance of many random snakes, computed independently of the simulation's own balance.

use super::Rollout;
use crate::genome::{ControllerKind, Genome};
use crate::score::Trial;
use crate::world::{Disqualification, Simulation};

/// Returns the kinetic and potential energy of all limbs, in J. The engine's positions are half a substep ahead of its velocities.
fn mechanical_energy_j(simulation: &Simulation) -> f64 {
    let world = simulation.in_rapier();
    let physics = world.physics();
    let parameters = &physics.integration_parameters;
    let half_substep_s = parameters.dt / parameters.num_solver_iterations as f32 / 2.0;
    let bodies = world.bodies().iter().map(|&part| &physics.bodies[part]);
    let energies_j = bodies.zip(simulation.parts()).map(|(body, part)| {
        let inertia = body.mass_properties().local_mprops.principal_inertia();
        let rate = part.turn.inverse() * part.angular;
        let moving_j = body.mass() * part.linear.length_squared() + (inertia * rate).dot(rate);
        let height_m = part.at.z - part.linear.z * half_substep_s;
        let weight_n = -physics.gravity.z * body.mass();
        f64::from(moving_j / 2.0) + f64::from(weight_n * height_m)
    });
    energies_j.sum()
}

/// Returns the largest gain of mechanical energy beyond the work of the joints during a rollout, in J, less 5 % of the energy that the
/// joints spent, and the reason of a disqualification. The work is the sum over all steps of torque times turned angle, for the torques
/// and angles that the simulation reports. The simulation's own balance is not used.
fn greatest_gain_j(genome: &Genome, trial: &Trial) -> (f64, Option<Disqualification>) {
    let mut rollout = Rollout::new(genome, trial);
    let start_j = mechanical_energy_j(rollout.simulation());
    let angles = |simulation: &Simulation| -> Vec<[f32; 2]> {
        simulation.joint_states().map(|joint| [joint.bend_rad, joint.twist_rad]).collect()
    };
    let mut before = angles(rollout.simulation());
    let (mut work_j, mut most_j) = (0.0, f64::MIN);
    while rollout.advance() {
        let after = angles(rollout.simulation());
        let torques = rollout.simulation().applied_torques();
        for ((torque, before), after) in torques.zip(&before).zip(&after) {
            let [bend_rad, twist_rad] = [after[0] - before[0], after[1] - before[1]];
            work_j += f64::from(torque.bend_nm * bend_rad + torque.twist_nm * twist_rad);
        }
        before = after;
        let spent_j = f64::from(rollout.simulation().effort().energy_j);
        let gained_j = mechanical_energy_j(rollout.simulation()) - start_j - work_j;
        most_j = most_j.max(gained_j - 0.05 * spent_j);
    }
    (most_j, rollout.evaluation().disqualified)
}

/// Runs this number of random snakes of two kinds of controller. Snakes that are not disqualified must not gain energy.
fn audit(snakes: u32) {
    let mut trial = Trial::default();
    for density_kg_m3 in [2.5, 9.0] {
        trial.agent.density_kg_m3 = Some(density_kg_m3.into());
        for kind in [ControllerKind::Gait, ControllerKind::Signal] {
            let mut healthy = 0;
            for individual in 0..snakes {
                let genome = trial.random_genome_of(kind, individual);
                let (gained_j, disqualified) = greatest_gain_j(&genome, &trial);
                if disqualified.is_none() {
                    healthy += 1;
                    assert!(gained_j < 1.0, "{kind} {individual}: {gained_j} J too much");
                }
            }
            assert!(healthy > snakes * 4 / 5, "{kind}: {healthy} of {snakes} are not disqualified");
        }
    }
}

#[test]
fn random_snakes_gain_no_energy_from_nothing_or_are_disqualified() {
    audit(25);
}

#[test]
#[ignore = "a minute: cargo test --release -p snakes-core a_thousand_random_snakes -- --ignored"]
fn a_thousand_random_snakes_gain_no_energy_from_nothing_or_are_disqualified() {
    audit(250);
}
