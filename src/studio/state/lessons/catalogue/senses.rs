//! The lessons on senses: the limits of a snake without senses, and the use that a snake makes of its senses.

use crate::studio::state::lessons::lesson::{Lesson, LessonScene, Shows, furthest, side};

/// Lesson on changed stairs, for a snake without senses and one with senses.
pub(super) const ONE_MOTION: Lesson = Lesson {
    title: "One motion for all stairs",
    question: "Does a snake that climbs its own stairs climb others?",
    story: "Most snakes of this program feel nothing but their joints: they repeat one motion. The stage shows such \
            a snake on its own steps, 0.5 m high, on lower and on higher ones; then a snake whose blocks feel the ground.",
    to_try: "Guess, and watch the first race. Do the same with the second snake. Afterwards open the Senses panel \
             and choose Examine on 100 staircases.",
    look_for: "Whether the motion changes with the stairs: the first snake moves its joints in the same way on all of them; the \
               second waits, pushes and turns as its blocks touch the steps.",
    conclusion: "A repeated motion may fit other stairs or not: of 100 staircases this snake climbs 61, the best of its \
                 kind 87. The second climbs 78, because it feels them: without senses only 28.",
    scenes: &[
        LessonScene {
            label: "A snake that feels only its joints",
            shows: Shows::Champion("climber"),
            question: furthest(
                "On steps 0.4 m and 0.5 m high it reaches the landing; five steps 0.6 m high \
                 stop it: motion and steps no longer fit.",
            ),
            sides: &[
                side("steps 0.4 m high", &[("stairs.rise_m", "0.4")]),
                side("original", &[]),
                side("steps 0.6 m high", &[("stairs.rise_m", "0.6")]),
            ],
        },
        LessonScene {
            label: "A snake that feels the ground",
            shows: Shows::Champion("feeler"),
            question: furthest("It stands on the landing of both stairs."),
            sides: &[
                side("0.4 m high, with senses", &[("stairs.rise_m", "0.4")]),
                side("0.6 m high, with senses", &[("stairs.rise_m", "0.6")]),
            ],
        },
    ],
    worksheet: include_str!("../../../../../docs/worksheets/3.md"),
};

/// Lesson on a snake whose sight is taken away.
pub(super) const BLINDFOLD: Lesson = Lesson {
    title: "Take away its eyes",
    question: "Which of its senses does a snake need?",
    story: "This snake has sight (the next step), touch (contacts) and balance (tilt and motion). Its neurons need not use every sense. To find \
            out which it needs, researchers take one away: that sense keeps the value that it had at the start.",
    to_try: "Guess, and watch the snake with and without sight. Then guess what it does without touch and without \
             balance. The switches in the Senses panel do the same to any snake that senses, at any moment.",
    look_for: "Which copies keep to the motion of the original, and which fail on the stairs. Click a block: the \
               wiring in the Senses panel shows which senses its neurons read.",
    conclusion: "Evolution uses what helps. Watching a snake does not show which sense that is: its wiring gives a hint, and an \
                 experiment tells. Examine on 100 staircases, in the Senses panel, also takes away all of them at once.",
    scenes: &[
        LessonScene {
            label: "Without sight",
            shows: Shows::Champion("feeler"),
            question: furthest(
                "Its neurons read no sense of the stairs ahead, so it moves in exactly the same way without sight: it \
                 feels its way.",
            ),
            sides: &[side("original", &[]), side("without sight", &[("senses.sight", "false")])],
        },
        LessonScene {
            label: "Without touch, without balance",
            shows: Shows::Champion("feeler"),
            question: furthest(
                "Without touch it no longer knows when a block stands on a step, and stops in the middle of the \
                 stairs; without balance it stops further up.",
            ),
            sides: &[
                side("original", &[]),
                side("without touch", &[("senses.touch", "false")]),
                side("without balance", &[("senses.balance", "false")]),
            ],
        },
    ],
    worksheet: include_str!("../../../../../docs/worksheets/4.md"),
};
