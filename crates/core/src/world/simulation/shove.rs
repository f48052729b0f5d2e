//! Applies a shove to a limb of a running world.

use super::Simulation;
use crate::world::Shove;

impl Simulation {
    /// Shoves a limb now. If there is no such limb, nothing happens. The energy that the shove adds or takes counts neither as gained nor
    /// as lost in the energy balance.
    pub fn shove(&mut self, shove: &Shove) {
        for part in self.plan.body.parts_of(shove.limb) {
            let mass_kg = self.plan.body.parts[part].mass_kg();
            let velocity = &mut self.engine.parts_mut()[part].linear;
            let before_j = mass_kg * velocity.length_squared() / 2.0;
            *velocity += shove.change_m_s;
            let after_j = mass_kg * velocity.length_squared() / 2.0;
            self.balance.start_j += f64::from(after_j - before_j);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::score::Trial;
    use crate::world::{JointTorque, Shove, Simulation, Vector};

    #[test]
    fn a_shove_moves_all_parts_of_a_soft_limb() {
        let champion = crate::save::shipped_champion().expect("shipped").champion;
        let mut trial = champion.trial.clone();
        trial.agent.youngs_modulus_pa = Some(60_000.0.into());
        let mut world = Simulation::new(&trial.world_plan(&champion.genome));
        world.shove(&Shove { limb: 1, at_s: 0.0, change_m_s: Vector::new(0.0, -2.0, 0.0) });
        let speeds: Vec<f32> = world.speeds_m_s().collect();
        assert_eq!(speeds[2..7], [0.0, 2.0, 2.0, 2.0, 0.0]);
    }

    #[test]
    fn a_shove_changes_the_speed_of_one_limb_and_is_no_gain_of_energy() {
        let trial = Trial::default();
        let genome = trial.random_genome(0);
        let mut world = Simulation::new(&trial.world_plan(&genome));
        let torques = vec![JointTorque::default(); world.body().joints.len()];
        (0..60).for_each(|_| world.step(&torques).expect("healthy"));
        let (speeds, lost_j) =
            (world.speeds_m_s().collect::<Vec<_>>(), world.energy_lost().total_j);
        world.shove(&Shove { limb: 1, at_s: 1.0, change_m_s: Vector::new(0.0, -2.0, 0.0) });
        let after: Vec<f32> = world.speeds_m_s().collect();
        assert!((after[1] - 2.0).abs() < 0.05, "{after:?}");
        assert_eq!((after[0], &after[2..]), (speeds[0], &speeds[2..]));
        assert!((world.energy_lost().total_j - lost_j).abs() < 0.01);
        (0..60).for_each(|_| world.step(&torques).expect("healthy"));
        assert!(
            world.energy_lost().total_j > lost_j + 1.0,
            "friction has taken the energy of the shove"
        );
    }
}
