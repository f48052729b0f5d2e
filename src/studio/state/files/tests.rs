//! Tests of the answers of dialogs, with a folder of saves and without any window.

use super::*;
use snakes_core::save::SavesFolder;
use snakes_core::save::library::SavePlace;
use snakes_core::save::{shipped_champion, store_champion};

/// The state of files and a library in an empty folder, and a champion elsewhere.
struct Tried {
    _folder: tempfile::TempDir,
    champion: PathBuf,
    library: Library,
    files: Files,
    history: UndoHistory,
    notices: Notices,
}

impl Tried {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(&folder.path().join("saves")));
        let champion = folder.path().join("mine.ron");
        let loaded = shipped_champion().expect("well formed");
        store_champion(&champion, &loaded.champion, None).expect("written");
        Self {
            library: Library::new(saves),
            champion,
            files: Files::default(),
            history: UndoHistory::default(),
            notices: Notices::default(),
            _folder: folder,
        }
    }

    fn apply(&mut self, command: &FileCommand) -> Result<Option<Show>, String> {
        self.files.apply(command, &mut self.library, &mut self.history, &mut self.notices)
    }
}

#[test]
fn a_file_is_opened_on_the_stage_without_being_imported_and_is_remembered() {
    let mut tried = Tried::new();
    let paths = vec![tried.champion.clone()];
    let open = FileCommand::Answer(FileQuestion::Open, paths.clone());
    let show = tried.apply(&open).expect("read").expect("shown");
    assert_eq!(show.champions[0].name(), "mine");
    assert_eq!(tried.files.recent.0, paths);
    assert!(!tried.library.saves.path().exists(), "nothing was copied");
    std::fs::remove_file(&tried.champion).expect("removed");
    let error = tried.apply(&open).expect_err("gone");
    assert!(error.contains("mine.ron: cannot be read"), "{error}");
    assert_eq!(tried.files.recent.0.len(), 0, "it is no longer offered");
}

#[test]
fn without_a_system_dialog_the_library_asks_for_the_path_and_says_why() {
    let mut tried = Tried::new();
    let answer = Err("No portal.".to_owned());
    let commands = answer_to(FileQuestion::Import, answer, &mut tried.library);
    let open = Command::Window(WindowCommand::OpenPanel(PanelKind::Library));
    assert_eq!(commands, [open]);
    let expected = (FileQuestion::Import, "No portal.".to_owned());
    assert_eq!(tried.library.unanswered, (1, Some(expected)));
    let cancelled = answer_to(FileQuestion::Import, Ok(Vec::new()), &mut tried.library);
    assert_eq!(cancelled, []);
    let chosen = vec![tried.champion.clone()];
    let commands = answer_to(FileQuestion::Import, Ok(chosen.clone()), &mut tried.library);
    assert_eq!(commands, [Command::File(FileCommand::Answer(FileQuestion::Import, chosen))]);
}

#[test]
fn while_a_dialog_does_not_answer_a_second_question_is_asked_in_the_window() {
    let mut tried = Tried::new();
    tried.apply(&FileCommand::Ask(FileQuestion::Open)).expect("asked");
    assert_eq!(tried.files.wanted, Some(FileQuestion::Open));
    let (end, waits) = crossbeam_channel::bounded::<()>(0);
    let hidden = move || {
        let _ = waits.recv();
        Ok(Vec::new())
    };
    let hidden = BackgroundTask::start(hidden).expect("a thread");
    tried.files.asked = Some((FileQuestion::Open, hidden));
    tried.apply(&FileCommand::Ask(FileQuestion::Import)).expect("asked");
    let unasked = tried.files.unasked.take().expect("asked in the window");
    assert_eq!(unasked, (FileQuestion::Import, OPEN_ALREADY.to_owned()));
    drop(end);
}

#[test]
fn each_question_becomes_a_command_to_the_library() {
    let path = PathBuf::from("/runs/climb-seed1/run.ron");
    let places = vec![SavePlace::Shipped("fast")];
    for (question, expected) in [
        (FileQuestion::Open, LibraryCommand::Replay(SavePlace::Run("/runs/climb-seed1".into()))),
        (FileQuestion::Import, LibraryCommand::Import(vec![path.clone()])),
        (
            FileQuestion::Export(places.clone()),
            LibraryCommand::Export { places, to: Some(path.clone()) },
        ),
    ] {
        assert_eq!(request(&question, std::slice::from_ref(&path)), Some(expected));
    }
}

#[test]
fn a_folder_or_a_picture_that_does_not_exist_is_reported() {
    let gone = PathBuf::from("/nowhere/at/all");
    for (command, problem) in [
        (FileCommand::OpenFolder(gone.clone()), "/nowhere/at/all: cannot be opened"),
        (FileCommand::CopyPicture(gone), "The picture could not be copied: "),
    ] {
        let mut tried = Tried::new();
        tried.apply(&command).expect("begun");
        while tried.notices.len() == 0 {
            tried.files.report(&mut tried.notices);
        }
        let report = tried.notices.last().expect("shown");
        assert!(report.starts_with(problem), "{report}");
    }
}
