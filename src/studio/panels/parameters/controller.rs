//! What drives the joints, and what a genome may be.

use super::entry::{Choice, Section, choice, list, number};
use crate::genome::ControllerKind;

/// Which kind of controller.
pub const CONTROLLER: Section = Section {
    title: "Controller",
    about: "What turns genes into torques.",
    prefix: "genome.",
    entries: &[choice("controller", "Controller", "What drives the joints", controllers)],
};

/// Free signals.
pub const SIGNALS: Section = Section {
    title: "Torques",
    about: "The range of all torques, and how newborn signals wander in it.",
    prefix: "genome.",
    entries: &[
        number(
            "torque_range_nm",
            "Torque range",
            "N·m",
            "Torques of signals and waves stay within plus and minus this",
            [0.001, 1.0e6],
        )
        .slider(1.0, 2000.0),
        number(
            "torque_step_nm",
            "Torque step",
            "N·m",
            "From one point of a newborn signal to the next it changes by at most this",
            [0.0, 1.0e6],
        )
        .slider(0.0, 2000.0),
        number(
            "points_per_s",
            "Points per second",
            "",
            "How often a signal's torque changes. One to three a second move a snake, many cancel out",
            [0.1, 1000.0],
        )
        .slider(0.5, 60.0)
        .by_ratio_from(0.5),
    ],
};

/// Waves and gaits.
pub const WAVES: Section = Section {
    title: "Waves and gaits",
    about: "The ranges of motions that repeat.",
    prefix: "genome.wave.",
    entries: &[
        number(
            "frequency_min_hz",
            "Least frequency",
            "Hz",
            "The slowest motion that a snake may be born with",
            [0.01, 20.0],
        )
        .slider(0.05, 5.0)
        .by_ratio_from(0.05),
        number(
            "frequency_max_hz",
            "Greatest frequency",
            "Hz",
            "The quickest motion that a snake may be born with",
            [0.01, 20.0],
        )
        .slider(0.05, 10.0)
        .by_ratio_from(0.05),
        number(
            "harmonics",
            "Terms of a wave",
            "",
            "1 is a plain sine; more make richer motions and more genes",
            [1.0, 5.0],
        )
        .slider(1.0, 5.0)
        .whole(),
        number(
            "angle_range_rad",
            "Angle range",
            "rad",
            "How far a gait may swing a joint, and shift the middle of its swing",
            [0.0, 3.0],
        )
        .slider(0.0, 3.0),
        number(
            "stiffness_min_nm_per_rad",
            "Least stiffness",
            "N·m/rad",
            "The softest servo that a snake may be born with: it gives way to what it touches",
            [0.0, 1.0e5],
        )
        .slider(0.0, 5000.0)
        .by_ratio_from(1.0),
        number(
            "stiffness_max_nm_per_rad",
            "Greatest stiffness",
            "N·m/rad",
            "The stiffest servo that a snake may be born with: it holds its angles",
            [0.0, 1.0e5],
        )
        .slider(0.0, 5000.0)
        .by_ratio_from(1.0),
        number(
            "servo_damping_nms_per_rad",
            "Servo damping",
            "N·m·s/rad",
            "How much the servo itself resists quick turns, on top of the joints' own damping",
            [0.0, 1.0e4],
        )
        .slider(0.0, 200.0)
        .by_ratio_from(1.0),
    ],
};

/// What newborns draw from.
pub const NEWBORNS: Section = Section {
    title: "Newborns",
    about: "What each snake's own limits and density are drawn from, where they are not given.",
    prefix: "genome.",
    entries: &[
        list(
            "bend_limits_rad",
            "Bend limits to choose from",
            "rad",
            "Each snake is born with one of these. A list with one number gives all the same",
            [0.0, 3.0],
        ),
        list(
            "twist_limits_rad",
            "Twist limits to choose from",
            "rad",
            "Each snake is born with one of these. 0 holds the joint's twist fast",
            [0.0, 3.0],
        ),
        number(
            "density_min_kg_m3",
            "Least density",
            "kg/m³",
            "The lightest material that a snake may be born with",
            [0.1, 20_000.0],
        )
        .slider(0.1, 50.0)
        .by_ratio_from(0.1),
        number(
            "density_max_kg_m3",
            "Greatest density",
            "kg/m³",
            "The heaviest material that a snake may be born with",
            [0.1, 20_000.0],
        )
        .slider(0.1, 50.0)
        .by_ratio_from(0.1),
    ],
};

/// The sections below the choice of a controller.
pub const GENOME: [&Section; 3] = [&SIGNALS, &WAVES, &NEWBORNS];

/// Whether a kind of controller has anything to do with a section.
pub fn concerns(controller: ControllerKind, section: &Section) -> bool {
    if section.title == SIGNALS.title {
        controller != ControllerKind::Gait
    } else if section.title == WAVES.title {
        controller != ControllerKind::Signal
    } else {
        true
    }
}

fn controllers() -> Vec<Choice> {
    let title = |kind| match kind {
        ControllerKind::Signal => "Signal",
        ControllerKind::Wave => "Wave",
        ControllerKind::Gait => "Gait",
    };
    ControllerKind::ALL.map(|kind| Choice::new(kind.name(), title(kind), sentence(kind))).to_vec()
}

/// What a controller is, as a sentence.
fn sentence(kind: ControllerKind) -> String {
    let mut letters = kind.words().chars();
    let first = letters.next().map(|letter| letter.to_uppercase().to_string());
    format!("{}{}.", first.unwrap_or_default(), letters.as_str())
}
