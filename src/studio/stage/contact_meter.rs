//! Readings of contacts over a short span of simulated time, calm enough to be read while a snake moves.
//!
//! A meter only reads the world, at most sixty times per simulated second, and never changes it.

use std::collections::{BTreeSet, VecDeque};

use super::replay::Replay;
use crate::world::{ContactPatch, SurfaceDamping, TouchedSurface};

/// Span of simulated time over which readings are taken, in seconds.
pub(crate) const SPAN_S: f32 = 0.25;
/// Time for which a reading stays while the stage plays, in simulated seconds: digits that change with each frame
/// cannot be read.
const HOLD_S: f32 = 0.125;
/// Samples per simulated second, unless there are fewer steps.
const SAMPLES_PER_S: u32 = 60;

/// Contacts of the last moments.
#[derive(Debug)]
pub(crate) struct ContactMeter {
    samples: VecDeque<ContactSample>,
    /// Physics steps from one sample to the next.
    every_steps: u32,
    span_steps: u32,
    hold_steps: u32,
    last_step: u32,
}

/// Contacts after one step.
#[derive(Debug)]
struct ContactSample {
    step: u32,
    patches: Vec<ContactPatch>,
    damping: Vec<SurfaceDamping>,
}

/// What limbs do on a surface, over [`SPAN_S`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SurfaceReading {
    /// Number of limbs that touched it.
    pub limbs: usize,
    /// Speed of the contacts along the surface, in m/s: the mean over time and limbs, weighted by the normal force, so
    /// that a limb that only grazes the surface counts little.
    pub slip_m_s: f32,
    /// Largest speed of a point of contact along the surface, in m/s.
    pub top_slip_m_s: f32,
    /// Share of the friction that was used, from 0 to 1: the mean over time and limbs, weighted by the friction
    /// that each contact could give. `None` without friction.
    pub grip_share: Option<f32>,
    /// Greatest depth to which a limb has sunk in, in metres.
    pub depth_m: f32,
    /// Mean power lost to friction and to the damping of the surface, in W.
    pub lost_w: f32,
}

impl ContactMeter {
    /// An empty meter for a simulation with this number of physics steps per second.
    pub fn new(steps_per_s: u32) -> Self {
        let steps = |time_s: f32| ((time_s * steps_per_s as f32) as u32).max(1);
        Self {
            samples: VecDeque::new(),
            every_steps: (steps_per_s / SAMPLES_PER_S).max(1),
            span_steps: steps(SPAN_S),
            hold_steps: steps(HOLD_S),
            last_step: 0,
        }
    }

    /// Forgets everything, before a jump. Returns the number of steps that must be noted before the moment of the jump
    /// for its readings to be complete.
    pub fn restart(&mut self) -> u32 {
        self.samples.clear();
        self.last_step = 0;
        self.lead_steps()
    }

    fn lead_steps(&self) -> u32 {
        self.span_steps + self.hold_steps
    }

    /// Notes the contacts of a replay after a step on the way to the step `target`, unless they will be too old by then.
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

    /// Reading of the surfaces for which `is_meant` holds; `None` if no limb has touched them. While the stage plays,
    /// it changes eight times per simulated second; paused, it is that of the shown moment.
    pub fn surface(
        &self,
        is_playing: bool,
        is_meant: impl Fn(TouchedSurface) -> bool,
    ) -> Option<SurfaceReading> {
        let is_damping = |loss: &SurfaceDamping| is_meant(loss.touched);
        self.reading(is_playing, |patch| is_meant(patch.touched), is_damping)
    }

    /// The same for one limb, without the damping of surfaces.
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
        // Sticking contacts tremble by tiny amounts in both directions.
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
mod tests {
    use super::*;
    use crate::save::{load_preset, shipped_champion};
    use crate::studio::stage::lane::Lane;
    use crate::studio::stage::staged_champion::StagedChampion;

    /// The shipped champion, on the surface of a preset if one is named.
    fn lane(preset: Option<&str>) -> Lane {
        let staged = StagedChampion::from_file(&shipped_champion().expect("well formed"), 0, "one");
        let Some(preset) = preset else { return Lane::new(staged, 0) };
        let mut trial = staged.trial().clone();
        trial.surface = load_preset(preset).expect("shipped").settings.trial.surface;
        Lane::new(staged.in_world(&trial, preset.to_owned()), 0)
    }

    fn reading(lane: &Lane) -> Option<SurfaceReading> {
        lane.readings().meter.surface(false, |_| true)
    }

    #[test]
    fn a_jump_gives_the_readings_of_playing_to_the_same_moment() {
        let (mut played, mut sought) = (lane(None), lane(None));
        sought.finish_lookahead();
        let mut seen = 0;
        for step in 1..=600 {
            played.show(f64::from(step) / 60.0, None, 3000).expect("healthy");
        }
        for back in 0..30 {
            let time_s = 10.0 - f64::from(back) / 3.0;
            let mut again = lane(None);
            again.show(time_s, None, 3000).expect("healthy");
            sought.show(time_s, None, 3000).expect("healthy");
            for is_playing in [false, true] {
                let of = |lane: &Lane| lane.readings().meter.surface(is_playing, |_| true);
                assert_eq!(of(&sought), of(&again), "at {time_s} s");
            }
            if back == 0 {
                assert_eq!(reading(&sought), reading(&played));
            }
            assert_eq!(sought.readings().energy_lost, again.readings().energy_lost);
            seen += usize::from(reading(&sought).is_some());
        }
        assert!(seen > 15, "it touches something at {seen} moments");
    }

    #[test]
    fn while_the_stage_plays_a_reading_stays_for_an_eighth_of_a_second() {
        let mut lane = lane(None);
        let (mut held, mut fresh) = (0, 0);
        let mut before = (None, None);
        for step in 1..=240 {
            lane.show(f64::from(step) / 60.0, None, 3000).expect("healthy");
            let meter = &lane.readings().meter;
            let now = (meter.surface(true, |_| true), meter.surface(false, |_| true));
            held += usize::from(now.0 != before.0);
            fresh += usize::from(now.1 != before.1);
            before = now;
        }
        assert!((15..=35).contains(&held), "{held} changes in 4 s");
        assert!(fresh > 2 * held, "{fresh} changes without holding");
    }

    #[test]
    fn ice_uses_nearly_all_grip_glue_little_and_mud_is_dented_and_takes_energy() {
        let over_time = |preset: Option<&str>, friction: Option<f32>| {
            let mut lane = lane(preset);
            if let Some(friction) = friction {
                let mut trial = lane.trial().clone();
                trial.surface.friction = friction;
                lane = Lane::new(lane.staged().in_world(&trial, "changed".to_owned()), 0);
            }
            let mut readings = Vec::new();
            for quarter in 1..=56 {
                lane.show(f64::from(quarter) / 4.0, None, 3000).expect("healthy");
                readings.extend(reading(&lane));
            }
            let mean = |of: fn(&SurfaceReading) -> f32| {
                readings.iter().map(of).sum::<f32>() / readings.len() as f32
            };
            [
                mean(|one| one.grip_share.unwrap_or(0.0)),
                mean(|one| one.depth_m),
                mean(|one| one.lost_w),
            ]
        };
        let (own, ice, mud) =
            (over_time(None, None), over_time(Some("ice"), None), over_time(Some("mud"), None));
        let glue = over_time(None, Some(5.0));
        assert!(ice[0] > 0.85 && own[0] < 0.85 && glue[0] < 0.4, "{ice:?} {own:?} {glue:?}");
        assert!(mud[1] > 0.2 && own[1] < 0.05, "{mud:?} {own:?}");
        assert!(mud[2] > 3.0 * own[2], "{mud:?} {own:?}");
    }

    #[test]
    fn the_fine_print_of_a_limb_covers_only_that_limb() {
        let mut lane = lane(Some("mud"));
        lane.show(1.0, None, 3000).expect("healthy");
        let meter = &lane.readings().meter;
        let all = meter.surface(false, |_| true).expect("it lies in mud");
        let limbs: Vec<_> = (0..5).filter_map(|limb| meter.limb(false, limb, |_| true)).collect();
        let deepest_m = limbs.iter().map(|limb| limb.depth_m).fold(0.0, f32::max);
        assert!(limbs.len() > 2 && limbs.iter().all(|limb| limb.limbs == 1), "{limbs:?}");
        assert_eq!(deepest_m, all.depth_m);
        assert_eq!(meter.surface(false, |touched| touched == TouchedSurface::Limb(0)), None);
    }

    #[test]
    fn a_fast_step_rate_takes_no_more_samples() {
        let mut trial = lane(None).trial().clone();
        trial.physics.steps_per_s = 960;
        let mut lane = Lane::new(lane(None).staged().in_world(&trial, "fine".to_owned()), 0);
        lane.show(2.0, None, 3000).expect("healthy");
        let samples = lane.readings().meter.samples.len();
        assert!((20..=25).contains(&samples), "{samples} samples of 0.375 s");
    }
}
