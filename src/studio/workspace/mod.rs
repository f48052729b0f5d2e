//! State of the window: panel layout, UI scale, modal view.

pub mod layout;
pub mod scale;
pub mod widths;

use std::collections::BTreeSet;

use bevy::prelude::*;

use super::commands::WindowCommand;
use super::commands::modal::Modal;
use super::commands::panel::PanelKind;
use super::schedule::FrameSet;
use super::state::options::Options;

use layout::Layout;
use scale::UiScale;

/// Key under which the choice to show torques over time is remembered.
const TORQUES: &str = "Torques of the player";

/// State of the window: panel layout, UI scale, modal view.
#[derive(Resource, Debug, Default)]
pub(super) struct Workspace {
    /// Layout of the panels.
    pub layout: Layout,
    /// UI scale; 1 is the default.
    pub scale: UiScale,
    /// Whether the panels are hidden.
    pub is_bare: bool,
    /// Whether the tour was neither finished nor skipped, now or in an earlier run of the program.
    pub awaits_tour: bool,
    /// Titles of the sections whose advanced settings are unfolded.
    pub unfolded: BTreeSet<String>,
    /// Whether the stage is presented in full screen: without panels and cards, under a large caption.
    pub is_presenting: bool,
    /// Whether the screen is black in the presenting mode.
    pub is_black: bool,
    /// Whether a menu is open.
    pub is_menu_open: bool,
    /// Label of the setting to scroll to, until the settings panel has handled it.
    pub sought: Option<&'static str>,
    modal: Option<Modal>,
}

impl Workspace {
    /// Creates the initial state, with or without the tour, and in the presenting mode or not.
    pub fn new(tour_is_over: bool, is_presenting: bool) -> Self {
        Self { awaits_tour: !tour_is_over, is_presenting, ..Self::default() }
    }

    /// Returns the open modal view. A tour is hidden in the presenting mode, because it points at panels.
    pub fn modal(&self) -> Option<Modal> {
        self.modal.filter(|modal| !self.is_presenting || !matches!(modal, Modal::Tour(_)))
    }

    /// Returns whether the player shows the torques of each joint over time.
    pub fn shows_torques(&self) -> bool {
        self.unfolded.contains(TORQUES)
    }

    /// Returns whether the presenting mode currently shows a black screen instead of the stage.
    pub fn is_black(&self) -> bool {
        self.is_presenting && self.is_black
    }

    /// Executes a window command. Returns a message for the user if the command has no effect.
    pub fn apply(&mut self, command: &WindowCommand) -> Option<&'static str> {
        match command {
            WindowCommand::OpenPanel(kind) => self.open(*kind),
            WindowCommand::FindSetting(label) => {
                self.open(PanelKind::World);
                self.sought = Some(label);
            }
            WindowCommand::ClosePanel => self.layout.close_front(),
            WindowCommand::ResetLayout => self.layout.reset(),
            // The presenting mode shows no panels, and its end restores what was visible before it.
            WindowCommand::TogglePanels if self.is_presenting => {}
            WindowCommand::TogglePanels => self.is_bare = !self.is_bare,
            WindowCommand::TogglePresenting => {
                (self.is_presenting, self.is_black) = (!self.is_presenting, false);
            }
            WindowCommand::EndPresenting => {
                (self.is_presenting, self.is_black) = (false, false);
            }
            WindowCommand::ToggleBlack => self.is_black = !self.is_black,
            WindowCommand::ChangeScale { larger } => return self.scale.change(*larger).err(),
            WindowCommand::ToggleLarger => return self.scale.toggle_larger().err(),
            WindowCommand::ResetScale => self.scale.chosen = 1.0,
            WindowCommand::Fold { section, is_open: true } => {
                self.unfolded.insert((*section).to_owned());
            }
            WindowCommand::Fold { section, is_open: false } => {
                self.unfolded.remove(*section);
            }
            WindowCommand::ToggleTorques => {
                if !self.unfolded.remove(TORQUES) {
                    self.unfolded.insert(TORQUES.to_owned());
                }
            }
            WindowCommand::ToggleModal(modal) => self.toggle_modal(*modal),
            WindowCommand::CloseModal if self.modal().is_some() => self.show_modal(None),
            WindowCommand::CloseModal if self.is_presenting => {
                return self.apply(&WindowCommand::EndPresenting);
            }
            WindowCommand::CloseModal => self.is_bare = false,
        }
        None
    }

    /// Brings a panel to the front, and shows the panels if they are hidden.
    pub fn open(&mut self, kind: PanelKind) {
        (self.is_bare, self.is_presenting) = (false, false);
        self.layout.open(kind);
    }

    /// Opens a modal view in place of any other, or closes the view if it is open already.
    pub fn toggle_modal(&mut self, modal: Modal) {
        self.show_modal((self.modal != Some(modal)).then_some(modal));
    }

    /// Shows this modal view in place of any other. A tour that was open is over.
    fn show_modal(&mut self, modal: Option<Modal>) {
        self.awaits_tour &= !matches!(self.modal, Some(Modal::Tour(_)));
        self.modal = modal;
    }
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Workspace>()
        .add_systems(Update, open_first.in_set(FrameSet::TakeIn).run_if(run_once));
}

/// In the first frame, opens the charts if the program was started with a comparison, or else the tour if it is not over.
fn open_first(mut workspace: ResMut<Workspace>, options: Res<Options>) {
    if options.comparison.is_some() {
        workspace.layout.open(PanelKind::Charts);
    } else if workspace.awaits_tour {
        workspace.modal = Some(Modal::Tour(0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_toggle_closes_a_modal_and_a_closed_tour_is_finished() {
        let mut workspace = Workspace::new(false, false);
        workspace.toggle_modal(Modal::Keys);
        assert_eq!(workspace.modal(), Some(Modal::Keys));
        workspace.toggle_modal(Modal::Keys);
        assert_eq!(workspace.modal(), None);
        assert!(workspace.awaits_tour);
        workspace.toggle_modal(Modal::Tour(0));
        workspace.toggle_modal(Modal::Tour(1));
        assert_eq!(workspace.modal(), Some(Modal::Tour(1)));
        workspace.show_modal(None);
        assert!(workspace.modal().is_none() && !workspace.awaits_tour);
    }

    #[test]
    fn the_end_of_the_presenting_mode_brings_back_what_was_visible_before() {
        for is_bare in [false, true] {
            let mut workspace =
                Workspace { is_bare, modal: Some(Modal::Tour(2)), ..Workspace::default() };
            workspace.apply(&WindowCommand::TogglePresenting);
            assert!(workspace.is_presenting && workspace.modal().is_none());
            workspace.apply(&WindowCommand::TogglePanels);
            workspace.apply(&WindowCommand::ToggleModal(Modal::Keys));
            workspace.modal = Some(Modal::Tour(2));
            workspace.apply(&WindowCommand::CloseModal);
            assert!(!workspace.is_presenting, "Escape ends it");
            assert_eq!((workspace.is_bare, workspace.modal()), (is_bare, Some(Modal::Tour(2))));
        }
    }

    #[test]
    fn escape_closes_a_view_over_the_presented_stage_first_and_a_panel_ends_presenting() {
        let mut workspace = Workspace::new(true, true);
        workspace.apply(&WindowCommand::ToggleModal(Modal::Keys));
        workspace.apply(&WindowCommand::CloseModal);
        assert!(workspace.is_presenting && workspace.modal().is_none());
        workspace.apply(&WindowCommand::OpenPanel(PanelKind::World));
        assert!(!workspace.is_presenting);
    }
}
