//! Cards over the stage: the camera bar, the leaderboard, readings of a limb, and a reminder of the lesson.

use bevy_egui::egui;

use super::camera_bar::view_bar;
use super::card_places::messages_room;
use super::generation_card::{generation_card, waiting_card};
use super::leaderboard::leaderboard;
use super::limb_card::{CardSize, limb_card, limb_title};
use super::overlay_legend::overlay_legend;
use super::stage_card::{CardStates, CardTable, StageCard};
use crate::studio::commands::panel::PanelKind;
use crate::studio::commands::{Command, LessonCommand, StageCommand, WindowCommand};
use crate::studio::panels::champions::FOLLOW_COMMAND;
use crate::studio::panels::help::menu::IsOn;
use crate::studio::panels::on_stage::OnStage;
use crate::studio::scene::way_back::{Excursion, WayBack};
use crate::studio::stage::StageMode;
use crate::studio::stage::lane::Lane;
use crate::studio::ui::buttons::CommandButton;
use crate::studio::ui::theme;

/// Draws the reminder that a lesson is in progress, for the time when the lessons panel is hidden.
fn lesson_card(ui: &mut egui::Ui, lesson: usize) {
    ui.horizontal(|ui| {
        ui.label(format!("Lesson {} is in progress.", lesson + 1));
        let show = Command::Window(WindowCommand::OpenPanel(PanelKind::Lessons));
        CommandButton::new("Show lesson", "", show).show(ui);
        let leave = Command::Lesson(LessonCommand::Leave);
        CommandButton::new("Back to my own run", "", leave).show(ui);
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

/// State, apart from the stage, on which the cards depend.
pub(crate) struct CardSituation<'a> {
    /// Function that returns whether the setting that a command toggles is on.
    pub is_on: IsOn<'a>,
    /// Number of evaluated snakes and number of all snakes of the current generation.
    pub progress: (u32, u32),
    /// Lesson in progress, if the lessons panel is hidden; the first is 0.
    pub lesson: Option<usize>,
    /// Area of the card of the tour, in points, if it is open.
    pub tour: Option<egui::Rect>,
    /// Size of the messages in the last frame, in points.
    pub messages: egui::Vec2,
}

/// Draws the cards over the edges of the stage. Returns the cards that must not cover the snakes, which are the
/// leaderboard or the card of a generation, and the card of a limb; and the area for messages, which are drawn in its
/// lower right corner. All are in points.
pub(crate) fn around_stage(
    context: &egui::Context,
    stage: egui::Rect,
    on_stage: &OnStage,
    (lanes, focused): (&[&Lane], &Lane),
    (situation, states): (&CardSituation<'_>, &mut CardStates),
) -> (Vec<egui::Rect>, egui::Rect) {
    let room = stage.shrink(theme::GAP * 1.5);
    let palette = theme::of_context(context);
    let is_narrow = room.width() < theme::NARROW_STAGE;
    let bar = egui::Area::new(egui::Id::new("view")).fixed_pos(room.min).constrain_to(room);
    let bar = bar.show(context, |ui| {
        let small = egui::Margin::symmetric(theme::GAP as i8 / 2, theme::GAP as i8 / 2);
        palette.card(palette.field_hovered).inner_margin(small).show(ui, |ui| {
            let mode = on_stage.rig.camera_mode;
            view_bar(ui, mode, is_narrow, situation.is_on, &on_stage.quality, states);
        });
    });
    let bar = bar.response.rect;
    let view = on_stage.view(context);
    let limb_of = |lane: &Lane, limb: usize| view.as_ref()?.limb(lane, limb);
    let seen = lanes.iter().filter(|lane| !lane.is_ghost);
    let limbs = seen.flat_map(|lane| (0..lane.body.limbs()).map(|limb| limb_of(lane, limb)));
    let gate = view.as_ref().and_then(|view| view.gate(focused));
    let kept_free = limbs.flatten().chain(gate).collect();
    let taken = std::iter::once(bar).chain(situation.tour).collect();
    let mut table = CardTable { context, room, taken, kept_free, states };
    // With one lane, the stairs rise from the lower left to the upper right, so the sky at the upper left is free.
    let card = |name, title: &str, occasion: String, corner| {
        let title = title.to_owned();
        StageCard { name, title, occasion, corner }
    };
    let small = |name| card(name, "", String::new(), egui::Align2::LEFT_TOP);
    if let Some(lesson) = situation.lesson {
        table.place(&small("lesson"), None, |ui| lesson_card(ui, lesson));
    }
    let names = || lanes.iter().map(|lane| lane.staged.name()).collect::<Vec<_>>().join(", ");
    // With several lanes, the default camera shows few snakes in the lower left corner.
    let board = |title| card("board", title, names(), egui::Align2::LEFT_BOTTOM);
    let generation = |number: u32| {
        card("generation", &format!("Generation {number}"), String::new(), egui::Align2::LEFT_TOP)
    };
    let (mode, following) = (&*on_stage.mode, &*on_stage.following);
    let ranking = |ui: &mut egui::Ui| {
        let (focus, time_s) = (focused.number, on_stage.playback.time_s());
        let leaves = (is_narrow, on_stage.way_back.can_leave());
        leaderboard(ui, lanes, mode, focus, time_s, leaves);
    };
    let drawn = match mode {
        StageMode::Race => table.card(&board("Race"), None, ranking),
        StageMode::WhatIf { .. } => table.card(&board("What if"), None, ranking),
        StageMode::Generation { number, .. } => table.card(&generation(*number), None, |ui| {
            if let Some(best) = lanes.first() {
                let following = (following, (situation.is_on)(&FOLLOW_COMMAND));
                generation_card(ui, mode, following, best, lanes.len());
            }
        }),
        StageMode::Solo if following.holds => {
            let waiting = |ui: &mut egui::Ui| waiting_card(ui, situation.progress);
            table.card(&generation(1), None, waiting)
        }
        StageMode::Solo => back_in_words(&on_stage.way_back).map(|back| {
            table.place(&small("back"), None, |ui| {
                CommandButton::new(back, "", Command::Stage(StageCommand::Leave)).show(ui);
            })
        }),
    };
    if !on_stage.overlays.is_empty() {
        let is_pulled = lanes.iter().any(|lane| lane.replay.is_disturbed());
        let shown = on_stage.overlays.iter().map(|overlay| overlay.name()).collect();
        let legend = card("legend", "Legend", shown, egui::Align2::LEFT_TOP);
        table.card(&legend, None, |ui| overlay_legend(ui, &on_stage.overlays, is_pulled));
    }
    let limb_place = on_stage.selection.limb.and_then(|limb| {
        let size = CardSize::for_stage(egui::vec2(stage.width(), room.bottom() - bar.bottom()));
        let corner = egui::Align2::RIGHT_BOTTOM;
        let title = limb_title(focused, limb);
        let card = card("limb", &title, title.clone(), corner);
        let selected = limb_of(focused, limb);
        let is_playing = on_stage.playback.is_playing;
        table.card(&card, selected, |ui| limb_card(ui, focused, limb, is_playing, size))
    });
    let others: Vec<egui::Rect> =
        table.taken[1..].iter().copied().filter(|area| Some(*area) != limb_place).collect();
    let messages_room = messages_room(stage, bar, limb_place, &others, situation.messages);
    let board = drawn.map(|area| area.expand(theme::GAP));
    (board.into_iter().chain(limb_place).collect(), messages_room)
}
