//! Timeline below the stage: caption, player controls, current readings, and torques over time.

use bevy_egui::egui;

use super::generation_card::WHY_HINT;
use super::torque_strip::{THIN, TorqueStrip};
use crate::studio::commands::{Command, PlayerCommand, StageCommand};
use crate::studio::panels::senses::exam::own_stairs_button;
use crate::studio::stage::end_s;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::playback::{Playback, SPEED_RANGE};
use crate::studio::stage::staged_champion::ChampionSource;
use crate::studio::ui::accessible::named;
use crate::studio::ui::buttons::{CommandButton, hint_of_command};
use crate::studio::ui::decimals::decimals;
use crate::studio::ui::icons::{Icon, icon_button};
use crate::studio::ui::text_rows::{at_right, explain, title_text, weak};
use crate::studio::ui::theme;
use snakes_core::schema::Choices;
use snakes_core::score::{EndingKind, Fitness, arrived_y_m};

/// Time span that the timeline shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TimelineSpan {
    /// End of the time span, in simulated seconds.
    pub end_s: f64,
    /// Whether the result and everything after the present time are hidden, because they answer the question of a lesson.
    pub hides_future: bool,
}

impl TimelineSpan {
    /// Returns the time span of all lanes. If the future is hidden, the span ends with the trial. An earlier end would
    /// reveal that all snakes are disqualified.
    pub fn of<'a>(lanes: impl Iterator<Item = &'a Lane>, hides_future: bool) -> Self {
        let end_s = match hides_future {
            true => lanes.map(|lane| f64::from(lane.trial().duration_s)).fold(0.0, f64::max),
            false => end_s(lanes),
        };
        Self { end_s, hides_future }
    }
}

/// The timeline panel, with its cached drawing.
#[derive(Default)]
pub(crate) struct TimelinePanel {
    torque_strip: TorqueStrip,
    /// Whether the strip has a row with the torques of each joint.
    pub shows_torques: bool,
    /// Selected limb, whose joints alone have a row; `None` for all joints.
    pub limb: Option<usize>,
    /// Whether a snake that lands has the button *Why does it climb?*; a generation has it on its card.
    pub offers_why: bool,
}

/// Width of the button that lists further readings, in points.
const MORE_WIDTH: f32 = 40.0;
/// Width from which the field of the speed has room for its name, in points.
const WIDTH_OF_WORDS: f32 = 320.0;
/// Minimum width of a truncated sentence, in points: enough for "disqualified".
const LEAST_SENTENCE: f32 = 100.0;
/// Width of a monospaced character, in points.
const DIGIT_WIDTH: f32 = 8.0;
/// Approximate width of a character, in points.
const CHARACTER_WIDTH: f32 = 7.4;

impl TimelinePanel {
    /// Draws the timeline and sends the user's commands. `run` is the number of the current run.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        lane: &Lane,
        playback: &Playback,
        span: TimelineSpan,
        run: u32,
    ) {
        caption(ui, lane, (span, playback, self.offers_why), run);
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = theme::GAP / 2.0;
            player(ui, playback, span.end_s);
            at_right(ui, |ui| readings(ui, lane));
        });
        let height = if self.shows_torques { theme::TORQUE_STRIP_HEIGHT } else { THIN };
        let moment = self.torque_strip.ui(ui, (lane, self.limb), playback.time_s(), span, height);
        Command::send_all(moment.map(|time_s| Command::Player(PlayerCommand::Seek(time_s))), ui);
    }
}

/// Draws the caption of the replay, with buttons for recordings.
fn caption(
    ui: &mut egui::Ui,
    lane: &Lane,
    (span, playback, offers_why): (TimelineSpan, &Playback, bool),
    run: u32,
) {
    let staged = &lane.staged;
    ui.horizontal(|ui| {
        at_right(ui, |ui| {
            if staged.other_engine().is_some() && staged.could_be_as_found() {
                let show = Command::Stage(StageCommand::ShowAsFound);
                CommandButton::new("As recorded", "Play the recording", show).show(ui);
            } else if staged.recording().is_some() {
                let hint = "Simulate it with this version of the engine. The motion may differ from \
                            the recording";
                let simulate = Command::Stage(StageCommand::Simulate);
                CommandButton::new("Simulate again", hint, simulate).show(ui);
            }
            own_stairs_button(ui, staged);
            if lane.replay.is_disturbed() {
                let hint = "You pulled this snake, so its result does not count. Go back in time to undo it";
                let text = egui::RichText::new("pulled with the mouse, not counted").color(theme::of(ui).problem);
                ui.label(text).on_hover_text(hint);
            } else if !span.hides_future {
                ending(ui, lane, (playback, offers_why));
            }
            ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                let is_earlier = matches!(staged.source(), ChampionSource::Run(of) if of != run);
                let prefix = if is_earlier { "Earlier run: " } else { "" };
                let text = match span.hides_future {
                    true => staged.label().to_owned(),
                    false => format!("{prefix}{}", staged.caption()),
                };
                ui.add(egui::Label::new(title_text(text)).truncate());
            });
        });
    });
}

/// Time before the moment that decided a trial from which the moment is played, in seconds.
const LEAD_S: f64 = 2.0;
/// Width from which the caption has room for the ending beside it, in points.
const WIDTH_OF_ENDING: f32 = 520.0;
/// Speed at which that moment is played, in simulated seconds per second.
const SLOW: f32 = 0.5;

/// Says how the trial of a lane ends, unless the snake lands in an honest way. Offers to play the moment that decides a failure, and to find
/// out what a climb needs. From right to left.
fn ending(ui: &mut egui::Ui, lane: &Lane, (playback, offers_why): (&Playback, bool)) {
    let Some(ending) = lane.history().and_then(|history| history.evaluation().ending) else {
        return;
    };
    let has_landed = ending.kind == EndingKind::Landed;
    if lane.trial().stairs.steps == 0 {
        return;
    }
    if has_landed {
        // Where blocks are in the genes, their torques are, too, and no setting can take them away.
        if offers_why && !lane.staged.champion().genome.body.has_own_blocks() {
            let why = Command::Stage(StageCommand::RaceKnockOuts);
            CommandButton::new("Why does it climb?", WHY_HINT, why).small().show(ui);
        }
        if ending.used().next().is_none() {
            return;
        }
    } else {
        let hint =
            "Say how it ended, and play the moment that decides the trial, at most at half speed";
        if ui.small_button("Why did it fail?").on_hover_text(hint).clicked() {
            let from_s = (f64::from(ending.at_s) - LEAD_S).max(0.0);
            let play = (!playback.is_playing).then_some(PlayerCommand::Toggle);
            let slow = PlayerCommand::SetSpeed(playback.speed().min(SLOW));
            let commands = [slow, PlayerCommand::Seek(from_s)].into_iter().chain(play);
            let words = format!("{}. {}", ending.words(), ending.kind.choice().sentence);
            let told = Command::Notify(format!("How it ended: {words}"));
            Command::send_all(commands.map(Command::Player).chain([told]), ui);
        }
    }
    let tricks = ending.used().map(|trick| trick.choice());
    let hint = tricks.fold(ending.kind.choice().sentence, |hint, trick| {
        format!("{hint}\nIt {}. {}", trick.title, trick.sentence)
    });
    let moment = match ending.kind {
        EndingKind::Landed | EndingKind::OutOfTime | EndingKind::Beside => String::new(),
        _ => format!(", {:.1} s", ending.at_s),
    };
    if ui.available_width() > WIDTH_OF_ENDING {
        ui.label(weak(ui, format!("End: {}{moment}", ending.words()))).on_hover_text(hint);
    }
}

/// Draws the playback buttons, the speed and the time.
fn player(ui: &mut egui::Ui, playback: &Playback, end_s: f64) {
    let play = match playback.is_playing {
        true => (Icon::Pause, "Pause", PlayerCommand::Toggle),
        false => (Icon::Play, "Play", PlayerCommand::Toggle),
    };
    for (icon, hint, command) in [
        (Icon::ToStart, "Play from the start", PlayerCommand::Restart),
        (Icon::StepBack, "Previous physics step", PlayerCommand::Step { forward: false }),
        play,
        (Icon::StepForward, "Next physics step", PlayerCommand::Step { forward: true }),
        (Icon::Loop, "Loop: start again at the end", PlayerCommand::ToggleLoop),
    ] {
        let (is_on, command) = (icon == Icon::Loop && playback.loops, Command::Player(command));
        let button = icon_button(ui, icon, is_on);
        if hint_of_command(button, hint, &command).clicked() {
            command.send(ui);
        }
    }
    ui.add_space(theme::GAP / 2.0);
    let mut speed = playback.speed();
    let prefix = if ui.available_width() < WIDTH_OF_WORDS { "× " } else { "Speed × " };
    let field = egui::DragValue::new(&mut speed)
        .range(SPEED_RANGE)
        .speed(0.02 * f64::from(playback.speed()))
        .max_decimals(2)
        .prefix(prefix);
    let hint = "Speed in simulated seconds per second: drag, click to type, or press + and −";
    if ui.add(field).on_hover_text(hint).changed() {
        Command::Player(PlayerCommand::SetSpeed(speed)).send(ui);
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

/// Draws the readings at the displayed time.
fn readings(ui: &mut egui::Ui, lane: &Lane) {
    let evaluation = lane.evaluation();
    let trial = lane.trial();
    if let Some(reason) = evaluation.disqualified {
        return disqualification(ui, &format!("disqualified: {}", reason.words()));
    }
    // A recording stores only the final evaluation.
    let is_on_record = lane.staged.recording().is_some() && !lane.replay.is_over();
    if is_on_record {
        ui.monospace(format!("{} m", decimals(evaluation.centre_y_m, 2)));
        return explain(ui, "position");
    }
    let energy = evaluation.effort.map(|effort| format!("{:.2} kJ", effort.energy_j / 1000.0));
    let steps = evaluation
        .behaviour
        .map(|seen| format!("{} of {}", seen.steps_climbed, trial.stairs.steps));
    let more = match trial.fitness {
        Fitness::Climb if trial.stairs.steps > 0 => format!(
            "; the first step is at {:.2} m, and at {:.2} m the whole snake is on the landing and nothing more counts",
            trial.stairs.riser_y_m(0),
            arrived_y_m(&trial.stairs, &lane.body)
        ),
        _ => String::new(),
    };
    let cost = match trial.energy_cost_per_kj {
        0.0 => String::new(),
        cost => format!(", minus {cost} per kJ that the joints use"),
    };
    let fitness_hint =
        format!("Fitness if the trial ended now: {}{cost}{more}", trial.fitness.words());
    let fitness = evaluation.fitness;
    let fitness_text = match trial.fitness {
        of @ Fitness::Share => of.text(fitness).trim_end_matches(" of the way").to_owned(),
        of => format!("{}{}", decimals(fitness, 2), of.unit()),
    };
    // The readings are ordered by importance, because a narrow window has room for only some of them.
    let all = [
        ("fitness", Some(fitness_text), fitness_hint.as_str()),
        ("steps", steps, "Steps that the middle block has climbed"),
        ("speed", Some(format!("{:.2} m/s", lane.speed_m_s())), "Speed of the middle block"),
        ("energy", energy, "Energy that the joints have used so far"),
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
    // The readings are added from right to left.
    for (index, (name, value, hint)) in shown.iter().enumerate().rev() {
        ui.label(egui::RichText::new(value).monospace()).on_hover_text(*hint);
        ui.label(weak(ui, *name)).on_hover_text(*hint);
        if index > 0 {
            ui.add(egui::Separator::default().spacing(theme::GAP * 1.5));
        }
    }
}

/// Draws the reason why the snake is disqualified. The text is truncated if there is no room for the whole sentence, or
/// replaced by a button if there is hardly any room.
fn disqualification(ui: &mut egui::Ui, sentence: &str) {
    if ui.available_width() < LEAST_SENTENCE {
        return more_readings(ui, &[(sentence, String::new(), "")]);
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
    named(button, egui::WidgetType::Button, "More readings").on_hover_ui(|ui| lines(ui));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::testing::{Sent, clicked, climber_lane, panel, shows};
    use crate::studio::stage::staged_champion::StagedChampion;
    use egui_kittest::kittest::Queryable;
    use snakes_core::save::shipped_champion;

    const SPAN: TimelineSpan = TimelineSpan { end_s: 15.0, hides_future: false };

    /// Creates the timeline of a lane at this width, in points.
    fn timeline(lane: &Lane, span: TimelineSpan, width: f32) -> Sent<'_> {
        timeline_in(lane, span, width, |_| ())
    }

    /// Creates the timeline of a lane at this width, in points, after `style` has changed its style.
    fn timeline_in(
        lane: &Lane,
        span: TimelineSpan,
        width: f32,
        style: fn(&egui::Context),
    ) -> Sent<'_> {
        let playback = Playback::default();
        let mut timeline = TimelinePanel { offers_why: true, ..TimelinePanel::default() };
        panel([width, 200.0], move |ui| {
            style(ui.ctx());
            timeline.ui(ui, lane, &playback, span, 0);
        })
    }

    /// Creates a lane with the climber of a lesson, in a world whose speed limit it breaks on its way.
    fn disqualified() -> Lane {
        let loaded = shipped_champion().expect("well formed");
        let lesson = StagedChampion::from_lesson(&loaded.champion).named("original".to_owned());
        let mut trial = lesson.trial().clone();
        trial.health.speed_m_s = 6.0;
        let mut lane = Lane::new(lesson.in_world(&trial, "a low limit".to_owned()), 0);
        lane.finish_lookahead();
        assert!(lane.end_s() < 14.0, "it is disqualified after {} s", lane.end_s());
        lane
    }

    #[test]
    fn each_button_of_the_player_sends_its_command() {
        let lane = climber_lane(0, "climber");
        for (label, command) in [
            ("Play from start", PlayerCommand::Restart),
            ("Previous step", PlayerCommand::Step { forward: false }),
            ("Pause playback", PlayerCommand::Toggle),
            ("Next step", PlayerCommand::Step { forward: true }),
            ("Loop", PlayerCommand::ToggleLoop),
        ] {
            let mut timeline = timeline(&lane, SPAN, 900.0);
            assert_eq!(clicked(&mut timeline, label), [Command::Player(command)]);
        }
    }

    #[test]
    fn before_a_lesson_was_watched_neither_caption_nor_time_reveals_its_result() {
        let lane = disqualified();
        for hides_future in [true, false] {
            let span = TimelineSpan::of(std::iter::once(&lane), hides_future);
            let timeline = timeline(&lane, span, 900.0);
            assert_eq!(!shows(&timeline, "26.00 m"), hides_future);
            assert_eq!(shows(&timeline, "of 15.00 s"), hides_future);
        }
    }

    #[test]
    fn the_reason_of_a_disqualification_never_covers_the_time() {
        let mut lane = disqualified();
        lane.show(lane.end_s() + 0.1, None, 3000).expect("shown");
        assert!(lane.evaluation().disqualified.is_some());
        for width in [368.0, 480.0, 608.0, 900.0] {
            let timeline = timeline_in(&lane, SPAN, width, theme::apply);
            // Below a stage of 400 points, the time is shown without the end.
            let time = timeline.query_by_label_contains(" of 15.00 s");
            assert_eq!(time.is_some(), width > 368.0, "{width}");
            let time = time.unwrap_or_else(|| timeline.get_by_label(" 0.00 s")).rect();
            // The caption above says it as well.
            let mut reasons = timeline.query_all_by_label_contains("disqualified: ");
            let reason = reasons.find(|of| of.rect().bottom() > time.top());
            let shown = reason.or_else(|| timeline.query_by_label("More readings"));
            let shown = shown.expect("a reason or its button").rect();
            assert!(shown.left() >= time.right(), "{width}: {shown} covers {time}");
            assert!(shown.right() <= width, "{width}: {shown}");
        }
    }

    #[test]
    fn a_trial_without_a_landing_says_how_it_ends_and_plays_the_moment_that_decides_it() {
        let lane = disqualified();
        let mut of_lane = timeline(&lane, SPAN, 900.0);
        assert!(shows(&of_lane, "End: disqualified: "));
        let from_s = (lane.end_s() - LEAD_S).max(0.0) as f32;
        let commands = clicked(&mut of_lane, "Why did it fail?");
        let [Command::Player(speed), Command::Player(PlayerCommand::Seek(to_s)), told] =
            &commands[..]
        else {
            panic!("{commands:?}")
        };
        assert!(
            matches!(told, Command::Notify(words) if words.contains("It broke a limit of the trial"))
        );
        assert_eq!(*speed, PlayerCommand::SetSpeed(SLOW));
        assert!((*to_s as f32 - from_s).abs() < 0.1, "{to_s} s, not {from_s} s");
        let hidden = TimelineSpan { hides_future: true, ..SPAN };
        assert!(timeline(&lane, hidden, 900.0).query_by_label("Why did it fail?").is_none());
        let mut landed = climber_lane(0, "climber");
        landed.finish_lookahead();
        let mut of_landed = timeline(&landed, SPAN, 900.0);
        assert!(of_landed.query_by_label("Why did it fail?").is_none());
        let why = Command::Stage(StageCommand::RaceKnockOuts);
        assert_eq!(clicked(&mut of_landed, "Why does it climb?"), [why]);
    }

    #[test]
    fn the_fitness_says_where_the_stairs_begin_and_where_it_stops_counting() {
        let lane = climber_lane(0, "climber");
        let mut timeline = timeline(&lane, SPAN, 900.0);
        timeline.get_by_label("fitness").hover();
        timeline.run_steps(60);
        assert!(shows(&timeline, "the first step is at 3.00 m, and at 26.00 m the whole snake is"));
    }

    #[test]
    fn a_narrow_panel_lists_the_least_important_readings_behind_a_button() {
        let lane = climber_lane(0, "climber");
        let is_shown =
            |width: f32, name: &str| timeline(&lane, SPAN, width).query_by_label(name).is_some();
        assert!(is_shown(900.0, "fitness") && is_shown(900.0, "energy"));
        assert!(!is_shown(900.0, "More readings"));
        assert!(is_shown(580.0, "fitness") && !is_shown(580.0, "energy"));
        for width in [400.0, 580.0] {
            let mut timeline = timeline(&lane, SPAN, width);
            clicked(&mut timeline, "More readings");
            assert!(shows(&timeline, "energy 0"), "{width}");
        }
    }
}
