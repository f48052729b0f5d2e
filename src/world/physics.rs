//! Settings of the physics engine: the constant step, the solver's substeps, gravity.

use serde::{Deserialize, Serialize};

use crate::schema::{Section, SettingGroup, Walk, number, whole};

/// Settings of the physics engine. They belong to the trial, because they change the bits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PhysicsSettings {
    /// Physics steps per simulated second, in Hz. Every step has the same length.
    pub steps_per_s: u32,
    /// Solver substeps within one step.
    pub substeps: u32,
    /// Downward acceleration, in m/s².
    pub gravity_m_s2: f32,
}

impl Default for PhysicsSettings {
    fn default() -> Self {
        Self { steps_per_s: 60, substeps: 4, gravity_m_s2: 9.81 }
    }
}

impl SettingGroup for PhysicsSettings {
    fn walk(&mut self, walk: &mut Walk<'_>) {
        let Self { steps_per_s, substeps, gravity_m_s2 } = self;
        walk.section(Self::SECTION);
        // From weightlessness to four times Jupiter.
        walk.setting(
            number("gravity_m_s2", "Gravity", 0.0..=100.0)
                .unit("m/s²")
                .hint("Acceleration of free fall: 9.81 on Earth, 1.62 on the Moon")
                .slider(0.0, 20.0),
            gravity_m_s2,
        );
        // Below 20 a second bodies pass through each other; above 1000 nothing changes.
        walk.setting(
            whole("steps_per_s", "Physics steps per second", 20..=1000)
                .hint("More steps are more accurate but take longer. A different number changes all motions")
                .slider(20.0, 240.0),
            steps_per_s,
        );
        walk.setting(
            whole("substeps", "Substeps per step", 1..=32)
                .hint("How often contacts and joints are solved within a step. More are stiffer but take longer")
                .slider(1.0, 16.0),
            substeps,
        );
    }
}

impl PhysicsSettings {
    /// The section of these settings.
    pub const SECTION: Section = Section { title: "Physics", about: "Gravity and time step." };

    /// Length of one physics step, in seconds.
    pub fn step_s(&self) -> f32 {
        1.0 / self.steps_per_s as f32
    }
}
