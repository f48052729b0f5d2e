//! The pixels of a picture as a canvas of the plotting library, with the embedded font and common colours.

use std::error::Error;
use std::sync::OnceLock;

use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};

use snakes_core::save::Picture;

/// Error when a plot could not be drawn.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the plot cannot be drawn: {0}")]
pub struct PlotError(String);

/// Colour of text and axes.
pub(super) const INK: RGBColor = RGBColor(0x22, 0x26, 0x2e);
/// Colour of grid lines and frames.
pub(super) const FAINT: RGBColor = RGBColor(0xdd, 0xdf, 0xe4);
/// Name of the embedded font in the plotting library.
pub(super) const FONT: &str = "sans-serif";
/// Height of the text of labels, in pixels.
pub(super) const TEXT_PIXELS: u32 = 18;

/// Returns the style of labels.
pub(super) fn text() -> TextStyle<'static> {
    (FONT, TEXT_PIXELS).into_font().color(&INK)
}

/// A drawing area of the plotting library, over the pixels of a picture.
pub(super) type Area<'a> = DrawingArea<BitMapBackend<'a>, plotters::coord::Shift>;

/// Draws on a picture. The embedded font is available.
pub(super) fn draw_on(
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
