//! Editor of the next run's stairs: a drawing with edges to drag, a table of the steps, random stairs, and building codes.

mod choice;
mod codes;
mod edit;
mod profile;
mod random;
mod table;

use bevy_egui::egui;

use super::own_files::OwnName;
use super::undo_buttons::undo_buttons;
use crate::studio::commands::files::FileCommand;
use crate::studio::commands::{Command, PlanCommand, WindowCommand};
use crate::studio::stage::lane::Lane;
use crate::studio::state::current_run::CurrentRun;
use crate::studio::state::undo::UndoHistory;
use crate::studio::ui::buttons::CommandButton;
use crate::studio::ui::text_rows::{explain, problem, title_and};
use snakes_core::save::NamedStairs;
use snakes_core::schema::check;
use snakes_core::world::Stairs;

pub(super) use choice::stairs_choice;
use choice::{name_of, replacement};
use codes::codes;
use edit::{StairsEdit, StairsResponse};
use profile::{Grab, Profile};
use random::RandomStairs;
use table::table;

/// The Stairs panel, with the change in progress.
#[derive(Debug, Default)]
pub(super) struct StairsPanel {
    /// Stairs during a drag; `None` if no drag is in progress.
    draft: Option<Stairs>,
    /// Edge that is being dragged, if any.
    grab: Option<Grab>,
    /// Reason why the latest change is not allowed, in a sentence.
    problem: Option<String>,
    /// Stairs of the next run in the last frame.
    before: Option<Stairs>,
    /// Step under the pointer, in the drawing or in the table; the lowest is 0.
    pointed: Option<u32>,
    name: OwnName,
    random: RandomStairs,
}

impl StairsPanel {
    /// Draws the panel and sends the user's commands. `lane` is the selected lane on the stage.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        run: &CurrentRun,
        history: &UndoHistory,
        lane: Option<&Lane>,
    ) {
        let next = &run.next_settings().trial;
        self.forget_what_is_over(ui, &next.stairs);
        let stairs = self.draft.clone().unwrap_or_else(|| next.stairs.clone());
        title_and(ui, "Stairs", |ui| undo_buttons(ui, history));
        let strategy = run.next_settings().evolution.strategy.info();
        if strategy.evolves_stairs {
            let title = strategy.title;
            let begins =
                "It begins with the number of steps, the mean tread and the width of these.";
            explain(ui, &format!("{title} makes its own stairs. {begins}"));
        } else {
            explain(
                ui,
                "The stairs of the next run. The stage shows each change beside the original.",
            );
        }
        self.files(ui, run, lane);
        let profile = Profile {
            stairs: &stairs,
            next: &next.stairs,
            agent: &next.agent,
            pointed: self.pointed,
        };
        let mut response = profile.ui(ui, &mut self.grab);
        codes(ui, &stairs);
        if let Some(reason) = &self.problem {
            problem(ui, reason);
        }
        if let Some(genome) = self.random.ui(ui) {
            let (first_riser_y_m, landing_m) = (stairs.first_riser_y_m, stairs.landing_m);
            let drawn = Stairs { first_riser_y_m, landing_m, ..genome.stairs() };
            response.edit = Some(StairsEdit::complete(drawn));
        }
        let hint =
            "Width, landing, nosing and the other settings of the stairs, in the Change panel";
        let find = Command::Window(WindowCommand::FindSetting("Stairs"));
        CommandButton::new("More settings", hint, find).show(ui);
        table(ui, &stairs, self.pointed, &mut response);
        let StairsResponse { pointed, edit } = response;
        if pointed != self.pointed {
            self.pointed = pointed;
            ui.ctx().request_repaint();
        }
        let is_cancelled = ui.input(|input| input.key_pressed(egui::Key::Escape));
        if let Some(edit) = edit.filter(|_| !is_cancelled) {
            self.take(ui, edit, run);
        }
    }

    /// Draws the selection of known stairs, and the buttons that save stairs or take them from the stage.
    fn files(&mut self, ui: &mut egui::Ui, run: &CurrentRun, lane: Option<&Lane>) {
        let stairs = &run.next_settings().trial.stairs;
        ui.horizontal_wrapped(|ui| stairs_choice(ui, run));
        ui.horizontal_wrapped(|ui| {
            let hint = "Save these stairs as a file, to use them again and to pass them on";
            let suggestion = || {
                let copied = name_of(run, stairs).unwrap_or("stairs");
                run.context.stairs.name_for_copy(copied)
            };
            self.name.button(ui, ("Save as…", hint), suggestion);
            let folder = run.context.saves.own_folder::<NamedStairs>();
            let refusal = Some("Save stairs first").filter(|_| !folder.is_dir());
            let hint = "Show the files of your stairs. File > Import adds the stairs of others";
            let show = Command::File(FileCommand::OpenFolder(folder));
            CommandButton::new("Show files", hint, show).unless(refusal).show(ui);
            let staged = lane.map(|lane| &lane.trial().stairs);
            if let Some(use_it) = staged.and_then(|of| replacement(run.next_settings(), of)) {
                let hint = "The next run gets the stairs of the selected snake on the stage";
                CommandButton::new("Use those on the stage", hint, use_it).show(ui);
            }
        });
        if let Some(name) = self.name.field(ui, &run.context.stairs) {
            Command::Plan(PlanCommand::StoreStairs(name)).send(ui);
        }
    }

    /// Discards a drag that was ended by Escape or while the panel was hidden. Also removes the message about a change
    /// after the stairs have changed.
    fn forget_what_is_over(&mut self, ui: &egui::Ui, next: &Stairs) {
        let context = ui.ctx();
        let is_dragging = context.dragged_id().is_some() || context.drag_stopped_id().is_some();
        if !is_dragging || ui.input(|input| input.key_pressed(egui::Key::Escape)) {
            (self.draft, self.grab) = (None, None);
        }
        if self.before.as_ref() != Some(next) {
            self.problem = None;
            self.before = Some(next.clone());
        }
    }

    /// Stores a change as the draft, and applies the draft to the next run when it is complete. A change that is not
    /// allowed does not affect the stairs.
    fn take(&mut self, ui: &egui::Ui, edit: StairsEdit, run: &CurrentRun) {
        match check(&edit.stairs) {
            Ok(()) => {
                self.problem = None;
                self.draft = Some(edit.stairs);
            }
            Err(error) => self.problem = Some(format!("Not possible: {error}.")),
        }
        if edit.is_complete
            && let Some(stairs) = self.draft.take()
        {
            Command::send_all(replacement(run.next_settings(), &stairs), ui);
            // The reason why the drag could go no further stays visible.
            self.before = Some(stairs);
        }
    }
}

#[cfg(test)]
mod tests;
