//! The stairs, the time a snake has, the physics, and when a snake is disqualified.

use super::entry::{Section, number};

/// The staircase.
pub const STAIRS: Section = Section {
    title: "Stairs",
    about: "The shape of the staircase, and where it begins.",
    prefix: "trial.stairs.",
    entries: &[
        number(
            "steps",
            "Steps",
            "",
            "Number of steps. Without any there is flat ground",
            [0.0, 100.0],
        )
        .slider(0.0, 20.0)
        .whole(),
        number("rise_m", "Rise", "m", "Height of a step. Higher is harder", [0.01, 5.0])
            .slider(0.05, 2.0),
        number(
            "tread_m",
            "Tread",
            "m",
            "Depth of a step. On a deep one there is room to gather",
            [0.1, 20.0],
        )
        .slider(0.2, 5.0),
        number(
            "width_m",
            "Width",
            "m",
            "Width of the stairs. From narrow ones a snake that drifts falls off",
            [1.0, 100.0],
        )
        .slider(1.0, 20.0),
        number(
            "first_riser_y_m",
            "First riser at y",
            "m",
            "Where the stairs begin. The further away, the longer the way to them",
            [-100.0, 100.0],
        )
        .slider(0.0, 20.0),
        number(
            "landing_m",
            "Landing",
            "m",
            "Depth of the landing behind the last step, on which a snake that has climbed stands",
            [0.0, 100.0],
        )
        .slider(0.0, 60.0),
    ],
};

/// How long a trial lasts and where it begins.
pub const TIME: Section = Section {
    title: "Time and start",
    about: "How long each snake has, and where it begins.",
    prefix: "trial.",
    entries: &[
        number(
            "duration_s",
            "Time",
            "s",
            "How long each snake has. Longer trials take longer to evaluate",
            [0.1, 600.0],
        )
        .slider(1.0, 30.0),
        number(
            "start_y_m",
            "Start at y",
            "m",
            "Where the snake's middle stands at first; the stairs are in the direction of larger y",
            [-100.0, 100.0],
        )
        .slider(-20.0, 10.0),
    ],
};

/// The engine.
pub const PHYSICS: Section = Section {
    title: "Physics",
    about: "Gravity, and how finely time is cut.",
    prefix: "trial.physics.",
    entries: &[
        number(
            "gravity_m_s2",
            "Gravity",
            "m/s²",
            "How strongly everything is pulled down: 9.81 on earth, 1.62 on the moon",
            [0.0, 100.0],
        )
        .slider(0.0, 20.0),
        number(
            "steps_per_s",
            "Physics steps per second",
            "",
            "More are more exact and take longer. Other numbers make other motions",
            [20.0, 1000.0],
        )
        .slider(20.0, 240.0)
        .whole(),
        number(
            "substeps",
            "Substeps in a step",
            "",
            "How often contacts and joints are solved within a step. More are stiffer and take longer",
            [1.0, 32.0],
        )
        .slider(1.0, 16.0)
        .whole(),
    ],
};

/// When a snake is taken out.
pub const HEALTH: Section = Section {
    title: "Disqualification",
    about: "A snake that breaks the physics instead of climbing is taken out.",
    prefix: "trial.health.",
    entries: &[
        number(
            "joint_drift_m",
            "Joint gap",
            "m",
            "A snake whose joint comes apart further than this is disqualified",
            [0.001, 10.0],
        )
        .slider(0.01, 1.0)
        .by_ratio_from(0.01),
        number(
            "speed_m_s",
            "Speed limit",
            "m/s",
            "A snake with a limb faster than this is disqualified: only an explosion is that fast",
            [1.0, 1000.0],
        )
        .slider(1.0, 100.0),
        number(
            "arena_half_width_m",
            "Arena to either side",
            "m",
            "A snake that is further off the middle is disqualified",
            [1.0, 1000.0],
        )
        .slider(2.0, 50.0),
        number(
            "arena_back_m",
            "Arena backwards",
            "m",
            "A snake with a limb behind minus this y is disqualified",
            [1.0, 1000.0],
        )
        .slider(5.0, 100.0),
    ],
};
