//! The palette of commands: type a few letters, choose, done.

use bevy_egui::egui;

use super::parameters::all_sections;
use crate::save::shipped_presets;
use crate::studio::actions::{ACTIONS, Situation};
use crate::studio::command::Command;
use crate::studio::look;

/// The palette, with what is being typed.
#[derive(Debug, Default)]
pub(super) struct Palette {
    typed: String,
    /// Which of those found is chosen; the first is 0.
    chosen: usize,
    /// Whether it was there in the frame before.
    is_open: bool,
    presets: Vec<(String, String)>,
}

/// Something the palette finds.
#[derive(Debug, Clone, PartialEq)]
struct Entry {
    group: String,
    name: String,
    key: &'static str,
    command: Command,
}

/// So many are shown at once.
const MOST_SHOWN: usize = 10;

impl Palette {
    /// Draws the palette over the window and adds what was asked for.
    pub fn ui(
        &mut self,
        context: &egui::Context,
        situation: Situation,
        lessons: &[&str],
        asked: &mut Vec<Command>,
    ) {
        let is_new = !self.is_open;
        if is_new {
            *self = Self { presets: presets(), is_open: true, ..Self::default() };
        }
        let found = found(&self.entries(situation, lessons), &self.typed);
        self.chosen = self.chosen.min(found.len().saturating_sub(1));
        let (down, up, enter) = context.input_mut(|input| {
            let mut pressed = |key| input.consume_key(egui::Modifiers::NONE, key);
            (pressed(egui::Key::ArrowDown), pressed(egui::Key::ArrowUp), pressed(egui::Key::Enter))
        });
        if down {
            self.chosen = (self.chosen + 1).min(found.len().saturating_sub(1));
        }
        if up {
            self.chosen = self.chosen.saturating_sub(1);
        }
        let mut taken = enter.then(|| found.get(self.chosen).cloned()).flatten();
        let palette = look::of_context(context);
        let area = egui::Modal::default_area(egui::Id::new("palette"))
            .anchor(egui::Align2::CENTER_TOP, [0.0, look::GAP * 8.0]);
        let modal = egui::Modal::new(egui::Id::new("palette")).area(area).frame(palette.dialog());
        let shown = modal.show(context, |ui| {
            ui.set_width(look::PALETTE_WIDTH.min(context.content_rect().width() - look::GAP * 4.0));
            let field = egui::TextEdit::singleline(&mut self.typed)
                .hint_text("What do you want to do?")
                .desired_width(f32::INFINITY);
            let field = ui.add(field);
            field.widget_info(|| {
                egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, true, "Find a command")
            });
            if is_new {
                field.request_focus();
            }
            if field.changed() {
                self.chosen = 0;
            }
            if found.is_empty() {
                super::explain(ui, "Nothing is called like that.");
            }
            for (index, entry) in found.iter().enumerate() {
                let name = format!("{}: {}", entry.group, entry.name);
                let key = egui::RichText::new(entry.key).color(palette.text_weak);
                let button = egui::Button::selectable(index == self.chosen, name).right_text(key);
                let row = ui.add(button.min_size(egui::vec2(ui.available_width(), 0.0)));
                if row.clicked() {
                    taken = Some(entry.clone());
                }
            }
        });
        if let Some(entry) = taken {
            asked.extend([Command::Uncover, entry.command]);
        } else if shown.backdrop_response.clicked() {
            asked.push(Command::Uncover);
        }
    }

    /// Forgets what was typed: the palette is gone.
    pub fn close(&mut self) {
        self.is_open = false;
    }

    fn entries(&self, situation: Situation, lessons: &[&str]) -> Vec<Entry> {
        let of_action = |action: &crate::studio::actions::Action| {
            let is_itself = action.name == "Find a command";
            let command = (action.asks)(situation).filter(|_| !is_itself)?;
            let (group, name) = (action.menu.name().to_owned(), action.name.to_owned());
            Some(Entry { group, name, key: action.key(), command })
        };
        let presets = self.presets.iter().map(|(name, about)| {
            let name_and_words = format!("{name} - {}", first_sentence(about));
            let command = Command::SetPreset(name.clone());
            Entry { group: "Preset".to_owned(), name: name_and_words, key: "", command }
        });
        let lessons = lessons.iter().enumerate().map(|(index, name)| Entry {
            group: "Lesson".to_owned(),
            name: (*name).to_owned(),
            key: "",
            command: Command::BeginLesson(index),
        });
        let settings = all_sections().into_iter().flat_map(|section| {
            section.entries.iter().map(|entry| Entry {
                group: "Setting".to_owned(),
                name: format!("{} ({})", entry.label, section.title.to_lowercase()),
                key: "",
                command: Command::FindSetting(entry.label),
            })
        });
        let actions = ACTIONS.iter().filter_map(of_action);
        actions.chain(presets).chain(lessons).chain(settings).collect()
    }
}

fn presets() -> Vec<(String, String)> {
    // The shipped presets are well formed; a test holds them to it.
    let presets = shipped_presets().unwrap_or_default();
    presets.into_iter().map(|preset| (preset.name, preset.about)).collect()
}

fn first_sentence(text: &str) -> String {
    let sentence = text.split_once(". ").map_or(text, |(first, _)| first);
    let line: Vec<&str> = sentence.split_whitespace().collect();
    let short: String = line.join(" ").chars().take(60).collect();
    short.trim_end_matches('.').to_owned()
}

/// Those in which every typed word stands, those first in which the words begin one.
fn found(entries: &[Entry], typed: &str) -> Vec<Entry> {
    let words: Vec<String> = typed.split_whitespace().map(str::to_lowercase).collect();
    let mut ranked: Vec<(usize, &Entry)> = entries
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
    ranked.into_iter().take(MOST_SHOWN).map(|(_, entry)| entry.clone()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    /// What is sent when a person types this and does `act`.
    fn sent(typed: &str, act: impl FnOnce(&mut Harness<'_, Vec<Command>>)) -> Vec<Command> {
        let mut palette = Palette::default();
        let mut harness = Harness::new_ui_state(
            |ui, asked| {
                palette.ui(&ui.ctx().clone(), Situation::default(), &["The grip of a step"], asked);
            },
            Vec::new(),
        );
        harness.run();
        harness.get_by_label("Find a command").type_text(typed);
        harness.run();
        act(&mut harness);
        harness.run();
        harness.state().clone()
    }

    #[test]
    fn a_few_letters_and_enter_do_what_is_first() {
        let press = |harness: &mut Harness<'_, Vec<Command>>| harness.key_press(egui::Key::Enter);
        assert_eq!(sent("dark", press), [Command::Uncover, Command::ToggleTheme]);
        let ice = Command::SetPreset("ice".to_owned());
        assert_eq!(sent("preset ice", press), [Command::Uncover, ice]);
        assert_eq!(sent("grip", press), [Command::Uncover, Command::BeginLesson(0)]);
        let setting = Command::FindSetting("Slip");
        assert_eq!(sent("setting slip", press), [Command::Uncover, setting]);
        assert_eq!(sent("no such thing", press), []);
    }

    #[test]
    fn the_arrows_choose_among_those_found() {
        let sent = sent("picture", |harness| {
            harness.key_press(egui::Key::ArrowDown);
            harness.run();
            harness.key_press(egui::Key::Enter);
        });
        let window = crate::studio::screenshot::Photograph::Window;
        assert_eq!(sent, [Command::Uncover, Command::TakePicture(window)]);
    }

    #[test]
    fn a_click_does_it_too() {
        let sent = sent("loop", |harness| {
            harness.get_by_label_contains("Loop, or stay").click();
        });
        assert_eq!(sent, [Command::Uncover, Command::ToggleLoop]);
    }
}
