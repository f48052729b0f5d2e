//! The sliders of the World tab: which settings they show, how they are named, how far they go.

use crate::evolve::Settings;
use crate::score::PerPart;
use crate::world::Surface;

/// A slider for one setting.
pub(super) struct Knob {
    /// The setting's name, or its last part.
    pub field: &'static str,
    pub label: &'static str,
    pub hint: &'static str,
    /// What the slider shows. More may be typed, up to what the setting allows.
    pub least: f32,
    pub most: f32,
    /// From this value up the slider goes by ratio; none: it is even.
    pub logarithmic_from: Option<f32>,
    pub is_whole: bool,
}

const fn knob(
    field: &'static str,
    label: &'static str,
    hint: &'static str,
    [least, most]: [f32; 2],
) -> Knob {
    Knob { field, label, hint, least, most, logarithmic_from: None, is_whole: false }
}

impl Knob {
    const fn by_ratio_from(mut self, value: f32) -> Self {
        self.logarithmic_from = Some(value);
        self
    }

    const fn whole(mut self) -> Self {
        self.is_whole = true;
        self
    }
}

/// A slider, and how to read what it shows.
pub(super) type Reads<T, V = f32> = (Knob, fn(&T) -> V);

/// The seven parameters of a surface.
pub(super) const SURFACE: [Reads<Surface>; 7] = [
    (
        knob(
            "friction",
            "Friction",
            "Largest tangential force over the normal force. 0 is ice without any hold",
            [0.0, 5.0],
        ),
        |surface| surface.friction,
    ),
    (
        knob("bounce", "Bounce", "Share of its speed that an impact gets back", [0.0, 1.0]),
        |surface| surface.bounce,
    ),
    (
        knob(
            "bounce_velocity_m_s",
            "Bounce velocity, m/s",
            "Impacts slower than this do not bounce",
            [0.0, 10.0],
        ),
        |surface| surface.bounce_velocity_m_s,
    ),
    (
        knob(
            "soft_erp",
            "Soft ERP",
            "Share of a penetration that is pushed out again in one step",
            [0.01, 1.0],
        ),
        |surface| surface.soft_erp,
    ),
    (
        knob(
            "soft_cfm_m_s_per_n",
            "Soft CFM, m/s per N",
            "0 is hard; the larger, the deeper the snake sinks in",
            [0.0, 1.0],
        )
        .by_ratio_from(1.0e-5),
        |surface| surface.soft_cfm_m_s_per_n,
    ),
    (
        knob(
            "slip_m_s_per_n",
            "Slip, m/s per N",
            "How fast a contact creeps under a push that friction would hold",
            [0.0, 1.0],
        )
        .by_ratio_from(1.0e-4),
        |surface| surface.slip_m_s_per_n,
    ),
    (
        knob(
            "dampen_per_s",
            "Dampen, 1/s",
            "Share of its speed that a touching limb loses per second",
            [0.0, 20.0],
        ),
        |surface| surface.dampen_per_s,
    ),
];

/// What else there is of the world.
pub(super) const STAIRS: [Reads<Settings>; 8] = [
    (knob("stairs.steps", "Steps", "Number of steps", [0.0, 20.0]).whole(), |settings| {
        settings.trial.stairs.steps as f32
    }),
    (knob("stairs.rise_m", "Rise, m", "Height of a step", [0.05, 2.0]), |settings| {
        settings.trial.stairs.rise_m
    }),
    (knob("stairs.tread_m", "Tread, m", "Depth of a step", [0.2, 5.0]), |settings| {
        settings.trial.stairs.tread_m
    }),
    (knob("stairs.width_m", "Width, m", "Width of the stairs", [1.0, 20.0]), |settings| {
        settings.trial.stairs.width_m
    }),
    (
        knob(
            "stairs.first_riser_y_m",
            "First riser at y, m",
            "Where the stairs begin",
            [0.0, 20.0],
        ),
        |settings| settings.trial.stairs.first_riser_y_m,
    ),
    (
        knob(
            "stairs.landing_m",
            "Landing, m",
            "Depth of the landing behind the last step",
            [0.0, 30.0],
        ),
        |settings| settings.trial.stairs.landing_m,
    ),
    (
        knob("gravity_m_s2", "Gravity, m/s²", "9.81 on earth, 1.62 on the moon", [0.0, 20.0]),
        |settings| settings.trial.physics.gravity_m_s2,
    ),
    (knob("trial.duration_s", "Time, s", "How long each snake has", [1.0, 30.0]), |settings| {
        settings.trial.duration_s
    }),
];

/// The snake. A setting with one value per part shows its first, and a change sets all.
pub(super) const SNAKE: [Reads<Settings>; 11] = [
    (
        knob("agent.limbs", "Limbs", "Number of blocks, each joined to the next", [2.0, 12.0])
            .whole(),
        |settings| settings.trial.agent.limbs as f32,
    ),
    (knob("agent.limb_width_m", "Width, m", "Of every block", [0.2, 3.0]), |settings| {
        settings.trial.agent.limb_width_m.at(0)
    }),
    (knob("agent.limb_length_m", "Length, m", "Of every block", [0.2, 5.0]), |settings| {
        settings.trial.agent.limb_length_m.at(0)
    }),
    (knob("agent.limb_height_m", "Height, m", "Of every block", [0.2, 3.0]), |settings| {
        settings.trial.agent.limb_height_m.at(0)
    }),
    (
        knob("max_bend_torque_nm", "Largest bend torque", "In N·m, of every joint", [0.0, 2000.0]),
        |settings| settings.trial.agent.max_bend_torque_nm.at(0),
    ),
    (
        knob("max_twist_torque_nm", "Largest twist torque", "In N·m, of every joint", [0.0, 2000.0]),
        |settings| settings.trial.agent.max_twist_torque_nm.at(0),
    ),
    (
        knob(
            "joint_damping_nms_per_rad",
            "Joint damping",
            "Torque that resists bend and twist, in N·m per rad/s. Without it the motion is chaotic",
            [0.0, 500.0],
        )
        .by_ratio_from(1.0),
        |settings| settings.trial.agent.joint_damping_nms_per_rad.at(0),
    ),
    (
        knob(
            "joint_cfm_m_s_per_n",
            "Joint CFM, m/s per N",
            "0 is rigid; the larger, the more the joints give way",
            [0.0, 0.1],
        )
        .by_ratio_from(1.0e-6),
        |settings| settings.trial.agent.joint_cfm_m_s_per_n.at(0),
    ),
    (
        knob(
            "angular_damping_per_s",
            "Angular damping, 1/s",
            "Share of its spin that a block loses per second, as in thick air",
            [0.0, 100.0],
        ),
        |settings| settings.trial.agent.angular_damping_per_s,
    ),
    (
        knob(
            "skin.friction",
            "Skin friction",
            "Multiplies the friction of what the snake touches",
            [0.0, 5.0],
        ),
        |settings| settings.trial.agent.skin.friction,
    ),
    (
        knob(
            "skin.soft_cfm_m_s_per_n",
            "Skin CFM, m/s per N",
            "0 is hard; the larger, the squishier the blocks",
            [0.0, 1.0],
        )
        .by_ratio_from(1.0e-5),
        |settings| settings.trial.agent.skin.soft_cfm_m_s_per_n,
    ),
];

/// Reads a limit.
pub(super) type Limit = fn(&Settings) -> &Option<PerPart>;

/// The limits of the joints, if they are given instead of each genome's own.
pub(super) const LIMITS: [(Knob, Limit); 2] = [
    (
        knob("agent.bend_limit_rad", "Bend limit, rad", "Largest bend of every joint", [0.0, 3.0]),
        |settings| &settings.trial.agent.bend_limit_rad,
    ),
    (
        knob(
            "agent.twist_limit_rad",
            "Twist limit, rad",
            "Largest twist of every joint",
            [0.0, 3.0],
        ),
        |settings| &settings.trial.agent.twist_limit_rad,
    ),
];
