//! The program without a window, run as a child process.

use serde_json::json;
use snakes_core::evolve::StrategyKind;
use snakes_core::save::load_preset;
use snakes_core::world::{LANES, VectorLevel};

use super::program::{
    CLIMBER, cut_log, folder, json_lines, json_of, run, snakes, stdout_of, with_slashes,
};

const SMALL: &str =
    "--no-render --set newborns=0 --population 8 --generations 3 --duration 1 --seed 4";

#[test]
fn a_run_prints_a_table_and_saves_a_champion_that_replays_exactly() {
    let folder = folder();
    let table = stdout_of(folder.path(), &format!("{SMALL} --out out"));
    let rows: Vec<&str> = table.lines().collect();
    assert!(rows[0].starts_with("generation     mean     best   median"), "{table}");
    for (row, generation) in rows[1..4].iter().zip(["1", "2", "3"]) {
        assert_eq!(row.split_whitespace().next(), Some(generation), "{table}");
    }
    let path = rows.iter().find_map(|row| row.strip_prefix("saved to  ")).expect("a champion file");
    let replay = stdout_of(folder.path(), &format!("replay {path} --no-render"));
    assert!(replay.contains("equal to the record, bit for bit"), "{replay}");
}

#[test]
fn json_lines_have_the_documented_fields() {
    let folder = folder();
    let lines = json_lines(folder.path(), &format!("{SMALL} --json --out out"));
    assert_eq!(lines.len(), 4);
    for line in &lines[..3] {
        let keys = line.as_object().expect("an object").keys().map(String::as_str);
        let mut keys: Vec<&str> = keys.collect();
        keys.sort_unstable();
        let documented = "best crashed disqualified elapsed_s endings evaluations first_landing generation hash mean \
                          meaning median on_landing simulations std type worst";
        assert_eq!(keys.join(" "), documented);
        // Two candidates for champion take nine trials each.
        assert_eq!((&line["evaluations"], &line["simulations"]), (&json!(8), &json!(26)));
    }
    let last = &lines[3];
    assert_eq!((&last["evaluations"], &last["simulations"]), (&json!(24), &json!(78)));
    assert_eq!(last["type"], json!("done"));
    assert_eq!(last["run_hash"].as_str().map(str::len), Some(16));
    let best = lines[..3].iter().map(|line| line["best"].as_f64().expect("a number"));
    assert_eq!(last["best"].as_f64(), best.reduce(f64::max));
    let champion = last["champion"].as_str().expect("a path");
    let replay = json_lines(folder.path(), &format!("replay {champion} --no-render --json"));
    assert_eq!(replay[0]["matches"], json!(true));
    assert_eq!(replay[0]["trace_hash"], replay[0]["recorded_trace_hash"]);
    assert_eq!(replay[0]["fitness"], last["best"]);
}

#[test]
fn a_replay_that_differs_from_its_record_fails() {
    let folder = folder();
    let lines = json_lines(folder.path(), &format!("{SMALL} --json --out out"));
    let path = folder.path().join(lines[3]["champion"].as_str().expect("a path"));
    let text = std::fs::read_to_string(&path).expect("read");
    let weaker = text.replace("max_bend_torque_nm: 1000.0", "max_bend_torque_nm: 900.0");
    assert_ne!(text, weaker);
    std::fs::write(&path, weaker).expect("written");
    let output = run(folder.path(), &format!("replay {} --no-render --json", path.display()));
    assert_eq!(output.status.code(), Some(1));
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(message.contains("replay differs from the record"), "{message}");
    assert_eq!(message.lines().count(), 1, "{message}");
    assert!(String::from_utf8_lossy(&output.stdout).contains("\"matches\":false"));
}

#[test]
fn saves_go_to_the_working_directorys_saves_folder_or_else_to_the_data_folder() {
    let folder = folder();
    let champion = |folder| {
        let lines = json_lines(folder, &format!("{SMALL} --json"));
        with_slashes(lines[3]["champion"].as_str().expect("a path"))
    };
    // On Windows the data folder cannot be redirected, and a test must not write into the user's folder.
    if cfg!(not(windows)) {
        let elsewhere = champion(folder.path());
        assert!(elsewhere.contains("data/snakes-and-stairs/saves"), "{elsewhere}");
    }
    std::fs::create_dir(folder.path().join("saves")).expect("created");
    let here = champion(folder.path());
    assert!(here.starts_with("saves/"), "{here}");
}

#[test]
fn a_run_from_a_champion_is_at_least_as_good_and_can_be_resumed() {
    let folder = folder();
    let small = "--population 6 --generations 2 --out out";
    let arguments = format!("--no-render --json --from {CLIMBER} --set strategy=halving {small}");
    let output = run(folder.path(), &arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{stderr}");
    assert!(stderr.contains("seed 1, from climber: generations 2"), "{stderr}");
    let lines = json_of(&output.stdout);
    let replay = json_lines(folder.path(), &format!("replay {CLIMBER} --no-render --json"));
    let reached = replay[0]["fitness"].as_f64().expect("a number");
    assert!(lines[0]["best"].as_f64().expect("a number") >= reached, "{lines:?}");
    let champion = with_slashes(lines[2]["champion"].as_str().expect("a path"));
    let its_folder = champion.rsplit_once('/').expect("a folder").0;
    cut_log(&folder.path().join(its_folder), 1);
    let resumed = json_lines(folder.path(), &format!("--no-render --json --resume {its_folder}"));
    assert_eq!(resumed[2]["run_hash"], lines[2]["run_hash"]);
    // A run without the champion as its founder is another run.
    let without = format!("--no-render --json --set strategy=halving {small}");
    let without = json_lines(folder.path(), &without);
    assert_ne!(
        without[2]["champion"].as_str().and_then(|path| path.rsplit_once('/')).map(|p| p.0),
        Some(its_folder)
    );
}

#[test]
fn a_run_from_a_champion_works_with_every_strategy() {
    let folder = folder();
    for strategy in ["halving", "ga", "cma_es", "map_elites", "novelty", "random"] {
        let small = "--population 8 --generations 2 --duration 1 --out out";
        let arguments =
            format!("--no-render --json --from {CLIMBER} --set strategy={strategy} {small}");
        let lines = json_lines(folder.path(), &arguments);
        assert_eq!(lines[2]["type"], json!("done"), "{strategy}");
    }
}

#[test]
fn a_file_that_a_run_cannot_begin_from_is_refused_with_the_reason() {
    let folder = folder();
    let no_champion = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/presets/mud.ron");
    for (arguments, code, complaint) in [
        (
            format!("--from {CLIMBER} --set agent.limbs=7"),
            2,
            "founder.controller joints is 4; allowed: 6",
        ),
        (
            format!("--from {CLIMBER} --set controller=signal"),
            2,
            "founder.controller is gait; allowed: signal",
        ),
        ("--from nosuch.ron".to_owned(), 1, "nosuch.ron: cannot be read"),
        (format!("--from {no_champion}"), 1, "mud.ron: kind is \"\""),
        (format!("--from {CLIMBER} --resume x"), 2, "cannot be used with"),
    ] {
        let output = run(folder.path(), &format!("--no-render --out out {arguments}"));
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(message.contains(complaint), "{message}");
        assert_eq!(message.lines().count(), 1, "{message}");
        assert_eq!(output.status.code(), Some(code), "{message}");
        assert!(!folder.path().join("out").exists(), "no run was started");
    }
}

#[test]
fn presets_are_listed_with_their_descriptions() {
    let folder = folder();
    let list = stdout_of(folder.path(), "show presets");
    assert!(list.lines().any(|line| line.starts_with("report") && line.len() > 80), "{list}");
    assert!(list.lines().any(|line| line.starts_with("quick")), "{list}");
}

#[test]
fn the_users_own_preset_file_is_used() {
    let folder = folder();
    let quick = include_str!("../../assets/presets/quick.ron");
    let own = quick
        .replace("name: \"quick\"", "name: \"own\"")
        .replace("population: 60", "population: 5");
    std::fs::write(folder.path().join("own.ron"), own).expect("written");
    let arguments = "--no-render --json --preset own.ron --generations 1 --duration 0.5 --out out";
    let lines = json_lines(folder.path(), arguments);
    assert_eq!(lines[0]["evaluations"], json!(5));
    assert!(lines[1]["champion"].as_str().expect("a path").contains("own-seed1-"));
}

#[test]
fn every_preset_runs() {
    let folder = folder();
    for preset in json_lines(folder.path(), "show presets --json") {
        let name = preset["name"].as_str().expect("a name");
        let size = "--population 20 --generations 1 --duration 1";
        let strategy = load_preset(name).expect("shipped").settings.evolution.strategy;
        let small = match strategy {
            StrategyKind::CmaEs => "--set newborns=0",
            StrategyKind::Islands => "--set candidates=10 --set limbs_max=3",
            _ => "",
        };
        let arguments = format!("--no-render --json --preset {name} {size} {small} --out out");
        let lines = json_lines(folder.path(), &arguments);
        // POET begins with a quarter of the evaluations, at random.
        let first = if strategy == StrategyKind::Poet { 5 } else { 20 };
        assert_eq!(lines[0]["evaluations"], json!(first), "{name}");
        assert_eq!(lines[1]["type"], json!("done"), "{name}");
    }
}

#[test]
fn a_single_setting_and_the_fitness_can_be_set_by_flag() {
    let folder = folder();
    let arguments =
        "show settings --json --set surface.friction=0.8 --set gravity_m_s2=1.62 --fitness head";
    let settings = &json_lines(folder.path(), arguments)[0]["settings"];
    assert_eq!(settings["trial"]["surface"]["friction"], json!(0.8), "the fewest digits");
    assert_eq!(settings["trial"]["fitness"], json!("head"));
    let list = stdout_of(folder.path(), "show settings --preset ice");
    let line = list.lines().find(|line| line.starts_with("trial.surface.friction"));
    assert!(line.is_some_and(|line| line.ends_with("= 0.03")), "{list}");
}

#[test]
fn table_1_is_printed_and_written_as_csv_and_png() {
    let folder = folder();
    let arguments =
        "study table1 --seeds 2 --population 6 --generations 2 --duration 0.5 --out out";
    let text = stdout_of(folder.path(), arguments);
    assert!(text.contains("| published |"), "{text}");
    assert!(text.contains("-5.94 |  slightly forward"), "{text}");
    assert!(text.contains("| runs: mean rises"), "{text}");
    let written = |name: &str| std::fs::read(folder.path().join("out").join(name)).expect(name);
    let csv = String::from_utf8(written("table1-runs.csv")).expect("text");
    assert_eq!(csv.lines().count(), 3, "{csv}");
    assert!(csv.starts_with("study,arm,seed,evaluations,simulations,fitness,"), "{csv}");
    assert!(csv.contains("\ntable1,report,211,12,12,"), "{csv}");
    let png = written("table1.png");
    assert!(png.starts_with(b"\x89PNG") && png.len() > 5_000);
    let lines = json_lines(folder.path(), &format!("{arguments} --json"));
    assert_eq!((lines[0]["seed"].clone(), lines[1]["seed"].clone()), (json!(211), json!(212)));
    assert_eq!(lines.last().map(|line| line["runs"].clone()), Some(json!(2)));
}

#[test]
fn robustness_prints_a_share_with_its_interval_for_each_step() {
    let folder = folder();
    let save = concat!(env!("CARGO_MANIFEST_DIR"), "/saves/first-climber.ron");
    let text = stdout_of(folder.path(), &format!("exam {save} --trials 20"));
    assert!(
        text.contains("first-climber.ron: 20 trials from seed 1: friction ±20 %, rise ±10 %"),
        "{text}"
    );
    let is_share = |line: &&str| line.contains(" to ") && line.ends_with(" %");
    assert_eq!(text.lines().filter(is_share).count(), 10, "{text}");
    assert!(text.contains("| champion      | suite  |"), "{text}");
    let still = "--off-friction 0 --off-rise 0 --off-start 0 --off-turn 0";
    let lines = json_lines(folder.path(), &format!("exam {save} --trials 3 {still} --json"));
    assert_eq!(lines[0]["share"], json!(1.0));
    assert_eq!(lines[9]["disqualified"], json!(0));
    assert_eq!(lines[9]["matches"], json!(true), "the record is as it was written");
    assert_eq!((&lines[10]["type"], &lines[10]["trials"]), (&json!("endings"), &json!(3)));
    assert_eq!(lines[10]["endings"][0]["trials"], json!(3), "all end alike: {}", lines[10]);
    let output = run(folder.path(), &format!("exam {save} --trials 3 --off-rise 2"));
    assert_eq!(output.status.code(), Some(2));
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(message.trim_end(), "error: --off-rise is 2; allowed: 0 to 0.9");
}

#[test]
fn robustness_says_that_a_champion_does_not_replay_to_its_record() {
    let folder = folder();
    let save = include_str!("../../saves/first-climber.ron");
    let fitness = save.find("fitness: ").expect("a record") + "fitness: ".len();
    let edited = format!("{}9{}", &save[..fitness], &save[fitness..]);
    std::fs::write(folder.path().join("edited.ron"), edited).expect("written");
    let output = run(folder.path(), "exam edited.ron --trials 1 --json");
    assert_eq!(output.status.code(), Some(0), "its genes can still be measured");
    let said = String::from_utf8_lossy(&output.stderr);
    let start = "warning: edited.ron: does not replay to its record: fitness ";
    assert!(said.contains(start) && said.contains("the file was edited"), "{said}");
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(text.contains(r#""matches":false"#), "{text}");
}

#[test]
fn a_champion_that_does_not_replay_is_exported_with_the_result_that_it_has_here() {
    let folder = folder();
    let save = include_str!("../../saves/first-climber.ron");
    let hash = "trace_hash: \"";
    let place = save.find(hash).expect("a record") + hash.len();
    let edited = format!("{}0000{}", &save[..place], &save[place + 4..]);
    std::fs::write(folder.path().join("edited.ron"), edited).expect("written");
    let output = run(folder.path(), "export edited.ron -o model.xml");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(said.contains("edited is exported with the result that it has here: "), "{said}");
    let model = std::fs::read_to_string(folder.path().join("model.xml")).expect("written");
    let own = &save[place..place + 16];
    assert!(model.contains(own), "its own hash, {own}, is not in the model");
}

#[test]
fn the_bench_reports_its_figures() {
    let folder = folder();
    let figures = &json_lines(folder.path(), "bench --threads 1 --json")[0];
    assert_eq!(figures["engine"], "lanes", "{figures}");
    assert_eq!(figures["lanes"], LANES, "{figures}");
    assert_eq!(figures["simd"], VectorLevel::in_use().name(), "{figures}");
    for field in ["steps_per_s", "sim_s_per_s", "sim_s_per_s_per_thread", "ratio_to_bare_rapier"] {
        assert!(figures[field].as_f64().expect(field) > 0.0, "{figures}");
    }
}

#[test]
fn vector_instructions_that_this_machine_does_not_have_are_refused() {
    let folder = folder();
    let mut command = snakes(folder.path(), "show presets");
    let output = command.env("SNAKES_SIMD", "mmx").output().expect("the program starts");
    let said = String::from_utf8_lossy(&output.stderr);
    let names: Vec<_> = VectorLevel::all().iter().map(|level| level.name()).collect();
    let expected = format!("SNAKES_SIMD is mmx; allowed: {}", names.join(", "));
    assert!(output.status.code() == Some(2) && said.contains(&expected), "{said}");
}

#[test]
fn the_bench_takes_a_champion() {
    let folder = folder();
    let save = include_str!("../../saves/first-climber.ron");
    std::fs::write(folder.path().join("climber.ron"), save).expect("written");
    let figures = &json_lines(folder.path(), "bench climber.ron --threads 1 --json")[0];
    assert!(figures["sim_s_per_s"].as_f64().expect("a rate") > 0.0, "{figures}");
    let output = run(folder.path(), "bench climber.ron --set limbs=3");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success() && said.contains("--set"), "{said}");
}

#[cfg(unix)]
#[test]
fn the_interrupt_key_ends_a_run_and_keeps_its_finished_generations() {
    use std::io::{BufRead, BufReader, Read};
    use std::process::Stdio;

    let folder = folder();
    let arguments =
        "--no-render --json --population 200 --generations 10000 --duration 1 --out out";
    let mut child = snakes(folder.path(), arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut lines = BufReader::new(child.stdout.take().expect("piped")).lines();
    assert!(lines.next().expect("a generation").expect("a line").contains("\"generation\":1"));
    let pid = child.id().to_string();
    std::process::Command::new("kill").args(["-INT", &pid]).status().expect("kill");
    let _ = lines.by_ref().count();
    let mut stderr = String::new();
    child.stderr.take().expect("piped").read_to_string(&mut stderr).expect("read");
    assert_eq!(child.wait().expect("ended").code(), Some(1), "{stderr}");
    assert!(
        stderr.contains("cancelled after generation ")
            && stderr.contains("continue it with: snakes --no-render --resume out/climb-seed1-"),
        "{stderr}"
    );
    assert!(std::fs::read_dir(folder.path().join("out")).expect("a folder").count() >= 1);
}
