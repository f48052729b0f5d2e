//! The lesson about stairs that grow with the snakes.

use crate::studio::state::lessons::lesson::{Lesson, LessonScene, best_run, furthest, lane, run};

/// Why a ladder helps.
pub(super) const LADDER: Lesson = Lesson {
    title: "Why a ladder helps",
    question: "Does it pay to begin with lower stairs?",
    story: "On the stairs of a house, most random snakes do not get onto the first step. All of them look equally bad, \
            and evolution has nothing to choose from. The stage shows one snake on three flights of steep stairs.",
    to_try: "Guess, and watch the race. Then let two runs of 54 generations learn on the same stairs: one from the start, \
             the other by way of lower stairs, which grow whenever most snakes of a generation succeed.",
    look_for: "How far the same snake gets on low and on high steps. In the runs, when each line rises, and whether it gets \
               stuck.",
    conclusion: "Stairs that some snakes climb and others do not tell good from bad. A ladder looks for such stairs. It is \
                 not always needed: with ten seeds, the direct way landed 8 times, and the ladder 10 times.",
    scenes: &[
        LessonScene::Lanes {
            label: "One snake, three flights",
            champion: "climber",
            question: Some(furthest(
                "It lands on the lowest flight, climbs part of the middle one, and cannot get onto the highest. On that one it \
                 could not be told from a snake that only crawls.",
            )),
            lanes: &[
                lane("steps of 0.2 m", &FLIGHTS[0]),
                lane("steps of 0.3 m", &FLIGHTS[1]),
                lane("steps of 0.4 m", &FLIGHTS[2]),
            ],
        },
        LessonScene::Runs {
            label: "Direct and by a ladder",
            preset: "house",
            question: best_run(
                "The best of the direct search crawls past the stairs at their side, where the way counts only up to the first \
                 riser. The ladder's snakes land. With other seeds the direct way may succeed, too.",
            ),
            runs: &[run("direct", 102, 1, &DIRECT), run("by a ladder", 102, 1, &BY_LADDER)],
        },
    ],
    worksheet: include_str!("../../../../../docs/worksheets/9.md"),
};

/// Steep stairs with steps of three heights.
const FLIGHTS: [[(&str, &str); 2]; 3] = [
    [("stairs.tread_m", "0.8"), ("stairs.rise_m", "0.2")],
    [("stairs.tread_m", "0.8"), ("stairs.rise_m", "0.3")],
    [("stairs.tread_m", "0.8"), ("stairs.rise_m", "0.4")],
];

/// Settings of the run that learns on the stairs themselves.
const DIRECT: [(&str, &str); 2] = [("generations", "54"), ("champion_trials", "0")];
/// The same with a ladder.
const BY_LADDER: [(&str, &str); 3] =
    [("generations", "54"), ("champion_trials", "0"), ("ladder.first_rise_m", "0.1")];
