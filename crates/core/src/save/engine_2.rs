//! Conversion of worlds of engine 2 to the numbers of this engine, with which they behave as in engine 2.
//!
//! Engine 2 had rates and shares per physics step, so the effect of a number depended on the step rate. Presets of format 2 and champions
//! of engine 2 have such numbers.

use crate::evolve::Settings;
use crate::score::Trial;
use crate::world::{ERP_TIME_S, Surface};

/// Converts the settings of a preset of format 2 to those of this engine.
pub fn converted_settings(mut settings: Settings) -> Settings {
    settings.trial = converted(settings.trial);
    // In format 2, bends and twists had a common range.
    let wave = &mut settings.genome.wave;
    wave.twist_range_rad = wave.angle_range_rad;
    settings
}

/// Converts a trial of engine 2 to the numbers of this engine.
pub fn converted(mut trial: Trial) -> Trial {
    let steps_per_s = trial.physics.steps_per_s as f32;
    // Engine 2 had one iteration per substep.
    trial.physics.iterations = 1;
    // Engine 2 divided velocities by 1 + d h in each step.
    let damping = &mut trial.agent.angular_damping_per_s;
    *damping = steps_per_s * libm::log1pf(*damping / steps_per_s);
    for surface in std::iter::once(&mut trial.surface).chain(&mut trial.ground) {
        convert_surface(surface, steps_per_s);
    }
    let skin = &mut trial.agent.skin;
    convert_softness(&mut skin.soft_erp, &mut skin.soft_cfm_m_s_per_n, steps_per_s);
    // The joints keep their stiffness. The damping of a soft joint follows from it, because joints have no ERP of their own.
    let stiffer = 1.0 / (ERP_TIME_S * steps_per_s);
    trial.agent.joint_cfm_m_s_per_n =
        trial.agent.joint_cfm_m_s_per_n.map(|cfm| (cfm * stiffer).min(MOST_JOINT_CFM));
    trial
}

/// Largest damping of a surface, in 1/s. At its highest damping and lowest step rate, engine 2 stopped limbs within one step, which no
/// finite rate can do.
const MOST_DAMPING_PER_S: f32 = 20.0;
/// Limits of this engine: the least ERP and the greatest CFM of a material, and the greatest CFM of a joint. At low step rates, extreme
/// numbers of engine 2 convert to numbers beyond these limits.
const LEAST_ERP: f32 = 0.01;
const MOST_CFM: f32 = 1.0;
const MOST_JOINT_CFM: f32 = 0.1;

fn convert_surface(surface: &mut Surface, steps_per_s: f32) {
    // Engine 2 multiplied velocities by 1 - d h in each step.
    let share = (surface.dampen_per_s / steps_per_s).min(1.0);
    surface.dampen_per_s = (-steps_per_s * libm::log1pf(-share)).min(MOST_DAMPING_PER_S);
    convert_softness(&mut surface.soft_erp, &mut surface.soft_cfm_m_s_per_n, steps_per_s);
}

/// Converts the ERP, which was the share of an error that a step corrected, and the CFM of a material.
fn convert_softness(erp: &mut f32, cfm_m_s_per_n: &mut f32, steps_per_s: f32) {
    let steps = ERP_TIME_S * steps_per_s;
    if (steps - 1.0).abs() < 1.0e-6 {
        return;
    }
    if *cfm_m_s_per_n == 0.0 {
        *erp = (1.0 - libm::powf(1.0 - *erp, steps)).max(LEAST_ERP);
        return;
    }
    // The conversion keeps the spring ERP / (h CFM) and the damper (1 - ERP) / CFM.
    let stiff = *erp * steps;
    let new_erp = stiff / (stiff + 1.0 - *erp);
    *cfm_m_s_per_n = (*cfm_m_s_per_n * new_erp / stiff).min(MOST_CFM);
    *erp = new_erp.max(LEAST_ERP);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::PhysicsSettings;

    #[test]
    fn numbers_at_the_limits_stay_within_those_of_this_engine() {
        for steps_per_s in [20_u32, 30, 60, 240, 960] {
            for (soft_erp, soft_cfm_m_s_per_n) in [(0.02, 0.0), (1.0, 0.0), (0.02, 1.0), (1.0, 1.0)]
            {
                let mut trial = Trial {
                    physics: PhysicsSettings { steps_per_s, ..Default::default() },
                    ..Trial::default()
                };
                trial.surface.soft_erp = soft_erp;
                trial.surface.soft_cfm_m_s_per_n = soft_cfm_m_s_per_n;
                trial.agent.joint_cfm_m_s_per_n = 0.1.into();
                let new = converted(trial);
                assert_eq!(new.check(), Ok(()), "{steps_per_s}, {soft_erp}, {soft_cfm_m_s_per_n}");
            }
        }
    }

    #[test]
    fn rates_and_shares_of_a_step_become_those_of_time() {
        for steps_per_s in [60_u32, 120, 30] {
            let mut trial = Trial {
                physics: PhysicsSettings { steps_per_s, ..Default::default() },
                ..Trial::default()
            };
            let step_s = 1.0 / steps_per_s as f32;
            trial.agent.angular_damping_per_s = 200.0;
            trial.surface.dampen_per_s = 5.0;
            trial.surface.soft_erp = 0.4;
            let soft = Surface { soft_erp: 0.3, soft_cfm_m_s_per_n: 0.02, ..Surface::default() };
            trial.ground = Some(soft.clone());
            let new = converted(trial);
            let close = |found: f32, expected: f32| {
                assert!((found / expected - 1.0).abs() < 1e-4, "{found} for {expected}");
            };
            let kept = |rate: f32| libm::expf(-rate * step_s);
            close(kept(new.agent.angular_damping_per_s), 1.0 / (1.0 + 200.0 * step_s));
            close(kept(new.surface.dampen_per_s), 1.0 - 5.0 * step_s);
            close(libm::powf(1.0 - new.surface.soft_erp, step_s / ERP_TIME_S), 0.6);
            let ground = new.ground.expect("it had one");
            close(
                ground.soft_erp / (ERP_TIME_S * ground.soft_cfm_m_s_per_n),
                soft.soft_erp / (step_s * soft.soft_cfm_m_s_per_n),
            );
            close(
                (1.0 - ground.soft_erp) / ground.soft_cfm_m_s_per_n,
                (1.0 - soft.soft_erp) / soft.soft_cfm_m_s_per_n,
            );
        }
    }
}
