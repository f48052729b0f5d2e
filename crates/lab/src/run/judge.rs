//! Champions in another program's physics engine: the same body on the same stairs, moved by the same controller.
//!
//! A Python process runs the engine (a script of `tests/peers`, which is embedded in this program). The controller runs in this
//! process: it senses the limbs that the other engine moves, and sends torques back. Therefore every kind of controller works, with or
//! without senses.

mod process;

use std::io;
use std::path::PathBuf;

use super::evaluator::Evaluator;
use super::exam::exam_ends;
use super::run_control::{Cancelled, RunControl};
use process::{Order, PythonProcess, Surfaces};
use snakes_core::evolve::Champion;
use snakes_core::score::{
    Endings, ExamCondition, ExamEnd, MirroredRollout, PerturbationRange, median, varied,
};
use snakes_core::world::{JointTorque, WorldPlan};

/// Another program's engine that examines champions.
#[derive(Debug, PartialEq, Eq)]
pub struct Judge {
    /// Name of the exam suite.
    pub name: &'static str,
    /// Name of the engine for users.
    pub title: &'static str,
    /// Argument of `pip install` that installs the engine.
    package: &'static str,
    /// Script that runs the engine.
    script: &'static str,
}

/// All judges. None of them may be used in learning or for choosing settings.
pub const JUDGES: [Judge; 2] = [
    Judge {
        name: "mujoco",
        title: "MuJoCo",
        package: "\"mujoco>=3,<5\"",
        script: include_str!("../../../../tests/peers/mujoco.py"),
    },
    Judge {
        name: "ode",
        title: "ODE",
        package: "\"panda3d>=1.10,<2\"",
        script: include_str!("../../../../tests/peers/ode.py"),
    },
];

/// Number of trials in each engine.
const TRIALS: u32 = 20;
/// Seed from which the starts of the trials are drawn.
const SEED: u64 = 1;
/// Minimum number of steps that counts as climbing in a comparison of engines.
pub const CLIMBED_STEPS: u32 = 3;

impl Judge {
    /// Returns the judge with this name of a suite.
    pub fn named(name: &str) -> Option<&'static Self> {
        JUDGES.iter().find(|judge| judge.name == name)
    }

    /// Returns the description of the exam suite for users.
    pub fn sentence(&self) -> String {
        let Self { title, package, .. } = self;
        format!(
            "20 trials in the physics engine {title}, from other starts (±0.2 m, ±5°), and the same trials here. Needs Python and \
             pip install {package}; only if it is named."
        )
    }
}

/// Why a judge could not be used.
#[derive(Debug, thiserror::Error)]
pub enum JudgeError {
    /// Python or the judge's package is missing.
    #[error(
        "{} needs Python with its package: {python}: {reason}; install it with `pip install {}`, or name another Python in {}",
        judge.title, judge.package, process::PYTHON_VARIABLE
    )]
    Missing {
        /// The judge.
        judge: &'static Judge,
        /// Name of the Python program.
        python: String,
        /// Why it cannot be used.
        reason: String,
    },
    /// The system refused to start the Python process. Holds the reason.
    #[error("{python}: cannot be started: {reason}")]
    NotStarted {
        /// Name of the Python program.
        python: String,
        /// Reason of the system.
        reason: io::Error,
    },
    /// The folder for temporary files, in which the judge works, cannot be written. Holds the reason and the path.
    #[error("{}: a temporary folder cannot be made: {reason}; TMPDIR names the folder for temporary files", within.display())]
    NoFolder {
        /// Folder for temporary files.
        within: PathBuf,
        /// Reason of the system, without the path.
        reason: String,
    },
    /// The Python process failed during the exam. Holds the name of the engine and the reason.
    #[error("{0} failed: {1}")]
    Failed(&'static str, String),
    /// The user cancelled the exam.
    #[error("cancelled")]
    Cancelled,
}

impl From<Cancelled> for JudgeError {
    fn from(Cancelled: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// Results of a champion here and with a judge. A way is the share of the distance from the start to the landing, 0 to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct JudgeResult {
    /// The judge.
    pub judge: &'static Judge,
    /// Number of trials in each engine.
    pub trials: u32,
    /// Number of trials that climb at least [`CLIMBED_STEPS`], in this program and in the other engine.
    pub climbed: [u32; 2],
    /// Number of trials that end on the landing, in this program and in the other engine.
    pub landed: [u32; 2],
    /// Median way, in this program and in the other engine.
    pub way: [f32; 2],
    /// Median ratio of the way in the other engine to the way in this program from the same start. Starts without a way in this
    /// program are left out.
    pub kept: f32,
    /// How the trials ended, in this program and in the other engine.
    pub endings: [Endings; 2],
}

/// A judge at work in a separate Python process.
pub struct Court {
    /// The judge.
    pub judge: &'static Judge,
    process: PythonProcess,
}

impl Court {
    /// Starts the Python process of a judge.
    ///
    /// # Errors
    /// [`JudgeError::Missing`], if Python or the judge's package is missing.
    pub fn start(judge: &'static Judge) -> Result<Self, JudgeError> {
        Ok(Self { judge, process: PythonProcess::start(judge)? })
    }

    /// Returns the version of the judge's package.
    pub fn version(&self) -> &str {
        &self.process.version
    }

    /// Simulates a champion in the suite's trials, with `evaluator` and in the other engine. `model` writes a world as MJCF.
    ///
    /// # Errors
    /// The judge fails, or `control` was cancelled.
    pub fn examine(
        &mut self,
        champion: &Champion,
        model: &dyn Fn(&WorldPlan) -> io::Result<String>,
        evaluator: &dyn Evaluator,
        control: &RunControl,
    ) -> Result<JudgeResult, JudgeError> {
        control.set_done(0);
        let starts = PerturbationRange { friction: 0.0, rise: 0.0, ..PerturbationRange::default() };
        let conditions = varied(&champion.trial, &starts, TRIALS, SEED);
        let here = exam_ends(&champion.genome, &conditions, evaluator, control)?;
        let play = |condition| {
            control.wait_while_paused()?;
            // The interrupt key may end the judge's process, too, which is no failure then.
            let ended = |error| match control.is_cancelled() {
                true => JudgeError::Cancelled,
                false => error,
            };
            let end = self.play(champion, condition, model, control).map_err(ended)?;
            control.count_one();
            Ok(end)
        };
        let there = conditions.iter().map(play).collect::<Result<Vec<_>, JudgeError>>()?;
        Ok(JudgeResult::of(self.judge, &here, &there))
    }

    /// Simulates a champion in a trial in the other engine.
    fn play(
        &mut self,
        champion: &Champion,
        condition: &ExamCondition,
        model: &dyn Fn(&WorldPlan) -> io::Result<String>,
        control: &RunControl,
    ) -> Result<ExamEnd, JudgeError> {
        let mut rollout = MirroredRollout::new(&champion.genome, condition);
        let plan = &rollout.plan;
        let text =
            model(plan).map_err(|error| JudgeError::Failed(self.judge.title, error.to_string()))?;
        self.process.send(&Order::Model {
            model: &text,
            substeps: plan.explicit_steps(),
            air_per_s: plan.body.angular_damping_per_s,
            surfaces: Surfaces { stairs: &plan.surface, ground: &plan.ground, skin: &plan.skin },
        })?;
        // The first answer has the limbs at the start, which are equal in both engines.
        self.process.limbs()?;
        let mut torques = Vec::new();
        while !rollout.is_over() {
            if control.is_cancelled() {
                return Err(JudgeError::Cancelled);
            }
            torques.clear();
            torques.extend(rollout.torques().iter().map(|torque| {
                let JointTorque { bend_nm, twist_nm } = *torque;
                [bend_nm, twist_nm]
            }));
            self.process.send(&Order::Torques { torques: &torques })?;
            match self.process.limbs()? {
                Some(limbs) => rollout.take(&limbs),
                None => rollout.disqualify(),
            }
        }
        Ok(rollout.end())
    }
}

impl JudgeResult {
    /// Summarizes the same trials in this program (`here`) and in the other engine (`there`).
    fn of(judge: &'static Judge, here: &[ExamEnd], there: &[ExamEnd]) -> Self {
        let both = [here, there];
        let count = |is: fn(&ExamEnd) -> bool| {
            both.map(|ends| ends.iter().filter(|end| is(end)).count() as u32)
        };
        // Trials without a way in this program have no ratio.
        let both_ways = here.iter().zip(there).filter(|(here, _)| here.way > 0.0);
        let kept = both_ways.map(|(here, there)| there.way / here.way).collect();
        Self {
            judge,
            trials: there.len() as u32,
            climbed: count(|end| end.steps >= CLIMBED_STEPS),
            landed: count(|end| end.has_landed),
            way: both.map(|ends| median(ends.iter().map(|end| end.way).collect())),
            kept: median(kept),
            endings: both.map(|ends| Endings::of(ends.iter().map(|end| &end.ending))),
        }
    }
}

/// Returns the number of trials for a champion, in both engines together.
pub const fn judge_trials() -> u32 {
    2 * TRIALS
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::score::{Ending, EndingKind};

    fn end(steps: u32, way: f32) -> ExamEnd {
        let ending = Ending {
            kind: if steps == 10 { EndingKind::Landed } else { EndingKind::OffTheSide },
            step: steps,
            reason: None,
            at_s: 0.0,
            tricks: [false; 3],
        };
        let has_landed = steps == 10;
        ExamEnd { steps, way, has_landed, is_disqualified: false, ending, ..ExamEnd::CRASHED }
    }

    #[test]
    fn the_kept_share_compares_trials_from_the_same_start() {
        let here = [end(10, 1.0), end(4, 0.5), end(0, 0.0)];
        let there = [end(5, 0.6), end(4, 0.5), end(2, 0.4)];
        let result = JudgeResult::of(&JUDGES[0], &here, &there);
        assert_eq!((result.trials, result.climbed, result.landed), (3, [2, 2], [1, 0]));
        assert_eq!((result.way, result.kept), ([0.5, 0.5], 0.8), "the third has no way here");
        let landed = result.endings.map(|endings| endings.count(EndingKind::Landed));
        assert_eq!(landed, result.landed);
    }
}
