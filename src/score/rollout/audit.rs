//! The energy audit over many random snakes.

use super::Rollout;
use crate::genome::{ControllerKind, GenomeSpace};
use crate::rng::{Purpose, stream};
use crate::score::Trial;
use crate::world::Disqualification;

#[test]
#[ignore = "measure"]
fn measure_energy_gain() {
    for (name, damping, kind, density) in [
        ("signal", 2.0, ControllerKind::Signal, 8.0), ("signal light", 2.0, ControllerKind::Signal, 2.5),
        ("gait", 2.0, ControllerKind::Gait, 8.0), ("gait light", 2.0, ControllerKind::Gait, 2.5), ("gait undamped", 0.0, ControllerKind::Gait, 8.0),
    ] {
        let mut trial = Trial { duration_s: 5.0, ..Trial::default() };
        trial.agent.angular_damping_per_s = damping;
        trial.agent.density_kg_m3 = Some(density.into());
        let space = GenomeSpace { controller: kind, ..GenomeSpace::default() };
        let mut reasons = std::collections::BTreeMap::new();
        let mut gains: Vec<(f32, f32, f32, f32)> = Vec::new();
        for individual in 0..1000 {
            let mut rng = stream(1, 1, individual, Purpose::Birth);
            let genome = space.random_genome(trial.genome_shape(), &mut rng);
            let mut rollout = Rollout::new(&genome, &trial);
            let mut worst = (f32::MIN, 0.0, 0.0, 0.0);
            while rollout.advance() {
                let lost = rollout.simulation().energy_lost();
                let spent = rollout.simulation().effort().energy_j;
                let over = -lost.total_j - 0.05 * spent;
                if over > worst.0 { worst = (over, -lost.elsewhere_j(), spent, -lost.total_j); }
            }
            *reasons.entry(rollout.evaluation().disqualified).or_insert(0) += 1;
            gains.push(worst);
        }
        gains.sort_by(|a, b| b.0.total_cmp(&a.0));
        println!("{name}: {reasons:?} {:?} median {:?}", &gains[..5], gains[500]);
    }
    for density in [2.5_f32, 8.0, 50.0] { for rate in [60, 240] {
        let mut trial = Trial { duration_s: 2.0, ..Trial::default() };
        trial.agent.density_kg_m3 = Some(density.into());
        trial.agent.max_bend_torque_nm = 0.0.into();
        trial.agent.max_twist_torque_nm = 0.0.into();
        trial.physics.steps_per_s = rate;
        let space = GenomeSpace { controller: ControllerKind::Signal, ..GenomeSpace::default() };
        let mut rng = stream(1, 1, 1, Purpose::Birth);
        let genome = space.random_genome(trial.genome_shape(), &mut rng);
        let mut rollout = Rollout::new(&genome, &trial);
        let mut text = String::new();
        while rollout.advance() {
            if rollout.step() < 12 || rollout.step() % 30 == 0 { text += &format!("{:.3} ({:.4}) ", -rollout.simulation().energy_lost().total_j, rollout.middle_m().z); }
        }
        println!("rest density {density} rate {rate}: {:?} {text}", rollout.evaluation().disqualified);
    } }
    let _ = Disqualification::EnergyFromNothing;
}
