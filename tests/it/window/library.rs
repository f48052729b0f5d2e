//! The library with real mouse and keys, and its effects on the files.

use std::fs;
use std::path::{Path, PathBuf};

use super::display::Studio;
use super::places::Place;

/// Makes a folder of saves with two champions and a damaged file, and returns its path.
fn saves(folder: &Path) -> PathBuf {
    let saves = folder.join("saves");
    fs::create_dir(&saves).expect("created");
    let shipped = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/saves"));
    for (from, to) in [("climber", "zebra-one"), ("robust", "zebra-two")] {
        let to = saves.join(format!("{to}.ron"));
        fs::copy(shipped.join(format!("{from}.ron")), to).expect("copied");
    }
    fs::write(saves.join("zebra-broken.ron"), "(kind: \"nothing\"").expect("written");
    saves
}

/// Opens a studio whose library shows only the three files of `saves`.
fn with_zebras(test: &str, saves: &Path) -> Option<Studio> {
    let arguments = format!("--preset quick --saves {}", saves.display());
    let studio = Studio::open(test, &arguments)?;
    studio.pause_evolution();
    studio.open_panel("Library");
    studio.place_of("TextInput", "Search the library");
    studio.type_into("Search the library", "zebra");
    wait_for_count(&studio, "3 of ");
    Some(studio)
}

/// Waits until this number of saves is listed.
fn wait_for_count(studio: &Studio, count: &str) {
    studio.place_where(count, |place| {
        place.label.starts_with(count) && place.label.contains(" saves")
    });
}

/// Waits for the row of a loaded save with this name.
fn row(studio: &Studio, name: &str) -> Place {
    let start = format!("{name}, ");
    studio.place_where(name, |place| {
        place.role == "Button"
            && place.label.starts_with(&start)
            && !place.label.contains("not read yet")
    })
}

/// Selects a save by a click on its row, which also gives the list the keyboard focus.
fn choose(studio: &Studio, name: &str) {
    studio.click_at(row(studio, name).area.middle());
    studio.wait(|| row(studio, name).value == "on", || format!("{name} to be chosen"));
}

/// Waits for a caption with this name under the stage.
fn wait_for_caption(studio: &Studio, name: &str) {
    let left = studio.stage().left;
    studio.place_where(name, |place| {
        place.role == "Label" && place.label.contains(name) && place.area.left >= left
    });
}

#[test]
fn saves_are_searched_replayed_and_raced() {
    let folder = super::folder();
    let Some(studio) = with_zebras("library", &saves(folder.path())) else { return };
    let broken = row(&studio, "zebra-broken");
    assert!(broken.label.contains("damaged"), "{}", broken.label);
    studio.double_click_at(row(&studio, "zebra-two").area.middle());
    wait_for_caption(&studio, "zebra-two");
    choose(&studio, "zebra-one");
    studio.click_with("ctrl", &row(&studio, "zebra-two"));
    studio.place_with("2 selected");
    studio.key("Return");
    studio.wait_for_title("showing a race of 2");
    studio.type_into("Search the library", "zebra damaged");
    wait_for_count(&studio, "1 of ");
    assert!(studio.find(|place| place.label.starts_with("zebra-one,")).is_none());
}

#[test]
fn a_save_is_renamed_deleted_and_restored() {
    let folder = super::folder();
    let saves = saves(folder.path());
    let Some(studio) = with_zebras("library-files", &saves) else { return };
    let is_there = |name: &str| saves.join(format!("{name}.ron")).is_file();
    let wait_for = |name: &str, is: bool| {
        studio.wait(|| is_there(name) == is, || format!("{name} to be there: {is}"));
    };
    choose(&studio, "zebra-one");
    studio.key("F2");
    studio.place_of("TextInput", "New name");
    studio.retype("zebra-best");
    studio.key("Return");
    wait_for("zebra-best", true);
    assert!(!is_there("zebra-one"));
    choose(&studio, "zebra-best");
    studio.key("Delete");
    wait_for("zebra-best", false);
    wait_for_count(&studio, "2 of ");
    studio.key("ctrl+z");
    wait_for("zebra-best", true);
    studio.key("ctrl+z");
    wait_for("zebra-one", true);
    assert!(!is_there("zebra-best"));
}
