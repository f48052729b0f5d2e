//! Sharing champions from the stage, and the arguments of the process that writes their file.

use super::*;
use crate::studio::state::current_run::climber;

fn look() -> StageLook {
    let overlays = vec![Overlay::Trail, Overlay::Wireframe, Overlay::Torques];
    StageLook { camera: CameraMode::Free, theme: Theme::Dark, overlays }
}

#[test]
fn a_film_looks_like_the_stage_and_a_table_has_no_look() {
    let words = |format: ExportFormat, size: FilmSize| -> Vec<String> {
        let path = PathBuf::from(format!("a.{}", format.info().ending));
        let arguments = arguments(format, &path, (&look(), size));
        arguments.iter().map(|word| word.to_string_lossy().into_owned()).collect()
    };
    let film = words(ExportFormat::Gif, FilmSize::Usual).join(" ");
    assert_eq!(film, "--output a.gif --camera follow --theme dark --show trail,torques");
    let small = words(ExportFormat::Gif, FilmSize::Small).join(" ");
    assert_eq!(small, format!("{film} --speed 2 --most-mb 2"));
    assert_eq!(words(ExportFormat::Csv, FilmSize::Usual).join(" "), "--output a.csv");
}

#[test]
fn the_ending_is_added_if_it_is_missing() {
    let named = |name: &str| with_ending(Path::new(name), ExportFormat::Mp4);
    assert_eq!(named("/a/b"), PathBuf::from("/a/b.mp4"));
    assert_eq!(named("/a/b.MP4"), PathBuf::from("/a/b.MP4"));
    assert_eq!(named("/a/v1.2"), PathBuf::from("/a/v1.2.mp4"), "no ending of a format");
}

#[test]
fn a_champion_in_a_changed_world_is_shared_with_its_result_there() {
    let found = climber(0);
    let (name, champion) = shared(&found).expect("shared")();
    assert_eq!((name.as_str(), &champion), ("climber", found.champion()));
    let mut icy = found.trial().clone();
    icy.surface.friction = 0.05;
    let changed = found.in_world(&icy, "friction 0.05".to_owned());
    let (name, champion) = shared(&changed).expect("shared")();
    assert_eq!((name.as_str(), &champion.trial), ("friction 0.05", &icy));
    assert_eq!(champion.evaluation, evaluate(&champion.genome, &icy));
    assert_ne!(champion.evaluation, found.champion().evaluation);
}

#[test]
fn without_a_file_under_way_there_is_nothing_to_cancel() {
    let mut shares = Shares::default();
    assert_eq!(shares.cancel(), Err("No file is being written.".to_owned()));
    assert_eq!((shares.progress(), shares.busy()), (None, None));
}

#[test]
fn a_stage_or_a_path_that_does_not_suit_the_file_is_refused_in_a_sentence() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("climb.csv"), "mine").expect("written");
    for (format, found, name, problem) in [
        (ExportFormat::Csv, 0, "a.csv", "There is no snake on the stage."),
        (
            ExportFormat::Html,
            7,
            "race",
            "A .html file holds up to 6 snakes, and 7 are on the stage. Race fewer.",
        ),
        (
            ExportFormat::Mjcf,
            2,
            "race",
            "A .xml file holds one snake, and 2 are on the stage. Leave the race with the one that you want.",
        ),
        // A file that exists under the added ending is not replaced.
        (ExportFormat::Csv, 1, "climb", "climb.csv exists already; choose another name."),
    ] {
        let (race, path) = (vec![climber(0); found], folder.path().join(name));
        let refused = Shares::default().begin(format, &path, &race, (&look(), FilmSize::Usual));
        assert_eq!(refused, Err(problem.to_owned()));
    }
}

#[test]
fn a_file_holds_the_snakes_for_which_it_was_asked_whatever_the_stage_shows_at_the_answer() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.xml");
    let mut shares = Shares::default();
    let asked = |shares: &mut Shares, found: usize| {
        let number = shares.ask((0..found).map(climber).collect(), look(), FilmSize::Usual);
        shares.ask(vec![climber(0)], look(), FilmSize::Usual);
        shares.begin_asked(ExportFormat::Mjcf, &path, number)
    };
    // The number of snakes in the refusal tells which ones would be written.
    assert!(asked(&mut shares, 0).is_err_and(|why| why.contains("no snake")));
    assert!(asked(&mut shares, 3).is_err_and(|why| why.contains("and 3 are on the stage")));
    assert!(shares.begin_asked(ExportFormat::Mjcf, &path, 1).is_err(), "it was answered");
}
