//! Under the stage: what is on it, how far it has come, and the buttons to hold it and to start again.

use bevy_egui::egui;

use crate::studio::command::Command;
use crate::studio::exhibit::Source;
use crate::studio::look;
use crate::studio::stage::Stage;

/// Draws the caption in the middle of what is left of the window, and adds what was asked for. `run` is
/// the number of the current run.
pub(super) fn caption(
    context: &egui::Context,
    stage: &Stage,
    run: u32,
    left_points: f32,
    asked: &mut Vec<Command>,
) {
    let window = context.viewport_rect();
    let centre =
        egui::pos2((left_points + window.right()) / 2.0, window.bottom() - look::GAP * 2.0);
    // In a small window the caption must not cover the panel.
    let width = (window.right() - left_points - look::GAP * 8.0).min(look::CAPTION_WIDTH);
    egui::Area::new(egui::Id::new("caption"))
        .fixed_pos(centre)
        .pivot(egui::Align2::CENTER_BOTTOM)
        .show(context, |ui| {
            look::of(ui).card(look::of(ui).field_hovered).show(ui, |ui| {
                ui.set_width(width);
                contents(ui, stage, run, asked);
            });
        });
}

fn contents(ui: &mut egui::Ui, stage: &Stage, run: u32, asked: &mut Vec<Command>) {
    let is_earlier = matches!(stage.exhibit().source(), Source::Run(of) if of != run);
    let prefix = if is_earlier { "Earlier run. " } else { "" };
    let text = format!("{prefix}{}", stage.exhibit().caption());
    ui.label(egui::RichText::new(text).size(look::TITLE_SIZE));

    let share = stage.time_s() / stage.duration_s();
    ui.add(egui::ProgressBar::new(share).desired_height(4.0).fill(look::of(ui).accent));

    let evaluation = stage.evaluation();
    ui.horizontal(|ui| {
        let hold = if stage.is_playing() { "Hold" } else { "Play" };
        if ui.button(hold).on_hover_text("Hold or play the stage (Space)").clicked() {
            asked.push(Command::TogglePlayback);
        }
        if ui.button("From the start").on_hover_text("Play from the start (R)").clicked() {
            asked.push(Command::Restart);
        }
        let state = match evaluation.disqualified {
            Some(reason) => format!("disqualified: {}", reason.words()),
            None => format!(
                "{:.1} of {:.1} s   y = {:.2} m",
                stage.time_s(),
                stage.duration_s(),
                evaluation.centre_y_m
            ),
        };
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.label(egui::RichText::new(state).color(look::of(ui).text_weak).monospace());
        });
    });
    let exhibit = stage.exhibit();
    if exhibit.could_be_as_found() {
        let hint = "Play it again as it was found";
        if ui.button("As recorded").on_hover_text(hint).clicked() {
            asked.push(Command::ShowAsFound);
        }
    } else if exhibit.recording().is_some() {
        let hint =
            "Simulate it with this engine, which computes other bits than the one that found it";
        if ui.button("Simulate here").on_hover_text(hint).clicked() {
            asked.push(Command::Simulate);
        }
    }
}
