//! Theme of the studio: palette and sizes. No other module defines a colour.

mod fonts;
pub mod palette;

use std::str::FromStr;

use bevy::color::ColorToPacked;
use bevy::prelude::{Color, Resource};
use bevy_egui::egui::{self, Color32};

use snakes_core::check::Invalid;
use snakes_core::schema::named_values;

use palette::CORNER;

pub use fonts::GlyphWarmUp;
pub use palette::Palette;

named_values! {
    /// The palette that panels and scene use. Its name is that in files and flags.
    #[derive(Resource, Default)]
    pub enum Theme {
        /// Light colours, best for a projector in a lit room.
        #[default]
        Light = "light";
        /// Dark colours.
        Dark = "dark";
    }
}

impl Theme {
    /// Returns the palette of the theme.
    pub fn palette(self) -> &'static Palette {
        match self {
            Self::Light => &palette::LIGHT,
            Self::Dark => &palette::DARK,
        }
    }

    /// Returns the other theme.
    pub fn other(self) -> Self {
        match self {
            Self::Light => Self::Dark,
            Self::Dark => Self::Light,
        }
    }
}

impl FromStr for Theme {
    type Err = Invalid;

    fn from_str(text: &str) -> Result<Self, Invalid> {
        let known = Self::ALL.into_iter().find(|theme| theme.name() == text);
        known.ok_or_else(|| Invalid::new("theme", format!("{text:?}"), "light or dark"))
    }
}

impl From<Theme> for egui::Theme {
    fn from(theme: Theme) -> Self {
        match theme {
            Theme::Light => Self::Light,
            Theme::Dark => Self::Dark,
        }
    }
}

/// Returns the palette of the active theme.
pub fn of(ui: &egui::Ui) -> &'static Palette {
    if ui.visuals().dark_mode { &palette::DARK } else { &palette::LIGHT }
}

/// Returns the palette of the active theme of a context.
pub fn of_context(context: &egui::Context) -> &'static Palette {
    if context.theme() == egui::Theme::Dark { &palette::DARK } else { &palette::LIGHT }
}

/// Base unit of spacing, in points.
pub const GAP: f32 = 8.0;
/// Font size of the program's name, in points.
pub const HEADING_SIZE: f32 = 22.0;
/// Font size of a section title, in points.
pub const TITLE_SIZE: f32 = 15.0;
/// Font sizes of the presenting mode's caption, in points. The largest one at which the caption fits is used.
pub const PRESENTED_SIZES: [f32; 4] = [40.0, 34.0, 29.0, 25.0];
/// Font size of the line below the presenting mode's caption, in points.
pub const PRESENTED_DETAIL_SIZE: f32 = 21.0;
/// Height of the band with the presenting mode's caption and the line below it, in points.
pub const PRESENTED_BAND: f32 = 112.0;
/// Diameter of a dot in the colour of a lane, in points.
pub const LANE_DOT: f32 = 10.0;
/// Width of a field for a number, in points.
pub const FIELD_WIDTH: f32 = 64.0;
/// Width of a combo box, in points.
pub const COMBO_WIDTH: f32 = 190.0;
/// Maximum height of an open list, in points: enough for all built-in presets and some of the user's.
const LIST_HEIGHT: f32 = 660.0;
/// Maximum share of the window's height that an open list takes.
const LIST_SHARE: f32 = 0.92;
/// Minimum width that the layout of panels supports, in points.
#[cfg(test)]
pub const PANEL_WIDTH: f32 = 320.0;
/// Height of a tab bar, in points.
pub const TAB_BAR_HEIGHT: f32 = 28.0;
/// Minimum width of a menu, in points.
pub const MENU_WIDTH: f32 = 230.0;
/// Width of the command palette, in points.
pub const PALETTE_WIDTH: f32 = 480.0;
/// Width of a card of the tour, in points.
pub const TOUR_WIDTH: f32 = 332.0;
/// Width of a column in the list of shortcuts, in points.
pub const KEY_COLUMN_WIDTH: f32 = 320.0;
/// Width of a message over the stage, in points.
pub const NOTICE_WIDTH: f32 = 340.0;
/// Height of the torque strip under the stage, in points.
pub const TORQUE_STRIP_HEIGHT: f32 = 88.0;
/// Width of the card with a limb's numbers, in points.
pub const LIMB_CARD_WIDTH: f32 = 284.0;
/// Font size of a name tag, in points.
pub const TAG_SIZE: f32 = 13.0;
/// Height of a chart, in points.
pub const CHART_HEIGHT: f32 = 140.0;
/// Minimum height of a chart, in points.
pub const MIN_CHART_HEIGHT: f32 = 80.0;
/// Minimum height of a chart in the charts panel, and height of a lesson's chart, in points.
pub const PLOT_HEIGHT: f32 = 150.0;
/// Height of the controls above and below a chart in the charts panel, in points.
pub const CHART_CONTROLS_HEIGHT: f32 = 120.0;
/// Maximum ratio of a chart's height to its width.
pub const MAX_CHART_ASPECT: f32 = 1.4;
/// Minimum width of each of several charts side by side, in points.
pub const MULTIPLE_WIDTH: f32 = 230.0;
/// Minimum height of each of several stacked charts, in points.
pub const MULTIPLE_HEIGHT: f32 = 120.0;
/// Width of a colour sample in a legend, in points.
pub const SAMPLE_WIDTH: f32 = 20.0;
/// Minimum width of the labels on the left of a chart, in points.
pub const AXIS_WIDTH: f32 = 24.0;
/// Font size of small text, such as in charts, in points.
pub const SMALL_SIZE: f32 = 11.0;
/// Height of a row in the library, in points.
pub const LIBRARY_ROW_HEIGHT: f32 = 44.0;
/// Size of a thumbnail in a row of the library, in points.
pub const THUMBNAIL_SIZE: egui::Vec2 = egui::vec2(76.0, 36.0);
/// Height of a row in the list of champions, in points.
pub const CHAMPION_ROW_HEIGHT: f32 = 28.0;
/// Size of a thumbnail in the list of champions, in points.
pub const CHAMPION_THUMBNAIL: egui::Vec2 = egui::vec2(44.0, 24.0);
/// Height of the picture of the selected save, in points.
pub const PICTURE_HEIGHT: f32 = 64.0;
/// Stage width below which cards are compact, in points.
pub const NARROW_STAGE: f32 = 560.0;
/// Minimum width of the library at which it shows columns, in points.
pub const COLUMNS_WIDTH: f32 = 560.0;
/// Widths of the library's columns after the name: way, preset, generation, date, in points.
pub const COLUMN_WIDTHS: [f32; 4] = [84.0, 84.0, 150.0, 136.0];
/// Minimum height of the library's list, as a share of the panel's height.
pub const LEAST_LIST_SHARE: f32 = 0.55;
/// Height of the list of a run's champions, in points.
pub const CHAMPIONS_HEIGHT: f32 = 130.0;

/// Returns the maximum height of an open list in this window, in points.
pub fn list_height(ui: &egui::Ui) -> f32 {
    LIST_HEIGHT.min(ui.ctx().content_rect().height() * LIST_SHARE)
}

/// Converts a colour of the scene for egui.
pub fn flat(color: Color) -> Color32 {
    let [red, green, blue, alpha] = color.to_srgba().to_u8_array();
    Color32::from_rgba_unmultiplied(red, green, blue, alpha)
}

/// Configures both egui themes. [`egui::Context::set_theme`] selects the active one.
pub fn apply(context: &egui::Context) {
    context.all_styles_mut(|style| {
        style.text_styles.insert(egui::TextStyle::Small, egui::FontId::proportional(SMALL_SIZE));
        style.spacing.item_spacing = egui::vec2(GAP, GAP * 0.75);
        style.spacing.button_padding = egui::vec2(GAP * 1.25, GAP * 0.625);
        style.spacing.interact_size.y = GAP * 3.0;
        // Otherwise an open list begins with a height of 400 points, whatever its contents.
        style.spacing.default_area_size.y = LIST_HEIGHT;
        // Keep a faint scroll bar visible, beside the content, so that users notice that there is more.
        style.spacing.scroll = egui::style::ScrollStyle {
            floating_width: GAP / 2.0,
            floating_allocated_width: GAP,
            dormant_handle_opacity: 0.3,
            // egui's fade would draw grey edges, because colours blend in linear light in this window.
            fade: egui::style::ScrollFadeStyle { strength: 0.0, ..Default::default() },
            ..egui::style::ScrollStyle::floating()
        };
        for widget in [
            &mut style.visuals.widgets.noninteractive,
            &mut style.visuals.widgets.inactive,
            &mut style.visuals.widgets.hovered,
            &mut style.visuals.widgets.active,
            &mut style.visuals.widgets.open,
        ] {
            widget.corner_radius = CORNER;
        }
    });
    for theme in Theme::ALL {
        context.style_mut_of(theme.into(), |style| theme.palette().dress(&mut style.visuals));
    }
}

#[cfg(test)]
mod tests {
    use super::palette::ramp;
    use super::*;

    #[test]
    fn drawing_uses_the_active_theme() {
        let context = egui::Context::default();
        // egui loads its fonts in the first pass.
        context.begin_pass(egui::RawInput::default());
        apply(&context);
        for theme in [Theme::Dark, Theme::Light] {
            context.set_theme(egui::Theme::from(theme));
            assert_eq!(of_context(&context).panel, theme.palette().panel);
            assert_eq!(context.global_style().visuals.panel_fill, theme.palette().panel);
        }
    }

    #[test]
    fn the_colour_ramp_brightens_monotonically() {
        let brightness = |color: Color32| {
            let [r, g, b, _] = color.to_array().map(f32::from);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        let shades: Vec<f32> = (0..=100).map(|i| brightness(ramp(i as f32 / 100.0))).collect();
        assert!(shades.is_sorted(), "{shades:?}");
    }
}
