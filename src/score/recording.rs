//! What a rollout looked like: enough poses to play it again where other bits are computed.

use super::{Rollout, Trial};
use crate::genome::Genome;
use crate::world::Pose;

/// The poses of a rollout at equal distances of time. Between them it is interpolated.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    every_steps: u32,
    limbs: usize,
    /// Frame by frame, in each the limbs from the head.
    poses: Vec<Pose>,
}

/// A recording has at least so many frames in a simulated second, unless it would grow too large.
const FRAMES_PER_S: u32 = 30;

impl Recording {
    /// The most poses in a recording: twelve limbs for four and a half minutes, at 30 frames a second.
    pub const MOST_POSES: usize = 100_000;

    /// Frames of `limbs` poses each, `every_steps` physics steps apart, the start first. None, if there is
    /// not at least one whole frame, or no distance between frames.
    pub fn new(every_steps: u32, limbs: usize, poses: Vec<Pose>) -> Option<Self> {
        let is_whole = limbs > 0 && !poses.is_empty() && poses.len().is_multiple_of(limbs);
        (every_steps > 0 && is_whole).then_some(Self { every_steps, limbs, poses })
    }

    /// Records a rollout of a genome. Both must have passed their checks.
    pub fn of(genome: &Genome, trial: &Trial) -> Self {
        let every_steps = distance_steps(trial);
        let mut rollout = Rollout::new(genome, trial);
        let limbs = rollout.poses().len();
        let mut poses = rollout.poses().to_vec();
        while rollout.advance() {
            if rollout.step().is_multiple_of(every_steps) {
                poses.extend_from_slice(rollout.poses());
            }
        }
        Self { every_steps, limbs, poses }
    }

    /// Physics steps from one frame to the next.
    pub fn every_steps(&self) -> u32 {
        self.every_steps
    }

    /// Limbs in each frame.
    pub fn limbs(&self) -> usize {
        self.limbs
    }

    /// Frames from the start on, each with the limbs from the head.
    pub fn frames(&self) -> impl ExactSizeIterator<Item = &[Pose]> {
        self.poses.chunks_exact(self.limbs)
    }

    /// The poses at a moment, in physics steps from the start; after the last frame, the last.
    pub fn at(&self, step: f32) -> Vec<Pose> {
        let place = (step / self.every_steps as f32).max(0.0);
        let last = self.frames().len() - 1;
        let before = (place as usize).min(last);
        let share = place - before as f32;
        let frame = |index: usize| &self.poses[index * self.limbs..][..self.limbs];
        if share == 0.0 || before == last {
            return frame(before).to_vec();
        }
        let pairs = frame(before).iter().zip(frame(before + 1));
        pairs.map(|(before, after)| before.lerp(after, share)).collect()
    }
}

/// How many steps apart the frames of a trial's recording are.
fn distance_steps(trial: &Trial) -> u32 {
    let wanted = (trial.physics.steps_per_s / FRAMES_PER_S).max(1);
    let most_frames = (Recording::MOST_POSES / trial.agent.limbs as usize) as u32;
    // The frame at the start is one of them.
    wanted.max(trial.steps().div_ceil(most_frames.saturating_sub(1).max(1)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::GenomeSpace;
    use crate::rng::{Purpose, stream};

    fn newborn(trial: &Trial) -> Genome {
        let mut rng = stream(1, 1, 0, Purpose::Birth);
        GenomeSpace::default().birth(trial.descent(), &mut rng)
    }

    #[test]
    fn a_recording_goes_through_the_rollouts_poses() {
        let trial = Trial { duration_s: 1.0, ..Trial::default() };
        let genome = newborn(&trial);
        let recording = Recording::of(&genome, &trial);
        assert_eq!((recording.every_steps(), recording.frames().len()), (2, 31));
        let mut rollout = Rollout::new(&genome, &trial);
        for step in 0..=60 {
            let seen = recording.at(step as f32);
            let distance = (seen[2].translation - rollout.poses()[2].translation).length();
            // Between two frames a limb may have hit a step.
            let most_m = if step % 2 == 0 { 1e-6 } else { 0.05 };
            assert!(distance < most_m, "{distance} m at step {step}");
            rollout.advance();
        }
        assert_eq!(recording.at(1.0e9), rollout.poses(), "after the end, the end");
    }

    #[test]
    fn a_long_recording_has_fewer_frames() {
        let mut trial = Trial { duration_s: 600.0, ..Trial::default() };
        trial.physics.steps_per_s = 1000;
        trial.agent.limbs = 12;
        let frames = trial.steps() / distance_steps(&trial) + 1;
        assert!((8000..=8333).contains(&frames), "{frames}");
        let poses = vec![Pose::IDENTITY; 6];
        assert_eq!(Recording::new(2, 4, poses.clone()), None, "no whole frames");
        assert_eq!(Recording::new(0, 3, poses), None);
    }
}
