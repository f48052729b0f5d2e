//! A column of the table: the readings of one lane on one surface.

use bevy_egui::egui;

use crate::studio::stage::contact_meter::SurfaceReading;
use crate::studio::stage::lane::Lane;
use crate::studio::ui::accessible::named;
use crate::studio::ui::decimals::in_percent;
use crate::studio::ui::theme;
use snakes_core::world::TouchedSurface;

/// Height of the bar that shows the share of friction, in points.
const BAR_HEIGHT: f32 = theme::GAP;
/// Maximum width of the bar, in points.
const BAR_WIDTH: f32 = theme::GAP * 15.0;
/// Width of the text beside the bar, in points.
const PERCENT_WIDTH: f32 = theme::GAP * 5.0;
/// Minimum width of a column in which "5 of 5 blocks" fits, in points.
const WIDTH_FOR_LIMBS: f32 = theme::GAP * 12.5;
/// Share of the available friction from which a contact counts as sliding. The engine's values stay slightly below 1.
const SLIDES_FROM: f32 = 0.995;

/// A column of the table: a lane with its reading on one surface.
pub(super) struct LaneColumn<'l> {
    pub lane: &'l Lane,
    /// Width of the column, in points.
    pub width: f32,
    /// Reading of the surface; `None` if no limb touches it.
    reading: Option<SurfaceReading>,
    is_playing: bool,
    /// Returns whether a surface that a limb touches belongs to the section.
    is_meant: &'l dyn Fn(TouchedSurface) -> bool,
}

impl<'l> LaneColumn<'l> {
    /// Creates the column of a lane for the surfaces for which `is_meant` holds.
    pub fn of(
        lane: &'l Lane,
        width: f32,
        is_playing: bool,
        is_meant: &'l dyn Fn(TouchedSurface) -> bool,
    ) -> Self {
        let reading = lane.readings.meter.surface(is_playing, is_meant);
        Self { lane, width, reading, is_playing, is_meant }
    }

    /// Draws the energy lost so far in contacts and at the stops of the joints.
    pub fn lost(&self, ui: &mut egui::Ui) {
        let lost = self.lane.readings.energy_lost;
        let lost = lost.map(|lost| in_joules(lost.elsewhere_j()));
        number(ui, lost.as_deref().unwrap_or(UNKNOWN));
    }

    /// Draws how many limbs touch the surface.
    pub fn contact(&self, ui: &mut egui::Ui) {
        let text = match (self.lane.replay.simulation(), self.reading) {
            (None, _) => "recording".to_owned(),
            (_, None) => "none".to_owned(),
            (_, Some(reading)) => {
                let unit = if ui.available_width() < WIDTH_FOR_LIMBS { "" } else { " blocks" };
                format!("{} of {}{unit}", reading.limbs, self.lane.body.limbs())
            }
        };
        number(ui, &text);
    }

    /// Draws a value of the reading as text.
    pub fn value(&self, ui: &mut egui::Ui, text: impl Fn(&SurfaceReading) -> String) {
        number(ui, self.reading.as_ref().map(text).as_deref().unwrap_or(UNKNOWN));
    }

    /// Draws the used share of the available friction as a bar with a number.
    pub fn grip(&self, ui: &mut egui::Ui) {
        let Some(share) = self.reading.and_then(|reading| reading.grip_share) else {
            let is_frictionless = self.reading.is_some();
            number(ui, if is_frictionless { "no friction" } else { UNKNOWN });
            return;
        };
        let palette = theme::of(ui);
        let width = (ui.available_width() - PERCENT_WIDTH - theme::GAP).clamp(0.0, BAR_WIDTH);
        let (bar, response) =
            ui.allocate_exact_size(egui::vec2(width, BAR_HEIGHT), egui::Sense::hover());
        let percent = in_percent(share);
        let said = format!("Grip used: {percent}");
        named(response, egui::WidgetType::ProgressIndicator, &said);
        let full = egui::Rect::from_min_size(bar.min, bar.size() * egui::vec2(share, 1.0));
        let color = if share >= SLIDES_FROM { palette.second } else { palette.accent };
        let corner = BAR_HEIGHT / 2.0;
        ui.painter().rect_filled(bar, corner, palette.empty_cell);
        ui.painter().with_clip_rect(full).rect_filled(bar, corner, color);
        number(ui, &format!("{percent:>5}"));
    }

    /// Draws the speed of the fastest point, and the readings of each limb.
    pub fn explain_slip(&self, ui: &mut egui::Ui) {
        if let Some(reading) = self.reading {
            ui.label(format!("Fastest point: {:.2} m/s", reading.top_slip_m_s));
        }
        self.explain_limbs(ui);
    }

    /// Draws slip, grip and depth of each limb that touches the surface.
    pub fn explain_limbs(&self, ui: &mut egui::Ui) {
        if self.reading.is_none() {
            return;
        }
        let grid = egui::Grid::new("limbs").num_columns(4).spacing([theme::GAP, 0.0]);
        grid.show(ui, |ui| {
            for limb in 0..self.lane.body.limbs() {
                let meter = &self.lane.readings.meter;
                let Some(reading) = meter.limb(self.is_playing, limb, self.is_meant) else {
                    continue;
                };
                ui.label(format!("Block {}", limb + 1));
                for text in [
                    format!("{:5.2} m/s", reading.slip_m_s),
                    reading.grip_share.map_or(UNKNOWN.to_owned(), in_percent),
                    in_mm(reading.depth_m),
                ] {
                    ui.monospace(format!("{text:>6}"));
                }
                ui.end_row();
            }
        });
    }

    /// Draws a list of the energy lost, by cause.
    pub fn explain_energy(&self, ui: &mut egui::Ui) {
        let Some(lost) = self.lane.readings.energy_lost else {
            if self.lane.replay.is_disturbed() {
                ui.label("Unknown, because the mouse has pulled the snake.");
            }
            return;
        };
        egui::Grid::new("energy").num_columns(2).spacing([theme::GAP, 0.0]).show(ui, |ui| {
            for (name, energy_j) in [
                ("Contacts and stops of joints", lost.elsewhere_j()),
                ("Damping of joints", lost.joint_damping_j),
                ("Damping of rotation", lost.rotation_damping_j),
                ("Sum", lost.total_j),
            ] {
                ui.label(name);
                ui.monospace(format!("{:>8}", in_joules(energy_j)));
                ui.end_row();
            }
        });
    }
}

/// Text in place of a value that is unknown.
const UNKNOWN: &str = "-";

fn number(ui: &mut egui::Ui, text: &str) {
    let text = egui::RichText::new(text).monospace();
    ui.add(egui::Label::new(text).truncate());
}

/// Formats a speed with two decimals, or with one decimal from 10 m/s upwards.
pub(super) fn in_m_s(speed_m_s: f32) -> String {
    let decimals = if speed_m_s < 9.995 { 2 } else { 1 };
    format!("{speed_m_s:.decimals$} m/s")
}

pub(super) fn in_mm(depth_m: f32) -> String {
    format!("{:.0} mm", depth_m * 1000.0)
}

pub(super) fn in_watts(power_w: f32) -> String {
    if power_w < 9.95 { format!("{power_w:.1} W") } else { format!("{power_w:.0} W") }
}

pub(super) fn in_joules(energy_j: f32) -> String {
    // Rounding must not yield "-0 J" at the start.
    let energy_j = if energy_j.abs() < 0.5 { 0.0 } else { energy_j };
    if energy_j.abs() < 999.5 {
        format!("{energy_j:.0} J")
    } else {
        format!("{:.1} kJ", energy_j / 1000.0)
    }
}
