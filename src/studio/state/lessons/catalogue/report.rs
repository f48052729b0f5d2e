//! The lessons on the experiences that the authors of the report describe.

use crate::studio::state::lessons::lesson::{
    AS_FOUND, Lesson, LessonScene, Shows, Side, best_run, furthest, runs_of, same_hash, side,
};
use crate::studio::state::lessons::prediction::{Asks, Question};

/// Lesson on the amount of friction.
pub(super) const FRICTION: Lesson = Lesson {
    title: "Friction: how much?",
    question: "How much grip do stairs need?",
    story: "This program rebuilds an experiment in which the surface was tuned by eye, which took a long time. The stage shows the same snake on a surface like ice (friction 0.1), on its own surface (1) and on a \
            much rougher surface (5).",
    to_try: "Guess which snake gets furthest, then watch the race. Afterwards select the original, go back to \
             the start, open the Change panel and drag Friction: a copy of the snake starts beside it with the new value.",
    look_for: "How far each snake gets. The genome is the same in all lanes; only the surface differs.",
    conclusion: "A snake that evolved on one surface is adapted to it: it tolerates small changes, not large \
                 ones. The Change panel lets you set every property of a surface as a number and \
                 see its effect at once.",
    scenes: &[
        LessonScene {
            label: "Ice, original, very rough",
            shows: Shows::Champion("robust"),
            question: furthest(
                "With too little grip the snake slips; with too much, a block catches on the edge of a step and \
                 holds the others back.",
            ),
            sides: &[
                side("friction 0.1", &[("surface.friction", "0.1")]),
                side("original", &[]),
                side("friction 5", &[("surface.friction", "5")]),
            ],
        },
        LessonScene {
            label: "A little less, a little more",
            shows: Shows::Champion("robust"),
            question: furthest(
                "With 0.3 less or more, it gets less far, but still reaches the landing.",
            ),
            sides: &[
                side("friction 0.7", &[("surface.friction", "0.7")]),
                side("original", &[]),
                side("friction 1.3", &[("surface.friction", "1.3")]),
            ],
        },
    ],
    worksheet: include_str!("../../../../../docs/worksheets/1.md"),
};

/// Lesson on the frame rate and the physics steps.
pub(super) const FRAME_RATE: Lesson = Lesson {
    title: "Frame rate and physics steps",
    question: "Why did the best snake climb on one computer and fall on another?",
    story: "In the rebuilt experiment, forces were applied once per drawn frame. Moving the window slowed \
            the drawing and the snake. The stage shows the same genome with its own 60 physics steps per second, with \
            120 and 240.",
    to_try: "Watch the race. Then choose \"Another snake at two playback speeds\" and play it to its end at two speeds, \
             for example × 1 and × 4 (the field with × below the stage). You can also turn on everything in Show to \
             slow the drawing.",
    look_for: "In the race, where each snake ends. At each playback speed, all digits of the end position, and \
               the hash of the motion: sixteen characters (0 to 9 and a to f) that summarise every bit of each \
               block's position after every physics step.",
    conclusion: "There, a slow computer changed the physics steps, and so the motion. Here it only shows fewer frames \
                 of the same climb.",
    scenes: &[
        LessonScene {
            label: "More physics steps per second",
            shows: Shows::Champion("by-heart"),
            question: Some(Question {
                text: "Which snake ends furthest? The ground beside the stairs counts, too.",
                asks: Asks::Furthest,
                finding: "At 120 it falls off and ends further, but on the ground. At 240 it leaves the area.",
            }),
            sides: &[
                side("original", &[]),
                side("120 physics steps/s", &[("physics.steps_per_s", "120")]),
                side("240 physics steps/s", &[("physics.steps_per_s", "240")]),
            ],
        },
        LessonScene {
            label: "Another snake at two playback speeds",
            shows: Shows::Champion("climber"),
            question: Some(Question {
                text: "Play it to its end at two speeds. Will it end exactly the same?",
                asks: Asks::PlaybackSpeed,
                finding: "Playback speed changes when a step is drawn, not what happens in it.",
            }),
            sides: &[side("another snake", &[])],
        },
    ],
    worksheet: include_str!("../../../../../docs/worksheets/8.md"),
};

/// Lesson on the limits of the joints.
pub(super) const JOINT_LIMITS: Lesson = Lesson {
    title: "Limits on the joints",
    question: "Does it help evolution to restrict the joints, or does it hinder?",
    story: "A joint that can turn all the way round allows more movements, and it can fold the snake into itself. \
            In the rebuilt experiment, each joint had a maximum angle, chosen at random for each genome.",
    to_try: "Run evolution twice for six generations of 120 snakes: with limits like those of that experiment, and with limits of \
             172°, which hardly restrict a joint.",
    look_for: "The number of disqualified snakes, the distance of the best one, and where that lies in the race \
               afterwards.",
    conclusion: "Limits remove more useless movements than useful ones, so that evolution has more snakes to \
                 choose from. What it then finds depends on the fitness: here only the distance counts, and six \
                 generations find a way around the stairs.",
    scenes: &[
        AS_FOUND,
        LessonScene {
            label: "Evolve with and almost without limits",
            shows: runs_of("quick", 3, &[("population", "120"), ("generations", "6")]),
            question: best_run(
                "Almost without limits, more snakes are disqualified, and fewer are left to breed from. The \
                 best snake with limits gets further, but beside the stairs.",
            ),
            sides: &[
                side("with limits", &[]),
                side(
                    "almost no limits",
                    &[("bend_limits_rad", "[3]"), ("twist_limits_rad", "[3]")],
                ),
            ],
        },
    ],
    worksheet: include_str!("../../../../../docs/worksheets/6.md"),
};

/// Lesson on the decrease of the mutation range.
pub(super) const MUTATIONS: Lesson = Lesson {
    title: "Mutations: how fast should they shrink?",
    question: "What happens to the progress of a run when its mutations become smaller?",
    story: "Children differ from their parent by random changes within a mutation range. In the rebuilt experiment, this range halved with each generation: 100, 50, 25 N·m and so on. Here one run does the same; in a second run it shrinks by \
            only 5 % each time.",
    to_try: "Run evolution twice for fourteen generations: with a range that halves, and with one that shrinks \
             slowly.",
    look_for: "The two lines, early and late: which is ahead, and which still rises?",
    conclusion: "Small changes refine a solution; large changes find new ones. After six halvings the range is so small that it can only refine. With the strategy Halving, you set the range and its decay in the Watch \
                 panel; some others, such as CMA-ES, adapt the size of their changes themselves.",
    scenes: &[
        AS_FOUND,
        LessonScene {
            label: "Evolve with both ranges",
            shows: runs_of("quick", 4, &[("population", "120"), ("generations", "14")]),
            question: best_run(
                "With the range that shrinks slowly, the best snake gets further. Not every run shows this, \
                 because some are lucky early.",
            ),
            sides: &[
                side("range halves", &[]),
                side("range shrinks slowly", &[("mutation_decay", "0.95")]),
            ],
        },
    ],
    worksheet: include_str!("../../../../../docs/worksheets/2.md"),
};

/// Lesson on the repetition of a run.
pub(super) const REPETITION: Lesson = Lesson {
    title: "Repeating a run",
    question: "Does a run give the same result when you repeat it?",
    story: "In the rebuilt experiment, the same forces gave different results from run to run and from computer \
            to computer. Results could not be checked, work could not be shared between computers, and runs \
            were repeated only to discard outliers.",
    to_try: "Repeat the same run with one and with two snakes computed at a time. Then repeat it with the friction \
             changed by a millionth.",
    look_for: "The hash of each run: sixteen characters (0 to 9 and a to f) that summarise every bit of the results of all snakes.",
    conclusion: "A hash tells at once whether two runs are the same in every bit. If a run repeats \
                 exactly, one repetition is enough to check it, and computers can share the work.",
    scenes: &[
        AS_FOUND,
        LessonScene {
            label: "The same run twice",
            shows: runs_of("quick", 1, &[("population", "60"), ("generations", "6")]),
            question: same_hash(
                "The same settings and the same random numbers (seed) give the same hash, however many snakes are \
                 computed at a time, and on every computer with an Intel or AMD processor (x86-64).",
            ),
            sides: &[side("one at a time", &[]), Side { threads: 2, ..side("two at a time", &[]) }],
        },
        LessonScene {
            label: "Friction changed by a millionth",
            shows: runs_of("quick", 1, &[("population", "60"), ("generations", "6")]),
            question: same_hash(
                "Even a millionth changes the hash, which does not tell how much the results differ.",
            ),
            sides: &[
                side("friction 5", &[]),
                side("friction 5.000005", &[("surface.friction", "5.000005")]),
            ],
        },
    ],
    worksheet: include_str!("../../../../../docs/worksheets/9.md"),
};
