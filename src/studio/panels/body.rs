//! The blocks of the snake on the stage: a drawing, and an editor with budgets, undo and tuning of the gait.

mod budgets;
mod drawing;

use bevy_egui::egui;

use crate::studio::commands::{BlockSize, BodyCommand, Command};
use crate::studio::stage::lane::Lane;
use crate::studio::state::body_editor::{BodyEditor, EditedBody};
use crate::studio::ui::accessible::named;
use crate::studio::ui::buttons::CommandButton;
use crate::studio::ui::text_rows::{cancellable_progress, explain, problem, title, title_and};
use crate::studio::ui::theme;
use snakes_core::genome::{BodyChange, Segment};

use budgets::budgets;
use drawing::drawing;

/// The body panel, with the selected block.
#[derive(Debug, Default)]
pub(super) struct BodyPanel {
    /// Block whose numbers the panel shows; the head is 0.
    block: usize,
    /// Limb that was last selected on the stage, if any.
    limb: Option<usize>,
}

/// A number of a block: its kind, its label, its shown unit, the range of its slider in that unit, and its tooltip.
type Size = (BlockSize, &'static str, &'static str, std::ops::RangeInclusive<f32>, &'static str);

/// Numbers that every block has.
const SIZES: [Size; 4] = [
    (BlockSize::Length, "Length", " m", 0.4..=4.0, "Size along the snake"),
    (BlockSize::Width, "Width", " m", 0.4..=2.0, "Size across the snake"),
    (BlockSize::Height, "Height", " m", 0.4..=2.0, "Size from bottom to top"),
    (BlockSize::Density, "Density", " kg/m³", 1.0..=20.0, "Mass per volume"),
];
/// Numbers of the joint in front of a block. The head has none.
const OF_JOINT: [Size; 3] = [
    (BlockSize::BendLimit, "Bend limit", "°", 10.0..=105.0, "How far it bends, up or down"),
    (BlockSize::TwistLimit, "Twist limit", "°", 0.0..=85.0, "How far it twists, to either side"),
    (BlockSize::Strength, "Strength", "", 0.25..=1.0, "Share of the torque that its blocks allow"),
];
/// Changes of the body's structure, each with its label and its tooltip.
const CHANGES: [(BodyChange, &str, &str); 5] = [
    (BodyChange::Split, "Split", "Two halves in its place. The new joint is held straight"),
    (BodyChange::Duplicate, "Duplicate", "A copy behind it, which moves in the same rhythm"),
    (BodyChange::Insert, "Insert", "A new block between this one and the next, the mean of both"),
    (BodyChange::Merge, "Merge", "One block in the place of this one and the next"),
    (BodyChange::Remove, "Remove", "The blocks beside it are joined"),
];

impl BodyPanel {
    /// Draws the panel and sends the user's commands. `limb` is the selected limb on the stage.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        edited: Option<EditedBody<'_>>,
        lane: Option<&Lane>,
        limb: Option<usize>,
    ) {
        let Some(edited) = edited else { return self.invitation(ui, lane) };
        if limb != self.limb {
            self.limb = limb;
            self.block = limb.unwrap_or(self.block);
        }
        self.block = self.block.min(edited.segments.len().saturating_sub(1));
        self.head(ui, &edited);
        if let Some(block) = drawing(ui, &edited.body, Some(self.block)) {
            self.block = block;
        }
        let is_busy = edited.tuning.is_some();
        ui.add_enabled_ui(!is_busy, |ui| self.block(ui, edited.segments));
        budgets(ui, &edited);
        if let Some(reason) = &edited.problem {
            problem(ui, reason);
        }
        end(ui, &edited);
    }

    /// Draws the panel before the body is edited: the body on the stage, and the button that begins to edit it.
    fn invitation(&mut self, ui: &mut egui::Ui, lane: Option<&Lane>) {
        title(ui, "Body");
        let Some(lane) = lane else {
            return explain(ui, "The blocks of the snake on the stage will appear here.");
        };
        let body = &lane.body;
        drawing(ui, body, None);
        let (blocks, length_m, mass_kg) = (body.limbs(), body.length_m(), body.mass_kg());
        ui.label(format!("{blocks} blocks, {length_m:.1} m long, {mass_kg:.1} kg"));
        if body.is_branching() {
            return explain(
                ui,
                "This body grows from a graph of nodes. Only chains of blocks can be edited here.",
            );
        }
        explain(
            ui,
            "Change sizes, joints and strength of every block, add blocks and remove them: the stage shows the changed \
             snake beside the original.",
        );
        let refusal = BodyEditor::refusal(&lane.staged);
        let edit = CommandButton::new("Edit this body", "", Command::Body(BodyCommand::Edit));
        if edit.unless(refusal.as_deref()).show(ui) {
            self.block = 0;
        }
        if let Some(reason) = refusal {
            explain(ui, &format!("Not possible here. {reason}."));
        }
    }

    /// Draws the title, and the buttons for undo, redo and closing.
    fn head(&self, ui: &mut egui::Ui, edited: &EditedBody<'_>) {
        let name = format!("Body of {}", edited.original.name());
        title_and(ui, &name, |ui| {
            let closes = "Show the original alone. The changes are lost";
            let [can_undo, can_redo] = edited.steps.map(|can| can && edited.tuning.is_none());
            // The buttons are added from right to left.
            for (label, hint, is_on, command) in [
                ("Close", closes, true, BodyCommand::Close),
                ("Redo", "Redo the latest undone change", can_redo, BodyCommand::Redo),
                ("Undo", "Undo the latest change of the body", can_undo, BodyCommand::Undo),
            ] {
                CommandButton::new(label, hint, Command::Body(command)).only_if(is_on).show(ui);
            }
        });
    }

    /// Draws the numbers of the selected block, and the changes of structure at the block.
    fn block(&self, ui: &mut egui::Ui, segments: &[Segment]) {
        let block = self.block;
        let Some(segment) = segments.get(block) else { return };
        let what = match block {
            0 => "Head".to_owned(),
            _ => format!("Block {} of {}", block + 1, segments.len()),
        };
        ui.label(egui::RichText::new(what).strong());
        let joint: &[Size] = if block == 0 { &[] } else { &OF_JOINT };
        egui::Grid::new("block").num_columns(2).show(ui, |ui| {
            for (size, label, unit, range, hint) in SIZES.iter().chain(joint) {
                let is_angle = *unit == "°";
                let value = *size.of_mut(&mut segment.clone());
                let mut value = if is_angle { value.to_degrees() } else { value };
                ui.label(*label).on_hover_text(*hint);
                let slider = egui::Slider::new(&mut value, range.clone()).suffix(*unit);
                let slider = slider.max_decimals(if is_angle { 1 } else { 2 });
                if is_changed(ui, slider, label, hint) {
                    let (size, value) = (*size, if is_angle { value.to_radians() } else { value });
                    Command::Body(BodyCommand::Set { block, size, value }).send(ui);
                }
                ui.end_row();
            }
            softness(ui, block, segment);
        });
        let is_last = block + 1 == segments.len();
        ui.horizontal_wrapped(|ui| {
            for (change, label, hint) in CHANGES {
                let needs_next = matches!(change, BodyChange::Insert | BodyChange::Merge);
                let command = Command::Body(BodyCommand::Change { block, change });
                CommandButton::new(label, hint, command).only_if(!(is_last && needs_next)).show(ui);
            }
        });
    }
}

/// Draws a slider, which moves no value that it does not reach. Returns whether the user changed its value.
fn is_changed(ui: &mut egui::Ui, slider: egui::Slider<'_>, label: &str, hint: &str) -> bool {
    let slider = ui.add(slider.clamping(egui::SliderClamping::Edits)).on_hover_text(hint);
    named(slider, egui::WidgetType::Slider, label).changed()
}

/// Draws the row that shows whether a block is soft, and its Young's modulus.
fn softness(ui: &mut egui::Ui, block: usize, segment: &Segment) {
    const HINT: &str = "A soft block bends and springs back";
    const MODULUS_HINT: &str =
        "Young's modulus of its material. A block that is too stiff to bend is rigid";
    let mut is_soft = segment.youngs_modulus_pa.is_some();
    if ui.checkbox(&mut is_soft, "Soft").on_hover_text(HINT).clicked() {
        let (size, value) = (BlockSize::Modulus, BlockSize::usual_modulus_pa(segment));
        Command::Body(match is_soft {
            true => BodyCommand::Set { block, size, value },
            false => BodyCommand::MakeRigid { block },
        })
        .send(ui);
    }
    if let Some(mut value) = segment.youngs_modulus_pa {
        let slider = egui::Slider::new(&mut value, 1000.0..=100_000.0).suffix(" Pa");
        let slider = slider.logarithmic(true).max_decimals(0);
        if is_changed(ui, slider, "Young's modulus", MODULUS_HINT) {
            let size = BlockSize::Modulus;
            Command::Body(BodyCommand::Set { block, size, value }).send(ui);
        }
    }
    ui.end_row();
}

/// Draws the buttons that adapt the gait to the edited body, start a run from it, and save it.
fn end(ui: &mut egui::Ui, edited: &EditedBody<'_>) {
    ui.add_space(theme::GAP / 2.0);
    if let Some([done, all]) = edited.tuning {
        let share = done as f32 / all.max(1) as f32;
        let words = format!("{done} of {all} gaits tried");
        let cancel = ("Keep the best gait so far", Command::Body(BodyCommand::CancelTuning));
        return cancellable_progress(ui, cancel, share, &words);
    }
    let is_allowed = edited.problem.is_none();
    ui.horizontal_wrapped(|ui| {
        for (label, hint, is_allowed, command) in [
            (
                "Adapt the gait",
                "The gait fits the body with which it evolved: try 59 gaits like it, and keep the best",
                is_allowed,
                BodyCommand::Tune,
            ),
            (
                "Evolve body and gait",
                "Start a run from this snake, in which its blocks change, too. The current run stays saved",
                is_allowed,
                BodyCommand::Evolve,
            ),
            (
                "Save",
                "Save the changed snake in the library",
                is_allowed && edited.is_unsaved,
                BodyCommand::Save,
            ),
        ] {
            CommandButton::new(label, hint, Command::Body(command)).only_if(is_allowed).show(ui);
        }
    });
}

#[cfg(test)]
mod tests;
