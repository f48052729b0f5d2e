//! The real window on a virtual display, with real keys and clicks.
//!
//! The tests need Debian's `xvfb`, `xdotool`, `mesa-vulkan-drivers` and `libvulkan1`. Without them each is skipped with a line,
//! which has the number skipped so far, or fails if `SNAKES_WINDOW_TESTS=required` is set.
#![expect(clippy::panic, reason = "a helper of a test fails by panicking, as tests do")]

mod display;
mod guidance;
mod input;
mod keyboards;
mod library;
mod panels;
mod picture;
mod places;
mod presenting;
mod random_hand;
mod screenshot_matrix;
mod screenshots;
mod settings;
mod stage;

use super::program::{cut_log, folder, json_lines, run, stdout_of};
pub use display::Studio;
use picture::{Picture, difference, is_blue, is_red};
use places::Area;
use std::time::Duration;

/// Path of a champion in the report's world.
const REPORTS_CLIMBER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/saves/first-climber.ron");

#[test]
fn it_opens_with_a_moving_red_and_blue_snake_while_a_run_evolves() {
    let Some(studio) = Studio::open("opens", "--preset quick") else { return };
    let first =
        studio.picture_with(|picture| picture.count(is_red) > 300 && picture.count(is_blue) > 300);
    studio.picture_with(|picture| difference(&first, picture) > 500);
    studio.wait_for_title("4 of 4 generations, finished");
}

#[test]
fn keys_buttons_and_the_menu_start_pause_and_single_step_evolution() {
    let Some(studio) = Studio::open("evolution-keys", "--preset quick --generations 1000") else {
        return;
    };
    studio.wait_for_title("running");
    studio.click_label("Pause evolution");
    studio.wait_for_title("paused");
    let before = studio.generations();
    studio.click_label("One generation");
    studio.wait_for_title(&format!("{} of 1000 generations, paused", before + 1));
    studio.click_champion(1);
    studio.wait_for_title("showing generation 1");
    studio.choose("Run", "Start or pause evolution");
    studio.wait_for_title("running");
    studio.key("e");
    studio.wait_for_title("paused");
    let before = studio.generations();
    studio.key("g");
    studio.wait_for_title(&format!("{} of 1000 generations, paused", before + 1));
    studio.key("1");
    studio.wait_for_title("showing generation 1");
    studio.key("0");
    studio.wait_for_title("showing climber");
    studio.key("e");
    studio.wait_for_title("running");
    studio.wait_for_generations(before + 3);
    studio.click_label("New run");
    studio.wait_for_title("seed 2 - ");
}

/// This test opens no window, but needs the same driver: it draws pictures without a display.
#[test]
fn figures_are_drawn_without_a_display() {
    if display::lacks_a_driver("figures") {
        return;
    }
    let folder = folder();
    let small = "--no-render --json --population 6 --generations 2 --duration 1 --out run";
    let champion = json_lines(folder.path(), small)[2]["champion"].clone();
    let run = champion.as_str().and_then(|path| path.rsplit_once('/')).expect("a path").0;
    stdout_of(folder.path(), &format!("export {run} --figures -o figures"));
    for name in ["signal.png", "generation-1.png", "generation-2.png"] {
        let bytes = std::fs::read(folder.path().join("figures").join(name)).expect(name);
        assert!(bytes.starts_with(b"\x89PNG"), "{name}");
        // An empty picture would compress to a few thousand bytes.
        assert!(bytes.len() > 15_000, "{name} has {} bytes", bytes.len());
    }
}

#[test]
fn a_typed_seed_starts_another_run() {
    // The champion belongs to the run's world, so it stays on the stage unless a better one is found.
    let arguments = format!("replay {REPORTS_CLIMBER} --preset quick");
    let Some(studio) = Studio::open("seed", &arguments) else { return };
    studio.wait_for_title("seed 1 - 4 of 4 generations, finished");
    studio.fold("Method of evolution");
    studio.type_into("Seed", "77");
    // Stage shortcuts must ignore text that is typed into a field, so the key for generation 7 must not show that generation.
    assert!(studio.title().ends_with("showing first-climber"), "{}", studio.title());
    studio.scroll_and_click("Button", "New run");
    studio.wait_for_title("seed 77 - 4 of 4 generations, finished");
    studio.key("0");
    studio.wait_for_title("showing first-climber");
    studio.type_into("Seed", "1");
    assert!(studio.title().ends_with("showing first-climber"), "{}", studio.title());
}

#[test]
fn the_mouse_moves_the_camera_and_home_resets_it() {
    let Some(studio) = Studio::open("camera", "--preset quick") else { return };
    studio.pause_evolution();
    studio.key("space");
    studio.wait_for_title(", stopped");
    let home = studio.still_picture();
    let (x, y) = studio.stage().at(0.58, 0.64);
    studio.drag(1, (x, y), (x + 100, y + 40));
    let turned = studio.still_picture();
    assert!(difference(&home, &turned) > 2000, "a drag turns the camera");
    studio.drag(3, (x, y), (x + 40, y + 40));
    let moved = studio.still_picture();
    assert!(difference(&turned, &moved) > 2000, "a drag with the right button moves it");
    let title = studio.place("Panel Watch").area.middle();
    studio.wheel(true, title);
    studio.drag(1, title, (x, y));
    let unmoved = studio.still_picture();
    assert_eq!(difference(&moved, &unmoved), 0, "wheel and drag on a panel do not move the camera");
    studio.wheel(true, (x, y));
    let zoomed = studio.still_picture();
    assert!(difference(&moved, &zoomed) > 2000, "the wheel zooms");
    studio.key("Home");
    studio.picture_with(|picture| difference(&home, picture) < 200);
    studio.key("d");
    studio.picture_with(|picture| difference(&home, picture) > 300);
    studio.key("d");
    studio.picture_with(|picture| difference(&home, picture) < 200);
}

#[test]
fn r_plays_from_the_start_and_f_stops_following() {
    let Some(studio) = Studio::open("restart", "--preset quick") else { return };
    studio.pause_evolution();
    let start = studio.picture();
    // The snake is far from its start when the stage is paused, and near the start again after R.
    std::thread::sleep(Duration::from_secs(3));
    studio.key("f");
    studio.key("space");
    studio.wait_for_title(", stopped");
    let held = studio.still_picture();
    assert!(difference(&start, &held) > 1000);
    studio.key("r");
    studio.wait_for_title_without(", stopped");
    studio.picture_with(|picture| difference(&held, picture) > 1000);
    // Without following, the stairs do not move on the screen. The sky and the far ground at the top of the stage show this.
    let far = |picture: &Picture| {
        let scene = picture.scene;
        picture.region(Area { bottom: scene.top + 30, ..scene })
    };
    let before = far(&studio.picture());
    std::thread::sleep(Duration::from_secs(2));
    assert!(far(&studio.picture()) == before, "the camera stands still");
}

#[test]
fn a_first_start_shows_the_first_generation_and_then_a_better_one() {
    let Some(studio) = Studio::open_following("learns", "--preset quick --seed 3") else { return };
    studio.wait_for_title("showing generation 1, ");
    studio.place("Generation 1");
    studio.place_with("40 of 60 snakes");
    studio.wait_for_title_without("showing generation 1, ");
    studio.wait_for_title("showing generation ");
    studio.click_label("Only the best");
    studio.wait_for_title_without(" snakes");
}

#[test]
fn a_second_start_opens_the_stopped_run_with_continue_and_new_run() {
    let folder = folder();
    let arguments =
        format!("--preset quick --generations 1000 --saves {}", folder.path().join("s").display());
    let Some(studio) = Studio::open_following("first-start", &arguments) else { return };
    // A title with the number of finished generations might be gone before it is read.
    studio.wait_for_title("showing generation ");
    drop(studio);
    let studio = Studio::open_following("second-start", &arguments).expect("it opened before");
    studio.wait_for_title("seed 1 - ");
    studio.wait_for_title("paused");
    studio.place("Continue evolution");
    studio.click_label("New run");
    studio.wait_for_title("seed 2 - ");
    studio.wait_for_title("running");
}

/// A run that takes hours, so that only the test ends it.
const ENDLESS: &str = "--preset quick --generations 10000";

#[test]
fn a_killed_studio_continues_its_run_and_so_does_headless_mode() {
    let folder = folder();
    let saves = folder.path().join("saves");
    // Two generations of so many snakes take seconds, so on most machines the kill comes in the middle of the run.
    let run = "--preset quick --population 500";
    let arguments = format!("{run} --saves {}", saves.display());
    let Some(studio) = Studio::open("killed", &arguments) else { return };
    studio.wait_for_generations(2);
    // Dropping the studio kills the program.
    drop(studio);
    let evolved = std::fs::read_dir(&saves).expect("saves").next().expect("a run").expect("a run");
    let resume = format!("--resume {}", evolved.path().display());
    cut_log(&evolved.path(), 2);
    let Some(studio) = Studio::open("resumed", &resume) else { return };
    studio.wait_for_title("4 of 4 generations, finished");
    drop(studio);
    let undisturbed = json_lines(folder.path(), &format!("--no-render --json {run} --out other"));
    let resumed = json_lines(folder.path(), &format!("--no-render --json {resume}"));
    assert_eq!(resumed[4]["run_hash"], undisturbed[4]["run_hash"]);
}

#[test]
fn studio_and_headless_run_refuse_each_others_folder_and_name_the_owner() {
    let folder = folder();
    let arguments = format!("{ENDLESS} --seed 1 --saves {}", folder.path().join("saves").display());
    let Some(studio) = Studio::open("locked", &arguments) else { return };
    studio.wait_for_title("running");
    let output = run(folder.path(), &format!("--no-render {arguments}"));
    let message = String::from_utf8_lossy(&output.stderr);
    let owner = format!("in use by process {} (the studio)", studio.process());
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.starts_with("error: ") && message.contains(&owner), "{message}");
    drop(studio);
    let mut headless = super::program::snakes(folder.path(), &format!("--no-render {arguments}"))
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .spawn()
        .expect("the program starts");
    std::thread::sleep(Duration::from_secs(1));
    let studio = Studio::open("refused", &arguments).expect("it opened before");
    // The second program opens and shows its champion, but does not evolve.
    studio.wait_for_title("generations, ready");
    headless.kill().expect("killed");
    headless.wait().expect("ended");
    studio.click_label("Start evolution");
    studio.wait_for_title("running");
}

#[test]
fn a_damaged_champion_opened_from_the_desktop_is_named_in_the_window() {
    let folder = folder();
    let damaged = folder.path().join("damaged.ron");
    std::fs::write(&damaged, "(kind: \"snakes-and-stairs champion\"").expect("written");
    let arguments = format!("replay --desktop --preset quick {}", damaged.display());
    let Some(studio) = Studio::open("damaged", &arguments) else { return };
    studio.place_with("damaged.ron: ");
    studio.wait_for_title("quick, seed 1");
    let refused = run(folder.path(), &format!("replay {}", damaged.display()));
    assert_eq!(refused.status.code(), Some(1), "in a terminal it is an error");
}
