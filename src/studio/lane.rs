//! A lane of the stage: one snake on its stairs, shown at the moment of the stage's clock.
//!
//! Replay, race and what-if are one, many and two lanes. Between frames a lane's physics world lives in a
//! bevy_rapier3d context on its entity, so that debug drawing sees the very bodies that are scored. To advance, the world is lent back to the rollout, which takes whole constant steps; the clock only decides how
//! many. What is drawn lies between the last two steps.

use std::sync::Arc;

use bevy::prelude::*;

use super::exhibit::Exhibit;
use super::performance::{Context, Performance};
use crate::run::{Lookahead, caught};
use crate::score::{Evaluation, History, Trial};
use crate::world::{ContactForce, JointState, JointTorque, Pose, Pull, Vector};

/// A lane. Its entity carries the physics context.
#[derive(Component)]
pub(super) struct Lane {
    exhibit: Exhibit,
    /// Which one it is; the first is 0.
    number: usize,
    /// How far along x it is from where its world thinks it is, in metres.
    offset_x_m: f32,
    performance: Performance,
    lookahead: Lookahead,
    /// Of a recording: after which step it first stood on the landing.
    recorded_landing: Option<u32>,
    /// Poses before the last step, head first.
    before: Vec<Pose>,
    /// How much of the last step has been shown, from 0 to 1.
    share: f32,
    step_s: f64,
    /// What was read off after the last step.
    readings: Readings,
    /// Where the middle limb was since a hand first interfered, in metres.
    detour_m: Vec<Vector>,
    /// Whether the program failed on it: it stays as it was then.
    is_broken: bool,
    /// Whether the end was compared with what was recorded of the champion.
    is_checked: bool,
}

/// What can be read off a world after a step; the world itself is in its context.
#[derive(Debug, Clone, Default)]
pub(super) struct Readings {
    /// What ground and stairs do to the limbs.
    pub contacts: Vec<ContactForce>,
    /// The torques on the joints, from the head.
    pub torques: Vec<JointTorque>,
    /// How the joints stand, from the head.
    pub joints: Vec<JointState>,
    /// How fast the limbs' centres are, head first, in m/s.
    pub speeds_m_s: Vec<f32>,
}

/// So many steps a frame may simulate over all lanes without being felt: some 60 ms of a core.
pub(super) const MOST_STEPS_A_FRAME: u32 = 3000;
/// A moment that is nearer to a step than this share of a step is meant to be on it.
const ON_STEP: f32 = 1.0e-4;

impl Lane {
    /// A lane at the start of an exhibit's performance. What will happen in it is worked out from now on.
    pub fn new(exhibit: Exhibit, number: usize) -> Self {
        let performance = Performance::of(&exhibit);
        let lookahead = match exhibit.recording() {
            // It is known to its end.
            Some(_) => Lookahead::default(),
            None => Lookahead::begin(&exhibit.champion().genome, exhibit.trial()),
        };
        Self {
            recorded_landing: performance.recorded_landing(&exhibit.trial().stairs),
            before: performance.poses().to_vec(),
            step_s: 1.0 / f64::from(exhibit.trial().physics.steps_per_s),
            lookahead,
            performance,
            exhibit,
            number,
            offset_x_m: 0.0,
            share: 1.0,
            readings: Readings::default(),
            detour_m: Vec::new(),
            is_broken: false,
            is_checked: false,
        }
    }

    /// Puts it so far along x from where its world thinks it is.
    pub fn at_x(mut self, offset_x_m: f32) -> Self {
        self.offset_x_m = offset_x_m;
        self
    }

    /// What is on show.
    pub fn exhibit(&self) -> &Exhibit {
        &self.exhibit
    }

    /// Which lane it is; the first is 0.
    pub fn number(&self) -> usize {
        self.number
    }

    /// How far along x it is from where its world thinks it is, in metres.
    pub fn offset(&self) -> Vec3 {
        Vec3::new(self.offset_x_m, 0.0, 0.0)
    }

    /// The trial on show: the stairs to draw, the limbs' sizes.
    pub fn trial(&self) -> &Trial {
        self.exhibit.trial()
    }

    /// Length of a physics step, in seconds.
    pub fn step_s(&self) -> f64 {
        self.step_s
    }

    /// When it ends, in simulated seconds: at the trial's end, or where the agent is disqualified, as far as is known.
    pub fn end_s(&self) -> f64 {
        let steps = if self.performance.is_over() {
            self.performance.step()
        } else {
            match self.history() {
                Some(history) if !self.is_disturbed() => history.evaluation().steps,
                _ => self.performance.last_step(),
            }
        };
        f64::from(steps) * self.step_s
    }

    /// What there is to say of the rollout so far; at its end, the score.
    pub fn evaluation(&self) -> Evaluation {
        self.performance.evaluation(&self.exhibit)
    }

    /// What will happen, once it is known; a recording has no history.
    pub fn history(&self) -> Option<&Arc<History>> {
        self.lookahead.history()
    }

    /// How much of what will happen is worked out, from 0 to 1, while it is on its way.
    pub fn lookahead_share(&self) -> Option<f32> {
        let steps = self.lookahead.steps_done()?;
        Some(steps as f32 / self.performance.last_step().max(1) as f32)
    }

    /// Whether it has come to its end.
    pub fn is_over(&self) -> bool {
        self.performance.is_over()
    }

    /// Whether a hand has interfered: what is seen says nothing of the genome.
    pub fn is_disturbed(&self) -> bool {
        self.performance.is_disturbed()
    }

    /// What was read off after the last step.
    pub fn readings(&self) -> &Readings {
        &self.readings
    }

    /// The middle limb's way so far, in metres, in the lane's own coordinates.
    pub fn trail_m(&self) -> Vec<Vector> {
        if let Some(way) = self.performance.recorded_way_m() {
            return way;
        }
        let undisturbed = self.history().map_or(&[][..], |history| {
            let steps = (self.performance.step() as usize).saturating_sub(self.detour_m.len());
            let shown = steps / history.sample_steps() as usize + 1;
            &history.middles_m()[..shown.min(history.middles_m().len())]
        });
        undisturbed.iter().chain(&self.detour_m).copied().collect()
    }

    /// The limbs' poses between the last two steps, head first, in the lane's own coordinates: where to draw them.
    pub fn drawn_poses(&self) -> impl ExactSizeIterator<Item = Pose> + '_ {
        let pairs = self.before.iter().zip(self.performance.poses());
        // Held on a step, it is exactly that step.
        let is_on_step = self.share > 1.0 - ON_STEP;
        pairs.map(
            move |(before, after)| {
                if is_on_step { *after } else { before.lerp(after, self.share) }
            },
        )
    }

    /// Where the middle limb's centre is drawn, in the lane's own coordinates.
    pub fn drawn_middle(&self) -> Vec3 {
        let mut poses = self.drawn_poses();
        let middle = poses.len() / 2;
        poses.nth(middle).map_or(Vec3::ZERO, |pose| pose.translation)
    }

    /// The limbs' poses after the last step, head first, in the lane's own coordinates.
    pub fn last_poses(&self) -> &[Pose] {
        self.performance.poses()
    }

    /// Where a point of a limb's own frame is after the last step, in the lane's own coordinates.
    pub fn point_of(&self, limb: usize, in_limb_m: Vector) -> Vector {
        self.performance.poses().get(limb).map_or(in_limb_m, |pose| *pose * in_limb_m)
    }

    /// How fast the middle limb is between the last two steps, in m/s.
    pub fn speed_m_s(&self) -> f32 {
        if self.is_over() {
            // It goes nowhere any more.
            return 0.0;
        }
        let middle = self.before.len() / 2;
        match (self.before.get(middle), self.performance.poses().get(middle)) {
            (Some(before), Some(after)) => {
                before.translation.distance(after.translation) / self.step_s as f32
            }
            _ => 0.0,
        }
    }

    /// When it first stood on the landing, in simulated seconds, if that has happened by `time_s`.
    pub fn landed_s(&self, time_s: f64) -> Option<f64> {
        let known = self.history().filter(|_| !self.is_disturbed());
        let step = known.and_then(|history| history.landed_at_step()).or(self.recorded_landing)?;
        let landed_s = f64::from(step) * self.step_s;
        (landed_s <= time_s).then_some(landed_s)
    }

    /// Whether its end is on show for the first time, in an undisturbed performance.
    pub fn has_just_ended(&mut self) -> bool {
        let has_ended = self.performance.is_over() && !self.is_disturbed() && !self.is_checked;
        self.is_checked |= has_ended;
        has_ended
    }

    /// The physics engine's state, if it has not been lent out.
    #[cfg(test)]
    pub fn performance(&self) -> &Performance {
        &self.performance
    }

    /// Takes in what has been worked out meanwhile.
    pub fn look_ahead(&mut self) {
        self.lookahead.poll();
    }

    /// Waits until it is known what will happen.
    pub fn know_what_comes(&mut self) {
        self.lookahead.wait();
    }

    /// Puts its physics world into its context.
    pub fn move_in(&mut self, context: Context<'_>) {
        self.readings = readings_of(&self.performance);
        self.performance.exchange(context);
    }

    /// Shows the lane at a moment, in simulated seconds. The world is borrowed from its context if it has to change.
    ///
    /// # Errors
    /// The program failed on it; it stays as it was then.
    pub fn show(
        &mut self,
        time_s: f64,
        pull: Option<Pull>,
        (simulation, colliders, joints, bodies): Context<'_>,
    ) -> Result<(), String> {
        if self.is_broken {
            return Ok(());
        }
        let (step, share) = self.moment(time_s);
        self.share = share;
        let now = self.performance.step();
        let is_at_end = self.performance.is_over() && step > now;
        if step == now || is_at_end {
            return Ok(());
        }
        let known = self.history().cloned();
        // Without a keyframe on the way it is quicker to go on.
        let pays = |history: &Arc<History>| {
            !self.is_disturbed() && pull.is_none() && history.keyframe_before(step) > now
        };
        let jumps = step < now || known.as_ref().is_some_and(pays);
        let is_on_its_way = known.is_none() && self.lookahead_share().is_some();
        if step < now && is_on_its_way && step > MOST_STEPS_A_FRAME {
            // What is worked out already is not worked out twice: it comes with the next frames.
            return Ok(());
        }
        self.performance.exchange((&mut *simulation, &mut *colliders, &mut *joints, &mut *bodies));
        let result = caught(|| {
            if jumps {
                self.jump(step, known.as_deref());
            } else {
                self.performance.pull(pull);
                // A long way takes several frames.
                self.go_on(step.min(now + MOST_STEPS_A_FRAME));
            }
        });
        self.readings = readings_of(&self.performance);
        self.performance.exchange((simulation, colliders, joints, bodies));
        self.is_broken = result.is_err();
        result
    }

    /// Which step is the last one that has begun at a moment, and how much of it has passed.
    fn moment(&self, time_s: f64) -> (u32, f32) {
        // A moment that is meant to be on a step may be off by a rounding.
        let place = time_s / self.step_s;
        let step = libm::ceil(place - f64::from(ON_STEP)).max(0.0);
        let share = if step == 0.0 { 1.0 } else { 1.0 - (step - place) };
        let last = self.performance.last_step();
        if step > f64::from(last) {
            (last, 1.0)
        } else {
            (step as u32, share.clamp(0.0, 1.0) as f32)
        }
    }

    fn go_on(&mut self, step: u32) {
        while self.performance.step() < step && !self.performance.is_over() {
            self.before.copy_from_slice(self.performance.poses());
            let goes_on = self.performance.advance();
            if goes_on && self.performance.is_disturbed() {
                let middle = self.performance.poses()[self.before.len() / 2].translation;
                self.detour_m.push(middle);
            }
        }
        if self.performance.is_over() {
            self.share = 1.0;
        }
    }

    fn jump(&mut self, step: u32, history: Option<&History>) {
        self.detour_m.clear();
        self.performance.go_to(step.saturating_sub(1), &self.exhibit, history);
        self.before.copy_from_slice(self.performance.poses());
        self.go_on(step);
    }

    /// Goes to a moment of a lane that is not on a stage, for a picture. The world must not have been lent out.
    pub fn skip_to(&mut self, time_s: f64) {
        let (step, share) = self.moment(time_s);
        self.share = share;
        self.go_on(step);
        self.readings = readings_of(&self.performance);
    }

    /// Goes to the end of the rollout at once. Returns the poses on the way at `moments` equal distances
    /// of time, the start first. The world must not have been lent out.
    pub fn skip_to_end(&mut self, moments: u32) -> Vec<Vec<Pose>> {
        let last = self.performance.last_step();
        let every = (last / moments.max(1)).max(1);
        let mut seen = Vec::new();
        for moment in 0..moments {
            self.go_on(moment * every);
            seen.push(self.performance.poses().to_vec());
        }
        self.go_on(last);
        seen
    }
}

/// What can be read off a performance. Its world must not have been lent out.
fn readings_of(performance: &Performance) -> Readings {
    performance.simulation().map_or_else(Readings::default, |simulation| Readings {
        contacts: simulation.contact_forces(),
        torques: simulation.applied_torques().collect(),
        joints: simulation.joint_states().collect(),
        speeds_m_s: simulation.speeds_m_s().collect(),
    })
}
