//! The recorded poses of a rollout, for replay where the engine computes different bits.

use super::{Rollout, Trial};
use crate::genome::Genome;
use crate::world::Pose;

/// The poses of a rollout at equal intervals. Between two frames the poses are interpolated.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    every_steps: u32,
    parts: usize,
    /// Poses frame by frame; in each frame those of the parts from the head.
    poses: Vec<Pose>,
}

/// Number of frames per simulated second, unless the recording would exceed `MOST_POSES`.
const FRAMES_PER_S: u32 = 30;

impl Recording {
    /// Maximum number of poses: enough for twelve limbs during four and a half minutes, at 30 frames per second.
    pub const MOST_POSES: usize = 100_000;

    /// Creates a recording of frames of `parts` poses each, `every_steps` physics steps apart, beginning with the start. `None` if the
    /// poses do not make whole frames, or if `every_steps` is 0.
    pub fn new(every_steps: u32, parts: usize, poses: Vec<Pose>) -> Option<Self> {
        let is_whole = parts > 0 && !poses.is_empty() && poses.len().is_multiple_of(parts);
        (every_steps > 0 && is_whole).then_some(Self { every_steps, parts, poses })
    }

    /// Records a rollout of a genome. Genome and trial must have passed their checks.
    pub fn of(genome: &Genome, trial: &Trial) -> Self {
        let mut rollout = Rollout::new(genome, trial);
        let parts = rollout.body().parts.len();
        let every_steps = steps_between_frames(trial, parts);
        let mut poses = rollout.poses().to_vec();
        while rollout.advance() {
            if rollout.step().is_multiple_of(every_steps) {
                poses.extend_from_slice(rollout.poses());
            }
        }
        Self { every_steps, parts, poses }
    }

    /// Returns the number of physics steps from one frame to the next.
    pub fn every_steps(&self) -> u32 {
        self.every_steps
    }

    /// Returns the number of parts in each frame.
    pub fn parts(&self) -> usize {
        self.parts
    }

    /// Returns the frames from the start on, each with the poses of the parts from the head.
    pub fn frames(&self) -> impl ExactSizeIterator<Item = &[Pose]> {
        self.poses.chunks_exact(self.parts)
    }

    /// Returns the poses at a time, in physics steps from the start. After the last frame, the poses are those of the last frame.
    pub fn at(&self, step: f32) -> Vec<Pose> {
        let position = (step / self.every_steps as f32).max(0.0);
        let last = self.frames().len() - 1;
        let before = (position as usize).min(last);
        let share = position - before as f32;
        let frame = |index: usize| &self.poses[index * self.parts..][..self.parts];
        if share == 0.0 || before == last {
            return frame(before).to_vec();
        }
        let pairs = frame(before).iter().zip(frame(before + 1));
        pairs.map(|(before, after)| before.lerp(after, share)).collect()
    }
}

/// Returns the number of physics steps from one frame of a trial's recording to the next.
fn steps_between_frames(trial: &Trial, parts: usize) -> u32 {
    let wanted = (trial.physics.steps_per_s / FRAMES_PER_S).max(1);
    let max_frames = (Recording::MOST_POSES / parts) as u32;
    // One of the frames is the one at the start.
    wanted.max(trial.steps().div_ceil(max_frames.saturating_sub(1).max(1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_recording_follows_the_poses_of_the_rollout() {
        let trial = Trial { duration_s: 1.0, ..Trial::default() };
        let genome = trial.random_genome(0);
        let recording = Recording::of(&genome, &trial);
        assert_eq!((recording.every_steps(), recording.frames().len()), (2, 31));
        let mut rollout = Rollout::new(&genome, &trial);
        for step in 0..=60 {
            let seen = recording.at(step as f32);
            let distance = (seen[2].translation - rollout.poses()[2].translation).length();
            // Between two frames, interpolation is less exact, because a limb may have hit a step.
            let max_m = if step % 2 == 0 { 1e-6 } else { 0.05 };
            assert!(distance < max_m, "{distance} m at step {step}");
            rollout.advance();
        }
        assert_eq!(recording.at(1.0e9), rollout.poses(), "after the end, the end");
    }

    #[test]
    fn a_long_recording_has_fewer_frames() {
        let mut trial = Trial { duration_s: 600.0, ..Trial::default() };
        trial.physics.steps_per_s = 1000;
        let frames = trial.steps() / steps_between_frames(&trial, 12) + 1;
        assert!((8000..=8333).contains(&frames), "{frames}");
        let poses = vec![Pose::IDENTITY; 6];
        assert_eq!(Recording::new(2, 4, poses.clone()), None, "no whole frames");
        assert_eq!(Recording::new(0, 3, poses), None);
    }
}
