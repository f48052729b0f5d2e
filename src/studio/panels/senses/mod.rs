//! The senses of the snake on the stage, and how its controller turns them into motion.
//!
//! The panel shows one lane at the displayed time. Its switches take senses away by the same command as the settings of
//! the Change panel, so a copy without these senses is added beside the snake.

mod decision_view;
pub(super) mod exam;
mod limb_view;
mod network_graph;
mod readouts;
mod reflex_view;
mod rule_row;
mod value_bar;
mod wave_view;

use std::borrow::Cow;

use bevy_egui::egui;

use super::on_stage::OnStage;
use crate::studio::commands::library::LibraryCommand;
use crate::studio::commands::{Command, PlanCommand, StageCommand};
use crate::studio::stage::StageMode;
use crate::studio::stage::lane::Lane;
use crate::studio::state::stairs_exams::StairsExams;
use crate::studio::ui::buttons::{CommandButton, command_box};
use crate::studio::ui::lane_dot::lane_dot;
use crate::studio::ui::text_rows::{explain, title};
use crate::studio::ui::theme;
use snakes_core::control::{ActiveSenses, Activity, SenseOrgan};
use snakes_core::genome::ControllerKind;
use snakes_core::save::library::SavePlace;

use exam::exam;
use readouts::readouts;

/// The Senses panel, with its options.
#[derive(Debug, Default)]
pub(super) struct SensesPanel {
    /// Whether the list of rules also contains those that do not match.
    shows_all_rules: bool,
}

/// The snake that the Senses panel shows.
pub(super) struct SensesView<'l> {
    lane: &'l Lane,
    /// Index of the selected limb, or 0, the head, if none is selected.
    limb: usize,
    /// Whether a limb is selected.
    is_selected: bool,
    /// Lanes among which the user can choose.
    racers: Vec<&'l Lane>,
    /// Senses that the switches show. In a what-if they are those of the current copy.
    switched: ActiveSenses,
}

impl<'l> SensesView<'l> {
    /// Returns the view of the focused lane, or `None` if there is none.
    pub fn of(lanes: &[&'l Lane], focused: Option<&'l Lane>, on_stage: &OnStage) -> Option<Self> {
        let lane = focused?;
        let switched = match *on_stage.mode {
            StageMode::WhatIf { current, .. } => lanes.get(current).copied().unwrap_or(lane),
            _ => lane,
        };
        let selection = &on_stage.selection;
        let limb = selection.limb.filter(|_| selection.lane == lane.number);
        Some(Self {
            lane,
            limb: limb.unwrap_or(0).min(lane.body.limbs().saturating_sub(1)),
            is_selected: limb.is_some(),
            racers: lanes.iter().copied().filter(|lane| !lane.is_ghost).collect(),
            switched: switched.trial().agent.senses,
        })
    }

    /// Returns the index of the joint in front of the limb; for the head, the first joint.
    fn joint(&self) -> usize {
        self.limb.saturating_sub(1)
    }

    fn kind(&self) -> ControllerKind {
        self.lane.staged.champion().genome.controller.kind()
    }
}

impl SensesPanel {
    /// Draws the panel and sends the user's commands.
    pub fn ui(&mut self, ui: &mut egui::Ui, view: Option<&SensesView>, exams: &StairsExams) {
        title(ui, "Senses");
        let Some(view) = view else {
            explain(ui, "What the snake on the stage senses will appear here.");
            return feeler_button(ui);
        };
        lane_choice(ui, view);
        if !view.lane.staged.champion().genome.senses_surroundings() {
            explain(ui, unsensing(view.kind()));
            let sensing = ControllerKind::ALL.iter().filter(|kind| kind.senses_surroundings());
            let titles = sensing.map(|kind| kind.title()).collect::<Vec<_>>().join(", ");
            let sensing = "Controllers that sense touch, balance and the stairs ahead";
            explain(ui, &format!("{sensing}: {titles}. Choose one in the Watch panel."));
            feeler_button(ui);
            return exam(ui, view.lane, exams);
        }
        let Some(rollout) = view.lane.replay.rollout() else {
            explain(ui, "A recording contains poses, but no senses.");
            return exam(ui, view.lane, exams);
        };
        switches(ui, view);
        exam(ui, view.lane, exams);
        let mut rollout = Cow::Borrowed(rollout);
        if rollout.perception().limbs.is_empty() {
            // Nothing is sensed before the first step. Without the step of a copy, the panel would be empty for a moment
            // and scroll to its top whenever a replay starts again.
            rollout.to_mut().advance();
        }
        readouts(ui, view, &rollout);
        self.controller(ui, view, rollout.activity(view.joint()).as_ref());
    }

    /// Draws the controller's activity.
    fn controller(&mut self, ui: &mut egui::Ui, view: &SensesView, activity: Option<&Activity>) {
        let kind = view.kind();
        title(ui, &format!("Controller: {}", kind.title()));
        explain(ui, &kind.words());
        match activity {
            Some(Activity::Network(network)) => network_graph::network_graph(ui, network),
            Some(Activity::Decision(decision)) => {
                decision_view::decision_view(ui, decision, &mut self.shows_all_rules);
            }
            Some(Activity::Reflex(reflex)) => reflex_view::reflex_view(ui, reflex),
            Some(Activity::Waves(choice)) => wave_view::wave_view(ui, choice),
            Some(Activity::Limbs(limbs)) => limb_view::limb_view(ui, limbs, view.limb),
            None => {}
        }
    }
}

/// Describes in a sentence a controller that does not sense its surroundings.
fn unsensing(kind: ControllerKind) -> &'static str {
    match kind {
        ControllerKind::Signal | ControllerKind::Wave => {
            "This snake feels nothing: its torques are in its genes, whatever happens to it."
        }
        _ => {
            "This snake feels only its joints: they follow the angles in its genes, whatever happens \
             around it."
        }
    }
}

/// Name of a built-in champion that senses its surroundings.
const FEELER: &str = "feeler";

/// Draws the button that shows a snake with senses.
fn feeler_button(ui: &mut egui::Ui) {
    let show = Command::Library(LibraryCommand::Replay(SavePlace::Shipped(FEELER)));
    let hint = "Replay a built-in champion whose blocks react to what they touch";
    CommandButton::new("Show me a snake that feels", hint, show).show(ui);
}

/// Draws the buttons that select the lane.
fn lane_choice(ui: &mut egui::Ui, view: &SensesView) {
    if view.racers.len() < 2 {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        for lane in &view.racers {
            lane_dot(ui, lane.number, theme::LANE_DOT);
            let is_shown = lane.number == view.lane.number;
            let name = egui::Button::selectable(is_shown, lane.staged.label()).truncate();
            let hint = "Show the senses of this snake";
            if ui.add(name).on_hover_text(hint).clicked() && !is_shown {
                Command::Stage(StageCommand::Focus(lane.number)).send(ui);
            }
        }
    });
}

/// Draws the switches that take senses away from a copy of the snake.
fn switches(ui: &mut egui::Ui, view: &SensesView) {
    let organs = [
        ("Sight", SenseOrgan::Sight, "the gap to the next riser, its height, the clearance"),
        ("Touch", SenseOrgan::Touch, "touch, load, and resistance ahead"),
        ("Balance", SenseOrgan::Balance, "pitch, roll, yaw, speed, distance aside"),
    ];
    ui.horizontal(|ui| {
        for (name, organ, senses) in organs {
            let works = view.switched.has(organ);
            let hint = format!(
                "Off: {senses} keep their last values in a copy of the snake, which walks beside it from this \
                 moment on. The next run gets the same setting; Ctrl Z undoes it"
            );
            let field = format!("trial.agent.senses.{}", name.to_lowercase());
            let command = Command::Plan(PlanCommand::set(&field, &(!works).to_string()));
            command_box(ui, works, (name, &hint), command);
        }
    });
    let effect = match view.switched == ActiveSenses::default() {
        true => "Switch one off: a copy without it walks beside this snake.",
        false => "Senses that are off keep their last values, marked as frozen.",
    };
    explain(ui, effect);
}

#[cfg(test)]
mod tests;
