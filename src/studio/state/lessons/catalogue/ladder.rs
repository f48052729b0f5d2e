//! The lesson about stairs that grow with the snakes.

use crate::studio::state::lessons::lesson::{
    Lesson, LessonScene, Shows, best_run, furthest, runs_of, side,
};

/// Lesson on the ladder: stairs that become higher as the snakes improve.
pub(super) const LADDER: Lesson = Lesson {
    title: "Why a ladder helps",
    question: "Does it help to begin with lower stairs?",
    story: "Most random snakes do not get onto a high first step: all look equally bad. The stage shows one snake on two \
            staircases.",
    to_try: "Guess, and watch the race. Then let two runs of 54 generations evolve on the same stairs: one directly, the other by way of lower stairs, which grow whenever most snakes of a generation succeed.",
    look_for: "How far the same snake gets on low and on high steps. In the runs, when each line rises, and whether it gets \
               stuck.",
    conclusion: "Stairs that only some snakes climb tell good from bad, and a ladder looks for such stairs. It is not always \
                 needed: in ten runs each, the direct way reached the top 7 times, and the ladder 10 times.",
    scenes: &[
        LessonScene {
            label: "One snake, two staircases",
            shows: Shows::Champion("climber"),
            question: furthest(
                "It climbs the lower staircase, but does not get onto the first step of the higher one.",
            ),
            // Both staircases have shallow treads, but their rises differ.
            sides: &[
                side("steps 0.2 m high", &[("stairs.tread_m", "0.8"), ("stairs.rise_m", "0.2")]),
                side("steps 0.4 m high", &[("stairs.tread_m", "0.8"), ("stairs.rise_m", "0.4")]),
            ],
        },
        LessonScene {
            label: "Direct and by a ladder",
            shows: runs_of("house", 102, &[("generations", "54"), ("champion_trials", "0")]),
            question: best_run(
                "With as many evaluated snakes, the direct search has come no further than the fourth step. Other runs may differ.",
            ),
            sides: &[side("direct", &[]), side("by a ladder", &[("ladder.first_rise_m", "0.1")])],
        },
    ],
    worksheet: include_str!("../../../../../docs/worksheets/5.md"),
};
