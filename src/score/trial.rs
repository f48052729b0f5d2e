//! The conditions of an evaluation: everything that is not in the genome.

use serde::{Deserialize, Serialize};

use crate::check::{Invalid, within};
use crate::genome::{
    DENSITY_RANGE_KG_M3, Genome, JointSignals, LARGEST_GENOME_TORQUES, LARGEST_LIMIT_RAD,
    POINTS_PER_S_RANGE,
};
use crate::world::{
    BodyPlan, HealthLimits, JointPlan, LimbPlan, PhysicsSettings, Softness, Stairs, Surface,
    WorldPlan,
};

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
    /// The material of ground and stairs.
    pub surface: Surface,
    /// What is given of the snake.
    pub agent: AgentSettings,
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
            agent: AgentSettings::default(),
            health: HealthLimits::default(),
        }
    }
}

/// The parts of the snake that do not evolve.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AgentSettings {
    /// Number of limbs. The report has five.
    pub limbs: u32,
    /// Width of each limb across x, in metres.
    pub limb_width_m: f32,
    /// Length of each limb along y, in metres.
    pub limb_length_m: f32,
    /// Height of each limb, in metres.
    pub limb_height_m: f32,
    /// Largest torque on a joint's bend axis, in N·m.
    pub max_bend_torque_nm: f32,
    /// Largest torque on a joint's twist axis, in N·m.
    pub max_twist_torque_nm: f32,
    /// Torque that resists the joints' motion, in N·m·s/rad. Without it the motion is chaotic and a
    /// child lands anywhere, whatever its parent did.
    pub joint_damping_nms_per_rad: f32,
    /// How firmly the joints hold.
    pub joint_softness: Softness,
    /// Share of a limb's angular velocity lost per second, in 1/s.
    pub angular_damping_per_s: f32,
}

impl Default for AgentSettings {
    fn default() -> Self {
        Self {
            limbs: 5,
            limb_width_m: 1.0,
            limb_length_m: 2.0,
            limb_height_m: 1.0,
            max_bend_torque_nm: 1000.0,
            max_twist_torque_nm: 1000.0,
            joint_damping_nms_per_rad: 30.0,
            joint_softness: Softness::default(),
            angular_damping_per_s: 2.0,
        }
    }
}

impl AgentSettings {
    /// Checks every field against its range.
    pub fn check(&self) -> Result<(), Invalid> {
        within("limbs", self.limbs, 2..=12)?;
        within("limb_width_m", self.limb_width_m, 0.1..=10.0)?;
        within("limb_length_m", self.limb_length_m, 0.1..=10.0)?;
        within("limb_height_m", self.limb_height_m, 0.1..=10.0)?;
        within("max_bend_torque_nm", self.max_bend_torque_nm, 0.0..=1.0e6)?;
        within("max_twist_torque_nm", self.max_twist_torque_nm, 0.0..=1.0e6)?;
        within("joint_damping_nms_per_rad", self.joint_damping_nms_per_rad, 0.0..=1.0e5)?;
        self.joint_softness.check().map_err(|error| error.inside("joint_softness"))?;
        within("angular_damping_per_s", self.angular_damping_per_s, 0.0..=100.0)
    }

    /// Number of joints between the limbs.
    pub fn joints(&self) -> usize {
        self.limbs.saturating_sub(1) as usize
    }

    /// Length of the straight snake, in metres.
    pub fn length_m(&self) -> f32 {
        self.limb_length_m * self.limbs as f32
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
        let agent = &self.agent;
        let limb = LimbPlan {
            width_m: agent.limb_width_m,
            length_m: agent.limb_length_m,
            height_m: agent.limb_height_m,
            density_kg_m3: genome.density_kg_m3,
        };
        let joint = JointPlan {
            bend_limit_rad: genome.bend_limit_rad,
            twist_limit_rad: genome.twist_limit_rad,
            max_bend_torque_nm: agent.max_bend_torque_nm,
            max_twist_torque_nm: agent.max_twist_torque_nm,
            damping_nms_per_rad: agent.joint_damping_nms_per_rad,
            softness: agent.joint_softness,
        };
        WorldPlan {
            physics: self.physics.clone(),
            stairs: self.stairs.clone(),
            surface: self.surface.clone(),
            health: self.health.clone(),
            body: BodyPlan {
                limbs: vec![limb; agent.limbs as usize],
                joints: vec![joint; agent.joints()],
                angular_damping_per_s: agent.angular_damping_per_s,
            },
            start_y_m: self.start_y_m,
        }
    }

    /// What a mean or a fitness of `y_m` means, in the words of the report's Table 1.
    pub fn meaning(&self, y_m: f64) -> String {
        let length_m = f64::from(self.agent.length_m());
        self.stairs.meaning(y_m, f64::from(self.start_y_m), length_m)
    }
}
