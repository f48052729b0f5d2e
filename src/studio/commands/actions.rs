//! The list of all named actions. Menus, keys, the command palette and the list of shortcuts all read this one list, so
//! they cannot disagree.

use std::sync::LazyLock;

use super::camera_mode::CameraMode;
use super::files::{FileCommand, FileQuestion};
use super::modal::Modal;
use super::overlay::Overlay;
use super::panel::PanelKind;
use super::pick::Pick;
use super::screenshot_area::ScreenshotArea;
use super::share::ShareCommand;
use super::{
    Command, ExamCommand, PlanCommand, PlayerCommand, RunCommand, StageCommand, ViewCommand,
    WindowCommand,
};
use snakes_lab::export::ExportFormat;

/// A menu, and a group in the list of shortcuts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Menu {
    /// Files, pictures, and the end of the program.
    File,
    /// Files of other formats, from the champions on the stage.
    Share,
    /// Evolution, and the choice of champions.
    Run,
    /// Undo and redo.
    Edit,
    /// Playback.
    Stage,
    /// Camera, overlays, theme and pictures.
    View,
    /// Panels.
    Panels,
    /// Help.
    Help,
}

impl Menu {
    /// All menus, in the order of the menu bar.
    pub const ALL: [Self; 8] = [
        Self::File,
        Self::Share,
        Self::Run,
        Self::Edit,
        Self::Stage,
        Self::View,
        Self::Panels,
        Self::Help,
    ];

    /// Label.
    pub fn name(self) -> &'static str {
        match self {
            Self::File => "File",
            Self::Share => "Share",
            Self::Run => "Run",
            Self::Edit => "Edit",
            Self::Stage => "Stage",
            Self::View => "View",
            Self::Panels => "Panels",
            Self::Help => "Help",
        }
    }
}

/// The state that decides which command an action stands for.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Situation {
    /// Evolution is running.
    pub is_running: bool,
    /// The stage shows a what-if.
    pub is_what_if: bool,
    /// The latest lane of the what-if can stay beside another one.
    pub can_try_another: bool,
    /// The stage shows a race or a whole generation.
    pub is_race: bool,
    /// A modal view is open, the panels are hidden, or the stage is presented on the full screen.
    pub is_covered: bool,
    /// The stage is presented on the full screen, with nothing over it.
    pub is_presenting: bool,
    /// A file is being written from the stage.
    pub is_sharing: bool,
    /// There is a change to undo.
    pub can_undo: bool,
    /// There is a change to redo.
    pub can_redo: bool,
    /// The digit key that was pressed, if any.
    pub digit: Option<u32>,
}

/// A named action.
#[derive(Clone, Copy)]
pub(crate) struct Action {
    /// Menu that lists the action.
    pub menu: Menu,
    /// Label.
    pub name: &'static str,
    /// Keyboard shortcuts, such as `Ctrl Z`. The first is the one that is displayed.
    pub keys: &'static [&'static str],
    asks: ActionCommand,
}

/// The way from a situation to an action's command.
#[derive(Clone, Copy)]
enum ActionCommand {
    /// The action in this situation.
    Of(fn(Situation) -> Option<Command>),
    /// A file of this format.
    File(ExportFormat),
}

const fn action(
    menu: Menu,
    name: &'static str,
    keys: &'static [&'static str],
    asks: fn(Situation) -> Option<Command>,
) -> Action {
    Action { menu, name, keys, asks: ActionCommand::Of(asks) }
}

impl Action {
    /// The command in this situation; `None` if there is nothing to do.
    pub fn command(&self, now: Situation) -> Option<Command> {
        match &self.asks {
            ActionCommand::Of(asks) => asks(now),
            ActionCommand::File(_) if now.is_sharing => None,
            ActionCommand::File(format) => Some(Command::Share(ShareCommand::Ask(*format))),
        }
    }

    /// Explanation for the mouse; may be empty.
    pub fn hint(&self) -> &'static str {
        match &self.asks {
            ActionCommand::Of(_) => "",
            ActionCommand::File(format) => format.info().sentence,
        }
    }

    /// The displayed shortcut, or an empty text.
    pub fn key(&self) -> &'static str {
        match self.keys {
            ["1", ..] => "1 ... 9",
            [first, ..] => first,
            [] => "",
        }
    }
}

/// The action of a shortcut. Without an exact match, Shift is ignored.
pub(crate) fn of_keys(keys: &str) -> Option<&'static Action> {
    let exact = |keys: &str| actions().iter().find(|action| action.keys.contains(&keys));
    exact(keys).or_else(|| exact(keys.strip_prefix("Shift ")?))
}

/// All actions, grouped by menu.
pub(crate) fn actions() -> &'static [Action] {
    static ALL: LazyLock<Vec<Action>> = LazyLock::new(|| {
        let of_files = FIXED.iter().take_while(|action| action.menu == Menu::File).count();
        let (files, rest) = FIXED.split_at(of_files);
        [files, &ExportFormat::ALL.map(file_of), rest].concat()
    });
    &ALL
}

/// The action that writes a file of a format.
fn file_of(format: ExportFormat) -> Action {
    let info = format.info();
    // The list of actions is made once, and its names last as long as the program.
    let name = format!("{} (.{})…", info.title, info.ending).leak();
    Action { menu: Menu::Share, name, keys: &[], asks: ActionCommand::File(format) }
}

/// The actions that do not depend on other lists.
const FIXED: &[Action] = &[
    action(Menu::File, "New run…", &["Ctrl N"], |_| {
        Some(Command::Window(WindowCommand::OpenPanel(PanelKind::Run)))
    }),
    action(Menu::File, "Open…", &["Ctrl O"], |_| {
        Some(Command::File(FileCommand::Ask(FileQuestion::Open)))
    }),
    action(Menu::File, "Import…", &["Ctrl I"], |_| {
        Some(Command::File(FileCommand::Ask(FileQuestion::Import)))
    }),
    action(Menu::File, "Export…", &["Ctrl E"], |_| Some(Command::File(FileCommand::AskExport))),
    action(Menu::File, "Show saves folder", &[], |_| Some(Command::File(FileCommand::ShowSaves))),
    action(Menu::File, "Save picture of the stage", &["P"], |_| {
        Some(Command::View(ViewCommand::TakePicture(ScreenshotArea::Stage)))
    }),
    action(Menu::File, "Save picture of the window", &["Shift P"], |_| {
        Some(Command::View(ViewCommand::TakePicture(ScreenshotArea::Window)))
    }),
    action(Menu::File, "Quit", &["Ctrl Q"], |_| Some(Command::Quit)),
    action(Menu::Share, "Cancel writing the file", &[], |now| {
        now.is_sharing.then_some(Command::Share(ShareCommand::Cancel))
    }),
    action(Menu::Run, "Start or pause evolution", &["E"], |now| {
        Some(if now.is_running {
            Command::Run(RunCommand::Pause)
        } else {
            Command::Run(RunCommand::Start)
        })
    }),
    action(Menu::Run, "Evolve one generation", &["G"], |_| {
        Some(Command::Run(RunCommand::SingleGeneration))
    }),
    action(Menu::Run, "Reset the run", &[], |_| Some(Command::Run(RunCommand::Reset))),
    action(
        Menu::Run,
        "Show a generation's champion",
        &["1", "2", "3", "4", "5", "6", "7", "8", "9"],
        |now| {
            now.digit
                .map(|generation| Command::Stage(StageCommand::Show(Pick::Generation(generation))))
        },
    ),
    action(Menu::Run, "Show the saved champion", &["0"], |_| {
        Some(Command::Stage(StageCommand::Show(Pick::Opened(0))))
    }),
    action(Menu::Run, "Follow evolution", &["W"], |_| {
        Some(Command::Stage(StageCommand::ToggleFollowEvolution))
    }),
    action(Menu::Run, "Story: first, middle and latest generation", &["S"], |_| {
        Some(Command::Stage(StageCommand::TellStory))
    }),
    action(Menu::Run, "Whole latest generation", &["I"], |_| {
        Some(Command::Stage(StageCommand::ShowGeneration(None)))
    }),
    action(Menu::Run, "Race generations", &["N"], |_| {
        Some(Command::Stage(StageCommand::RaceGenerations))
    }),
    action(Menu::Run, "Race best 10 of the latest generation", &["M"], |_| {
        Some(Command::Stage(StageCommand::RaceLeaders(None)))
    }),
    action(Menu::Run, "Race the snake over ten staircases", &[], |_| {
        Some(Command::Stage(StageCommand::RaceStairs))
    }),
    action(Menu::Run, "Examine the snake on 100 unseen staircases", &[], |_| {
        Some(Command::Exam(ExamCommand::Examine))
    }),
    action(Menu::Edit, "Undo", &["Ctrl Z"], |now| now.can_undo.then_some(Command::Undo)),
    action(Menu::Edit, "Redo", &["Ctrl Shift Z", "Ctrl Y"], |now| {
        now.can_redo.then_some(Command::Redo)
    }),
    action(Menu::Edit, "Keep this change", &[], |now| {
        now.is_what_if.then_some(Command::Stage(StageCommand::KeepChange))
    }),
    action(Menu::Edit, "Try another change beside this one", &[], |now| {
        now.can_try_another.then_some(Command::Stage(StageCommand::TryAnother))
    }),
    action(Menu::Edit, "Leave race / Discard change", &["Esc"], |now| match now {
        Situation { is_covered: true, .. } => Some(Command::Window(WindowCommand::CloseModal)),
        Situation { is_what_if: true, .. } => Some(Command::Plan(PlanCommand::DropChange)),
        Situation { is_race: true, .. } => Some(Command::Stage(StageCommand::Single)),
        _ => None,
    }),
    action(Menu::Stage, "Pause / Play", &["Space"], |_| {
        Some(Command::Player(PlayerCommand::Toggle))
    }),
    action(Menu::Stage, "Previous physics step", &["Left"], |_| {
        Some(Command::Player(PlayerCommand::Step { forward: false }))
    }),
    action(Menu::Stage, "Next physics step", &["Right"], |_| {
        Some(Command::Player(PlayerCommand::Step { forward: true }))
    }),
    action(Menu::Stage, "Play from start", &["R"], |_| {
        Some(Command::Player(PlayerCommand::Restart))
    }),
    action(Menu::Stage, "Go to end", &["End"], |_| Some(Command::Player(PlayerCommand::SeekEnd))),
    action(Menu::Stage, "Faster", &["+", "="], |_| {
        Some(Command::Player(PlayerCommand::ChangeSpeed { faster: true }))
    }),
    action(Menu::Stage, "Slower", &["-"], |_| {
        Some(Command::Player(PlayerCommand::ChangeSpeed { faster: false }))
    }),
    action(Menu::Stage, "Loop", &["O"], |_| Some(Command::Player(PlayerCommand::ToggleLoop))),
    action(Menu::View, "Follow snake", &["F"], |_| Some(Command::View(ViewCommand::ToggleFollow))),
    action(Menu::View, "Next camera", &["C"], |_| Some(Command::View(ViewCommand::NextCameraMode))),
    action(Menu::View, "View from the side", &[], |_| {
        Some(Command::View(ViewCommand::SetCamera(CameraMode::Side)))
    }),
    action(Menu::View, "View from above", &[], |_| {
        Some(Command::View(ViewCommand::SetCamera(CameraMode::Top)))
    }),
    action(Menu::View, "Reset camera", &["Home"], |_| {
        Some(Command::View(ViewCommand::ResetCamera))
    }),
    action(Menu::View, "Contacts and forces", &["V"], |_| {
        Some(Command::View(ViewCommand::ToggleOverlay(Overlay::Contacts)))
    }),
    action(Menu::View, "Joint torques", &["J"], |_| {
        Some(Command::View(ViewCommand::ToggleOverlay(Overlay::Torques)))
    }),
    action(Menu::View, "Trail", &["B"], |_| {
        Some(Command::View(ViewCommand::ToggleOverlay(Overlay::Trail)))
    }),
    action(Menu::View, "Fitness line", &["L"], |_| {
        Some(Command::View(ViewCommand::ToggleOverlay(Overlay::FitnessLine)))
    }),
    action(Menu::View, "Collision shapes", &["D"], |_| {
        Some(Command::View(ViewCommand::ToggleOverlay(Overlay::Wireframe)))
    }),
    action(Menu::View, "Anti-aliasing", &["A"], |_| {
        Some(Command::View(ViewCommand::ToggleSmoothEdges))
    }),
    action(Menu::View, "Dark theme", &["T"], |_| Some(Command::View(ViewCommand::ToggleTheme))),
    action(Menu::View, "Larger panels", &["Ctrl +", "Ctrl ="], |_| {
        Some(Command::Window(WindowCommand::ChangeScale { larger: true }))
    }),
    action(Menu::View, "Smaller panels", &["Ctrl -"], |_| {
        Some(Command::Window(WindowCommand::ChangeScale { larger: false }))
    }),
    action(Menu::View, "Reset panel size", &["Ctrl 0"], |_| {
        Some(Command::Window(WindowCommand::ResetScale))
    }),
    action(Menu::View, "Show only the stage", &["H"], |_| {
        Some(Command::Window(WindowCommand::TogglePanels))
    }),
    action(Menu::View, "Present on the full screen", &["F11", "F5"], |_| {
        Some(Command::Window(WindowCommand::TogglePresenting))
    }),
    action(Menu::Panels, "Run", &["Ctrl 1"], |_| {
        Some(Command::Window(WindowCommand::OpenPanel(PanelKind::Run)))
    }),
    action(Menu::Panels, "World", &["Ctrl 2"], |_| {
        Some(Command::Window(WindowCommand::OpenPanel(PanelKind::World)))
    }),
    action(Menu::Panels, "Charts", &["Ctrl 3"], |_| {
        Some(Command::Window(WindowCommand::OpenPanel(PanelKind::Charts)))
    }),
    action(Menu::Panels, "Champions", &["Ctrl 4"], |_| {
        Some(Command::Window(WindowCommand::OpenPanel(PanelKind::Champions)))
    }),
    action(Menu::Panels, "Library", &["Ctrl 5"], |_| {
        Some(Command::Window(WindowCommand::OpenPanel(PanelKind::Library)))
    }),
    action(Menu::Panels, "Lessons", &["Ctrl 6"], |_| {
        Some(Command::Window(WindowCommand::OpenPanel(PanelKind::Lessons)))
    }),
    action(Menu::Panels, "Senses", &["Ctrl 7"], |_| {
        Some(Command::Window(WindowCommand::OpenPanel(PanelKind::Senses)))
    }),
    action(Menu::Panels, "Machines", &["Ctrl 8"], |_| {
        Some(Command::Window(WindowCommand::OpenPanel(PanelKind::Machines)))
    }),
    action(Menu::Panels, "Body", &["Ctrl 9"], |_| {
        Some(Command::Window(WindowCommand::OpenPanel(PanelKind::Body)))
    }),
    action(Menu::Panels, "Stairs", &["Ctrl T"], |_| {
        Some(Command::Window(WindowCommand::OpenPanel(PanelKind::Stairs)))
    }),
    action(Menu::Panels, "Close panel", &["Ctrl W"], |_| {
        Some(Command::Window(WindowCommand::ClosePanel))
    }),
    action(Menu::Panels, "Reset layout", &[], |_| {
        Some(Command::Window(WindowCommand::ResetLayout))
    }),
    action(Menu::Help, "Keyboard shortcuts", &["?", "F1"], |_| {
        Some(Command::Window(WindowCommand::ToggleModal(Modal::Keys)))
    }),
    action(Menu::Help, "Find a command", &["Ctrl K", "Ctrl P"], |_| {
        Some(Command::Window(WindowCommand::ToggleModal(Modal::CommandPalette)))
    }),
    action(Menu::Help, "Take the tour", &[], |_| {
        Some(Command::Window(WindowCommand::ToggleModal(Modal::Tour(0))))
    }),
];

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
