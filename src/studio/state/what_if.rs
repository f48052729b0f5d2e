//! What-ifs: copies of the champion in changed worlds beside the original.
//!
//! A change applies to the latest copy, which restarts from the time of the change. A copy that is kept beside the next
//! one is not changed any more.

use std::fmt::Display;

use bevy::prelude::*;

use super::current_run::CurrentRun;
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::stage::{Show, StageMode};
use snakes_core::evolve::{RunPlan, Settings, with_fields, world_in_words};
use snakes_core::score::{Rollout, Trial};
use snakes_core::world::PhysicsSettings;

/// A change of the world.
#[derive(Debug, Clone)]
pub(crate) enum WorldChange<'a> {
    /// New values of settings, by the settings' names: see [`with_fields`].
    Fields(Vec<(&'a str, &'a str)>),
    /// World of the preset with this name.
    Preset(&'a str),
}

/// The champions on the stage, and the state from which a change of their world is tried.
#[derive(Clone, Copy)]
pub(crate) struct ChangedStage<'a> {
    /// Champions by lane, of which the first is the original, and the relation between them.
    pub show: &'a Show,
    /// Rollout of the original at the time of the change; `None` for its start.
    pub moment: Option<&'a Rollout>,
}

impl ChangedStage<'_> {
    /// Returns the champion whose world the next run has: that of the current lane in a what-if, or else the original.
    pub fn current(&self) -> Option<&StagedChampion> {
        match self.show.mode {
            StageMode::WhatIf { current, .. } => self.show.champions.get(current),
            _ => self.show.champions.first(),
        }
    }

    /// Returns the stage after the world of the current lane became `trial`. A new copy replaces the latest one; there is no new copy if
    /// a lane that is kept already has this world. `before` is the plan of the next run before any change.
    ///
    /// # Errors
    /// The champion does not fit the changed world.
    pub fn with_world(
        &self,
        before: &RunPlan,
        trial: &Trial,
        label: String,
    ) -> Result<Show, String> {
        let (before, beside) = match &self.show.mode {
            StageMode::WhatIf { before, beside, .. } => (before.clone(), beside.clone()),
            _ => (Box::new(before.clone()), Vec::new()),
        };
        // All lanes are simulated, so that their only difference is the change.
        let staying = self.show.champions.iter().take(1 + beside.len());
        let mut champions: Vec<StagedChampion> = staying.map(StagedChampion::simulated).collect();
        let Some(original) = champions.first().cloned() else {
            return Err("There is no snake on the stage.".to_owned());
        };
        if let Some(current) = champions.iter().position(|staged| staged.trial() == trial) {
            return Ok(what_if_of(champions, before, beside, current));
        }
        let changed = original.in_world_from(self.moment, trial, label);
        changed.check().map_err(unsuited)?;
        champions.push(changed);
        let current = champions.len() - 1;
        Ok(what_if_of(champions, before, beside, current))
    }
}

/// Describes why a snake stays in its world, in a sentence.
pub(super) fn unsuited(reason: impl Display) -> String {
    format!(
        "The snake on the stage stays in its world, because it does not fit the new one: {reason}"
    )
}

/// Creates a what-if, or shows the original alone if there is no copy.
fn what_if_of(
    champions: Vec<StagedChampion>,
    before: Box<RunPlan>,
    beside: Vec<RunPlan>,
    current: usize,
) -> Show {
    let is_alone = champions.len() < 2;
    let mode =
        if is_alone { StageMode::Solo } else { StageMode::WhatIf { before, beside, current } };
    Show { champions, mode }
}

/// Applies a change to the next run. Returns the original beside its copies in changed worlds; `None` if the change
/// does not affect the stage.
pub(crate) fn what_if(
    run: &mut CurrentRun,
    stage: ChangedStage,
    change: &WorldChange,
) -> Result<Option<Show>, String> {
    let before = run.plan_next.clone();
    match change {
        WorldChange::Fields(changes) => run.set_fields(changes)?,
        WorldChange::Preset(name) => run.set_preset(name)?,
    }
    let Some(original) = stage.show.champions.first() else { return Ok(None) };
    // The change is added to those of the current lane.
    let so_far = stage.current().unwrap_or(original);
    let next = run.next_settings();
    let trial = match change {
        // Other differences between the next run's world and the stage are ignored.
        WorldChange::Fields(changes) => {
            let settings = Settings { trial: so_far.trial().clone(), ..next.clone() };
            with_fields(&settings, changes.iter().copied())?.trial
        }
        // Duration, fitness and engine are kept, so that the lanes remain comparable.
        WorldChange::Preset(_) => Trial {
            physics: PhysicsSettings {
                engine: so_far.trial().physics.engine,
                ..next.trial.physics.clone()
            },
            duration_s: so_far.trial().duration_s,
            fitness: so_far.trial().fitness,
            energy_cost_per_kj: so_far.trial().energy_cost_per_kj,
            repeats: so_far.trial().repeats.clone(),
            ..next.trial.clone()
        },
    };
    if trial == *so_far.trial() {
        return Ok(None);
    }
    let label = match change {
        WorldChange::Preset(name) => (*name).to_owned(),
        WorldChange::Fields(_) => world_in_words(&original.champion().trial, &trial),
    };
    stage.with_world(&before, &trial, label).map(Some)
}

/// Keeps the latest copy, so that the next change adds another one beside it.
///
/// # Errors
/// No copy can be kept; the error states the reason.
pub(crate) fn another_beside(run: &CurrentRun, show: Show) -> Result<Show, String> {
    let can_try_another = show.mode.can_try_another();
    match show.mode {
        StageMode::WhatIf { before, mut beside, current } if can_try_another => {
            beside.push(run.plan_next.clone());
            Ok(what_if_of(show.champions, before, beside, current))
        }
        StageMode::WhatIf { beside, current, .. } if current > beside.len() => {
            Err("There is no room for another copy: discard one first.".to_owned())
        }
        _ => Err("Change a setting of the Change panel first.".to_owned()),
    }
}

/// Discards the latest copy. The next run gets the world of the previous lane.
pub(crate) fn dropped(run: &mut CurrentRun, show: &Show) -> Result<Option<Show>, String> {
    let StageMode::WhatIf { before, beside, .. } = &show.mode else { return Ok(None) };
    let current = show.champions.len().saturating_sub(2);
    let mut beside = beside.clone();
    beside.truncate(current);
    run.undo_world(beside.last().unwrap_or(before))?;
    Ok(Some(what_if_of(show.champions[..=current].to_vec(), before.clone(), beside, current)))
}

/// Returns the lane of a what-if whose world the next run has, alone and from the start.
pub(crate) fn kept(show: &Show) -> Option<Show> {
    let StageMode::WhatIf { current, .. } = show.mode else { return None };
    show.champions.get(current).map(|staged| Show::solo(staged.shown_from_start()))
}

/// Keeps only one changed lane of a what-if, from the start. The next run gets its world.
pub(crate) fn kept_lane(
    run: &mut CurrentRun,
    show: &Show,
    lane: usize,
) -> Result<Option<Show>, String> {
    let StageMode::WhatIf { beside, .. } = &show.mode else { return Ok(None) };
    if let Some(plan) = lane.checked_sub(1).and_then(|index| beside.get(index)) {
        run.undo_world(plan)?;
    }
    Ok(show.champions.get(lane).map(|staged| Show::solo(staged.shown_from_start())))
}

#[cfg(test)]
pub(super) mod tests;
