//! The lesson about bodies that evolve with their gaits.

use crate::studio::state::lessons::lesson::{
    Lesson, LessonScene, Shows, furthest, lane_of_body, runs_of, side,
};
use crate::studio::state::lessons::prediction::{Asks, Question};
use snakes_core::genome::BodyChange;

/// Lesson on protection: new bodies need time for their gaits to adapt.
pub(super) const PROTECTION: Lesson = Lesson {
    title: "What protection does for new bodies",
    question: "Why does evolution settle so soon on a body?",
    story: "A body and its gait, its way of moving, can evolve together. The stage shows a snake \
            and its gait in bodies with one block more and one less.",
    to_try: "Guess, and watch the race. Then let bodies evolve for 24 generations of 60 snakes, twice: by fitness \
             alone, and with protection. Then a body loses only to better bodies that are no older.",
    look_for: "How the same gait moves the three bodies. In the runs, how often the best snake has another body than the \
               best before it, and which run climbs further.",
    conclusion: "A new body is judged with the old gait: most lose at once. Protection gives them time to adapt, \
                 but costs progress: 8 of 10 runs four times as long got less far.",
    scenes: &[
        LessonScene {
            label: "A block more, a block less",
            shows: Shows::Champion("tapered"),
            question: furthest("In another body the same gait climbs no step."),
            sides: &[
                side("original", &[]),
                lane_of_body("a block more", BodyChange::Duplicate, 2),
                lane_of_body("a block less", BodyChange::Remove, 2),
            ],
        },
        LessonScene {
            label: "With and without protection",
            shows: runs_of("bodies", 1, SMALL),
            question: Some(Question {
                text: "In which run does the body of the best snake change more often in the second half?",
                asks: Asks::LateBodyChanges,
                finding: "Protected bodies go on changing. By fitness alone, the first good body stays and only its gait \
                          improves. Other runs may differ.",
            }),
            sides: &[
                side("with protection", &[("body_ga.protection", "age")]),
                side("without protection", &[("body_ga.protection", "none")]),
            ],
        },
    ],
    worksheet: include_str!("../../../../../docs/worksheets/7.md"),
};

/// Settings of both runs, small enough for a lesson.
const SMALL: &[(&str, &str)] = &[
    // The conclusion refers to runs with this engine.
    ("engine", "rapier"),
    ("strategy", "body_ga"),
    ("population", "60"),
    ("generations", "24"),
    ("duration_s", "10"),
    ("champion_trials", "0"),
];
