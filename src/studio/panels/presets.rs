//! The choice of a preset: those of the program, a person's own, and the way to keep one.

use bevy_egui::egui;

use super::explain;
use crate::save::check_own_name;
use crate::studio::command::Command;
use crate::studio::evolution::Evolution;
use crate::studio::look;
use crate::studio::presets::Presets;

/// The choice, with what is being typed.
#[derive(Debug, Default)]
pub(super) struct PresetChoice {
    /// The name under which the settings are to be kept, while it is typed.
    name: Option<String>,
}

impl PresetChoice {
    /// Draws the choice and adds what was asked for.
    pub fn ui(&mut self, ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
        ui.horizontal_wrapped(|ui| {
            ui.label("Preset");
            let list = egui::ComboBox::from_id_salt("preset")
                .selected_text(run.next_preset())
                .width(look::COMBO_WIDTH)
                .show_ui(ui, |ui| presets(ui, run.presets(), run.next_preset(), asked));
            let is_on = ui.is_enabled();
            list.response.widget_info(|| {
                egui::WidgetInfo::labeled(egui::WidgetType::ComboBox, is_on, "Preset")
            });
            if list.response.clicked() {
                // Somebody may have put a file into the folder meanwhile.
                asked.push(Command::ListPresets);
            }
            list.response.on_hover_text("All settings of the next run at once");
            let hint =
                "Keep the next run's settings under a name of your own, to choose them again later";
            let mut is_open = self.name.is_some();
            if ui.toggle_value(&mut is_open, "Save as a preset…").on_hover_text(hint).changed() {
                self.name = is_open.then(String::new);
            }
        });
        if let Some(mut name) = self.name.take() {
            let is_kept = name_field(ui, run.presets(), &mut name, asked);
            self.name = (!is_kept).then_some(name);
        }
    }
}

/// The presets to choose from.
fn presets(ui: &mut egui::Ui, presets: &Presets, chosen: &str, asked: &mut Vec<Command>) {
    let mut choice = |ui: &mut egui::Ui, name: &str, about: &str| {
        if ui.selectable_label(name == chosen, name).on_hover_text(about).clicked() {
            asked.push(Command::SetPreset(name.to_owned()));
        }
    };
    for preset in presets.shipped() {
        choice(ui, &preset.name, &preset.about);
    }
    if presets.own().is_empty() {
        return;
    }
    ui.separator();
    explain(ui, "Your own");
    for own in presets.own() {
        match &own.preset {
            Ok(preset) => choice(ui, &own.name, &preset.about),
            Err(reason) => {
                let button = egui::Button::selectable(false, &own.name);
                ui.add_enabled(false, button).on_disabled_hover_text(reason);
            }
        }
    }
}

/// The field for the name. Whether the preset is to be kept.
fn name_field(
    ui: &mut egui::Ui,
    presets: &Presets,
    name: &mut String,
    asked: &mut Vec<Command>,
) -> bool {
    let problem = if name.is_empty() { None } else { problem_with(presets, name) };
    let mut is_kept = false;
    ui.horizontal(|ui| {
        let label = ui.label("Name");
        let field = egui::TextEdit::singleline(name)
            .desired_width(look::COMBO_WIDTH)
            .margin(egui::Margin::symmetric(look::GAP as i8, look::GAP as i8 / 2))
            .hint_text("my-preset");
        let field = ui.add(field).labelled_by(label.id);
        let is_entered =
            field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        let is_right = problem.is_none() && !name.is_empty();
        let hint = "The file goes into the folder \"presets\" within the saves";
        let save = ui.add_enabled(is_right, egui::Button::new("Save")).on_hover_text(hint);
        is_kept = is_right && (save.clicked() || is_entered);
    });
    if let Some(problem) = problem {
        let text = egui::RichText::new(problem).color(look::of(ui).problem);
        ui.add(egui::Label::new(text).wrap());
    }
    if is_kept {
        asked.push(Command::StorePreset(name.clone()));
    }
    is_kept
}

/// What is wrong with a name, in words.
fn problem_with(presets: &Presets, name: &str) -> Option<String> {
    if presets.has(name) {
        return Some(format!("There is a preset {name} already; take another name."));
    }
    check_own_name(name).err().map(|invalid| {
        let start: String = name.chars().take(30).collect();
        let rest = if name.chars().count() > 30 { "…" } else { "" };
        format!("The name is \"{start}{rest}\"; allowed: {}.", invalid.allowed)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::evolution::prepared_run;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    type Panel<'a> = Harness<'a, Vec<Command>>;

    fn panel(run: &Evolution) -> Panel<'_> {
        let mut choice = PresetChoice::default();
        let size = egui::vec2(look::PANEL_WIDTH, 600.0);
        Harness::builder()
            .with_size(size)
            .build_ui_state(move |ui, asked| choice.ui(ui, run, asked), Vec::new())
    }

    /// Opens the field and types a name.
    fn type_name(panel: &mut Panel, name: &str) {
        panel.get_by_label("Save as a preset…").click();
        panel.run();
        panel.get_by_label("Name").focus();
        panel.run();
        panel.get_by_label("Name").type_text(name);
        panel.run();
    }

    #[test]
    fn a_shipped_preset_is_chosen_from_the_list() {
        let run = prepared_run();
        let mut panel = panel(&run);
        panel.get_by_role_and_label(egui::accesskit::Role::ComboBox, "Preset").click();
        panel.run();
        panel.get_by_label("ice").click();
        panel.run();
        let asked = [Command::ListPresets, Command::SetPreset("ice".to_owned())];
        assert_eq!(*panel.state(), asked);
    }

    #[test]
    fn settings_are_kept_under_a_name() {
        let run = prepared_run();
        let mut panel = panel(&run);
        type_name(&mut panel, "my-slope-2");
        panel.get_by_label("Save").click();
        panel.run();
        assert_eq!(*panel.state(), [Command::StorePreset("my-slope-2".to_owned())]);
        assert!(panel.query_by_label("Name").is_none(), "done");
    }

    #[test]
    fn a_name_that_is_none_is_refused_plainly() {
        let long = "x".repeat(300);
        for (name, said) in [
            ("a/b", "The name is \"a/b\"; allowed: 1 to 40 of a-z, 0-9 and -."),
            (long.as_str(), "; allowed: 1 to 40 of a-z, 0-9 and -."),
            ("climb", "There is a preset climb already"),
        ] {
            let run = prepared_run();
            let mut panel = panel(&run);
            type_name(&mut panel, name);
            assert!(panel.query_by_label_contains(said).is_some(), "{name}");
            panel.get_by_label("Save").click();
            panel.run();
            assert_eq!(*panel.state(), []);
        }
    }
}
