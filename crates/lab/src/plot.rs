//! Plots as pictures: a torque signal as in the report's Figure 4, and any figure that is given as data.

mod colors;
mod figure;
mod film_text;
mod labels;
mod paint;
mod series;
mod ticks;

use std::error::Error;
use std::ops::Range;
use std::sync::OnceLock;

use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};

use snakes_core::evolve::Champion;
use snakes_core::genome::JointCommands;
use snakes_core::save::Picture;
use snakes_core::score::Rollout;

pub use colors::{BAND_OPACITY, ink_on, ramp, role_color};
pub use figure::{Axis, Chart, Figure, Mark, Role, Series, Shape};
pub use film_text::{FilmBand, FilmTitle, film_band, film_title};
pub use labels::beside_line;
pub use paint::figure;
pub use ticks::tick_step;

/// A plot could not be drawn.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the plot cannot be drawn: {0}")]
pub struct PlotError(String);

impl PlotError {
    fn new(error: impl Error) -> Self {
        Self(error.to_string())
    }
}

/// Colour of our results, in all plots.
const OURS: RGBColor = RGBColor(0x1f, 0x6f, 0xd0);
/// Colour of text and axes.
const INK: RGBColor = RGBColor(0x22, 0x26, 0x2e);
/// Colour of grid lines and frames.
const FAINT: RGBColor = RGBColor(0xdd, 0xdf, 0xe4);
const FONT: &str = "sans-serif";
const TITLE_PIXELS: u32 = 26;
const TEXT_PIXELS: u32 = 18;

/// The style of labels.
fn text() -> TextStyle<'static> {
    (FONT, TEXT_PIXELS).into_font().color(&INK)
}

/// Plots the commands to the bend axis of a champion's first joint, as in the report's Figure 4.
///
/// # Errors
/// The plotting library failed.
pub fn signal(champion: &Champion, title: &str) -> Result<Picture, PlotError> {
    let duration_s = f64::from(champion.trial.duration_s);
    let commands = champion.genome.controller.commands(duration_s);
    let JointCommands { quantity, least_range, is_held, joints } =
        commands.unwrap_or_else(|| applied_torques(champion));
    let points = joints.into_iter().next().map_or(Vec::new(), |[bend, _]| bend);
    // Commands that are held between their points have marks; a smooth curve has none.
    let dot = if is_held { 3 } else { 0 };
    let digits = if least_range < 10.0 { 1 } else { 0 };
    let y_range = padded(points.iter().map(|(_, value)| *value).chain([-least_range, least_range]));
    draw((960, 420), |area| {
        let mut chart = ChartBuilder::on(area)
            .caption(title, (FONT, TITLE_PIXELS).into_font().color(&INK))
            .margin(20)
            .x_label_area_size(48)
            .y_label_area_size(80)
            .build_cartesian_2d(0.0..duration_s, y_range)?;
        chart
            .configure_mesh()
            .x_desc("time in s")
            .y_desc(quantity)
            .y_labels(9)
            .y_label_formatter(&|value| format!("{value:.digits$}"))
            .light_line_style(WHITE)
            .bold_line_style(FAINT)
            .axis_style(INK)
            .label_style(text())
            .draw()?;
        chart.draw_series(LineSeries::new([(0.0, 0.0), (duration_s, 0.0)], INK.mix(0.4)))?;
        let line = LineSeries::new(points.clone(), OURS.stroke_width(2)).point_size(dot);
        chart.draw_series(line)?;
        Ok(())
    })
}

/// The torques that acted in a champion's rollout, for a controller whose commands depend on its senses.
fn applied_torques(champion: &Champion) -> JointCommands {
    let mut rollout = Rollout::new(&champion.genome, &champion.trial);
    let step_s = f64::from(champion.trial.physics.step_s());
    let mut joints = vec![[Vec::new(), Vec::new()]; champion.genome.controller.joints()];
    while rollout.advance() {
        let time_s = f64::from(rollout.step() - 1) * step_s;
        for ([bend, twist], torque) in joints.iter_mut().zip(rollout.simulation().applied_torques())
        {
            bend.push((time_s, f64::from(torque.bend_nm)));
            twist.push((time_s, f64::from(torque.twist_nm)));
        }
    }
    JointCommands { quantity: "torque in N·m", least_range: 1000.0, is_held: false, joints }
}

/// Writes a line of text onto a picture, on a band along its lower edge.
///
/// # Errors
/// The plotting library failed.
pub fn caption(picture: &mut Picture, text: &str) -> Result<(), PlotError> {
    font()?;
    let size = (picture.width, picture.height);
    let area = BitMapBackend::with_buffer(&mut picture.rgb, size).into_drawing_area();
    let (width, height) = (size.0 as i32, size.1 as i32);
    let band = TEXT_PIXELS as i32 * 2;
    area.draw(&Rectangle::new([(0, height - band), (width, height)], INK.mix(0.82).filled()))
        .map_err(PlotError::new)?;
    let style = (FONT, TEXT_PIXELS + 2).into_font().color(&WHITE);
    area.draw(&Text::new(text, (band / 2, height - band * 3 / 4), style))
        .map_err(PlotError::new)?;
    area.present().map_err(PlotError::new)
}

/// Writes labels onto a picture, each on a light background above a point: `(text, (x, y))`, in pixels from the top
/// left. A label that would cover another is moved above it.
///
/// # Errors
/// The plotting library failed.
pub fn tags(picture: &mut Picture, tags: &[(&str, (f32, f32))]) -> Result<(), PlotError> {
    font()?;
    let size = (picture.width, picture.height);
    let area = BitMapBackend::with_buffer(&mut picture.rgb, size).into_drawing_area();
    // The size of a label on a screen of this height.
    let pixels = (size.1 / 48).clamp(12, 40);
    let style = (FONT, pixels).into_font().color(&INK);
    let mut lowest_first: Vec<_> = tags.iter().collect();
    lowest_first.sort_by(|a, b| b.1.1.total_cmp(&a.1.1));
    let mut placed: Vec<[i32; 4]> = Vec::new();
    for (text, (x, y)) in lowest_first {
        let (width, height) = area.estimate_text_size(text, &style).map_err(PlotError::new)?;
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
        area.draw(&Rectangle::new(corners, WHITE.mix(0.88).filled())).map_err(PlotError::new)?;
        let inside = (at[0] + pixels as i32 / 2, at[1] + pixels as i32 * 3 / 8);
        area.draw(&Text::new(*text, inside, style.clone())).map_err(PlotError::new)?;
    }
    area.present().map_err(PlotError::new)
}

/// The range of the finite values with a margin.
fn padded(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (least, most) = values
        .filter(|value| value.is_finite())
        .fold((f64::MAX, f64::MIN), |(least, most), value| (least.min(value), most.max(value)));
    if least > most {
        return -1.0..1.0;
    }
    let margin = ((most - least) * 0.06).max(0.5);
    least - margin..most + margin
}

type Area<'a> = DrawingArea<BitMapBackend<'a>, plotters::coord::Shift>;

fn draw(
    size: (u32, u32),
    paint: impl FnOnce(&Area) -> Result<(), Box<dyn Error>>,
) -> Result<Picture, PlotError> {
    font()?;
    let mut picture = Picture::new(size.0, size.1);
    {
        let area = BitMapBackend::with_buffer(&mut picture.rgb, size).into_drawing_area();
        area.fill(&WHITE).map_err(PlotError::new)?;
        paint(&area).map_err(|error| PlotError(error.to_string()))?;
        area.present().map_err(PlotError::new)?;
    }
    Ok(picture)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_values_there_is_a_default_range() {
        assert_eq!(padded(std::iter::empty()), -1.0..1.0);
        assert_eq!(padded([1.0, f64::NAN].into_iter()), 0.5..1.5);
    }
}
