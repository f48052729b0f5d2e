//! Below the stage: caption, player controls, current readings and torques over time.

use bevy_egui::egui;

use super::torque_strip::TorqueStrip;
use crate::studio::commands::{Command, PlayerCommand, StageCommand};
use crate::studio::panels::own_stairs_button::own_stairs_button;
use crate::studio::stage::end_s;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::playback::{Playback, SPEED_RANGE};
use crate::studio::stage::staged_champion::ChampionSource;
use crate::studio::ui::decimals::decimals;
use crate::studio::ui::icons::{Icon, icon_button};
use crate::studio::ui::theme;
use snakes_core::score::Fitness;

/// What the time line shows of the time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TimelineSpan {
    /// Its end, in simulated seconds.
    pub end_s: f64,
    /// Whether nothing after the present may be seen, nor the result: it answers the question of a lesson.
    pub hides_future: bool,
}

impl TimelineSpan {
    /// The time of all lanes. With a hidden future the end is that of the trial, because an earlier end would tell that
    /// all snakes are disqualified.
    pub fn of<'a>(lanes: impl Iterator<Item = &'a Lane>, hides_future: bool) -> Self {
        let end_s = match hides_future {
            true => lanes.map(|lane| f64::from(lane.trial().duration_s)).fold(0.0, f64::max),
            false => end_s(lanes),
        };
        Self { end_s, hides_future }
    }
}

/// The panel with its cached drawing.
#[derive(Default)]
pub(crate) struct TimelinePanel {
    torque_strip: TorqueStrip,
}

/// Width of the button that lists more readings, in points.
const MORE_WIDTH: f32 = 40.0;
/// Minimum width of a sentence that is cut, in points: "disqualified" fits.
const LEAST_SENTENCE: f32 = 100.0;
/// Width of a monospaced character, in points.
const DIGIT_WIDTH: f32 = 8.0;
/// Approximate width of a character, in points.
const CHARACTER_WIDTH: f32 = 7.4;

impl TimelinePanel {
    /// Draws the panel and collects the user's commands. `run` is the number of the current run.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        lane: &Lane,
        playback: &Playback,
        span: TimelineSpan,
        run: u32,
        commands: &mut Vec<Command>,
    ) {
        self.caption(ui, lane, span, run, commands);
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = theme::GAP / 2.0;
            player(ui, playback, span.end_s, commands);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                readings(ui, lane);
            });
        });
        let height = theme::TORQUE_STRIP_HEIGHT;
        let moment = self.torque_strip.ui(ui, lane, playback.time_s(), span, height);
        commands.extend(moment.map(|time_s| Command::Player(PlayerCommand::Seek(time_s))));
    }

    /// Caption of the replay, with buttons for recordings.
    fn caption(
        &self,
        ui: &mut egui::Ui,
        lane: &Lane,
        span: TimelineSpan,
        run: u32,
        commands: &mut Vec<Command>,
    ) {
        let staged = lane.staged();
        ui.horizontal(|ui| {
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if staged.other_engine().is_some() && staged.could_be_as_found() {
                    if ui.button("As recorded").on_hover_text("Play the recording").clicked() {
                        commands.push(Command::Stage(StageCommand::ShowAsFound));
                    }
                } else if staged.recording().is_some() {
                    let hint = "Simulate it with this version of the engine. The motion may differ from \
                                the recording";
                    if ui.button("Simulate again").on_hover_text(hint).clicked() {
                        commands.push(Command::Stage(StageCommand::Simulate));
                    }
                }
                own_stairs_button(ui, staged, commands);
                if lane.is_disturbed() {
                    let hint = "You pulled this snake, so its result does not count. Go back in time to undo it";
                    let text = egui::RichText::new("pulled with the mouse, not counted").color(theme::of(ui).problem);
                    ui.label(text).on_hover_text(hint);
                }
                ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                    let is_earlier = matches!(staged.source(), ChampionSource::Run(of) if of != run);
                    let prefix = if is_earlier { "Earlier run: " } else { "" };
                    let text = match span.hides_future {
                        true => staged.label().to_owned(),
                        false => format!("{prefix}{}", staged.caption()),
                    };
                    let text = egui::RichText::new(text).size(theme::TITLE_SIZE).strong();
                    ui.add(egui::Label::new(text).truncate());
                });
            });
        });
    }
}

/// Draws the playback buttons, the speed and the time.
fn player(ui: &mut egui::Ui, playback: &Playback, end_s: f64, commands: &mut Vec<Command>) {
    let (play, play_hint) = if playback.is_playing() {
        (Icon::Pause, "Pause (Space)")
    } else {
        (Icon::Play, "Play (Space)")
    };
    for (icon, is_on, hint, command) in [
        (Icon::ToStart, false, "Play from the start (R)", Command::Player(PlayerCommand::Restart)),
        (
            Icon::StepBack,
            false,
            "Previous physics step (Left)",
            Command::Player(PlayerCommand::Step { forward: false }),
        ),
        (play, false, play_hint, Command::Player(PlayerCommand::Toggle)),
        (
            Icon::StepForward,
            false,
            "Next physics step (Right)",
            Command::Player(PlayerCommand::Step { forward: true }),
        ),
        (
            Icon::Loop,
            playback.loops(),
            "Loop: start again at the end (O)",
            Command::Player(PlayerCommand::ToggleLoop),
        ),
    ] {
        if icon_button(ui, icon, is_on, hint).clicked() {
            commands.push(command);
        }
    }
    ui.add_space(theme::GAP / 2.0);
    let mut speed = playback.speed();
    let field = egui::DragValue::new(&mut speed)
        .range(SPEED_RANGE)
        .speed(0.02 * f64::from(playback.speed()))
        .max_decimals(2)
        .prefix("× ");
    let hint = "Speed in simulated seconds per second: drag, click to type, or press + and −";
    if ui.add(field).on_hover_text(hint).changed() {
        commands.push(Command::Player(PlayerCommand::SetSpeed(speed)));
    }
    ui.add_space(theme::GAP / 2.0);
    let width = format!("{end_s:.2}").len();
    let mut time = format!("{:width$.2} of {end_s:.2} s", playback.time_s());
    let end = format!("The end is at {end_s:.2} s");
    if ui.available_width() < time.len() as f32 * DIGIT_WIDTH + MORE_WIDTH {
        time = format!("{:width$.2} s", playback.time_s());
    }
    ui.label(egui::RichText::new(time).monospace()).on_hover_text(end);
}

/// Draws the readings at the current time.
fn readings(ui: &mut egui::Ui, lane: &Lane) {
    let evaluation = lane.evaluation();
    let trial = lane.trial();
    let palette = theme::of(ui);
    if let Some(reason) = evaluation.disqualified {
        disqualification(ui, &format!("disqualified: {}", reason.words()));
        return;
    }
    let unit = trial.fitness.unit();
    // A recording stores only the final evaluation.
    let is_on_record = lane.staged().recording().is_some() && !lane.is_over();
    if is_on_record {
        let place = format!("{} m", decimals(evaluation.centre_y_m, 2));
        ui.label(egui::RichText::new(place).monospace());
        ui.label(egui::RichText::new("position").color(palette.text_weak));
        return;
    }
    let behaviour = evaluation.behaviour;
    let energy_kj = evaluation.effort.map(|effort| effort.energy_j / 1000.0);
    let steps = behaviour.map(|seen| format!("{} of {}", seen.steps_climbed, trial.stairs.steps));
    let more = match trial.fitness {
        Fitness::Climb => "; the distance stops counting once the whole snake is on the landing",
        _ => "",
    };
    let cost = match trial.energy_cost_per_kj {
        0.0 => String::new(),
        cost => format!(", minus {cost} per kJ that the joints use"),
    };
    let fitness_hint =
        format!("Fitness if the trial ended now: {}{cost}{more}", trial.fitness.words());
    // Ordered by importance, because a narrow window has room for only some of them.
    let all = [
        (
            "fitness",
            Some(format!("{}{unit}", decimals(evaluation.fitness, 2))),
            fitness_hint.as_str(),
        ),
        ("steps", steps, "Steps that the middle block has climbed"),
        ("speed", Some(format!("{:.2} m/s", lane.speed_m_s())), "Speed of the middle block"),
        (
            "energy",
            energy_kj.map(|energy_kj| format!("{energy_kj:.2} kJ")),
            "Energy that the joints have used so far",
        ),
    ];
    let known: Vec<(&str, String, &str)> =
        all.into_iter().filter_map(|(name, value, hint)| Some((name, value?, hint))).collect();
    let width = |(name, value, _): &(&str, String, &str)| {
        (name.len() + value.chars().count()) as f32 * CHARACTER_WIDTH + theme::GAP * 2.5
    };
    let room = ui.available_width();
    let mut shown = known.as_slice();
    if known.iter().map(width).sum::<f32>() > room {
        let mut used = MORE_WIDTH;
        let fits = |reading: &&(&str, String, &str)| {
            used += width(reading);
            used <= room
        };
        let (first, others) = known.split_at(known.iter().take_while(fits).count());
        shown = first;
        more_readings(ui, others);
    }
    // The layout runs from right to left.
    for (name, value, hint) in shown.iter().rev() {
        ui.label(egui::RichText::new(value).monospace()).on_hover_text(*hint);
        ui.label(egui::RichText::new(*name).color(palette.text_weak)).on_hover_text(*hint);
        ui.add_space(theme::GAP / 2.0);
    }
}

/// Draws why the snake is out, cut with "…" where there is no room for the whole sentence, or behind a button where there
/// is hardly any.
fn disqualification(ui: &mut egui::Ui, sentence: &str) {
    if ui.available_width() < LEAST_SENTENCE {
        more_readings(ui, &[(sentence, String::new(), "")]);
        return;
    }
    let text = egui::RichText::new(sentence).color(theme::of(ui).problem);
    ui.add(egui::Label::new(text).truncate()).on_hover_text(sentence);
}

/// Draws a button that lists the readings for which the panel has no room.
fn more_readings(ui: &mut egui::Ui, readings: &[(&str, String, &str)]) {
    let lines = |ui: &mut egui::Ui| {
        for (name, value, hint) in readings {
            let reading = ui.label(format!("{name} {value}").trim_end());
            if !hint.is_empty() {
                reading.on_hover_text(*hint);
            }
        }
    };
    let button = ui.menu_button("…", lines).response;
    let is_on = ui.is_enabled();
    let said = "More readings";
    button.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, is_on, said));
    button.on_hover_ui(|ui| lines(ui));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::stage::staged_champion::StagedChampion;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;
    use snakes_core::save::shipped_champion;

    const SPAN: TimelineSpan = TimelineSpan { end_s: 15.0, hides_future: false };

    /// Commands sent after `act` in a panel of this width.
    fn sent(width: f32, act: impl FnOnce(&mut Harness<'_, Vec<Command>>)) -> Vec<Command> {
        let loaded = shipped_champion().expect("well formed");
        let lane = Lane::new(StagedChampion::from_file(&loaded, 0, "climber"), 0);
        let (mut panel, playback) = (TimelinePanel::default(), Playback::default());
        let size = egui::vec2(width, 200.0);
        let mut harness = Harness::builder().with_size(size).build_ui_state(
            |ui, commands| panel.ui(ui, &lane, &playback, SPAN, 0, commands),
            Vec::new(),
        );
        act(&mut harness);
        harness.run();
        harness.state().clone()
    }

    #[test]
    fn each_button_of_the_player_sends_its_command() {
        for (label, command) in [
            ("Play from start", Command::Player(PlayerCommand::Restart)),
            ("Previous step", Command::Player(PlayerCommand::Step { forward: false })),
            ("Pause playback", Command::Player(PlayerCommand::Toggle)),
            ("Next step", Command::Player(PlayerCommand::Step { forward: true })),
            ("Loop", Command::Player(PlayerCommand::ToggleLoop)),
        ] {
            assert_eq!(sent(900.0, |harness| harness.get_by_label(label).click()), [command]);
        }
    }

    #[test]
    fn before_a_lesson_was_watched_neither_caption_nor_time_reveals_its_result() {
        let loaded = shipped_champion().expect("well formed");
        let lesson = StagedChampion::from_lesson(&loaded.champion).named("original".to_owned());
        let mut trial = lesson.trial().clone();
        // A speed limit that the climber breaks on its way.
        trial.health.speed_m_s = 6.0;
        let mut lane = Lane::new(lesson.in_world(&trial, "a low limit".to_owned()), 0);
        lane.finish_lookahead();
        assert!(lane.end_s() < 14.0, "it is disqualified after {} s", lane.end_s());
        for hides_future in [true, false] {
            let span = TimelineSpan::of(std::iter::once(&lane), hides_future);
            let (mut panel, playback) = (TimelinePanel::default(), Playback::default());
            let size = egui::vec2(900.0, 200.0);
            let mut harness = Harness::builder().with_size(size).build_ui_state(
                |ui, commands| panel.ui(ui, &lane, &playback, span, 0, commands),
                Vec::new(),
            );
            harness.run();
            assert_eq!(harness.query_by_label_contains("26.00 m").is_none(), hides_future);
            assert_eq!(harness.query_by_label_contains("of 15.00 s").is_some(), hides_future);
        }
    }

    #[test]
    fn the_reason_of_a_disqualification_never_covers_the_time() {
        let loaded = shipped_champion().expect("well formed");
        let lesson = StagedChampion::from_lesson(&loaded.champion).named("original".to_owned());
        let mut trial = lesson.trial().clone();
        trial.health.speed_m_s = 6.0;
        let mut lane = Lane::new(lesson.in_world(&trial, "a low limit".to_owned()), 0);
        lane.finish_lookahead();
        lane.show(lane.end_s() + 0.1, None, 3000).expect("shown");
        assert!(lane.evaluation().disqualified.is_some());
        for width in [368.0, 480.0, 608.0, 900.0] {
            let (mut panel, playback) = (TimelinePanel::default(), Playback::default());
            let size = egui::vec2(width, 200.0);
            let mut harness = Harness::builder().with_size(size).build_ui_state(
                |ui, commands| {
                    theme::apply(ui.ctx());
                    panel.ui(ui, &lane, &playback, SPAN, 0, commands);
                },
                Vec::new(),
            );
            harness.run();
            // Below a stage of 400 points there is only room for the time itself.
            let time = harness.query_by_label_contains(" of 15.00 s");
            assert_eq!(time.is_some(), width > 368.0, "{width}");
            let time = time.unwrap_or_else(|| harness.get_by_label(" 0.00 s")).rect();
            let reason = harness.query_by_label_contains("disqualified: ");
            let shown = reason.or_else(|| harness.query_by_label("More readings"));
            let shown = shown.expect("a reason or its button").rect();
            assert!(shown.left() >= time.right(), "{width}: {shown} covers {time}");
            assert!(shown.right() <= width, "{width}: {shown}");
        }
    }

    #[test]
    fn a_narrow_panel_lists_the_least_important_readings_behind_a_button() {
        let is_shown = |width: f32, name: &str| {
            let mut seen = false;
            sent(width, |harness| seen = harness.query_by_label(name).is_some());
            seen
        };
        assert!(is_shown(900.0, "fitness") && is_shown(900.0, "energy"));
        assert!(!is_shown(900.0, "More readings"));
        assert!(is_shown(540.0, "fitness") && !is_shown(540.0, "energy"));
        for width in [400.0, 540.0] {
            sent(width, |harness| {
                harness.get_by_label("More readings").click();
                harness.run();
                assert!(
                    harness.query_all_by_label_contains("energy 0").next().is_some(),
                    "{width}"
                );
            });
        }
    }
}
