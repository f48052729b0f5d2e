//! Effect of each command on the way back to earlier scenes of the stage.

use super::stage::StageParams;
use crate::studio::commands::{BodyCommand, Command, ExamCommand, PlanCommand, StageCommand};
use crate::studio::scene::camera::rig::CameraRig;
use crate::studio::scene::way_back::{Excursion, LeftScene, WayBack};
use crate::studio::stage::StageMode;

/// Effect of a command on the way back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Effect {
    /// The way back stays as it is.
    None,
    /// An excursion begins.
    Enter(Excursion),
    /// An excursion ends.
    Leave(Excursion),
    /// The kept lane of a what-if stays on the stage.
    Settle,
    /// Something new is on the stage, from which nothing leads back.
    Forget,
}

/// Excursions that last from a command that begins them to one that ends them, whatever the commands between show.
const FRAMES: [Excursion; 2] = [Excursion::Presenting, Excursion::Lesson];

/// Returns the effect of a command that shows `shown`, if anything, on a stage in the mode `from`.
fn effect(command: &Command, from: &StageMode, shown: Option<&StageMode>, way: &WayBack) -> Effect {
    use StageCommand::{
        Join, KeepChange, Leave, RaceGenerations, RaceKnockOuts, RaceLeaders, RaceStairs, Show,
        ShowGeneration, Single, Sweep, TellStory, ToggleFollowEvolution,
    };
    let is_what_if = |mode: &StageMode| matches!(mode, StageMode::WhatIf { .. });
    let is_race = shown == Some(&StageMode::Race);
    match command {
        Command::Stage(ToggleFollowEvolution | TellStory)
        | Command::Plan(PlanCommand::StartFromSave(_)) => Effect::Forget,
        Command::Stage(Leave) => {
            // Lessons and presentations end by commands of their own.
            let innermost = way.innermost().filter(|_| way.can_leave());
            innermost.map_or(Effect::None, |(innermost, _)| Effect::Leave(innermost))
        }
        Command::Exam(ExamCommand::BackToOwnStairs) => Effect::Leave(Excursion::Exam),
        Command::Body(BodyCommand::Close | BodyCommand::Evolve) => Effect::Leave(Excursion::Body),
        _ if shown.is_none() => Effect::None,
        Command::Plan(PlanCommand::KeepLane(_)) | Command::Stage(KeepChange) | Command::Run(_) => {
            Effect::Settle
        }
        Command::Plan(_) | Command::Undo | Command::Redo => match shown.map(is_what_if) {
            Some(true) if !is_what_if(from) => Effect::Enter(Excursion::WhatIf),
            Some(false) if is_what_if(from) => Effect::Leave(Excursion::WhatIf),
            _ => Effect::None,
        },
        Command::Stage(Join(_)) if !is_race || *from == StageMode::Race => Effect::None,
        Command::Stage(
            Join(_) | Sweep(_) | RaceStairs | RaceKnockOuts | RaceGenerations | RaceLeaders(_),
        ) => Effect::Enter(Excursion::Race),
        Command::Stage(Single) => Effect::Enter(Excursion::Snake),
        Command::Stage(Show(_)) | Command::Library(_) | Command::File(_) => match way.innermost() {
            _ if is_race => Effect::Enter(Excursion::Race),
            None if *from == StageMode::Solo => Effect::None,
            _ => Effect::Enter(Excursion::Snake),
        },
        Command::Exam(_) => Effect::Enter(Excursion::Exam),
        Command::Body(_) => Effect::Enter(Excursion::Body),
        Command::Stage(ShowGeneration(_)) | Command::Lesson(_) => Effect::Forget,
        _ => Effect::None,
    }
}

impl StageParams<'_, '_> {
    /// Returns the scene before a command. The lanes are copied only when the command begins an excursion.
    pub(super) fn scene(&self, camera: &CameraRig) -> LeftScene {
        LeftScene {
            mode: self.mode.clone(),
            lanes: Vec::new(),
            playback: self.playback.clone(),
            camera: camera.clone(),
            selected: (self.selection.lane, self.selection.limb),
            following: self.following.clone(),
        }
    }

    /// Sends what a command shows to the stage, or brings back an earlier scene if the command ends an excursion. `left`
    /// is the scene before the command: see [`Self::scene`]. `before` and `after` tell which of [`FRAMES`] were open
    /// before and after the command. Returns whether the stage gets other lanes.
    pub(super) fn finish(
        &mut self,
        command: &Command,
        left: LeftScene,
        (before, after): ([bool; 2], [bool; 2]),
        camera: &mut CameraRig,
    ) -> bool {
        let shown = self.pending.take();
        let mode = shown.as_ref().map(|show| &show.mode);
        let changed =
            FRAMES.into_iter().enumerate().find(|(index, _)| before[*index] != after[*index]);
        let effect = match changed {
            // A lesson ends a presentation, and returns to the scene before it.
            Some((_, frame)) if (before, after) == ([true, false], [false, true]) => {
                self.way_back.turn(frame, Excursion::Lesson);
                Effect::None
            }
            Some((index, frame)) if after[index] => Effect::Enter(frame),
            Some((_, frame)) => Effect::Leave(frame),
            None => effect(command, &self.mode, mode, &self.way_back),
        };
        match effect {
            Effect::None => {}
            Effect::Enter(excursion) => {
                let lanes = &self.lanes;
                self.way_back.enter(excursion, || {
                    let lanes = lanes.iter().map(|(_, lane)| lane.kept()).collect();
                    LeftScene { lanes, ..left }
                });
            }
            Effect::Leave(excursion) => {
                if let Some(scene) = self.way_back.leave(excursion) {
                    self.bring_back(scene, camera);
                    return true;
                }
            }
            Effect::Settle => self.way_back.settle(),
            Effect::Forget => self.way_back.forget(),
        }
        let is_other = shown.is_some();
        self.show.write_batch(shown);
        is_other
    }
}
