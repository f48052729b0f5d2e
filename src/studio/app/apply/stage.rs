//! Commands to the stage: its lanes and its clock.

mod changes;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use crate::studio::commands::{Command, PlanCommand, PlayerCommand, StageCommand};
use crate::studio::stage::lane::Lane;
use crate::studio::stage::opening::OpeningChampions;
use crate::studio::stage::playback::Playback;
use crate::studio::stage::selection::Selection;
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::stage::{Show, StageMode, end_s};
use crate::studio::state::current_run::CurrentRun;
use crate::studio::state::following::Following;
use crate::studio::state::lineup::{all_generations, champion_of, leaders, with_one_more};
use crate::studio::state::stairs_race::stairs_race;
use crate::studio::state::sweep::sweep;
use crate::studio::state::turns::Turns;
use crate::studio::state::what_if::{another_beside, kept};
use crate::studio::ui::notifications::Notices;
use snakes_core::save::library::plain_name;

/// State of the stage.
#[derive(SystemParam)]
pub(crate) struct StageParams<'w, 's> {
    lanes: Query<'w, 's, &'static Lane>,
    pub mode: Res<'w, StageMode>,
    show: MessageWriter<'w, Show>,
    playback: ResMut<'w, Playback>,
    selection: ResMut<'w, Selection>,
    following: ResMut<'w, Following>,
    turns: ResMut<'w, Turns>,
}

/// Shown when the user leaves a what-if without discarding the change.
const CHANGE_STAYS: &str = "The next run keeps the change: see the World panel.";

impl StageParams<'_, '_> {
    /// A name for a file with the champions on the stage, without its ending.
    pub fn name_for_file(&self) -> String {
        match self.champions_to_share().as_slice() {
            [only] => plain_name(only.label()),
            _ => "race".to_owned(),
        }
    }

    /// The champions on the stage that a file gets: all, but of a whole generation its best.
    pub fn champions_to_share(&self) -> Vec<StagedChampion> {
        let mut champions = self.champions();
        if matches!(*self.mode, StageMode::Generation { .. }) {
            champions.truncate(1);
        }
        champions
    }

    /// The champions on the stage, by lane.
    fn champions(&self) -> Vec<StagedChampion> {
        let mut lanes: Vec<&Lane> = self.lanes.iter().collect();
        lanes.sort_by_key(|lane| lane.number());
        lanes.into_iter().map(|lane| lane.staged().clone()).collect()
    }

    /// The champions on the stage; in a race, the one of the selected lane first, because a change of the world applies
    /// to the first.
    pub fn champions_to_change(&self) -> Vec<StagedChampion> {
        let mut champions = self.champions();
        if *self.mode == StageMode::Race && self.selection.lane < champions.len() {
            champions.swap(0, self.selection.lane);
        }
        champions
    }

    /// The champion of the selected lane, or else of the first one.
    pub fn selected(&self) -> Option<StagedChampion> {
        let lanes = || self.lanes.iter();
        let selected = lanes().find(|lane| lane.number() == self.selection.lane);
        let lane = selected.or_else(|| lanes().min_by_key(|lane| lane.number()));
        lane.map(|lane| lane.staged().clone())
    }

    /// The champions on the stage and their mode.
    pub fn on_show(&self) -> Show {
        Show { champions: self.champions(), mode: self.mode.clone() }
    }

    /// Shows other champions from their start, which stay until the user chooses again. A pause command later in the
    /// same frame applies to them.
    pub fn present(&mut self, show: Option<Show>) {
        if show.is_some() {
            self.following.stop();
        }
        self.present_for_now(show);
    }

    /// Shows other champions from their start, until evolution has something better to show.
    pub fn present_for_now(&mut self, show: Option<Show>) {
        if let Some(show) = show {
            self.playback.begin();
            self.show.write(show);
        }
    }

    /// Shows other champions. Reminds the user of the change if that leaves a what-if.
    pub fn present_others(&mut self, show: Option<Show>, notices: &mut Notices) {
        if show.is_some() && matches!(*self.mode, StageMode::WhatIf { .. }) {
            notices.info(CHANGE_STAYS.to_owned());
        }
        self.present(show);
    }

    /// The current show with the champion of the selected lane replaced.
    fn in_place(&self, replace: impl Fn(&StagedChampion) -> StagedChampion) -> Show {
        let mut champions = self.champions();
        if let Some(focused) = champions.get_mut(self.selection.lane) {
            *focused = replace(focused);
        }
        Show { champions, mode: self.mode.clone() }
    }

    /// Keeps the change of a what-if when a run starts, because that run uses it.
    pub fn settle(&mut self) {
        let kept = kept(&self.champions(), &self.mode);
        self.present_for_now(kept);
    }

    /// The change of a what-if that is on the stage, in words.
    pub fn tried_change(&self) -> Option<String> {
        let kept = kept(&self.champions(), &self.mode)?;
        let changed = kept.champions.iter().find(|staged| staged.is_changed());
        changed.map(|staged| staged.label().to_owned())
    }

    /// Executes a command to the lanes.
    pub fn apply(
        &mut self,
        command: &StageCommand,
        run: &CurrentRun,
        opening: &OpeningChampions,
        notices: &mut Notices,
    ) -> Result<(), String> {
        let show = match command {
            // The individual may have been replaced since the click; then do nothing.
            StageCommand::Show(pick) => champion_of(pick, run, opening).map(Show::solo),
            StageCommand::Join(pick) => {
                let mut on_show = self.champions();
                if matches!(*self.mode, StageMode::WhatIf { .. } | StageMode::Generation { .. }) {
                    // The lanes of a what-if show one champion, and a generation has no room beside it.
                    on_show.truncate(1);
                }
                let staged = champion_of(pick, run, opening);
                staged.map(|staged| with_one_more(on_show, staged)).transpose()?.flatten()
            }
            StageCommand::ShowGeneration(generation) => {
                let latest = run.reports().last().map(|report| report.generation);
                let number = generation.or(latest).ok_or("No generation is finished yet.")?;
                let kept = run.whole_generation(number);
                Some(kept.ok_or_else(|| {
                    format!("All snakes of generation {number} were disqualified.")
                })?)
            }
            StageCommand::ToggleFollowEvolution => {
                if self.following.follows_evolution() {
                    self.following.stop();
                } else {
                    self.following.follow_evolution();
                }
                None
            }
            StageCommand::TellStory => {
                self.following.tell_story(run)?;
                None
            }
            StageCommand::Sweep(field) => {
                let on_show = self.champions_to_change();
                on_show.first().map(|champion| sweep(champion, field)).transpose()?
            }
            StageCommand::RaceStairs => {
                let on_show = self.champions_to_change();
                on_show.first().map(stairs_race).transpose()?
            }
            StageCommand::RaceGenerations => Some(Show::race(all_generations(run)?)),
            StageCommand::RaceLeaders(generation) => Some(Show::race(leaders(run, *generation)?)),
            StageCommand::TakeTurn(turn) => {
                self.turns.take(*turn);
                None
            }
            StageCommand::Single
                if matches!(*self.mode, StageMode::Solo | StageMode::WhatIf { .. }) =>
            {
                None
            }
            StageCommand::Single => {
                let left = self.champions().into_iter().nth(self.selection.lane);
                if let Some(left) = left.iter().find(|left| left.is_changed()) {
                    let text = format!(
                        "The stage keeps {}. The settings in the World panel do not.",
                        left.label()
                    );
                    let take = Command::Plan(PlanCommand::UseWorldOfLane);
                    notices.offer("world", text, [("Use this world", take)]);
                }
                left.map(Show::solo)
            }
            StageCommand::KeepChange => {
                self.settle();
                None
            }
            StageCommand::TryAnother => {
                // The clock runs on: nothing on the stage changes.
                self.show.write(another_beside(run, self.champions(), &self.mode)?);
                None
            }
            StageCommand::ShowAsFound => {
                self.present(Some(self.in_place(StagedChampion::as_found)));
                None
            }
            StageCommand::Simulate => {
                self.present(Some(self.in_place(StagedChampion::simulated)));
                None
            }
            StageCommand::Focus(lane) => {
                (self.selection.lane, self.selection.limb) = (*lane, None);
                None
            }
        };
        self.present_others(show, notices);
        Ok(())
    }

    /// Executes a command to the clock.
    pub fn apply_to_player(&mut self, command: &PlayerCommand) {
        let focused = self.lanes.iter().find(|lane| lane.number() == self.selection.lane);
        let step_s = focused.map_or(1.0, Lane::step_s);
        self.playback.apply(command, step_s, end_s(self.lanes.iter()));
    }
}
