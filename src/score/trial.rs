//! The conditions of an evaluation: everything that is not in the genome.

use serde::{Deserialize, Serialize};

use super::{AgentSettings, Fitness};
use crate::check::{Invalid, within};
use crate::genome::{
    DENSITY_RANGE_KG_M3, Genome, JointSignals, LARGEST_GENOME_TORQUES, LARGEST_LIMIT_RAD,
    POINTS_PER_S_RANGE,
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
            health: HealthLimits::default(),
        }
    }
}

impl Trial {
    /// Checks every field against its range.
    pub fn check(&self) -> Result<(), Invalid> {
        within("duration_s", self.duration_s, 0.1..=600.0)?;
        within("start_y_m", self.start_y_m, -100.0..=100.0)?;
        self.physics.check().map_err(|error| error.inside("physics"))?;
        self.stairs.check().map_err(|error| error.inside("stairs"))?;
        self.surface.check().map_err(|error| error.inside("surface"))?;
        if let Some(ground) = &self.ground {
            ground.check().map_err(|error| error.inside("ground"))?;
        }
        self.agent.check().map_err(|error| error.inside("agent"))?;
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
        within("signals.points_per_s", genome.signals.points_per_s, POINTS_PER_S_RANGE)?;
        let (joints, expected) = (genome.signals.joints.len(), self.agent.joints());
        if joints != expected {
            let allowed = format!("{expected}, one per joint of {} limbs", self.agent.limbs);
            return Err(Invalid::new("signals.joints", format!("{joints} joints"), allowed));
        }
        let points = |joint: &JointSignals| joint.bend_nm.len() + joint.twist_nm.len();
        let torques: usize = genome.signals.joints.iter().map(points).sum();
        within("signals torque points", torques, 1..=LARGEST_GENOME_TORQUES)?;
        for (index, joint) in genome.signals.joints.iter().enumerate() {
            for (axis, signal) in [("bend_nm", &joint.bend_nm), ("twist_nm", &joint.twist_nm)] {
                let field = format!("signals.joints[{index}].{axis}");
                if signal.is_empty() {
                    return Err(Invalid::new(field, "empty", "at least one point"));
                }
                signal.iter().try_for_each(|&torque| within(&field, torque, -1.0e6..=1.0e6))?;
            }
        }
        Ok(())
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
        }
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
