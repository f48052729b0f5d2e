//! Controls for choices, switches and lists of numbers.

use bevy_egui::egui;

use super::form::{Sheet, Shown};
use super::number::Control;
use crate::studio::ui::accessible::named;
use crate::studio::ui::check_box::check_box;
use crate::studio::ui::theme;
use snakes_core::schema::{Choice, SettingValue};

impl Sheet {
    /// Draws a drop-down list. Returns the new choice, if it has changed.
    pub(super) fn choice(
        &mut self,
        ui: &mut egui::Ui,
        shown: &Shown,
        choices: &[Choice],
    ) -> Option<String> {
        let is_chosen = |choice: &&Choice| SettingValue::Name(choice.name) == shown.listed.value;
        let chosen = choices.iter().find(is_chosen);
        let (title, sentence) =
            chosen.map_or((&*shown.text, ""), |choice| (choice.title, &*choice.sentence));
        self.usual_row(ui, shown, false, |_, ui, width, _| {
            let mut requested = None;
            let list = egui::ComboBox::from_id_salt(&shown.listed.path)
                .selected_text(title)
                .truncate()
                .width(width)
                .height(theme::list_height(ui))
                .show_ui(ui, |ui| {
                    for choice in choices {
                        let is_chosen = is_chosen(&choice);
                        let option = ui.selectable_label(is_chosen, choice.title);
                        if option.on_hover_text(&choice.sentence).clicked() && !is_chosen {
                            requested = Some(choice.name.to_owned());
                        }
                    }
                });
            let kind = egui::WidgetType::ComboBox;
            named(list.response, kind, shown.listed.setting.label)
                .on_hover_text(format!("{}\n\nSelected: {sentence}", shown.hint));
            requested
        })
    }

    /// Draws a check box. Returns the new value, if it has changed.
    pub(super) fn on_off(&mut self, ui: &mut egui::Ui, shown: &Shown) -> Option<String> {
        self.usual_row(ui, shown, true, |_, ui, _, name| {
            let mut is_on = shown.listed.value == SettingValue::Switch(true);
            let ticked = check_box(ui, &mut is_on, "").labelled_by(name).on_hover_text(&shown.hint);
            ticked.changed().then(|| is_on.to_string())
        })
    }

    /// Draws a text field with comma-separated numbers. Returns the new list when the field loses the focus.
    pub(super) fn list(&mut self, ui: &mut egui::Ui, shown: &Shown) -> Option<String> {
        let check = |text: &str| shown.values.typed(shown.listed, text);
        let plain = shown.text.trim_start_matches('[').trim_end_matches(']');
        self.usual_row(ui, shown, false, |sheet, ui, width, name| {
            let control = Control { value: plain, ..Control::of(shown, name, &check) };
            sheet.text_field(ui, &control, plain, width)
        })
    }
}
