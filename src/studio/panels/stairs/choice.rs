//! Selection of built-in stairs or the user's own for the next run.

use bevy_egui::egui;

use crate::studio::commands::{Command, PlanCommand};
use crate::studio::panels::own_files::{file_row, own_files};
use crate::studio::state::current_run::CurrentRun;
use crate::studio::ui::accessible::named;
use crate::studio::ui::theme;
use snakes_core::evolve::{Settings, fields};
use snakes_core::save::NamedStairs;
use snakes_core::world::Stairs;

/// Describes stairs that are not among the known ones: "10 equal steps".
fn in_words(stairs: &Stairs) -> String {
    let first = (stairs.step_rise_m(0), stairs.step_tread_m(0));
    let is_equal = (1..stairs.steps)
        .all(|step| (stairs.step_rise_m(step), stairs.step_tread_m(step)) == first);
    format!("{} {} steps", stairs.steps, if is_equal { "equal" } else { "unequal" })
}

/// Draws the selection of stairs, and sends the user's commands.
pub(in crate::studio::panels) fn stairs_choice(ui: &mut egui::Ui, run: &CurrentRun) {
    let settings = run.next_settings();
    let present = name_of(run, &settings.trial.stairs);
    let mut chosen: Option<&NamedStairs> = None;
    ui.label("Shape");
    let list = egui::ComboBox::from_id_salt("known stairs")
        .selected_text(present.map_or_else(|| in_words(&settings.trial.stairs), str::to_owned))
        .width(theme::COMBO_WIDTH)
        .height(theme::list_height(ui))
        .show_ui(ui, |ui| {
            let known = &run.context.stairs;
            for built_in in known.built_in() {
                if file_row(ui, &built_in.name, present, &built_in.about) {
                    chosen = Some(built_in);
                }
            }
            let own = own_files(ui, known, "Your stairs", present, |named| &named.about);
            chosen = own.or(chosen);
        });
    let list = named(list.response, egui::WidgetType::ComboBox, "Known stairs");
    if list.clicked() {
        // The folder may contain new files.
        Command::Plan(PlanCommand::ListStairs).send(ui);
    }
    list.on_hover_text("Replaces all settings of the stairs");
    if let Some(named) = chosen {
        Command::send_all(replacement(settings, &named.stairs), ui);
    }
}

/// Returns the name of stairs, if they are known.
pub(super) fn name_of<'r>(run: &'r CurrentRun, stairs: &Stairs) -> Option<&'r str> {
    let known = &run.context.stairs;
    let own = known.own().iter().filter_map(|own| own.content.as_ref().ok());
    let mut all = known.built_in().iter().chain(own);
    all.find(|named| named.stairs == *stairs).map(|named| named.name.as_str())
}

/// Returns the command that uses other stairs in the next run, or `None` if it has these stairs already.
pub(super) fn replacement(settings: &Settings, stairs: &Stairs) -> Option<Command> {
    let is_new = settings.trial.stairs != *stairs;
    is_new.then(|| Command::Plan(PlanCommand::SetFields(changes(settings, stairs))))
}

/// Returns all settings of these stairs. None is left out, because the stairs on the stage may differ from those of the next run.
fn changes(settings: &Settings, stairs: &Stairs) -> Vec<(String, String)> {
    let mut changed = settings.clone();
    changed.trial.stairs = stairs.clone();
    let is_of_stairs = |field: &(String, String)| field.0.starts_with("trial.stairs.");
    fields(&changed).into_iter().filter(is_of_stairs).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::testing::{clicked, panel};
    use crate::studio::state::current_run::prepared_run;
    use crate::studio::state::plan_commands::borrowed;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn a_choice_sets_all_that_differs_and_is_shown_afterwards() {
        let mut run = prepared_run();
        let all: Vec<NamedStairs> = run.context.stairs.built_in().to_vec();
        assert!(all.len() >= 9);
        for NamedStairs { name, stairs, .. } in &all {
            let changes = changes(run.next_settings(), stairs);
            run.set_fields(&borrowed(&changes)).expect(name);
            assert_eq!(run.next_settings().trial.stairs, *stairs, "{name}");
            assert_eq!(name_of(&run, stairs), Some(name.as_str()));
            assert_eq!(replacement(run.next_settings(), stairs), None);
        }
        let mut panel = panel([theme::PANEL_WIDTH, 400.0], move |ui| stairs_choice(ui, &run));
        panel.get_by_role_and_label(egui::accesskit::Role::ComboBox, "Known stairs").click();
        panel.run();
        clicked(&mut panel, "ramps");
        let [Command::Plan(PlanCommand::ListStairs), Command::Plan(PlanCommand::SetFields(sent))] =
            panel.state().as_slice()
        else {
            panic!("two commands: {:?}", panel.state());
        };
        assert!(sent.iter().any(|(field, _)| field == "trial.stairs.slope_m"), "{sent:?}");
    }
}
