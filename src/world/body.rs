//! The snake as a physical plan: a row of box limbs with universal joints between neighbours.
//!
//! A plan holds plain numbers. What of them evolves is decided in `genome`, what a person sets in
//! the trial's agent settings; the world only builds what the plan says.

use crate::check::{Invalid, within};

/// The whole body. Limb 0 is the head: the foremost limb, nearest to the stairs.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyPlan {
    /// The limbs from head to tail.
    pub limbs: Vec<LimbPlan>,
    /// The joints; `joints[i]` holds limb `i` and limb `i + 1` together.
    pub joints: Vec<JointPlan>,
    /// Share of a limb's angular velocity lost per second to the air, in 1/s.
    pub angular_damping_per_s: f32,
}

/// One box-shaped limb.
#[derive(Debug, Clone, PartialEq)]
pub struct LimbPlan {
    /// Size across x, in metres.
    pub width_m: f32,
    /// Size along y, in metres.
    pub length_m: f32,
    /// Size along z, in metres.
    pub height_m: f32,
    /// Density, in kg/m³; with the size it gives the mass.
    pub density_kg_m3: f32,
}

/// One universal joint: bend about the front limb's x axis (snapping a stick), twist about its y
/// axis (wringing a sponge), no other relative motion.
#[derive(Debug, Clone, PartialEq)]
pub struct JointPlan {
    /// Largest bend to either side, in radians.
    pub bend_limit_rad: f32,
    /// Largest twist to either side, in radians.
    pub twist_limit_rad: f32,
    /// Largest torque on the bend axis, in N·m. A stronger command is clamped.
    pub max_bend_torque_nm: f32,
    /// Largest torque on the twist axis, in N·m. A stronger command is clamped.
    pub max_twist_torque_nm: f32,
    /// Torque that resists bend and twist, per joint rate, in N·m·s/rad. Integrated implicitly by
    /// the solver, so that large values stay stable.
    pub damping_nms_per_rad: f32,
    /// How firmly the joint holds its anchors, its locked axis and its limits.
    pub softness: Softness,
}

/// A constraint as a damped spring.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Softness {
    /// Natural frequency, in Hz: larger is harder.
    pub frequency_hz: f32,
    /// Damping ratio: 1 is critical.
    pub damping_ratio: f32,
}

impl Default for Softness {
    /// Practically rigid: rapier's own default for joints.
    fn default() -> Self {
        Self { frequency_hz: 1.0e6, damping_ratio: 1.0 }
    }
}

impl Softness {
    /// Checks both numbers against their ranges.
    pub fn check(&self) -> Result<(), Invalid> {
        within("frequency_hz", self.frequency_hz, 0.1..=1.0e6)?;
        within("damping_ratio", self.damping_ratio, 0.01..=100.0)
    }
}

impl BodyPlan {
    /// Length of the straight body from head to tail, in metres.
    pub fn length_m(&self) -> f32 {
        self.limbs.iter().map(|limb| limb.length_m).sum()
    }

    /// Which limb is the middle one: the third of five. Its centre is "the centre of the snake".
    pub fn middle_limb(&self) -> usize {
        self.limbs.len() / 2
    }
}
