//! The pixels of a picture as a canvas of the plotting library, with the embedded font and common colours.

use std::error::Error;
use std::sync::OnceLock;

use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingErrorKind,
};

use super::scripts::InAllScripts;
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
pub(super) type Area<'a> = DrawingArea<Canvas<'a>, plotters::coord::Shift>;

/// The pixels of a picture, on which texts may be in any script.
pub(super) struct Canvas<'a>(BitMapBackend<'a>);

/// Result of drawing on a canvas.
type CanvasResult<'a> =
    Result<(), DrawingErrorKind<<BitMapBackend<'a> as DrawingBackend>::ErrorType>>;

impl<'a> DrawingBackend for Canvas<'a> {
    type ErrorType = <BitMapBackend<'a> as DrawingBackend>::ErrorType;

    fn get_size(&self) -> (u32, u32) {
        self.0.get_size()
    }

    fn ensure_prepared(&mut self) -> CanvasResult<'a> {
        self.0.ensure_prepared()
    }

    fn present(&mut self) -> CanvasResult<'a> {
        self.0.present()
    }

    fn draw_pixel(&mut self, at: BackendCoord, color: BackendColor) -> CanvasResult<'a> {
        self.0.draw_pixel(at, color)
    }

    fn draw_line<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
    ) -> CanvasResult<'a> {
        self.0.draw_line(from, to, style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
        fill: bool,
    ) -> CanvasResult<'a> {
        self.0.draw_rect(from, to, style, fill)
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        at: BackendCoord,
    ) -> CanvasResult<'a> {
        self.0.draw_text(text, &InAllScripts(style), at)
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Self::ErrorType>> {
        self.0.estimate_text_size(text, &InAllScripts(style))
    }
}

/// Draws on a picture. The embedded font is available.
pub(super) fn draw_on(
    picture: &mut Picture,
    draw: impl FnOnce(&Area) -> Result<(), Box<dyn Error>>,
) -> Result<(), PlotError> {
    font()?;
    let size = (picture.width, picture.height);
    let canvas = Canvas(BitMapBackend::with_buffer(&mut picture.rgb, size));
    let area = canvas.into_drawing_area();
    let drawn = draw(&area).and_then(|()| Ok(area.present()?));
    drawn.map_err(|error| PlotError(error.to_string()))
}

/// Registers the embedded font with the plotting library, once. A plot looks the same everywhere, because fonts of the system draw only
/// the characters that this one lacks.
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
