//! Files that people and other programs have changed: line ends, byte order marks, links, modes; and requests to end the program.

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::program::{CLIMBER, cut_log, folder, json_lines, run, run_in, stdout_of};

/// Flags of a short run, which is complete after two generations.
const TINY: &str = "--no-render --json --population 4 --generations 2 --duration 0.2 --threads 1";

/// Makes a short run within a folder, and returns its folder and the hash that it printed.
fn tiny_run(folder: &Path) -> (PathBuf, String) {
    let lines = json_lines(folder, &format!("{TINY} --saves saves"));
    let hash = lines.last().expect("a line")["run_hash"].as_str().expect("a hash").to_owned();
    (run_in(&folder.join("saves")).expect("a run"), hash)
}

#[test]
fn f4_a_run_with_other_line_ends_and_byte_order_marks_is_continued_and_exported() {
    let folder = folder();
    let (run_folder, hash) = tiny_run(folder.path());
    cut_log(&run_folder, 1);
    for file in fs::read_dir(&run_folder).expect("a folder") {
        let path = file.expect("a file").path();
        let text = fs::read_to_string(&path).expect("text");
        if path.extension().is_some() {
            fs::write(&path, format!("\u{feff}{}", text.replace('\n', "\r\n"))).expect("written");
        }
    }
    let resume = format!("--no-render --json --threads 1 --resume {}", run_folder.display());
    for _ in 0..2 {
        let lines = json_lines(folder.path(), &resume);
        assert_eq!(lines.last().expect("a line")["run_hash"], hash);
    }
    let table = stdout_of(folder.path(), &format!("export {} -o a.csv", run_folder.display()));
    assert_eq!(table, "saved to a.csv\n");
}

#[test]
fn f6_an_exam_writes_through_links_keeps_the_mode_and_refuses_a_protected_file_at_once() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("store")).expect("created");
    fs::copy(CLIMBER, at("store/mine.ron")).expect("copied");
    fs::set_permissions(at("store/mine.ron"), PermissionsExt::from_mode(0o600)).expect("changed");
    symlink("store/mine.ron", at("view.ron")).expect("linked");
    let before = fs::read_to_string(at("store/mine.ron")).expect("read");
    let exam = "exam view.ron --suite step-rate --write";
    let said = stdout_of(folder.path(), exam);
    assert!(said.contains("| view"), "{said}");
    let about = at("view.ron").symlink_metadata().expect("there");
    assert!(about.is_symlink());
    let after = fs::read_to_string(at("store/mine.ron")).expect("read");
    // The shipped file has the results of all suites, so that only their order of writing can differ.
    assert!(after.contains("// Exam: ") && after.len() >= before.len() / 2, "{after:.300}");
    let about = fs::metadata(at("store/mine.ron")).expect("there");
    assert_eq!(about.mode() & 0o777, 0o600);
    fs::set_permissions(at("store/mine.ron"), PermissionsExt::from_mode(0o444)).expect("changed");
    for command in [exam.to_owned(), format!("export {CLIMBER} -o locked.csv")] {
        let _ = symlink("store/mine.ron", at("locked.csv"));
        let output = run(folder.path(), &command);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{error}");
        assert!(error.ends_with(": cannot be written: it is write-protected\n"), "{error}");
        assert!(output.stdout.is_empty());
    }
    assert_eq!(fs::read_to_string(at("store/mine.ron")).expect("read"), after);
}

#[test]
fn f12_every_request_to_end_stops_a_run_after_its_generation_but_nohup_ignores_hangups() {
    let order = "--no-render --json --population 40 --generations 10000 --duration 1 --out out";
    let program = env!("CARGO_BIN_EXE_snakes");
    for (ignored, signals) in [
        ("", vec!["-INT"]),
        ("", vec!["-TERM"]),
        ("", vec!["-HUP"]),
        // The time of the processor that a queue allows is spent.
        ("", vec!["-XCPU"]),
        ("HUP", vec!["-HUP", "-TERM"]),
    ] {
        let folder = folder();
        let begin = match ignored {
            "" => "exec env --default-signal=HUP,INT".to_owned(),
            ignored => format!("trap '' {ignored}; exec"),
        };
        let mut child = Command::new("bash")
            .args(["-c", &format!("{begin} {program} {order}")])
            .current_dir(folder.path())
            .env("HOME", folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("bash");
        let mut lines = BufReader::new(child.stdout.take().expect("piped")).lines();
        let mut next = || lines.next().expect("a generation").expect("a line");
        assert!(next().contains("\"generation\":1"));
        let id = child.id().to_string();
        for (number, signal) in signals.iter().enumerate() {
            let sent = Command::new("kill").args([*signal, &id]).status();
            assert!(sent.expect("kill").success(), "{signal}");
            if number + 1 < signals.len() {
                // The run goes on.
                (0..5).for_each(|_| assert!(next().contains("\"generation\"")));
            }
        }
        let _ = lines.by_ref().count();
        let mut said = String::new();
        child.stderr.take().expect("piped").read_to_string(&mut said).expect("read");
        assert_eq!(child.wait().expect("ended").code(), Some(1), "{signals:?}: {said}");
        assert!(said.contains("cancelled after generation "), "{signals:?}: {said}");
    }
}
