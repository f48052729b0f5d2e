//! Loads glyphs onto the graphics card before they are needed.

use std::sync::Arc;

use bevy_egui::egui::epaint::text::{LayoutJob, TextOptions, layout};
use bevy_egui::egui::{self, Color32};

use super::{
    HEADING_SIZE, PRESENTED_DETAIL_SIZE, PRESENTED_SIZES, SMALL_SIZE, TAG_SIZE, TITLE_SIZE,
};

/// Rasterizes every character into egui's font texture before it is drawn. The texture reaches the graphics card one
/// frame after the text, so a new character would be missing for a frame.
#[derive(Debug, Default)]
pub struct GlyphWarmUp {
    /// Text options and pixels per point of the loaded glyphs, whether the presenting mode's sizes are loaded, and the number of fonts,
    /// because a further font empties the texture. `None` before the first call.
    drawn: Option<(TextOptions, f32, bool, usize)>,
}

impl GlyphWarmUp {
    /// Rasterizes every character at the next frame's scale, unless that was done. Must be called after
    /// [`super::apply`] has taken effect and after every change of the scale.
    pub fn warm_up(&mut self, context: &egui::Context, scale: f32, is_presenting: bool) {
        let pixels_per_point = scale * context.native_pixels_per_point().unwrap_or(1.0);
        let (options, fonts) =
            context.fonts(|fonts| (*fonts.options(), fonts.definitions().font_data.len()));
        let now = Some((options, pixels_per_point, is_presenting, fonts));
        if self.drawn != now {
            self.drawn = now;
            draw_letters(context, pixels_per_point, is_presenting);
        }
    }
}

fn draw_letters(context: &egui::Context, pixels_per_point: f32, is_presenting: bool) {
    let letters: String = (' '..='~').chain(['·', '²', '³', '±', '×', '°', '−', '…']).collect();
    let style = context.global_style();
    let sizes = [TITLE_SIZE, HEADING_SIZE, TAG_SIZE, SMALL_SIZE - 1.0];
    let large = PRESENTED_SIZES.into_iter().chain([PRESENTED_DETAIL_SIZE]);
    let sizes = sizes.into_iter().chain(large.filter(|_| is_presenting));
    context.fonts_mut(|view| {
        for font in sizes.map(egui::FontId::proportional).chain(style.text_styles.values().cloned())
        {
            let job = LayoutJob::simple_singleline(letters.clone(), font, Color32::WHITE);
            layout(view.fonts, pixels_per_point, Arc::new(job));
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::ui::theme::apply;

    #[test]
    fn glyphs_are_loaded_before_they_are_drawn() {
        let context = egui::Context::default();
        let mut letters = GlyphWarmUp::default();
        // Counts the glyph uploads in a frame.
        let mut frame = |text: &str, scale: f32| {
            context.begin_pass(egui::RawInput::default());
            if letters.drawn.is_none() {
                apply(&context);
            }
            letters.warm_up(&context, scale, false);
            context.set_zoom_factor(scale);
            let font = egui::TextStyle::Body.resolve(&context.global_style());
            context.fonts_mut(|fonts| fonts.layout_no_wrap(text.to_owned(), font, Color32::WHITE));
            context.end_pass().textures_delta.set.len()
        };
        let text = "/tmp/Ahoi ~ 0123456789: N·m";
        // The style takes effect in the second frame.
        assert!(frame("", 1.0) > 0 && frame("", 1.0) > 0);
        assert_eq!(frame(text, 1.0), 0);
        assert!(frame("é", 1.0) > 0, "one that is not among them");
        assert!(frame("", 1.5) > 0, "for the next frame");
        assert_eq!(frame(text, 1.5), 0);
    }
}
