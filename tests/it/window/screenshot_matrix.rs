//! Screenshots of every view in every size of window, at every scale that fits, in both themes, to find what is cut, covered or
//! misaligned.
//!
//! `SNAKES_SCREENSHOTS=target/screenshots cargo test --release --test it views_at_every_size -- --ignored` takes them all, in half
//! an hour or more. `SNAKES_SCREENSHOTS_SIZE=1280x720` and `SNAKES_SCREENSHOTS_SCALE=1.5` take those of one size or
//! scale.

use std::path::{Path, PathBuf};
use std::time::Duration;

use super::display::{Studio, preferences};

/// Widths and heights of the window, in pixels.
const SIZES: [(u16, u16); 6] =
    [(1024, 640), (1280, 720), (1600, 900), (1920, 1080), (2560, 1440), (3840, 2160)];
const SCALES: [f32; 3] = [1.0, 1.5, 2.0];
/// Least width and height of the window in the panels' units, below which the program reduces the scale.
const LEAST: (f32, f32) = (800.0, 480.0);

/// A run that ends in the first minute.
pub const RUN: &str = "--preset climb --generations 30 --threads 2";

/// Brings up a view.
type Show = fn(&Studio);

/// Names of the views, and functions that bring them up, in an order in which each can follow the one before.
const VIEWS: [(&str, Show); 14] = [
    ("story", story),
    ("crowd", crowd),
    ("main", main_view),
    ("landing", landing),
    ("world", world),
    ("sweep", sweep),
    ("race", race),
    ("charts", charts),
    ("body", body),
    ("library", library),
    ("creature", creature),
    ("stairs", stairs),
    ("presenting", presenting),
    ("lesson", lesson),
];

/// Pauses the stage at this fraction of the trial's duration.
pub fn hold(studio: &Studio, share: f64) {
    if !studio.title().contains(", stopped") {
        studio.key("space");
        studio.wait_for_title(", stopped");
    }
    studio.seek(share);
}

fn story(studio: &Studio) {
    studio.key("s");
    studio.place_with("Story, part 1");
    hold(studio, 0.3);
}

fn crowd(studio: &Studio) {
    studio.key("i");
    studio.wait_for_title("showing generation");
    hold(studio, 0.3);
}

fn main_view(studio: &Studio) {
    studio.key("0");
    studio.wait_for_title_without(", stopped");
    hold(studio, 0.42);
}

fn landing(studio: &Studio) {
    studio.seek(0.97);
}

fn world(studio: &Studio) {
    studio.open_panel("Change");
    studio.drag_slider("Friction", 0.3);
    studio.wait_for_title("what-if");
    hold(studio, 0.5);
}

fn sweep(studio: &Studio) {
    studio.key("Escape");
    studio.wait_for_title_without("what-if");
    studio.scroll_and_click("Button", "Sweep Friction");
    studio.wait_for_title("showing a race of 5");
    hold(studio, 0.5);
}

fn race(studio: &Studio) {
    studio.open_panel("Champions");
    studio.key("n");
    studio.wait_for_title("showing a race of 6");
    hold(studio, 0.55);
}

pub fn charts(studio: &Studio) {
    studio.open_panel("Charts");
    studio.place("Chart: Fitness by generation");
}

fn body(studio: &Studio) {
    studio.key("0");
    studio.wait_for_title("showing climber");
    studio.open_panel("Body");
    hold(studio, 0.3);
}

/// Clicks the save with this name in the library.
fn click_save(studio: &Studio, name: &str) {
    let start = format!("{name}, ");
    let save = studio.place_where(name, |place| place.label.starts_with(&start));
    studio.click_at(save.area.middle());
}

pub fn library(studio: &Studio) {
    studio.open_panel("Library");
    let is_read = || {
        let places = studio.places();
        let has = |part: &str| places.iter().any(|place| place.label.contains(part));
        has(" saves") && !has("not read yet")
    };
    studio.wait(is_read, || "a library that is read".to_owned());
    click_save(studio, "climber");
    studio.place("Replay");
}

fn creature(studio: &Studio) {
    click_save(studio, "crawler");
    studio.click_label("Replay");
    studio.wait_for_title("showing crawler");
    hold(studio, 0.3);
}

fn stairs(studio: &Studio) {
    studio.key("0");
    studio.wait_for_title_without("crawler");
    studio.choose("Run", "Race the snake over ten staircases");
    studio.wait_for_title("showing a race of 10");
    hold(studio, 0.5);
}

fn presenting(studio: &Studio) {
    studio.key("Escape");
    studio.wait_for_title_without("race");
    studio.key("F11");
    studio.wait_for_no("Panel Change");
    hold(studio, 0.42);
}

fn lesson(studio: &Studio) {
    studio.key("Escape");
    studio.place("Panel Change");
    first_lesson(studio);
}

/// Begins the first lesson, and pauses its race.
pub fn first_lesson(studio: &Studio) {
    studio.open_panel("Learn");
    studio.click_label("Begin lesson 1");
    studio.wait_for_title("showing a race of 3");
    // The race waits for a guess.
    studio.scroll_and_click("Button", "Guess: original");
    studio.wait_for_title_without(", stopped");
    hold(studio, 0.6);
}

/// Opens the program with preferences and saves in the folder `scratch`, and waits for the end of its run; `None` if that is
/// impossible.
pub fn open_finished(
    scratch: &Path,
    test: &str,
    fields: &str,
    arguments: &str,
    size: (i32, i32),
) -> Option<Studio> {
    let path = scratch.join("studio.ron");
    std::fs::write(&path, preferences(fields)).expect("written");
    let (preferences, saves) = (path.display(), scratch.join("saves"));
    let arguments = format!("{arguments} --preferences {preferences} --saves {}", saves.display());
    let studio = Studio::open_sized(test, &arguments, size)?;
    studio.wait_for_title("finished");
    Some(studio)
}

/// Takes the pictures of one size and scale in both themes; `None` if no window can be opened.
fn take(folder: &Path, (width, height): (u16, u16), scale: f32) -> Option<()> {
    let scratch = super::folder();
    let quality = std::env::var("SNAKES_SCREENSHOTS_QUALITY").unwrap_or("fast".to_owned());
    let fields = format!("ui_scale: {scale:.1}, tour_is_over: true, quality: Some({quality:?})");
    let (arguments, size) = (format!("{RUN} --theme light"), (width.into(), height.into()));
    let studio = open_finished(scratch.path(), "matrix", &fields, &arguments, size)?;
    for (view, show) in VIEWS {
        show(&studio);
        for theme in ["light", "dark"] {
            studio.step_aside();
            // Messages disappear after eight seconds, and a camera moves for one.
            let settling_s = if theme == "light" { 9 } else { 1 };
            std::thread::sleep(Duration::from_secs(settling_s));
            studio.wait_for_frames(3);
            let name = format!("{width}x{height}-{scale:.1}-{quality}-{view}-{theme}.png");
            studio.picture().store(&folder.join(name));
            studio.key("t");
        }
    }
    Some(())
}

#[test]
#[ignore = "takes an hour or more; run it by hand after a change of what is drawn"]
fn views_at_every_size() {
    let folder = std::env::var_os("SNAKES_SCREENSHOTS").expect("SNAKES_SCREENSHOTS names a folder");
    let folder = PathBuf::from(folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    let is_wanted = |name: &str, value: String| {
        std::env::var(format!("SNAKES_SCREENSHOTS_{name}")).map_or(true, |wanted| wanted == value)
    };
    for (width, height) in SIZES {
        for scale in SCALES {
            let fits = f32::from(width) / scale >= LEAST.0 && f32::from(height) / scale >= LEAST.1;
            let is_wanted = is_wanted("SIZE", format!("{width}x{height}"))
                && is_wanted("SCALE", format!("{scale:.1}"));
            if fits && is_wanted {
                let _skipped = take(&folder, (width, height), scale);
            }
        }
    }
}
