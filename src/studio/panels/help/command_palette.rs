//! The command palette, which searches commands, presets, lessons and settings by name.

use bevy_egui::egui;

use crate::studio::commands::actions::{Action, Situation, actions};
use crate::studio::commands::{Command, LessonCommand, PlanCommand, WindowCommand};
use crate::studio::panels::settings::every_setting;
use crate::studio::ui::accessible::named;
use crate::studio::ui::text_rows::{explain, weak};
use crate::studio::ui::theme;
use snakes_core::save::shipped_presets;
use snakes_core::schema::ListedSetting;
use snakes_lab::run::names::preset_title;

/// The command palette, with its search text.
#[derive(Debug, Default)]
pub(crate) struct CommandPalette {
    typed: String,
    /// Index of the selected match; the first is 0.
    chosen: usize,
    /// Whether the palette was open in the previous frame. If not, it begins with an empty search text.
    pub is_open: bool,
    presets: Vec<(String, String)>,
}

/// An entry that the palette can find.
#[derive(Debug, Clone, PartialEq)]
struct PaletteEntry {
    group: &'static str,
    name: String,
    key: &'static str,
    command: Command,
}

/// Maximum number of matches shown at once.
const MAX_MATCHES: usize = 10;

impl CommandPalette {
    /// Draws the palette over the window and sends the user's commands.
    pub fn ui(&mut self, context: &egui::Context, situation: Situation, lessons: &[&str]) {
        let is_new = !self.is_open;
        if is_new {
            *self = Self { presets: presets(), is_open: true, ..Self::default() };
        }
        let found = matching(&self.entries(situation, lessons), &self.typed);
        let (down, up, enter) = context.input_mut(|input| {
            let mut pressed = |key| input.consume_key(egui::Modifiers::NONE, key);
            (pressed(egui::Key::ArrowDown), pressed(egui::Key::ArrowUp), pressed(egui::Key::Enter))
        });
        let last = found.len().saturating_sub(1);
        self.chosen = (self.chosen + usize::from(down)).min(last).saturating_sub(usize::from(up));
        let mut taken = enter.then(|| found.get(self.chosen).cloned()).flatten();
        let palette = theme::of_context(context);
        let area = egui::Modal::default_area(egui::Id::new("palette"))
            .anchor(egui::Align2::CENTER_TOP, [0.0, theme::GAP * 8.0]);
        let modal = egui::Modal::new(egui::Id::new("palette")).area(area).frame(palette.dialog());
        let shown = modal.show(context, |ui| {
            ui.set_width(
                theme::PALETTE_WIDTH.min(context.content_rect().width() - theme::GAP * 4.0),
            );
            let field = egui::TextEdit::singleline(&mut self.typed)
                .hint_text("Search commands, settings, presets and lessons")
                .desired_width(f32::INFINITY);
            let field = named(ui.add(field), egui::WidgetType::TextEdit, "Find a command");
            if is_new {
                field.request_focus();
            }
            if field.changed() {
                self.chosen = 0;
            }
            if found.is_empty() {
                explain(ui, "No command, setting, preset or lesson matches.");
            }
            for (index, entry) in found.iter().enumerate() {
                let name = format!("{}: {}", entry.group, entry.name);
                let button = egui::Button::selectable(index == self.chosen, name)
                    .right_text(weak(ui, entry.key));
                let row = ui.add(button.truncate().min_size(egui::vec2(ui.available_width(), 0.0)));
                if row.clicked() {
                    taken = Some(entry.clone());
                }
            }
        });
        if let Some(entry) = taken {
            Command::send_all([Command::Window(WindowCommand::CloseModal), entry.command], context);
        } else if shown.backdrop_response.clicked() {
            Command::Window(WindowCommand::CloseModal).send(context);
        }
    }

    fn entries(&self, situation: Situation, lessons: &[&str]) -> Vec<PaletteEntry> {
        let of_action = |action: &Action| {
            let is_itself = action.name == "Find a command";
            let command = action.command(situation).filter(|_| !is_itself)?;
            let (group, name) = (action.menu.name(), action.name.to_owned());
            Some(PaletteEntry { group, name, key: action.key(), command })
        };
        let entry = |group, name, command| PaletteEntry { group, name, key: "", command };
        let presets = self.presets.iter().map(|(name, about)| {
            let command = Command::Plan(PlanCommand::SetPreset(name.clone()));
            // The name in files comes last, where only the search needs it.
            let words = format!("{} - {} ({name})", preset_title(name), first_sentence(about));
            entry("Preset", words, command)
        });
        let lessons = lessons.iter().enumerate().map(|(index, name)| {
            let command = Command::Lesson(LessonCommand::Begin(index));
            entry("Lesson", (*name).to_owned(), command)
        });
        let settings = every_setting().into_iter().map(|of| {
            let command = Command::Window(WindowCommand::FindSetting(of.setting.label));
            entry("Setting", name_of(&of), command)
        });
        let actions = actions().iter().filter_map(of_action);
        actions.chain(presets).chain(lessons).chain(settings).collect()
    }
}

/// Returns the name of a setting with its section.
fn name_of(of: &ListedSetting) -> String {
    format!("{} ({})", of.setting.label, of.section.title.to_lowercase())
}

fn presets() -> Vec<(String, String)> {
    // A test checks that the built-in presets are well formed.
    let presets = shipped_presets().unwrap_or_default();
    presets.into_iter().map(|preset| (preset.name, preset.about)).collect()
}

fn first_sentence(text: &str) -> String {
    let sentence = text.split_once(". ").map_or(text, |(first, _)| first);
    let line: Vec<&str> = sentence.split_whitespace().collect();
    // A longer line is truncated at the edge of the palette.
    line.join(" ").trim_end_matches('.').to_owned()
}

/// Returns the entries that contain all typed words. Matches at the start of a word come first.
fn matching(entries: &[PaletteEntry], typed: &str) -> Vec<PaletteEntry> {
    let words: Vec<String> = typed.split_whitespace().map(str::to_lowercase).collect();
    let mut ranked: Vec<(usize, &PaletteEntry)> = entries
        .iter()
        .filter_map(|entry| {
            let text = format!("{} {}", entry.group, entry.name).to_lowercase();
            let place = |word: &String| {
                let at = text.find(word.as_str())?;
                let begins = at == 0 || text.as_bytes().get(at - 1) == Some(&b' ');
                Some(if begins { at } else { at + 100 })
            };
            let places: Option<Vec<usize>> = words.iter().map(place).collect();
            places.map(|places| (places.iter().sum(), entry))
        })
        .collect();
    if !words.is_empty() {
        ranked.sort_by_key(|(place, _)| *place);
    }
    ranked.into_iter().take(MAX_MATCHES).map(|(_, entry)| entry.clone()).collect()
}

#[cfg(test)]
mod three_clicks;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::commands::{PlayerCommand, ScreenshotArea, ViewCommand};
    use crate::studio::panels::testing::{Sent, panel, press, sent_by};
    use egui_kittest::kittest::{NodeT, Queryable};

    /// Creates the palette in a window of this size, after a text was typed.
    fn palette(size: [f32; 2], typed: &str) -> Sent<'static> {
        let mut palette = CommandPalette::default();
        let mut harness = panel(size, move |ui| {
            let lessons = ["The grip of a step"];
            palette.ui(&ui.ctx().clone(), Situation::default(), &lessons);
        });
        harness.get_by_label("Find a command").type_text(typed);
        harness.run();
        harness
    }

    /// Types a text and calls `act`. Returns the command that was sent after the palette was closed, or `None`.
    fn sent(typed: &str, act: impl FnOnce(&mut Sent<'_>)) -> Option<Command> {
        match &sent_by(palette([800.0, 600.0], typed), act)[..] {
            [] => None,
            [Command::Window(WindowCommand::CloseModal), command] => Some(command.clone()),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn enter_runs_the_first_match() {
        for (typed, command) in [
            ("dark", Some(Command::View(ViewCommand::ToggleTheme))),
            ("preset ice", Some(Command::Plan(PlanCommand::SetPreset("ice".to_owned())))),
            ("grip", Some(Command::Lesson(LessonCommand::Begin(0)))),
            ("setting slip", Some(Command::Window(WindowCommand::FindSetting("Creep (slip)")))),
            ("no such thing", None),
        ] {
            assert_eq!(sent(typed, |harness| press(harness, egui::Key::Enter)), command, "{typed}");
        }
    }

    #[test]
    fn arrow_keys_select_a_match() {
        let sent = sent("picture", |harness| {
            press(harness, egui::Key::ArrowDown);
            press(harness, egui::Key::Enter);
        });
        let picture = ViewCommand::TakePicture(ScreenshotArea::Window);
        assert_eq!(sent, Some(Command::View(picture)));
    }

    #[test]
    fn a_click_runs_a_match() {
        let sent = sent("loop", |harness| {
            harness.get_by_label_contains("Stage: Loop").click();
        });
        assert_eq!(sent, Some(Command::Player(PlayerCommand::ToggleLoop)));
    }

    #[test]
    fn lines_that_are_too_long_end_within_the_palette() {
        let harness = palette([400.0, 700.0], "preset");
        let field = harness.get_by_label("Find a command").rect();
        let is_preset = |label: String| label.starts_with("Preset: ");
        let rows: Vec<egui::Rect> = harness
            .get_all_by(|node| node.label().is_some_and(is_preset))
            .map(|row| row.rect())
            .collect();
        let are_inside = rows.iter().all(|row| row.right() <= field.right() + 1.0);
        assert!(rows.len() > 5 && are_inside, "{rows:?}");
        let labels = harness.get_all_by(|node| node.label().is_some_and(is_preset));
        let longest = labels.filter_map(|row| row.accesskit_node().label()).max_by_key(String::len);
        assert!(longest.is_some_and(|label| label.len() > 70), "nothing is cut beforehand");
    }
}
