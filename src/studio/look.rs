//! The one look of the studio: palette and spacing. Nothing else in the studio names a colour.

use bevy::prelude::Color;
use bevy_egui::egui::{self, Color32, CornerRadius, Frame, Margin, Stroke};

use crate::evolve::StrategyKind;
use crate::plot::strategy_color;

/// Background of the panel.
pub const PANEL: Color32 = Color32::from_rgb(0x1d, 0x21, 0x2b);
/// Background of a card or a field within it.
pub const FIELD: Color32 = Color32::from_rgb(0x28, 0x2e, 0x3b);
/// A field under the pointer.
pub const FIELD_HOVERED: Color32 = Color32::from_rgb(0x36, 0x3e, 0x4f);
/// Text.
pub const TEXT: Color32 = Color32::from_rgb(0xec, 0xef, 0xf4);
/// Text that explains.
pub const TEXT_WEAK: Color32 = Color32::from_rgb(0xa3, 0xac, 0xbd);
/// What can be pressed, what is new, the best.
pub const ACCENT: Color32 = Color32::from_rgb(0x4f, 0x9d, 0xf7);
/// The mean, beside the best.
pub const SECOND: Color32 = Color32::from_rgb(0xf2, 0xb1, 0x4b);
/// What went wrong.
pub const PROBLEM: Color32 = Color32::from_rgb(0xf0, 0x6a, 0x5f);

/// A cell of a map in which nobody is.
pub const EMPTY_CELL: Color32 = Color32::from_rgb(0x12, 0x15, 0x1c);

/// The report's red, for the first, third and fifth limb.
pub const RED_LIMB: Color = Color::srgb(0.83, 0.12, 0.12);
/// The report's blue, for the second and fourth limb.
pub const BLUE_LIMB: Color = Color::srgb(0.10, 0.26, 0.80);
/// Sky, and what the ground fades into.
pub const SKY: Color = Color::srgb(0.74, 0.83, 0.92);
/// The ground.
pub const GROUND: Color = Color::srgb(0.53, 0.59, 0.53);
/// The lines on the ground.
pub const GRID: Color = Color::srgba(0.0, 0.0, 0.0, 0.16);
/// Every other step.
pub const STAIR: Color = Color::srgb(0.80, 0.76, 0.69);
/// The steps between them.
pub const STAIR_OTHER: Color = Color::srgb(0.71, 0.67, 0.60);
/// The report's two lights are white.
pub const LIGHT: Color = Color::WHITE;

/// The unit of spacing, in points.
pub const GAP: f32 = 8.0;
/// Size of the program's name, in points.
pub const HEADING_SIZE: f32 = 22.0;
/// Size of a section's title, in points.
pub const TITLE_SIZE: f32 = 15.0;
/// Width of a field for a number, in points.
pub const FIELD_WIDTH: f32 = 64.0;
/// From this height on a window has room for everything at once, in points.
pub const TALL_WINDOW: f32 = 880.0;
/// Width of a list to choose from, in points.
pub const COMBO_WIDTH: f32 = 190.0;
/// Width of a slider without its number, in points.
pub const SLIDER_WIDTH: f32 = 190.0;
/// Width of the left panel, in points.
pub const PANEL_WIDTH: f32 = 320.0;
/// Width of a message over the stage, in points.
pub const NOTICE_WIDTH: f32 = 340.0;
/// Largest width of the caption under the stage, in points.
pub const CAPTION_WIDTH: f32 = 520.0;
/// Height of the chart, in points.
pub const CHART_HEIGHT: f32 = 170.0;
/// Height of the chart in the lowest window, in points.
pub const LEAST_CHART_HEIGHT: f32 = 80.0;
/// Height of what stands over the chart, in points; chart and champions share the rest.
pub const WITHOUT_CHART: f32 = 420.0;
/// Height of the chart of distance and energy, and of learning curves, in points.
pub const PLOT_HEIGHT: f32 = 150.0;
/// Height of a map, in points.
pub const MAP_HEIGHT: f32 = 190.0;
/// Least width of the numbers at the left of a chart, in points.
pub const AXIS_WIDTH: f32 = 24.0;
/// Size of the letters in and at charts, in points.
pub const SMALL_SIZE: f32 = 11.0;
/// Width of the list of controllers, in points.
pub const CONTROLLER_WIDTH: f32 = 84.0;
/// Corner radius of cards and buttons, in points.
const CORNER: CornerRadius = CornerRadius::same(6);

/// From the least to the most: viridis (van der Walt and Smith, 2015), whose brightness rises evenly, so that it
/// reads in order without its hues too.
const RAMP: [[u8; 3]; 9] = [
    [0x44, 0x01, 0x54],
    [0x47, 0x2d, 0x7b],
    [0x3b, 0x52, 0x8b],
    [0x2c, 0x72, 0x8e],
    [0x21, 0x91, 0x8c],
    [0x28, 0xae, 0x80],
    [0x5e, 0xc9, 0x62],
    [0xad, 0xdc, 0x30],
    [0xfd, 0xe7, 0x25],
];

/// The colour of a value between the least, 0, and the most, 1.
pub fn ramp(share: f32) -> Color32 {
    let last = RAMP.len() - 1;
    let place = share.clamp(0.0, 1.0) * last as f32;
    let below = (place as usize).min(last - 1);
    let [from, to] = [RAMP[below], RAMP[below + 1]].map(|[r, g, b]| Color32::from_rgb(r, g, b));
    from.lerp_to_gamma(to, place - below as f32)
}

/// The colour of a strategy, in all curves.
pub fn strategy(kind: StrategyKind) -> Color32 {
    let [red, green, blue] = strategy_color(kind);
    // As light as the panel is dark: on white the same colours are a shade darker.
    Color32::from_rgb(red, green, blue).lerp_to_gamma(TEXT, 0.2)
}

/// A card with a coloured edge.
pub fn card(edge: Color32) -> Frame {
    Frame::new()
        .fill(PANEL.gamma_multiply(0.94))
        .stroke(Stroke::new(1.0, edge))
        .corner_radius(CORNER)
        .inner_margin(Margin::symmetric(12, 8))
}

/// Dresses egui.
pub fn apply(context: &egui::Context) {
    context.set_theme(egui::Theme::Dark);
    context.all_styles_mut(|style| {
        style.text_styles.insert(egui::TextStyle::Small, egui::FontId::proportional(SMALL_SIZE));
        style.spacing.item_spacing = egui::vec2(GAP, GAP * 0.75);
        style.spacing.button_padding = egui::vec2(GAP * 1.25, GAP * 0.625);
        style.spacing.interact_size.y = GAP * 3.0;
        let visuals = &mut style.visuals;
        visuals.panel_fill = PANEL;
        visuals.window_fill = PANEL;
        visuals.extreme_bg_color = FIELD;
        visuals.override_text_color = Some(TEXT);
        visuals.weak_text_color = Some(TEXT_WEAK);
        visuals.selection.bg_fill = ACCENT.gamma_multiply(0.45);
        visuals.selection.stroke = Stroke::new(1.0, TEXT);
        for widget in [
            &mut visuals.widgets.noninteractive,
            &mut visuals.widgets.inactive,
            &mut visuals.widgets.hovered,
            &mut visuals.widgets.active,
            &mut visuals.widgets.open,
        ] {
            widget.corner_radius = CORNER;
        }
        visuals.widgets.inactive.weak_bg_fill = FIELD;
        visuals.widgets.inactive.bg_fill = FIELD;
        // Else an empty check box is hardly there.
        visuals.widgets.inactive.bg_stroke = Stroke::new(1.0, FIELD_HOVERED);
        visuals.widgets.hovered.weak_bg_fill = FIELD_HOVERED;
        visuals.widgets.active.weak_bg_fill = ACCENT.gamma_multiply(0.6);
        visuals.widgets.noninteractive.bg_stroke = Stroke::new(1.0, FIELD_HOVERED);
    });
    warm_up_fonts(context);
}

/// Draws every letter once into egui's font texture. A letter that is new to it is missing for a frame,
/// because the texture arrives on the graphics card one frame after the text.
fn warm_up_fonts(context: &egui::Context) {
    let letters: String = (' '..='~').chain(['·', '²', '³', '±']).collect();
    let fonts = egui::TextStyle::Body.resolve(&context.global_style());
    let sizes = [fonts.size, TITLE_SIZE, HEADING_SIZE].map(egui::FontId::proportional);
    let others = [egui::TextStyle::Monospace, egui::TextStyle::Small, egui::TextStyle::Button]
        .map(|style| style.resolve(&context.global_style()));
    context.fonts_mut(|fonts| {
        for font in sizes.into_iter().chain(others) {
            fonts.layout_no_wrap(letters.clone(), font, TEXT);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ramp_gets_brighter_all_the_way() {
        let brightness = |color: Color32| {
            let [r, g, b, _] = color.to_array().map(f32::from);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        let shades: Vec<f32> = (0..=100).map(|i| brightness(ramp(i as f32 / 100.0))).collect();
        assert!(shades.is_sorted(), "{shades:?}");
    }
}
