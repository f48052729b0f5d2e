//! Settings of the physics engine: the constant step, the solver's substeps, gravity.

use std::ops::RangeInclusive;

use super::Vector;
use crate::schema::{
    Section, SettingGroup, Walk, choice, choices, is_default, number, setting_group, settings,
    whole,
};

/// Allowed numbers of physics steps per second. Below 20, bodies pass through each other; above 1000, the motion hardly changes.
pub const STEP_RATES_HZ: RangeInclusive<u32> = 20..=1000;

choices! {
    /// The program that computes the motion: rapier or *lanes*.
    #[derive(Default)]
    pub enum PhysicsEngine {
        #[default]
        Rapier = "rapier", "rapier",
            "The general engine rapier. Its bits differ between processors of different kinds.";
        Lanes = "lanes", "lanes",
            "Many snakes side by side, one per lane of the processor's vectors: several times as fast, and with the same \
             bits on every processor.";
    }
}

impl PhysicsEngine {
    /// Returns the other of the two engines.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Rapier => Self::Lanes,
            Self::Lanes => Self::Rapier,
        }
    }
}

setting_group! {
    /// Settings of the physics engine. They belong to the trial, because they change the bits of its results.
    pub struct PhysicsSettings {
        /// The engine that computes the motion.
        #[serde(default, skip_serializing_if = "is_default")]
        engine: PhysicsEngine = PhysicsEngine::Rapier;
        /// Number of physics steps per simulated second, in Hz. Every step has the same length.
        steps_per_s: u32 = 60;
        /// Number of solver substeps within one step.
        substeps: u32 = 2;
        /// Solver iterations within one substep. Engine version 2 had one.
        #[serde(default = "one_iteration")]
        iterations: u32 = 4;
        /// Downward acceleration, in m/s².
        gravity_m_s2: f32 = 9.81;
    }
}

impl SettingGroup for PhysicsSettings {
    fn walk(&mut self, walk: &mut Walk<'_>) {
        let Self { engine, steps_per_s, substeps, iterations, gravity_m_s2 } = self;
        walk.section(Section { title: "Physics", about: "Gravity and time step." });
        settings! { walk,
            // The range goes from weightlessness to four times Jupiter's gravity.
            gravity_m_s2: number("Gravity", 0.0..=100.0)
                .unit("m/s²")
                .hint("Acceleration of free fall: 9.81 on Earth, 1.62 on the Moon")
                .slider(0.0, 20.0);
            engine: choice("Physics engine").advanced()
                .hint("The program that computes the motion. Motions differ a little at first, and a champion of one may fall in the other");
            steps_per_s: whole("Physics steps per second", STEP_RATES_HZ).advanced()
                .hint("More steps are more accurate but take longer. A different number changes all motions")
                .slider(20.0, 240.0);
            substeps: whole("Substeps per step", 1..=32).advanced()
                .hint(
                    "How often contacts and joints are solved within a step. More substeps make them stiffer \
                     but take longer",
                )
                .slider(1.0, 16.0);
            iterations: whole("Iterations per substep", 1..=32).advanced()
                .hint(
                    "How often all contacts and joints are solved within a substep. More iterations hold the joints \
                     better and cost less than more substeps",
                )
                .slider(1.0, 16.0);
        }
    }
}

/// Returns the number of iterations for files that do not state it.
fn one_iteration() -> u32 {
    1
}

/// Step rates, in Hz, with the substeps, at which the motion is tested against every closed formula.
#[cfg(test)]
pub const TESTED_RATES: [(u32, u32); 7] =
    [(60, 4), (120, 4), (240, 4), (60, 2), (60, 8), (120, 2), (240, 2)];

impl PhysicsSettings {
    /// Returns the length of one physics step, in seconds.
    pub fn step_s(&self) -> f32 {
        1.0 / self.steps_per_s as f32
    }

    /// Returns the share of the joints' damping that the solver integrates, implicitly, in each of n substeps: `n / (n + 1)`. The rest of
    /// the damping acts as a torque that is constant over a step.
    ///
    /// Implicit integration alone damps too little, by half of `damping · substep / inertia`. With these shares a rate
    /// decays in one step by `1 - x + x²/2 - ...` for `x = damping · step / inertia`, which agrees with `exp(-x)` to second
    /// order, and a constant torque has its exact final rate.
    pub(super) fn joint_damping_in_solver(&self) -> f32 {
        let substeps = self.substeps.max(1) as f32;
        substeps / (substeps + 1.0)
    }

    /// Returns the acceleration of free fall, in m/s².
    pub fn gravity(&self) -> Vector {
        Vector::new(0.0, 0.0, -self.gravity_m_s2)
    }

    /// Returns the length of one substep, in seconds.
    pub fn substep_s(&self) -> f32 {
        self.step_s() / self.substeps.max(1) as f32
    }
}
