//! Selection of built-in and own presets, and a field to save a new one.

use bevy_egui::egui;

use crate::studio::commands::{Command, PlanCommand};
use crate::studio::panels::own_files::{OwnName, own_files};
use crate::studio::state::current_run::CurrentRun;
use crate::studio::ui::accessible::named;
use crate::studio::ui::text_rows::explain;
use crate::studio::ui::theme;
use snakes_lab::run::names::{PRESET_TITLES, with_title};

/// Draws the selection of presets, and the button and field that save a new one. Sends the user's commands.
pub(super) fn preset_choice(ui: &mut egui::Ui, name: &mut OwnName, run: &CurrentRun) {
    let (presets, chosen) = (&run.context.presets, run.plan_next.preset.as_str());
    ui.horizontal_wrapped(|ui| {
        ui.label("Preset");
        let mut picked = None;
        let list = egui::ComboBox::from_id_salt("preset")
            .selected_text(with_title(&run.next_preset_in_words()))
            .width(theme::COMBO_WIDTH)
            .height(theme::list_height(ui))
            .show_ui(ui, |ui| {
                // The rows are close together, so that all fit into a small window.
                ui.spacing_mut().item_spacing.y = theme::GAP / 4.0;
                ui.spacing_mut().interact_size.y = theme::GAP * 2.5;
                for (group, of_group) in &PRESET_TITLES {
                    if !group.is_empty() {
                        explain(ui, group);
                    }
                    for (name, title) in *of_group {
                        let preset = presets.built_in().iter().find(|preset| preset.name == *name);
                        let about = preset.map_or("", |preset| &preset.about);
                        let row = ui.selectable_label(chosen == *name, *title);
                        if row.on_hover_text(format!("{about}\n\nPreset {name}")).clicked() {
                            picked = Some(*name);
                        }
                    }
                }
                let own = own_files(ui, presets, "Your presets", Some(chosen), |own| &own.about);
                picked = own.map(|own| own.name.as_str()).or(picked);
            });
        let picked = picked.map(|name| PlanCommand::SetPreset(name.to_owned()));
        Command::send_all(picked.map(Command::Plan), ui);
        let list = named(list.response, egui::WidgetType::ComboBox, "Preset");
        if list.clicked() {
            // The folder may contain new files.
            Command::Plan(PlanCommand::ListPresets).send(ui);
        }
        list.on_hover_text("Replaces all settings of the next run");
        let hint = "Save the settings of the next run under a name, to use them again later";
        let suggestion = || presets.name_for_copy(chosen);
        name.button(ui, ("Save as preset…", hint), suggestion);
    });
    if let Some(name) = name.field(ui, presets) {
        Command::Plan(PlanCommand::StorePreset(name)).send(ui);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::testing::{self, Sent, clicked, press, shows};
    use crate::studio::state::current_run::prepared_run;
    use egui_kittest::kittest::Queryable;
    use snakes_lab::run::names::preset_title;

    fn panel(run: &CurrentRun) -> Sent<'_> {
        let mut name = OwnName::default();
        // The height is that of the smallest usual window.
        testing::panel([theme::PANEL_WIDTH, 720.0], move |ui| {
            theme::apply(ui.ctx());
            preset_choice(ui, &mut name, run);
        })
    }

    /// Opens the field for the name of a preset, and types into it.
    fn with_name<'a>(run: &'a CurrentRun, name: &str) -> Sent<'a> {
        let mut panel = panel(run);
        clicked(&mut panel, "Save as preset…");
        // The field has the focus, and the suggested name is selected.
        panel.event(egui::Event::Text(name.to_owned()));
        panel.run();
        panel
    }

    #[test]
    fn the_open_list_shows_all_presets_of_the_program_and_a_click_selects_one() {
        let run = prepared_run();
        let last = run.context.presets.built_in().last().expect("shipped").name.clone();
        // A click on an entry that is scrolled out of view would have no effect.
        for name in ["ice".to_owned(), last] {
            let mut panel = panel(&run);
            panel.get_by_role_and_label(egui::accesskit::Role::ComboBox, "Preset").click();
            panel.run();
            let sent = clicked(&mut panel, preset_title(&name));
            let commands = [PlanCommand::ListPresets, PlanCommand::SetPreset(name)];
            assert_eq!(sent, commands.map(Command::Plan));
        }
    }

    #[test]
    fn every_preset_of_the_program_is_in_one_group_under_a_title_of_its_own() {
        let run = prepared_run();
        let mut built_in: Vec<&str> =
            run.context.presets.built_in().iter().map(|preset| preset.name.as_str()).collect();
        let listed = || PRESET_TITLES.iter().flat_map(|(_, presets)| presets.iter());
        let mut names: Vec<&str> = listed().map(|(name, _)| *name).collect();
        built_in.sort_unstable();
        names.sort_unstable();
        assert_eq!(names, built_in);
        let titles: std::collections::BTreeSet<&str> = listed().map(|(_, title)| *title).collect();
        assert_eq!(titles.len(), names.len());
    }

    #[test]
    fn settings_are_saved_under_a_name_or_under_its_allowed_form() {
        let run = prepared_run();
        for (typed, allowed) in [("my-slope-2", "my-slope-2"), ("My ice: 1/2", "my-ice-1-2")] {
            let mut panel = with_name(&run, typed);
            if typed != allowed {
                clicked(&mut panel, &format!("Use the name {allowed}"));
            }
            let stored = Command::Plan(PlanCommand::StorePreset(allowed.to_owned()));
            assert_eq!(clicked(&mut panel, "Save"), [stored]);
            assert!(panel.query_by_label("Name").is_none(), "done");
        }
    }

    #[test]
    fn the_name_field_suggests_a_free_name_that_enter_saves_and_escape_drops() {
        let run = prepared_run();
        for (key, saved) in [(egui::Key::Enter, true), (egui::Key::Escape, false)] {
            let mut panel = panel(&run);
            clicked(&mut panel, "Save as preset…");
            assert!(panel.get_by_label("Name").is_focused());
            let suggestion = run.context.presets.name_for_copy(&run.plan_next.preset);
            assert!(suggestion.starts_with("my-"), "{suggestion}");
            assert_eq!(panel.get_by_label("Name").value(), Some(suggestion.clone()));
            press(&mut panel, key);
            let commands = [Command::Plan(PlanCommand::StorePreset(suggestion))];
            assert_eq!(*panel.state(), commands[..usize::from(saved)]);
            assert!(panel.query_by_label("Name").is_none(), "closed");
        }
    }

    #[test]
    fn an_invalid_name_is_refused_with_a_reason() {
        let long = "x".repeat(300);
        for (name, said) in [
            ("a/b", "The name is \"a/b\"; allowed: 1 to 40 characters, each a-z, 0-9 or -."),
            (long.as_str(), "; allowed: 1 to 40 characters, each a-z, 0-9 or -."),
            ("climb", "A preset named climb already exists"),
        ] {
            let run = prepared_run();
            let mut panel = with_name(&run, name);
            assert!(shows(&panel, said), "{name}");
            assert_eq!(clicked(&mut panel, "Save"), []);
        }
    }
}
