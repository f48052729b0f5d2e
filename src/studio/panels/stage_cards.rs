//! The cards over the stage: the camera's buttons, a race's board, a limb's numbers, that a lesson is going on.

use bevy::prelude::Msaa;
use bevy_egui::egui;

use super::board::board;
use super::limb_card::limb_card;
use super::view_bar::view_bar;
use super::{OnStage, PanelKind};
use crate::studio::command::Command;
use crate::studio::lane::Lane;
use crate::studio::look;
use crate::studio::stage::Programme;

/// That a lesson is going on, for who has its panel out of sight.
pub(super) fn lesson_card(
    context: &egui::Context,
    at: egui::Pos2,
    lesson: usize,
    asked: &mut Vec<Command>,
) {
    let palette = look::of_context(context);
    egui::Area::new(egui::Id::new("lesson")).fixed_pos(at).show(context, |ui| {
        palette.card(palette.accent).show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.label(format!("Lesson {} is going on.", lesson + 1));
                if ui.button("To the lesson").clicked() {
                    asked.push(Command::Open(PanelKind::Lessons));
                }
                if ui.button("Back to my own run").clicked() {
                    asked.push(Command::LeaveLesson);
                }
            });
        });
    });
}

/// What the cards over the stage's edges leave.
pub(super) struct AroundStage {
    /// Where there is room for another, under the one at the top left.
    pub below_bar: egui::Pos2,
    /// How wide the one at the lower left is, with the space beside it, in points; 0 without one.
    pub board_width: f32,
}

/// Draws the cards over the stage's edges.
pub(super) fn around_stage(
    context: &egui::Context,
    stage: egui::Rect,
    on_stage: &OnStage,
    lanes: &[&Lane],
    focused: &Lane,
    theme: look::Theme,
    asked: &mut Vec<Command>,
) -> AroundStage {
    let stage = stage.shrink(look::GAP * 1.5);
    let palette = look::of_context(context);
    let card = |name: &str, pivot: egui::Align2, at: egui::Pos2| {
        egui::Area::new(egui::Id::new(name)).pivot(pivot).fixed_pos(at).constrain_to(stage)
    };
    let frame = palette.card(palette.field_hovered);
    let bar = card("view", egui::Align2::LEFT_TOP, stage.left_top()).show(context, |ui| {
        let small = egui::Margin::symmetric(look::GAP as i8 / 2, look::GAP as i8 / 2);
        frame.inner_margin(small).show(ui, |ui| {
            let is_smooth = on_stage.smoothing.iter().any(|msaa| *msaa != Msaa::Off);
            view_bar(ui, on_stage.rig.shot(), &on_stage.overlays, is_smooth, theme, asked);
        });
    });
    let is_narrow = stage.width() < look::NARROW_STAGE;
    let mut board_width = 0.0;
    if *on_stage.programme != Programme::Solo {
        // Of several lanes, seen as they are at first, none is there.
        let place = card("board", egui::Align2::LEFT_BOTTOM, stage.left_bottom());
        let shown = place.show(context, |ui| {
            frame.show(ui, |ui| {
                let time_s = on_stage.playback.time_s();
                let (programme, focus) = (&*on_stage.programme, focused.number());
                board(ui, lanes, programme, focus, time_s, is_narrow, asked);
            });
        });
        board_width = shown.response.rect.width() + look::GAP * 1.5;
    }
    if let Some(limb) = on_stage.hands.limb {
        // The pointer goes through it, to the snake that may be behind.
        let place = card("limb", egui::Align2::RIGHT_BOTTOM, stage.right_bottom());
        place.interactable(false).show(context, |ui| {
            frame.show(ui, |ui| limb_card(ui, focused, limb));
        });
    }
    let below_bar = bar.response.rect.left_bottom() + egui::vec2(0.0, look::GAP);
    AroundStage { below_bar, board_width }
}
