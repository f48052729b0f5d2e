//! Text field of a dialog that opens on demand, such as one for a name.
//!
//! The field takes the focus when it opens. While it is shown, typed letters go into the field and are never shortcuts,
//! even if no widget has the focus: see [`is_open`].

use bevy_egui::egui;

use super::number_field::select;

/// A text field that Enter or Escape closes.
#[derive(Debug)]
pub(crate) struct TextPrompt {
    /// Text typed so far.
    pub text: String,
    /// What the field does when it takes the focus: `true` selects the whole text, so that typing replaces it; `false`
    /// puts the cursor at the end. `None` once the field has the focus.
    pending: Option<bool>,
}

/// How a text prompt ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PromptEnd {
    /// Enter was pressed.
    Accepted,
    /// Escape was pressed.
    Cancelled,
}

impl TextPrompt {
    /// Creates a prompt with a suggested text, which is selected.
    pub fn new(suggestion: String) -> Self {
        Self { text: suggestion, pending: Some(true) }
    }

    /// Returns the text without spaces at its ends.
    pub fn trimmed(&self) -> &str {
        self.text.trim()
    }

    /// Takes the focus again after an invalid text.
    pub fn ask_again(&mut self) {
        self.pending = Some(false);
    }

    /// Draws the field with `add`. Returns the field's response, and how the prompt ended, if it did.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        add: impl FnOnce(&mut egui::Ui, egui::TextEdit<'_>) -> egui::Response,
    ) -> (egui::Response, Option<PromptEnd>) {
        let context = ui.ctx().clone();
        let pass = context.cumulative_pass_nr();
        context.data_mut(|data| data.insert_temp(mark(), pass));
        let has_focus = context.memory(|memory| memory.focused().is_some());
        let has_keys = self.pending.is_none() && !is_covered(&context) && !has_focus;
        if has_keys {
            self.take_letters(&context);
        }
        let response = add(ui, egui::TextEdit::singleline(&mut self.text));
        if let Some(selects_all) = self.pending.take() {
            response.request_focus();
            // The field opens by an action elsewhere, and its panel may be scrolled away from it.
            response.scroll_to_me(None);
            let length = self.text.chars().count();
            let from = if selects_all { 0 } else { length };
            select(&response, from, length);
            return (response, None);
        }
        let is_left = response.lost_focus() && !is_covered(&context);
        let pressed = |key| context.input(|input| input.key_pressed(key));
        let end = if !(has_keys || is_left) {
            None
        } else if pressed(egui::Key::Enter) {
            Some(PromptEnd::Accepted)
        } else {
            pressed(egui::Key::Escape).then_some(PromptEnd::Cancelled)
        };
        (response, end)
    }

    /// Appends typed letters to the text while no widget has the focus, such as after a click beside the field.
    fn take_letters(&mut self, context: &egui::Context) {
        let typed: String = context.input(|input| {
            let text = |event: &egui::Event| match event {
                egui::Event::Text(text) => Some(text.clone()),
                _ => None,
            };
            input.events.iter().filter_map(text).collect()
        });
        if !typed.is_empty() {
            self.text.push_str(&typed);
            self.pending = Some(false);
        }
    }
}

/// Returns whether a prompt is shown. Typed letters are then never shortcuts.
pub(crate) fn is_open(context: &egui::Context) -> bool {
    let pass: Option<u64> = context.data(|data| data.get_temp(mark()));
    // Between two passes, the pass number is already that of the next one.
    pass.is_some_and(|pass| pass + 1 >= context.cumulative_pass_nr())
}

fn mark() -> egui::Id {
    egui::Id::new("text prompt")
}

/// Returns whether a modal view or a menu is open, which handles Enter and Escape itself.
fn is_covered(context: &egui::Context) -> bool {
    context.memory(|memory| memory.top_modal_layer().is_some()) || egui::Popup::is_any_open(context)
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    /// The open prompt, and the text and the way in which it ended.
    type State = (Option<TextPrompt>, Option<(String, PromptEnd)>);

    /// Creates a prompt in a dialog with a label beside the field.
    fn dialog() -> Harness<'static, State> {
        let draw = |ui: &mut egui::Ui, (prompt, ended): &mut State| {
            ui.label("Beside");
            let Some(open) = prompt else { return };
            let (response, end) = open.ui(ui, |ui, field| ui.add(field));
            ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Name"));
            if let Some(end) = end {
                *ended = prompt.take().map(|prompt| (prompt.text, end));
            }
        };
        let state = (Some(TextPrompt::new("my-ice".to_owned())), None);
        let mut dialog = Harness::new_ui_state(draw, state);
        dialog.run();
        dialog
    }

    fn text(dialog: &Harness<'_, State>) -> String {
        dialog.state().0.as_ref().expect("open").text.clone()
    }

    fn type_text(dialog: &mut Harness<'_, State>, text: &str) {
        dialog.event(egui::Event::Text(text.to_owned()));
        dialog.run();
    }

    #[test]
    fn a_prompt_has_the_focus_and_typing_replaces_its_suggestion() {
        let mut dialog = dialog();
        assert!(dialog.get_by_label("Name").is_focused());
        assert_eq!(text(&dialog), "my-ice");
        type_text(&mut dialog, "M");
        type_text(&mut dialog, "e");
        assert_eq!(text(&dialog), "Me");
        dialog.key_press(egui::Key::Enter);
        dialog.run();
        assert_eq!(dialog.state().1, Some(("Me".to_owned(), PromptEnd::Accepted)));
    }

    #[test]
    fn after_a_click_beside_the_field_letters_enter_and_escape_still_belong_to_it() {
        for (key, end) in
            [(egui::Key::Enter, PromptEnd::Accepted), (egui::Key::Escape, PromptEnd::Cancelled)]
        {
            for is_typed in [true, false] {
                let mut dialog = dialog();
                dialog.get_by_label("Name").click();
                dialog.run();
                let beside = dialog.get_by_label("Beside").rect().right_center();
                dialog.drag_at(beside + egui::vec2(40.0, 0.0));
                dialog.drop_at(beside + egui::vec2(40.0, 0.0));
                dialog.run();
                assert!(!dialog.get_by_label("Name").is_focused());
                assert!(is_open(&dialog.ctx), "its letters are no commands");
                if is_typed {
                    type_text(&mut dialog, "e");
                    type_text(&mut dialog, "!");
                    assert!(dialog.get_by_label("Name").is_focused());
                }
                dialog.key_press(key);
                dialog.run();
                let expected = if is_typed { "my-icee!" } else { "my-ice" };
                assert_eq!(dialog.state().1, Some((expected.to_owned(), end)));
                dialog.run();
                assert!(!is_open(&dialog.ctx), "closed");
            }
        }
    }
}
