//! Bad input gives one line that names the field, the value and the allowed values. The exit code is 2 for wrong usage, 1 for
//! failure. No file is overwritten or left incomplete.

use std::fs;
use std::path::Path;

use super::program::{folder, json_lines, run, snakes, with_slashes};

/// Runs the program, which must fail with `code` and one line, and returns the line.
pub fn refusal(folder: &Path, arguments: &str, code: i32) -> String {
    let output = run(folder, arguments);
    let message = String::from_utf8(output.stderr).expect("UTF-8");
    let message = message.trim_end().to_owned();
    assert_eq!(output.status.code(), Some(code), "snakes {arguments}: {message}");
    assert_eq!(message.lines().count(), 1, "snakes {arguments}: {message}");
    assert!(output.stdout.is_empty(), "snakes {arguments} printed on standard output");
    message
}

#[test]
fn an_unknown_setting_or_a_value_out_of_range_is_refused() {
    let folder = folder();
    let message = refusal(folder.path(), "--no-render --set surface.fricton=0.8", 2);
    assert!(
        message.starts_with("error: --set is \"surface.fricton\", an unknown setting"),
        "{message}"
    );
    assert!(message.contains("trial.surface.friction"), "{message}");
    let message = refusal(folder.path(), "--no-render --set surface.slip_m_s_per_n=-1", 2);
    assert_eq!(message, "error: trial.surface.slip_m_s_per_n is -1; allowed: 0 to 10");
    let message = refusal(folder.path(), "--no-render --fitness speed", 2);
    let allowed = "centre, head, centre_of_mass, height, furthest_y, steps_climbed, climb, share";
    assert_eq!(message, format!("error: --fitness is \"speed\"; allowed: {allowed}"));
    let message = refusal(folder.path(), "study table1 --seeds 0", 2);
    assert_eq!(message, "error: --seeds is 0; allowed: 1 to 10000");
    let message = refusal(folder.path(), "study table1 --fitness height", 2);
    assert_eq!(message, "error: --fitness is height; allowed: centre, as of the published means");
}

#[cfg(feature = "studio")]
#[test]
fn figures_of_a_folder_without_a_run_are_refused() {
    let folder = folder();
    let message = refusal(folder.path(), "export nosuch --figures", 1);
    assert!(message.starts_with("error: nosuch: cannot be read: "), "{message}");
    let message = refusal(folder.path(), "export . --figures", 1);
    assert!(message.contains("it contains no generation-1.ron or later"), "{message}");
}

#[cfg(feature = "studio")]
#[test]
fn wrong_values_of_render_are_refused_before_anything_is_drawn() {
    let folder = folder();
    let climber = concat!("export ", env!("CARGO_MANIFEST_DIR"), "/saves/climber.ron -o a.png");
    for (arguments, message) in [
        ("--at 99", "--at is 99; allowed: 0 to 15, or end"),
        ("--at -1", "--at is -1; allowed: 0 to 15, or end"),
        ("--at soon", "--at is \"soon\"; allowed: 0 to 15, or end"),
        ("--at 3 --size 0x0", "--size width is 0; allowed: 64 to 8192"),
        ("--at 3 --size big", "--size is \"big\"; allowed: WIDTHxHEIGHT, 64x64 to 8192x8192"),
        ("--at 3 --camera foo", "--camera is \"foo\"; allowed: follow, side or top"),
        ("--at 3 --show ghosts", "--show is \"ghosts\"; allowed: contacts, torques, trail or line"),
        ("--at end --theme dim", "--theme is \"dim\"; allowed: light or dark"),
    ] {
        let said = refusal(folder.path(), &format!("{climber} {arguments}"), 2);
        assert_eq!(said, format!("error: {message}"));
    }
    let said = refusal(folder.path(), "export missing.ron -o a.png --at end", 1);
    assert!(said.contains("missing.ron"), "{said}");
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0, "nothing is drawn");
}

#[test]
fn an_unknown_flag_is_refused() {
    let message = refusal(folder().path(), "--no-render --polulation 3", 2);
    assert!(message.contains("--polulation"), "{message}");
}

#[test]
fn a_missing_save_is_refused() {
    let message = refusal(folder().path(), "replay nosuch.ron --no-render", 1);
    assert!(message.starts_with("error: nosuch.ron: cannot be read: "), "{message}");
}

/// Returns the error of replaying a shipped champion whose file was changed by `edit`.
fn refusal_of_save(edit: impl FnOnce(&str) -> String) -> String {
    let folder = folder();
    let edited = edit(include_str!("../../saves/first-climber.ron"));
    fs::write(folder.path().join("save.ron"), &edited).expect("written");
    let message = refusal(folder.path(), "replay save.ron --no-render", 1);
    let kept = fs::read_to_string(folder.path().join("save.ron")).expect("read");
    assert_eq!(kept, edited, "the file is left as it was");
    message
}

#[test]
fn a_file_of_another_kind_is_refused() {
    let message = refusal_of_save(|_| "(name: \"opening\", moves: [\"e4\", \"e5\"])".to_owned());
    let allowed = "allowed: \"snakes-and-stairs champion\"";
    assert_eq!(message, format!("error: save.ron: kind is \"\"; {allowed}"));
    let message = refusal_of_save(|_| "Dear diary".to_owned());
    let place = "damaged or incomplete at line 1, column 1";
    assert_eq!(
        message,
        format!("error: save.ron: {place}: fields in parentheses are expected here")
    );
    let message = refusal_of_save(|_| "\u{7f}ELF\u{1}\u{2}".to_owned());
    assert!(message.starts_with("error: save.ron: damaged or incomplete at line 1"), "{message}");
}

#[test]
fn a_save_with_a_value_out_of_range_is_refused() {
    let message = refusal_of_save(|text| text.replace("steps_per_s: 60", "steps_per_s: 0"));
    assert_eq!(message, "error: save.ron: trial.physics.steps_per_s is 0; allowed: 20 to 1000");
}

#[test]
fn an_output_folder_that_cannot_be_written_is_refused() {
    let folder = folder();
    fs::write(folder.path().join("taken"), "a file, no folder").expect("written");
    // The run is refused before its first evaluation, so standard output stays empty.
    let message = {
        let output = run(folder.path(), "--no-render --json --out taken");
        assert_eq!(output.status.code(), Some(1));
        assert!(output.stdout.is_empty());
        with_slashes(&String::from_utf8(output.stderr).expect("UTF-8"))
    };
    let last = message.lines().last().expect("a line");
    assert!(
        last.starts_with("error: taken/climb-seed1-") && last.contains(": cannot be written: "),
        "{message}"
    );
    let kept = fs::read_to_string(folder.path().join("taken")).expect("read");
    assert_eq!(kept, "a file, no folder");
}

#[test]
fn a_preset_file_with_an_unknown_missing_or_wrong_field_is_refused() {
    let folder = folder();
    let quick = include_str!("../../assets/presets/quick.ron");
    for (edit, complaint) in [
        (quick.replace("friction: 1.0", "fricton: 1.0"), "fricton"),
        (quick.replace("start_y_m: -7.23,", ""), "start_y_m"),
        (
            quick.replace("soft_erp: 0.25,\n", "soft_erp: 1.5,\n"),
            "trial.surface.soft_erp is 1.5; allowed: 0.01 to 1",
        ),
        (
            quick.replace("limb_width_m: 1.0,", "limb_width_m: [1.0, 1.0],"),
            "trial.agent.limb_width_m is a list of 2; allowed: one value, or a list of 5",
        ),
    ] {
        fs::write(folder.path().join("own.ron"), edit).expect("written");
        let message = refusal(folder.path(), "--no-render --preset own.ron", 1);
        assert!(message.contains("own.ron: ") && message.contains(complaint), "{message}");
    }
}

#[test]
fn the_same_run_writes_the_same_folder_and_another_run_another() {
    let folder = folder();
    let run_with = |population: u32| {
        let arguments = format!(
            "--no-render --json --population {population} --generations 1 --duration 0.5 --out out"
        );
        json_lines(folder.path(), &arguments);
        let files = fs::read_dir(folder.path().join("out")).expect("a folder");
        files.count()
    };
    assert_eq!(run_with(4), 1);
    assert_eq!(run_with(4), 1, "the same run writes the same folder");
    assert_eq!(run_with(5), 2, "another run writes another");
}

/// Windows names the folders of a user in another way.
#[cfg(unix)]
#[test]
fn f2_a_home_that_is_no_absolute_path_is_not_used() {
    let folder = folder();
    for home in ["home", "."] {
        let mut command = snakes(folder.path(), "run --preset quick --generations 1 --restart");
        let output = command.env("HOME", home).env_remove("XDG_DATA_HOME").output();
        let said = String::from_utf8(output.expect("the program starts").stdout).expect("UTF-8");
        assert!(said.contains("saved to  saves/quick-"), "{said}");
    }
    let mut found: Vec<_> = fs::read_dir(folder.path()).expect("a folder").collect();
    assert_eq!(found.pop().expect("saves").expect("read").file_name(), "saves");
    assert!(found.is_empty(), "{found:?}");
}

/// Systems other than Linux always have a display.
#[cfg(target_os = "linux")]
#[test]
fn without_a_display_the_studio_fails_with_one_line() {
    let message = refusal(folder().path(), "", 1);
    assert!(message.contains("--no-render"), "{message}");
    #[cfg(feature = "studio")]
    assert!(message.starts_with("error: no window can be opened ("), "{message}");
}

/// Returns the error line of the program with these environment variables.
#[cfg(all(feature = "studio", target_os = "linux"))]
fn refusal_with(variables: &[(&str, &str)], arguments: &str) -> String {
    let folder = folder();
    let output = snakes(folder.path(), arguments).envs(variables.iter().copied()).output();
    let output = output.expect("the program starts");
    assert_eq!(output.status.code(), Some(1), "{arguments}");
    let text = String::from_utf8(output.stderr).expect("UTF-8");
    let line = text.lines().find(|line| line.starts_with("error: "));
    line.expect("an error").to_owned()
}

#[cfg(all(feature = "studio", target_os = "linux"))]
#[test]
fn f2_an_error_names_the_variables_that_lead_to_no_display_or_driver() {
    let message = refusal_with(&[], "");
    assert!(message.contains("neither WAYLAND_DISPLAY nor DISPLAY is set"), "{message}");
    // A display number beyond all that exist.
    let (wayland, x11) = (("WAYLAND_DISPLAY", "wayland-9"), ("DISPLAY", ":64999"));
    for (variables, named) in [
        (vec![wayland], "with WAYLAND_DISPLAY=\"wayland-9\""),
        (vec![x11], "with DISPLAY=\":64999\""),
        (vec![wayland, x11], "with DISPLAY=\":64999\""),
        (vec![("WAYLAND_SOCKET", "four")], "with WAYLAND_SOCKET=\"four\""),
    ] {
        let message = refusal_with(&variables, "");
        assert!(message.contains(&format!("no server answers {named}")), "{message}");
        assert!(message.contains("--no-render"), "{message}");
    }
    let champion = concat!(env!("CARGO_MANIFEST_DIR"), "/saves/climber.ron");
    let picture = format!("export {champion} -o p.png --at 1 --size 64x64");
    for (name, value) in [("WGPU_BACKEND", "metal"), ("VK_ICD_FILENAMES", "/nowhere.json")] {
        // Another kind of driver must not be found instead.
        let message =
            refusal_with(&[(name, value), ("VK_DRIVER_FILES", "/nowhere.json")], &picture);
        assert!(message.contains(&format!("{name}={value:?}")), "{message}");
    }
}
