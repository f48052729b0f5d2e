//! Text as people and other programs leave it: byte order marks, line ends and encodings.

use super::*;
use crate::save::library::fixtures::{champion_in, run_in, saves};
use crate::save::library::{read_notes, set_notes_text};
use crate::save::{
    Preferences, PreferencesFile, SavedProgress, load_champion, load_plan, load_preset, load_stairs,
};

/// Puts a byte order mark before a file, and turns its line ends into those of Windows.
fn convert(path: &Path) {
    let text = fs::read_to_string(path).expect("text");
    assert!(text.contains('\n') && !text.contains('\r'), "{}", path.display());
    fs::write(path, format!("\u{feff}{}", text.replace('\n', "\r\n"))).expect("written");
}

#[test]
fn f7_byte_order_marks_and_other_line_ends_change_nothing_in_any_file() {
    let (folder, saves) = saves();
    let assets = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets");
    let copied = |from: &str, name: &str| {
        let path = folder.path().join(name);
        fs::copy(format!("{assets}/{from}"), &path).expect("copied");
        path.to_string_lossy().into_owned()
    };
    let champion = champion_in(&saves, "mine");
    set_notes_text(&champion, "two\nlines").expect("noted");
    let champion_path = champion.path().expect("a file").to_owned();
    let preset = copied("presets/ice.ron", "ice.preset");
    let stairs = copied("stairs/ramps.ron", "ramps.stairs");
    let preferences = PreferencesFile::at(&folder.path().join("studio.ron"));
    preferences.store(&Preferences::default()).expect("written");
    let run = run_in(&saves, 1);
    let run_path = run.path().expect("a folder").to_owned();
    let read = || {
        let plan = load_plan(&run_path).expect("whole");
        let progress = SavedProgress::read(&run_path, &plan).expect("whole");
        assert_eq!((progress.records.len(), progress.lineage.len()), (2, 0));
        (
            (load_champion(&champion_path).expect("whole"), read_notes(&champion)),
            (load_preset(&preset).expect("whole"), load_stairs(&stairs).expect("whole")),
            (preferences.load().expect("whole"), plan, progress),
        )
    };
    // The state of a strategy is kept as text, in which line ends have no meaning.
    let show = |all| format!("{all:?}").replace("\\r\\n", "\\n");
    let before = show(read());
    let of_run = fs::read_dir(&run_path).expect("a folder").map(|of| of.expect("one").path());
    let of_run = of_run
        .filter(|path| path.extension().is_some() && path.metadata().is_ok_and(|of| of.len() > 0));
    let others = ["mine.ron", "mine.about", "ice.preset", "ramps.stairs", "studio.ron"];
    let all: Vec<PathBuf> =
        others.map(|name| folder.path().join(name)).into_iter().chain(of_run).collect();
    assert!(all.len() >= 5 + 6, "{all:?}");
    all.iter().for_each(|path| convert(path));
    assert!(show(read()) == before, "a value differs");
}

#[test]
fn f7_text_in_another_encoding_is_refused_with_the_place_and_the_cause() {
    let path = Path::new("a.ron");
    let utf_16 = |text: &str| -> Vec<u8> {
        "\u{feff}".encode_utf16().chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect()
    };
    for (bytes, expected) in [
        (b"(\n  name: \"caf\xE9\")".to_vec(), "line 2, column 13: not UTF-8 text"),
        (utf_16("(name: 1)"), "line 1, column 1: the text is UTF-16; save it as UTF-8"),
    ] {
        let error = text_of(path, bytes).expect_err("no UTF-8").to_string();
        assert_eq!(error, format!("a.ron: damaged or incomplete at {expected}"));
    }
    assert_eq!(text_of(path, b"\xEF\xBB\xBF(".to_vec()).expect("text"), "(");
}
