//! The lessons on senses: the limits of a snake without senses, and the use that a snake makes of its senses.

use crate::studio::state::lessons::lesson::{Lesson, LessonScene, furthest, lane};

/// Lesson on changed stairs, for a snake without senses and one with senses.
pub(super) const LEARNED_BY_HEART: Lesson = Lesson {
    title: "Learned by heart",
    question: "Does a snake that climbs its own stairs climb others?",
    story: "Most snakes of this program feel nothing but their joints: they repeat one motion. The stage shows such \
            a snake on its own steps of 0.5 m, on lower and on higher ones; then a snake whose limbs feel the ground.",
    to_try: "Guess, and watch the first race. Do the same with the second snake. Afterwards open the Senses panel \
             and choose Examine on 100 staircases.",
    look_for: "Whether the motion changes with the stairs: the first snake moves its joints alike on all of them; the \
               second waits, pushes and turns as its limbs touch the steps.",
    conclusion: "A repeated motion may fit other stairs or not: of 100 staircases, this snake lands on 61, and the best of \
                 its kind on 87. The second snake lands on 78, and because it feels them: without senses on 28.",
    scenes: &[
        LessonScene::Lanes {
            label: "A snake that feels nothing",
            champion: "climber",
            question: Some(furthest(
                "Lower steps do not stop it, but steps of 0.6 m do: after five of them its motion and the steps no \
                 longer fit.",
            )),
            lanes: &[
                lane("steps of 0.4 m", &[("stairs.rise_m", "0.4")]),
                lane("original", &[]),
                lane("steps of 0.6 m", &[("stairs.rise_m", "0.6")]),
            ],
        },
        LessonScene::Lanes {
            label: "A snake that feels its limbs",
            champion: "feeler",
            question: Some(furthest("It stands on the landing of both stairs.")),
            lanes: &[
                lane("0.4 m, with senses", &[("stairs.rise_m", "0.4")]),
                lane("0.6 m, with senses", &[("stairs.rise_m", "0.6")]),
            ],
        },
    ],
    worksheet: include_str!("../../../../../docs/worksheets/6.md"),
};

/// Lesson on a snake whose sight is taken away.
pub(super) const BLINDFOLD: Lesson = Lesson {
    title: "Take away its eyes",
    question: "Which of its senses does a snake need?",
    story: "The limbs of this snake hold neurons that sense the next step, contacts, and attitude and motion. A sense \
            that is there need not be used. To find out, researchers take one away: it keeps the value that it had at \
            the start.",
    to_try: "Guess, and watch the snake with and without sight. Then guess what it does without touch and without \
             balance. The switches in the Senses panel do the same to any snake that senses, at any moment.",
    look_for: "Which copies keep to the motion of the original, and which lose their way on the stairs. Click a limb: the \
               wiring in the Senses panel shows which senses its neurons read.",
    conclusion: "Evolution uses what helps, and nothing says beforehand which sense that is. Only an experiment tells: \
                 the suite \"lesion\" of the exam takes away all of them at once, on 100 staircases.",
    scenes: &[
        LessonScene::Lanes {
            label: "Without sight",
            champion: "feeler",
            question: Some(furthest(
                "Its neurons read no sense of the stairs ahead, so it moves exactly alike without sight: it feels \
                 its way.",
            )),
            lanes: &[lane("original", &[]), lane("without sight", &[("senses.sight", "false")])],
        },
        LessonScene::Lanes {
            label: "Without touch, without balance",
            champion: "feeler",
            question: Some(furthest(
                "Without touch it no longer knows when a limb stands on a step, and stops in the middle of the \
                 stairs; without balance it stops further up.",
            )),
            lanes: &[
                lane("original", &[]),
                lane("without touch", &[("senses.touch", "false")]),
                lane("without balance", &[("senses.balance", "false")]),
            ],
        },
    ],
    worksheet: include_str!("../../../../../docs/worksheets/7.md"),
};
