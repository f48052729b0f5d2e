//! The pictures of the studio that the README shows, taken from the real window.
//!
//! `cargo test --test it screenshots -- --ignored` writes them into `assets/screenshots`. Another size, and then another
//! folder, are named by the environment: `SNAKES_SCREENSHOTS_SIZE=2560x1440 SNAKES_SCREENSHOTS=target/screenshots`.

use std::path::PathBuf;
use std::time::Duration;

use super::display::Studio;

/// A run that has learned something, quickly.
const RUN: &str = "--preset climb --generations 30 --threads 2 --saves saves";

struct Album {
    studio: Studio,
    folder: PathBuf,
    theme: &'static str,
    size: (u32, u32),
}

impl Album {
    fn keep(&self, name: &str) {
        // What is new in a frame is complete in one of the next; the camera glides for a second.
        std::thread::sleep(Duration::from_secs(6));
        let path = self.folder.join(format!("{name}-{}.png", self.theme));
        self.studio.picture().store(&path);
    }

    /// Holds the stage at this share of the time.
    fn seek(&self, share: f64) {
        let (width, height) = self.size;
        let (left, right) = (336.0, f64::from(width) - 16.0);
        self.studio.click_at(((left + (right - left) * share) as u32, height - 50));
    }

    /// Moves the pointer to where it shows no hint.
    fn step_aside(&self) {
        self.studio.move_to((5, self.size.1 - 5));
    }
}

#[test]
#[ignore = "takes minutes, and writes into the repository; for whoever has changed what is drawn"]
fn screenshots() {
    let size = std::env::var("SNAKES_SCREENSHOTS_SIZE").unwrap_or("1280x720".to_owned());
    let (width, height) = size.split_once('x').expect("WIDTHxHEIGHT");
    let size = (width.parse().expect("a width"), height.parse().expect("a height"));
    let shipped = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/screenshots");
    let folder = PathBuf::from(std::env::var("SNAKES_SCREENSHOTS").unwrap_or(shipped.to_owned()));
    std::fs::create_dir_all(&folder).expect("a folder");
    for theme in ["light", "dark"] {
        let arguments = format!("{RUN} --theme {theme}");
        let Some(studio) = Studio::open_sized("screenshots", &arguments, size) else { return };
        studio.wait_for_title("finished");
        let album = Album { studio, folder: folder.clone(), theme, size };
        let studio = &album.studio;
        studio.key("a");
        studio.key("0");
        studio.key("space");
        album.seek(0.42);
        album.step_aside();
        album.keep("single");

        studio.key("n");
        studio.wait_for_title("showing a race of 6");
        studio.key("space");
        album.seek(0.55);
        album.step_aside();
        album.keep("race");

        studio.key("0");
        studio.wait_for_title("showing saved champion");
        studio.click_button("World");
        // The slider of the friction, from 1 down to a third.
        studio.drag(1, (77, 336), (52, 336));
        studio.wait_for_title("what if");
        studio.key("space");
        album.seek(0.5);
        album.step_aside();
        album.keep("what-if");
        drop(album);

        // One that often touches something, from near, at a moment at which it does.
        let robust =
            concat!("replay ", env!("CARGO_MANIFEST_DIR"), "/saves/robust.ron --preset quick");
        let arguments = format!("{robust} --saves others --theme {theme}");
        let Some(studio) = Studio::open_sized("screenshots", &arguments, size) else { return };
        let album = Album { studio, folder: folder.clone(), theme, size };
        let studio = &album.studio;
        studio.wait_for_title("finished");
        for key in ["a", "0", "space", "v", "j", "b"] {
            studio.key(key);
        }
        album.seek(0.3);
        std::thread::sleep(Duration::from_secs(3));
        let limb = studio.picture().find(super::is_red).expect("a red limb");
        studio.double_click_at(limb);
        album.step_aside();
        album.keep("contacts");
    }
}
