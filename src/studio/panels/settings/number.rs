//! Controls for numbers: a slider and a field, for a single value or for one value per part.
//!
//! Controls use the unit of panels, such as degrees. The texts that they return use the unit of files.

use bevy_egui::egui;

use super::form::{Sheet, Shown};
use super::row::VALUE_WIDTH;
use super::scale::{NUMBERS_HEIGHT, Scale};
use super::values::rounded;
use crate::studio::ui::accessible::{named, named_selected};
use crate::studio::ui::check_box::check_box;
use crate::studio::ui::number_field::select_all_on_focus;
use crate::studio::ui::text_rows::{text_field, weak};
use crate::studio::ui::theme;
use snakes_core::schema::{ListedSetting, NumberRange, SettingValue};

/// Width of the switch between a single value and one value per part, in points.
const SWITCH_WIDTH: f32 = 72.0;

/// A control for the text of one value.
pub(super) struct Control<'a> {
    /// ID of the control.
    pub id: &'a str,
    /// ID of the control's label.
    pub name: egui::Id,
    /// Name for accessibility tools, if the label is not sufficient.
    pub said: Option<String>,
    /// Value as text, in the unit of panels.
    pub value: &'a str,
    /// Value as text, in the unit of files.
    pub stored: &'a str,
    pub hint: &'a str,
    /// Converts typed text to the setting's text, in the unit of files. The error is a sentence.
    pub check: &'a dyn Fn(&str) -> Result<String, String>,
}

impl<'a> Control<'a> {
    /// Creates the control of a whole setting.
    pub(super) fn of(
        shown: &'a Shown,
        name: egui::Id,
        check: &'a dyn Fn(&str) -> Result<String, String>,
    ) -> Self {
        let Shown { listed, stored, text, hint, .. } = shown;
        Self { id: &listed.path, name, said: None, value: text, stored, hint, check }
    }
}

impl Sheet {
    /// Draws a number, or one number per part. Returns a new value, if there is one.
    pub(super) fn number(
        &mut self,
        ui: &mut egui::Ui,
        shown: &Shown,
        range: &NumberRange,
    ) -> Option<String> {
        let each = match &shown.listed.value {
            SettingValue::List(each) => Some(each.as_slice()),
            _ => None,
        };
        let is_given = shown.listed.value != SettingValue::None;
        let is_small = range.slider.is_none() && range.begins_with.is_none();
        let mut new = self.row(
            ui,
            (&shown.listed.path, is_small),
            |ui, width| number_name(ui, shown, range, each, width),
            |sheet, ui, width, name| {
                if is_given && each.is_none() {
                    let check = |text: &str| shown.values.typed(shown.listed, text);
                    let control = Control::of(shown, name, &check);
                    return sheet.slider_and_field(ui, &control, shown, range, width);
                }
                let part = range.parts.word();
                // The hint says what happens without a value.
                let without = shown.listed.setting.hint.split_once("Without a value, ");
                let instead = match is_given {
                    true => format!("{part} by {part}"),
                    false => without.map_or("off".to_owned(), |(_, of)| format!("off: {of}")),
                };
                ui.add(egui::Label::new(weak(ui, instead)).wrap());
                None
            },
            |sheet, ui| sheet.buttons(ui, shown),
        );
        if is_given && each.is_none() {
            make_room_for_numbers(ui, range);
        }
        let each = each.unwrap_or_default();
        for index in 0..each.len() {
            new = self.part(ui, shown, range, each, index).or(new.take());
        }
        new
    }

    /// Draws the number of one part. Returns the new list, if the number has changed.
    fn part(
        &mut self,
        ui: &mut egui::Ui,
        shown: &Shown,
        range: &NumberRange,
        each: &[f32],
        index: usize,
    ) -> Option<String> {
        let part = range.parts.name(index);
        let id = format!("{}[{index}]", shown.listed.path);
        let stored = each[index].to_string();
        let setting = &shown.listed.setting;
        let value = setting.shown_number(each[index]);
        let with = |text: &str| {
            let mut all = each.to_vec();
            all[index] = text.parse().unwrap_or(each[index]);
            SettingValue::List(all).to_string()
        };
        let check = |text: &str| {
            let text = shown.values.typed(shown.listed, text)?;
            shown.values.whole(shown.listed, &with(&text)).map(|()| text)
        };
        let new = self.row(
            ui,
            (&id, false),
            |ui, _| {
                ui.add_space(theme::GAP * 2.0);
                (ui.label(weak(ui, &part)).id, None)
            },
            |sheet, ui, width, name| {
                let said = Some(format!("{} of {}", setting.label, part.to_lowercase()));
                let of_whole = Control::of(shown, name, &check);
                let control = Control { id: &id, said, value: &value, stored: &stored, ..of_whole };
                sheet.slider_and_field(ui, &control, shown, range, width)
            },
            |_, _| None,
        );
        make_room_for_numbers(ui, range);
        new.map(|text| with(&text))
    }

    /// Draws a slider, if the range has one, and a field. Returns the slider's value when the slider is released or
    /// rests, and the field's value when the field loses the focus.
    fn slider_and_field(
        &mut self,
        ui: &mut egui::Ui,
        control: &Control,
        shown: &Shown,
        range: &NumberRange,
        width: f32,
    ) -> Option<String> {
        let setting = &shown.listed.setting;
        let range = setting.shown_range(range);
        let mut slid = None;
        if let Some(ends) = range.slider {
            ui.spacing_mut().slider_width =
                (width - VALUE_WIDTH - theme::GAP).max(theme::GAP * 4.0);
            let scale = Scale::of(&range, ends, setting.shown_unit());
            slid = self.slider(ui, control, &scale, range.is_whole);
        } else {
            // The field is aligned with the other fields.
            ui.add_space(width - VALUE_WIDTH);
        }
        let held = self.changing.as_ref().filter(|changing| changing.id == control.id);
        let value = held.map(|changing| rounded(changing.so_far));
        let value = value.as_deref().unwrap_or(control.value);
        let typed = self.text_field(ui, control, value, VALUE_WIDTH);
        slid.or(typed)
    }

    /// Draws a text field. Returns its text when it loses the focus, if the text is valid and has changed.
    pub(super) fn text_field(
        &mut self,
        ui: &mut egui::Ui,
        control: &Control,
        value: &str,
        width: f32,
    ) -> Option<String> {
        if self.typed.get(control.id).is_some_and(|typed| typed.beside != control.value) {
            // The value was changed elsewhere: by undo, a preset or the slider.
            self.typed.remove(control.id);
        }
        let seen_in = self.drawn_in;
        let typed = self.typed.get_mut(control.id).map(|typed| {
            typed.seen_in = seen_in;
            typed.text.clone()
        });
        let mut text = typed.unwrap_or_else(|| value.to_owned());
        let size = egui::vec2(width, ui.spacing().interact_size.y);
        let response = ui.add_sized(size, text_field(&mut text).id_salt(control.id));
        let response = response.labelled_by(control.name).on_hover_text(control.hint);
        select_all_on_focus(&response, &text);
        let response = match &control.said {
            Some(said) => named(response, egui::WidgetType::TextEdit, said),
            None => response,
        };
        if response.changed() {
            let problem = (control.check)(&text).err();
            self.keep(control.id, text, problem, control.value);
        }
        if !response.lost_focus() {
            return None;
        }
        if ui.input(|input| input.key_pressed(egui::Key::Escape)) {
            self.typed.remove(control.id);
            return None;
        }
        if self.typed.get(control.id).is_some_and(|typed| typed.problem.is_some()) {
            // Invalid text stays in the field, so that the user can correct it.
            return None;
        }
        let typed = self.typed.remove(control.id)?;
        // A value that was not typed in the unit of panels is shown rounded. If its text is not changed, the value
        // stays exactly as it is.
        let is_other = typed.text.trim() != control.value;
        (control.check)(&typed.text).ok().filter(|text| is_other && text != control.stored)
    }
}

/// Draws the label of a number, with a check box if the value is optional, and a switch if each part may have its own
/// value. Returns the label's ID and the requested value.
fn number_name(
    ui: &mut egui::Ui,
    shown: &Shown,
    range: &NumberRange,
    each: Option<&[f32]>,
    width: f32,
) -> (egui::Id, Option<String>) {
    let ListedSetting { setting, value, .. } = shown.listed;
    let is_given = *value != SettingValue::None;
    let has_switch = range.parts.count() > 1 && is_given;
    let name_width = if has_switch { width - SWITCH_WIDTH - theme::GAP } else { width };
    let mut requested = None;
    let size = egui::vec2(name_width, ui.spacing().interact_size.y);
    let layout = egui::Layout::left_to_right(egui::Align::Center);
    let name = ui.allocate_ui_with_layout(size, layout, |ui| {
        ui.set_width(name_width);
        let Some(begins_with) = range.begins_with else { return shown.name(ui, name_width) };
        let mut given = is_given;
        let name = check_box(ui, &mut given, setting.title()).on_hover_text(&shown.hint);
        if name.changed() {
            requested = Some(if given { begins_with.to_string() } else { "none".to_owned() });
        }
        name
    });
    if has_switch {
        let is_each = each.is_some();
        let of_what = range.parts.word();
        let hint = if is_each {
            format!("Use the value of the first {of_what} for all")
        } else {
            format!("Set each {of_what} separately")
        };
        let switch = ui.selectable_label(is_each, format!("per {of_what}")).on_hover_text(hint);
        let said = format!("{}: {of_what} by {of_what}", setting.label);
        let kind = egui::WidgetType::SelectableLabel;
        if named_selected(switch, kind, is_each, &said).clicked() {
            let one = shown.stored.parse().unwrap_or_default();
            requested = Some(match each {
                Some(each) => each.first().copied().unwrap_or_default().to_string(),
                None => SettingValue::List(vec![one; range.parts.count()]).to_string(),
            });
        }
    }
    (name.inner.id, requested)
}

/// Adds space for the numbers below a slider's marks.
fn make_room_for_numbers(ui: &mut egui::Ui, range: &NumberRange) {
    if range.slider.is_some() {
        ui.add_space(NUMBERS_HEIGHT);
    }
}
