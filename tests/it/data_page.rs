//! `docs/data.md` names every field of the lines of JSON. Commands that compute for long or need a server are left out: `study NAME`, `verify`,
//! `bench`, `machines`, and the suites of other engines.
#![expect(clippy::panic, reason = "a helper of a test fails by panicking, as tests do")]

use std::collections::BTreeSet;

use serde_json::Value;

use super::program::{CLIMBER, folder, json_lines};

/// Returns the fields that `docs/data.md` lists for lines of this type of a command: all words in code of its rows.
fn documented(command: &str, kind: &str) -> BTreeSet<String> {
    let page = include_str!("../../docs/data.md");
    let lines = page.split("\n## ").find(|part| part.starts_with("Lines of JSON")).expect("a part");
    let (mut of_command, mut of_kind, mut fields) = (String::new(), String::new(), BTreeSet::new());
    for row in lines.lines().filter(|line| line.starts_with("| ")) {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let [first, second, text] = cells[..] else { panic!("three columns: {row}") };
        if !first.is_empty() {
            of_command = first.trim_matches('`').to_owned();
        }
        if !second.is_empty() {
            of_kind = second.trim_matches('`').to_owned();
        }
        if (of_command.as_str(), of_kind.as_str()) == (command, kind) {
            let code = text.split('`').skip(1).step_by(2);
            fields.extend(code.flat_map(|words| words.split(", ")).map(str::to_owned));
        }
    }
    fields
}

/// Adds the names of all fields of a value, including those within it, but not the names of settings and of an exam's conditions.
fn add_fields(value: &Value, fields: &mut BTreeSet<String>) {
    match value {
        Value::Object(object) => object.iter().for_each(|(name, value)| {
            fields.insert(name.clone());
            if !["settings", "kept_in"].contains(&name.as_str()) {
                add_fields(value, fields);
            }
        }),
        Value::Array(list) => list.iter().for_each(|value| add_fields(value, fields)),
        _ => (),
    }
}

#[test]
fn r6_every_field_of_these_lines_of_json_is_documented() {
    let folder = folder();
    let tiny = "--population 4 --generations 2 --duration 0.5 --threads 1 --json";
    for (command, arguments) in [
        ("run", format!("run --preset neat {tiny} --out a")),
        ("run", format!("run --preset bodies --set evolution.strategy=body_ga {tiny} --out b")),
        ("run", format!("run --preset ladder {tiny} --out c")),
        ("run", format!("run --preset climb --set repeats.champion_trials=1 {tiny} --out d")),
        ("replay --no-render", format!("replay {CLIMBER} --no-render --json")),
        ("exam", format!("exam {CLIMBER} --suite step-rate --json")),
        ("exam --trials", format!("exam {CLIMBER} --trials 2 --json")),
        ("study` without a name", "study --json".to_owned()),
        ("export", format!("export {CLIMBER} -o a.csv --json")),
        ("show presets", "show presets --json".to_owned()),
        ("show settings", "show settings --json".to_owned()),
        ("show body", format!("show body {CLIMBER} --json")),
    ] {
        for line in json_lines(folder.path(), &arguments) {
            let kind = line["type"].as_str().expect("a type").to_owned();
            let of_exam = command == "exam --trials" && kind != "done";
            let listed = match kind.as_str() {
                "done" if command == "exam" || command == "exam --trials" => {
                    documented("exam --trials", &kind)
                }
                _ if of_exam => documented("exam --trials", &kind)
                    .union(&documented("exam", "suite"))
                    .cloned()
                    .collect(),
                _ => documented(command, &kind),
            };
            let mut fields = BTreeSet::new();
            add_fields(&line, &mut fields);
            fields.remove("type");
            let missing: Vec<_> = fields.difference(&listed).collect();
            assert!(missing.is_empty(), "{command}, {kind}: {missing:?} of {line}");
        }
    }
}
