//! The energy audit over many random snakes.

use super::Rollout;
use crate::genome::{ControllerKind, GenomeSpace};
use crate::rng::{Purpose, stream};
use crate::score::Trial;

#[test]
#[ignore = "measure"]
fn measure_energy_gain() {
    for (rate, substeps) in [(60, 2), (60, 4)] {
        let mut trial = Trial { duration_s: 3.0, ..Trial::default() };
        trial.agent.density_kg_m3 = Some(8.0.into());
        trial.physics.steps_per_s = rate;
        trial.physics.substeps = substeps;
        let space = GenomeSpace { controller: ControllerKind::Gait, ..GenomeSpace::default() };
        let mut flagged = 0;
        let mut shown = 0;
        for individual in 0..150 {
            let mut rng = stream(1, 1, individual, Purpose::Birth);
            let genome = space.random_genome(trial.genome_shape(), &mut rng);
            let mut rollout = Rollout::new(&genome, &trial);
            let mut rows = Vec::new();
            while rollout.advance() {
                let lost = rollout.simulation().energy_lost();
                let spent = rollout.simulation().effort().energy_j;
                let bends: Vec<String> = rollout.simulation().joint_states().map(|j| format!("{:.2}/{:.2}", j.bend_rad, j.twist_rad)).collect();
                rows.push(format!("step {} gain {:.2} jd {:.2} spent {:.2} contact {} z {:.3} {bends:?}", rollout.step(), -lost.total_j, lost.joint_damping_j, spent, rollout.simulation().limbs_in_contact(), rollout.middle_m().z));
            }
            let e = rollout.evaluation();
            if e.disqualified.is_some() {
                flagged += 1;
                if shown < 4 {
                    shown += 1;
                    println!("rate {rate} sub {substeps} ind {individual} limits {:?}/{:?} {:?} after {}", genome.body.bend_limit_rad, genome.body.twist_limit_rad, e.disqualified, e.steps);
                    let lost = rollout.simulation().energy_lost();
                    let bends: Vec<String> = rollout.simulation().joint_states().map(|j| format!("{:.2}/{:.2} {:.1}/{:.1}", j.bend_rad, j.twist_rad, j.bend_rad_s, j.twist_rad_s)).collect();
                    let t: Vec<String> = rollout.simulation().applied_torques().map(|t| format!("{:.0}/{:.0}", t.bend_nm, t.twist_nm)).collect();
                    let ke: f32 = rollout.simulation().physics().bodies.iter().map(|(_, b)| b.kinetic_energy()).sum();
                    println!("   FLAG gain {:.2} lost {lost:?} ke {ke} {bends:?} {t:?}", -lost.total_j);
                    for row in rows.iter().rev().take(8).rev() { println!("   {row}"); }
                }
            }
        }
        println!("rate {rate} substeps {substeps}: flagged {flagged} of 150");
    }
}
