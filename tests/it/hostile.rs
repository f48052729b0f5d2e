//! Hostile and damaged files: each gives one line of error, and is left unchanged.

use std::fs;
use std::path::{Path, PathBuf};
#[cfg(unix)]
use std::process::Command;
use std::process::Output;

use rayon::prelude::*;
use xxhash_rust::xxh3::xxh3_64;

use super::program::{cut_log, folder, run, run_in};

const CHAMPION: &str = include_str!("../../saves/first-climber.ron");
const PRESET: &str = include_str!("../../assets/presets/mud.ron");

/// How the program opens a hostile file.
#[derive(Clone, Copy, Debug, PartialEq)]
enum OpenedAs {
    Champion,
    Preset,
    Run,
}

/// A hostile file: a description, how it is opened, its path below the test's folder, and its bytes.
struct Hostile {
    what: String,
    opened: OpenedAs,
    path: PathBuf,
    bytes: Vec<u8>,
}

/// All hostile files. Each file of a run gets its own copy of a good run.
#[derive(Default)]
struct Collection(Vec<Hostile>);

impl Collection {
    fn add(&mut self, what: impl Into<String>, opened: OpenedAs, bytes: impl Into<Vec<u8>>) {
        let path = PathBuf::from(format!("hostile-{}.ron", self.0.len()));
        self.0.push(Hostile { what: what.into(), opened, path, bytes: bytes.into() });
    }

    /// Adds a hostile file of a run.
    fn add_to_run(&mut self, what: impl Into<String>, file: &str, bytes: impl Into<Vec<u8>>) {
        let path = Path::new(&format!("run-{}", self.0.len())).join(file);
        self.0.push(Hostile {
            what: what.into(),
            opened: OpenedAs::Run,
            path,
            bytes: bytes.into(),
        });
    }

    /// Adds texts that are cut off at the beginning or in the middle of every `every`th line.
    fn cut_everywhere(&mut self, opened: OpenedAs, text: &str, every: usize) {
        let mut at = 0;
        for (number, line) in text.split_inclusive('\n').enumerate() {
            let place = if number % 2 == 0 { at } else { at + line.len() / 2 };
            if number % every == 0 && (1..text.trim_end().len()).contains(&place) {
                self.add(format!("cut off at {place}"), opened, &text.as_bytes()[..place]);
            }
            at += line.len();
        }
    }

    /// Adds texts in which each number in turn is replaced by each of `others`.
    fn replace_numbers(&mut self, opened: OpenedAs, text: &str, others: &[&str]) {
        for (number, line) in text.lines().enumerate() {
            let Some((field, value)) = line.trim_end_matches(',').split_once(": ") else {
                continue;
            };
            if value.parse::<f64>().is_err() || line.trim_start().starts_with("//") {
                continue;
            }
            let field = field.trim();
            for other in others {
                let lines = text.lines().enumerate().map(|(n, l)| {
                    if n == number { format!("{field}: {other},\n") } else { format!("{l}\n") }
                });
                self.add(format!("{field} is {other}"), opened, lines.collect::<String>());
            }
        }
    }

    /// Adds texts that lack each required field in turn.
    fn leave_out_fields(&mut self, opened: OpenedAs, text: &str) {
        for (number, line) in text.lines().enumerate() {
            // An optional field that is None may be left out.
            let is_needed = !line.contains("//") && !line.ends_with(": None,");
            if line.ends_with(',') && line.contains(": ") && is_needed {
                let lines = text.lines().enumerate().filter(|(n, _)| *n != number);
                let lines: Vec<&str> = lines.map(|(_, line)| line).collect();
                self.add(format!("without {}", line.trim()), opened, lines.join("\n"));
            }
        }
    }

    fn replace(&mut self, opened: OpenedAs, text: &str, from: &str, to: &str) {
        assert!(text.contains(from), "{from}");
        let what = format!("{from} -> {}", to.chars().take(60).collect::<String>());
        self.add(what, opened, text.replacen(from, to, 1));
    }
}

/// Adds files that are wrong for every parser: damaged, nested, huge, or of another kind.
fn add_general(all: &mut Collection, opened: OpenedAs, text: &str) {
    all.add("empty", opened, "");
    all.add("white space", opened, " \n\t\n");
    all.add("a byte order mark only", opened, "\u{feff}");
    all.add(
        "a zero byte in the middle",
        opened,
        text.replacen("engine", "eng\0ine", 1).replacen("about", "ab\0out", 1),
    );
    all.add("not text", opened, [0xff, 0xfe, 0x00, 0x80].repeat(100));
    all.add("not quite text", opened, [text.as_bytes(), &[0xc3]].concat());
    all.add("an executable", opened, [b"\x7fELF\x02\x01\x01".as_slice(), &[0; 500]].concat());
    all.add("JSON", opened, "{\"kind\": \"snakes-and-stairs champion\", \"format\": 3}");
    all.add("XML", opened, "<!DOCTYPE x [<!ENTITY a SYSTEM \"file:///etc/passwd\">]><x>&a;</x>");
    all.add("text after the end", opened, format!("{text}\n()"));
    all.add("twice", opened, format!("{text}\n{text}"));
    for (name, open) in [
        ("parentheses", "("),
        ("brackets", "["),
        ("options", "Some("),
        ("fields", "(a:"),
        ("maps", "{1:"),
        ("comments", "/*"),
    ] {
        all.add(format!("nested {name}"), opened, open.repeat(200_000));
        all.add(
            format!("nested {name} where a field is"),
            opened,
            text.replacen("settings: (", &format!("settings: ({}", open.repeat(100_000)), 1)
                .replacen("kind: ", &format!("kind: {}", open.repeat(100_000)), 1),
        );
    }
    all.add("ten million empty values", opened, "[(),".repeat(2_600_000));
    all.add("a name of ten megabytes", opened, format!("({}: 1)", "a".repeat(10_000_000)));
    all.add("a text of ten megabytes", opened, format!("(kind: \"{}\")", "a".repeat(10_000_000)));
    all.add("a number of ten megabytes", opened, format!("(format: {})", "9".repeat(10_000_000)));
    all.add("eleven megabytes of white space", opened, " ".repeat(11 * 1024 * 1024));
    all.add("terminal controls", opened, "(\u{1b}[2J\u{1b}[31mkind\u{7}: \"\u{9b}31m\")");
    all.add(
        "a field twice",
        opened,
        text.replacen("    settings: (", "    name: \"x\",\n    settings: (", 1).replacen(
            "    engine: 3,",
            "    engine: 3,\n    engine: 3,",
            1,
        ),
    );
    all.add(
        "a field that is not known",
        opened,
        text.replacen("    settings: (", "    include: \"/etc/passwd\",\n    settings: (", 1)
            .replacen("    engine: 3,", "    engine: 3,\n    include: \"/etc/passwd\",", 1),
    );
}

fn champions(all: &mut Collection) {
    add_general(all, OpenedAs::Champion, CHAMPION);
    all.cut_everywhere(OpenedAs::Champion, CHAMPION, 3);
    all.replace_numbers(OpenedAs::Champion, CHAMPION, &["NaN", "inf", "-1.0e30", "\"1\""]);
    all.leave_out_fields(OpenedAs::Champion, CHAMPION);
    let formats = ["1", "4", "6", "4294967295", "99999999999999999999", "-1", "1.5", "\"5\"", "0"];
    for format in formats {
        all.replace(OpenedAs::Champion, CHAMPION, "format: 5", &format!("format: {format}"));
    }
    for preset in
        ["../../etc/passwd", "/etc/passwd", "..", "", "a b", "C:\\\\x", "x\\n", "\u{202e}x"]
    {
        all.replace(
            OpenedAs::Champion,
            CHAMPION,
            "preset: \"report\"",
            &format!("preset: \"{preset}\""),
        );
    }
    for (from, to) in [
        ("frames: 85", "frames: 4294967295"),
        ("frames: 85", "frames: 84"),
        ("frames: 85", "frames: 0"),
        ("every_steps: 2", "every_steps: 0"),
        ("data: \"", "data: \"****"),
        ("data: \"", "data: \"AAAA"),
        ("limbs: 5,\n        frames", "limbs: 4294967295,\n        frames"),
        ("joints: [", "joints: [(bend_nm: [], twist_nm: []),"),
        ("bend_nm: [", "bend_nm: [NaN, "),
        ("bend_nm: [", "bend_nm: [1.0e39, "),
        ("bend_nm: [", "bend_nm: [], was: ["),
        ("fitness: steps_climbed", "fitness: kilos"),
        ("ground: None", "ground: Some(1)"),
        ("trace_hash: \"", "trace_hash: \"g"),
        ("trace_hash: \"", "trace_hash: \"00000000000000000"),
        ("steps: 168", "steps: 167"),
        ("limbs: 5", "limbs: 6"),
        ("kind: \"snakes-and-stairs champion\"", "kind: \"snakes-and-stairs run\""),
    ] {
        all.replace(OpenedAs::Champion, CHAMPION, from, to);
    }
    let joints = "(bend_nm: [0.0], twist_nm: [0.0]),".repeat(350_000);
    all.replace(OpenedAs::Champion, CHAMPION, "joints: [", &format!("joints: [{joints}"));
    let points = "0,".repeat(5_000_000);
    all.replace(OpenedAs::Champion, CHAMPION, "bend_nm: [", &format!("bend_nm: [{points}"));
    // A flipped bit that leaves the file readable changes the champion's motion, which is reported. Only digits before a decimal
    // point are flipped, because later ones may be too small to matter.
    let bytes = CHAMPION.as_bytes();
    let torques = CHAMPION.find("joints: [").expect("a genome");
    let exam = CHAMPION.find("\n    exam: [").expect("an exam");
    let digits =
        (torques..exam).filter(|&place| bytes[place].is_ascii_digit() && bytes[place + 1] == b'.');
    for place in digits.step_by(3) {
        let mut bytes = CHAMPION.as_bytes().to_vec();
        bytes[place] ^= 1;
        all.add(format!("the last bit of byte {place} flipped"), OpenedAs::Champion, bytes);
    }
    let values = CHAMPION.find("\n(").expect("comments, and then values");
    let marks = CHAMPION.bytes().enumerate().skip(values);
    for (place, byte) in marks.filter(|(_, byte)| b"(),:[]\"".contains(byte)).step_by(9) {
        let mut bytes = CHAMPION.as_bytes().to_vec();
        bytes[place] = byte ^ 0x40;
        all.add(
            format!("a bit of the {:?} at byte {place} flipped", char::from(byte)),
            OpenedAs::Champion,
            bytes,
        );
    }
}

fn presets(all: &mut Collection) {
    add_general(all, OpenedAs::Preset, PRESET);
    all.cut_everywhere(OpenedAs::Preset, PRESET, 7);
    all.replace_numbers(OpenedAs::Preset, PRESET, &["NaN", "-1.0e30"]);
    for name in ["../x", "/tmp/x", "", ".", "mud/../../x", "MUD", "m\\u{0}d"] {
        all.replace(OpenedAs::Preset, PRESET, "name: \"mud\"", &format!("name: \"{name}\""));
    }
    for format in ["format: 0", "format: 1", "format: 4", "format: 3, format: 3"] {
        all.replace(OpenedAs::Preset, PRESET, "format: 3", format);
    }
    all.replace(OpenedAs::Preset, PRESET, "population: 30", "population: 100000, x: ");
    let limits = "0.5,".repeat(2_500_000);
    all.replace(
        OpenedAs::Preset,
        PRESET,
        "bend_limits_rad: [",
        &format!("bend_limits_rad: [{limits}"),
    );
    let widths = format!("limb_width_m: [{}1.0]", "1.0,".repeat(2_500_000));
    all.replace(OpenedAs::Preset, PRESET, "limb_width_m: 1.0", &widths);
    let about = format!("about: \"{}", "very ".repeat(10_000));
    all.replace(OpenedAs::Preset, PRESET, "about: \"", &about);
}

/// Returns a line of a log with its correct checksum.
fn line(json: &str) -> String {
    let open = json.strip_suffix('}').expect("an object");
    format!("{open},\"sum\":\"{:016x}\"}}\n", xxh3_64(open.as_bytes()))
}

fn runs(all: &mut Collection, good: &Path) {
    let read = |file: &str| fs::read_to_string(good.join(file)).expect("a file of the good run");
    let (plan, log, checkpoint) = (read("run.ron"), read("log.jsonl"), read("checkpoint-2.ron"));
    for (from, to) in [
        ("format: 4", "format: 1"),
        ("format: 4", "format: 3"),
        ("format: 4", "format: 5"),
        ("engine: 3", "engine: 1"),
        ("engine: 3", "engine: 4"),
        ("founder: None", "founder: Some(())"),
        ("founder: None", "founder: Some((name: \"x\", genome: 1))"),
        ("founder: None", "founder: None, founder: None"),
        ("kind: \"snakes-and-stairs run\"", "kind: \"snakes-and-stairs champion\""),
        ("preset: \"report\"", "preset: \"../../../etc\""),
        ("population: 4", "population: 4000000000"),
        ("population: 4", "population: 0"),
        ("generations: 3", "generations: NaN"),
        ("duration_s: 0.2", "duration_s: inf"),
        ("seed: 1", "seed: -1"),
        ("seed: 1", "seed: 18446744073709551616"),
        ("settings: (", "settings: [("),
    ] {
        assert!(plan.contains(from), "{from} in {plan}");
        all.add_to_run(format!("run.ron with {to}"), "run.ron", plan.replacen(from, to, 1));
    }
    for place in [0, 1, plan.len() / 3, plan.len() / 2, plan.len() - 3] {
        all.add_to_run(format!("run.ron cut off at {place}"), "run.ron", &plan.as_bytes()[..place]);
    }
    for (from, to) in [
        ("format: 3", "format: 2"),
        ("format: 3", "format: 4"),
        ("engine: 3", "engine: 1"),
        ("generation: 2", "generation: 1"),
        ("run_hash: \"", "run_hash: \"0"),
        ("run_hash: \"", "run_hash: \"x"),
        ("strategy: [(", "strategy: [(step: 0.1, point: [0.5]), ("),
        ("strategy: [", "strategy: [1, "),
        ("strategy: [", "strategy: [], was: ["),
        ("bend_nm: [", "bend_nm: [NaN, "),
        ("bend_limit_rad: ", "bend_limit_rad: -"),
        ("density_kg_m3: ", "density_kg_m3: 1.0e38, x: "),
    ] {
        assert!(checkpoint.contains(from), "{from} in {checkpoint}");
        let what = format!("checkpoint with {to}");
        all.add_to_run(what, "checkpoint-2.ron", checkpoint.replacen(from, to, 1));
    }
    for place in [0, 20, checkpoint.len() / 2, checkpoint.len() - 3] {
        let what = format!("checkpoint cut off at {place}");
        all.add_to_run(what, "checkpoint-2.ron", &checkpoint.as_bytes()[..place]);
    }
    let lines: Vec<&str> = log.split_inclusive('\n').collect();
    let objects: Vec<String> = lines
        .iter()
        .map(|line| format!("{}}}", line.split_once(",\"sum\"").expect("a sum").0))
        .collect();
    let mut logs = vec![
        ("lines in another order".to_owned(), format!("{}{}", lines[1], lines[0])),
        ("a line left out".to_owned(), lines[1].to_owned()),
        ("the first line twice".to_owned(), format!("{}{}", lines[0], lines[0])),
        ("a line without a sum".to_owned(), format!("{}\n{}", objects[0], lines[1])),
        ("an empty line".to_owned(), format!("\n{log}")),
        ("lines of another program".to_owned(), "GET / HTTP/1.1\nHost: x\n\n".to_owned()),
        (
            "deep brackets".to_owned(),
            format!("{}{}", line(&format!("{{\"generation\":{}}}", "[".repeat(100_000))), log),
        ),
        (
            "more generations than there are".to_owned(),
            (1..=5)
                .map(|n| {
                    line(&objects[0].replace("\"generation\":1", &format!("\"generation\":{n}")))
                })
                .collect(),
        ),
    ];
    for (from, to) in [
        ("\"generation\":1", "\"generation\":4294967296"),
        ("\"generation\":1", "\"generation\":-1"),
        ("\"generation\":1", "\"generation\":2"),
        ("\"evaluations\":4", "\"evaluations\":\"4\""),
        ("\"hash\":\"", "\"hash\":\"not hexadecimal "),
        ("\"elapsed_s\":", "\"elapsed_s\":1e999,\"x\":"),
        ("\"crashed\":0", "\"crashed\":null"),
        ("\"mean\":", "\"mean\":NaN,\"x\":"),
    ] {
        assert!(objects[0].contains(from), "{from} in {}", objects[0]);
        let first = line(&objects[0].replacen(from, to, 1));
        logs.push((format!("a log with {to}"), format!("{first}{}", lines[1])));
    }
    for place in (0..lines[0].len()).step_by(31) {
        let mut text = log.clone().into_bytes();
        text[place] ^= 2;
        all.add_to_run(format!("a bit of byte {place} of the log flipped"), "log.jsonl", text);
    }
    for (what, text) in logs {
        all.add_to_run(what, "log.jsonl", text);
    }
    changes(all);
    founders(all, &plan);
    all.add_to_run(
        "a log of eleven megabytes",
        "log.jsonl",
        log.repeat(11 * 1024 * 1024 / log.len() + 1),
    );
    all.add_to_run("a champion cut off", "generation-1.ron", "(kind: ");
    all.add_to_run("another file as champion", "generation-2.ron", plan);
}

/// Adds files of changes that are impossible or hostile.
fn changes(all: &mut Collection) {
    let change = |generation: &str, field: &str, value: &str| {
        line(&format!("{{\"generation\":{generation},\"field\":{field:?},\"value\":{value:?}}}"))
    };
    let parents = "evolution.halving.parents";
    let good = change("2", parents, "2");
    let mut files = vec![
        ("of generation 0".to_owned(), change("0", parents, "2")),
        ("of a generation after the end".to_owned(), change("4", parents, "2")),
        ("of no generation".to_owned(), change("-1", parents, "2")),
        ("of a huge generation".to_owned(), change("4294967296", parents, "2")),
        ("out of order".to_owned(), change("3", parents, "3") + &good),
        ("too many".to_owned(), good.repeat(2001)),
        ("of eleven megabytes".to_owned(), good.repeat(11 * 1024 * 1024 / good.len() + 1)),
        ("without a sum".to_owned(), "{\"generation\":2}\n".to_owned()),
        ("of a field that is not known".to_owned(), good.replace("value", "valve")),
        ("before what it would shorten".to_owned(), change("3", "evolution.generations", "2")),
        ("without end".to_owned(), change("2", "evolution.generations", "10001")),
        ("of a long value".to_owned(), change("2", parents, &"2".repeat(5_000_000))),
        ("of a long field".to_owned(), change("2", &"x".repeat(5_000_000), "2")),
        ("deep".to_owned(), change("2", parents, &"[".repeat(50))),
    ];
    for value in ["0", "-1", "NaN", "none", "", "1e99", "\u{1b}[2J", "null", "{}"] {
        files.push((format!("to {value:?}"), change("2", parents, value)));
    }
    for (field, value) in [
        ("trial.surface.friction", "0.5"),
        ("genome.controller", "gait"),
        ("evolution.strategy", "ga"),
        ("evolution.ga.elites", "1"),
        ("halving.parents", "2"),
        ("../../etc/passwd", "2"),
        ("\u{1b}[2J", "2"),
        ("", ""),
    ] {
        files.push((format!("of {field:?}"), change("2", field, value)));
    }
    for place in (0..good.len() - 1).step_by(17) {
        let mut bytes = good.clone().into_bytes();
        bytes[place] ^= 2;
        all.add_to_run(format!("changes with byte {place} flipped"), "changes.jsonl", bytes);
    }
    for (what, text) in files {
        all.add_to_run(format!("changes {what}"), "changes.jsonl", text);
    }
    // The change is valid, but the checkpoint of generation 2 was written without it.
    all.add_to_run("a change that was not made", "changes.jsonl", good);
}

/// Adds runs whose founders do not fit or are hostile.
fn founders(all: &mut Collection, plan: &str) {
    let genome = CHAMPION.split_once("    genome: ").expect("a genome").1;
    let genome =
        genome.split_once("    poses: ").expect("poses").0.trim_end_matches([',', ' ', '\n']);
    let torques = genome.split_once("joints: [").expect("torques").1;
    let torques = torques.trim_end_matches([')', ',', ' ', '\n']);
    let genome = |points: &str| {
        format!(
            "(body: (bend_limit_rad: 0.6, twist_limit_rad: 0.9, density_kg_m3: 2.2), controller: \
             Signal((points_per_s: {points}, joints: [{torques})))"
        )
    };
    for (what, name, genome) in [
        ("of another length", "x", genome("1.8")),
        ("of another rate", "x", genome("3.0")),
        ("of a hostile name", "../\\u{1b}[2J", genome("10.0")),
        ("of an endless name", &*"x".repeat(5_000_000), genome("10.0")),
        ("of no name", "", genome("10.0")),
        ("without a controller", "x", "(body: (bend_limit_rad: 0.6))".to_owned()),
        ("of numbers that are none", "x", genome("NaN")),
    ] {
        let founder = format!("founder: Some((name: \"{name}\", genome: {genome}))");
        let text = plan.replacen("founder: None", &founder, 1);
        assert_ne!(text, plan);
        all.add_to_run(format!("a founder {what}"), "run.ron", text);
    }
}

/// Runs the program with at most 200 MiB of memory besides its own code.
#[cfg(unix)]
fn in_little_memory(folder: &Path, arguments: &str) -> Output {
    let program = env!("CARGO_BIN_EXE_snakes");
    let code_kib = fs::metadata(program).expect("the program").len() / 1024;
    // All threads share one arena, because reserved memory counts even if it is not used.
    let script = format!("ulimit -v {}; exec {program} {arguments}", 200 * 1024 + code_kib);
    let mut command = Command::new("sh");
    command.args(["-c", &script]).current_dir(folder).env("MALLOC_ARENA_MAX", "1");
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env("HOME", folder);
    command.output().expect("sh starts")
}

/// Runs the program without a limit, because Windows cannot limit memory from a command line.
#[cfg(not(unix))]
fn in_little_memory(folder: &Path, arguments: &str) -> Output {
    super::program::run(folder, arguments)
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("created");
    for file in fs::read_dir(from).expect("a folder") {
        let file = file.expect("a file").path();
        fs::copy(&file, to.join(file.file_name().expect("a name"))).expect("copied");
    }
}

/// Makes a run that was stopped after two of its three generations, and returns its folder.
fn good_run(folder: &Path, settings: &str) -> PathBuf {
    let arguments = "--no-render --population 4 --generations 3 --duration 0.2 --out good";
    let arguments = format!("{arguments} --preset report {settings}");
    assert!(run(folder, &arguments).status.success());
    let good = run_in(&folder.join("good")).expect("a run");
    cut_log(&good, 2);
    good
}

/// Returns the fault in the program's reaction to a hostile file; `None` if it reacts correctly.
fn fault(folder: &Path, opened: OpenedAs, path: &Path) -> Option<String> {
    let arguments = match opened {
        OpenedAs::Champion => format!("replay {} --no-render", path.display()),
        OpenedAs::Preset => {
            format!("--no-render --generations 1 --out out --preset {}", path.display())
        }
        OpenedAs::Run => {
            format!("--no-render --resume {}", path.parent().expect("a run").display())
        }
    };
    let output = in_little_memory(folder, &arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    let problem = if output.status.code() != Some(1) {
        format!("ended with {:?}", output.status)
    } else if stderr.lines().count() != 1 || !stderr.starts_with("error: ") {
        "not one line of error".to_owned()
    } else if stderr.len() > 1000 {
        format!("{} bytes of error", stderr.len())
    } else if stderr.trim_end().contains(char::is_control) {
        "control characters".to_owned()
    } else if opened == OpenedAs::Run && !stderr.contains("run-") {
        "the file is not named".to_owned()
    } else {
        return None;
    };
    let start: String = stderr.chars().take(300).collect();
    Some(format!("{problem}: {start}"))
}

#[test]
fn every_hostile_file_gets_one_line_of_error_within_200_mib() {
    let folder = folder();
    let good = good_run(folder.path(), "");
    let mut all = Collection::default();
    champions(&mut all);
    presets(&mut all);
    runs(&mut all, &good);
    let faults: Vec<String> = all
        .0
        .par_iter()
        .filter_map(|Hostile { what, opened, path, bytes }| {
            let place = folder.path().join(path);
            if *opened == OpenedAs::Run {
                copy(&good, place.parent().expect("a run"));
            }
            fs::write(&place, bytes).expect("written");
            let fault = fault(folder.path(), *opened, path);
            let kept = fs::read(&place).expect("read");
            let touched = (kept != *bytes).then(|| "the file was changed".to_owned());
            fs::remove_file(&place).expect("removed");
            let fault = fault.or(touched)?;
            Some(format!("{opened:?}: {what}: {fault}\n"))
        })
        .collect();
    println!("{} hostile files", all.0.len());
    assert!(all.0.len() >= 200);
    assert!(faults.is_empty(), "{} of {}:\n{}", faults.len(), all.0.len(), faults.concat());
    assert!(!folder.path().join("out").exists(), "no run was started");
}

#[test]
fn damaged_checkpoints_of_every_strategy_are_refused() {
    let nonsense = [
        ("point: [", "point: [1.0, "),
        ("point: [", "point: [NaN, "),
        ("point: [", "point: [1.0e300, "),
        ("step: 0.", "step: 7000000."),
        ("step: 0.", "step: -0."),
        ("population: 4", "population: 4000000000"),
        ("population: 4", "population: 5"),
        ("population: 4", "population: 0"),
        ("mean: [", "mean: [0.5, "),
        ("mean: [", "mean: [inf, "),
        ("covariance: [", "covariance: [-"),
        ("covariance: [", "covariance: [1.0, "),
        (
            "elites: [(",
            "elites: [(99999, (fitness: 1.0, generation: 1, individual: 0, point: [])), (",
        ),
        ("fitness: ", "fitness: 1.0e30, x: "),
        ("archive: [(", "archive: [(2.0, 0.0, 0.0), ("),
        ("front: [", "front: [1, "),
        ("terms: [(", "terms: [(1.0e9, 0.0), ("),
        ("contact_duty: ", "contact_duty: NaN, x: "),
    ];
    let mut tried = 0;
    for strategy in ["ga", "cma_es", "map_elites", "novelty", "random"] {
        let folder = folder();
        // The budget is smaller than CMA-ES with restarts could use.
        let share = if strategy == "map_elites" { "--set cma_share=1" } else { "" };
        let settings = format!(
            "--set controller=gait --set strategy={strategy} {share} --set health.joint_drift_m=1"
        );
        let good = good_run(folder.path(), &settings);
        let checkpoint = fs::read_to_string(good.join("checkpoint-2.ron")).expect("read");
        for (number, (from, to)) in nonsense.iter().enumerate() {
            if !checkpoint.contains(from) {
                continue;
            }
            let path = PathBuf::from(format!("run-{number}")).join("checkpoint-2.ron");
            let place = folder.path().join(&path);
            copy(&good, place.parent().expect("a run"));
            fs::write(&place, checkpoint.replacen(from, to, 1)).expect("written");
            let fault = fault(folder.path(), OpenedAs::Run, &path);
            assert_eq!(fault, None, "{strategy}: {to}");
            tried += 1;
        }
    }
    assert!(tried >= 30, "only {tried} replacements applied");
}

#[cfg(unix)]
#[test]
fn links_folders_and_pipes_in_place_of_files_are_refused() {
    use std::os::unix::fs::symlink;

    let folder = folder();
    let good = good_run(folder.path(), "");
    let secret = folder.path().join("secret");
    fs::write(&secret, "do not touch").expect("written");
    let files = "run.ron log.jsonl checkpoint-2.ron generation-1.ron evaluations.jsonl changes.jsonl lock lock-owner";
    let mut number = 0;
    for file in files.split(' ') {
        for kind in ["link", "link to itself", "link to a good one", "folder", "pipe"] {
            number += 1;
            let path = PathBuf::from(format!("run-{number}")).join(file);
            let place = folder.path().join(&path);
            copy(&good, place.parent().expect("a run"));
            let _ = fs::remove_file(&place);
            match kind {
                "link" => symlink(&secret, &place).expect("linked"),
                "link to itself" => symlink(&place, &place).expect("linked"),
                "link to a good one" => symlink(good.join(file), &place).expect("linked"),
                "folder" => fs::create_dir(&place).expect("created"),
                _ => {
                    assert!(Command::new("mkfifo").arg(&place).status().expect("mkfifo").success())
                }
            }
            let fault = fault(folder.path(), OpenedAs::Run, &path);
            assert_eq!(fault, None, "{file} is a {kind}");
        }
    }
    assert_eq!(fs::read_to_string(&secret).expect("read"), "do not touch");
    // A user may name a link to a file, but not a folder, and not a pipe, which might never end.
    assert!(
        Command::new("mkfifo").arg(folder.path().join("pipe")).status().expect("mkfifo").success()
    );
    for path in ["pipe", "good", "/dev/zero"] {
        for opened in [OpenedAs::Champion, OpenedAs::Preset] {
            assert_eq!(fault(folder.path(), opened, Path::new(path)), None, "{path}");
        }
    }
}
