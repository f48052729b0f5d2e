//! The conditions of an evaluation: everything that is not in the genome.

use serde::{Deserialize, Serialize};

use super::{AgentSettings, Fitness, Repeats};
use crate::check::{Invalid, within};
use crate::genome::{
    Controller, DENSITY_RANGE_KG_M3, Descent, Genome, LARGEST_LIMIT_RAD, LARGEST_TORQUE_NM,
};
use crate::world::{HealthLimits, PhysicsSettings, Stairs, Surface, WorldPlan};

/// Where, how long, on which surface, with which body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Trial {
    /// Length of the simulation, in simulated seconds.
    pub duration_s: f32,
    /// Where the centre of the snake starts on the y axis, in metres. The report's first
    /// generation, which goes nowhere, stands at -7.23.
    pub start_y_m: f32,
    /// Step length, substeps, gravity.
    pub physics: PhysicsSettings,
    /// The staircase.
    pub stairs: Stairs,
    /// The material of the stairs, and of the ground if that has none of its own.
    pub surface: Surface,
    /// The material of the ground, if it differs from that of the stairs.
    pub ground: Option<Surface>,
    /// What is given of the snake.
    pub agent: AgentSettings,
    /// What is rewarded.
    pub fitness: Fitness,
    /// What energy costs, in units of the fitness per kJ: it is taken off. Without it all effort is free.
    pub energy_cost_per_kj: f32,
    /// How many trials make an evaluation.
    pub repeats: Repeats,
    /// When the snake is disqualified.
    pub health: HealthLimits,
}

impl Default for Trial {
    fn default() -> Self {
        Self {
            duration_s: 5.0,
            start_y_m: -7.23,
            physics: PhysicsSettings::default(),
            stairs: Stairs::default(),
            surface: Surface::default(),
            ground: None,
            agent: AgentSettings::default(),
            fitness: Fitness::default(),
            energy_cost_per_kj: 0.0,
            repeats: Repeats::default(),
            health: HealthLimits::default(),
        }
    }
}

impl Trial {
    /// Checks every field against its range.
    pub fn check(&self) -> Result<(), Invalid> {
        // Ten minutes are a third of a second to compute; longer genomes make unreadable saves.
        within("duration_s", self.duration_s, 0.1..=600.0)?;
        within("start_y_m", self.start_y_m, -100.0..=100.0)?;
        self.physics.check().map_err(|error| error.inside("physics"))?;
        self.stairs.check().map_err(|error| error.inside("stairs"))?;
        self.surface.check().map_err(|error| error.inside("surface"))?;
        if let Some(ground) = &self.ground {
            ground.check().map_err(|error| error.inside("ground"))?;
        }
        self.agent.check().map_err(|error| error.inside("agent"))?;
        // At 1000 a joule costs a metre.
        within("energy_cost_per_kj", self.energy_cost_per_kj, 0.0..=1000.0)?;
        self.repeats.check().map_err(|error| error.inside("repeats"))?;
        self.health.check().map_err(|error| error.inside("health"))
    }

    /// How many physics steps the trial lasts: the duration, rounded to the nearest step.
    pub fn steps(&self) -> u32 {
        let steps = f64::from(self.duration_s) * f64::from(self.physics.steps_per_s);
        libm::round(steps).max(1.0) as u32
    }

    /// Checks that a genome, wherever it comes from, can be built and driven under this trial.
    pub fn check_genome(&self, genome: &Genome) -> Result<(), Invalid> {
        within("bend_limit_rad", genome.bend_limit_rad, 0.0..=LARGEST_LIMIT_RAD)?;
        within("twist_limit_rad", genome.twist_limit_rad, 0.0..=LARGEST_LIMIT_RAD)?;
        within("density_kg_m3", genome.density_kg_m3, DENSITY_RANGE_KG_M3)?;
        let (joints, expected) = (genome.controller.joints(), self.agent.joints());
        if joints != expected {
            let allowed = format!("{expected}, one per joint of {} limbs", self.agent.limbs);
            return Err(Invalid::new("controller joints", format!("{joints} joints"), allowed));
        }
        match &genome.controller {
            Controller::Signal(signals) => signals.check().map_err(|e| e.inside("signals")),
            Controller::Wave(waves) => {
                waves.check(LARGEST_TORQUE_NM).map_err(|e| e.inside("waves"))
            }
            Controller::Gait(gait) => gait.check().map_err(|e| e.inside("gait")),
        }
    }

    /// The world in which this trial puts a genome.
    pub fn world_plan(&self, genome: &Genome) -> WorldPlan {
        WorldPlan {
            physics: self.physics.clone(),
            stairs: self.stairs.clone(),
            surface: self.surface.clone(),
            ground: self.ground().clone(),
            skin: self.agent.skin.clone(),
            health: self.health.clone(),
            body: self.agent.body_plan(genome),
            start_y_m: self.start_y_m,
            start_x_m: 0.0,
            start_turn_rad: 0.0,
        }
    }

    /// For whom this trial's genomes are.
    pub fn descent(&self) -> Descent {
        Descent { joints: self.agent.joints(), duration_s: self.duration_s }
    }

    /// The material of the ground.
    pub fn ground(&self) -> &Surface {
        self.ground.as_ref().unwrap_or(&self.surface)
    }

    /// What it means that the centre stands at `y_m`, alone or on average, in the words of the report's Table 1.
    pub fn meaning(&self, y_m: f64) -> String {
        let length_m = f64::from(self.agent.length_m());
        self.stairs.meaning(y_m, f64::from(self.start_y_m), length_m)
    }
}

#[cfg(test)]
mod tests {
    use crate::evolve::{Settings, with_fields};
    use crate::genome::{Descent, GenomeSpace};
    use crate::rng::{Purpose, stream};
    use crate::score::evaluate;

    /// A world in which everything acts a little, so that nothing is without effect.
    fn lively() -> Settings {
        let changes = [
            ("surface.bounce", "0.3"),
            ("surface.bounce_velocity_m_s", "0.5"),
            ("surface.soft_cfm_m_s_per_n", "0.001"),
            ("surface.slip_m_s_per_n", "0.001"),
            ("surface.dampen_per_s", "0.1"),
            ("skin.bounce", "0.1"),
            ("skin.soft_cfm_m_s_per_n", "0.001"),
            ("joint_cfm_m_s_per_n", "0.00001"),
            ("ground.friction", "0.9"),
            // Within reach at once.
            ("first_riser_y_m", "-1.5"),
            ("trial.duration_s", "5"),
            // Whatever happens, it goes on to the end.
            ("joint_drift_m", "10"),
            ("speed_m_s", "1000"),
            ("arena_half_width_m", "1000"),
            ("arena_back_m", "1000"),
        ];
        with_fields(&Settings::default(), changes).expect("allowed")
    }

    /// A newborn that touches ground and stairs, and lands on both.
    const A_TRAVELLER: u32 = 19;

    fn trace(settings: &Settings) -> u64 {
        let joints = settings.trial.agent.joints();
        let mut rng = stream(1, 1, A_TRAVELLER, Purpose::Birth);
        evaluate(
            &GenomeSpace::default().birth(Descent { joints, duration_s: 5.0 }, &mut rng),
            &settings.trial,
        )
        .trace_hash
    }

    #[test]
    fn each_parameter_alone_changes_the_trajectory_of_one_genome() {
        let lively = lively();
        let unchanged = trace(&lively);
        assert_eq!(unchanged, trace(&lively));
        for (field, value) in [
            ("surface.friction", "0.9"),
            ("surface.bounce", "0.35"),
            ("surface.bounce_velocity_m_s", "3"),
            ("surface.soft_erp", "0.3"),
            ("surface.soft_cfm_m_s_per_n", "0.0012"),
            ("surface.slip_m_s_per_n", "0.0012"),
            ("surface.dampen_per_s", "0.12"),
            ("ground.friction", "1.1"),
            ("ground.bounce", "0.35"),
            ("ground.bounce_velocity_m_s", "3"),
            ("ground.soft_erp", "0.3"),
            ("ground.soft_cfm_m_s_per_n", "0.0012"),
            ("ground.slip_m_s_per_n", "0.0012"),
            ("ground.dampen_per_s", "0.12"),
            ("skin.friction", "1.1"),
            ("skin.bounce", "0.35"),
            ("skin.soft_erp", "0.3"),
            ("skin.soft_cfm_m_s_per_n", "0.0012"),
            ("agent.limbs", "6"),
            ("limb_width_m", "[1, 1, 1.1, 1, 1]"),
            ("limb_length_m", "[2, 2, 2, 2.1, 2]"),
            ("limb_height_m", "[1, 1, 1, 1, 1.1]"),
            ("agent.density_kg_m3", "[2, 2, 2, 2, 3]"),
            ("agent.bend_limit_rad", "[0.5, 1, 1, 1]"),
            ("agent.twist_limit_rad", "[1, 1, 1, 0.2]"),
            ("max_bend_torque_nm", "[1000, 1000, 500, 1000]"),
            ("max_twist_torque_nm", "[1000, 300, 1000, 1000]"),
            ("joint_damping_nms_per_rad", "[30, 30, 31, 30]"),
            ("joint_cfm_m_s_per_n", "[0.00001, 0.00002, 0.00001, 0.00001]"),
            ("angular_damping_per_s", "2.1"),
            ("stairs.rise_m", "0.6"),
            ("stairs.tread_m", "1.8"),
            ("stairs.steps", "1"),
            ("stairs.first_riser_y_m", "-1.6"),
            ("trial.start_y_m", "-7.2"),
            ("trial.duration_s", "2.5"),
            ("steps_per_s", "61"),
            ("substeps", "5"),
            ("gravity_m_s2", "9.7"),
        ] {
            let changed = with_fields(&lively, [(field, value)]).expect(field);
            assert_ne!(changed, lively, "{field}");
            assert_ne!(trace(&changed), unchanged, "{field} = {value} does nothing");
        }
    }

    #[test]
    fn a_setting_for_each_part_goes_to_that_part() {
        let changes = [
            ("agent.limbs", "3"),
            ("limb_width_m", "[1, 2, 3]"),
            ("agent.density_kg_m3", "[4, 5, 6]"),
            ("agent.bend_limit_rad", "[0.1, 0.2]"),
            ("joint_damping_nms_per_rad", "[7, 8]"),
            ("max_bend_torque_nm", "[9, 10]"),
        ];
        let settings = with_fields(&Settings::default(), changes).expect("allowed");
        let mut rng = stream(1, 1, 0, Purpose::Birth);
        let genome = GenomeSpace::default().birth(Descent { joints: 2, duration_s: 1.0 }, &mut rng);
        let body = settings.trial.world_plan(&genome).body;
        let limbs: Vec<_> =
            body.limbs.iter().map(|limb| (limb.width_m, limb.density_kg_m3)).collect();
        assert_eq!(limbs, [(1.0, 4.0), (2.0, 5.0), (3.0, 6.0)]);
        let joints: Vec<_> = body
            .joints
            .iter()
            .map(|joint| {
                (joint.bend_limit_rad, joint.damping_nms_per_rad, joint.max_bend_torque_nm)
            })
            .collect();
        assert_eq!(joints, [(0.1, 7.0, 9.0), (0.2, 8.0, 10.0)]);
        assert_eq!(body.joints[0].twist_limit_rad, genome.twist_limit_rad, "the genome's own");
    }
}
