//! What the snake crawls on, and its own skin.

use super::entry::{Entry, Section, number};

/// The material of the stairs, and of the ground if that has none of its own.
pub const SURFACE: Section = Section {
    title: "Surface",
    about: "What the stairs are made of, and the ground too if it has no surface of its own.",
    prefix: "trial.surface.",
    entries: &MATERIAL,
};

/// The material of the ground, if it differs.
pub const GROUND: Section = Section {
    title: "Ground",
    about: "What the ground before the stairs is made of.",
    prefix: "trial.ground.",
    entries: &MATERIAL,
};

/// The material of the limbs.
pub const SKIN: Section = Section {
    title: "Skin",
    about: "What the snake itself is made of, where it touches something.",
    prefix: "trial.agent.skin.",
    entries: &[
        number(
            "friction",
            "Skin friction",
            "",
            "Multiplies the friction of whatever the snake touches. 1 leaves it as it is",
            [0.0, 1000.0],
        )
        .slider(0.0, 5.0),
        number(
            "bounce",
            "Skin bounce",
            "",
            "Share of its speed that an impact gives back. The bouncier of skin and surface counts",
            [0.0, 1.0],
        )
        .slider(0.0, 1.0),
        number(
            "soft_erp",
            "Skin soft ERP",
            "",
            "How quickly a soft skin springs back: the share of a dent that is pushed out in one step",
            [0.01, 1.0],
        )
        .slider(0.01, 1.0),
        number(
            "soft_cfm_m_s_per_n",
            "Skin soft CFM",
            "m/s per N",
            "0 is hard; the larger, the squishier the blocks",
            [0.0, 1.0],
        )
        .slider(0.0, 1.0)
        .by_ratio_from(1.0e-5),
    ],
};

const MATERIAL: [Entry; 7] = [
    number(
        "friction",
        "Friction",
        "",
        "Largest sideways force over the force that presses. 0 is ice without any hold",
        [0.0, 1000.0],
    )
    .slider(0.0, 5.0),
    number(
        "bounce",
        "Bounce",
        "",
        "Share of its speed that an impact gives back: 0 falls dead, 1 jumps as high as it fell",
        [0.0, 1.0],
    )
    .slider(0.0, 1.0),
    number(
        "bounce_velocity_m_s",
        "Bounce velocity",
        "m/s",
        "Impacts slower than this do not bounce, so that a snake at rest stays at rest",
        [0.0, 1000.0],
    )
    .slider(0.0, 10.0),
    number(
        "soft_erp",
        "Soft ERP",
        "",
        "How quickly a soft surface springs back: the share of a dent that is pushed out in one step",
        [0.01, 1.0],
    )
    .slider(0.01, 1.0),
    number(
        "soft_cfm_m_s_per_n",
        "Soft CFM",
        "m/s per N",
        "0 is hard; the larger, the deeper the snake sinks in",
        [0.0, 1.0],
    )
    .slider(0.0, 1.0)
    .by_ratio_from(1.0e-5),
    number(
        "slip_m_s_per_n",
        "Slip",
        "m/s per N",
        "How fast a limb creeps under a push that friction would hold, as on oil",
        [0.0, 10.0],
    )
    .slider(0.0, 1.0)
    .by_ratio_from(1.0e-4),
    number(
        "dampen_per_s",
        "Dampen",
        "1/s",
        "Share of its speed that a limb loses per second while it touches, as in mud",
        [0.0, 20.0],
    )
    .slider(0.0, 20.0),
];
