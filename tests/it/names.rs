//! Names of files that would act on a terminal, or break a line or a table.

use std::fs;
use std::path::Path;
use std::process::Output;

use serde_json::Value;

use super::program::{CLIMBER, folder, snakes};

/// Stems of files that would clear the screen and change colours, end a cell, end a line, and turn the direction of writing.
const NAMES: [&str; 4] =
    ["\u{1b}[2J\u{1b}[31mred\u{7}", "a|b\\|c", "two\nlines\r", "nor\u{202e}gpj\u{9b}1m\u{7f}"];

/// Commands about the champion NAME.ron, which is there, and about files that are not.
const COMMANDS: [&str; 14] = [
    "exam NAME.ron --suite step-rate",
    "exam NAME.ron --suite step-rate --json",
    "exam NAME.ron --trials 2",
    "exam NAME.ron --trials 2 --json",
    "replay NAME.ron NAME.ron --no-render",
    "show body NAME.ron",
    "export NAME.ron -o NAME.csv",
    "export NAME.ron -o NAME.csv --json",
    "export NAME.ron -o NAME.NAME",
    "export NAME.ron -o missing/NAME.csv",
    "run --population 2 --generations 1 --duration 0.2 --out NAME --restart",
    "run --preset NAME",
    "run --NAME",
    "run --resume NAME.ron",
];

/// Runs a command about a name.
fn run(folder: &Path, command: &str, name: &str) -> Output {
    let words = command.split(' ').map(|word| word.replace("NAME", name));
    snakes(folder, "").args(words).output().expect("the program starts")
}

/// Returns the number of cells of a row of Markdown.
fn cells(row: &str) -> usize {
    row.replace("\\\\", "").replace("\\|", "").matches('|').count()
}

#[test]
fn f9_names_of_files_act_neither_on_the_terminal_nor_on_lines_and_tables() {
    let folder = folder();
    for name in NAMES.iter().chain(&["plain"]) {
        fs::copy(CLIMBER, folder.path().join(format!("{name}.ron"))).expect("copied");
    }
    let acts = |c: char| c != '\n' && (c.is_control() || ('\u{202a}'..='\u{202e}').contains(&c));
    for command in COMMANDS {
        let plain = run(folder.path(), command, "plain");
        for name in NAMES {
            let output = run(folder.path(), command, name);
            assert_eq!(output.status, plain.status, "{command}: {name:?}");
            for (text, plain) in [(&output.stdout, &plain.stdout), (&output.stderr, &plain.stderr)]
            {
                let [text, plain] = [text, plain].map(|text| String::from_utf8_lossy(text));
                assert!(!text.contains(acts), "{command}: {text:?}");
                assert_eq!(text.lines().count(), plain.lines().count(), "{command}: {text}");
                for (row, plain) in
                    text.lines().zip(plain.lines()).filter(|(_, row)| row.starts_with('|'))
                {
                    assert_eq!(cells(row), cells(plain), "{command}: {row}");
                }
            }
            if command.ends_with("--json") {
                let said = String::from_utf8_lossy(&output.stdout);
                let first = said.lines().next().expect("a line");
                let first: Value = serde_json::from_str(first).expect("JSON");
                if let Some(file) = first.get("file") {
                    assert_eq!(file, &Value::from(format!("{name}.ron")), "{command}");
                }
            }
        }
    }
}
