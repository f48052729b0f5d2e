//! Readings of contacts, averaged over a short span of simulated time so that they can be read while a snake moves.
//!
//! A meter reads the world at most sixty times per simulated second, and never changes it.

use std::collections::{BTreeSet, VecDeque};

use super::replay::Replay;
use snakes_core::world::{ContactPatch, SurfaceDamping, TouchedSurface};

/// Span of simulated time over which contacts are averaged, in seconds.
pub(crate) const SPAN_S: f32 = 0.25;
/// Time for which a reading is kept while the stage plays, in simulated seconds. Digits that change in every frame
/// cannot be read.
const HOLD_S: f32 = 0.125;
/// Samples per simulated second; fewer if there are fewer physics steps.
const SAMPLES_PER_S: u32 = 60;

/// Samples of the latest contacts of a lane.
#[derive(Debug, Clone, Default)]
pub(crate) struct ContactMeter {
    samples: VecDeque<ContactSample>,
    /// Number of physics steps from one sample to the next.
    every_steps: u32,
    span_steps: u32,
    hold_steps: u32,
    last_step: u32,
}

/// Contacts after one physics step.
#[derive(Debug, Clone)]
struct ContactSample {
    step: u32,
    patches: Vec<ContactPatch>,
    damping: Vec<SurfaceDamping>,
}

/// Readings of the contacts between limbs and a surface, over [`SPAN_S`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SurfaceReading {
    /// Number of limbs that touched the surface.
    pub limbs: usize,
    /// Speed of the contacts along the surface, in m/s: the mean over time and limbs, weighted by the normal force, so
    /// that a limb that merely grazes the surface has little influence.
    pub slip_m_s: f32,
    /// Largest speed of a point of contact along the surface, in m/s.
    pub top_slip_m_s: f32,
    /// Used share of the available friction, from 0 to 1: the mean over time and limbs, weighted by the friction
    /// available at each contact. `None` without friction.
    pub grip_share: Option<f32>,
    /// Greatest depth of a limb below the surface, in metres.
    pub depth_m: f32,
    /// Mean power lost to friction and to the damping of the surface, in W.
    pub lost_w: f32,
}

impl ContactMeter {
    /// Creates an empty meter for a simulation with this number of physics steps per second.
    pub fn new(steps_per_s: u32) -> Self {
        let steps = |time_s: f32| ((time_s * steps_per_s as f32) as u32).max(1);
        Self {
            every_steps: (steps_per_s / SAMPLES_PER_S).max(1),
            span_steps: steps(SPAN_S),
            hold_steps: steps(HOLD_S),
            ..Self::default()
        }
    }

    /// Discards all samples, before a jump in time. Returns how many steps before the target of the jump must be noted
    /// for complete readings.
    pub fn restart(&mut self) -> u32 {
        self.samples.clear();
        self.last_step = 0;
        self.lead_steps()
    }

    fn lead_steps(&self) -> u32 {
        self.span_steps + self.hold_steps
    }

    /// Samples the contacts of a replay after a step, on the way to the step `target`. Skips samples that will be too old at the target.
    pub fn note(&mut self, replay: &Replay, target: u32) {
        let Some(simulation) = replay.simulation() else { return };
        self.last_step = replay.step();
        let (step, lead_steps) = (self.last_step, self.lead_steps());
        if !step.is_multiple_of(self.every_steps) || step + lead_steps < target {
            return;
        }
        while self.samples.front().is_some_and(|sample| sample.step + lead_steps < step) {
            self.samples.pop_front();
        }
        self.samples.push_back(ContactSample {
            step,
            patches: simulation.contact_patches(),
            damping: simulation.surface_damping().collect(),
        });
    }

    /// Returns the reading of the surfaces for which `is_meant` holds; `None` if no limb has touched them. While the stage plays, the
    /// reading changes eight times per simulated second. While paused, it is that of the displayed time.
    pub fn surface(
        &self,
        is_playing: bool,
        is_meant: impl Fn(TouchedSurface) -> bool,
    ) -> Option<SurfaceReading> {
        let is_damping = |loss: &SurfaceDamping| is_meant(loss.touched);
        self.reading(is_playing, |patch| is_meant(patch.touched), is_damping)
    }

    /// Returns the reading of one limb on the surfaces for which `is_meant` holds, without the damping of surfaces;
    /// `None` if the limb has not touched them. While the stage plays, the reading changes eight times per simulated
    /// second. While paused, it is that of the displayed time.
    pub fn limb(
        &self,
        is_playing: bool,
        limb: usize,
        is_meant: impl Fn(TouchedSurface) -> bool,
    ) -> Option<SurfaceReading> {
        let touches = |patch: &ContactPatch| {
            let is_limb = patch.limb == limb || patch.touched == TouchedSurface::Limb(limb);
            is_limb && is_meant(patch.touched)
        };
        self.reading(is_playing, touches, |_| false)
    }

    fn reading(
        &self,
        is_playing: bool,
        is_meant: impl Fn(&ContactPatch) -> bool,
        is_damping: impl Fn(&SurfaceDamping) -> bool,
    ) -> Option<SurfaceReading> {
        let end = match self.last_step {
            step if is_playing => step - step % self.hold_steps,
            step => step,
        };
        let in_span = |step: u32| step <= end && step + self.span_steps > end;
        let mut touching = BTreeSet::new();
        let (mut top_slip_m_s, mut depth_m) = (0.0_f32, 0.0_f32);
        let (mut slip_w, mut pressed_n) = (0.0, 0.0);
        let (mut samples, mut used_n, mut limit_n, mut lost_w) = (0.0, 0.0, 0.0, 0.0);
        for sample in self.samples.iter().filter(|sample| in_span(sample.step)) {
            samples += 1.0;
            for patch in sample.patches.iter().filter(|patch| is_meant(patch)) {
                touching.insert(patch.limb);
                if let TouchedSurface::Limb(other) = patch.touched {
                    touching.insert(other);
                }
                top_slip_m_s = top_slip_m_s.max(patch.slip_m_s);
                slip_w += patch.slip_m_s * patch.normal_n;
                pressed_n += patch.normal_n;
                depth_m = depth_m.max(patch.depth_m);
                used_n += patch.grip_share * patch.friction_limit_n;
                limit_n += patch.friction_limit_n;
                lost_w += patch.friction_w;
            }
            let damping = sample.damping.iter().filter(|loss| is_damping(loss));
            lost_w += damping.map(|loss| loss.power_w).sum::<f32>();
        }
        let grip_share = (limit_n > 0.0).then(|| used_n / limit_n);
        // Sticking contacts vibrate slightly in both directions, so the sum can be slightly negative.
        let lost_w = (lost_w / samples).max(0.0);
        (!touching.is_empty()).then_some(SurfaceReading {
            limbs: touching.len(),
            slip_m_s: slip_w / pressed_n,
            top_slip_m_s,
            grip_share,
            depth_m,
            lost_w,
        })
    }
}

#[cfg(test)]
mod tests;
