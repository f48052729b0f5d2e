//! The lesson about bodies that evolve with their gaits.

use crate::genome::BodyChange;
use crate::studio::state::lessons::lesson::{
    Lesson, LessonScene, furthest, lane, lane_of_body, later_bodies, run,
};

/// Why bodies need protection.
pub(super) const PROTECTION: Lesson = Lesson {
    title: "Why bodies need protection",
    question: "Why does evolution settle so soon on a body?",
    story: "Blocks can come and go while a gait evolves. The stage shows a snake whose gait belongs to its body, and the \
            same gait in two other bodies: with a block more, and with a block less.",
    to_try: "Guess, and watch the race. Then let bodies evolve for 24 generations of 60 snakes, twice: choosing by \
             fitness alone, and with protection, where a snake with a new body only loses against better ones whose \
             bodies are as new.",
    look_for: "How the same gait moves the three bodies. In the runs, how often the best snake has another body than the \
               best before it, and which run climbs further.",
    conclusion: "A new body is judged with the gait of the old one, and most lose at once, before a gait of their own \
                 could develop. Protection gives them time, but it is not free: in runs four times as long, protected \
                 bodies still changed late, and 8 of 10 climbed less far than those chosen by fitness alone.",
    scenes: &[
        LessonScene::Lanes {
            label: "A block more, a block less",
            champion: "tapered",
            question: Some(furthest(
                "In another body the same gait leads nowhere: both copies end before the first step.",
            )),
            lanes: &[
                lane("original", &[]),
                lane_of_body("a block more", BodyChange::Duplicate, 2),
                lane_of_body("a block less", BodyChange::Remove, 2),
            ],
        },
        LessonScene::Runs {
            label: "Evolve with and without protection",
            preset: "bodies",
            question: later_bodies(
                "Protected, bodies go on changing. By fitness alone the first good body stays, and only its gait \
                 improves; in this short run it even climbs a little further. Not every seed shows this.",
            ),
            runs: &[
                run("with protection", 1, 1, &PROTECTED),
                run("without protection", 1, 1, &UNPROTECTED),
            ],
        },
    ],
    worksheet: include_str!("../../../../../docs/worksheets/8.md"),
};

/// Settings of a run with protection: small enough for a lesson.
const PROTECTED: [(&str, &str); 6] = of_runs("age");
/// The same without protection.
const UNPROTECTED: [(&str, &str); 6] = of_runs("none");

const fn of_runs(protection: &'static str) -> [(&'static str, &'static str); 6] {
    [
        ("strategy", "body_ga"),
        ("body_ga.protection", protection),
        ("population", "60"),
        ("generations", "24"),
        ("duration_s", "10"),
        ("champion_trials", "0"),
    ]
}
