//! The README's screenshots of the studio, taken from the real window.
//!
//! `cargo test --release --test it screenshots -- --ignored` writes them to `assets/screenshots`. Environment variables take
//! other screenshots: a folder, a window size, a UI scale and a theme, as in `SNAKES_SCREENSHOTS=target/screenshots
//! SNAKES_SCREENSHOTS_SIZE=2560x1440 SNAKES_SCREENSHOTS_SCALE=1.5 SNAKES_SCREENSHOTS_THEME=dark`.

use std::path::PathBuf;
use std::time::Duration;

use super::display::Studio;
use super::screenshot_matrix::{RUN, charts, first_lesson, hold, library, open_finished};

/// The README's screenshots; only these are written to `assets/screenshots`.
const IN_README: [&str; 6] = ["single", "race", "charts", "library", "lesson", "senses"];

/// Folder, size, scale and theme of the screenshots.
struct Album {
    /// Target folder; `None` for the folder of the README's screenshots.
    folder: Option<PathBuf>,
    size: (i32, i32),
    scale: String,
    theme: String,
    /// Folder for saves and preferences of the program.
    scratch: tempfile::TempDir,
}

impl Album {
    fn from_environment() -> Self {
        let given = |name: &str, otherwise: &str| {
            std::env::var(format!("SNAKES_SCREENSHOTS_{name}")).unwrap_or(otherwise.to_owned())
        };
        let size = given("SIZE", "1280x720");
        let (width, height) = size.split_once('x').expect("WIDTHxHEIGHT");
        let size = (width.parse().expect("a width"), height.parse().expect("a height"));
        let folder = std::env::var_os("SNAKES_SCREENSHOTS").map(PathBuf::from);
        if let Some(folder) = &folder {
            std::fs::create_dir_all(folder).expect("a folder");
        }
        let (scale, theme) = (given("SCALE", "1.0"), given("THEME", "light"));
        Self { folder, size, scale, theme, scratch: super::folder() }
    }

    /// Opens the program; `None` if that is impossible. Saves are shared between screenshots, everything else is fresh.
    fn open(&self, arguments: &str, tour_is_over: bool) -> Option<Studio> {
        let fields = format!("ui_scale: {}, tour_is_over: {tour_is_over}", self.scale);
        let arguments = format!("{arguments} --theme {}", self.theme);
        open_finished(self.scratch.path(), "screenshots", &fields, &arguments, self.size)
    }

    /// Writes a screenshot once the display is still.
    fn keep(&self, studio: &Studio, name: &str) {
        let folder = match &self.folder {
            Some(folder) => folder.clone(),
            None if IN_README.contains(&name) => {
                PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/screenshots"))
            }
            None => return,
        };
        studio.step_aside();
        // Messages disappear after eight seconds. A camera moves for one second, and a large picture takes one.
        std::thread::sleep(Duration::from_secs(9));
        studio.picture().store(&folder.join(format!("{name}-{}.png", self.theme)));
    }

    /// Takes screenshots of the stage: a race, another world, a close-up.
    fn stage(&self) -> Option<()> {
        let studio = self.open(RUN, true)?;
        studio.key("a");
        studio.key("n");
        studio.wait_for_title("showing a race of 6");
        hold(&studio, 0.55);
        self.keep(&studio, "race");

        studio.key("0");
        studio.wait_for_title("showing climber");
        studio.open_panel("Change");
        studio.drag_slider("Friction", 0.3);
        studio.wait_for_title("what-if");
        hold(&studio, 0.5);
        self.keep(&studio, "what-if");
        drop(studio);

        // The close-up shows a moment with contacts.
        let robust =
            concat!("replay ", env!("CARGO_MANIFEST_DIR"), "/saves/robust.ron --preset quick");
        let studio = self.open(robust, true)?;
        for key in ["a", "0", "v", "j", "b"] {
            studio.key(key);
        }
        hold(&studio, 0.3);
        let limb = studio.still_picture().find(super::is_red).expect("a red limb");
        studio.double_click_at(limb);
        self.keep(&studio, "contacts");
        Some(())
    }

    /// Takes a screenshot of a snake with touch, beside its copy without touch.
    fn senses(&self) -> Option<()> {
        let feeler =
            concat!("replay ", env!("CARGO_MANIFEST_DIR"), "/saves/feeler.ron --preset quick");
        let studio = self.open(feeler, true)?;
        studio.key("a");
        studio.key("0");
        hold(&studio, 0.2);
        studio.open_panel("Senses");
        studio.scroll_and_click("CheckBox", "Touch");
        studio.wait_for_title("what-if");
        hold(&studio, 0.76);
        self.keep(&studio, "senses");
        Some(())
    }

    /// Takes screenshots of the main view, the panels and the modal views.
    fn panels(&self) -> Option<()> {
        let studio = self.open(RUN, true)?;
        studio.key("a");
        studio.key("0");
        hold(&studio, 0.42);
        self.keep(&studio, "single");

        charts(&studio);
        self.keep(&studio, "charts");

        library(&studio);
        self.keep(&studio, "library");

        studio.key("question");
        studio.place("Keyboard and mouse");
        self.keep(&studio, "keys");
        studio.key("Escape");
        studio.wait_for_no("Keyboard and mouse");

        first_lesson(&studio);
        self.keep(&studio, "lesson");
        drop(studio);

        let studio = self.open(RUN, false)?;
        studio.place("1 of 5");
        studio.click_label("Next");
        studio.place("2 of 5");
        self.keep(&studio, "tour");
        Some(())
    }
}

#[test]
#[ignore = "takes minutes, and writes into the repository; run it by hand after a change of what is drawn"]
fn screenshots_of_the_stage() {
    let _skipped = Album::from_environment().stage();
}

#[test]
#[ignore = "takes minutes, and writes into the repository; run it by hand after a change of what is drawn"]
fn screenshots_of_the_senses() {
    let _skipped = Album::from_environment().senses();
}

#[test]
#[ignore = "takes minutes, and writes into the repository; run it by hand after a change of what is drawn"]
fn screenshots_of_the_panels() {
    let _skipped = Album::from_environment().panels();
}
