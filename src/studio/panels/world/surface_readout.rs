//! Readings of the contacts between the snakes on the stage and a surface at the displayed time, above the settings of
//! the surface.

mod lane_column;

use bevy_egui::egui;

use crate::studio::panels::on_stage::OnStage;
use crate::studio::stage::StageMode;
use crate::studio::stage::lane::Lane;
use crate::studio::ui::lane_dot::lane_dot;
use crate::studio::ui::text_rows::{explain, folded, weak};
use crate::studio::ui::theme;
use snakes_core::world::TouchedSurface;

use lane_column::{LaneColumn, in_m_s, in_mm, in_watts};

/// Lanes whose contacts the Change panel shows.
#[derive(Clone, Default)]
pub(crate) struct ReadLanes<'l> {
    /// The selected lane, or all lanes of a what-if.
    pub lanes: Vec<&'l Lane>,
    /// Whether there are other lanes beside these, so that their names are shown.
    pub are_named: bool,
    /// Whether the stage plays. The readings then change only a few times per second.
    pub is_playing: bool,
}

/// Surface that a section of the Change panel is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ReadSurface {
    /// The stairs, and the ground if it shares their surface.
    Stairs,
    /// The ground, if it has its own surface.
    Ground,
    /// The skin of the snake, where limbs touch each other.
    Skin,
}

impl ReadSurface {
    /// Returns whether a surface that a limb touches belongs to this section. The ground belongs to the stairs unless
    /// it has its own surface.
    fn is_meant(self, has_own_ground: bool, touched: TouchedSurface) -> bool {
        match (self, touched) {
            (Self::Stairs, TouchedSurface::Stairs)
            | (Self::Ground, TouchedSurface::Ground)
            | (Self::Skin, TouchedSurface::Limb(_)) => true,
            (Self::Stairs, TouchedSurface::Ground) => !has_own_ground,
            _ => false,
        }
    }
}

/// A line of the readings.
struct ReadoutLine {
    name: &'static str,
    /// Technical term for the quantity.
    term: &'static str,
    hint: &'static str,
    draw: fn(&LaneColumn, &mut egui::Ui),
    /// Draws the tooltip of a value in the line, below the line's hint.
    explain: fn(&LaneColumn, &mut egui::Ui),
}

/// Lines of the readings. The last is about the whole snake, and is shown only with the stairs.
const LINES: [ReadoutLine; 6] = [
    ReadoutLine {
        name: "Contact",
        term: "",
        hint: "Number of blocks that touched it in the last 0.25 s",
        draw: |column, ui| column.contact(ui),
        explain: |column, ui| column.explain_limbs(ui),
    },
    ReadoutLine {
        name: "Slip speed",
        term: "",
        hint: "Speed of the contacts along the surface: mean of the last 0.25 s, in which hard-pressed blocks count most. \
               Near 0 the blocks hold",
        draw: |column, ui| column.value(ui, |reading| in_m_s(reading.slip_m_s)),
        explain: |column, ui| column.explain_slip(ui),
    },
    ReadoutLine {
        name: "Grip used",
        term: "friction cone",
        hint: "Share of the possible friction that is used: force along the surface, divided by the coefficient of \
               friction times the force onto it. Mean of all contacts in the last 0.25 s. At 100 % everything that touches slides",
        draw: |column, ui| column.grip(ui),
        explain: |column, ui| column.explain_limbs(ui),
    },
    ReadoutLine {
        name: "Sinks in",
        term: "penetration",
        hint: "Greatest depth of a block's lowest corner below the surface in the last 0.25 s. A hard surface stays near 0. \
               In a soft one, a block that stands on its end can sink in by more than a metre",
        draw: |column, ui| column.value(ui, |reading| in_mm(reading.depth_m)),
        explain: |column, ui| column.explain_limbs(ui),
    },
    ReadoutLine {
        name: "Heating power",
        term: "dissipation",
        hint: "Energy per second that turns into heat here: friction force times slip speed, and what the surface's \
               damping takes. Mean of the last 0.25 s. Impacts, bounces and dents are not in it",
        draw: |column, ui| column.value(ui, |reading| in_watts(reading.lost_w)),
        explain: |column, ui| column.explain_limbs(ui),
    },
    ReadoutLine {
        name: "Lost so far",
        term: "contacts, stops",
        hint: "Energy lost since the start in all contacts (friction, impacts, dents) and at the stops of the joints: work \
               of the joints, minus the gain in motion and height, minus what the damping of joints and rotation took. A \
               dent holds a part of it, which may come back. Below 0, the engine has added energy",
        draw: |column, ui| column.lost(ui),
        explain: |column, ui| column.explain_energy(ui),
    },
];

/// Width of the lines' names, in points.
const NAME_WIDTH: f32 = theme::GAP * 11.0;
/// Minimum width of a lane's column, in points: enough for every number.
const LEAST_COLUMN: f32 = theme::GAP * 8.5;

impl<'l> ReadLanes<'l> {
    /// Selects the lanes to read among those on the stage.
    pub fn of(lanes: &[&'l Lane], focused: Option<&'l Lane>, on_stage: &OnStage) -> Self {
        let lanes = match *on_stage.mode {
            // The readings of all lanes are shown, so that the effect of the change can be seen.
            StageMode::WhatIf { .. } => lanes.to_vec(),
            StageMode::Solo | StageMode::Race | StageMode::Generation { .. } => {
                focused.into_iter().collect()
            }
        };
        let are_named = matches!(*on_stage.mode, StageMode::WhatIf { .. } | StageMode::Race);
        Self { lanes, are_named, is_playing: on_stage.playback.is_playing }
    }

    /// Draws the readings of a surface. Draws nothing without lanes, or for a ground that shares the surface of the stairs.
    pub(super) fn ui(&self, ui: &mut egui::Ui, surface: ReadSurface) {
        let has_own_ground = self.lanes.iter().any(|lane| lane.trial().ground.is_some());
        if self.lanes.is_empty() || (surface == ReadSurface::Ground && !has_own_ground) {
            return;
        }
        let title = match (surface, has_own_ground) {
            (ReadSurface::Stairs, false) => "On stairs and ground now",
            (ReadSurface::Stairs, true) => "On the stairs now",
            (ReadSurface::Ground, _) => "On the ground now",
            (ReadSurface::Skin, _) => "Between blocks now",
        };
        let header = egui::CollapsingHeader::new(weak(ui, title))
            .id_salt(("read-out", title))
            .default_open(surface != ReadSurface::Skin);
        let hint = "What the snake on the stage does there at the shown moment";
        folded(ui, header, hint, |ui| {
            self.table(ui, surface, has_own_ground);
        });
    }

    fn table(&self, ui: &mut egui::Ui, surface: ReadSurface, has_own_ground: bool) {
        if self.lanes.iter().all(|lane| lane.replay.simulation().is_none()) {
            return explain(ui, "Not available in a recording");
        }
        if self.lanes.iter().any(|lane| lane.is_ghost) {
            return explain(ui, "Not available for a ghost");
        }
        let all_room = ui.available_width() - NAME_WIDTH;
        // Columns for which there is no room are drawn below the first ones.
        let most = ((all_room / (LEAST_COLUMN + theme::GAP)) as usize).max(1);
        let beside = self.lanes.len().div_ceil(self.lanes.len().div_ceil(most));
        let width = all_room / beside as f32 - theme::GAP;
        let is_meant = &|touched| surface.is_meant(has_own_ground, touched);
        let column = |lane: &&'l Lane| LaneColumn::of(lane, width, self.is_playing, is_meant);
        let columns: Vec<LaneColumn> = self.lanes.iter().map(column).collect();
        for (index, columns) in columns.chunks(beside).enumerate() {
            self.grid(ui, (surface, index), columns);
        }
    }

    /// Draws the readings of several lanes side by side. `index` is the number of the table among those of the surface.
    fn grid(
        &self,
        ui: &mut egui::Ui,
        (surface, index): (ReadSurface, usize),
        columns: &[LaneColumn],
    ) {
        let gap = theme::GAP;
        // A table with other columns is another one. It would be drawn once with the widths of the one before, so that its
        // texts overlap.
        let grid = egui::Grid::new(("read-out", surface as u8, index, columns.len()))
            .min_col_width(0.0)
            .min_row_height(gap * 2.25)
            .spacing([gap, gap / 8.0]);
        grid.show(ui, |ui| {
            if self.are_named {
                ui.label("");
                for column in columns {
                    cell(ui, column.width, |ui| {
                        let dot = lane_dot(ui, column.lane.number, theme::LANE_DOT);
                        let label = column.lane.staged.label();
                        let name = weak(ui, head_of(ui, label));
                        ui.add(egui::Label::new(name).truncate()).on_hover_text(label);
                        dot.on_hover_text(label);
                    });
                }
                ui.end_row();
            }
            let of_snake = usize::from(surface == ReadSurface::Stairs);
            for line in &LINES[..LINES.len() - 1 + of_snake] {
                line.ui(ui, columns);
            }
        });
    }
}

/// Returns the head of a lane's column: its label or, if there is no room, the value at the label's end. The beginnings
/// of the labels are often the same.
fn head_of(ui: &egui::Ui, label: &str) -> String {
    let font = egui::TextStyle::Body.resolve(ui.style());
    let whole = ui.painter().layout_no_wrap(label.to_owned(), font, egui::Color32::PLACEHOLDER);
    let value = label.rsplit(' ').next().filter(|last| last.parse::<f64>().is_ok());
    match value {
        Some(value) if whole.size().x > ui.available_width() => format!("…{value}"),
        _ => label.to_owned(),
    }
}

impl ReadoutLine {
    /// Draws the line in a table with these columns.
    fn ui(&self, ui: &mut egui::Ui, columns: &[LaneColumn]) {
        let hint = match self.term {
            "" => self.hint.to_owned(),
            term => format!("{}.\nIn the terms of the field: {term}", self.hint),
        };
        cell(ui, NAME_WIDTH, |ui| drop(ui.label(weak(ui, self.name)).on_hover_text(hint)));
        for column in columns {
            let cell = cell(ui, column.width, |ui| (self.draw)(column, ui));
            // The area for the tooltip is above the number, which would otherwise hide it from the pointer.
            let id = ui.id().with((self.name, column.lane.number));
            ui.interact(cell.rect, id, egui::Sense::hover()).on_hover_ui(|ui| {
                ui.set_max_width(theme::NOTICE_WIDTH);
                ui.label(self.hint);
                (self.explain)(column, ui);
            });
        }
        ui.end_row();
    }
}

/// Draws a cell of this fixed width, in points, so that nothing moves while the values change.
fn cell(ui: &mut egui::Ui, width: f32, content: impl FnOnce(&mut egui::Ui)) -> egui::Response {
    let size = egui::vec2(width, theme::GAP * 2.25);
    let layout = egui::Layout::left_to_right(egui::Align::Center);
    let shown = ui.allocate_ui_with_layout(size, layout, |ui| {
        ui.set_width(width);
        ui.spacing_mut().item_spacing.x = theme::GAP / 2.0;
        content(ui);
    });
    shown.response
}

#[cfg(test)]
mod tests;
