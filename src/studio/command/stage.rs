//! What is asked of the stage: who is on it, which moment, from where.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use super::Command;
use crate::studio::Opening;
use crate::studio::camera::{CameraRig, StageCamera};
use crate::studio::casting::{
    Change, all_generations, dropped, exhibit_of, kept, leaders, what_if, with_one_more,
};
use crate::studio::evolution::Evolution;
use crate::studio::exhibit::Exhibit;
use crate::studio::hands::Hands;
use crate::studio::lane::Lane;
use crate::studio::look::Theme;
use crate::studio::overlay::Overlays;
use crate::studio::playback::Playback;
use crate::studio::screenshot::Photograph;
use crate::studio::stage::{Programme, Show, end_s};
use crate::studio::undo::{Step, Way, followed, stepped};
use crate::studio::view::Shot;

/// What is on the stage, and how it is looked at.
#[derive(SystemParam)]
pub(super) struct StageParams<'w, 's> {
    lanes: Query<'w, 's, &'static Lane>,
    programme: Res<'w, Programme>,
    show: MessageWriter<'w, Show>,
    playback: ResMut<'w, Playback>,
    rig: ResMut<'w, CameraRig>,
    overlays: ResMut<'w, Overlays>,
    hands: ResMut<'w, Hands>,
    theme: ResMut<'w, Theme>,
    photographs: MessageWriter<'w, Photograph>,
    smoothing: Query<'w, 's, &'static mut Msaa, With<StageCamera>>,
}

impl StageParams<'_, '_> {
    /// What is on the stage, the first lane first.
    fn exhibits(&self) -> Vec<Exhibit> {
        let mut lanes: Vec<&Lane> = self.lanes.iter().collect();
        lanes.sort_by_key(|lane| lane.number());
        lanes.into_iter().map(|lane| lane.exhibit().clone()).collect()
    }

    /// What is on the stage, and as what.
    pub(super) fn on_show(&self) -> Show {
        Show { exhibits: self.exhibits(), programme: self.programme.clone() }
    }

    /// Puts others on the stage, from their start. Whoever holds the stage after that, in the same frame, holds them.
    pub(super) fn present(&mut self, show: Option<Show>) {
        if let Some(show) = show {
            self.playback.restart();
            self.show.write(show);
        }
    }

    fn end_s(&self) -> f64 {
        end_s(self.lanes.iter())
    }

    /// Length of a step of the lane in focus, in seconds.
    fn step_s(&self) -> f64 {
        let focused = self.lanes.iter().find(|lane| lane.number() == self.hands.lane);
        focused.map_or(1.0, Lane::step_s)
    }

    /// The lane in focus in another manner, the others as they are.
    fn in_place(&self, manner: impl Fn(&Exhibit) -> Exhibit) -> Show {
        let mut exhibits = self.exhibits();
        if let Some(focused) = exhibits.get_mut(self.hands.lane) {
            *focused = manner(focused);
        }
        Show { exhibits, programme: self.programme.clone() }
    }

    /// Whether a change that is being tried out is left by the way, neither kept nor dropped.
    pub(super) fn leaves_change(&self, command: &Command) -> bool {
        let stays =
            matches!(command, Command::KeepChange | Command::ShowAsFound | Command::Simulate);
        matches!(*self.programme, Programme::WhatIf { .. }) && !stays
    }

    /// Whoever begins a run while a change is tried out goes on with it.
    pub(super) fn settle(&mut self) {
        let kept = kept(&self.exhibits(), &self.programme);
        self.present(kept);
    }

    /// Shows what a change does, beside what it was before.
    pub(super) fn try_out(
        &mut self,
        evolution: &mut Evolution,
        change: &Change,
    ) -> Result<(), String> {
        let mut on_show = self.exhibits();
        if *self.programme == Programme::Race && self.hands.lane < on_show.len() {
            // Of a race it is the one in focus that is tried.
            on_show.swap(0, self.hands.lane);
        }
        let show = what_if(evolution, &on_show, &self.programme, change)?;
        self.present(show);
        Ok(())
    }

    /// Shows what was there before a change that is dropped, which the next run then has not either.
    pub(super) fn drop_change(&mut self, evolution: &mut Evolution) -> Result<(), String> {
        let show = dropped(evolution, &self.exhibits(), &self.programme)?;
        self.present(show);
        Ok(())
    }

    /// Takes a step back or forth; the stage follows.
    pub(super) fn step(
        &mut self,
        evolution: &mut Evolution,
        step: &Step,
        way: Way,
    ) -> Result<(), String> {
        match step {
            Step::Plan { before, after, .. } => {
                let (from, to) = if way == Way::Back { (after, before) } else { (before, after) };
                let now = evolution.next_plan().clone();
                let next = stepped(&now, from, to);
                if step.is_of_another_run() {
                    evolution.set_next_plan_alone(next)?;
                } else {
                    evolution.set_next_plan(next)?;
                }
                let next = evolution.next_plan();
                let show = followed(&self.exhibits(), &self.programme, &now, next)?;
                self.present(show);
            }
            // No matter of the stage.
            Step::Library { .. } => {}
        }
        Ok(())
    }
}

/// Does what concerns the stage alone. Says whether others take the stage.
pub(super) fn on_stage(
    command: &Command,
    stage: &mut StageParams,
    evolution: &Evolution,
    opening: &Opening,
) -> Result<bool, String> {
    let (end_s, step_s) = (stage.end_s(), stage.step_s());
    let on_show = || stage.exhibits();
    let show = match command {
        // Who is not found any more is not missed: somebody better has taken the place since the click.
        Command::Show(pick) => exhibit_of(pick, evolution, opening).map(Show::solo),
        Command::Join(pick) => {
            let mut on_show = on_show();
            if matches!(*stage.programme, Programme::WhatIf { .. }) {
                // The two are one.
                on_show.truncate(1);
            }
            let exhibit = exhibit_of(pick, evolution, opening);
            exhibit.map(|exhibit| with_one_more(on_show, exhibit)).transpose()?.flatten()
        }
        Command::RaceGenerations => Some(Show::race(all_generations(evolution)?)),
        Command::RaceLeaders(generation) => Some(Show::race(leaders(evolution, *generation)?)),
        Command::KeepChange => kept(&on_show(), &stage.programme),
        Command::Single if *stage.programme != Programme::Race => None,
        Command::Single => on_show().into_iter().nth(stage.hands.lane).map(Show::solo),
        Command::ShowAsFound => Some(stage.in_place(Exhibit::as_found)),
        Command::Simulate => Some(stage.in_place(Exhibit::simulated)),
        _ => None,
    };
    let is_new = show.is_some();
    stage.present(show);
    match command {
        Command::Focus(lane) => (stage.hands.lane, stage.hands.limb) = (*lane, None),
        Command::TogglePlayback => stage.playback.toggle(end_s),
        Command::Restart => stage.playback.restart(),
        Command::Seek(time_s) => stage.playback.seek(*time_s, end_s),
        Command::SeekEnd => stage.playback.hold_at(end_s),
        Command::Step { forward } => stage.playback.step(*forward, step_s, end_s),
        Command::SetSpeed(speed) => stage.playback.set_speed(*speed),
        Command::ChangeSpeed { faster } => stage.playback.change_speed(*faster),
        Command::ToggleLoop => stage.playback.toggle_loop(),
        Command::Look(shot) => stage.rig.take(*shot),
        Command::NextShot => {
            let next = stage.rig.shot().next();
            stage.rig.take(next);
        }
        Command::ToggleFollow => {
            let is_free = stage.rig.shot() == Shot::Free;
            stage.rig.take(if is_free { Shot::Follow } else { Shot::Free });
        }
        Command::ResetCamera => stage.rig.take(Shot::Follow),
        Command::Toggle(overlay) => stage.overlays.toggle(*overlay),
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
