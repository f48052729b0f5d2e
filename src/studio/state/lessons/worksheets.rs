//! The worksheets in `docs/worksheets`, generated from the catalogue and the results of the experiments. Each fits on
//! one printed page.

use std::fs;
use std::path::PathBuf;

use super::plays::Play;
use super::tests::result;
use super::*;
use snakes_core::score::Evaluation;

/// Contents of a worksheet besides the texts of its lesson.
struct Sheet {
    /// Instructions that follow the step "guess".
    steps: &'static [&'static str],
    /// Questions about the result.
    questions: [&'static str; 2],
    /// Further expected answers, for the teacher.
    expected: &'static str,
}

const SHEETS: [Sheet; LESSONS.len()] = [
    Sheet {
        steps: &[
            "Begin lesson 1, give your guess, and watch the race to its end. Fill in the table.",
            "Do the same with \"A little less, a little more\".",
            "Select \"original\". From the start, drag Friction: find the smallest tenth that still lands.",
        ],
        questions: [
            "What goes wrong with too little friction, and what with too much?",
            "Why does this snake climb best near the friction on which it evolved?",
        ],
        expected: "Of the tenths, 0.5 is the smallest friction that still lands. ",
    },
    Sheet {
        steps: &[
            "Begin lesson 2, give your guess, and watch the race to its end. Fill in the table.",
            "Choose \"The original at two playback speeds\" and guess. Play it to its end at × 1 and × 4.",
            "Write down the end position with all digits, and the first four characters of the hash.",
        ],
        questions: [
            "What is the difference between fewer physics steps per second and a slower playback?",
            "Why must forces not depend on how fast a computer draws?",
        ],
        expected: "",
    },
    Sheet {
        steps: &[
            "Begin lesson 3 and choose \"Evolve with and almost without limits\".",
            "Give your guess and wait for the six generations. Fill in the table.",
            "Watch the best snake of each run race against the other.",
        ],
        questions: [
            "Why does it matter how many snakes of a generation are disqualified?",
            "The fitness is the distance alone. Where does the best snake of each run end, and why there?",
        ],
        expected: "Each disqualified snake is one less to breed from. ",
    },
    Sheet {
        steps: &[
            "Begin lesson 4 and choose \"Evolve with both ranges\".",
            "Give your guess and watch both lines grow for fourteen generations. Fill in the table.",
            "Note the generation after which the lower line hardly rises any more.",
        ],
        questions: [
            "A range of 100 N·m is halved six times. How large is it then?",
            "When are small changes useful, and when large ones?",
        ],
        expected: "Halved six times, 100 N·m become 1.6 N·m. ",
    },
    Sheet {
        steps: &[
            "Begin lesson 5 and choose \"The same run twice\". Guess, wait, and write down both hashes.",
            "Choose \"Friction changed by a millionth\", guess again, and write down both hashes.",
            "Compare your hashes with those of your neighbours.",
        ],
        questions: [
            "What does it tell you if two runs have the same hash?",
            "Why should a scientific result be repeatable by other people?",
        ],
        expected: "",
    },
    Sheet {
        steps: &[
            "Begin lesson 6, give your guess, and watch the race to its end. Fill in the table.",
            "Choose \"A snake that feels its limbs\" and do the same.",
            "Open the Senses panel and choose Examine on 100 staircases: how many with senses, how many without?",
        ],
        questions: [
            "The first snake moves alike on all stairs. Why do lower steps not stop it, but higher ones?",
            "How can you find out whether a snake needs its senses?",
        ],
        expected: "",
    },
    Sheet {
        steps: &[
            "Begin lesson 7, guess, and watch the snake with and without sight. Fill in the table.",
            "Choose \"Without touch, without balance\" and do the same.",
            "Click a limb and look at the wiring in the Senses panel: which senses do its neurons read?",
        ],
        questions: [
            "Why can a snake do without a sense that it has?",
            "Why is it not enough to look at a snake in order to know what it senses?",
        ],
        expected: "",
    },
    Sheet {
        steps: &[
            "Begin lesson 8, guess, and watch the race to its end. Fill in the first table.",
            "Choose \"With and without protection\", guess, and wait. Fill in the second table.",
            "Race again, and select \"a block more\". In the Body panel: Edit this body, Adapt the gait.",
        ],
        questions: [
            "Why is a snake with a changed body worse at first, even if its body could be better?",
            "What does protection cost, and when is it worth that?",
        ],
        expected: "",
    },
    Sheet {
        steps: &[
            "Begin lesson 9, guess, and watch the race to its end. Fill in the first table.",
            "Choose \"Direct and by a ladder\", guess, and watch both lines. Fill in the second table.",
            "Open the Stairs panel and build stairs that the snake on the stage just fails to climb.",
        ],
        questions: [
            "Why does a search learn nothing from a task that all candidates fail alike?",
            "Where do people learn by a ladder, too?",
        ],
        expected: "",
    },
];

/// A line on which the reader writes.
const LINE: &str = "________________________________________";

/// Returns the text of a worksheet as Markdown.
fn text(index: usize) -> String {
    let (lesson, sheet) = (&LESSONS[index], &SHEETS[index]);
    let mut text = format!(
        "# Worksheet {}: {}\n\nName: {LINE} Date: {}\n\n**{}** {}\n\n## Predict\n\n",
        index + 1,
        lesson.title,
        &LINE[..15],
        lesson.question,
        lesson.story
    );
    for scene in lesson.scenes {
        let Some(question) = scene.question() else { continue };
        let answers: Vec<String> =
            scene.answers().iter().map(|answer| format!("☐ {answer}")).collect();
        text += &format!("- {}: {} {}\n", scene.label(), question.text, answers.join(" "));
    }
    text += &format!("\nBecause: {LINE}{LINE}\n\n## Try it\n\n");
    for (number, step) in (1..).zip(sheet.steps) {
        text += &format!("{number}. {step}\n");
    }
    text += &format!("\n{}\n## Explain\n\n", tables(index));
    for (number, question) in (1..).zip(sheet.questions) {
        text += &format!("{number}. {question}\n\n   {LINE}{LINE}\n\n");
    }
    text + &format!(
        "---\n\n**For the teacher** (cover before copying). {} {}{}\n",
        expected(index),
        sheet.expected,
        lesson.conclusion
    )
}

/// Returns the tables to fill in. Experiments with the same columns share a table.
fn tables(index: usize) -> String {
    let asked =
        || LESSONS[index].scenes.iter().filter_map(|scene| Some((scene, scene.question()?.asks)));
    let has_speeds = asked().any(|(_, asks)| asks == Asks::PlaybackSpeed);
    let heads = |asks: Asks| -> &'static [&'static str] {
        match asks {
            _ if has_speeds => &["Snake", "Ends at (m)", "Hash"],
            Asks::Furthest | Asks::PlaybackSpeed => &["Snake", "Ends at (m)", "On the landing?"],
            Asks::BestRun => {
                &["Run", "Best fitness (m)", "Disqualified", "Where does the best end?"]
            }
            Asks::LateBodyChanges => {
                &["Run", "Best fitness", "Changes of the body in the second half"]
            }
            Asks::SameHash => &["Run", "Hash"],
        }
    };
    let mut tables: Vec<(&[&str], Vec<&str>)> = Vec::new();
    for (scene, asks) in asked() {
        let names = match asks {
            Asks::PlaybackSpeed => vec!["played at × 1", "played at × 4"],
            _ => scene.sides().iter().map(|side| side.name).collect(),
        };
        if tables.last().is_none_or(|(of, _)| *of != heads(asks)) {
            tables.push((heads(asks), Vec::new()));
        }
        let Some((_, rows)) = tables.last_mut() else { continue };
        for name in names {
            // Two scenes may both contain the original.
            if !rows.contains(&name) {
                rows.push(name);
            }
        }
    }
    let row = |cells: &[&str]| format!("| {} |\n", cells.join(" | "));
    let table = |(heads, names): (&[&str], Vec<&str>)| {
        let blank = |name: &str| {
            let mut cells = vec![name];
            cells.resize(heads.len(), " ");
            row(&cells)
        };
        let rows: String = names.into_iter().map(blank).collect();
        row(heads) + &row(&vec!["---"; heads.len()]) + &rows
    };
    tables.into_iter().map(table).collect::<Vec<_>>().join("\n")
}

/// Describes the results of all experiments, for the teacher.
fn expected(index: usize) -> String {
    let scenes = LESSONS[index].scenes.iter().enumerate();
    let asked = scenes.filter_map(|(number, scene)| {
        let question = scene.question()?;
        let progress = result(index, number);
        let lane = |(name, of): &(String, Evaluation)| match of.disqualified {
            Some(reason) => format!("{name}: disqualified, {}", reason.words()),
            None => format!("{name}: {:.2} m", of.centre_y_m),
        };
        let run = |found: &Found| {
            let best = found.best().map_or("none".to_owned(), |best| best.reached());
            let out: u32 = found.reports.iter().map(|report| report.disqualified).sum();
            let all: u32 = found.reports.iter().map(|report| report.evaluations).sum();
            format!("{}: {best}, {out} of {all} disqualified", found.name)
        };
        let changes = |found: &Found| {
            let best = found
                .best()
                .map_or("none".to_owned(), |best| best.trial.fitness.text(best.evaluation.fitness));
            format!("{}: {best}, {} late changes", found.name, found.late_body_changes())
        };
        let hash =
            |found: &Found| format!("{}: {:016x}", found.name, found.run_hash.unwrap_or_default());
        let play = |play: &Play| {
            let Play { speed, evaluation } = play;
            format!("× {speed}: {} m, hash {:016x}", evaluation.centre_y_m, evaluation.trace_hash)
        };
        let results: Vec<String> = match question.asks {
            Asks::Furthest => progress.lanes.iter().map(lane).collect(),
            Asks::PlaybackSpeed => progress.plays.finished().iter().map(play).collect(),
            Asks::BestRun => progress.runs.iter().map(run).collect(),
            Asks::LateBodyChanges => progress.runs.iter().map(changes).collect(),
            Asks::SameHash => progress.runs.iter().map(hash).collect(),
        };
        Some(format!("{} ({}). {}", scene.label(), results.join("; "), question.finding))
    });
    asked.collect::<Vec<_>>().join(" ")
}

fn file(index: usize) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("docs/worksheets");
    folder.join(format!("{}.md", index + 1))
}

/// Estimates the printed height of a worksheet, in lines of text. On A4 with margins of 2 cm, letters of 11 points and a line spacing of
/// 1.25, 95 characters fit on a line and 53 lines on the page, of which at most [`PAGE_LINES`] are used.
fn printed_lines(text: &str) -> f64 {
    let height = |line: &str| match line {
        // Half a line separates paragraphs.
        "" => 0.5,
        heading if heading.starts_with('#') => 1.8,
        rule if rule.starts_with("| ---") => 0.0,
        row if row.starts_with('|') => 1.3,
        line => line.chars().count().div_ceil(95) as f64,
    };
    text.lines().map(height).sum()
}

/// Maximum printed height of a worksheet, in lines.
const PAGE_LINES: f64 = 48.0;

#[test]
fn the_worksheets_are_up_to_date() {
    for (index, lesson) in LESSONS.iter().enumerate() {
        assert_eq!(
            lesson.worksheet,
            text(index),
            "worksheet {}: run `cargo test --release --bin snakes write_the_worksheets -- --ignored`",
            index + 1
        );
    }
}

#[test]
fn each_worksheet_prints_on_one_page() {
    for (number, lesson) in (1..).zip(&LESSONS) {
        let lines = printed_lines(lesson.worksheet);
        assert!((20.0..=PAGE_LINES).contains(&lines), "worksheet {number} has {lines} lines");
        let parts = ["## Predict", "## Try it", "## Explain", "**For the teacher**", "☐"];
        for part in parts.into_iter().chain([lesson.title, lesson.question]) {
            assert!(lesson.worksheet.contains(part), "worksheet {number}: {part}");
        }
    }
}

#[test]
#[ignore = "writes the worksheets into docs/worksheets"]
fn write_the_worksheets() {
    for index in 0..LESSONS.len() {
        fs::write(file(index), text(index)).expect("written");
    }
}
