//! The list of all named actions. Menus, keys, the command palette and the list of shortcuts all read it, so they
//! cannot disagree.

use std::sync::LazyLock;

use super::Command::{self, Exam, File, Player, Run, Share, Stage, View, Window};
use super::camera_mode::CameraMode;
use super::files::{FileCommand, FileQuestion};
use super::library::LibraryCommand;
use super::modal::Modal;
use super::overlay::Overlay;
use super::panel::PanelKind;
use super::pick::Pick;
use super::{
    ExamCommand, FilmSize, PlanCommand, PlayerCommand, RunCommand, SMALL_GIF_MB, ScreenshotArea,
    ShareCommand, StageCommand, ViewCommand, WindowCommand,
};
use snakes_core::schema::named_values;
use snakes_lab::export::ExportFormat;
use snakes_lab::export::film::MOST_MB;

named_values! {
    /// A menu, which is also a group in the list of shortcuts, in the order of the menu bar. Its name is its label.
    pub enum Menu {
        /// Menu for files, pictures, and the end of the program.
        File = "File";
        /// Menu that writes the champions on the stage to files of other formats.
        Share = "Share";
        /// Menu for evolution and the choice of champions.
        Run = "Run";
        /// Menu for undo and redo.
        Edit = "Edit";
        /// Menu for playback.
        Stage = "Stage";
        /// Menu for camera, overlays, theme and size of the panels.
        View = "View";
        /// Menu that opens panels.
        Panels = "Panels";
        /// Menu for shortcuts, the command palette and the tour.
        Help = "Help";
    }
}

/// State of the program that decides which command an action sends.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Situation {
    /// Whether evolution is running.
    pub is_running: bool,
    /// Whether the stage shows a what-if: the snake beside a copy with a changed setting.
    pub is_what_if: bool,
    /// Whether the latest changed lane of the what-if can stay while another one is added.
    pub can_try_another: bool,
    /// Whether the current run is finished.
    pub is_finished: bool,
    /// Whether the stage can return to an earlier scene.
    pub can_leave: bool,
    /// Whether a modal view is open, the panels are hidden, or the stage is presented in full screen.
    pub is_covered: bool,
    /// Whether the stage is presented in full screen with no modal view over it.
    pub is_presenting: bool,
    /// Whether a file is being written from the stage.
    pub is_sharing: bool,
    /// Whether there is a change to undo.
    pub can_undo: bool,
    /// Whether there is a change to redo.
    pub can_redo: bool,
    /// Digit key that was pressed, if any. It selects a generation.
    pub digit: Option<u32>,
}

/// A named action of the menus, the keys and the command palette.
#[derive(Clone)]
pub(crate) struct Action {
    /// Menu that lists the action.
    pub menu: Menu,
    /// Label in menus and in the command palette.
    pub name: &'static str,
    /// Keyboard shortcuts, such as `Ctrl Z`. Only the first is displayed.
    pub keys: &'static [&'static str],
    /// Tooltip; empty for none.
    pub hint: &'static str,
    /// Command that the action sends in most situations.
    command: Command,
}

impl Action {
    /// Returns the command of the action in the situation `now`, or `None` if the action has no effect.
    pub fn command(&self, now: Situation) -> Option<Command> {
        match &self.command {
            Run(RunCommand::Start) if now.is_running => return Some(Run(RunCommand::Pause)),
            Stage(StageCommand::Show(Pick::Generation(_))) => {
                let shown = |generation| Stage(StageCommand::Show(Pick::Generation(generation)));
                return now.digit.map(shown);
            }
            Run(RunCommand::Start) if now.is_finished => {
                let text =
                    "This run is finished. The Watch panel continues it, or begins another one.";
                return Some(Command::Notify(text.to_owned()));
            }
            Stage(StageCommand::Leave) if now.is_covered => {
                return Some(Window(WindowCommand::CloseModal));
            }
            Stage(StageCommand::Leave) if now.is_what_if => {
                return Some(Command::Plan(PlanCommand::DropChange));
            }
            _ => {}
        }
        let is_possible = match &self.command {
            Command::Undo => now.can_undo,
            Command::Redo => now.can_redo,
            Share(ShareCommand::Cancel) => now.is_sharing,
            Share(ShareCommand::Ask(..)) => !now.is_sharing,
            Run(RunCommand::ShowHash | RunCommand::Extend) => now.is_finished,
            Stage(StageCommand::ToggleFollowEvolution) => !now.is_finished,
            Stage(StageCommand::KeepChange) => now.is_what_if,
            Stage(StageCommand::TryAnother) => now.can_try_another,
            Stage(StageCommand::Leave) => now.can_leave,
            _ => true,
        };
        is_possible.then(|| self.command.clone())
    }

    /// Returns whether the action shows or hides something on the stage.
    pub fn shows_on_stage(&self) -> bool {
        matches!(
            self.command,
            View(ViewCommand::ToggleOverlay(_)) | Window(WindowCommand::ToggleTorques)
        )
    }

    /// Returns the displayed shortcut, or an empty text.
    pub fn key(&self) -> &'static str {
        match self.keys {
            ["1", ..] => "1 ... 9",
            [first, ..] => first,
            [] => "",
        }
    }
}

/// Finds the action of a shortcut. If there is no exact match, ignores Shift.
pub(crate) fn of_keys(keys: &str) -> Option<&'static Action> {
    let exact = |keys: &str| actions().iter().find(|action| action.keys.contains(&keys));
    exact(keys).or_else(|| exact(keys.strip_prefix("Shift ")?))
}

/// Returns a tooltip, followed by the command's shortcut if it has one.
pub(crate) fn hint_with_key(hint: &str, command: &Command) -> String {
    // An action sends commands such as pausing or discarding only in these situations.
    let situations = [
        Situation::default(),
        Situation { is_running: true, ..Situation::default() },
        Situation { is_what_if: true, ..Situation::default() },
        Situation { can_leave: true, ..Situation::default() },
    ];
    let gives = |action: &&Action| {
        situations.iter().any(|now| action.command(*now).as_ref() == Some(command))
    };
    match actions().iter().find(gives).map_or("", Action::key) {
        "" => hint.to_owned(),
        key => format!("{hint} ({key})"),
    }
}

/// Name of an action, its shortcuts, and its usual command.
type ActionRow = (&'static str, &'static [&'static str], Command);

/// Returns all actions, grouped by menu.
pub(crate) fn actions() -> &'static [Action] {
    static ALL: LazyLock<Vec<Action>> = LazyLock::new(|| {
        let action = |menu, (name, keys, command)| {
            let hint = match command {
                Share(ShareCommand::Ask(_, FilmSize::Small)) => {
                    "For messages: small pictures, played twice as fast"
                }
                Share(ShareCommand::Ask(format, _)) => format.info().sentence,
                View(ViewCommand::ToggleOverlay(of)) => of.hint(),
                Window(WindowCommand::ToggleTorques) => {
                    "Torques over the whole trial, below the player"
                }
                Window(WindowCommand::ToggleLarger) => {
                    "All texts a quarter larger, or back to the usual size"
                }
                Command::Library(LibraryCommand::SaveSnake) => {
                    "The selected snake on the stage, into the library"
                }
                _ => "",
            };
            Action { menu, name, keys, hint, command }
        };
        let in_menu = |menu| rows(menu).into_iter().map(move |row| action(menu, row));
        Menu::ALL.into_iter().flat_map(in_menu).collect()
    });
    &ALL
}

/// Returns the actions of a menu, in their order.
fn rows(menu: Menu) -> Vec<ActionRow> {
    use StageCommand::{
        KeepChange, Leave, RaceGenerations, RaceKnockOuts, RaceLeaders, RaceStairs, Show,
        ShowGeneration, Single, TellStory, ToggleFollowEvolution, TryAnother,
    };
    let overlay = |of: Overlay| View(ViewCommand::ToggleOverlay(of));
    let panel = |of: PanelKind| (of.name(), of.keys(), Window(WindowCommand::OpenPanel(of)));
    let picture = |of: ScreenshotArea| View(ViewCommand::TakePicture(of));
    let scale = |larger| Window(WindowCommand::ChangeScale { larger });
    let modal = |of: Modal| Window(WindowCommand::ToggleModal(of));
    match menu {
        Menu::File => vec![
            ("New run", &["Ctrl N"], Run(RunCommand::New)),
            ("Open…", &["Ctrl O"], File(FileCommand::Ask(FileQuestion::Open))),
            ("Save snake", &["Ctrl S"], Command::Library(LibraryCommand::SaveSnake)),
            ("Import…", &["Ctrl I"], File(FileCommand::Ask(FileQuestion::Import))),
            ("Export…", &["Ctrl E"], File(FileCommand::AskExport)),
            ("Show saves folder", &[], File(FileCommand::ShowSaves)),
            ("Save picture of the stage", &["P"], picture(ScreenshotArea::Stage)),
            ("Save picture of the window", &["Shift P"], picture(ScreenshotArea::Window)),
            ("Quit", &["Ctrl Q"], Command::Quit),
        ],
        Menu::Share => {
            let mut rows: Vec<ActionRow> = Vec::new();
            for format in ExportFormat::ALL {
                let info = format.info();
                let is_gif = format == ExportFormat::Gif;
                let most =
                    if is_gif { format!(", about {MOST_MB} MB at most") } else { String::new() };
                // The list of actions is built once, so its leaked names last as long as the program.
                let name = format!("{}{most} (.{})…", info.title, info.ending).leak();
                rows.push((name, &[], Share(ShareCommand::Ask(format, FilmSize::Usual))));
                if is_gif {
                    let small = Share(ShareCommand::Ask(format, FilmSize::Small));
                    let name = format!("Small GIF, about {SMALL_GIF_MB} MB at most…").leak();
                    rows.push((name, &[], small));
                }
            }
            rows.push(("Cancel writing the file", &[], Share(ShareCommand::Cancel)));
            rows
        }
        Menu::Run => vec![
            ("Start or pause evolution", &["E"], Run(RunCommand::Start)),
            ("Evolve one generation", &["G"], Run(RunCommand::SingleGeneration)),
            ("Continue the finished run", &[], Run(RunCommand::Extend)),
            ("Repeat the run from its start", &[], Run(RunCommand::Reset)),
            ("Show the run hash", &[], Run(RunCommand::ShowHash)),
            (
                "Show a generation's champion",
                &["1", "2", "3", "4", "5", "6", "7", "8", "9"],
                Stage(Show(Pick::Generation(1))),
            ),
            ("Show the built-in champion", &["0"], Stage(Show(Pick::Opened(0)))),
            ("Follow evolution", &["W"], Stage(ToggleFollowEvolution)),
            ("Story: first, middle and latest generation", &["S"], Stage(TellStory)),
            ("Whole latest generation", &["I"], Stage(ShowGeneration(None))),
            ("Race generations", &["N"], Stage(RaceGenerations)),
            ("Race best 10 of the latest generation", &["M"], Stage(RaceLeaders(None))),
            ("Why does it climb? Copies without one joint or motion", &[], Stage(RaceKnockOuts)),
            ("Race the snake over ten staircases", &[], Stage(RaceStairs)),
            ("Examine the snake on 100 unseen staircases", &[], Exam(ExamCommand::Examine)),
        ],
        Menu::Edit => vec![
            ("Undo", &["Ctrl Z"], Command::Undo),
            ("Redo", &["Ctrl Shift Z", "Ctrl Y"], Command::Redo),
            ("Keep this change", &[], Stage(KeepChange)),
            ("Try another change beside this one", &[], Stage(TryAnother)),
            ("Only the selected snake", &[], Stage(Single)),
            ("Back to the earlier scene / Discard change", &["Esc"], Stage(Leave)),
        ],
        Menu::Stage => vec![
            ("Pause / Play", &["Space"], Player(PlayerCommand::Toggle)),
            ("Previous physics step", &["Left"], Player(PlayerCommand::Step { forward: false })),
            ("Next physics step", &["Right"], Player(PlayerCommand::Step { forward: true })),
            ("Play from start", &["R"], Player(PlayerCommand::Restart)),
            ("Go to end", &["End"], Player(PlayerCommand::SeekEnd)),
            ("Faster", &["+", "="], Player(PlayerCommand::ChangeSpeed { faster: true })),
            ("Slower", &["-"], Player(PlayerCommand::ChangeSpeed { faster: false })),
            ("Loop", &["O"], Player(PlayerCommand::ToggleLoop)),
        ],
        Menu::View => vec![
            ("Follow snake", &["F"], View(ViewCommand::ToggleFollow)),
            ("Next camera", &["C"], View(ViewCommand::NextCameraMode)),
            ("View from the side", &[], View(ViewCommand::SetCamera(CameraMode::Side))),
            ("View from above", &[], View(ViewCommand::SetCamera(CameraMode::Top))),
            ("Reset camera", &["Home"], View(ViewCommand::ResetCamera)),
            ("Contacts and forces", &["V"], overlay(Overlay::Contacts)),
            ("Joint torques", &["J"], overlay(Overlay::Torques)),
            ("Trail", &["B"], overlay(Overlay::Trail)),
            ("Fitness line", &["L"], overlay(Overlay::FitnessLine)),
            ("Collision shapes", &["D"], overlay(Overlay::Wireframe)),
            ("Torques over time", &[], Window(WindowCommand::ToggleTorques)),
            ("Next picture quality", &["A"], View(ViewCommand::NextQuality)),
            ("Dark theme", &["T"], View(ViewCommand::ToggleTheme)),
            ("Larger for a projector", &[], Window(WindowCommand::ToggleLarger)),
            ("Larger panels", &["Ctrl +", "Ctrl ="], scale(true)),
            ("Smaller panels", &["Ctrl -"], scale(false)),
            ("Reset panel size", &["Ctrl 0"], Window(WindowCommand::ResetScale)),
            ("Show only the stage", &["H"], Window(WindowCommand::TogglePanels)),
            ("Present on the full screen", &["F11", "F5"], Window(WindowCommand::TogglePresenting)),
        ],
        Menu::Panels => {
            let mut rows: Vec<ActionRow> = PanelKind::IN_MENU.iter().copied().map(panel).collect();
            rows.push(("Close panel", &["Ctrl W"], Window(WindowCommand::ClosePanel)));
            rows.push(("Reset layout", &[], Window(WindowCommand::ResetLayout)));
            rows
        }
        Menu::Help => vec![
            ("Keyboard shortcuts", &["?", "F1"], modal(Modal::Keys)),
            ("Find a command", &["Ctrl K", "Ctrl P"], modal(Modal::CommandPalette)),
            ("Take the tour", &[], modal(Modal::Tour(0))),
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn names_and_keys_are_unique() {
        let mut names = BTreeSet::new();
        let mut keys = BTreeSet::new();
        for action in actions() {
            assert!(names.insert(action.name), "{} twice", action.name);
            for key in action.keys {
                assert!(keys.insert(*key), "{key} twice");
            }
        }
    }

    #[test]
    fn actions_are_grouped_by_menu_and_no_menu_is_empty() {
        let mut menus: Vec<Menu> = actions().iter().map(|action| action.menu).collect();
        menus.dedup();
        assert_eq!(menus, Menu::ALL);
    }

    #[test]
    fn shift_is_ignored_unless_the_shortcut_exists_with_shift() {
        assert_eq!(of_keys("Shift R").map(|action| action.name), Some("Play from start"));
        assert_eq!(
            of_keys("Shift P").map(|action| action.name),
            Some("Save picture of the window")
        );
        assert!(of_keys("Ctrl R").is_none());
    }
}
