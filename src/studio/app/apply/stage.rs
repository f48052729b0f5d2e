//! Commands to the stage: its lanes, the clock, the camera.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use crate::studio::commands::Command;
use crate::studio::commands::camera_mode::CameraMode;
use crate::studio::commands::screenshot_area::ScreenshotArea;
use crate::studio::scene::camera::{CameraRig, StageCamera};
use crate::studio::scene::overlays::Overlays;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::opening::OpeningChampions;
use crate::studio::stage::playback::Playback;
use crate::studio::stage::selection::Selection;
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::stage::{Show, StageMode, end_s};
use crate::studio::state::current_run::CurrentRun;
use crate::studio::state::lineup::{all_generations, champion_of, leaders, with_one_more};
use crate::studio::state::undo::{UndoDirection, UndoStep, followed, stepped};
use crate::studio::state::what_if::{WorldChange, dropped, kept, what_if};
use crate::studio::ui::theme::Theme;

/// State of the stage and of its camera.
#[derive(SystemParam)]
pub(crate) struct StageParams<'w, 's> {
    lanes: Query<'w, 's, &'static Lane>,
    mode: Res<'w, StageMode>,
    show: MessageWriter<'w, Show>,
    playback: ResMut<'w, Playback>,
    rig: ResMut<'w, CameraRig>,
    overlays: ResMut<'w, Overlays>,
    selection: ResMut<'w, Selection>,
    theme: ResMut<'w, Theme>,
    photographs: MessageWriter<'w, ScreenshotArea>,
    smoothing: Query<'w, 's, &'static mut Msaa, With<StageCamera>>,
}

impl StageParams<'_, '_> {
    /// The champions on the stage, by lane.
    fn champions(&self) -> Vec<StagedChampion> {
        let mut lanes: Vec<&Lane> = self.lanes.iter().collect();
        lanes.sort_by_key(|lane| lane.number());
        lanes.into_iter().map(|lane| lane.staged().clone()).collect()
    }

    /// The champions on the stage and their mode.
    pub(crate) fn on_show(&self) -> Show {
        Show { champions: self.champions(), mode: self.mode.clone() }
    }

    /// Shows other champions from their start. A pause command later in the same frame applies to them.
    pub(crate) fn present(&mut self, show: Option<Show>) {
        if let Some(show) = show {
            self.playback.restart();
            self.show.write(show);
        }
    }

    fn end_s(&self) -> f64 {
        end_s(self.lanes.iter())
    }

    /// Length of a physics step of the selected lane, in seconds.
    fn step_s(&self) -> f64 {
        let focused = self.lanes.iter().find(|lane| lane.number() == self.selection.lane);
        focused.map_or(1.0, Lane::step_s)
    }

    /// The current show with the champion of the selected lane replaced.
    fn in_place(&self, manner: impl Fn(&StagedChampion) -> StagedChampion) -> Show {
        let mut champions = self.champions();
        if let Some(focused) = champions.get_mut(self.selection.lane) {
            *focused = manner(focused);
        }
        Show { champions, mode: self.mode.clone() }
    }

    /// Whether a command leaves a what-if without keeping or discarding the change.
    pub(crate) fn leaves_change(&self, command: &Command) -> bool {
        let stays =
            matches!(command, Command::KeepChange | Command::ShowAsFound | Command::Simulate);
        matches!(*self.mode, StageMode::WhatIf { .. }) && !stays
    }

    /// Keeps the change of a what-if when a run starts, because that run uses it.
    pub(crate) fn settle(&mut self) {
        let kept = kept(&self.champions(), &self.mode);
        self.present(kept);
    }

    /// Shows the effect of a change beside the unchanged champion.
    pub(crate) fn try_out(
        &mut self,
        run: &mut CurrentRun,
        change: &WorldChange,
    ) -> Result<(), String> {
        let mut on_show = self.champions();
        if *self.mode == StageMode::Race && self.selection.lane < on_show.len() {
            // In a race, the change applies to the selected lane.
            on_show.swap(0, self.selection.lane);
        }
        let show = what_if(run, &on_show, &self.mode, change)?;
        self.present(show);
        Ok(())
    }

    /// Discards a change: shows the unchanged champion and removes the change from the next run.
    pub(crate) fn drop_change(&mut self, run: &mut CurrentRun) -> Result<(), String> {
        let show = dropped(run, &self.champions(), &self.mode)?;
        self.present(show);
        Ok(())
    }

    /// Undoes or redoes a step, and updates the stage.
    pub(crate) fn step(
        &mut self,
        run: &mut CurrentRun,
        step: &UndoStep,
        way: UndoDirection,
    ) -> Result<(), String> {
        match step {
            UndoStep::Plan { before, after, .. } => {
                let (from, to) =
                    if way == UndoDirection::Back { (after, before) } else { (before, after) };
                let now = run.next_plan().clone();
                let next = stepped(&now, from, to);
                if step.is_of_another_run() {
                    run.set_next_plan_alone(next)?;
                } else {
                    run.set_next_plan(next)?;
                }
                let next = run.next_plan();
                let show = followed(&self.champions(), &self.mode, &now, next)?;
                self.present(show);
            }
            // Not about the stage.
            UndoStep::Library { .. } => {}
        }
        Ok(())
    }
}

/// Executes commands that concern the stage alone. Returns whether they replace the champions.
pub(crate) fn on_stage(
    command: &Command,
    stage: &mut StageParams,
    run: &CurrentRun,
    opening: &OpeningChampions,
) -> Result<bool, String> {
    let (end_s, step_s) = (stage.end_s(), stage.step_s());
    let on_show = || stage.champions();
    let show = match command {
        // The individual may have been replaced since the click; then do nothing.
        Command::Show(pick) => champion_of(pick, run, opening).map(Show::solo),
        Command::Join(pick) => {
            let mut on_show = on_show();
            if matches!(*stage.mode, StageMode::WhatIf { .. }) {
                // The two lanes of a what-if show one champion.
                on_show.truncate(1);
            }
            let staged = champion_of(pick, run, opening);
            staged.map(|staged| with_one_more(on_show, staged)).transpose()?.flatten()
        }
        Command::RaceGenerations => Some(Show::race(all_generations(run)?)),
        Command::RaceLeaders(generation) => Some(Show::race(leaders(run, *generation)?)),
        Command::KeepChange => kept(&on_show(), &stage.mode),
        Command::Single if *stage.mode != StageMode::Race => None,
        Command::Single => on_show().into_iter().nth(stage.selection.lane).map(Show::solo),
        Command::ShowAsFound => Some(stage.in_place(StagedChampion::as_found)),
        Command::Simulate => Some(stage.in_place(StagedChampion::simulated)),
        _ => None,
    };
    let is_new = show.is_some();
    stage.present(show);
    match command {
        Command::Focus(lane) => (stage.selection.lane, stage.selection.limb) = (*lane, None),
        Command::TogglePlayback => stage.playback.toggle(end_s),
        Command::Restart => stage.playback.restart(),
        Command::Seek(time_s) => stage.playback.seek(*time_s, end_s),
        Command::SeekEnd => stage.playback.hold_at(end_s),
        Command::Step { forward } => stage.playback.step(*forward, step_s, end_s),
        Command::SetSpeed(speed) => stage.playback.set_speed(*speed),
        Command::ChangeSpeed { faster } => stage.playback.change_speed(*faster),
        Command::ToggleLoop => stage.playback.toggle_loop(),
        Command::SetCamera(camera_mode) => stage.rig.take(*camera_mode),
        Command::NextCameraMode => {
            let next = stage.rig.camera_mode().next();
            stage.rig.take(next);
        }
        Command::ToggleFollow => {
            let is_free = stage.rig.camera_mode() == CameraMode::Free;
            stage.rig.take(if is_free { CameraMode::Follow } else { CameraMode::Free });
        }
        Command::ResetCamera => stage.rig.take(CameraMode::Follow),
        Command::ToggleOverlay(overlay) => stage.overlays.toggle(*overlay),
        Command::ToggleSmoothEdges => {
            for mut msaa in &mut stage.smoothing {
                *msaa = if *msaa == Msaa::Off { Msaa::Sample4 } else { Msaa::Off };
            }
        }
        Command::ToggleTheme => *stage.theme = stage.theme.other(),
        Command::TakePicture(of) => {
            stage.photographs.write(*of);
        }
        _ => {}
    }
    Ok(is_new)
}
