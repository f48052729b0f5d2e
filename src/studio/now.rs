//! What an action's meaning depends on, as things are now.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use super::actions::Situation;
use super::desk::Desk;
use super::evolution::{Evolution, Status};
use super::stage::Programme;
use super::undo::{History, Way};

/// Where things stand.
#[derive(SystemParam)]
pub(super) struct Now<'w> {
    programme: Res<'w, Programme>,
    evolution: Res<'w, Evolution>,
    desk: Res<'w, Desk>,
    history: Res<'w, History>,
}

impl Now<'_> {
    /// What an action's meaning depends on.
    pub fn situation(&self) -> Situation {
        Situation::of(&self.evolution, &self.programme, &self.desk, &self.history)
    }
}

impl Situation {
    /// As things stand.
    pub fn of(
        evolution: &Evolution,
        programme: &Programme,
        desk: &Desk,
        history: &History,
    ) -> Self {
        Self {
            is_running: evolution.status() == Status::Running,
            is_what_if: matches!(programme, Programme::WhatIf { .. }),
            is_race: *programme == Programme::Race,
            is_covered: desk.over().is_some() || desk.is_bare,
            can_undo: history.next(Way::Back).is_some(),
            can_redo: history.next(Way::Forth).is_some(),
            digit: None,
        }
    }
}
