//! State of the stage that the panels read.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use crate::studio::scene::camera::{CameraRig, StageCamera};
use crate::studio::scene::overlays::Overlays;
use crate::studio::stage::StageMode;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::playback::Playback;
use crate::studio::stage::selection::Selection;
use crate::studio::state::undo::UndoHistory;

/// State of the stage that the panels read.
#[derive(SystemParam)]
pub(crate) struct OnStage<'w, 's> {
    pub lanes: Query<'w, 's, &'static Lane>,
    pub mode: Res<'w, StageMode>,
    pub playback: Res<'w, Playback>,
    pub selection: Res<'w, Selection>,
    pub rig: Res<'w, CameraRig>,
    pub overlays: Res<'w, Overlays>,
    pub history: Res<'w, UndoHistory>,
    pub smoothing: Query<'w, 's, &'static Msaa, With<StageCamera>>,
}
