//! The current situation, which decides which command an action sends.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use crate::studio::commands::actions::Situation;
use crate::studio::scene::way_back::WayBack;
use crate::studio::stage::StageMode;
use crate::studio::state::current_run::{CurrentRun, RunStatus};
use crate::studio::state::shares::Shares;
use crate::studio::state::undo::{UndoDirection, UndoHistory};
use crate::studio::workspace::Workspace;

/// Resources from which the current situation is computed.
#[derive(SystemParam)]
pub(crate) struct CurrentSituation<'w> {
    mode: Res<'w, StageMode>,
    run: Res<'w, CurrentRun>,
    workspace: Res<'w, Workspace>,
    history: Res<'w, UndoHistory>,
    shares: Res<'w, Shares>,
    way_back: Res<'w, WayBack>,
}

impl CurrentSituation<'_> {
    /// Returns the current situation.
    pub fn situation(&self) -> Situation {
        let (stage, files) = ((&*self.mode, &*self.way_back), (&*self.history, &*self.shares));
        Situation::of(&self.run, stage, &self.workspace, files)
    }
}

impl Situation {
    /// Computes the situation from the run, the stage, the window, the undo history and the file that is being written.
    pub fn of(
        run: &CurrentRun,
        (mode, way_back): (&StageMode, &WayBack),
        workspace: &Workspace,
        (history, shares): (&UndoHistory, &Shares),
    ) -> Self {
        Self {
            is_running: run.status() == RunStatus::Running,
            is_what_if: matches!(mode, StageMode::WhatIf { .. }),
            can_try_another: mode.can_try_another(),
            is_finished: run.status() == RunStatus::Finished,
            can_leave: way_back.can_leave(),
            is_covered: workspace.modal().is_some() || workspace.is_bare || workspace.is_presenting,
            is_presenting: workspace.is_presenting && workspace.modal().is_none(),
            is_sharing: shares.busy().is_some(),
            can_undo: history.next(UndoDirection::Back).is_some(),
            can_redo: history.next(UndoDirection::Forth).is_some(),
            digit: None,
        }
    }
}
