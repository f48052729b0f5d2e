//! What the snake crawls on, what its skin is like, and how the two meet.

use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

use crate::check::{Invalid, within};

/// The material of the ground or the stairs: the seven parameters of the report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Surface {
    /// Coulomb coefficient: the largest tangential force over the normal force.
    pub friction: f32,
    /// Restitution, from 0 (no bounce) to 1 (all of the speed comes back).
    pub bounce: f32,
    /// Least incoming normal speed for a bounce, in m/s. Slower impacts do not bounce.
    pub bounce_velocity_m_s: f32,
    /// Error reduction parameter: the share of a penetration that is corrected in one physics step.
    pub soft_erp: f32,
    /// Constraint force mixing, in m/s per N (ODE's unit, s/kg): 0 is hard, larger is softer. See
    /// [`spring`] for what it means physically.
    pub soft_cfm_m_s_per_n: f32,
    /// Force-dependent slip, in m/s per N: under a tangential force F inside the friction cone a
    /// contact creeps at slip times F.
    pub slip_m_s_per_n: f32,
    /// While a limb touches the surface, its linear and angular velocity lose this share per second,
    /// in 1/s: a factor of 1 - dampen · step in each step.
    pub dampen_per_s: f32,
}

impl Default for Surface {
    /// Hard ground on which nothing slips or bounces.
    fn default() -> Self {
        Self {
            friction: 1.0,
            bounce: 0.0,
            bounce_velocity_m_s: 0.0,
            soft_erp: 0.25,
            soft_cfm_m_s_per_n: 0.0,
            slip_m_s_per_n: 0.0,
            dampen_per_s: 0.0,
        }
    }
}

/// From ice without any friction to beyond the 150 of the report's engine manual.
pub const FRICTION_RANGE: RangeInclusive<f32> = 0.0..=1000.0;
/// More than 1 would create energy.
pub const BOUNCE_RANGE: RangeInclusive<f32> = 0.0..=1.0;
/// Up to the speed at which an agent is disqualified by default, and beyond.
pub const BOUNCE_VELOCITY_RANGE: RangeInclusive<f32> = 0.0..=1000.0;
/// At 0 nothing would ever be pushed out again and the snake would sink through the ground.
pub const SOFT_ERP_RANGE: RangeInclusive<f32> = 0.01..=1.0;
/// At 1 m/s per N the snake's own weight pushes it through a step in less than a second.
pub const SOFT_CFM_RANGE: RangeInclusive<f32> = 0.0..=1.0;
/// At 10 m/s per N a surface does not hold anything that a limb's weight could feel.
pub const SLIP_RANGE: RangeInclusive<f32> = 0.0..=10.0;
/// At 20 1/s and the longest step (1/20 s) everything stops at once; more would turn it around.
pub const DAMPEN_RANGE: RangeInclusive<f32> = 0.0..=20.0;

impl Surface {
    /// Checks every field against its range.
    pub fn check(&self) -> Result<(), Invalid> {
        within("friction", self.friction, FRICTION_RANGE)?;
        within("bounce", self.bounce, BOUNCE_RANGE)?;
        within("bounce_velocity_m_s", self.bounce_velocity_m_s, BOUNCE_VELOCITY_RANGE)?;
        within("soft_erp", self.soft_erp, SOFT_ERP_RANGE)?;
        within("soft_cfm_m_s_per_n", self.soft_cfm_m_s_per_n, SOFT_CFM_RANGE)?;
        within("slip_m_s_per_n", self.slip_m_s_per_n, SLIP_RANGE)?;
        within("dampen_per_s", self.dampen_per_s, DAMPEN_RANGE)
    }
}

/// The snake's own material. The default is neutral: with it, a surface's numbers are the contact's.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Skin {
    /// Multiplies the surface's friction.
    pub friction: f32,
    /// Restitution, from 0 to 1.
    pub bounce: f32,
    /// Error reduction parameter, as [`Surface::soft_erp`]. Matters where the skin is soft.
    pub soft_erp: f32,
    /// Constraint force mixing, in m/s per N, as [`Surface::soft_cfm_m_s_per_n`].
    pub soft_cfm_m_s_per_n: f32,
}

impl Default for Skin {
    fn default() -> Self {
        Self { friction: 1.0, bounce: 0.0, soft_erp: 0.25, soft_cfm_m_s_per_n: 0.0 }
    }
}

impl Skin {
    /// Checks every field against its range.
    pub fn check(&self) -> Result<(), Invalid> {
        within("friction", self.friction, FRICTION_RANGE)?;
        within("bounce", self.bounce, BOUNCE_RANGE)?;
        within("soft_erp", self.soft_erp, SOFT_ERP_RANGE)?;
        within("soft_cfm_m_s_per_n", self.soft_cfm_m_s_per_n, SOFT_CFM_RANGE)
    }

    fn give(&self) -> Give {
        Give { erp: self.soft_erp, cfm_m_s_per_n: self.soft_cfm_m_s_per_n }
    }
}

/// How much a contact gives way under load, as ODE says it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Give {
    /// Share of the penetration that is corrected in one step.
    pub erp: f32,
    /// Constraint force mixing, in m/s per N.
    pub cfm_m_s_per_n: f32,
}

/// What happens where a surface and a skin touch.
///
/// The combine rules: the frictions multiply; of the bounces the larger counts; two soft materials are
/// springs in series, so their CFMs add and the softer one's ERP weighs more. Bounce velocity, slip
/// and dampen are the surface's alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ContactLaw {
    pub bounce_velocity_m_s: f32,
    pub slip_m_s_per_n: f32,
    pub dampen_per_s: f32,
    pub give: Give,
}

impl ContactLaw {
    /// Between a surface and the snake. Friction and bounce are combined by the engine itself.
    pub fn between(surface: &Surface, skin: &Skin) -> Self {
        let surface_gives =
            Give { erp: surface.soft_erp, cfm_m_s_per_n: surface.soft_cfm_m_s_per_n };
        let skin_gives = skin.give();
        Self {
            bounce_velocity_m_s: surface.bounce_velocity_m_s,
            slip_m_s_per_n: surface.slip_m_s_per_n,
            dampen_per_s: surface.dampen_per_s,
            // A hard skin leaves a surface as it is; a soft one is all there is on a hard surface.
            give: if skin_gives.is_soft() {
                surface_gives.in_series_with(skin_gives)
            } else {
                surface_gives
            },
        }
    }

    /// Between two limbs of the snake.
    pub fn within(skin: &Skin) -> Self {
        Self {
            bounce_velocity_m_s: 0.0,
            slip_m_s_per_n: 0.0,
            dampen_per_s: 0.0,
            give: skin.give().in_series_with(skin.give()),
        }
    }

    /// Whether a contact under this law has to be looked at before it is solved.
    pub fn needs_hook(&self) -> bool {
        self.bounce_velocity_m_s > 0.0 || self.slip_m_s_per_n > 0.0 || self.give.is_soft()
    }
}

impl Give {
    /// Whether the contact is a spring instead of a wall.
    pub fn is_soft(self) -> bool {
        self.cfm_m_s_per_n > 0.0
    }

    /// Two materials pressed against each other by the same force: with the stiffness kp = ERP / (h ·
    /// CFM) of each, 1/kp adds.
    fn in_series_with(self, other: Self) -> Self {
        let cfm_m_s_per_n = self.cfm_m_s_per_n + other.cfm_m_s_per_n;
        let erp = if cfm_m_s_per_n > 0.0 {
            cfm_m_s_per_n / (self.cfm_m_s_per_n / self.erp + other.cfm_m_s_per_n / other.erp)
        } else {
            self.erp
        };
        Self { erp, cfm_m_s_per_n }
    }
}

/// A constraint as a spring and a damper side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spring {
    /// Stiffness, in N/m.
    pub kp_n_per_m: f32,
    /// Damping, in N·s/m.
    pub kd_ns_per_m: f32,
}

/// What ERP and CFM are physically, for a physics step of `step_s`: `kp = ERP / (h · CFM)` and
/// `kd = (1 - ERP) / CFM` (Open Dynamics Engine manual, section "How to use ERP and CFM").
pub(super) fn spring(give: Give, step_s: f32) -> Spring {
    Spring {
        kp_n_per_m: give.erp / (step_s * give.cfm_m_s_per_n),
        kd_ns_per_m: (1.0 - give.erp) / give.cfm_m_s_per_n,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_neutral_skin_leaves_the_surface_as_it_is() {
        for soft_cfm_m_s_per_n in [0.0, 0.02] {
            let surface = Surface { soft_erp: 0.7, soft_cfm_m_s_per_n, ..Default::default() };
            let law = ContactLaw::between(&surface, &Skin::default());
            assert_eq!(law.give, Give { erp: 0.7, cfm_m_s_per_n: soft_cfm_m_s_per_n });
        }
    }

    #[test]
    fn two_soft_materials_are_springs_in_series() {
        let skin = Skin { soft_erp: 0.2, soft_cfm_m_s_per_n: 0.01, ..Default::default() };
        let surface = Surface { soft_erp: 0.5, soft_cfm_m_s_per_n: 0.03, ..Default::default() };
        let law = ContactLaw::between(&surface, &skin);
        let kp = |erp, cfm_m_s_per_n| spring(Give { erp, cfm_m_s_per_n }, 1.0 / 60.0).kp_n_per_m;
        let series = 1.0 / (1.0 / kp(0.2, 0.01) + 1.0 / kp(0.5, 0.03));
        let found = spring(law.give, 1.0 / 60.0).kp_n_per_m;
        assert!((found / series - 1.0).abs() < 1e-5, "{found} for {series}");
    }

    #[test]
    fn each_field_has_a_range_that_is_named() {
        let broken = |change: fn(&mut Surface)| {
            let mut surface = Surface::default();
            change(&mut surface);
            surface.check().unwrap_err().to_string()
        };
        for (message, expected) in [
            (broken(|s| s.friction = -1.0), "friction is -1; allowed: 0 to 1000"),
            (broken(|s| s.bounce = 1.5), "bounce is 1.5; allowed: 0 to 1"),
            (
                broken(|s| s.bounce_velocity_m_s = f32::NAN),
                "bounce_velocity_m_s is NaN; allowed: 0 to 1000",
            ),
            (broken(|s| s.soft_erp = 0.0), "soft_erp is 0; allowed: 0.01 to 1"),
            (broken(|s| s.soft_cfm_m_s_per_n = 2.0), "soft_cfm_m_s_per_n is 2; allowed: 0 to 1"),
            (broken(|s| s.slip_m_s_per_n = -0.1), "slip_m_s_per_n is -0.1; allowed: 0 to 10"),
            (broken(|s| s.dampen_per_s = 30.0), "dampen_per_s is 30; allowed: 0 to 20"),
        ] {
            assert_eq!(message, expected);
        }
    }
}
