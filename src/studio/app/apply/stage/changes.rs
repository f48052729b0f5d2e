//! Changes of the next run's plan, and their effect on the stage.
//!
//! A change of the world is tried from a certain time on. The first change uses the time of the clock. Later changes
//! use the same time until the user goes to another one, so that their effects can be compared.

use super::StageParams;
use crate::studio::commands::PlanCommand;
use crate::studio::stage::opening::OpeningChampions;
use crate::studio::stage::{Show, StageMode};
use crate::studio::state::current_run::CurrentRun;
use crate::studio::state::library::Library;
use crate::studio::state::plan_commands::apply_to_plan;
use crate::studio::state::undo::{PlanStep, UndoDirection, UndoHistory, followed, stepped};
use crate::studio::state::what_if::ChangedStage;
use crate::studio::ui::notifications::Notices;
use snakes_core::score::Rollout;
use snakes_lab::run::caught;

impl StageParams<'_, '_> {
    /// Executes a command to the plan of the next run, and shows its effect on the stage.
    pub fn apply_to_plan(
        &mut self,
        command: &PlanCommand,
        run: &mut CurrentRun,
        saves: (&Library, &OpeningChampions),
        history: &UndoHistory,
        notices: &mut Notices,
    ) -> Result<(), String> {
        let shown = self.to_change();
        let is_tried = matches!(
            command,
            PlanCommand::SetField { .. } | PlanCommand::SetFields(_) | PlanCommand::SetPreset(_)
        );
        let (time_s, moment) = if is_tried { self.moment(history) } else { (0.0, None) };
        let stage = ChangedStage { show: &shown, moment: moment.as_ref() };
        let show = apply_to_plan(command, run, saves, stage, notices)?;
        match command {
            _ if is_tried => self.present_change(show, time_s),
            // The lanes that are kept continue.
            PlanCommand::DropChange => {
                self.following.stop();
                *self.pending = show;
            }
            _ => self.present(show),
        }
        Ok(())
    }

    /// Undoes or redoes a change of the plan, and updates the stage.
    pub fn step(
        &mut self,
        run: &mut CurrentRun,
        step: &PlanStep,
        way: UndoDirection,
        history: &UndoHistory,
    ) -> Result<(), String> {
        let PlanStep { before, after, .. } = step;
        let (from, to) = if way == UndoDirection::Back { (after, before) } else { (before, after) };
        let now = run.plan_next.clone();
        let next = stepped(&now, from, to);
        run.replace_next(next, !step.is_of_another_run())?;
        let (time_s, moment) = self.moment(history);
        let shown = self.shown();
        let stage = ChangedStage { show: &shown, moment: moment.as_ref() };
        let show = followed(stage, &now, &run.plan_next)?;
        self.present_change(show, time_s);
        Ok(())
    }

    /// Returns the time from which a change is tried now, in simulated seconds, and the rollout of the original at that
    /// time; `None` at the start, from which a change is also tried after the end of the trial and on the landing.
    fn moment(&self, history: &UndoHistory) -> (f64, Option<Rollout>) {
        let at_start = (0.0, None);
        let original = if *self.mode == StageMode::Race { self.selection.lane } else { 0 };
        let Some(lane) = self.all_lanes().find(|lane| lane.number == original) else {
            return at_start;
        };
        // A drag of a slider across the original value ends the what-if and begins it again.
        let goes_on = matches!(*self.mode, StageMode::WhatIf { .. }) || !history.is_settled;
        let tried_s = self.playback.tried_from_s.filter(|_| goes_on);
        let time_s = tried_s.unwrap_or(self.playback.time_s());
        let (step, _) = lane.moment(time_s);
        let is_over = f64::from(step) * lane.step_s >= lane.end_s();
        if step == 0 || is_over {
            return at_start;
        }
        // A genome whose simulation panics is tried from the start; the stage then reports the panic.
        let Ok(rollout) = caught(|| lane.rollout_at(step)) else { return at_start };
        if rollout.is_on_landing() {
            // The snake has climbed the stairs, so a change would have no effect that can be seen.
            return at_start;
        }
        (f64::from(step) * lane.step_s, Some(rollout))
    }

    /// Shows the effect of a change from the time of the change on, in simulated seconds.
    fn present_change(&mut self, show: Option<Show>, time_s: f64) {
        let Some(show) = show else { return };
        let current = match show.mode {
            StageMode::WhatIf { current, .. } => show.champions.get(current),
            // Only the original remains on the stage.
            _ if matches!(*self.mode, StageMode::WhatIf { .. }) => show.champions.first(),
            // A copy that was kept gets another world.
            _ => return self.present(Some(show)),
        };
        self.following.stop();
        let is_original = current.is_none_or(|staged| Some(staged) == show.champions.first());
        let is_from_moment =
            is_original || current.is_some_and(|staged| staged.changes_at_step().is_some());
        let start_s = if is_from_moment { time_s } else { 0.0 };
        self.playback.play_change(start_s, time_s);
        *self.pending = Some(show);
    }
}
