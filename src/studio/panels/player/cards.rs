//! Cards over the stage: camera bar, leaderboard, limb readings and lesson reminder.

use bevy::prelude::Msaa;
use bevy_egui::egui;

use super::camera_bar::view_bar;
use super::generation_card::{generation_card, waiting_card};
use super::leaderboard::leaderboard;
use super::limb_card::limb_card;
use super::overlay_legend::overlay_legend;
use crate::studio::commands::panel::PanelKind;
use crate::studio::commands::{Command, LessonCommand, WindowCommand};
use crate::studio::panels::on_stage::OnStage;
use crate::studio::stage::StageMode;
use crate::studio::stage::lane::Lane;
use crate::studio::ui::theme;

/// Draws the reminder that a lesson is in progress, for when the lessons panel is hidden.
pub(crate) fn lesson_card(
    context: &egui::Context,
    at: egui::Pos2,
    lesson: usize,
    commands: &mut Vec<Command>,
) {
    let palette = theme::of_context(context);
    egui::Area::new(egui::Id::new("lesson")).fixed_pos(at).show(context, |ui| {
        palette.card(palette.accent).show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.label(format!("Lesson {} is in progress.", lesson + 1));
                if ui.button("Show lesson").clicked() {
                    commands.push(Command::Window(WindowCommand::OpenPanel(PanelKind::Lessons)));
                }
                if ui.button("Back to my own run").clicked() {
                    commands.push(Command::Lesson(LessonCommand::Leave));
                }
            });
        });
    });
}

/// Space left beside the cards.
pub(crate) struct AroundStage {
    /// Position for another card below the camera bar.
    pub below_bar: egui::Pos2,
    /// The leaderboard or the card of a generation, in points. The camera keeps the snakes out of it.
    pub board: Option<egui::Rect>,
    /// Height at which messages above the lower right corner end.
    pub messages_end: f32,
}

/// Draws the cards over the edges of the stage. `progress` has the evaluated and all snakes of the current generation;
/// `is_touring` says that a card of the tour covers the upper left corner.
pub(crate) fn around_stage(
    context: &egui::Context,
    stage: egui::Rect,
    on_stage: &OnStage,
    lanes: &[&Lane],
    focused: &Lane,
    (theme, progress, is_touring): (theme::Theme, (u32, u32), bool),
    commands: &mut Vec<Command>,
) -> AroundStage {
    let whole = stage;
    let stage = stage.shrink(theme::GAP * 1.5);
    let palette = theme::of_context(context);
    let card = |name: &str, pivot: egui::Align2, at: egui::Pos2| {
        egui::Area::new(egui::Id::new(name)).pivot(pivot).fixed_pos(at).constrain_to(stage)
    };
    let frame = palette.card(palette.field_hovered);
    let bar = card("view", egui::Align2::LEFT_TOP, stage.left_top()).show(context, |ui| {
        let small = egui::Margin::symmetric(theme::GAP as i8 / 2, theme::GAP as i8 / 2);
        frame.inner_margin(small).show(ui, |ui| {
            let is_smooth = on_stage.smoothing.iter().any(|msaa| *msaa != Msaa::Off);
            view_bar(
                ui,
                on_stage.rig.camera_mode(),
                &on_stage.overlays,
                is_smooth,
                theme,
                commands,
            );
        });
    });
    let below = |rect: egui::Rect| rect.left_bottom() + egui::vec2(0.0, theme::GAP);
    let mut below_bar = below(bar.response.rect);
    let is_narrow = stage.width() < theme::NARROW_STAGE;
    let mut board = None;
    // With several lanes, the default camera shows few snakes in the lower left corner, and leaves it free.
    let low = (egui::Align2::LEFT_BOTTOM, stage.left_bottom());
    // One lane rises from the lower left to the upper right, so the sky at the upper left is free.
    let high = (egui::Align2::LEFT_TOP, below_bar);
    let (pivot, at) = if is_touring { low } else { high };
    let mut corner = None;
    if let (StageMode::Generation { .. }, Some(best)) = (&*on_stage.mode, lanes.first()) {
        let (mode, following) = (&*on_stage.mode, &on_stage.following);
        let shown = card("generation", pivot, at).show(context, |ui| {
            frame.show(ui, |ui| generation_card(ui, mode, following, best, lanes.len(), commands));
        });
        corner = Some(shown.response.rect);
    } else if *on_stage.mode != StageMode::Solo {
        let (mode, focus) = (&*on_stage.mode, focused.number());
        let time_s = on_stage.playback.time_s();
        let shown = card("board", low.0, low.1).show(context, |ui| {
            frame.show(ui, |ui| {
                leaderboard(ui, lanes, mode, focus, time_s, is_narrow, commands);
            });
        });
        board = Some(shown.response.rect.expand(theme::GAP));
    } else if on_stage.following.awaits_first() {
        let shown = card("waiting", pivot, at).show(context, |ui| {
            frame.show(ui, |ui| waiting_card(ui, progress, commands));
        });
        corner = Some(shown.response.rect);
    }
    if let Some(corner) = corner {
        board = Some(corner.expand(theme::GAP));
        if !is_touring {
            below_bar = below(corner);
        }
    }
    let mut messages_end = whole.bottom();
    if let Some(limb) = on_stage.selection.limb {
        // The card ignores the pointer, because the snake may be behind it.
        let place = card("limb", egui::Align2::RIGHT_BOTTOM, stage.right_bottom());
        let shown = place.interactable(false).show(context, |ui| {
            frame.show(ui, |ui| limb_card(ui, focused, limb, on_stage.playback.is_playing()));
        });
        messages_end = shown.response.rect.top();
    }
    if on_stage.overlays.shows_any() {
        // The legend ignores the pointer, because the snake may be behind it.
        let place = card("legend", egui::Align2::LEFT_TOP, below_bar).interactable(false);
        let is_pulled = lanes.iter().any(|lane| lane.is_disturbed());
        let shown = place.show(context, |ui| {
            frame.show(ui, |ui| overlay_legend(ui, &on_stage.overlays, is_pulled));
        });
        below_bar = below(shown.response.rect);
    }
    AroundStage { below_bar, board, messages_end }
}
