//! Cards over the stage: the camera bar, the leaderboard, readings of a limb, and a reminder of the lesson.

use bevy_egui::egui;

use super::camera_bar::view_bar;
use super::card_places::{AroundLimb, messages_room};
use super::generation_card::{generation_card, waiting_card};
use super::leaderboard::leaderboard;
use super::limb_card::{CardSize, limb_card};
use super::overlay_legend::overlay_legend;
use crate::studio::commands::panel::PanelKind;
use crate::studio::commands::{Command, LessonCommand, StageCommand, WindowCommand};
use crate::studio::panels::on_stage::OnStage;
use crate::studio::scene::way_back::{Excursion, WayBack};
use crate::studio::stage::StageMode;
use crate::studio::stage::lane::Lane;
use crate::studio::ui::buttons::CommandButton;
use crate::studio::ui::theme;

/// Draws the reminder that a lesson is in progress, for the time when the lessons panel is hidden.
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
                let show = Command::Window(WindowCommand::OpenPanel(PanelKind::Lessons));
                CommandButton::new("Show lesson", "", show).show(ui, commands);
                let leave = Command::Lesson(LessonCommand::Leave);
                CommandButton::new("Back to my own run", "", leave).show(ui, commands);
            });
        });
    });
}

/// Returns the label of the button that brings several snakes back after one of them was shown alone.
fn back_in_words(way_back: &WayBack) -> Option<String> {
    match way_back.innermost()? {
        (Excursion::Snake | Excursion::Race, StageMode::Generation { number, .. }) => {
            Some(format!("Back to generation {number}"))
        }
        (Excursion::Snake, StageMode::Race) => Some("Back to the race".to_owned()),
        (Excursion::Snake, StageMode::WhatIf { .. }) => Some("Back to the what-if".to_owned()),
        (Excursion::Snake | Excursion::Race, StageMode::Solo) => Some("Back".to_owned()),
        _ => None,
    }
}

/// Areas that the cards over the stage leave free or cover.
pub(crate) struct AroundStage {
    /// Position for a further card below the camera bar, in points.
    pub below_bar: egui::Pos2,
    /// Cards that must not cover the snakes, in points: the leaderboard or the card of a generation, and the card of a
    /// limb.
    pub cards: Vec<egui::Rect>,
    /// Area for messages, which are drawn in its lower right corner, in points.
    pub messages_room: egui::Rect,
}

/// State, apart from the stage, on which the cards depend.
pub(crate) struct CardSituation {
    pub theme: theme::Theme,
    /// Number of evaluated snakes and number of all snakes of the current generation.
    pub progress: (u32, u32),
    /// Whether a card of the tour covers the upper left corner of the stage.
    pub is_touring: bool,
    /// Size of the messages in the last frame, in points.
    pub messages: egui::Vec2,
    /// Whether the player shows the torques of each joint over time.
    pub shows_torques: bool,
}

/// Draws the cards over the edges of the stage.
pub(crate) fn around_stage(
    context: &egui::Context,
    stage: egui::Rect,
    on_stage: &OnStage,
    lanes: &[&Lane],
    focused: &Lane,
    situation: &CardSituation,
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
            view_bar(
                ui,
                on_stage.rig.camera_mode(),
                &on_stage.overlays,
                &on_stage.quality,
                situation.shows_torques,
                situation.theme,
                commands,
            );
        });
    });
    let below = |rect: egui::Rect| rect.left_bottom() + egui::vec2(0.0, theme::GAP);
    let mut below_bar = below(bar.response.rect);
    let is_narrow = stage.width() < theme::NARROW_STAGE;
    let mut board = None;
    let can_leave = on_stage.way_back.can_leave();
    // With several lanes, the default camera shows few snakes in the lower left corner.
    let low = (egui::Align2::LEFT_BOTTOM, stage.left_bottom());
    // With one lane, the stairs rise from the lower left to the upper right, so the sky at the upper left is free.
    let high = (egui::Align2::LEFT_TOP, below_bar);
    let (pivot, at) = if situation.is_touring { low } else { high };
    let mut corner = None;
    if let (StageMode::Generation { .. }, Some(best)) = (&*on_stage.mode, lanes.first()) {
        let (mode, following) = (&*on_stage.mode, &on_stage.following);
        let shown = card("generation", pivot, at).show(context, |ui| {
            frame.show(ui, |ui| generation_card(ui, mode, following, best, lanes.len(), commands));
        });
        corner = Some(shown.response.rect);
    } else if *on_stage.mode != StageMode::Solo {
        let (mode, focus) = (&*on_stage.mode, focused.number);
        let time_s = on_stage.playback.time_s();
        let shown = card("board", low.0, low.1).show(context, |ui| {
            frame.show(ui, |ui| {
                let leaves = (is_narrow, can_leave);
                leaderboard(ui, lanes, mode, focus, time_s, leaves, commands);
            });
        });
        board = Some(shown.response.rect.expand(theme::GAP));
    } else if on_stage.following.holds {
        let shown = card("waiting", pivot, at).show(context, |ui| {
            frame.show(ui, |ui| waiting_card(ui, situation.progress, commands));
        });
        corner = Some(shown.response.rect);
    } else if let Some(back) = back_in_words(&on_stage.way_back) {
        let shown = card("back", pivot, at).show(context, |ui| {
            let leave = Command::Stage(StageCommand::Leave);
            frame.show(ui, |ui| CommandButton::new(back, "", leave).show(ui, commands));
        });
        corner = Some(shown.response.rect);
    }
    if let Some(corner) = corner {
        board = Some(corner.expand(theme::GAP));
        if !situation.is_touring {
            below_bar = below(corner);
        }
    }
    let bar = bar.response.rect;
    let mut others: Vec<egui::Rect> = std::iter::once(bar).chain(board).collect();
    if on_stage.overlays.shows_any() {
        // The legend ignores the pointer, because the snake may be behind the legend.
        let place = card("legend", egui::Align2::LEFT_TOP, below_bar).interactable(false);
        let is_pulled = lanes.iter().any(|lane| lane.replay.is_disturbed());
        let shown = place.show(context, |ui| {
            frame.show(ui, |ui| overlay_legend(ui, &on_stage.overlays, is_pulled));
        });
        below_bar = below(shown.response.rect);
        others.push(shown.response.rect);
    }
    let limb_place = on_stage.selection.limb.map(|limb| {
        let room = egui::vec2(whole.width(), stage.bottom() - bar.bottom());
        let size = CardSize::for_stage(room);
        let at = limb_place(context, (stage, &others), on_stage, (lanes, focused), (limb, size));
        // The card ignores the pointer, because a snake may be behind the card.
        let place = card(LIMB_CARD, egui::Align2::LEFT_TOP, at.min).interactable(false);
        let is_playing = on_stage.playback.is_playing;
        let shown = place.show(context, |ui| {
            frame.show(ui, |ui| limb_card(ui, focused, limb, is_playing, size));
        });
        shown.response.rect
    });
    if let Some(limb_place) = limb_place.filter(|place| place.contains(below_bar)) {
        below_bar = below(limb_place);
    }
    let messages_room = messages_room(whole, bar, limb_place, &others[1..], situation.messages);
    AroundStage { below_bar, cards: board.into_iter().chain(limb_place).collect(), messages_room }
}

/// Name of the card of a limb, from which egui's ID is derived.
const LIMB_CARD: &str = "limb";

/// Returns the place of the card of a limb in the focused lane, beside the `others`.
fn limb_place(
    context: &egui::Context,
    (room, others): (egui::Rect, &[egui::Rect]),
    on_stage: &OnStage,
    (lanes, focused): (&[&Lane], &Lane),
    (limb, size): (usize, CardSize),
) -> egui::Rect {
    let drawn = context.memory(|memory| memory.area_rect(egui::Id::new(LIMB_CARD)));
    // Before the first frame, the height of the card is unknown.
    let least = egui::vec2(size.width(), 0.0);
    let drawn_size = drawn.map_or(least, |rect| rect.size());
    let of_lane = |lane: &Lane| on_stage.limbs_in_window(context, lane);
    let selected = of_lane(focused).get(limb).copied().flatten();
    let lanes = lanes.iter().filter(|lane| !lane.is_ghost);
    let all: Vec<egui::Rect> = lanes.flat_map(|lane| of_lane(lane)).flatten().collect();
    let around = AroundLimb { room, taken: others, selected, all: &all };
    around.place(drawn_size, drawn)
}
