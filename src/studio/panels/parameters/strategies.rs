//! The search: how long it goes, which method, and what each method is told.

use super::entry::{Choice, Section, choice, number, on_off};
use crate::evolve::{Descriptor, StrategyKind};

/// How large and how long a run is.
pub const RUN: Section = Section {
    title: "Run",
    about: "How many snakes, for how many generations.",
    prefix: "evolution.",
    entries: &[
        number(
            "population",
            "Population",
            "",
            "Snakes in a generation. More find more, and take longer",
            [1.0, 100_000.0],
        )
        .whole(),
        number(
            "generations",
            "Generations",
            "",
            "Generations in a run. With the population they give the evaluations that it may cost",
            [1.0, 10_000.0],
        )
        .whole(),
    ],
};

/// Which method.
pub const STRATEGY: Section = Section {
    title: "Strategy",
    about: "How the next generation is made from the last.",
    prefix: "evolution.",
    entries: &[choice("strategy", "Strategy", "The method of the search", strategies)],
};

/// What a method is told; nothing if it has no settings.
pub fn section_of(strategy: StrategyKind) -> Option<&'static Section> {
    match strategy {
        StrategyKind::Halving => Some(&HALVING),
        StrategyKind::Ga => Some(&GA),
        StrategyKind::CmaEs => Some(&CMA_ES),
        StrategyKind::MapElites => Some(&MAP_ELITES),
        StrategyKind::Novelty => Some(&NOVELTY),
        StrategyKind::Random => None,
    }
}

const HALVING: Section = Section {
    title: "Halving (the report's)",
    about: "The best few have children, each shifted at random within a range that shrinks.",
    prefix: "evolution.halving.",
    entries: &[
        number(
            "parents",
            "Parents",
            "",
            "How many of the best become parents. Few settle quickly, many keep more variety",
            [1.0, 100_000.0],
        )
        .slider(1.0, 50.0)
        .whole(),
        number(
            "mutation_range_nm",
            "Mutation range",
            "N·m",
            "How far the children of the second generation may differ from their parents",
            [0.0, 1.0e6],
        )
        .slider(0.0, 1000.0),
        number(
            "mutation_decay",
            "Mutation decay",
            "",
            "What the range is multiplied by with each generation: 0.5 halves it, 1 keeps it",
            [0.0, 1.0],
        )
        .slider(0.0, 1.0),
    ],
};

const GA: Section = Section {
    title: "Genetic algorithm",
    about: "Parents are chosen, crossed and mutated. Novelty search makes its children like this too.",
    prefix: "evolution.ga.",
    entries: &[
        choice("selection", "Selection", "Who becomes a parent", selections),
        number(
            "tournament",
            "Tournament",
            "",
            "How many are drawn, of whom the best becomes a parent. Large ones settle quickly",
            [1.0, 1000.0],
        )
        .slider(1.0, 20.0)
        .whole(),
        choice("crossover", "Crossover", "How two parents make one child", crossovers),
        number(
            "crossover_share",
            "Share with two parents",
            "",
            "The other children are copies of one parent before they mutate",
            [0.0, 1.0],
        )
        .slider(0.0, 1.0),
        choice(
            "mutation",
            "Mutation",
            "How a child's genes differ from what it inherited",
            mutations,
        ),
        number(
            "step",
            "First step of mutation",
            "",
            "As a share of each gene's range. Later the step is inherited, and mutates itself",
            [1.0e-4, 0.5],
        )
        .slider(0.001, 0.5)
        .by_ratio_from(0.001),
        number(
            "cooling",
            "Cooling",
            "",
            "What the steps are multiplied by with each generation. Below 1 the search settles",
            [0.5, 1.0],
        )
        .slider(0.5, 1.0),
        number(
            "elites",
            "Elites",
            "",
            "How many of the best go on unchanged into the next generation",
            [0.0, 100_000.0],
        )
        .slider(0.0, 20.0)
        .whole(),
    ],
};

const CMA_ES: Section = Section {
    title: "CMA-ES",
    about: "Learns in which directions it pays to vary.",
    prefix: "evolution.cma_es.",
    entries: &[
        number(
            "step",
            "First step of CMA-ES",
            "",
            "Spread of the first generation, as a share of each gene's range. Small ones search nearby",
            [1.0e-6, 10.0],
        )
        .slider(0.01, 1.0)
        .by_ratio_from(0.01),
        on_off(
            "active",
            "Learn from the bad too",
            "Bad snakes count too: the directions in which they lie become less likely",
        ),
        choice("restarts", "Restarts", "What happens when a search has come to its end", restarts),
        number(
            "newborns",
            "Newborns first",
            "",
            "The search begins at the best of that many random snakes. At 0 it begins in the middle of all \
             ranges",
            [0.0, 10_000.0],
        )
        .slider(0.0, 1000.0)
        .whole(),
    ],
};

const MAP_ELITES: Section = Section {
    title: "MAP-Elites",
    about: "Keeps the best of every kind of behaviour in a map, and breeds from all of them.",
    prefix: "evolution.map_elites.",
    entries: &[
        choice("x", "Columns of the map", "What the columns of the map tell apart", descriptors),
        choice("y", "Rows of the map", "What the rows of the map tell apart", descriptors),
        number(
            "cells",
            "Columns and rows",
            "",
            "How many of each the map has. More keep finer differences apart",
            [2.0, 100.0],
        )
        .slider(2.0, 50.0)
        .whole(),
        number(
            "step",
            "Step of mutation",
            "",
            "Spread of random steps from an elite, as a share of each gene's range",
            [0.0, 1.0],
        )
        .slider(0.0, 0.3),
        number(
            "line",
            "Step towards another elite",
            "",
            "Spread of steps along the line between two elites, in lengths of that line",
            [0.0, 2.0],
        )
        .slider(0.0, 1.0),
        number(
            "cma_share",
            "Share made by CMA-ES",
            "",
            "Share of each generation that is bred by CMA-ES around an elite",
            [0.0, 1.0],
        )
        .slider(0.0, 1.0),
        number(
            "cma_step",
            "Step of that CMA-ES",
            "",
            "Its first spread around the elite, as a share of each gene's range",
            [1.0e-6, 1.0],
        )
        .slider(0.001, 1.0)
        .by_ratio_from(0.001),
    ],
};

const NOVELTY: Section = Section {
    title: "Novelty search",
    about: "Rewards what has not been seen before. Children are made as the genetic algorithm is told to.",
    prefix: "evolution.novelty.",
    entries: &[
        number(
            "weight",
            "Weight of novelty",
            "",
            "1 is pure novelty search, 0 only looks at fitness",
            [0.0, 1.0],
        )
        .slider(0.0, 1.0),
        number(
            "neighbours",
            "Neighbours",
            "",
            "New is who is far, on average, from so many of the most similar snakes",
            [1.0, 1000.0],
        )
        .slider(1.0, 50.0)
        .whole(),
        number(
            "remembered",
            "Remembered of each generation",
            "",
            "How many, chosen at random, later snakes are compared with",
            [0.0, 1000.0],
        )
        .slider(0.0, 50.0)
        .whole(),
        number(
            "archive_limit",
            "Remembered at most",
            "",
            "Beyond that, new ones take the places of others",
            [1.0, 20_000.0],
        )
        .slider(100.0, 20_000.0)
        .by_ratio_from(100.0)
        .whole(),
        choice(
            "first",
            "Told apart by",
            "What behaviours are told apart by, beside where they end",
            descriptors,
        ),
        choice("second", "And by", "And by this", descriptors),
    ],
};

fn strategies() -> Vec<Choice> {
    StrategyKind::ALL.map(|kind| Choice::new(kind.name(), kind.title(), kind.words())).to_vec()
}

fn selections() -> Vec<Choice> {
    vec![
        Choice::new("tournament", "Tournament", "The best of a few that are drawn."),
        Choice::new("rank", "Rank", "Anyone, the better the more often; the worst hardly ever."),
    ]
}

fn crossovers() -> Vec<Choice> {
    vec![
        Choice::new("uniform", "Uniform", "Each gene is of either parent."),
        Choice::new(
            "one_point",
            "One point",
            "The genes before a point are of one parent, those after it of the other.",
        ),
    ]
}

fn mutations() -> Vec<Choice> {
    vec![
        Choice::new("gaussian", "Gaussian", "Mostly small steps, now and then a large one."),
        Choice::new("uniform", "Uniform", "Steps of any length up to a limit, all as likely."),
    ]
}

fn restarts() -> Vec<Choice> {
    vec![
        Choice::new("none", "None", "Nothing: it goes on where it is."),
        Choice::new("ipop", "Larger", "A new search with twice the population (IPOP)."),
        Choice::new(
            "bipop",
            "Larger or smaller",
            "New searches, now with twice the population, now with a small one (BIPOP).",
        ),
    ]
}

fn descriptors() -> Vec<Choice> {
    let sentence = |descriptor| match descriptor {
        Descriptor::BodyHeight => "How high the snake carries itself, on average.",
        Descriptor::Sideways => "How far from the middle of the stairs it goes, on average.",
        Descriptor::EnergyPerMetre => "How much energy it spends for a metre forward.",
        Descriptor::ContactDuty => "How many of its limbs touch something, on average.",
        Descriptor::Frequency => "How often its motion repeats in a second.",
    };
    let choice = |kind: Descriptor| Choice::new(kind.name(), kind.label(), sentence(kind));
    Descriptor::ALL.map(choice).to_vec()
}
