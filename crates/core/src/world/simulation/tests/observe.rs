//! Readings of a world compared with known forces and torques.

use super::*;

/// Returns the sum of the forces of all contacts, in N.
fn sum(simulation: &Simulation) -> Vector {
    simulation.contact_forces().iter().map(|contact| contact.force_n).sum()
}

in_both_engines!(a_snake_at_rest_is_carried_by_its_contacts);
fn a_snake_at_rest_is_carried_by_its_contacts() {
    let plan = plan(5);
    let mut simulation = Simulation::new(&plan);
    simulation.take_steps(120, &[]);
    let weight_n = plan.body.mass_kg() * plan.physics.gravity_m_s2;
    let sum = sum(&simulation);
    assert!((sum.z - weight_n).abs() < 0.01 * weight_n, "{sum} for {weight_n} N");
    assert!(sum.x.abs() + sum.y.abs() < 0.01 * weight_n, "{sum}");
    for contact in simulation.contact_forces() {
        assert!(contact.limb < 5 && contact.at_m.z.abs() < 0.02, "{contact:?}");
    }
}

in_both_engines!(friction_opposes_the_motion_with_the_force_of_its_law);
fn friction_opposes_the_motion_with_the_force_of_its_law() {
    let mut plan = plan(2);
    plan.surface.friction = 0.5;
    plan.ground.friction = 0.5;
    let mut simulation = Simulation::new(&plan);
    simulation.change_parts(|(_, part)| part.linear.y = -4.0);
    simulation.take_steps(10, &[]);
    let weight_n = plan.body.mass_kg() * plan.physics.gravity_m_s2;
    let sum = sum(&simulation);
    assert!((sum.z - weight_n).abs() < 0.05 * weight_n, "{sum} for {weight_n} N");
    assert!((sum.y - 0.5 * sum.z).abs() < 0.05 * weight_n, "{sum}: forwards, half the weight");
}

in_both_engines!(applied_torques_are_the_clamped_torques);
fn applied_torques_are_the_clamped_torques() {
    let mut simulation = Simulation::new(&plan(3));
    let asked = JointTorque { bend_nm: 5000.0, twist_nm: -30.0 };
    simulation.step(&[asked, JointTorque::default()]).expect("healthy");
    let seen: Vec<JointTorque> = simulation.applied_torques().collect();
    assert_eq!(seen, [JointTorque { bend_nm: 1000.0, twist_nm: -30.0 }, JointTorque::default()]);
    assert_eq!(simulation.body().joints[0].max_bend_torque_nm, 1000.0);
}
