//! Under the stage: what is on it, the player, the numbers of the moment, and the torques over time.

use bevy_egui::egui;

use super::icons::{Icon, icon_button};
use super::signals::Signals;
use crate::score::Fitness;
use crate::studio::command::Command;
use crate::studio::exhibit::Source;
use crate::studio::lane::Lane;
use crate::studio::look;
use crate::studio::playback::{Playback, SPEED_RANGE};

/// The panel, with what it has drawn.
#[derive(Default)]
pub(super) struct TimelinePanel {
    signals: Signals,
}

/// About the width of a letter, in points.
const LETTER_WIDTH: f32 = 7.4;

impl TimelinePanel {
    /// Draws the panel and adds what was asked for. `run` is the number of the current run, `end_s` where the last
    /// lane ends.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        lane: &Lane,
        playback: &Playback,
        end_s: f64,
        run: u32,
        asked: &mut Vec<Command>,
    ) {
        self.caption(ui, lane, run, asked);
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = look::GAP / 2.0;
            player(ui, playback, end_s, asked);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                numbers(ui, lane);
            });
        });
        let height = look::SIGNALS_HEIGHT;
        let moment = self.signals.ui(ui, lane, playback.time_s(), end_s, height);
        asked.extend(moment.map(Command::Seek));
    }

    /// What is on the stage.
    fn caption(&self, ui: &mut egui::Ui, lane: &Lane, run: u32, asked: &mut Vec<Command>) {
        let exhibit = lane.exhibit();
        ui.horizontal(|ui| {
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if exhibit.other_engine().is_some() && exhibit.could_be_as_found() {
                    if ui.button("As recorded").on_hover_text("Play what was recorded").clicked() {
                        asked.push(Command::ShowAsFound);
                    }
                } else if exhibit.recording().is_some() {
                    let hint = "Simulate it with this engine, which computes other bits than the one \
                                that found it";
                    if ui.button("Simulate here").on_hover_text(hint).clicked() {
                        asked.push(Command::Simulate);
                    }
                }
                if lane.is_disturbed() {
                    let hint = "A hand has pulled it. Go back in time, and it is itself again";
                    let text = egui::RichText::new("disturbed by hand").color(look::of(ui).problem);
                    ui.label(text).on_hover_text(hint);
                }
                ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                    let is_earlier = matches!(exhibit.source(), Source::Run(of) if of != run);
                    let prefix = if is_earlier { "Earlier run. " } else { "" };
                    let text = format!("{prefix}{}", exhibit.caption());
                    let text = egui::RichText::new(text).size(look::TITLE_SIZE).strong();
                    ui.add(egui::Label::new(text).truncate());
                });
            });
        });
    }
}

/// The player's buttons, and the time.
fn player(ui: &mut egui::Ui, playback: &Playback, end_s: f64, asked: &mut Vec<Command>) {
    let (play, play_hint) = if playback.is_playing() {
        (Icon::Hold, "Hold (Space)")
    } else {
        (Icon::Play, "Play (Space)")
    };
    for (icon, is_on, hint, command) in [
        (Icon::ToStart, false, "Play from the start (R)", Command::Restart),
        (Icon::StepBack, false, "One physics step back (Left)", Command::Step { forward: false }),
        (play, false, play_hint, Command::TogglePlayback),
        (Icon::StepForward, false, "One physics step on (Right)", Command::Step { forward: true }),
        (Icon::Loop, playback.loops(), "Begin again after the end (O)", Command::ToggleLoop),
    ] {
        if icon_button(ui, icon, is_on, hint).clicked() {
            asked.push(command);
        }
    }
    ui.add_space(look::GAP / 2.0);
    let mut speed = playback.speed();
    let field = egui::DragValue::new(&mut speed)
        .range(SPEED_RANGE)
        .speed(0.02 * f64::from(playback.speed()))
        .max_decimals(2)
        .prefix("× ");
    let hint = "Simulated seconds in a second: drag, click to type, or press + and −";
    if ui.add(field).on_hover_text(hint).changed() {
        asked.push(Command::SetSpeed(speed));
    }
    ui.add_space(look::GAP / 2.0);
    let width = format!("{end_s:.2}").len();
    let time = format!("{:width$.2} of {end_s:.2} s", playback.time_s());
    ui.label(egui::RichText::new(time).monospace());
}

/// What there is to say of the moment.
fn numbers(ui: &mut egui::Ui, lane: &Lane) {
    let evaluation = lane.evaluation();
    let trial = lane.trial();
    let palette = look::of(ui);
    if let Some(reason) = evaluation.disqualified {
        let text = format!("disqualified: {}", reason.words());
        ui.label(egui::RichText::new(text).color(palette.problem));
        return;
    }
    let unit = trial.fitness.unit();
    // A recording knows only what it ended with.
    let is_on_record = lane.exhibit().recording().is_some() && !lane.is_over();
    if is_on_record {
        let place = format!("{:.2} m", evaluation.centre_y_m);
        ui.label(egui::RichText::new(place).monospace());
        ui.label(egui::RichText::new("place").color(palette.text_weak));
        return;
    }
    let behaviour = evaluation.behaviour;
    let energy_kj = evaluation.effort.map(|effort| effort.energy_j / 1000.0);
    let steps = behaviour.map(|seen| format!("{} of {}", seen.steps_climbed, trial.stairs.steps));
    let more = match trial.fitness {
        Fitness::Climb => {
            "; with the whole snake on the landing it has arrived, and it counts no more"
        }
        _ => "",
    };
    let cost = match trial.energy_cost_per_kj {
        0.0 => String::new(),
        cost => format!(", less {cost} per kJ that the joints spend"),
    };
    let fitness_hint = format!(
        "What it would be worth if the time ended now: {}{cost}{more}",
        trial.fitness.words()
    );
    // The most important first: in a narrow window only some have room.
    let all = [
        ("fitness", Some(format!("{:.2}{unit}", evaluation.fitness)), fitness_hint.as_str()),
        ("steps", steps, "Steps below the middle block"),
        ("speed", Some(format!("{:.2} m/s", lane.speed_m_s())), "Of the middle block"),
        (
            "energy",
            energy_kj.map(|energy_kj| format!("{energy_kj:.2} kJ")),
            "What the joints have spent so far",
        ),
    ];
    let room = ui.available_width();
    let mut used = 0.0;
    let with_room = all.into_iter().filter_map(|(name, value, hint)| Some((name, value?, hint)));
    let shown: Vec<(&str, String, &str)> = with_room
        .take_while(|(name, value, _)| {
            used += (name.len() + value.chars().count()) as f32 * LETTER_WIDTH + look::GAP * 2.5;
            used < room
        })
        .collect();
    // From right to left.
    for (name, value, hint) in shown.into_iter().rev() {
        ui.label(egui::RichText::new(value).monospace()).on_hover_text(hint);
        ui.label(egui::RichText::new(name).color(palette.text_weak)).on_hover_text(hint);
        ui.add_space(look::GAP / 2.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::shipped_champion;
    use crate::studio::exhibit::Exhibit;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    /// What the panel sends when a person does `act`, in a panel of this width.
    fn sent(width: f32, act: impl FnOnce(&mut Harness<'_, Vec<Command>>)) -> Vec<Command> {
        let loaded = shipped_champion().expect("well formed");
        let lane = Lane::new(Exhibit::saved(&loaded, 0, "climber"), 0);
        let (mut panel, playback) = (TimelinePanel::default(), Playback::default());
        let size = egui::vec2(width, 200.0);
        let mut harness = Harness::builder()
            .with_size(size)
            .build_ui_state(|ui, asked| panel.ui(ui, &lane, &playback, 15.0, 0, asked), Vec::new());
        act(&mut harness);
        harness.run();
        harness.state().clone()
    }

    #[test]
    fn each_button_of_the_player_sends_its_command() {
        for (label, command) in [
            ("From the start", Command::Restart),
            ("Step back", Command::Step { forward: false }),
            ("Hold", Command::TogglePlayback),
            ("Step forward", Command::Step { forward: true }),
            ("Loop", Command::ToggleLoop),
        ] {
            assert_eq!(sent(900.0, |harness| harness.get_by_label(label).click()), [command]);
        }
    }

    #[test]
    fn in_a_narrow_window_the_least_important_numbers_are_left_out() {
        let is_there = |width: f32, name: &str| {
            let mut seen = false;
            sent(width, |harness| seen = harness.query_by_label(name).is_some());
            seen
        };
        assert!(is_there(900.0, "fitness") && is_there(900.0, "energy"));
        assert!(is_there(540.0, "fitness") && !is_there(540.0, "energy"));
    }
}
