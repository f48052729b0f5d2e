//! The materials of the surfaces and of the snake's skin, and how they combine in a contact.

use crate::schema::{number, setting_group};

setting_group! {
    /// The material of the ground or the stairs: the seven parameters of the report. By default it is hard, and nothing slips or bounces
    /// on it.
    pub struct Surface {
        /// Coulomb coefficient: the largest tangential force over the normal force.
        friction: f32 = 1.0,
            // The range goes from ice without any friction to beyond the 150 of the report's engine manual.
            number("Friction", 0.0..=1000.0)
                .hint(
                    "Coefficient of friction: largest force along the surface per force onto it. 0 slides freely, 1 grips \
                     like rubber, 5 hardly slips at all",
                )
                .slider(0.0, 10.0)
                .logarithmic_from(0.01);

        /// Restitution, from 0 (no bounce) to 1 (the whole speed is kept).
        bounce: f32 = 0.0,
            // A restitution above 1 would create energy.
            number("Bounce", 0.0..=1.0)
                .hint("How much speed is kept after an impact: 0 does not bounce, 1 bounces back to full height")
                .slider(0.0, 1.0);

        /// Least incoming normal speed at which a contact bounces, in m/s. Slower impacts do not bounce.
        bounce_velocity_m_s: f32 = 0.0,
            // The range ends beyond the speed at which an agent is disqualified by default.
            number("Bounce velocity", 0.0..=1000.0).advanced()
                .unit("m/s")
                .hint("Impacts slower than this do not bounce, so that a snake at rest stays at rest")
                .slider(0.0, 10.0);

        /// Error reduction parameter: the share of a penetration that is corrected in [`ERP_TIME_S`].
        soft_erp: f32 = 0.25,
            // The range excludes 0, at which nothing would ever be pushed out again and the snake would sink through the ground.
            number("Springiness (ERP)", 0.01..=1.0).advanced()
                .hint("How quickly a soft surface springs back: share of a dent that is corrected in 1/60 s")
                .slider(0.01, 1.0);

        /// Constraint force mixing, in m/s per N (ODE's unit, s/kg): 0 is hard, larger is softer. See
        /// [`spring`] for the physical meaning.
        soft_cfm_m_s_per_n: f32 = 0.0,
            // The range ends at 1 m/s per N, at which the snake's own weight pushes it through a step in less than a second.
            number("Softness (CFM)", 0.0..=1.0)
                .unit("m/s per N")
                .hint("0 is hard; larger values let the snake sink in deeper")
                .slider(0.0, 1.0)
                .logarithmic_from(1.0e-5);

        /// Force-dependent slip, in m/s per N: under a tangential force F inside the friction cone a
        /// contact creeps at slip times F.
        slip_m_s_per_n: f32 = 0.0,
            // The range ends at 10 m/s per N, at which a limb's own weight is too much for the surface's hold.
            number("Creep (slip)", 0.0..=10.0).advanced()
                .unit("m/s per N")
                .hint("How fast a block creeps under a force that friction would otherwise hold, as on oil")
                .slider(0.0, 1.0)
                .logarithmic_from(1.0e-4);

        /// Rate at which the linear and angular velocity of a limb decay while it touches the surface, in 1/s: after a time t, the limb
        /// keeps `exp(-dampen t)` of both velocities.
        dampen_per_s: f32 = 0.0,
            // The range ends at 20 1/s, at which a limb that moves at 10 m/s comes to rest within its own length.
            number("Damping", 0.0..=20.0).advanced()
                .unit("1/s")
                .hint("Rate at which a block loses speed while it touches the surface, as in mud")
                .slider(0.0, 20.0);
    }
}

setting_group! {
    /// The material of the snake. By default it is neutral: a contact then has the parameters of the surface.
    pub struct Skin {
        /// Factor on the surface's friction.
        friction: f32 = 1.0,
            number("Skin friction", 0.0..=1000.0)
                .hint("Factor for the friction of everything that the snake touches. 1 changes nothing")
                .slider(0.0, 10.0)
                .logarithmic_from(0.01);

        /// Restitution, from 0 to 1. The larger restitution of skin and surface counts.
        bounce: f32 = 0.0,
            number("Skin bounce", 0.0..=1.0)
                .hint("How much speed is kept after an impact. The larger value of skin and surface counts")
                .slider(0.0, 1.0);

        /// Error reduction parameter, as [`Surface::soft_erp`]. It matters only where the skin is soft.
        soft_erp: f32 = 0.25,
            number("Skin springiness (ERP)", 0.01..=1.0).advanced()
                .hint("How quickly a soft skin springs back: share of a dent that is corrected in 1/60 s")
                .slider(0.01, 1.0);

        /// Constraint force mixing, in m/s per N, as [`Surface::soft_cfm_m_s_per_n`].
        soft_cfm_m_s_per_n: f32 = 0.0,
            number("Skin softness (CFM)", 0.0..=1.0)
                .unit("m/s per N")
                .hint("0 is hard; larger values make the blocks softer")
                .slider(0.0, 1.0)
                .logarithmic_from(1.0e-5);
    }
}

impl Skin {
    fn softness(&self) -> Softness {
        Softness { erp: self.soft_erp, cfm_m_s_per_n: self.soft_cfm_m_s_per_n }
    }
}

/// Softness of a material or a contact under load, in the terms of ODE.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Softness {
    /// Share of a penetration that is corrected in [`ERP_TIME_S`].
    pub erp: f32,
    /// Constraint force mixing, in m/s per N.
    pub cfm_m_s_per_n: f32,
}

/// Behaviour of a contact between a surface and a skin.
///
/// Rules of combination: frictions multiply; the larger bounce counts; two soft materials are springs in series, so their CFMs add and the
/// ERP of the softer one weighs more. Bounce velocity, slip and damping are the surface's alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ContactLaw {
    pub bounce_velocity_m_s: f32,
    pub slip_m_s_per_n: f32,
    pub dampen_per_s: f32,
    pub softness: Softness,
}

impl ContactLaw {
    /// Returns the law of contacts between a surface and the snake. The engine itself combines friction and bounce.
    pub fn between(surface: &Surface, skin: &Skin) -> Self {
        let surface_softness =
            Softness { erp: surface.soft_erp, cfm_m_s_per_n: surface.soft_cfm_m_s_per_n };
        let skin_softness = skin.softness();
        Self {
            bounce_velocity_m_s: surface.bounce_velocity_m_s,
            slip_m_s_per_n: surface.slip_m_s_per_n,
            dampen_per_s: surface.dampen_per_s,
            // A hard skin does not change a surface; on a hard surface only a soft skin counts.
            softness: if skin_softness.is_soft() {
                surface_softness.in_series_with(skin_softness)
            } else {
                surface_softness
            },
        }
    }

    /// Returns the law of contacts between two limbs of the snake.
    pub fn within(skin: &Skin) -> Self {
        Self {
            bounce_velocity_m_s: 0.0,
            slip_m_s_per_n: 0.0,
            dampen_per_s: 0.0,
            softness: skin.softness().in_series_with(skin.softness()),
        }
    }

    /// Returns whether a contact under this law must pass the contact hooks before it is solved.
    pub fn needs_hook(&self) -> bool {
        self.bounce_velocity_m_s > 0.0 || self.slip_m_s_per_n > 0.0 || self.softness.is_soft()
    }
}

impl Softness {
    /// Returns whether the contact is a spring instead of rigid.
    pub fn is_soft(self) -> bool {
        self.cfm_m_s_per_n > 0.0
    }

    /// Combines two materials pressed against each other by the same force. The stiffness of each is kp = ERP / (h · CFM), and the values
    /// of 1/kp add.
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
    /// Stiffness of the spring, in N/m.
    pub kp_n_per_m: f32,
    /// Damping of the damper, in N·s/m.
    pub kd_ns_per_m: f32,
}

/// Time in which a contact or a joint corrects the share ERP of an error, in seconds. In ODE this time is one step, so that the same
/// numbers make another material at another step rate. Here it is 1/60 s, the step with which the report's program ran, at every step
/// rate.
pub const ERP_TIME_S: f32 = 1.0 / 60.0;

/// Returns the spring and damper that ERP and CFM describe: `kp = ERP / (h · CFM)` and `kd = (1 - ERP) / CFM` with h = [`ERP_TIME_S`]
/// (Open Dynamics Engine manual, section "How to use ERP and CFM").
pub(super) fn spring(softness: Softness) -> Spring {
    Spring {
        kp_n_per_m: softness.erp / (ERP_TIME_S * softness.cfm_m_s_per_n),
        kd_ns_per_m: (1.0 - softness.erp) / softness.cfm_m_s_per_n,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_neutral_skin_does_not_change_the_surface() {
        for soft_cfm_m_s_per_n in [0.0, 0.02] {
            let surface = Surface { soft_erp: 0.7, soft_cfm_m_s_per_n, ..Default::default() };
            let law = ContactLaw::between(&surface, &Skin::default());
            assert_eq!(law.softness, Softness { erp: 0.7, cfm_m_s_per_n: soft_cfm_m_s_per_n });
        }
    }

    #[test]
    fn two_soft_materials_are_springs_in_series() {
        let skin = Skin { soft_erp: 0.2, soft_cfm_m_s_per_n: 0.01, ..Default::default() };
        let surface = Surface { soft_erp: 0.5, soft_cfm_m_s_per_n: 0.03, ..Default::default() };
        let law = ContactLaw::between(&surface, &skin);
        let kp = |erp, cfm_m_s_per_n| spring(Softness { erp, cfm_m_s_per_n }).kp_n_per_m;
        let series = 1.0 / (1.0 / kp(0.2, 0.01) + 1.0 / kp(0.5, 0.03));
        let found = spring(law.softness).kp_n_per_m;
        assert!((found / series - 1.0).abs() < 1e-5, "{found} for {series}");
    }
}
