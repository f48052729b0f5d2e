//! What is rewarded, what energy costs, and trials that are repeated a little otherwise.

use super::entry::{Choice, Section, choice, number};
use crate::score::{Counts, Fitness};

/// What counts.
pub const REWARD: Section = Section {
    title: "Reward",
    about: "What the search tries to make large.",
    prefix: "trial.",
    entries: &[
        choice("fitness", "Fitness", "What a snake is scored by", fitnesses),
        number(
            "energy_cost_per_kj",
            "Cost of energy",
            "per kJ",
            "So much of the fitness is taken off for each kJ that the joints spend. At 0 all effort is free",
            [0.0, 1000.0],
        )
        .slider(0.0, 10.0)
        .by_ratio_from(0.01),
    ],
};

/// Trials that are a little otherwise.
pub const REPEATS: Section = Section {
    title: "Repeated trials",
    about: "Who does well in several trials, each a little otherwise, has learned more.",
    prefix: "trial.repeats.",
    entries: &[
        number(
            "trials",
            "Trials for each snake",
            "",
            "The first is as it should be, the others are off by what is set below. Each takes its time",
            [1.0, 100.0],
        )
        .slider(1.0, 10.0)
        .whole(),
        choice("counts", "What counts", "Which of the trials' results a snake is scored by", counts),
        number(
            "off.friction",
            "Friction off by",
            "",
            "Share by which friction is larger or smaller: 0.2 is a fifth to either side",
            [0.0, 0.9],
        )
        .slider(0.0, 0.9),
        number(
            "off.rise",
            "Rise off by",
            "",
            "Share by which the steps are higher or lower: 0.1 is a tenth to either side",
            [0.0, 0.9],
        )
        .slider(0.0, 0.9),
        number(
            "off.density",
            "Density off by",
            "",
            "Share by which the limbs are heavier or lighter",
            [0.0, 0.9],
        )
        .slider(0.0, 0.9),
        number(
            "off.start_m",
            "Start off by",
            "m",
            "How far ahead, behind or aside the snake starts",
            [0.0, 5.0],
        )
        .slider(0.0, 2.0),
        number(
            "off.turn_deg",
            "Start turned by",
            "°",
            "How far the snake is turned to either side at the start",
            [0.0, 180.0],
        )
        .slider(0.0, 45.0),
    ],
};

fn fitnesses() -> Vec<Choice> {
    let choice = |kind: Fitness| Choice::new(kind.name(), short_name(kind), about(kind));
    Fitness::ALL.map(choice).to_vec()
}

fn short_name(fitness: Fitness) -> &'static str {
    match fitness {
        Fitness::Centre => "Centre, y",
        Fitness::Head => "Head, y",
        Fitness::CentreOfMass => "Centre of mass, y",
        Fitness::Height => "Height",
        Fitness::FurthestY => "Furthest y ever",
        Fitness::StepsClimbed => "Steps climbed",
        Fitness::Climb => "Climb: y on the stairs",
    }
}

fn about(fitness: Fitness) -> String {
    format!("The {}.\nRewards wrongly: {}", fitness.words(), fitness.rewards_wrongly())
}

fn counts() -> Vec<Choice> {
    let choice = |counts: Counts| match counts {
        Counts::Mean => Choice::new(counts.name(), "Their mean", "All trials count alike."),
        Counts::Worst => Choice::new(
            counts.name(),
            "The worst of them",
            "A snake is as good as its worst trial.",
        ),
    };
    Counts::ALL.map(choice).to_vec()
}
