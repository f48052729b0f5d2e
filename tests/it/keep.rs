//! Finished generations survive a kill, a full disk, and a second program.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
#[cfg(unix)]
use std::process::Command;
use std::process::Stdio;
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use rand::RngExt;
use serde_json::{Value, json};
use snakes_core::evolve::RunPlan;
use snakes_core::rng::{Purpose, stream};
use snakes_core::save::{ExistingRun, SavesFolder, load_preset};
use snakes_lab::run::{LocalPool, RecordedRun, RunControl, RunSource};

use super::program::{cut_log, folder, json_lines, json_of, run, run_in, snakes, with_slashes};

/// Flags of a run so short that it spends most of its time with writing.
const TINY: &str = "--no-render --json --preset report --population 4 --generations 40 --duration 0.2 \
                    --threads 2";
/// Settings with which bodies evolve in a tiny run.
const WITH_BODIES: &str = "--set controller=gait --set bodies.vary=true --set limbs_max=3";

/// Settings for stairs that rise and fall every few generations.
const WITH_LADDER: &str = "--set stairs.steps=1 --set first_riser_y_m=-2.2 --set ladder.first_rise_m=0.1 \
                           --set ladder.step_m=0.1 --set ladder.share=0.3 --set ladder.way=0.01 --set patience=1";

/// Settings for soft blocks in a tiny run, without and with bodies that evolve. The report's snake weighs half a kilogram per m³,
/// so that its blocks are rigid from 4,600 Pa on.
const WITH_SOFT_BLOCKS: &str = "--set youngs_modulus_pa=2000";
const WITH_SOFT_BODIES: &str = "--set bodies.soft=true";

/// Settings with which creatures evolve in a tiny run.
const WITH_CREATURES: &str =
    "--set controller=part_neurons --set bodies.vary=true --set parts_max=4";

/// Settings with which stairs evolve in a tiny run, through all phases of a round.
const WITH_PAIRS: &str = "--set pairs=3 --set pair_candidates=4 --set learn_generations=1 --set transfers=1 \
                          --set reproduces_from=0 --set too_hard_below=0 --set too_easy_above=1.1";
const WITH_QUEUES: &str = "--set criterion=0.05 --set snake_queue=4 --set snake_children=2 --set stairs_queue=2 \
                           --set stairs_children=1 --set uses_of_stairs=2 --set first_snakes=2";

/// Number of runs that are killed: each of seventeen kinds of run six times.
const ROUNDS: usize = 102;

/// Returns the number of complete lines in a run's log.
fn finished(run: &Path) -> usize {
    let log = fs::read_to_string(run.join("log.jsonl")).unwrap_or_default();
    log.split_inclusive('\n').filter(|line| line.ends_with("\"}\n")).count()
}

/// Starts the program and kills it `delay` after it has reported `generations`. Returns the number of generations that it reported.
fn kill_after(generations: usize, delay: Duration, folder: &Path, arguments: &str) -> usize {
    let mut child = snakes(folder, arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    let lines = BufReader::new(child.stdout.take().expect("piped")).lines();
    // The pipe is read to its end, so that the program never waits for its reader.
    let (sender, reported) = mpsc::channel();
    let reader = thread::spawn(move || {
        let reports =
            lines.filter(|line| line.as_ref().is_ok_and(|line| line.contains("\"hash\"")));
        // Later reports have no receiver.
        reports
            .inspect(|_| {
                let _ = sender.send(());
            })
            .count()
    });
    reported.iter().take(generations).for_each(drop);
    thread::sleep(delay);
    // SIGKILL is a signal that the program cannot handle.
    child.kill().expect("killed");
    child.wait().expect("ended");
    reader.join().expect("read")
}

#[test]
fn a_run_killed_at_any_instant_resumes_and_ends_with_the_same_hash() {
    let saves = folder();
    let of_bodies = ["body_ga", "body_novelty", "body_map_elites", "islands", "creature_ga"];
    let strategies = ["halving", "ga", "cma_es", "map_elites", "novelty", "random"];
    let soft = ["soft cma_es", "soft body_ga"];
    let on_ladders = ["ladder cma_es"];
    let with_stairs = ["poet", "body_poet", "mcc"];
    let strategies = [&strategies[..], &of_bodies, &soft, &on_ladders, &with_stairs].concat();
    let tiny = |strategy: &str| {
        if let Some(strategy) = strategy.strip_prefix("ladder ") {
            return format!("{TINY} --set strategy={strategy} {WITH_LADDER}");
        }
        if with_stairs.contains(&strategy) {
            // Strategies that evolve stairs have larger generations.
            let tiny = TINY.replace("--population 4", "--population 100");
            let (pairs, bodies) = match strategy {
                "mcc" => (WITH_QUEUES, "--set controller=gait"),
                "poet" => (WITH_PAIRS, "--set controller=gait"),
                _ => (WITH_PAIRS, WITH_BODIES),
            };
            return format!(
                "{tiny} --set trial.fitness=share --set strategy={strategy} {pairs} {bodies}"
            );
        }
        let (strategy, is_soft) =
            strategy.strip_prefix("soft ").map_or((strategy, false), |strategy| (strategy, true));
        let softness = match strategy {
            _ if !is_soft => "",
            "body_ga" => WITH_SOFT_BODIES,
            _ => WITH_SOFT_BLOCKS,
        };
        let bodies = match strategy {
            // Only `islands` has an effective setting for the number of candidates.
            "islands" => format!("{WITH_BODIES} --set candidates=4"),
            "creature_ga" => WITH_CREATURES.to_owned(),
            of if of_bodies.contains(&of) => WITH_BODIES.to_owned(),
            _ => String::new(),
        };
        format!("{TINY} --set strategy={strategy} {bodies} {softness}")
    };
    let expected = strategies.iter().map(|strategy| {
        let lines = json_lines(
            saves.path(),
            &format!("{} --out {}", tiny(strategy), strategy.replace(' ', "-")),
        );
        lines.last().expect("lines")["run_hash"].clone()
    });
    let expected: Vec<_> = expected.collect();
    let mut rng = stream(1, 0, 0, Purpose::Calibration);
    let mut killed_on_the_way = 0;
    for round in 0..ROUNDS {
        let out = format!("out-{round}");
        // The strategies take turns.
        let (strategy, expected) =
            (strategies[round % strategies.len()], &expected[round % strategies.len()]);
        // A generation takes a few milliseconds, mostly for writing.
        let mut instant =
            || (rng.random_range(0..39), Duration::from_micros(rng.random_range(0..8000)));
        let (generations, delay) = instant();
        let command = format!("{} --out {out}", tiny(strategy));
        let reported = kill_after(generations, delay, saves.path(), &command);
        let Some(run) = run_in(&saves.path().join(&out)) else { continue };
        let after_first = finished(&run);
        assert!(after_first >= reported, "{reported} were reported, {after_first} are left");
        killed_on_the_way += usize::from((1..40).contains(&after_first));
        // The run is killed once more after it has resumed, unless the first kill came before its plan was written.
        if !run.join("run.ron").exists() {
            let lines = json_lines(saves.path(), &command);
            assert_eq!(lines.last().expect("lines")["run_hash"], *expected);
        } else {
            let resume = format!("--no-render --json --resume {} --threads 2", run.display());
            let (generations, delay) = instant();
            kill_after(generations, delay, saves.path(), &resume);
            let after_second = finished(&run);
            assert!(after_second >= after_first, "{after_first} became {after_second}");
            let lines = json_lines(saves.path(), &resume);
            let last = lines.last().expect("lines");
            assert_eq!(last["run_hash"], *expected, "round {round}, {strategy}");
        }
        let unfinished = fs::read_dir(&run).expect("a folder").map(|file| file.expect("a file"));
        let unfinished =
            unfinished.filter(|file| file.file_name().to_string_lossy().starts_with('.'));
        assert_eq!(unfinished.count(), 0, "incomplete files of a kill are removed");
    }
    assert!(killed_on_the_way * 5 >= ROUNDS * 4, "{killed_on_the_way} of {ROUNDS} on the way");
    println!("killed on the way: {killed_on_the_way} of {ROUNDS}");
}

/// Returns the plan of a tiny run of the report's preset.
fn tiny_plan(seed: u64, generations: u32) -> RunPlan {
    let mut settings = load_preset("report").expect("shipped").settings;
    settings.evolution.population = 4;
    settings.evolution.generations = generations;
    settings.trial.duration_s = 0.2;
    RunPlan::new("report", seed, settings)
}

/// Changes during a tiny run: the first generation that uses the change, the setting, the value.
const CHANGES: [(u32, &str, &str); 5] = [
    (2, "halving.parents", "2"),
    (9, "halving.mutation_range_nm", "300"),
    (9, "population", "6"),
    (21, "halving.mutation_decay", "0.9"),
    (38, "generations", "44"),
];

/// Evolves a saved run until `last` generations are finished, and makes the changes that are due.
fn evolve_changing(run: &mut RecordedRun, last: u32) {
    let pool = LocalPool::new(2).expect("threads");
    while !run.experiment.is_over() && run.experiment.finished() < last {
        let next = run.experiment.finished() + 1;
        for (_, field, value) in CHANGES.iter().filter(|(of, _, _)| *of == next) {
            let field = format!("evolution.{field}");
            let change = run.experiment.next_plan().change_of_text(next, &field, value);
            let value = change.expect("allowed").value;
            run.recorder.change_setting(&mut run.experiment, &field, value).expect("allowed");
        }
        let report = run.experiment.run_generation(&pool, &RunControl::default());
        run.recorder
            .record_generation(&run.experiment, &report.expect("not cancelled"))
            .expect("kept");
    }
}

#[test]
fn a_changed_run_killed_at_any_instant_repeats_its_changes() {
    let saves = folder();
    let plan = tiny_plan(1, 40);
    let open = |name: &str| {
        let folder = SavesFolder::find(Some(&saves.path().join(name)));
        RunSource::in_saves(&folder, plan.clone(), ExistingRun::Keep)
            .open("a test")
            .expect("opened")
    };
    let mut whole = open("whole");
    evolve_changing(&mut whole, u32::MAX);
    assert_eq!(whole.experiment.finished(), 44);
    let expected = json!(format!("{:016x}", whole.experiment.run_hash()));
    let changes = fs::read(whole.recorder.folder().join("changes.jsonl")).expect("read");
    assert_eq!(changes.iter().filter(|byte| **byte == b'\n').count(), CHANGES.len());
    let mut rng = stream(2, 0, 0, Purpose::Calibration);
    for round in 0..12 {
        let mut begun = open(&format!("out-{round}"));
        // The run is stopped before the first change, after it, after the third change, or before the first generation.
        evolve_changing(&mut begun, [1, 3, 12, 0][round % 4]);
        let run_folder = begun.recorder.folder().to_owned();
        drop(begun);
        // The run looks as if a disk had lost the latest generations: all changes are known, and some are still due.
        fs::write(run_folder.join("changes.jsonl"), &changes).expect("written");
        if [2, 3].contains(&(round % 4)) {
            // Without a log, every change is still in the future.
            fs::remove_file(run_folder.join("log.jsonl")).expect("removed");
        }
        let resume = format!("--no-render --json --resume {} --threads 2", run_folder.display());
        for _ in 0..2 {
            let delay = Duration::from_micros(rng.random_range(0..8000));
            kill_after(rng.random_range(1..43), delay, saves.path(), &resume);
        }
        let output = run(saves.path(), &resume);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "round {round}: {stderr}");
        let second = stderr.lines().nth(1).unwrap_or_default();
        let told = "changed during the run: halving.parents 2 from generation 2, halving.mutation_range_nm 300";
        assert!(second.starts_with(told), "{stderr}");
        let lines = json_of(&output.stdout);
        assert_eq!(lines.len(), 45, "44 generations");
        assert_eq!(lines[44]["run_hash"], expected, "round {round}");
        let kept = fs::read(run_folder.join("changes.jsonl")).expect("read");
        assert_eq!(kept, changes, "no change is written twice");
    }
}

#[test]
fn the_same_command_continues_a_stopped_run_and_restart_starts_over() {
    let saves = folder();
    let whole = json_lines(saves.path(), &format!("{TINY} --out whole"));
    json_lines(saves.path(), &format!("{TINY} --out out"));
    let run_folder = run_in(&saves.path().join("out")).expect("a run");
    for (flag, goes_on) in [("", true), ("--restart", false)] {
        cut_log(&run_folder, 3);
        let output = run(saves.path(), &format!("{TINY} --out out {flag}"));
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{stderr}");
        // The complete run has removed checkpoint 3, but kept checkpoint 2.
        assert_eq!(stderr.contains("continues after generation 2"), goes_on, "{stderr}");
        let lines = json_of(&output.stdout);
        assert_eq!(lines.last().expect("lines")["run_hash"], whole[40]["run_hash"]);
    }
}

#[test]
fn a_second_program_on_the_same_run_is_refused_with_the_owners_name() {
    let saves = folder();
    let arguments = "--no-render --preset report --population 4 --generations 2 --duration 0.2 --out out --seed 3";
    let out = SavesFolder::find(Some(&saves.path().join("out")));
    let source = RunSource::in_saves(&out, tiny_plan(3, 2), ExistingRun::Keep);
    let held = source.open("the studio").expect("opened");
    let output = run(saves.path(), arguments);
    assert_eq!(output.status.code(), Some(1));
    let message = with_slashes(&String::from_utf8_lossy(&output.stderr));
    let owner = format!("in use by process {} (the studio)", std::process::id());
    assert!(
        message.starts_with("error: out/report-seed3-") && message.contains(&owner),
        "{message}"
    );
    assert_eq!(message.lines().count(), 1, "{message}");
    drop(held);
    assert!(run(saves.path(), arguments).status.success());
}

/// Returns the only error on standard error.
#[cfg(unix)]
fn error_of(output: &std::process::Output) -> String {
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    let errors: Vec<&str> = stderr.lines().filter(|line| line.starts_with("error: ")).collect();
    assert_eq!(errors.len(), 1, "{stderr}");
    errors[0].to_owned()
}

/// Resumes a run, which must end with the hash of an undisturbed run.
#[cfg(unix)]
fn resumes_to_the_same_end(saves: &Path, run: &Path) {
    assert!((1..40).contains(&finished(run)), "it was stopped before its end: {}", finished(run));
    let resumed = json_lines(saves, &format!("--no-render --json --resume {}", run.display()));
    let whole = json_lines(saves, &format!("{TINY} --out whole"));
    assert_eq!(resumed[40]["run_hash"], whole[40]["run_hash"]);
}

/// The size of files is limited, and the log reaches the limit in the middle of the run.
#[cfg(unix)]
#[test]
fn a_log_that_cannot_grow_ends_the_run_with_an_error_and_the_run_can_be_resumed() {
    let saves = folder();
    let program = env!("CARGO_BIN_EXE_snakes");
    // The unit of the limit is 512 bytes. The signal is ignored, so that writing returns an error.
    let script = format!("trap '' XFSZ; ulimit -f 16; exec {program} {TINY} --out out");
    let output = Command::new("sh")
        .args(["-c", &script])
        .current_dir(saves.path())
        .output()
        .expect("sh starts");
    let run = run_in(&saves.path().join("out")).expect("a run");
    let error = error_of(&output);
    assert!(error.contains("log.jsonl: cannot be written: File too large"), "{error}");
    let safe = format!("generations up to {} are saved", finished(&run));
    assert!(
        error.contains(&safe)
            && error.contains("continue the run with: snakes --no-render --resume out/"),
        "{error}"
    );
    resumes_to_the_same_end(saves.path(), &run);
}

/// The disk is really full. The test needs a private mount, and is skipped where the system does not allow one.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_ends_the_run_with_an_error_and_the_run_can_be_resumed() {
    let saves = folder();
    let program = env!("CARGO_BIN_EXE_snakes");
    let script = format!(
        "mount -t tmpfs -o size=192k none small || exit 99; \
         {program} {TINY} --out small/out; code=$?; cp -r small/out kept; exit $code"
    );
    fs::create_dir(saves.path().join("small")).expect("created");
    let output = Command::new("unshare")
        .args(["--user", "--map-root-user", "--mount", "sh", "-c", &script])
        .current_dir(saves.path())
        .output();
    let refused = |output: &std::process::Output| {
        let stderr = String::from_utf8_lossy(&output.stderr);
        output.status.code() == Some(99) || stderr.starts_with("unshare: ")
    };
    let output = match output {
        Ok(output) if !refused(&output) => output,
        other => return eprintln!("no private mount here, skipped: {other:?}"),
    };
    let error = error_of(&output);
    assert!(error.contains("No space left on device"), "{error}");
    assert!(
        error.contains("are saved; continue the run with: snakes --no-render --resume small/out/"),
        "{error}"
    );
    let run = run_in(&saves.path().join("kept")).expect("a run");
    resumes_to_the_same_end(saves.path(), &run);
}

#[test]
fn a_runs_folder_contains_its_plan_logs_checkpoints_and_champions() {
    let saves = folder();
    let lines = json_lines(saves.path(), &format!("{TINY} --out out"));
    let run = run_in(&saves.path().join("out")).expect("a run");
    let mut files: Vec<String> = fs::read_dir(&run)
        .expect("a folder")
        .map(|file| file.expect("a file").file_name().to_string_lossy().into_owned())
        .filter(|name| !name.starts_with("generation-"))
        .collect();
    files.sort();
    let kept = [1, 16, 2, 32, 39, 4, 40, 8].map(|number| format!("checkpoint-{number}.ron"));
    assert_eq!(files[..8], kept, "{files:?}");
    assert_eq!(files[8..], ["lineage.jsonl", "lock", "lock-owner", "log.jsonl", "run.ron"]);
    let log = fs::read_to_string(run.join("log.jsonl")).expect("read");
    for (line, printed) in log.lines().zip(&lines) {
        let line: Value = serde_json::from_str(line).expect("JSON");
        assert_eq!(line["hash"], printed["hash"]);
        assert_eq!(line["statistics"]["mean"], printed["mean"]);
        assert_eq!(line["crashed"], json!(0));
    }
}
