//! Scenes of the stage to which leaving a race, a what-if, a lesson or another excursion returns.

use bevy::prelude::*;

use super::camera::rig::CameraRig;
use crate::studio::stage::StageMode;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::playback::Playback;
use crate::studio::state::following::Following;

/// An activity that shows something else on the stage. Its end brings the earlier scene back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Excursion {
    /// Several snakes side by side.
    Race,
    /// The snake beside copies in changed worlds.
    WhatIf,
    /// A single snake, chosen while several were on the stage.
    Snake,
    /// The snake on stairs of its exam.
    Exam,
    /// The snake beside one with an edited body.
    Body,
    /// A guided experiment.
    Lesson,
    /// The stage on the full screen.
    Presenting,
}

impl Excursion {
    /// Returns whether the excursion has an end of its own, so that the shows within it do not end it.
    fn is_frame(self) -> bool {
        matches!(self, Self::Lesson | Self::Presenting)
    }
}

/// The stage at the moment when an excursion began.
pub(crate) struct LeftScene {
    /// Relation between the lanes.
    pub mode: StageMode,
    /// Lanes in their state at that moment.
    pub lanes: Vec<Lane>,
    /// Clock of the stage.
    pub playback: Playback,
    /// Camera of the stage.
    pub camera: CameraRig,
    /// Selected lane and limb.
    pub selected: (usize, Option<usize>),
    /// Generations that the stage followed.
    pub following: Following,
}

/// The scenes to which the excursions in progress return, the innermost last.
#[derive(Resource, Default)]
pub(crate) struct WayBack(Vec<(Excursion, LeftScene)>);

/// Maximum number of scenes. Of more, the outermost is forgotten.
const MAX_SCENES: usize = 8;

impl WayBack {
    /// Returns the innermost excursion and the stage's mode to which it returns.
    pub fn innermost(&self) -> Option<(Excursion, &StageMode)> {
        self.0.last().map(|(excursion, scene)| (*excursion, &scene.mode))
    }

    /// Returns whether the innermost excursion can be left by the general command, rather than by its own.
    pub fn can_leave(&self) -> bool {
        self.innermost().is_some_and(|(excursion, _)| !excursion.is_frame())
    }

    /// Begins an excursion. An excursion within one of its own kind, such as another sweep during a race, returns to the
    /// scene before the first.
    pub fn enter(&mut self, excursion: Excursion, scene: impl FnOnce() -> LeftScene) {
        if self.innermost().is_some_and(|(innermost, _)| innermost == excursion) {
            return;
        }
        if self.0.len() >= MAX_SCENES {
            self.0.remove(0);
        }
        self.0.push((excursion, scene()));
    }

    /// Ends the innermost excursion of a kind, with all excursions within it. Returns the scene from before it.
    pub fn leave(&mut self, excursion: Excursion) -> Option<LeftScene> {
        let index = self.0.iter().rposition(|(of, _)| *of == excursion)?;
        self.0.drain(index..).next().map(|(_, scene)| scene)
    }

    /// Ends all excursions within the innermost one of a kind, and makes that one of another kind.
    pub fn turn(&mut self, excursion: Excursion, into: Excursion) {
        if let Some(index) = self.0.iter().rposition(|(of, _)| *of == excursion) {
            self.0.truncate(index + 1);
            self.0[index].0 = into;
        }
    }

    /// Forgets all scenes back to the innermost lesson or presentation, because the stage shows something new.
    pub fn forget(&mut self) {
        let kept = self.0.iter().rposition(|(excursion, _)| excursion.is_frame());
        self.0.truncate(kept.map_or(0, |index| index + 1));
    }

    /// Makes the kept lane of a what-if the snake on the stage. A scene of several snakes can still come back.
    pub fn settle(&mut self) {
        match self.0.last_mut() {
            Some((Excursion::WhatIf, LeftScene { mode: StageMode::Solo, .. })) => {
                self.0.pop();
            }
            Some((excursion @ Excursion::WhatIf, _)) => *excursion = Excursion::Snake,
            _ => {}
        }
    }
}
