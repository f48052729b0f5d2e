//! The worksheets in `docs/worksheets`, generated from the catalogue and the results of the experiments. Only their steps and their
//! questions are written by hand, in the files themselves. Each worksheet fits on one printed page.

use std::fs;
use std::path::PathBuf;

use super::plays::Play;
use super::tests::result;
use super::*;
use snakes_core::evolve::Champion;
use snakes_core::score::Evaluation;

/// A line on which the reader writes.
const LINE: &str = "________________________________________";

/// Returns the text of a worksheet as Markdown: the steps and the questions of the present file, and everything else from the lesson.
fn text(index: usize) -> String {
    let lesson = &LESSONS[index];
    let mut text = format!(
        "# Worksheet {}: {}\n\nName: {LINE} Date: {}\n\n**{}** {}\n\n## Predict\n\n",
        index + 1,
        lesson.title,
        &LINE[..15],
        lesson.question,
        lesson.story
    );
    for scene in lesson.scenes {
        let Some(question) = &scene.question else { continue };
        let answers: Vec<String> =
            scene.answers().iter().map(|answer| format!("☐ {answer}")).collect();
        text += &format!("- {}: {} {}\n", scene.label, question.text, answers.join(" "));
    }
    let kept = |from: &str, to: &str| {
        let (_, rest) = lesson.worksheet.split_once(from).expect(from);
        format!("{from}{}", rest.split_once(to).expect(to).0)
    };
    text += &format!("\nBecause: {LINE}{LINE}\n\n{}\n", kept("## Try it", "\n| "));
    text += &format!("{}\n{}", tables(index), kept("## Explain", "**For the teacher"));
    let remark = match index {
        0 => "In tenths, 0.5 is the smallest friction that still gets it to the top. ",
        1 => "Halved six times, 100 N·m become 1.6 N·m. ",
        5 => "Each disqualified snake is one less to breed from. ",
        _ => "",
    };
    text + &format!("**For the teacher.** {} {remark}{}\n", expected(index), lesson.conclusion)
}

/// Returns the tables to fill in. Experiments with the same columns share a table.
fn tables(index: usize) -> String {
    let asked = || {
        LESSONS[index]
            .scenes
            .iter()
            .filter_map(|scene| Some((scene, scene.question.as_ref()?.asks)))
    };
    let heads = |asks: Asks| -> &'static [&'static str] {
        match asks {
            Asks::Furthest => &["Snake", "Ends at (m)", "On the landing?"],
            Asks::PlaybackSpeed => &["Played at", "Ends at (m)", "Hash"],
            Asks::BestRun => {
                &["Run", "Best fitness (m)", "Disqualified", "Where does the best end?"]
            }
            Asks::LateBodyChanges => {
                &["Run", "Best fitness (% of the way)", "Changes of the body in the second half"]
            }
            Asks::SameHash => &["Run", "Hash"],
        }
    };
    let mut tables: Vec<(&[&str], Vec<&str>)> = Vec::new();
    for (scene, asks) in asked() {
        let names = match asks {
            Asks::PlaybackSpeed => vec!["× 1", "× 4"],
            _ => scene.sides.iter().map(|side| side.name).collect(),
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
    let stairs = &result(index, 0).trial.as_ref().expect("lanes").stairs;
    let from_zero = format!("(m; first step at {} m)", stairs.first_riser_y_m);
    tables.into_iter().map(table).collect::<Vec<_>>().join("\n").replace("(m)", &from_zero)
}

/// Describes the results of all experiments, for the teacher.
fn expected(index: usize) -> String {
    let scenes = LESSONS[index].scenes.iter().enumerate();
    let asked = scenes.filter_map(|(number, scene)| {
        let question = scene.question.as_ref()?;
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
            let best = found.best().map_or("none".to_owned(), Champion::brief);
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
            Asks::PlaybackSpeed => progress.plays.finished.iter().map(play).collect(),
            Asks::BestRun => progress.runs.iter().map(run).collect(),
            Asks::LateBodyChanges => progress.runs.iter().map(changes).collect(),
            Asks::SameHash => progress.runs.iter().map(hash).collect(),
        };
        Some(format!("{} ({}). {}", scene.label, results.join("; "), question.finding))
    });
    asked.collect::<Vec<_>>().join(" ")
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
        let parts = ["## Predict", "## Try it", "## Explain", "**For the teacher.**", "☐"];
        for part in parts.into_iter().chain([lesson.title, lesson.question]) {
            assert!(lesson.worksheet.contains(part), "worksheet {number}: {part}");
        }
    }
}

#[test]
#[ignore = "writes the worksheets into docs/worksheets"]
fn write_the_worksheets() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("docs/worksheets");
    for index in 0..LESSONS.len() {
        fs::write(folder.join(format!("{}.md", index + 1)), text(index)).expect("written");
    }
}
