//! Charts as data, and as pictures and tables; and texts on pictures.

mod colors;
mod figure;
mod film_text;
mod labels;
mod paint;
mod series;
mod signal;
mod table;
mod ticks;

use std::error::Error;
use std::sync::OnceLock;

use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};

use snakes_core::save::Picture;

pub use colors::{BAND_OPACITY, ramp, role_color};
pub use figure::{Axis, Chart, Figure, Mark, Role, Series, Shape, extent, padded_range, with_unit};
pub use film_text::{FilmBand, FilmTitle, film_band, film_title};
pub use labels::beside_line;
pub use paint::figure;
pub use signal::signal;
pub use ticks::{tick_step, tick_text};

/// A plot could not be drawn.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the plot cannot be drawn: {0}")]
pub struct PlotError(String);

/// Colour of text and axes.
const INK: RGBColor = RGBColor(0x22, 0x26, 0x2e);
/// Colour of grid lines and frames.
const FAINT: RGBColor = RGBColor(0xdd, 0xdf, 0xe4);
const FONT: &str = "sans-serif";
const TEXT_PIXELS: u32 = 18;

/// The style of labels.
fn text() -> TextStyle<'static> {
    (FONT, TEXT_PIXELS).into_font().color(&INK)
}

/// Writes a line of text onto a picture, on a band along its lower edge.
///
/// # Errors
/// The plotting library failed.
pub fn caption(picture: &mut Picture, text: &str) -> Result<(), PlotError> {
    let (width, height) = (picture.width as i32, picture.height as i32);
    draw_on(picture, |area| {
        let band = TEXT_PIXELS as i32 * 2;
        let plate = [(0, height - band), (width, height)];
        area.draw(&Rectangle::new(plate, INK.mix(0.82).filled()))?;
        let style = (FONT, TEXT_PIXELS + 2).into_font().color(&WHITE);
        Ok(area.draw(&Text::new(text, (band / 2, height - band * 3 / 4), style))?)
    })
}

/// A label on a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct NameTag {
    /// Its text.
    pub text: String,
    /// Middle of its lower edge, in pixels from the picture's top left.
    pub at: (f32, f32),
}

/// Writes labels onto a picture, each on a light background above its point. A label that would cover another is moved
/// above it.
///
/// # Errors
/// The plotting library failed.
pub fn tags(picture: &mut Picture, tags: &[NameTag]) -> Result<(), PlotError> {
    // The size of a label on a screen of this height.
    let pixels = (picture.height / 48).clamp(12, 40);
    draw_on(picture, |area| {
        let style = (FONT, pixels).into_font().color(&INK);
        let mut lowest_first: Vec<_> = tags.iter().collect();
        lowest_first.sort_by(|a, b| b.at.1.total_cmp(&a.at.1));
        let mut placed: Vec<[i32; 4]> = Vec::new();
        for NameTag { text, at: (x, y) } in lowest_first {
            let (width, height) = area.estimate_text_size(text, &style)?;
            let (width, height) = (width as i32 + pixels as i32, height as i32 + pixels as i32 / 2);
            let mut at = [*x as i32 - width / 2, *y as i32 - height, width, height];
            let covers = |a: &[i32; 4], b: &[i32; 4]| {
                a[0] < b[0] + b[2] && b[0] < a[0] + a[2] && a[1] < b[1] + b[3] && b[1] < a[1] + a[3]
            };
            while let Some(other) = placed.iter().find(|other| covers(other, &at)) {
                at[1] = other[1] - height - 2;
            }
            placed.push(at);
            let corners = [(at[0], at[1]), (at[0] + width, at[1] + height)];
            area.draw(&Rectangle::new(corners, WHITE.mix(0.88).filled()))?;
            let inside = (at[0] + pixels as i32 / 2, at[1] + pixels as i32 * 3 / 8);
            area.draw(&Text::new(text.as_str(), inside, style.clone()))?;
        }
        Ok(())
    })
}

type Area<'a> = DrawingArea<BitMapBackend<'a>, plotters::coord::Shift>;

/// Draws on a picture, with the embedded font.
fn draw_on(
    picture: &mut Picture,
    draw: impl FnOnce(&Area) -> Result<(), Box<dyn Error>>,
) -> Result<(), PlotError> {
    font()?;
    let size = (picture.width, picture.height);
    let area = BitMapBackend::with_buffer(&mut picture.rgb, size).into_drawing_area();
    let drawn = draw(&area).and_then(|()| Ok(area.present()?));
    drawn.map_err(|error| PlotError(error.to_string()))
}

/// Registers the embedded font with the plotting library, once. System fonts are not used, so a plot looks the same
/// everywhere.
fn font() -> Result<(), PlotError> {
    static REGISTERED: OnceLock<bool> = OnceLock::new();
    let register =
        || register_font(FONT, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT).is_ok();
    if *REGISTERED.get_or_init(register) {
        Ok(())
    } else {
        Err(PlotError("the embedded font is broken".to_owned()))
    }
}
