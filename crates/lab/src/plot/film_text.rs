//! Texts on the frames of a film: a band along the lower edge, and a title over the picture. Their sizes follow the height of the
//! picture.

use std::error::Error;

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::canvas::{Area, FONT, INK, PlotError, draw_on};
use snakes_core::save::Picture;

/// Opacity of the band and of the plate behind a title.
const VEIL: f64 = 0.82;
/// Opacity of less important texts.
const WEAK: f64 = 0.72;
/// Minimum height of the band, in pixels.
const LEAST_BAND: u32 = 22;
/// Height of the picture divided by the height of the band.
const BANDS: u32 = 14;

/// The texts of the band along the lower edge.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct FilmBand {
    /// Name at the left end of the band.
    pub name: String,
    /// Text after the name in the band.
    pub detail: String,
    /// Time at the right end of the band.
    pub clock: String,
}

/// A title that is drawn over the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct FilmTitle {
    /// Text of the large line.
    pub text: String,
    /// Text of the smaller line below; may be empty.
    pub below: String,
    /// Opacity of the title, from 0 to 1.
    pub opacity: f64,
}

/// Draws the band onto a picture. Text that does not fit is left out: first the detail, then the end of the name.
///
/// # Errors
/// The plotting library failed.
pub fn film_band(picture: &mut Picture, band: &FilmBand) -> Result<(), PlotError> {
    let size = (picture.width, picture.height);
    draw_on(picture, |area| {
        let height = (size.1 / BANDS).max(LEAST_BAND).min(size.1);
        let (width, top) = (size.0 as i32, (size.1 - height) as i32);
        let plate = [(0, top), (width, size.1 as i32)];
        area.draw(&Rectangle::new(plate, INK.mix(VEIL).filled()))?;
        let pixels = height * 11 / 20;
        let (margin, middle) = (height as i32 / 2, top + height as i32 / 2);
        let clock_width = width_of(area, &band.clock, pixels)?;
        write(area, &band.clock, (width - margin, middle), (pixels, 1.0), HPos::Right)?;
        let room = width - 3 * margin - clock_width;
        let name = shortened(area, &band.name, (pixels, room))?;
        write(area, &name, (margin, middle), (pixels, 1.0), HPos::Left)?;
        let begins = margin + width_of(area, &name, pixels)? + height as i32;
        if begins + width_of(area, &band.detail, pixels)? <= width - 2 * margin - clock_width {
            write(area, &band.detail, (begins, middle), (pixels, WEAK), HPos::Left)?;
        }
        Ok(())
    })
}

/// Draws a title onto a picture, in the middle of its upper part.
///
/// # Errors
/// The plotting library failed.
pub fn film_title(picture: &mut Picture, title: &FilmTitle) -> Result<(), PlotError> {
    let size = (picture.width, picture.height);
    draw_on(picture, |area| {
        let (large, small) = ((size.1 / 11).max(14), (size.1 / 24).max(9));
        let most = size.0 as i32 * 9 / 10;
        let fitting = |text: &str, pixels: u32| -> Result<u32, Box<dyn Error>> {
            let width = width_of(area, text, pixels)?.max(1);
            Ok(if width > most { (pixels as i32 * most / width).max(6) as u32 } else { pixels })
        };
        let (large, small) = (fitting(&title.text, large)?, fitting(&title.below, small)?);
        let widest = width_of(area, &title.text, large)?.max(width_of(area, &title.below, small)?);
        let below = if title.below.is_empty() { 0 } else { small as i32 * 3 / 2 };
        let (middle, top) = (size.0 as i32 / 2, size.1 as i32 / 7);
        let pad = small as i32;
        let half = widest / 2 + pad * 2;
        let bottom = top + large as i32 * 6 / 5 + below + pad * 2;
        let plate = [(middle - half, top), (middle + half, bottom)];
        let opacity = title.opacity.clamp(0.0, 1.0);
        area.draw(&Rectangle::new(plate, INK.mix(VEIL * opacity).filled()))?;
        let line = top + pad + large as i32 * 3 / 5;
        write(area, &title.text, (middle, line), (large, opacity), HPos::Center)?;
        let line = bottom - pad - small as i32 / 2;
        write(area, &title.below, (middle, line), (small, WEAK * opacity), HPos::Center)
    })
}

/// Returns a text, shortened with an ellipsis if it is wider than `room` pixels.
fn shortened(
    area: &Area,
    text: &str,
    (pixels, room): (u32, i32),
) -> Result<String, Box<dyn Error>> {
    if width_of(area, text, pixels)? <= room {
        return Ok(text.to_owned());
    }
    let letters: Vec<char> = text.chars().collect();
    let beginning = |count: usize| letters[..count].iter().chain(&['…']).collect::<String>();
    let (mut fits, mut too_long) = (0, letters.len());
    while fits + 1 < too_long {
        let count = usize::midpoint(fits, too_long);
        let has_room = width_of(area, &beginning(count), pixels)? <= room;
        if has_room { fits = count } else { too_long = count }
    }
    Ok(if fits == 0 { String::new() } else { beginning(fits) })
}

/// Returns the width of a text of this size, in pixels.
fn width_of(area: &Area, text: &str, pixels: u32) -> Result<i32, Box<dyn Error>> {
    if text.is_empty() {
        return Ok(0);
    }
    let style = (FONT, pixels).into_font().color(&WHITE);
    Ok(area.estimate_text_size(text, &style)?.0 as i32)
}

/// Writes a white text, vertically centred at `at`, with its side `side` there.
fn write(
    area: &Area,
    text: &str,
    at: (i32, i32),
    (pixels, opacity): (u32, f64),
    side: HPos,
) -> Result<(), Box<dyn Error>> {
    if text.is_empty() {
        return Ok(());
    }
    let color = WHITE.mix(opacity);
    let style = (FONT, pixels).into_font().color(&color).pos(Pos::new(side, VPos::Center));
    Ok(area.draw(&Text::new(text, at, style))?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn light(picture: &Picture, columns: std::ops::Range<usize>) -> usize {
        let rows = picture.rgb.chunks_exact(picture.width as usize * 3);
        let inside = rows.flat_map(|row| &row.as_chunks::<3>().0[columns.clone()]);
        inside.filter(|pixel| pixel.iter().all(|channel| *channel > 110)).count()
    }

    #[test]
    fn a_band_has_the_name_at_the_left_and_the_time_at_the_right_whatever_its_length() {
        let band = |name: &str| FilmBand {
            name: name.to_owned(),
            detail: "climbed 3 of 10 steps".to_owned(),
            clock: "6.2 s".to_owned(),
        };
        let drawn = |name: &str, size: (u32, u32)| {
            let mut picture = Picture::new(size.0, size.1);
            film_band(&mut picture, &band(name)).expect("drawn");
            picture
        };
        let picture = drawn("climber", (640, 360));
        assert!(light(&picture, 0..100) > 50 && light(&picture, 560..640) > 20);
        assert!(light(&picture, 100..320) > 50, "the detail");
        let long = drawn(&"a very long name ".repeat(40), (640, 360));
        assert!(light(&long, 560..640) > 20, "the time stays");
        let gap = 589..597;
        assert_eq!(light(&long, gap), 0, "a gap before the time");
        drawn("x", (64, 64));
    }

    #[test]
    fn a_title_is_centred_and_fades() {
        let drawn = |opacity: f64| {
            let mut picture = Picture::new(640, 360);
            let (text, below) = ("Generation 12".to_owned(), "climbs 3 steps".to_owned());
            film_title(&mut picture, &FilmTitle { text, below, opacity }).expect("drawn");
            picture
        };
        let (left, right) = (light(&drawn(1.0), 0..320), light(&drawn(1.0), 320..640));
        assert!(left > 300 && left.abs_diff(right) * 3 < left, "{left} and {right}");
        assert_eq!(light(&drawn(0.0), 0..640), 0);
    }
}
