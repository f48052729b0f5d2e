//! A lane of the stage: one snake on its stairs, displayed at the time of the stage's clock.
//!
//! A replay has one lane, a what-if two to five, a race several. The rollout advances by whole physics steps of
//! constant length; the clock only determines how many. The limbs are drawn between the last two steps.

mod progress;
mod renewed;

pub(crate) use progress::AT_THE_TOP;

use std::sync::Arc;

use bevy::prelude::*;
use bevy_rapier3d::prelude::RapierContextSimulation;

use super::readings::Readings;
use super::replay::Replay;
use super::staged_champion::StagedChampion;
use snakes_core::score::{Evaluation, KeyframeHistory, Trial};
use snakes_core::world::{BodyPlan, Pose, Pull, Vector};
use snakes_lab::run::{Lookahead, caught};

/// A lane of the stage, with the rollout that is scored.
#[derive(Component)]
#[require(RapierContextSimulation)]
pub(crate) struct Lane {
    /// Champion in the lane.
    pub staged: StagedChampion,
    /// Body of the snake: number, sizes and joints of its limbs.
    pub body: BodyPlan,
    /// Index of the lane; the first is 0.
    pub number: usize,
    /// Offset of the lane's world along x, in metres.
    pub offset_x_m: f32,
    /// Whether the lane has the place of another lane and is drawn translucent, without stairs.
    pub is_ghost: bool,
    /// Replay of the snake, at its last step.
    pub replay: Replay,
    pub(super) lookahead: Lookahead,
    /// Step at which the snake of a recording first stood on the landing; `None` for a simulation.
    recorded_landing: Option<u32>,
    /// Poses of the parts before the last step, from head to tail.
    before: Vec<Pose>,
    /// Displayed fraction of the last step, from 0 to 1, for the interpolation of poses.
    share: f32,
    /// Length of a physics step, in seconds.
    pub step_s: f64,
    /// Contacts, torques and joints after the last step.
    pub readings: Readings,
    /// Path of the middle limb since the first pull by the mouse, in metres.
    detour_m: Vec<Vector>,
    /// Whether simulating the lane panicked. The lane then keeps its last state.
    is_broken: bool,
    /// Whether the final state has been compared with the champion's record.
    is_checked: bool,
    /// Whether the lane came back with an earlier scene, so that camera and selection stay as they were.
    pub is_back: bool,
}

/// Maximum physics steps per frame, as a sum over all lanes (about 60 ms on one core).
pub(crate) const MAX_STEPS_PER_FRAME: u32 = 3000;
/// Tolerance as a fraction of a step, within which a time counts as exactly on the step.
const ON_STEP: f32 = 1.0e-4;

impl Lane {
    /// Creates a lane at the start of a replay. The lookahead immediately begins to compute the rest of the rollout.
    pub fn new(staged: StagedChampion, number: usize) -> Self {
        let lookahead = match staged.recording() {
            // A recording needs no lookahead.
            Some(_) => Lookahead::default(),
            None => Lookahead::of(staged.rollout()),
        };
        Self::with(staged, number, lookahead)
    }

    /// Creates a ghost at the start of a replay: a lane that is drawn translucent in the place of another lane, without
    /// stairs. Ghosts have no lookahead, because dozens of its threads would slow the run down.
    pub fn ghost(staged: StagedChampion, number: usize) -> Self {
        Self { is_ghost: true, ..Self::with(staged, number, Lookahead::default()) }
    }

    fn with(staged: StagedChampion, number: usize, lookahead: Lookahead) -> Self {
        let replay = Replay::of(&staged);
        Self {
            recorded_landing: replay.recorded_landing(&staged.trial().stairs),
            before: replay.poses().to_vec(),
            step_s: 1.0 / f64::from(staged.trial().physics.steps_per_s),
            lookahead,
            body: staged.body(),
            readings: Readings::new(&replay, staged.trial().physics.steps_per_s),
            staged,
            number,
            offset_x_m: 0.0,
            is_ghost: false,
            share: 1.0,
            replay,
            detour_m: Vec::new(),
            is_broken: false,
            is_checked: false,
            is_back: false,
        }
    }

    /// Turns the lane into a ghost.
    #[cfg(test)]
    pub fn into_ghost(self) -> Self {
        Self { is_ghost: true, ..self }
    }

    /// Returns the offset of the lane's world along x, in metres.
    pub fn offset(&self) -> Vec3 {
        Vec3::new(self.offset_x_m, 0.0, 0.0)
    }

    /// Returns the trial that the lane shows.
    pub fn trial(&self) -> &Trial {
        self.staged.trial()
    }

    /// Returns the end of the lane, in simulated seconds: the time of disqualification, if it is known, or else the end of the trial.
    pub fn end_s(&self) -> f64 {
        let steps = match self.history() {
            _ if self.replay.is_over() => self.replay.step(),
            Some(history) if !self.replay.is_disturbed() => history.evaluation().steps,
            _ => self.replay.last_step(),
        };
        f64::from(steps) * self.step_s
    }

    /// Returns the evaluation of the rollout so far. At the end of the rollout, this is the final score.
    pub fn evaluation(&self) -> Evaluation {
        self.replay.evaluation(&self.staged)
    }

    /// Returns the precomputed history of the rollout, or `None` until the lookahead has finished. A recording has none.
    pub fn history(&self) -> Option<&Arc<KeyframeHistory>> {
        self.lookahead.history()
    }

    /// Returns the progress of the lookahead from 0 to 1, or `None` if it is not running.
    pub fn lookahead_share(&self) -> Option<f32> {
        let steps = self.lookahead.steps_done()?;
        Some(steps as f32 / self.replay.last_step().max(1) as f32)
    }

    /// Returns the path of the middle limb so far, in metres, in lane coordinates.
    pub fn trail_m(&self) -> Vec<Vector> {
        if let Some(way) = self.replay.recorded_way_m() {
            return way;
        }
        let undisturbed = self.history().map_or(&[][..], |history| {
            let steps = (self.replay.step() as usize).saturating_sub(self.detour_m.len());
            let shown = steps / history.sample_steps() as usize + 1;
            &history.middles_m()[..shown.min(history.middles_m().len())]
        });
        undisturbed.iter().chain(&self.detour_m).copied().collect()
    }

    /// Returns the poses to draw, interpolated between the last two steps, from head to tail, in lane coordinates.
    pub fn drawn_poses(&self) -> impl ExactSizeIterator<Item = Pose> + '_ {
        let pairs = self.before.iter().zip(self.replay.poses());
        // If the stage is paused on a step, the poses are exactly those of the step.
        let is_on_step = self.share > 1.0 - ON_STEP;
        pairs.map(
            move |(before, after)| {
                if is_on_step { *after } else { before.lerp(after, self.share) }
            },
        )
    }

    /// Returns the drawn position of the middle limb's centre, in metres, in lane coordinates.
    pub fn drawn_middle(&self) -> Vec3 {
        self.drawn_poses().nth(self.body.middle_part).map_or(Vec3::ZERO, |pose| pose.translation)
    }

    /// Converts a point from a part's frame after the last step to lane coordinates, in metres.
    pub fn point_of(&self, part: usize, in_part_m: Vector) -> Vector {
        self.replay.poses().get(part).map_or(in_part_m, |pose| *pose * in_part_m)
    }

    /// Returns the speed of the middle limb during the last step, in m/s.
    pub fn speed_m_s(&self) -> f32 {
        let mut ends = self.before.iter().zip(self.replay.poses());
        ends.nth(self.body.middle_part).map_or(0.0, |(before, after)| {
            before.translation.distance(after.translation) / self.step_s as f32
        })
    }

    /// Returns the time of the first landing, in simulated seconds, if the snake has landed by `time_s`.
    pub fn landed_s(&self, time_s: f64) -> Option<f64> {
        let known = self.history().filter(|_| !self.replay.is_disturbed());
        let step = known.and_then(|history| history.landed_at_step()).or(self.recorded_landing)?;
        let landed_s = f64::from(step) * self.step_s;
        (landed_s <= time_s).then_some(landed_s)
    }

    /// Returns true only once, when an undisturbed replay first reaches its end.
    pub fn has_just_ended(&mut self) -> bool {
        let has_ended = self.replay.is_over() && !self.replay.is_disturbed() && !self.is_checked;
        self.is_checked |= has_ended;
        has_ended
    }

    /// Blocks until the lookahead has finished.
    pub fn finish_lookahead(&mut self) {
        self.lookahead.wait();
    }

    /// Advances or rewinds the lane to a time, in simulated seconds, or towards it by at most `most_steps` physics steps.
    ///
    /// # Errors
    /// Simulating the lane panicked. The lane keeps its last state.
    pub fn show(&mut self, time_s: f64, pull: Option<Pull>, most_steps: u32) -> Result<(), String> {
        if self.is_broken {
            return Ok(());
        }
        let (step, share) = self.moment(time_s);
        self.share = share;
        let now = self.replay.step();
        let is_at_end = self.replay.is_over() && step > now;
        if step == now || is_at_end {
            return Ok(());
        }
        let known = self.history().cloned();
        // A jump is only faster if a keyframe lies between the current step and the target.
        let pays = |history: &Arc<KeyframeHistory>| {
            !self.replay.is_disturbed() && pull.is_none() && history.keyframe_before(step) > now
        };
        let jumps = step < now || known.as_ref().is_some_and(pays);
        let is_on_its_way = known.is_none() && self.lookahead_share().is_some();
        if step < now && is_on_its_way && step > MAX_STEPS_PER_FRAME {
            // The lookahead is already computing these steps, so the lane waits for it instead of repeating the work.
            return Ok(());
        }
        let result = caught(|| {
            // A long distance is covered in several frames.
            if jumps && known.is_none() {
                self.jump(step.min(most_steps), None);
            } else if jumps {
                self.jump(step, known.as_deref());
            } else {
                self.replay.pull(pull);
                self.go_on(step.min(now + most_steps));
            }
        });
        self.readings.update(&self.replay);
        self.is_broken = result.is_err();
        result
    }

    /// Returns the last step that has begun at a time, and the elapsed fraction of the step.
    pub fn moment(&self, time_s: f64) -> (u32, f32) {
        // Rounding can shift a time slightly off its step.
        let place = time_s / self.step_s;
        let step = libm::ceil(place - f64::from(ON_STEP)).max(0.0);
        let share = if step == 0.0 { 1.0 } else { 1.0 - (step - place) };
        let last = self.replay.last_step();
        if step > f64::from(last) {
            (last, 1.0)
        } else {
            (step as u32, share.clamp(0.0, 1.0) as f32)
        }
    }

    fn go_on(&mut self, step: u32) {
        let mut earlier = self.before.clone();
        while self.replay.step() < step && !self.replay.is_over() {
            let now = self.replay.step();
            earlier.copy_from_slice(&self.before);
            self.before.copy_from_slice(self.replay.poses());
            let goes_on = self.replay.advance();
            if self.replay.step() == now {
                // A step that breaks a limit does not count, so the last step is the one before.
                self.before.copy_from_slice(&earlier);
            }
            if goes_on && !self.is_ghost {
                self.readings.meter.note(&self.replay, step);
            }
            if goes_on && self.replay.is_disturbed() {
                let middle = self.replay.poses()[self.body.middle_part].translation;
                self.detour_m.push(middle);
            }
        }
        if self.replay.is_over() {
            self.share = 1.0;
        }
    }

    fn jump(&mut self, step: u32, history: Option<&KeyframeHistory>) {
        self.detour_m.clear();
        // The meter samples the steps just before the target.
        let noted = self.readings.meter.restart();
        self.replay.go_to(step.saturating_sub(noted), &self.staged, history);
        self.before.copy_from_slice(self.replay.poses());
        self.go_on(step);
    }

    /// Advances a lane outside the stage to a time in simulated seconds, for a picture.
    pub fn skip_to(&mut self, time_s: f64) {
        let (step, share) = self.moment(time_s);
        self.share = share;
        self.go_on(step);
        self.readings.update(&self.replay);
    }

    /// Advances to the end of the rollout. Returns the poses at `moments` times, equally spaced from the start.
    pub fn skip_to_end(&mut self, moments: u32) -> Vec<Vec<Pose>> {
        let last = self.replay.last_step();
        let every = (last / moments.max(1)).max(1);
        let mut seen = Vec::new();
        for moment in 0..moments {
            self.go_on(moment * every);
            seen.push(self.replay.poses().to_vec());
        }
        self.go_on(last);
        seen
    }
}
