//! Commands to the stage: its lanes and its clock.

mod changes;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use crate::studio::commands::{Command, PlanCommand, PlayerCommand, StageCommand};
use crate::studio::scene::camera::rig::CameraRig;
use crate::studio::scene::way_back::{LeftScene, WayBack};
use crate::studio::stage::lane::Lane;
use crate::studio::stage::opening::OpeningChampions;
use crate::studio::stage::playback::Playback;
use crate::studio::stage::selection::Selection;
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::stage::{Show, StageMode, end_s, placed};
use crate::studio::state::current_run::CurrentRun;
use crate::studio::state::following::Following;
use crate::studio::state::knock_outs::knock_outs;
use crate::studio::state::lineup::{all_generations, champion_of, leaders, with_one_more};
use crate::studio::state::stairs_race::stairs_race;
use crate::studio::state::sweep::sweep;
use crate::studio::state::turns::Turns;
use crate::studio::state::what_if::{ChangedStage, another_beside, kept};
use crate::studio::ui::notifications::Notices;
use snakes_core::save::library::plain_name;

/// System parameters that make up the state of the stage.
#[derive(SystemParam)]
pub(crate) struct StageParams<'w, 's> {
    pub(super) lanes: Query<'w, 's, (Entity, &'static Lane)>,
    pub(super) mode: ResMut<'w, StageMode>,
    pub(super) show: MessageWriter<'w, Show>,
    /// Request of the present command to the stage, if there is one.
    pub(super) pending: Local<'s, Option<Show>>,
    pub(super) way_back: ResMut<'w, WayBack>,
    commands: Commands<'w, 's>,
    pub(super) playback: ResMut<'w, Playback>,
    pub(super) selection: ResMut<'w, Selection>,
    pub(super) following: ResMut<'w, Following>,
    turns: ResMut<'w, Turns>,
}

/// Message for a user who leaves a what-if without discarding the change.
const CHANGE_STAYS: &str = "The next run keeps the change: see the Change panel.";

impl StageParams<'_, '_> {
    /// Suggests a file name for the champions on the stage, without an extension.
    pub fn name_for_file(&self) -> String {
        match self.champions_to_share().as_slice() {
            [only] => plain_name(only.label()),
            _ => "race".to_owned(),
        }
    }

    /// Returns the champions on the stage that are written to a file: all of them, or only the best of a whole generation.
    pub fn champions_to_share(&self) -> Vec<StagedChampion> {
        let mut champions = self.champions();
        if matches!(*self.mode, StageMode::Generation { .. }) {
            champions.truncate(1);
        }
        champions
    }

    fn all_lanes(&self) -> impl Iterator<Item = &Lane> {
        self.lanes.iter().map(|(_, lane)| lane)
    }

    /// Returns the champions on the stage, in the order of their lanes.
    fn champions(&self) -> Vec<StagedChampion> {
        let lanes = self.lanes.iter().sort_by_key::<&Lane, _>(|lane| lane.number);
        lanes.map(|(_, lane)| lane.staged.clone()).collect()
    }

    /// Returns a request for what is on the stage.
    fn shown(&self) -> Show {
        Show { champions: self.champions(), mode: self.mode.clone() }
    }

    /// Returns a request for what is on the stage. In a race, the champion of the selected lane is first, because a change
    /// of the world applies to the first.
    fn to_change(&self) -> Show {
        let mut shown = self.shown();
        if shown.mode == StageMode::Race && self.selection.lane < shown.champions.len() {
            shown.champions.swap(0, self.selection.lane);
        }
        shown
    }

    /// Returns the champion of the selected lane, or of the first lane if the selected one does not exist.
    pub fn selected(&self) -> Option<StagedChampion> {
        let nearness = |lane: &&Lane| (lane.number != self.selection.lane, lane.number);
        self.all_lanes().min_by_key(nearness).map(|lane| lane.staged.clone())
    }

    /// Returns the champion of which a race shows variations: that of the selected lane, or the best of a generation. In a
    /// what-if, this is the selected copy, with its change from the start.
    fn varied(&self) -> Option<StagedChampion> {
        match *self.mode {
            StageMode::Solo | StageMode::Race => self.selected(),
            StageMode::WhatIf { .. } => Some(self.selected()?.shown_from_start()),
            StageMode::Generation { .. } => self.champions().into_iter().next(),
        }
    }

    /// Shows other champions from their start until the user chooses again. A pause command later in the same frame
    /// applies to them.
    pub fn present(&mut self, show: Option<Show>) {
        if show.is_some() {
            self.following.stop();
        }
        self.present_for_now(show);
    }

    /// Shows other champions from their start, until evolution finds a better champion.
    pub fn present_for_now(&mut self, show: Option<Show>) {
        if let Some(show) = show {
            self.playback.begin();
            *self.pending = Some(show);
        }
    }

    /// Brings back an earlier scene: its lanes, clock, camera, selection, and the generations that it followed.
    pub(super) fn bring_back(&mut self, scene: LeftScene, camera: &mut CameraRig) {
        for (entity, _) in &self.lanes {
            self.commands.entity(entity).despawn();
        }
        for lane in scene.lanes {
            self.commands.spawn(placed(lane.back()));
        }
        *self.mode = scene.mode;
        self.playback.restore(&scene.playback);
        (self.selection.lane, self.selection.limb) = scene.selected;
        self.following.restore(scene.following);
        *camera = scene.camera;
    }

    /// Shows other champions. If this ends a what-if, reminds the user of the change.
    pub fn present_others(&mut self, show: Option<Show>, notices: &mut Notices) {
        if show.is_some() && matches!(*self.mode, StageMode::WhatIf { .. }) {
            notices.info(CHANGE_STAYS.to_owned());
        }
        self.present(show);
    }

    /// Returns a request for the present champions, with that of the selected lane replaced.
    fn in_place(&self, replace: impl Fn(&StagedChampion) -> StagedChampion) -> Show {
        let mut shown = self.shown();
        if let Some(focused) = shown.champions.get_mut(self.selection.lane) {
            *focused = replace(focused);
        }
        shown
    }

    /// Keeps the change of a what-if, for example when a run that uses it starts. Describes the change; returns `None`
    /// if there is none.
    pub fn settle(&mut self) -> Option<String> {
        let kept = kept(&self.shown())?;
        let changed = kept.champions.iter().find(|staged| staged.is_changed());
        let change = changed.map(|staged| staged.label().to_owned());
        self.present_for_now(Some(kept));
        change
    }

    /// Executes a command to the lanes of the stage.
    pub fn apply(
        &mut self,
        command: &StageCommand,
        run: &CurrentRun,
        opening: &OpeningChampions,
        notices: &mut Notices,
    ) -> Result<(), String> {
        match command {
            StageCommand::ToggleFollowEvolution if self.following.follows_evolution() => {
                self.following.stop();
            }
            StageCommand::ToggleFollowEvolution => self.following.follow_evolution(),
            StageCommand::TellStory => self.following.tell_story(run)?,
            StageCommand::TakeTurn(turn) => self.turns.take(*turn),
            // The scene comes back when the command is finished.
            StageCommand::Leave => {}
            StageCommand::Single => self.leave_single(notices),
            StageCommand::KeepChange => drop(self.settle()),
            // The clock continues, because nothing on the stage changes.
            StageCommand::TryAnother => *self.pending = Some(another_beside(run, self.shown())?),
            StageCommand::ShowAsFound => {
                self.present(Some(self.in_place(StagedChampion::as_found)))
            }
            StageCommand::Simulate => self.present(Some(self.in_place(StagedChampion::simulated))),
            StageCommand::Focus(lane) => (self.selection.lane, self.selection.limb) = (*lane, None),
            StageCommand::Show(_)
            | StageCommand::Join(_)
            | StageCommand::ShowGeneration(_)
            | StageCommand::Sweep(_)
            | StageCommand::RaceStairs
            | StageCommand::RaceKnockOuts
            | StageCommand::RaceGenerations
            | StageCommand::RaceLeaders(_) => {
                self.present_others(self.chosen(command, run, opening)?, notices);
            }
        }
        Ok(())
    }

    /// Returns the other champions that a command chooses for the stage, if there are any.
    fn chosen(
        &self,
        command: &StageCommand,
        run: &CurrentRun,
        opening: &OpeningChampions,
    ) -> Result<Option<Show>, String> {
        Ok(match command {
            // The individual may have been replaced since the click. Then nothing happens.
            StageCommand::Show(pick) => champion_of(pick, run, opening).map(Show::solo),
            StageCommand::Join(pick) => {
                let mut on_show = self.champions();
                if matches!(*self.mode, StageMode::WhatIf { .. } | StageMode::Generation { .. }) {
                    // The lanes of a what-if show a single champion, and there is no space beside a generation.
                    on_show.truncate(1);
                }
                let staged = champion_of(pick, run, opening);
                staged.map(|staged| with_one_more(on_show, staged)).transpose()?.flatten()
            }
            StageCommand::ShowGeneration(generation) => {
                let latest = run.reports.last().map(|report| report.generation);
                let number = generation.or(latest).ok_or("No generation is finished yet.")?;
                let kept = run.whole_generation(number);
                Some(kept.ok_or_else(|| {
                    format!("All snakes of generation {number} were disqualified.")
                })?)
            }
            StageCommand::Sweep(field) => {
                // In a what-if, this is the copy with the values that the sliders show.
                let stage = ChangedStage { show: &self.to_change(), moment: None };
                stage.current().map(|champion| sweep(champion, field)).transpose()?
            }
            StageCommand::RaceStairs => self.varied().as_ref().map(stairs_race).transpose()?,
            StageCommand::RaceKnockOuts => self.varied().as_ref().map(knock_outs).transpose()?,
            StageCommand::RaceGenerations => Some(Show::race(all_generations(run)?)),
            StageCommand::RaceLeaders(generation) => Some(Show::race(leaders(run, *generation)?)),
            _ => None,
        })
    }

    /// Leaves only the selected one of several snakes on the stage, and offers its world for the next run.
    fn leave_single(&mut self, notices: &mut Notices) {
        if matches!(*self.mode, StageMode::Solo | StageMode::WhatIf { .. }) {
            return;
        }
        self.following.stop();
        let left = self.champions().into_iter().nth(self.selection.lane);
        if let Some(left) = left.iter().find(|left| left.is_changed()) {
            let text = format!(
                "The stage keeps {}. The settings in the Change panel do not.",
                left.label()
            );
            let take = Command::Plan(PlanCommand::UseWorldOfLane);
            notices.offer("world", text, [("Use this world", take)]);
        }
        // The clock goes on, so that the snake is seen at the same moment as among the others.
        *self.pending = left.map(Show::solo);
    }

    /// Executes a command to the clock of the stage.
    pub fn apply_to_player(&mut self, command: &PlayerCommand) {
        let focused = self.all_lanes().find(|lane| lane.number == self.selection.lane);
        let step_s = focused.map_or(1.0, |lane| lane.step_s);
        let end_s = end_s(self.all_lanes());
        self.playback.apply(command, step_s, end_s);
    }
}
