//! The one look of the studio: palette and spacing. Nothing else in the studio names a colour.

mod letters;
mod palette;

use std::str::FromStr;

use bevy::color::ColorToPacked;
use bevy::prelude::{Color, Resource};
use bevy_egui::egui::{self, Color32, CornerRadius};

use crate::check::Invalid;
use crate::plot;

pub use letters::Letters;
pub use palette::Palette;

/// Which palette panels and scene share.
#[derive(Resource, Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Theme {
    /// Paper and a clear morning: what a projector in a lit room shows best.
    #[default]
    Light,
    /// Slate and evening.
    Dark,
}

impl Theme {
    /// Its colours.
    pub fn palette(self) -> &'static Palette {
        match self {
            Self::Light => &palette::LIGHT,
            Self::Dark => &palette::DARK,
        }
    }

    /// Its name, as in files and flags.
    pub fn name(self) -> &'static str {
        match self {
            Self::Light => "light",
            Self::Dark => "dark",
        }
    }

    /// The other one.
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
        match text {
            "light" => Ok(Self::Light),
            "dark" => Ok(Self::Dark),
            _ => Err(Invalid::new("theme", format!("{text:?}"), "light or dark")),
        }
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

impl From<egui::Theme> for Theme {
    fn from(theme: egui::Theme) -> Self {
        match theme {
            egui::Theme::Light => Self::Light,
            egui::Theme::Dark => Self::Dark,
        }
    }
}

/// The colours of what is being drawn.
pub fn of(ui: &egui::Ui) -> &'static Palette {
    Theme::from(egui::Theme::from_dark_mode(ui.visuals().dark_mode)).palette()
}

/// The colours of the theme that panels have now.
pub fn of_context(context: &egui::Context) -> &'static Palette {
    Theme::from(context.theme()).palette()
}

/// The unit of spacing, in points.
pub const GAP: f32 = 8.0;
/// Size of the program's name, in points.
pub const HEADING_SIZE: f32 = 22.0;
/// Size of a section's title, in points.
pub const TITLE_SIZE: f32 = 15.0;
/// Width of a field for a number, in points.
pub const FIELD_WIDTH: f32 = 64.0;
/// Width of a list to choose from, in points.
pub const COMBO_WIDTH: f32 = 190.0;
/// Width that panels are laid out for at least, in points.
#[cfg(test)]
pub const PANEL_WIDTH: f32 = 320.0;
/// Height of the panels' names over them, in points.
pub const TAB_BAR_HEIGHT: f32 = 28.0;
/// Least width of a menu, in points.
pub const MENU_WIDTH: f32 = 230.0;
/// Width of the palette of commands, in points.
pub const PALETTE_WIDTH: f32 = 480.0;
/// Width of a step of the tour, in points.
pub const TOUR_WIDTH: f32 = 380.0;
/// Width of a column of keys, in points.
pub const KEY_COLUMN_WIDTH: f32 = 320.0;
/// Where messages begin, in points from the top of the window: under the bar over the stage, which in a narrow window
/// reaches as far as they do.
pub const NOTICES_TOP: f32 = 84.0;
/// Width of a message over the stage, in points.
pub const NOTICE_WIDTH: f32 = 340.0;
/// Height of the torques under the stage, in points.
pub const SIGNALS_HEIGHT: f32 = 72.0;
/// Width of a limb's numbers, in points.
pub const LIMB_WIDTH: f32 = 284.0;
/// Size of the letters on a name tag, in points.
pub const TAG_SIZE: f32 = 13.0;
/// Height of the chart, in points.
pub const CHART_HEIGHT: f32 = 170.0;
/// Height of the chart in the lowest window, in points.
pub const LEAST_CHART_HEIGHT: f32 = 80.0;
/// Height of the chart of distance and energy, and of learning curves, in points.
pub const PLOT_HEIGHT: f32 = 150.0;
/// Height of what stands over and under a chart in its panel, in points.
pub const WITHOUT_PLOT: f32 = 120.0;
/// How much higher than wide a chart that has the room may be.
pub const TALLEST_CHART: f32 = 1.4;
/// Least width of one of several charts side by side, in points.
pub const MULTIPLE_WIDTH: f32 = 230.0;
/// Least height of one of several charts below each other, in points.
pub const MULTIPLE_HEIGHT: f32 = 120.0;
/// Width of a sample in a legend, in points.
pub const SAMPLE_WIDTH: f32 = 20.0;
/// Height of a map, in points.
#[cfg(test)]
pub const MAP_HEIGHT: f32 = 190.0;
/// Least width of the numbers at the left of a chart, in points.
pub const AXIS_WIDTH: f32 = 24.0;
/// Size of the letters in and at charts, in points.
pub const SMALL_SIZE: f32 = 11.0;
/// Height of a row in the library, in points.
pub const SAVE_HEIGHT: f32 = 44.0;
/// Size of the little picture in a row of the library, in points.
pub const THUMBNAIL_SIZE: egui::Vec2 = egui::vec2(76.0, 36.0);
/// Height of the picture of the save that is chosen, in points.
pub const PICTURE_HEIGHT: f32 = 64.0;
/// Below this width the stage has little room for cards, in points.
pub const NARROW_STAGE: f32 = 560.0;
/// From this width on the library has columns, in points.
pub const COLUMNS_WIDTH: f32 = 560.0;
/// Widths of the library's columns after the name: fitness, preset, generation, date, in points.
pub const COLUMN_WIDTHS: [f32; 4] = [84.0, 84.0, 150.0, 136.0];
/// Height of the library's list where the panel has no height of its own, and at least, in points.
pub const LIST_HEIGHTS: [f32; 2] = [360.0, 140.0];
/// Height of the list of a run's champions, in points.
pub const CHAMPIONS_HEIGHT: f32 = 130.0;
/// Corner radius of cards and buttons, in points.
const CORNER: CornerRadius = CornerRadius::same(6);

/// A colour of the scene, for a panel.
pub fn flat(color: Color) -> Color32 {
    let [red, green, blue, alpha] = color.to_srgba().to_u8_array();
    Color32::from_rgba_unmultiplied(red, green, blue, alpha)
}

/// The colour of a value between the least, 0, and the most, 1: see [`plot::ramp`].
pub fn ramp(share: f32) -> Color32 {
    let [red, green, blue] = plot::ramp(share);
    Color32::from_rgb(red, green, blue)
}

/// Dresses egui, both its themes: which of them shows is [`show`]'s to say.
pub fn apply(context: &egui::Context) {
    context.all_styles_mut(|style| {
        style.text_styles.insert(egui::TextStyle::Small, egui::FontId::proportional(SMALL_SIZE));
        style.spacing.item_spacing = egui::vec2(GAP, GAP * 0.75);
        style.spacing.button_padding = egui::vec2(GAP * 1.25, GAP * 0.625);
        style.spacing.interact_size.y = GAP * 3.0;
        // Seen without the pointer on it, or nobody knows that there is more; and beside what is scrolled.
        style.spacing.scroll = egui::style::ScrollStyle {
            floating_width: GAP / 2.0,
            floating_allocated_width: GAP,
            dormant_handle_opacity: 0.3,
            // Half a white is grey where colours are blended as light is.
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
    for theme in [Theme::Light, Theme::Dark] {
        context.style_mut_of(theme.into(), |style| theme.palette().dress(&mut style.visuals));
    }
}

/// Shows the panels in this theme from now on.
pub fn show(context: &egui::Context, theme: Theme) {
    context.set_theme(egui::Theme::from(theme));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_theme_is_one_of_two_names() {
        assert_eq!("light".parse(), Ok(Theme::Light));
        assert_eq!("dark".parse(), Ok(Theme::Dark));
        let refused = "Dim".parse::<Theme>().expect_err("no such theme");
        assert_eq!(refused.to_string(), "theme is \"Dim\"; allowed: light or dark");
    }

    #[test]
    fn what_is_drawn_takes_the_colours_of_the_theme_on_show() {
        let context = egui::Context::default();
        // The fonts are there from the first frame on.
        context.begin_pass(egui::RawInput::default());
        apply(&context);
        for theme in [Theme::Dark, Theme::Light] {
            show(&context, theme);
            assert_eq!(of_context(&context).panel, theme.palette().panel);
            assert_eq!(context.global_style().visuals.panel_fill, theme.palette().panel);
        }
    }

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
