//! Charts as data, as pictures and as tables; and texts on pictures.

mod canvas;
mod colors;
mod figure;
mod film_text;
mod labels;
mod paint;
mod scripts;
mod series;
mod signal;
mod system_fonts;
mod table;
mod ticks;

use plotters::prelude::*;

use snakes_core::save::Picture;

pub use canvas::PlotError;
use canvas::{FONT, INK, TEXT_PIXELS, draw_on};
pub use colors::{BAND_OPACITY, ramp, role_color};
pub use figure::{Axis, Chart, Figure, Mark, Role, Series, Shape, extent, padded_range, with_unit};
pub use film_text::{FilmBand, FilmTitle, film_band, film_title};
pub use labels::beside_line;
pub use paint::figure;
pub use scripts::in_visual_order;
pub use signal::signal;
pub use system_fonts::{SystemFont, system_font};
pub use ticks::{tick_step, tick_text};

/// Writes a line of text onto a picture, on a dark band along its lower edge.
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

/// A label for a point of a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct NameTag {
    /// Text of the label.
    pub text: String,
    /// Middle of the label's lower edge, in pixels from the picture's top left.
    pub at: (f32, f32),
}

/// Writes labels onto a picture, each on a light background above its point. A label that would cover another one is moved up above
/// it.
///
/// # Errors
/// The plotting library failed.
pub fn tags(picture: &mut Picture, tags: &[NameTag]) -> Result<(), PlotError> {
    // Height of the text, in pixels, which grows with the height of the picture.
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
