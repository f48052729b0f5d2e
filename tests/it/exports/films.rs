//! Films: their frames show the right moments, other programs can open their files, and an unfinished film leaves nothing behind.
//!
//! The tests need Debian's `mesa-vulkan-drivers` and `ffmpeg`. Without them they are skipped with a line, or fail if
//! `SNAKES_PEER_TESTS=required` is set.

use std::fs;
use std::io::BufReader;
use std::io::Write;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::program::{folder, interruptible_snakes, run, snakes, stdout_of};

/// A champion that climbs the stairs in 15 s.
const CLIMBER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/saves/climber.ron");
/// Another champion that climbs the stairs.
const FAST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/saves/fast.ron");

/// Returns whether something is missing that films need. The test is then skipped.
pub fn lacks(test: &str, needs_ffmpeg: bool) -> bool {
    let drivers = ["/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d"];
    let has_files = |folder: &&str| fs::read_dir(folder).is_ok_and(|mut of| of.next().is_some());
    let has_ffmpeg = || ["ffmpeg", "ffprobe"].into_iter().all(is_installed);
    let missing = if !drivers.iter().any(has_files) {
        "no Vulkan driver is installed"
    } else if needs_ffmpeg && !has_ffmpeg() {
        "ffmpeg is not installed"
    } else {
        return false;
    };
    let required = std::env::var("SNAKES_PEER_TESTS").is_ok_and(|value| value == "required");
    assert!(!required, "{test}: {missing}");
    // The line bypasses the test harness, which would hide it if the test passes.
    let _ = writeln!(std::io::stderr(), "skipped: {test}: {missing}");
    true
}

fn is_installed(tool: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join(tool).is_file())
}

/// Returns the names in a folder, sorted, without the program's data.
fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let names = entries.map(|of| of.expect("one").file_name().to_string_lossy().into_owned());
    let mut names: Vec<String> = names.filter(|name| name != "data").collect();
    names.sort();
    names
}

/// Returns the exit code and the only line of an error. The size of a GIF may be told before it.
fn refusal(output: &Output) -> (Option<i32>, String) {
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    let is_size = |line: &&str| line.starts_with("about ") && line.ends_with(" MB");
    let lines: Vec<&str> = text.lines().filter(|line| !is_size(line)).collect();
    assert_eq!(lines.len(), 1, "{text}");
    (output.status.code(), lines[0].to_owned())
}

#[test]
fn a_gif_has_the_frames_the_size_and_the_time_that_were_ordered_and_its_snake_moves() {
    if lacks("gif", false) {
        return;
    }
    let folder = folder();
    let order = format!("export {CLIMBER} -o a.gif --size 160x90 --fps 20 --start 2 --end 2.5");
    assert_eq!(stdout_of(folder.path(), &order), "saved to a.gif\n");
    let file = fs::File::open(folder.path().join("a.gif")).expect("written");
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::Indexed);
    let mut reader = options.read_info(BufReader::new(file)).expect("a GIF");
    assert_eq!((reader.width(), reader.height()), (160, 90));
    assert_eq!(reader.global_palette().map(<[u8]>::len), Some(256 * 3), "one palette for all");
    let (mut frames, mut hundredths, mut changed) = (0, 0, Vec::new());
    while let Some(frame) = reader.read_next_frame().expect("whole") {
        frames += 1;
        hundredths += frame.delay;
        assert!(frame.palette.is_none());
        let is_new = |index: &&u8| frame.transparent != Some(**index);
        changed.push(frame.buffer.iter().filter(is_new).count());
    }
    assert_eq!((frames, hundredths), (10, 50));
    assert_eq!(changed[0], 160 * 90, "the first frame is whole");
    let rest = &changed[1..];
    assert!(rest.iter().all(|count| *count > 300 && *count < 160 * 90), "{changed:?}");
    assert_eq!(names_in(folder.path()), ["a.gif"]);
}

#[test]
fn a3_a_gif_shows_only_the_climb_and_its_size_is_told_before_it_is_written() {
    if lacks("small gif", false) {
        return;
    }
    let folder = folder();
    let order = format!("export {CLIMBER} -o a.gif --size 128x72 --speed 8 --json");
    let said = stdout_of(folder.path(), &order);
    let lines: Vec<Value> =
        said.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let told = lines.iter().position(|line| line["type"] == "expected").expect("a size");
    // Frames are sampled before the size is told, and many more are written afterwards.
    let shares = |lines: &[Value]| lines.iter().filter(|line| line["progress"].is_f64()).count();
    assert!(shares(&lines[told..]) > 2 * shares(&lines[..told]), "{said}");
    let expected = lines[told]["bytes"].as_f64().expect("bytes");
    let written = fs::metadata(folder.path().join("a.gif")).expect("written").len() as f64;
    assert!((0.6..1.6).contains(&(written / expected)), "{written} instead of {expected}");
    let file = fs::File::open(folder.path().join("a.gif")).expect("written");
    let mut reader = gif::DecodeOptions::new().read_info(BufReader::new(file)).expect("a GIF");
    let mut hundredths = 0;
    while let Some(frame) = reader.read_next_frame().expect("whole") {
        hundredths += u32::from(frame.delay);
    }
    // The trial lasts 15 s, and the snake lands before.
    let shown_s = f64::from(hundredths) / 100.0 * 8.0;
    assert!((6.0..14.5).contains(&shown_s), "{shown_s} s");
}

#[test]
fn frames_show_the_moment_that_a_single_picture_of_it_shows() {
    if lacks("frames", false) {
        return;
    }
    let folder = folder();
    let size = "--size 320x180 --camera side --theme dark --show contacts,line";
    // A film of one frame equals the picture of its moment.
    let order =
        format!("export {CLIMBER} -o a.png {size} --start 6 --end 6.01 --fps 10 --no-captions");
    assert_eq!(stdout_of(folder.path(), &order), "saved to a-frames\n");
    assert_eq!(names_in(&folder.path().join("a-frames")), ["a-0001.png"]);
    stdout_of(folder.path(), &format!("export {CLIMBER} -o single.png {size} --at 6"));
    let single = pixels(&folder.path().join("single.png"));
    assert_eq!(pixels(&folder.path().join("a-frames/a-0001.png")), single);
    // An existing folder with files is never replaced.
    let again = run(folder.path(), &format!("export {CLIMBER} -o a.png --start 6 --end 6.01"));
    let (code, line) = refusal(&again);
    assert_eq!(code, Some(1), "{line}");
    assert!(line.contains("a-frames: cannot be written: it exists already"), "{line}");
}

/// Returns the pixels of a PNG file.
fn pixels(path: &Path) -> Vec<u8> {
    let file = fs::File::open(path).expect("a picture");
    let mut reader = png::Decoder::new(BufReader::new(file)).read_info().expect("a PNG");
    let mut bytes = vec![0; reader.output_buffer_size().expect("small")];
    reader.next_frame(&mut bytes).expect("whole");
    bytes
}

#[test]
fn an_mp4_is_what_players_expect_and_the_same_film_has_the_same_bytes() {
    if lacks("mp4", true) {
        return;
    }
    let folder = folder();
    let order = "--size 192x108 --fps 24 --start 1 --end 1.5 --speed 0.5";
    for name in ["a", "b"] {
        let order = format!("export {CLIMBER} {FAST} -o {name}.mp4 {order} --json");
        let said = stdout_of(folder.path(), &order);
        let lines: Vec<Value> =
            said.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
        let (last, progress) = lines.split_last().expect("lines");
        assert_eq!(last["saved"], format!("{name}.mp4"));
        let shares: Vec<f64> =
            progress.iter().map(|line| line["progress"].as_f64().expect("a share")).collect();
        assert!(shares.len() > 10 && shares.is_sorted(), "{shares:?}");
    }
    let probe = Command::new("ffprobe")
        .args(["-v", "error", "-count_frames", "-show_streams", "-of", "json", "a.mp4"])
        .current_dir(folder.path())
        .output()
        .expect("ffprobe");
    let probe: Value = serde_json::from_slice(&probe.stdout).expect("JSON");
    let stream = &probe["streams"][0];
    for (field, expected) in [
        ("codec_name", "h264"),
        ("pix_fmt", "yuv420p"),
        ("avg_frame_rate", "24/1"),
        ("nb_read_frames", "24"),
        ("color_space", "bt709"),
        ("color_range", "tv"),
    ] {
        assert_eq!(stream[field], expected, "{field}");
    }
    assert_eq!((&stream["width"], &stream["height"]), (&Value::from(192), &Value::from(108)));
    assert_eq!(probe["streams"].as_array().map(Vec::len), Some(1), "no sound");
    let bytes = |name: &str| fs::read(folder.path().join(name)).expect("written");
    assert!(bytes("a.mp4") == bytes("b.mp4"), "the same film");
    let begin = bytes("a.mp4");
    let place = |tag: &[u8]| begin.windows(4).position(|bytes| bytes == tag);
    assert!(place(b"moov") < place(b"mdat"), "it plays before it is loaded");
}

#[test]
fn a_story_films_the_first_the_middle_and_the_last_generation_with_titles() {
    if lacks("story", false) {
        return;
    }
    let folder = folder();
    let small = "--no-render --population 6 --generations 4 --duration 0.5 --out run";
    stdout_of(folder.path(), small);
    let run_folder = names_in(&folder.path().join("run")).remove(0);
    let order = format!("export run/{run_folder} --story -o a.png --size 160x90 --fps 2");
    stdout_of(folder.path(), &order);
    // The film has three parts of 0.5 s, each with a still of 1.2 s at its beginning and at its end.
    let frames = names_in(&folder.path().join("a-frames"));
    assert_eq!(frames.len(), 3 * (1 + 2 + 2), "{frames:?}");
    let order = format!("export run/{run_folder} {run_folder} --story -o b.png");
    let (code, line) = refusal(&run(folder.path(), &order));
    assert_eq!(code, Some(2), "{line}");
    assert!(line.contains("--story takes one run's folder"), "{line}");
}

#[test]
fn flags_without_effect_and_values_that_are_not_allowed_are_refused_by_name() {
    let folder = folder();
    for (flags, code, problem) in [
        ("-o a.csv --fps 25", 2, "--fps has no effect with .csv"),
        ("-o a.parquet --theme dark", 2, "--theme has no effect with .parquet"),
        ("-o a.csv --story", 2, "--story has no effect with .csv"),
        ("-o a.mp4 --size 641x360", 2, "--size is 641x360; allowed: an even width"),
        ("-o a.gif --fps 60", 2, "--fps is 60; allowed: 1 to 50"),
        ("-o a.mp4 --fps 0", 2, "--fps is 0; allowed: 1 to 120"),
        ("-o a.gif --fps many", 2, "--fps is \"many\"; allowed: a whole number from 1 to 50"),
        ("-o a.gif --speed 0", 2, "--speed is 0; allowed: 0.1 to 16"),
        ("-o a.gif --camera free", 2, "--camera is \"free\"; allowed: follow, side or top"),
        ("-o a.gif --show all", 2, "--show is \"all\"; allowed: contacts"),
        ("-o a.gif --start 20", 2, "--start is 20; allowed: 0 to 15"),
        ("-o a.gif --start NaN", 2, "--start is NaN; allowed: 0 to 15"),
        (
            "-o a.gif --start 3 --end 3",
            2,
            "--end is \"3\"; allowed: more than 3, at which the film starts, up to 15",
        ),
        (
            "-o a.gif --start 3 --end 2",
            2,
            "--end is \"2\"; allowed: more than 3, at which the film starts, up to 15",
        ),
        ("-o a.avi", 2, "--output is \"a.avi\"; allowed: a name that ends in "),
    ] {
        let (given, line) = refusal(&run(folder.path(), &format!("export {CLIMBER} {flags}")));
        assert_eq!(given, Some(code), "{flags}: {line}");
        assert!(line.starts_with(&format!("error: {problem}")), "{flags}: {line}");
    }
    assert!(names_in(folder.path()).is_empty());
}

#[test]
fn a_film_that_cannot_be_written_is_one_line_and_leaves_nothing_behind() {
    if lacks("unwritable", true) {
        return;
    }
    let folder = folder();
    let short = "--size 64x64 --start 1 --end 1.1";
    for name in ["none/a.gif", "none/a.mp4", "none/a.png"] {
        let output = run(folder.path(), &format!("export {CLIMBER} -o {name} {short}"));
        let (code, line) = refusal(&output);
        assert_eq!(code, Some(1), "{line}");
        assert!(line.starts_with("error: none/a") && line.contains("cannot be written"), "{line}");
    }
    let without_programs = snakes(folder.path(), &format!("export {CLIMBER} -o a.mp4 {short}"))
        .env("PATH", folder.path())
        .output();
    let (code, line) = refusal(&without_programs.expect("it starts"));
    assert_eq!(code, Some(1));
    assert!(line.starts_with("error: a .mp4 film is written by ffmpeg, which is not"), "{line}");
    // The size of files is limited to some kilobytes, which has the effect of a full disk.
    for (name, blocks) in [("a.gif", 4), ("a.mp4", 1)] {
        let order = format!("export {CLIMBER} -o {name} --size 320x180 --start 1 --end 1.3");
        let program = env!("CARGO_BIN_EXE_snakes");
        // The signal of the limit is ignored, so that writing fails as on a full disk.
        let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec {program} {order}");
        let output = Command::new("bash")
            .args(["-c", &script])
            .current_dir(folder.path())
            .env("HOME", folder.path())
            .output();
        let (code, line) = refusal(&output.expect("bash"));
        assert_eq!(code, Some(1), "{line}");
        assert!(line.contains(name) && line.contains("cannot be written"), "{line}");
    }
    assert!(names_in(folder.path()).is_empty(), "{:?}", names_in(folder.path()));
}

#[test]
fn s11_a_film_that_ffmpeg_does_not_write_is_an_error_and_the_earlier_film_stays() {
    use std::os::unix::fs::PermissionsExt;
    if lacks("unwritten", false) {
        return;
    }
    for (script, reason) in [
        ("cat > /dev/null", "ffmpeg reports success, but has written nothing"),
        ("exit 0", "ffmpeg ended early: exit status: 0"),
        ("kill -9 $$", "ffmpeg ended early: signal: 9 (SIGKILL)"),
    ] {
        let folder = folder();
        let ffmpeg = folder.path().join("ffmpeg");
        fs::write(&ffmpeg, format!("#!/bin/sh\n{script}\n")).expect("written");
        fs::set_permissions(&ffmpeg, fs::Permissions::from_mode(0o755)).expect("runnable");
        fs::write(folder.path().join("a.mp4"), "an earlier film").expect("written");
        let own = std::env::var("PATH").unwrap_or_default();
        let order = format!("export {CLIMBER} -o a.mp4 --size 160x90 --fps 10 --end 2");
        let mut command = snakes(folder.path(), &order);
        let path = format!("{}:{own}", folder.path().display());
        let (code, line) = refusal(&command.env("PATH", path).output().expect("it starts"));
        assert_eq!((code, line), (Some(1), format!("error: a.mp4: cannot be written: {reason}")));
        let kept = fs::read_to_string(folder.path().join("a.mp4")).expect("a file");
        assert_eq!((kept.as_str(), names_in(folder.path()).len()), ("an earlier film", 2));
    }
}

#[test]
fn f12_every_request_to_end_cancels_a_film_and_ends_ffmpeg() {
    if lacks("cancel", true) {
        return;
    }
    for (name, signal) in [
        ("a.mp4", Some("-INT")),
        ("b.mp4", Some("-TERM")),
        ("c.mp4", Some("-HUP")),
        ("d.mp4", None),
        ("e.gif", None),
        ("f.png", Some("-TERM")),
    ] {
        let folder = folder();
        let order =
            format!("export {CLIMBER} -o {name} --size 160x90 --fps 50 --json --until-input-ends");
        let mut process = interruptible_snakes(folder.path(), &order)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("it starts");
        let said = process.stdout.take().expect("its output");
        let mut lines = std::io::BufRead::lines(BufReader::new(said));
        let is_in_the_middle = |line: &str| {
            let line: Value = serde_json::from_str(line).expect("JSON");
            // The size of a GIF is told before it is written.
            line["progress"].as_f64().is_some_and(|progress| progress >= 0.02)
        };
        assert!(lines.any(|line| is_in_the_middle(&line.expect("a line"))), "{name}");
        let begun = names_in(folder.path());
        assert!(begun.len() == 1 && begun[0].starts_with(".unfinished-"), "{name}: {begun:?}");
        match signal {
            Some(signal) => {
                let id = process.id().to_string();
                let sent = Command::new("kill").args([signal, &id]).status();
                assert!(sent.is_ok_and(|sent| sent.success()));
            }
            // The end of the input.
            None => drop(process.stdin.take()),
        }
        // A pipe without a reader must not keep the process from ending.
        drop(lines);
        let (code, line) = refusal(&ended(process));
        assert_eq!((code, line.as_str()), (Some(1), "error: cancelled; nothing was written"));
        assert!(names_in(folder.path()).is_empty(), "{name}: {:?}", names_in(folder.path()));
        let path = folder.path().display().to_string();
        let left = Command::new("pgrep").args(["-f", &path]).output().expect("pgrep");
        assert!(left.stdout.is_empty(), "{name}: ffmpeg goes on");
    }
}

#[test]
fn f12_the_next_film_removes_what_a_kill_left() {
    if lacks("tidy", true) {
        return;
    }
    let folder = folder();
    for name in ["a.mp4", "b.png"] {
        let order = format!("export {CLIMBER} -o {name} --size 160x90 --fps 50 --json");
        let mut process = snakes(folder.path(), &order).stdout(Stdio::piped()).spawn();
        let process = process.as_mut().expect("it starts");
        let said = process.stdout.take().expect("its output");
        let mut lines = std::io::BufRead::lines(BufReader::new(said));
        assert!(lines.any(|line| line.expect("a line").contains("progress\":0.02")), "{name}");
        process.kill().expect("killed");
        process.wait().expect("ended");
    }
    // The second export has removed what the first left.
    let left = names_in(folder.path());
    assert!(left.len() == 1 && left[0].starts_with(".unfinished-"), "{left:?}");
    stdout_of(
        folder.path(),
        &format!("export {CLIMBER} -o climber.gif --size 160x90 --fps 10 --end 1"),
    );
    assert_eq!(names_in(folder.path()), ["climber.gif"]);
}

#[test]
fn f12_the_interrupt_key_ends_the_drawing_of_figures() {
    use std::os::unix::process::ExitStatusExt;
    if lacks("figures", false) {
        return;
    }
    let folder = folder();
    let order = "run --population 4 --generations 300 --duration 0.1 --threads 1 --saves saves";
    stdout_of(folder.path(), order);
    let mut runs = fs::read_dir(folder.path().join("saves")).expect("a folder");
    let path = runs.next().expect("a run").expect("a run").path();
    let order = format!("export {} --figures", path.display());
    let mut process = interruptible_snakes(folder.path(), &order)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("it starts");
    // The renderer, which could catch the signal, has begun by then, and most pictures are still to be drawn.
    std::thread::sleep(Duration::from_secs(5));
    assert!(process.try_wait().expect("a process").is_none(), "it has ended too early");
    let id = process.id().to_string();
    assert!(Command::new("kill").args(["-INT", &id]).status().expect("kill").success());
    assert_eq!(ended(process).status.signal(), Some(2));
}

/// Waits at most a minute for the end of a process, and returns its output.
fn ended(mut process: Child) -> Output {
    let begin = Instant::now();
    while process.try_wait().expect("a process").is_none() {
        assert!(begin.elapsed() < Duration::from_secs(60), "it goes on");
        std::thread::sleep(Duration::from_millis(20));
    }
    process.wait_with_output().expect("its output")
}
