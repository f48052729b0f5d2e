//! The five lessons: their words, and what they show. That what they say is so is tested in [`super`].

/// A lesson.
#[derive(Debug)]
pub(in crate::studio) struct Lesson {
    /// What it is called.
    pub title: &'static str,
    /// What it asks.
    pub question: &'static str,
    /// What happened to those who built the first stair climbers.
    pub story: &'static str,
    /// The one thing to try.
    pub to_try: &'static str,
    /// What to look for meanwhile.
    pub look_for: &'static str,
    /// What it comes to.
    pub answer: &'static str,
    /// What it shows; the first one at once.
    pub scenes: &'static [Scene],
}

/// Something a lesson shows.
#[derive(Debug)]
pub(in crate::studio) enum Scene {
    /// A champion in several worlds, on the stage.
    Lanes {
        /// What its button says.
        label: &'static str,
        /// Which of those that come with the program.
        champion: &'static str,
        /// The worlds.
        lanes: &'static [Side],
    },
    /// Small runs, whose best race when they are over.
    Runs {
        /// What its button says.
        label: &'static str,
        /// The runs.
        runs: &'static [Side],
    },
}

impl Scene {
    /// What its button says.
    pub fn label(&self) -> &'static str {
        match self {
            Self::Lanes { label, .. } | Self::Runs { label, .. } => label,
        }
    }
}

/// One of those that are compared.
#[derive(Debug, Clone)]
pub(in crate::studio) struct Side {
    /// What it is called.
    pub name: &'static str,
    /// What is other: settings by name, with their values as text.
    pub changes: &'static [(&'static str, &'static str)],
    /// Seed of its run.
    pub seed: u64,
    /// Worker threads of its run.
    pub threads: usize,
}

const fn lane(name: &'static str, changes: &'static [(&'static str, &'static str)]) -> Side {
    Side { name, changes, seed: 1, threads: 1 }
}

const fn run(
    name: &'static str,
    seed: u64,
    threads: usize,
    changes: &'static [(&'static str, &'static str)],
) -> Side {
    Side { name, changes, seed, threads }
}

/// The champion alone, as it was found.
const AS_FOUND: Scene = Scene::Lanes {
    label: "The champion as it was found",
    champion: "climber",
    lanes: &[lane("as found", &[])],
};

/// All lessons.
pub(in crate::studio) const LESSONS: [Lesson; 5] = [
    Lesson {
        title: "Friction: too little, and too much",
        question: "Why did tuning the ground take them so long?",
        story: "The ground of the first stair climbers was tuned by eye, with no help. On ice nothing pushes off. \
                So is more grip always better? On the stage: one and the same snake on ice, as it was found, \
                and on something like glue.",
        to_try: "Open the World panel and drag Friction; the same snake begins again beside itself. Or \
                 let these show it.",
        look_for: "Where each one ends. The torques are the same in all lanes; only the ground differs.",
        answer: "Where too little slips, too much sticks: a block that cannot slide over the edge of a step pulls \
                 the others back. And what evolved for one ground fits that ground; a little more or less it can \
                 bear. So a surface has its numbers here, and each of them shows at once what it does.",
        scenes: &[
            Scene::Lanes {
                label: "Ice, as found, glue",
                champion: "robust",
                lanes: &[
                    lane("friction 0.1", &[("surface.friction", "0.1")]),
                    lane("as found", &[]),
                    lane("friction 5", &[("surface.friction", "5")]),
                ],
            },
            Scene::Lanes {
                label: "A little less, a little more",
                champion: "robust",
                lanes: &[
                    lane("friction 0.7", &[("surface.friction", "0.7")]),
                    lane("as found", &[]),
                    lane("friction 1.3", &[("surface.friction", "1.3")]),
                ],
            },
        ],
    },
    Lesson {
        title: "Forces that follow the frame rate",
        question: "Why did their best creature climb on one computer and fall on the next?",
        story: "There, forces were applied whenever a picture was drawn. Moving the window was enough to slow the \
                picture, and with it the push. On the stage: the same genome as found, and as if the computer \
                drew fewer or more pictures a second.",
        to_try: "Show the champion alone, then play it at a quarter of the speed and at four times (the field \
                 with × below the stage), or turn on everything in Show to make the picture slow.",
        look_for: "The fitness at the end of the time. However slowly or quickly it is played, not a digit of \
                   it changes.",
        answer: "Here a physics step has one length, and what is drawn only looks at it. A slow computer shows \
                 fewer pictures of the very same climb.",
        scenes: &[
            Scene::Lanes {
                label: "As found, slower, faster pictures",
                champion: "climber",
                lanes: &[
                    lane("as found", &[]),
                    lane("45 steps a second", &[("physics.steps_per_s", "45")]),
                    lane("90 steps a second", &[("physics.steps_per_s", "90")]),
                ],
            },
            AS_FOUND,
        ],
    },
    Lesson {
        title: "Limits on the joints",
        question: "Why did it help to forbid movements?",
        story: "Signals alone made agents that shook themselves to pieces: a joint that may turn all the way round \
                folds the snake into itself. With a largest angle for each joint, drawn anew for each genome, \
                evolution had fewer bad ideas to try.",
        to_try: "Evolve twice, with the report's limits and with 3 radians, which is hardly any limit: six generations of \
                 120 snakes each.",
        look_for: "How many were disqualified, and how far the best has come.",
        answer: "A limit takes more useless movements away than useful ones. With hardly any nearly all newborns are \
                 out before they have moved, and little is left to breed from.",
        scenes: &[
            AS_FOUND,
            Scene::Runs {
                label: "Evolve with limits and with hardly any",
                runs: &[
                    run("with limits", 1, 1, &[("population", "120"), ("generations", "6")]),
                    run(
                        "hardly any limits",
                        1,
                        1,
                        &[
                            ("population", "120"),
                            ("generations", "6"),
                            ("bend_limits_rad", "[3]"),
                            ("twist_limits_rad", "[3]"),
                        ],
                    ),
                ],
            },
        ],
    },
    Lesson {
        title: "A range that halves",
        question: "Why did their progress stop after six generations?",
        story: "Children differ from their parent by a random shift within a range, and the range halved with each \
                generation: 100, 50, 25 and so on. After six generations a child is its parent with hardly \
                anything changed.",
        to_try: "Evolve twice for fourteen generations: with the range that halves, and with one that shrinks by 5 % \
                 only.",
        look_for: "The two lines. Early on the halved one is often ahead: small steps improve what is there. Where \
                   does it go after generation 6?",
        answer: "Small steps polish, large steps find. A range that is gone after six generations can only polish. It \
                 is not so with every seed: some runs are lucky early. In the Run panel the range and its decay are \
                 yours to set, and other strategies learn their own.",
        scenes: &[
            AS_FOUND,
            Scene::Runs {
                label: "Evolve with both ranges",
                runs: &[
                    run("range halves", 3, 1, &[("population", "120"), ("generations", "14")]),
                    run(
                        "range stays large",
                        3,
                        1,
                        &[("population", "120"), ("generations", "14"), ("mutation_decay", "0.95")],
                    ),
                ],
            },
        ],
    },
    Lesson {
        title: "The same bits",
        question: "Why must a run that is repeated give exactly the same?",
        story: "There, the same forces gave different results from run to run and from computer to computer. So no \
                result could be checked, work could not be shared between computers, and runs were repeated only to \
                throw outliers away.",
        to_try: "Evolve the same run twice, once on one thread and once on two. Then once more, with the friction \
                 changed by a millionth.",
        look_for: "The hash of each run: sixteen digits that stand for every bit of every evaluation.",
        answer: "The same seed and settings give the same hash, on any number of threads and on any of the usual \
                 computers. A millionth is enough to end elsewhere: so a result can only be trusted if it can be \
                 repeated exactly.",
        scenes: &[
            AS_FOUND,
            Scene::Runs {
                label: "The same run twice",
                runs: &[
                    run("on one thread", 1, 1, &[("population", "60"), ("generations", "6")]),
                    run("on two threads", 1, 2, &[("population", "60"), ("generations", "6")]),
                ],
            },
            Scene::Runs {
                label: "Friction changed by a millionth",
                runs: &[
                    run("friction 1", 1, 1, &[("population", "60"), ("generations", "6")]),
                    run(
                        "friction 1.000001",
                        1,
                        1,
                        &[
                            ("population", "60"),
                            ("generations", "6"),
                            ("surface.friction", "1.000001"),
                        ],
                    ),
                ],
            },
        ],
    },
];
