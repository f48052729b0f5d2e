//! Card of the generation on the stage: its number, its best result, and buttons for what to show next.

use bevy_egui::egui;

use crate::studio::commands::{Command, PlanCommand, PlayerCommand, StageCommand};
use crate::studio::panels::champions::follow_box;
use crate::studio::stage::StageMode;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::staged_champion::ChampionSource;
use crate::studio::state::following::Following;
use crate::studio::ui::buttons::CommandButton;
use crate::studio::ui::text_rows::{explain, title_text};

/// Draws the card of the generation on the stage. `best` is the lane of the best snake, `shown` the number of lanes.
/// `follows` is the state of the check box for following evolution, if it is offered.
pub(crate) fn generation_card(
    ui: &mut egui::Ui,
    mode: &StageMode,
    (following, follows): (&Following, Option<bool>),
    best: &Lane,
    shown: usize,
) {
    let StageMode::Generation { size, .. } = mode else { return };
    ui.label(how_many(*size, shown));
    let champion = best.staged.champion();
    ui.label(format!("Best: {}", champion.reached()));
    if let Some((part, parts)) = following.story_part() {
        explain(ui, &format!("Story, part {part} of {parts}"));
    }
    ui.horizontal(|ui| {
        follow_box(ui, follows);
        let hint = "Show only the best snake of this generation";
        CommandButton::new("Only the best", hint, Command::Stage(StageCommand::Single)).show(ui);
        if champion.evaluation.behaviour.is_some_and(|of| of.steps_climbed > 0) {
            let why = Command::Stage(StageCommand::RaceKnockOuts);
            CommandButton::new("Why does it climb?", WHY_HINT, why).show(ui);
        }
    });
    if champion.evaluation.is_on_landing(&champion.trial.stairs) {
        after_landing(ui, best.staged.source());
    }
}

/// Explains the race that tells why a snake climbs.
pub(super) const WHY_HINT: &str = "Race this snake against copies with one joint limp, or without bending or twisting: the less far \
                                   a copy gets, the more the climb needs what that copy lacks";

/// Draws large buttons for what to try after a landing, until they are closed. They come back with the next run.
fn after_landing(ui: &mut egui::Ui, run: ChampionSource) {
    let id = egui::Id::new("after the landing");
    if ui.data(|data| data.get_temp(id)) == Some(run) {
        return;
    }
    ui.separator();
    ui.horizontal(|ui| {
        ui.label(title_text("It reaches the top. Try next:"));
        if ui.small_button("Close").clicked() {
            ui.data_mut(|data| data.insert_temp(id, run));
        }
    });
    let friction = "trial.surface.friction";
    for (label, hint, command) in [
        (
            "On ice!",
            "A copy of the snake starts beside it on smooth ice",
            Command::Plan(PlanCommand::set(friction, ICE)),
        ),
        (
            "Five surfaces side by side",
            "The snake on five surfaces, from slippery to rough",
            Command::Stage(StageCommand::Sweep(friction.to_owned())),
        ),
        (
            "Race the generations",
            "The best snakes of the run, from the first generation to the latest",
            Command::Stage(StageCommand::RaceGenerations),
        ),
    ] {
        let button = egui::Button::new(egui::RichText::new(label).strong());
        let button = button.min_size(LARGE_BUTTON);
        CommandButton::of(button, hint, command).show(ui);
    }
}

/// Friction of smooth ice.
const ICE: &str = "0.05";
/// Size of the buttons after a landing, in points.
const LARGE_BUTTON: egui::Vec2 = egui::vec2(220.0, 34.0);

/// Describes how many snakes of a generation are on the stage.
pub(super) fn how_many(size: u32, shown: usize) -> String {
    if shown == size as usize {
        format!("All {size} snakes at once")
    } else {
        format!("{shown} of {size} snakes, from the best to the worst")
    }
}

/// Draws the card that is shown until the first generation is evaluated: `done` of `all` snakes are.
pub(crate) fn waiting_card(ui: &mut egui::Ui, (done, all): (u32, u32)) {
    ui.label(format!("{done} of {all} random snakes tried. They appear here in a moment."));
    let hint = "Watch a snake of an earlier run that climbs the stairs";
    let play = Command::Player(PlayerCommand::Toggle);
    CommandButton::new("Play the built-in champion instead", hint, play).show(ui);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::testing::{clicked, panel, shows};

    #[test]
    fn after_a_landing_three_buttons_lead_on_until_they_are_closed() {
        let run = ChampionSource::Run(0);
        let mut panel = panel([300.0, 300.0], move |ui| after_landing(ui, run));
        let race = Command::Stage(StageCommand::RaceGenerations);
        assert_eq!(clicked(&mut panel, "Race the generations"), [race]);
        panel.run();
        assert!(shows(&panel, "On ice!"), "the user may come back from the race");
        clicked(&mut panel, "Close");
        panel.run();
        assert!(!shows(&panel, "On ice!"));
    }

    #[test]
    fn the_card_says_how_many_snakes_are_shown() {
        assert_eq!(how_many(30, 30), "All 30 snakes at once");
        assert_eq!(how_many(100, 40), "40 of 100 snakes, from the best to the worst");
    }
}
