//! Selection of built-in stairs for the next run.

use std::sync::LazyLock;

use bevy_egui::egui;

use crate::evolve::{Settings, fields};
use crate::save::{NamedStairs, built_in_stairs};
use crate::studio::commands::{Command, PlanCommand};
use crate::studio::state::current_run::CurrentRun;
use crate::studio::ui::theme;
use crate::world::Stairs;

/// The built-in stairs. A test of them ensures that they can be read.
static BUILT_IN: LazyLock<Vec<NamedStairs>> =
    LazyLock::new(|| built_in_stairs().unwrap_or_default());

/// The name of stairs that are none of these.
const OTHER: &str = "none of these";

/// Draws the selection and collects the user's commands.
pub(super) fn stairs_choice(ui: &mut egui::Ui, run: &CurrentRun, commands: &mut Vec<Command>) {
    let settings = run.next_settings();
    let present = BUILT_IN.iter().find(|named| named.stairs == settings.trial.stairs);
    ui.horizontal_wrapped(|ui| {
        ui.label("Built-in stairs");
        let list = egui::ComboBox::from_id_salt("built-in stairs")
            .selected_text(present.map_or(OTHER, |named| &named.name))
            .width(theme::COMBO_WIDTH)
            .height(theme::list_height(ui))
            .show_ui(ui, |ui| {
                for NamedStairs { name, about, stairs } in BUILT_IN.iter() {
                    let is_present = present.is_some_and(|present| present.name == *name);
                    if ui.selectable_label(is_present, name).on_hover_text(about).clicked() {
                        let changes = changes(settings, stairs);
                        commands.push(Command::Plan(PlanCommand::SetFields(changes)));
                    }
                }
            });
        let is_on = ui.is_enabled();
        list.response.widget_info(|| {
            egui::WidgetInfo::labeled(egui::WidgetType::ComboBox, is_on, "Built-in stairs")
        });
        list.response.on_hover_text("Replaces all settings of the stairs");
    });
}

/// The changes of settings that lead to these stairs.
fn changes(settings: &Settings, stairs: &Stairs) -> Vec<(String, String)> {
    let mut changed = settings.clone();
    changed.trial.stairs = stairs.clone();
    let now = fields(settings);
    let differs =
        |field: &(String, String)| field.0.starts_with("trial.stairs.") && !now.contains(field);
    fields(&changed).into_iter().filter(differs).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::state::current_run::prepared_run;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn a_choice_sets_all_that_differs_and_is_shown_afterwards() {
        let mut run = prepared_run();
        for NamedStairs { name, stairs, .. } in BUILT_IN.iter() {
            let changes = changes(run.next_settings(), stairs);
            let changes: Vec<(&str, &str)> =
                changes.iter().map(|(field, text)| (field.as_str(), text.as_str())).collect();
            run.set_fields(&changes).expect(name);
            assert_eq!(run.next_settings().trial.stairs, *stairs, "{name}");
        }
        let draw = move |ui: &mut egui::Ui, commands: &mut Vec<Command>| {
            stairs_choice(ui, &run, commands);
        };
        let mut panel = Harness::builder()
            .with_size(egui::vec2(theme::PANEL_WIDTH, 400.0))
            .build_ui_state(draw, Vec::new());
        panel.run();
        panel.get_by_role_and_label(egui::accesskit::Role::ComboBox, "Built-in stairs").click();
        panel.run();
        panel.get_by_label("ramps").click();
        panel.run();
        let [Command::Plan(PlanCommand::SetFields(sent))] = panel.state().as_slice() else {
            panic!("one command");
        };
        assert!(sent.iter().any(|(field, _)| field == "trial.stairs.slope_m"), "{sent:?}");
    }
}
