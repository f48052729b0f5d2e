//! Texts in scripts that the panels' own fonts lack, such as a champion's name in Chinese, Arabic or Thai.
//!
//! The texts of each frame are looked through after they are laid out. Fonts of the system are read only when a text needs
//! them, on another thread, and the next frames use them.

use std::collections::BTreeSet;

use ab_glyph::{Font, FontRef};
use bevy::prelude::*;
use bevy::tasks::{IoTaskPool, Task, block_on};
use bevy_egui::egui::epaint::text::{FontInsert, FontPriority, InsertFontFamily, LayoutJob};
use bevy_egui::egui::epaint::{ClippedShape, TextShape};
use bevy_egui::{EguiContext, EguiFullOutput, EguiPostUpdateSet, egui};

use snakes_lab::plot::{SystemFont, in_visual_order, system_font};

/// Characters that were looked for, and the search that goes on.
#[derive(Resource, Default)]
struct Scripts {
    known: BTreeSet<char>,
    search: Option<Task<Vec<&'static SystemFont>>>,
}

pub(super) fn plugin(app: &mut App) {
    let after = EguiPostUpdateSet::EndPass;
    let before = EguiPostUpdateSet::ProcessOutput;
    app.init_resource::<Scripts>().add_systems(PostUpdate, complete.after(after).before(before));
}

/// Completes the texts of this frame, and adds fonts for the next ones.
fn complete(
    mut contexts: Query<(&mut EguiContext, &mut EguiFullOutput)>,
    mut scripts: ResMut<Scripts>,
) {
    for (mut context, mut output) in &mut contexts {
        let Some(output) = &mut output.0 else { continue };
        let context = context.get_mut();
        let letters = complete_texts(context, &mut output.shapes);
        if scripts.search.as_ref().is_some_and(Task::is_finished) {
            let found = scripts.search.take().map(block_on).unwrap_or_default();
            found.into_iter().for_each(|font| add(context, font));
        }
        let unknown: BTreeSet<char> = letters.difference(&scripts.known).copied().collect();
        if scripts.search.is_none() && !unknown.is_empty() {
            scripts.known.extend(&unknown);
            let lacking = lacking(context, unknown);
            let search = async move { lacking.into_iter().filter_map(system_font).collect() };
            scripts.search = Some(IoTaskPool::get().spawn(search));
        }
    }
}

/// Adds a font behind all others, unless it is there.
fn add(context: &egui::Context, font: &'static SystemFont) {
    let family = |family| InsertFontFamily { family, priority: FontPriority::Lowest };
    let families = [egui::FontFamily::Proportional, egui::FontFamily::Monospace].map(family);
    let data = egui::FontData { index: font.index, ..egui::FontData::from_static(font.bytes) };
    context.add_font(FontInsert::new(&font.name, data, families.into()));
}

/// Those characters that the panels' fonts lack. egui itself gives no answer for the font of its replacement character.
fn lacking(context: &egui::Context, mut letters: BTreeSet<char>) -> BTreeSet<char> {
    context.fonts(|fonts| {
        let definitions = fonts.definitions();
        let names = definitions.families.get(&egui::FontFamily::Proportional).into_iter().flatten();
        for data in names.filter_map(|name| definitions.font_data.get(name)) {
            if let Ok(font) = FontRef::try_from_slice_and_index(&data.font, data.index) {
                letters.retain(|letter| font.glyph_id(*letter).0 == 0);
            }
        }
    });
    letters
}

/// Puts words that run from right to left into their order, and returns the characters beyond ASCII.
fn complete_texts(context: &egui::Context, shapes: &mut [ClippedShape]) -> BTreeSet<char> {
    let mut letters = BTreeSet::new();
    for clipped in shapes {
        complete_shape(context, &mut clipped.shape, &mut letters);
    }
    letters
}

fn complete_shape(context: &egui::Context, shape: &mut egui::Shape, letters: &mut BTreeSet<char>) {
    match shape {
        egui::Shape::Vec(parts) => {
            parts.iter_mut().for_each(|part| complete_shape(context, part, letters));
        }
        egui::Shape::Text(text) if !text.galley.job.text.is_ascii() => {
            let beyond = text.galley.job.text.chars().filter(|letter| !letter.is_ascii());
            letters.extend(beyond.filter(|letter| !letter.is_control()));
            put_in_order(context, text);
        }
        _ => {}
    }
}

/// egui turns each word of Hebrew or Arabic round, but puts the words of a line from left to right.
fn put_in_order(context: &egui::Context, shape: &mut TextShape) {
    let job = &shape.galley.job;
    let ([section], [_]) = (job.sections.as_slice(), shape.galley.rows.as_slice()) else { return };
    let text = in_visual_order(&job.text);
    if text != job.text && !shape.galley.elided {
        let text = text.into_owned();
        let section = egui::text::LayoutSection {
            byte_range: 0.into()..text.len().into(),
            ..section.clone()
        };
        let job = LayoutJob { text, sections: vec![section], ..(**job).clone() };
        shape.galley = context.fonts_mut(|fonts| fonts.layout_job(job));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_egui::egui::epaint::text::FontDefinitions;

    /// A context with the panels' main font alone.
    fn plain_context() -> egui::Context {
        let context = egui::Context::default();
        let mut fonts = FontDefinitions::default();
        for family in fonts.families.values_mut() {
            *family = vec!["Ubuntu-Light".to_owned()];
        }
        context.set_fonts(fonts);
        context
    }

    /// Draws a text, and returns its shapes.
    fn drawn(context: &egui::Context, text: &str) -> Vec<ClippedShape> {
        let input = egui::RawInput::default();
        context.run_ui(input, |ui| drop(ui.label(text))).shapes
    }

    fn texts(shapes: &[ClippedShape]) -> Vec<String> {
        let text = |shape: &ClippedShape| match &shape.shape {
            egui::Shape::Text(text) => Some(text.galley.job.text.clone()),
            _ => None,
        };
        shapes.iter().filter_map(text).collect()
    }

    #[test]
    fn f11_a_character_that_no_font_has_is_found_and_a_new_font_draws_it() {
        let context = plain_context();
        let lacking = |context: &egui::Context| {
            lacking(context, complete_texts(context, &mut drawn(context, "snake 🐍 · 3.5 m")))
        };
        assert_eq!(lacking(&context), BTreeSet::from(['🐍']));
        let emoji = epaint_default_fonts::NOTO_EMOJI_REGULAR;
        let font = SystemFont::of_bytes("emoji".to_owned(), emoji, 0).expect("a font");
        let font: &'static SystemFont = Box::leak(Box::new(font));
        add(&context, font);
        assert_eq!(lacking(&context), BTreeSet::new());
        add(&context, font);
        assert_eq!(lacking(&context), BTreeSet::new());
        let families = context.fonts(|fonts| fonts.definitions().families.clone());
        for family in families.values() {
            assert_eq!(family, &["Ubuntu-Light", "emoji"], "behind the panels' own font, once");
        }
    }

    #[test]
    fn f11_words_from_right_to_left_stand_in_their_order() {
        let context = plain_context();
        for (text, expected) in [("שלום עולם", "עולם שלום"), ("a – b", "a – b")]
        {
            let mut shapes = drawn(&context, text);
            complete_texts(&context, &mut shapes);
            assert_eq!(texts(&shapes), [expected]);
        }
    }

    #[test]
    fn f11_names_in_arabic_and_thai_can_be_edited() {
        let Some(fonts) = "بง".chars().map(system_font).collect::<Option<Vec<_>>>() else {
            let required =
                std::env::var("SNAKES_PEER_TESTS").is_ok_and(|value| value == "required");
            assert!(!required, "no font has Arabic and Thai: install fonts-noto-core");
            eprintln!("skipped: no font of this system has Arabic and Thai");
            return;
        };
        for written in ["سلام لا", "งูยาว ที่"] {
            let context = plain_context();
            fonts.iter().for_each(|font| add(&context, font));
            let mut text = String::new();
            let send = |text: &mut String, event: Option<egui::Event>| {
                let events = event.into_iter().collect();
                let input = egui::RawInput { events, ..Default::default() };
                let mut output = context.run_ui(input, |ui| {
                    ui.text_edit_singleline(text).request_focus();
                });
                complete_texts(&context, &mut output.shapes);
            };
            let key = |key, modifiers| {
                let (physical_key, pressed, repeat) = (None, true, false);
                Some(egui::Event::Key { key, physical_key, pressed, repeat, modifiers })
            };
            send(&mut text, None);
            send(&mut text, Some(egui::Event::Text(written.to_owned())));
            assert_eq!(text, written);
            let none = egui::Modifiers::NONE;
            send(&mut text, key(egui::Key::Backspace, none));
            let count = written.chars().count();
            assert_eq!(text, written.chars().take(count - 1).collect::<String>());
            for _ in 0..12 {
                send(&mut text, key(egui::Key::ArrowLeft, none));
                send(&mut text, key(egui::Key::ArrowRight, egui::Modifiers::SHIFT));
            }
            send(&mut text, key(egui::Key::A, egui::Modifiers::COMMAND));
            send(&mut text, key(egui::Key::Delete, none));
            assert_eq!(text, "");
        }
    }
}
