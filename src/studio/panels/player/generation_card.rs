//! Card of the generation on the stage: its number, its best result, and buttons for what to show next.

use bevy_egui::egui;

use crate::studio::commands::{Command, PlayerCommand, StageCommand};
use crate::studio::panels::champions::{FOLLOW, FOLLOW_COMMAND};
use crate::studio::stage::StageMode;
use crate::studio::stage::lane::Lane;
use crate::studio::state::following::Following;
use crate::studio::ui::buttons::{CommandButton, command_box};
use crate::studio::ui::text_rows::explain;
use crate::studio::ui::theme;

/// Draws the card of the generation on the stage. `best` is the lane of the best snake, `shown` the number of lanes.
pub(crate) fn generation_card(
    ui: &mut egui::Ui,
    mode: &StageMode,
    following: &Following,
    best: &Lane,
    shown: usize,
    commands: &mut Vec<Command>,
) {
    let StageMode::Generation { number, size } = mode else { return };
    let (caption, detail) = captions(*number, *size, shown);
    ui.label(egui::RichText::new(caption).size(theme::CAPTION_SIZE).strong());
    ui.label(detail);
    ui.label(format!("Best: {}", best.staged().champion().reached()));
    if let Some((part, parts)) = following.story_part() {
        explain(ui, &format!("Story, part {part} of {parts}"));
    }
    ui.horizontal(|ui| {
        command_box(ui, following.follows_evolution(), FOLLOW, FOLLOW_COMMAND, commands);
        let hint = "Show only the best snake of this generation";
        let single = Command::Stage(StageCommand::Single);
        CommandButton::new("Only the best", hint, single).show(ui, commands);
    });
}

/// Returns the caption of a generation, and a text about the number of its snakes on the stage.
fn captions(number: u32, size: u32, shown: usize) -> (String, String) {
    let detail = if shown == size as usize {
        format!("All {size} snakes at once")
    } else {
        format!("{shown} of {size} snakes, from the best to the worst")
    };
    (format!("Generation {number}"), detail)
}

/// Draws the card that is shown until the first generation is evaluated: `done` of `all` snakes are.
pub(crate) fn waiting_card(
    ui: &mut egui::Ui,
    (done, all): (u32, u32),
    commands: &mut Vec<Command>,
) {
    ui.label(egui::RichText::new("Generation 1").size(theme::CAPTION_SIZE).strong());
    ui.label(format!("{done} of {all} random snakes tried. They appear here in a moment."));
    let hint = "Watch a snake of an earlier run that climbs the stairs";
    let play = Command::Player(PlayerCommand::Toggle);
    CommandButton::new("Play the built-in champion instead", hint, play).show(ui, commands);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_card_says_how_many_snakes_are_shown() {
        let (caption, all) = captions(3, 30, 30);
        assert_eq!((caption.as_str(), all.as_str()), ("Generation 3", "All 30 snakes at once"));
        assert_eq!(captions(1, 100, 40).1, "40 of 100 snakes, from the best to the worst");
    }
}
