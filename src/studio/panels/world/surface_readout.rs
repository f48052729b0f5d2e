//! What the snakes on the stage do on a surface at the shown moment, above the settings of that surface.

use bevy_egui::egui;

use crate::studio::panels::on_stage::OnStage;
use crate::studio::stage::StageMode;
use crate::studio::stage::contact_meter::SurfaceReading;
use crate::studio::stage::lane::Lane;
use crate::studio::ui::lane_dot::lane_dot;
use crate::studio::ui::theme;
use crate::world::TouchedSurface;

/// The lanes whose contacts are read.
#[derive(Clone, Default)]
pub(crate) struct ReadLanes<'l> {
    /// The selected lane, or both lanes of a what-if.
    pub lanes: Vec<&'l Lane>,
    /// Whether they stand beside others, so that their names must be shown.
    pub are_named: bool,
    /// Whether the stage plays. Readings then change a few times per second only.
    pub is_playing: bool,
}

/// Surfaces that a section of the panel is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ReadSurface {
    /// The stairs, and the ground where it shares their surface.
    Stairs,
    /// The ground with a surface of its own.
    Ground,
    /// The skin, where limbs touch each other.
    Skin,
}

/// A line of the read-out.
struct ReadoutLine {
    name: &'static str,
    /// The term of the field.
    term: &'static str,
    hint: &'static str,
}

const CONTACT: ReadoutLine =
    ReadoutLine { name: "Contact", term: "", hint: "Limbs that touch it in the last 0.25 s" };
const SLIP: ReadoutLine = ReadoutLine {
    name: "Slip speed",
    term: "",
    hint: "Speed of the contacts along the surface: mean of the last 0.25 s, in which hard-pressed limbs count most. Near 0 \
           the limbs hold",
};
const GRIP: ReadoutLine = ReadoutLine {
    name: "Grip used",
    term: "friction cone",
    hint: "Share of the friction that is used: sideways force divided by friction times the force pressing down. Mean of \
           all contacts in the last 0.25 s. At 100 % everything that touches slides",
};
const DENT: ReadoutLine = ReadoutLine {
    name: "Dent",
    term: "penetration",
    hint: "Greatest depth to which a limb has sunk in during the last 0.25 s. A hard surface stays near 0",
};
const POWER: ReadoutLine = ReadoutLine {
    name: "Rubbed away",
    term: "friction loss",
    hint: "Energy per second that turns into heat here: friction force times slip speed, and what the surface's damping \
           takes. Mean of the last 0.25 s. Impacts and dents are not in it",
};
const LOST: ReadoutLine = ReadoutLine {
    name: "Lost so far",
    term: "dissipation",
    hint: "Energy lost since the start in all contacts (friction, impacts, dents) and at the stops of the joints: work of the \
           joints, minus the gain in motion and height, minus what the damping of joints and rotation took",
};

/// Height of the bar, in points.
const BAR_HEIGHT: f32 = theme::GAP;
/// Largest width of the bar, in points.
const BAR_WIDTH: f32 = theme::GAP * 15.0;
/// Room for the text beside a bar, in points.
const PERCENT_WIDTH: f32 = theme::GAP * 5.0;
/// Width of the names, in points.
const NAME_WIDTH: f32 = theme::GAP * 11.0;
/// Panel width from which the names have the terms of the field beside them, in points.
const WIDTH_FOR_TERMS: f32 = theme::GAP * 35.0;
/// Width of a name with its term, in points.
const TERM_WIDTH: f32 = theme::GAP * 21.0;
/// Share from which a contact counts as sliding: the engine stays a little below 1.
const SLIDES_FROM: f32 = 0.995;

impl<'l> ReadLanes<'l> {
    /// The lanes to read out of those on the stage.
    pub fn of(lanes: &[&'l Lane], focused: Option<&'l Lane>, on_stage: &OnStage) -> Self {
        let lanes = match *on_stage.mode {
            // To see what a change does, one needs both values.
            StageMode::WhatIf { .. } => lanes.to_vec(),
            StageMode::Solo | StageMode::Race | StageMode::Generation { .. } => {
                focused.into_iter().collect()
            }
        };
        let are_named = matches!(*on_stage.mode, StageMode::WhatIf { .. } | StageMode::Race);
        Self { lanes, are_named, is_playing: on_stage.playback.is_playing() }
    }

    /// Draws the read-out of a surface; nothing without lanes, or for a ground that shares the surface of the stairs.
    pub(super) fn ui(&self, ui: &mut egui::Ui, surface: ReadSurface) {
        let has_own_ground = self.lanes.iter().any(|lane| lane.trial().ground.is_some());
        if self.lanes.is_empty() || (surface == ReadSurface::Ground && !has_own_ground) {
            return;
        }
        let title = match (surface, has_own_ground) {
            (ReadSurface::Stairs, false) => "On stairs and ground now",
            (ReadSurface::Stairs, true) => "On the stairs now",
            (ReadSurface::Ground, _) => "On the ground now",
            (ReadSurface::Skin, _) => "Between limbs now",
        };
        let palette = theme::of(ui);
        let header = egui::RichText::new(title).color(palette.text_weak);
        let fold = egui::CollapsingHeader::new(header)
            .id_salt(("read-out", title))
            .default_open(surface != ReadSurface::Skin);
        let is_meant = |touched: TouchedSurface| match (surface, touched) {
            (ReadSurface::Stairs, TouchedSurface::Stairs)
            | (ReadSurface::Ground, TouchedSurface::Ground)
            | (ReadSurface::Skin, TouchedSurface::Limb(_)) => true,
            (ReadSurface::Stairs, TouchedSurface::Ground) => !has_own_ground,
            _ => false,
        };
        let shown = fold.show_unindented(ui, |ui| self.table(ui, surface, is_meant));
        let hint = "What the snake on the stage does there at the shown moment";
        shown.header_response.on_hover_text(hint);
    }

    fn table(
        &self,
        ui: &mut egui::Ui,
        surface: ReadSurface,
        is_meant: impl Fn(TouchedSurface) -> bool + Copy,
    ) {
        let palette = theme::of(ui);
        let missing = if self.lanes.iter().all(|lane| lane.simulation().is_none()) {
            Some("Not available in a recording")
        } else if self.lanes.iter().any(|lane| lane.is_ghost()) {
            Some("Not available for a ghost")
        } else {
            None
        };
        if let Some(missing) = missing {
            ui.label(egui::RichText::new(missing).color(palette.text_weak));
            return;
        }
        let columns: Vec<LaneColumn> =
            self.lanes.iter().map(|lane| self.column(lane, is_meant)).collect();
        let has_terms = columns.len() == 1 && ui.available_width() >= WIDTH_FOR_TERMS;
        let names_width = if has_terms { TERM_WIDTH } else { NAME_WIDTH };
        let gaps = theme::GAP * columns.len() as f32;
        let room = (ui.available_width() - names_width - gaps) / columns.len() as f32;
        let table = ReadoutTable { columns, has_terms, names_width, room };
        let gap = theme::GAP;
        let grid = egui::Grid::new(("read-out", surface as u8))
            .min_col_width(0.0)
            .min_row_height(gap * 2.25)
            .spacing([gap, gap / 8.0]);
        grid.show(ui, |ui| {
            if self.are_named {
                ui.label("");
                for column in &table.columns {
                    table.cell(ui, |ui| {
                        let dot = lane_dot(ui, column.lane.number());
                        let label = column.lane.staged().label();
                        let name = egui::RichText::new(label).color(palette.text_weak);
                        ui.add(egui::Label::new(name).truncate()).on_hover_text(label);
                        dot.on_hover_text(label);
                    });
                }
                ui.end_row();
            }
            table.line(ui, &CONTACT, is_meant, |ui, column| column.contact(ui));
            table.line(ui, &SLIP, is_meant, |ui, column| {
                column.value(ui, |reading| format!("{:.2} m/s", reading.slip_m_s));
            });
            table.line(ui, &GRIP, is_meant, |ui, column| column.grip(ui));
            table.line(ui, &DENT, is_meant, |ui, column| {
                column.value(ui, |reading| in_mm(reading.depth_m));
            });
            table.line(ui, &POWER, is_meant, |ui, column| {
                column.value(ui, |reading| in_watts(reading.lost_w));
            });
            if surface == ReadSurface::Stairs {
                table.line(ui, &LOST, is_meant, |ui, column| {
                    let lost = column.lane.readings().energy_lost;
                    let lost = lost.map(|lost| in_joules(lost.elsewhere_j()));
                    number(ui, lost.as_deref().unwrap_or(UNKNOWN));
                });
            }
        });
    }

    fn column<'c>(
        &self,
        lane: &'c Lane,
        is_meant: impl Fn(TouchedSurface) -> bool,
    ) -> LaneColumn<'c> {
        let meter = &lane.readings().meter;
        LaneColumn {
            lane,
            reading: meter.surface(self.is_playing, is_meant),
            is_playing: self.is_playing,
        }
    }
}

/// The lines of a read-out with a column for each lane.
struct ReadoutTable<'l> {
    columns: Vec<LaneColumn<'l>>,
    has_terms: bool,
    /// Widths of the names and of a column, in points.
    names_width: f32,
    room: f32,
}

impl ReadoutTable<'_> {
    fn line(
        &self,
        ui: &mut egui::Ui,
        line: &ReadoutLine,
        is_meant: impl Fn(TouchedSurface) -> bool + Copy,
        value: impl Fn(&mut egui::Ui, &LaneColumn),
    ) {
        let palette = theme::of(ui);
        let name = match line.term {
            term if self.has_terms && !term.is_empty() => format!("{} ({term})", line.name),
            _ => line.name.to_owned(),
        };
        let size = egui::vec2(self.names_width, theme::GAP * 2.25);
        ui.allocate_ui_with_layout(size, egui::Layout::left_to_right(egui::Align::Center), |ui| {
            ui.set_width(self.names_width);
            ui.label(egui::RichText::new(name).color(palette.text_weak)).on_hover_text(line.hint);
        });
        for column in &self.columns {
            self.cell(ui, |ui| value(ui, column))
                .on_hover_ui(|ui| column.explain(ui, line, is_meant));
        }
        ui.end_row();
    }

    /// Draws a cell of fixed width, so that nothing moves while the values change.
    fn cell(&self, ui: &mut egui::Ui, content: impl FnOnce(&mut egui::Ui)) -> egui::Response {
        let size = egui::vec2(self.room, theme::GAP * 2.25);
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        let shown = ui.allocate_ui_with_layout(size, layout, |ui| {
            ui.set_width(self.room);
            ui.spacing_mut().item_spacing.x = theme::GAP / 2.0;
            content(ui);
        });
        shown.response
    }
}

/// A lane with its reading on one surface.
struct LaneColumn<'l> {
    lane: &'l Lane,
    /// `None` if no limb touches the surface.
    reading: Option<SurfaceReading>,
    is_playing: bool,
}

impl LaneColumn<'_> {
    fn contact(&self, ui: &mut egui::Ui) {
        let text = match (self.lane.simulation(), self.reading) {
            (None, _) => "recording".to_owned(),
            (_, None) => "none".to_owned(),
            (_, Some(reading)) => {
                format!("{} of {} limbs", reading.limbs, self.lane.body().limbs.len())
            }
        };
        number(ui, &text);
    }

    fn value(&self, ui: &mut egui::Ui, text: impl Fn(&SurfaceReading) -> String) {
        number(ui, self.reading.as_ref().map(text).as_deref().unwrap_or(UNKNOWN));
    }

    /// Draws the share of the friction as a bar with its number.
    fn grip(&self, ui: &mut egui::Ui) {
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
        response.widget_info(|| {
            let said = format!("Grip used: {percent}");
            egui::WidgetInfo::labeled(egui::WidgetType::ProgressIndicator, true, said)
        });
        let full = egui::Rect::from_min_size(bar.min, bar.size() * egui::vec2(share, 1.0));
        let color = if share >= SLIDES_FROM { palette.second } else { palette.accent };
        let corner = BAR_HEIGHT / 2.0;
        ui.painter().rect_filled(bar, corner, palette.empty_cell);
        ui.painter().with_clip_rect(full).rect_filled(bar, corner, color);
        number(ui, &format!("{percent:>5}"));
    }

    /// The tooltip of a value: its meaning, and slip and grip of each limb that touches the surface.
    fn explain(
        &self,
        ui: &mut egui::Ui,
        line: &ReadoutLine,
        is_meant: impl Fn(TouchedSurface) -> bool,
    ) {
        ui.set_max_width(theme::NOTICE_WIDTH);
        ui.label(line.hint);
        if line.name == LOST.name {
            self.explain_energy(ui);
            return;
        }
        let Some(reading) = self.reading else { return };
        if line.name == SLIP.name {
            ui.label(format!("Fastest point: {:.2} m/s", reading.top_slip_m_s));
        }
        let grid = egui::Grid::new("limbs").num_columns(4).spacing([theme::GAP, 0.0]);
        grid.show(ui, |ui| {
            for limb in 0..self.lane.body().limbs.len() {
                let meter = &self.lane.readings().meter;
                let Some(reading) = meter.limb(self.is_playing, limb, &is_meant) else { continue };
                ui.label(format!("Limb {}", limb + 1));
                for text in [
                    format!("{:5.2} m/s", reading.slip_m_s),
                    reading.grip_share.map_or(UNKNOWN.to_owned(), in_percent),
                    in_mm(reading.depth_m),
                ] {
                    ui.label(egui::RichText::new(format!("{text:>6}")).monospace());
                }
                ui.end_row();
            }
        });
    }
}

impl LaneColumn<'_> {
    /// Lists where the energy went.
    fn explain_energy(&self, ui: &mut egui::Ui) {
        let Some(lost) = self.lane.readings().energy_lost else {
            if self.lane.is_disturbed() {
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
                let text = format!("{:>8}", in_joules(energy_j));
                ui.label(egui::RichText::new(text).monospace());
                ui.end_row();
            }
        });
    }
}

/// Stands for a value that there is not.
const UNKNOWN: &str = "–";

fn number(ui: &mut egui::Ui, text: &str) {
    let text = egui::RichText::new(text).monospace();
    ui.add(egui::Label::new(text).truncate());
}

/// A share as whole percents.
pub(crate) fn in_percent(share: f32) -> String {
    format!("{:.0} %", share * 100.0)
}

fn in_mm(depth_m: f32) -> String {
    format!("{:.0} mm", depth_m * 1000.0)
}

fn in_watts(power_w: f32) -> String {
    if power_w < 9.95 { format!("{power_w:.1} W") } else { format!("{power_w:.0} W") }
}

fn in_joules(energy_j: f32) -> String {
    // Rounding must not leave "-0 J" at the start.
    let energy_j = energy_j.max(0.0);
    if energy_j < 999.5 {
        format!("{energy_j:.0} J")
    } else {
        format!("{:.2} kJ", energy_j / 1000.0)
    }
}
