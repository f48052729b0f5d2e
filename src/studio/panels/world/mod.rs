//! The Change panel: settings of the world and the snake of the next run by section, with a search over all settings.

pub mod presets;
pub mod surface_readout;

use bevy_egui::egui;

use super::own_files::OwnName;
use super::settings::Sheet;
use super::stairs::stairs_choice;
use super::undo_buttons::undo_buttons;
use crate::studio::commands::panel::PanelKind;
use crate::studio::commands::{Command, PlanCommand, RunCommand, WindowCommand};
use crate::studio::state::current_run::{CurrentRun, RunStatus};
use crate::studio::state::undo::UndoHistory;
use crate::studio::ui::accessible::named;
use crate::studio::ui::buttons::{CommandButton, command_box};
use crate::studio::ui::text_rows::{explain, folded, text_field, title_and, title_text};
use crate::studio::ui::theme;
use snakes_core::schema::{ListedSetting, Section, SettingKind};
use snakes_core::score::{AgentSettings, Trial};
use snakes_core::world::Stairs;

use presets::preset_choice;
use surface_readout::{ReadLanes, ReadSurface};

/// The Change panel, with its search text and fields.
#[derive(Debug, Default)]
pub(super) struct WorldPanel {
    /// Controls of the settings.
    pub sheet: Sheet,
    /// Field for the name of a preset to save.
    preset_name: OwnName,
    /// Text for which settings are searched.
    pub search: String,
}

impl WorldPanel {
    /// Draws the panel and sends the user's commands.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        run: &CurrentRun,
        history: &UndoHistory,
        on_stage: &ReadLanes,
    ) {
        self.sheet.begin(ui, run);
        title_and(ui, "World", |ui| undo_buttons(ui, history));
        preset_choice(ui, &mut self.preset_name, run);
        next_run(ui, run);
        self.search_field(ui);
        if self.search.trim().is_empty() {
            let all = self.sheet.sections("trial.");
            let (first, others): (Vec<Section>, Vec<Section>) =
                all.into_iter().partition(|section| FIRST.contains(section));
            self.sheet.knob(ui, |path| path == GRAVITY);
            for section in first {
                self.folded(ui, section, run, on_stage);
            }
            if self.sheet.fold(ui, ADVANCED, title_text("Advanced"), ADVANCED) {
                for section in others {
                    self.folded(ui, section, run, on_stage);
                }
            }
        } else {
            self.search_results(ui);
        }
        self.sheet.send(ui);
    }

    /// Draws the search field.
    fn search_field(&mut self, ui: &mut egui::Ui) {
        ui.horizontal(|ui| {
            let is_searching = !self.search.is_empty();
            let clear = if is_searching { theme::GAP * 8.0 } else { 0.0 };
            let field = text_field(&mut self.search)
                .hint_text("Find a setting")
                .desired_width(ui.available_width() - clear - theme::GAP);
            let field = named(ui.add(field), egui::WidgetType::TextEdit, "Find a setting");
            field.on_hover_text(
                "Searches the settings of all sections, including those of the Watch panel",
            );
            if is_searching && ui.small_button("Clear").clicked() {
                self.search.clear();
            }
        });
    }

    /// Draws a section that its header unfolds.
    fn folded(
        &mut self,
        ui: &mut egui::Ui,
        section: Section,
        run: &CurrentRun,
        on_stage: &ReadLanes,
    ) {
        ui.add_space(theme::GAP / 2.0);
        let header = egui::CollapsingHeader::new(title_text(section.title))
            .default_open(FIRST.contains(&section));
        folded(ui, header, section.about, |ui| {
            if section == Trial::GROUND {
                ground_switch(ui, run);
            }
            if section == Stairs::SECTION {
                ui.horizontal_wrapped(|ui| {
                    stairs_choice(ui, run);
                    let hint = "Drag the edges of the steps, change each step in a table, and save the stairs";
                    let edit = Command::Window(WindowCommand::OpenPanel(PanelKind::Stairs));
                    CommandButton::new("Edit…", hint, edit).show(ui);
                });
            }
            if let Some((_, surface)) = READ_OUT.iter().find(|(of, _)| *of == section) {
                on_stage.ui(ui, *surface);
            }
            self.sheet.section(ui, section);
        });
    }

    /// Draws the settings that match the search, by section: first those of sections whose title has all words, then
    /// those whose own name has them, and then those that only mention them; settings that the next run does not use come
    /// after all others.
    fn search_results(&mut self, ui: &mut egui::Ui) {
        let words = self.search.to_lowercase();
        let has_all = |text: &str| {
            let text = text.to_lowercase();
            words.split_whitespace().all(|word| text.contains(word))
        };
        let rank = |listed: &ListedSetting| {
            let by_words = match listed.setting.kind {
                SettingKind::Absent(_) => None,
                _ if has_all(listed.section.title) => Some(0),
                _ if has_all(&listed.setting.title()) => Some(1),
                _ => listed.setting.is_about(&words).then_some(2),
            };
            by_words.map(|rank| if listed.is_used { rank } else { rank + 3 })
        };
        let sections = self.sheet.sections("");
        let mut is_anything = false;
        for (wanted, section) in (0..6).flat_map(|rank| sections.iter().map(move |of| (rank, *of)))
        {
            let is_wanted = |listed: &ListedSetting| rank(listed) == Some(wanted);
            if self.sheet.in_section(section).any(is_wanted) {
                is_anything = true;
                ui.add_space(theme::GAP / 2.0);
                explain(ui, section.title);
                self.sheet.entries(ui, section, is_wanted);
            }
        }
        if !is_anything {
            explain(ui, "No setting matches.");
        }
    }
}

/// Sections above the fold, which are open at first.
const FIRST: [Section; 4] = [Trial::SURFACE, Trial::GROUND, AgentSettings::JOINTS, Stairs::SECTION];
/// Setting that is drawn above all sections.
const GRAVITY: &str = "trial.physics.gravity_m_s2";
/// Key and name of the fold with the other sections.
const ADVANCED: &str = "Advanced settings of the world";

/// Sections that begin with readings of a surface.
const READ_OUT: [(Section, ReadSurface); 3] = [
    (Trial::SURFACE, ReadSurface::Stairs),
    (Trial::GROUND, ReadSurface::Ground),
    (AgentSettings::SKIN, ReadSurface::Skin),
];

/// Draws the switch that gives the ground its own surface.
fn ground_switch(ui: &mut egui::Ui, run: &CurrentRun) {
    let trial = &run.next_settings().trial;
    let differs = trial.ground.is_some();
    let hint = "On: the ground gets its own settings, copied from the stairs. Off: ground and stairs share one surface";
    let change = match differs {
        true => PlanCommand::set("trial.ground", "none"),
        false => PlanCommand::set("ground.friction", &trial.surface.friction.to_string()),
    };
    let words = ("The ground has its own surface", hint);
    command_box(ui, differs, words, Command::Plan(change));
}

/// Draws whether the current run uses these settings, with a button that starts the next run.
fn next_run(ui: &mut egui::Ui, run: &CurrentRun) {
    // The row is always present, so that the layout does not move when a slider is released.
    let palette = theme::of(ui);
    let (text, color) = if !run.is_under_way() {
        ("These settings will be used by the next run.", palette.text_weak)
    } else if run.settings().trial != run.next_settings().trial {
        ("The current run still uses the old settings.", palette.second)
    } else {
        ("The current run uses these settings.", palette.text_weak)
    };
    ui.label(egui::RichText::new(text).color(color));
    let hint = "Prepares and starts a run with the changed settings; the current run stays saved";
    let refusal = match run.status() {
        _ if run.next_run_differs() => None,
        RunStatus::Running | RunStatus::Paused => {
            Some("The current run uses these settings already: change a setting first")
        }
        RunStatus::Ready => Some("The next run uses these settings: start it in the Watch panel"),
        RunStatus::Finished => Some("The finished run used these settings: change a setting first"),
    };
    let begin = Command::Run(RunCommand::New);
    CommandButton::new("New run in this world", hint, begin).unless(refusal).show(ui);
}

#[cfg(test)]
mod tests;
