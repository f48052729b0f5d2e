//! Preset selection: shipped and own presets, and a field to save a new one.

use bevy_egui::egui;

use crate::save::{PresetList, check_own_name};
use crate::studio::commands::{Command, PlanCommand};
use crate::studio::state::current_run::CurrentRun;
use crate::studio::ui::text_prompt::{PromptEnd, TextPrompt};
use crate::studio::ui::text_rows::explain;
use crate::studio::ui::theme;

/// The selection with its text field.
#[derive(Debug, Default)]
pub(crate) struct PresetChoice {
    /// Name of the preset to save, while it is typed.
    name: Option<TextPrompt>,
}

impl PresetChoice {
    /// Draws the selection and collects the user's commands.
    pub fn ui(&mut self, ui: &mut egui::Ui, run: &CurrentRun, commands: &mut Vec<Command>) {
        ui.horizontal_wrapped(|ui| {
            ui.label("Preset");
            let list = egui::ComboBox::from_id_salt("preset")
                .selected_text(run.next_preset_in_words())
                .width(theme::COMBO_WIDTH)
                .height(theme::list_height(ui))
                .show_ui(ui, |ui| presets(ui, run.presets(), run.next_preset(), commands));
            let is_on = ui.is_enabled();
            list.response.widget_info(|| {
                egui::WidgetInfo::labeled(egui::WidgetType::ComboBox, is_on, "Preset")
            });
            if list.response.clicked() {
                // The folder may have new files.
                commands.push(Command::Plan(PlanCommand::ListPresets));
            }
            list.response.on_hover_text("Replaces all settings of the next run");
            let hint = "Save the settings of the next run under a name, to use them again later";
            let mut is_open = self.name.is_some();
            if ui.toggle_value(&mut is_open, "Save as preset…").on_hover_text(hint).changed() {
                let suggestion = || free_name(run.presets(), run.next_preset());
                self.name = is_open.then(|| TextPrompt::new(suggestion()));
            }
        });
        if let Some(mut name) = self.name.take() {
            let is_closed = name_field(ui, run.presets(), &mut name, commands);
            self.name = (!is_closed).then_some(name);
        }
    }
}

/// Draws the list of presets.
fn presets(ui: &mut egui::Ui, presets: &PresetList, chosen: &str, commands: &mut Vec<Command>) {
    let mut choice = |ui: &mut egui::Ui, name: &str, about: &str| {
        if ui.selectable_label(name == chosen, name).on_hover_text(about).clicked() {
            commands.push(Command::Plan(PlanCommand::SetPreset(name.to_owned())));
        }
    };
    // Close together, so that all fit into a small window.
    ui.spacing_mut().item_spacing.y = theme::GAP / 4.0;
    ui.spacing_mut().interact_size.y = theme::GAP * 2.5;
    for preset in presets.shipped() {
        choice(ui, &preset.name, &preset.about);
    }
    if presets.own().is_empty() {
        return;
    }
    ui.separator();
    explain(ui, "Your presets");
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

/// Draws the name field. Returns whether it closes: the preset was saved, or Escape was pressed.
fn name_field(
    ui: &mut egui::Ui,
    presets: &PresetList,
    prompt: &mut TextPrompt,
    commands: &mut Vec<Command>,
) -> bool {
    let mut is_saved = false;
    let mut is_cancelled = false;
    ui.horizontal_wrapped(|ui| {
        let label = ui.label("Name");
        let (_, end) = prompt.ui(ui, |ui, field| {
            let field = field
                .desired_width(theme::COMBO_WIDTH)
                .margin(egui::Margin::symmetric(theme::GAP as i8, theme::GAP as i8 / 2))
                .hint_text("my-preset");
            ui.add(field).labelled_by(label.id)
        });
        let is_valid = !prompt.text.is_empty() && problem_with(presets, &prompt.text).is_none();
        let hint = "Writes a file to the \"presets\" folder inside the saves folder (Enter)";
        let refusal = "Type another name first: this one is empty, taken or not allowed";
        let save = ui.add_enabled(is_valid, egui::Button::new("Save")).on_hover_text(hint);
        let save = save.on_disabled_hover_text(refusal);
        is_saved = is_valid && (save.clicked() || end == Some(PromptEnd::Accepted));
        is_cancelled = end == Some(PromptEnd::Cancelled)
            || ui.button("Cancel").on_hover_text("Save no preset (Esc)").clicked();
        if end == Some(PromptEnd::Accepted) && !is_valid {
            prompt.ask_again();
        }
    });
    let problem = problem_with(presets, &prompt.text).filter(|_| !prompt.text.is_empty());
    if let Some(problem) = problem {
        let text = egui::RichText::new(problem).color(theme::of(ui).problem);
        ui.add(egui::Label::new(text).wrap());
        let allowed = allowed_name(presets, &prompt.text);
        if ui.button(format!("Use the name {allowed}")).clicked() {
            prompt.text = allowed;
            prompt.ask_again();
        }
    }
    if is_saved {
        commands.push(Command::Plan(PlanCommand::StorePreset(prompt.text.clone())));
    }
    is_saved || is_cancelled
}

/// A free name for a copy of a preset: "my-ice", then "my-ice-2" and so on.
fn free_name(presets: &PresetList, copied: &str) -> String {
    let is_plain = |c: &char| c.is_ascii_lowercase() || c.is_ascii_digit() || *c == '-';
    let plain: String = copied.chars().filter(is_plain).collect();
    let own = if plain.is_empty() { "preset" } else { plain.trim_start_matches("my-") };
    numbered_if_taken(presets, &format!("my-{own}"))
}

/// A free name that is like a name that is not allowed: "my-ice-1-2" for "My ice: 1/2".
fn allowed_name(presets: &PresetList, wanted: &str) -> String {
    let wanted = wanted.to_ascii_lowercase();
    let words = wanted.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    let plain = words.collect::<Vec<&str>>().join("-");
    numbered_if_taken(presets, if plain.is_empty() { "my-preset" } else { &plain })
}

/// The name if it is free, else the name with the first free number.
fn numbered_if_taken(presets: &PresetList, name: &str) -> String {
    let start: String = name.chars().take(36).collect();
    let numbered = (2..1000).map(|number| format!("{start}-{number}"));
    let mut names = std::iter::once(start.clone()).chain(numbered);
    names.find(|name| problem_with(presets, name).is_none()).unwrap_or_default()
}

/// Problem with a name, as a message.
fn problem_with(presets: &PresetList, name: &str) -> Option<String> {
    if presets.has(name) {
        return Some(format!("A preset named {name} already exists; choose another name."));
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
    use crate::studio::state::current_run::prepared_run;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    type Panel<'a> = Harness<'a, Vec<Command>>;

    fn panel(run: &CurrentRun) -> Panel<'_> {
        let mut choice = PresetChoice::default();
        // The height of the smallest usual window.
        let size = egui::vec2(theme::PANEL_WIDTH, 720.0);
        let draw = move |ui: &mut egui::Ui, commands: &mut Vec<Command>| {
            theme::apply(ui.ctx());
            choice.ui(ui, run, commands);
        };
        let mut panel = Harness::builder().with_size(size).build_ui_state(draw, Vec::new());
        panel.run();
        panel
    }

    /// Opens the field and types a name.
    fn type_name(panel: &mut Panel, name: &str) {
        panel.get_by_label("Save as preset…").click();
        panel.run();
        // The field has the focus, and its suggestion is selected.
        panel.event(egui::Event::Text(name.to_owned()));
        panel.run();
    }

    #[test]
    fn a_name_that_is_not_allowed_is_offered_in_an_allowed_form() {
        let run = prepared_run();
        let mut panel = panel(&run);
        type_name(&mut panel, "My ice: 1/2");
        panel.get_by_label("Use the name my-ice-1-2").click();
        panel.run();
        panel.get_by_label("Save").click();
        panel.run();
        let stored = Command::Plan(PlanCommand::StorePreset("my-ice-1-2".to_owned()));
        assert!(panel.state().contains(&stored), "{:?}", panel.state());
        assert_eq!(allowed_name(run.presets(), "ÄÖ/!"), "my-preset");
        assert_eq!(allowed_name(run.presets(), "Ice"), "ice-2", "the program has an ice");
    }

    #[test]
    fn a_shipped_preset_is_selected_from_the_list() {
        let run = prepared_run();
        let mut panel = panel(&run);
        panel.get_by_role_and_label(egui::accesskit::Role::ComboBox, "Preset").click();
        panel.run();
        panel.get_by_label("ice").click();
        panel.run();
        let commands = [
            Command::Plan(PlanCommand::ListPresets),
            Command::Plan(PlanCommand::SetPreset("ice".to_owned())),
        ];
        assert_eq!(*panel.state(), commands);
    }

    #[test]
    fn the_open_list_shows_all_presets_of_the_program() {
        let run = prepared_run();
        let mut panel = panel(&run);
        panel.get_by_role_and_label(egui::accesskit::Role::ComboBox, "Preset").click();
        panel.run();
        let last = run.presets().shipped().last().expect("shipped").name.clone();
        // Entries out of sight are clipped, and a click on them reaches none.
        panel.get_by_label(&last).click();
        panel.run();
        assert!(panel.state().contains(&Command::Plan(PlanCommand::SetPreset(last))));
    }

    #[test]
    fn settings_are_saved_under_a_name() {
        let run = prepared_run();
        let mut panel = panel(&run);
        type_name(&mut panel, "my-slope-2");
        panel.get_by_label("Save").click();
        panel.run();
        assert_eq!(
            *panel.state(),
            [Command::Plan(PlanCommand::StorePreset("my-slope-2".to_owned()))]
        );
        assert!(panel.query_by_label("Name").is_none(), "done");
    }

    #[test]
    fn the_name_field_suggests_a_free_name_that_enter_saves_and_escape_drops() {
        let run = prepared_run();
        for (key, saved) in [(egui::Key::Enter, true), (egui::Key::Escape, false)] {
            let mut panel = panel(&run);
            panel.get_by_label("Save as preset…").click();
            panel.run();
            assert!(panel.get_by_label("Name").is_focused());
            let suggestion = free_name(run.presets(), run.next_preset());
            assert!(suggestion.starts_with("my-"), "{suggestion}");
            assert_eq!(panel.get_by_label("Name").value(), Some(suggestion.clone()));
            panel.key_press(key);
            panel.run();
            let commands = [Command::Plan(PlanCommand::StorePreset(suggestion))];
            assert_eq!(*panel.state(), commands[..usize::from(saved)]);
            assert!(panel.query_by_label("Name").is_none(), "closed");
        }
    }

    #[test]
    fn a_suggested_name_is_allowed_and_free() {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = crate::save::SavesFolder::find(Some(folder.path()));
        let name = |copied: &str| free_name(&PresetList::read(&saves), copied);
        assert_eq!((name("ice"), name("my-ice")), ("my-ice".to_owned(), "my-ice".to_owned()));
        let ice = PresetList::read(&saves).find("ice").expect("whole").expect("shipped").clone();
        let mine = crate::save::Preset { name: "my-ice".to_owned(), ..ice };
        saves.store_own_preset(&mine).expect("written");
        assert_eq!((name("ice"), name("my-ice")), ("my-ice-2".to_owned(), "my-ice-2".to_owned()));
        for odd in ["", "Größe 1/2", &"x".repeat(90)] {
            assert_eq!(check_own_name(&name(odd)), Ok(()), "{odd}");
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
            let mut panel = panel(&run);
            type_name(&mut panel, name);
            assert!(panel.query_by_label_contains(said).is_some(), "{name}");
            panel.get_by_label("Save").click();
            panel.run();
            assert_eq!(*panel.state(), []);
        }
    }
}
