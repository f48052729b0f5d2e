//! Champions in MuJoCo: the same body on the same stairs, moved by the same controller, in another physics engine.
//!
//! A Python process runs MuJoCo (`tests/peers/mujoco.py`, which is embedded in this program). The controller runs in this process:
//! it senses the limbs that MuJoCo moves, and sends torques back. Therefore every kind of controller works, with or without senses.

use std::ffi::{OsStr, OsString};
use std::io::{self, BufRead, BufReader, Write};
use std::path::{self, Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use serde::{Deserialize, Serialize};

use super::evaluator::Evaluator;
use super::exam::exam_ends;
use super::run_control::{Cancelled, RunControl};
use snakes_core::evolve::Champion;
use snakes_core::score::{
    ExamCondition, ExamEnd, MirroredRollout, PerturbationRange, median, varied,
};
use snakes_core::world::{JointTorque, LimbState, Pose, Rotation, Vector, WorldPlan};

/// Name of the exam suite.
pub const MUJOCO: &str = "mujoco";
/// Description of the exam suite for users.
pub const MUJOCO_SENTENCE: &str = "20 trials in the physics engine MuJoCo, from other starts (±0.2 m, ±5°), and the same \
     trials here. Needs Python with the package mujoco; only if it is named.";
/// Environment variable that names the Python program.
const PYTHON_VARIABLE: &str = "SNAKES_PEER_PYTHON";
const PYTHON: &str = "python3";
/// Number of trials in each engine.
const TRIALS: u32 = 20;
/// Seed from which the starts of the trials are drawn.
const SEED: u64 = 1;
/// Minimum number of steps that counts as climbing in a comparison of engines.
pub const CLIMBED_STEPS: u32 = 3;

/// Why MuJoCo could not be used.
#[derive(Debug, thiserror::Error)]
pub enum MujocoError {
    /// Python or its package mujoco is missing.
    #[error(
        "the suite mujoco needs Python with the package mujoco: {python}: {reason}; install it with \
         `pip install \"mujoco>=3,<5\"`, or name another Python in {PYTHON_VARIABLE}"
    )]
    Missing {
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
    /// The folder for temporary files, in which MuJoCo works, cannot be written. Holds the reason and the path.
    #[error("{}: a temporary folder cannot be made: {reason}; TMPDIR names the folder for temporary files", within.display())]
    NoFolder {
        /// Folder for temporary files.
        within: PathBuf,
        /// Reason of the system, without the path.
        reason: String,
    },
    /// The Python process failed during the exam. Holds the reason.
    #[error("MuJoCo failed: {0}")]
    Failed(String),
    /// The user cancelled the exam.
    #[error("cancelled")]
    Cancelled,
}

impl From<Cancelled> for MujocoError {
    fn from(Cancelled: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// Results of a champion in both engines. A way is the share of the distance from the start to the landing, 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MujocoResult {
    /// Number of trials in each engine.
    pub trials: u32,
    /// Number of trials that climb at least [`CLIMBED_STEPS`], in this program and in MuJoCo.
    pub climbed: [u32; 2],
    /// Number of trials that end on the landing, in this program and in MuJoCo.
    pub landed: [u32; 2],
    /// Median way, in this program and in MuJoCo.
    pub way: [f32; 2],
    /// Median ratio of the way in MuJoCo to the way in this program from the same start. Starts without a way in this program are
    /// left out.
    pub kept: f32,
}

/// MuJoCo in a separate Python process.
pub struct Mujoco {
    child: Child,
    orders: ChildStdin,
    answers: BufReader<ChildStdout>,
    version: String,
    /// Working folder of the process, in which MuJoCo leaves a log of warnings.
    _folder: tempfile::TempDir,
}

/// A message to the Python process.
#[derive(Serialize)]
#[serde(untagged)]
enum Order<'o> {
    Model { model: &'o str, substeps: u32, air_per_s: f32 },
    Torques { torques: &'o [[f32; 2]] },
}

/// A message from the Python process.
#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Answer {
    Mujoco(String),
    Limbs(Vec<[f32; 17]>),
    Broken,
    Missing(String),
    Error(String),
}

/// Makes a folder for temporary files within a folder.
fn working_folder(within: &Path) -> Result<tempfile::TempDir, MujocoError> {
    tempfile::tempdir_in(within).map_err(|error| MujocoError::NoFolder {
        within: within.to_owned(),
        reason: error.to_string().split(" at path ").next().unwrap_or_default().to_owned(),
    })
}

impl Mujoco {
    /// Starts the Python process.
    ///
    /// # Errors
    /// [`MujocoError::Missing`], if Python or its package is missing.
    pub fn start() -> Result<Self, MujocoError> {
        let python = std::env::var_os(PYTHON_VARIABLE).filter(|name| !name.is_empty());
        let python = python.unwrap_or_else(|| OsString::from(PYTHON));
        let missing = |reason: String| MujocoError::Missing {
            python: python.to_string_lossy().into_owned(),
            reason,
        };
        let failed = |reason: io::Error| match reason.kind() {
            io::ErrorKind::NotFound | io::ErrorKind::PermissionDenied => {
                missing(reason.to_string())
            }
            _ => MujocoError::NotStarted { python: python.to_string_lossy().into_owned(), reason },
        };
        let folder = working_folder(&std::env::temp_dir())?;
        let mut command = Command::new(program(&python));
        command
            .args(["-c", include_str!("../../../../tests/peers/mujoco.py")])
            .current_dir(folder.path());
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut child = command.spawn().map_err(failed)?;
        let (orders, answers) = child
            .stdin
            .take()
            .zip(child.stdout.take())
            .ok_or_else(|| missing("no pipes".to_owned()))?;
        let mut started = Self {
            child,
            orders,
            answers: BufReader::new(answers),
            version: String::new(),
            _folder: folder,
        };
        match started.answer() {
            Ok(Answer::Mujoco(version)) => started.version = version,
            Ok(Answer::Missing(reason)) | Err(MujocoError::Failed(reason)) => {
                return Err(missing(reason));
            }
            Ok(_) => return Err(missing("it answers otherwise than expected".to_owned())),
            Err(other) => return Err(other),
        }
        Ok(started)
    }

    /// Returns the version of MuJoCo.
    pub fn version(&self) -> &str {
        &self.version
    }

    /// Simulates a champion in the suite's trials, with `evaluator` and in MuJoCo. `model` writes a world as MJCF.
    ///
    /// # Errors
    /// MuJoCo fails, or `control` was cancelled.
    pub fn examine(
        &mut self,
        champion: &Champion,
        model: &dyn Fn(&WorldPlan) -> io::Result<String>,
        evaluator: &dyn Evaluator,
        control: &RunControl,
    ) -> Result<MujocoResult, MujocoError> {
        control.set_done(0);
        let starts = PerturbationRange { friction: 0.0, rise: 0.0, ..PerturbationRange::default() };
        let conditions = varied(&champion.trial, &starts, TRIALS, SEED);
        let here = exam_ends(&champion.genome, &conditions, evaluator, control)?;
        let play = |condition| {
            control.wait_while_paused()?;
            let end = self.play(champion, condition, model, control)?;
            control.count_one();
            Ok(end)
        };
        let there = conditions.iter().map(play).collect::<Result<Vec<_>, MujocoError>>()?;
        Ok(MujocoResult::of(&here, &there))
    }

    /// Simulates a champion in a trial in MuJoCo.
    fn play(
        &mut self,
        champion: &Champion,
        condition: &ExamCondition,
        model: &dyn Fn(&WorldPlan) -> io::Result<String>,
        control: &RunControl,
    ) -> Result<ExamEnd, MujocoError> {
        let mut rollout = MirroredRollout::new(&champion.genome, condition);
        let plan = rollout.plan();
        let text = model(plan).map_err(|error| MujocoError::Failed(error.to_string()))?;
        let (substeps, air_per_s) = (plan.explicit_steps(), plan.body.angular_damping_per_s);
        self.send(&Order::Model { model: &text, substeps, air_per_s })?;
        // The first answer has the limbs at the start, which are equal in both engines.
        self.limbs()?;
        let mut torques = Vec::new();
        while !rollout.is_over() {
            if control.is_cancelled() {
                return Err(MujocoError::Cancelled);
            }
            torques.clear();
            torques.extend(rollout.torques().iter().map(|torque| {
                let JointTorque { bend_nm, twist_nm } = *torque;
                [bend_nm, twist_nm]
            }));
            self.send(&Order::Torques { torques: &torques })?;
            match self.limbs()? {
                Some(limbs) => rollout.take(&limbs),
                None => rollout.disqualify(),
            }
        }
        Ok(rollout.end())
    }

    fn send(&mut self, order: &Order<'_>) -> Result<(), MujocoError> {
        let failed = |error: io::Error| MujocoError::Failed(error.to_string());
        let mut line = serde_json::to_string(order).map_err(|error| failed(error.into()))?;
        line.push('\n');
        self.orders.write_all(line.as_bytes()).and_then(|()| self.orders.flush()).map_err(failed)
    }

    fn answer(&mut self) -> Result<Answer, MujocoError> {
        let failed = |error: io::Error| MujocoError::Failed(error.to_string());
        let mut line = String::new();
        self.answers.read_line(&mut line).map_err(failed)?;
        if line.is_empty() {
            return Err(MujocoError::Failed("it ended at once".to_owned()));
        }
        serde_json::from_str(&line).map_err(|error| failed(error.into()))
    }

    /// Reads the limbs from the process; `None` if MuJoCo cannot continue.
    fn limbs(&mut self) -> Result<Option<Vec<LimbState>>, MujocoError> {
        match self.answer()? {
            Answer::Limbs(rows) => Ok(Some(rows.iter().map(limb_state).collect())),
            Answer::Broken => Ok(None),
            Answer::Error(reason) | Answer::Missing(reason) => Err(MujocoError::Failed(reason)),
            Answer::Mujoco(_) => Err(MujocoError::Failed("it starts again".to_owned())),
        }
    }
}

/// Returns the path of a program. A relative path becomes absolute, because the process has another working folder. A bare name
/// stays, to be searched for as usual. Links are not resolved, because the Python of a virtual environment is a link.
fn program(name: &OsStr) -> PathBuf {
    let name = Path::new(name);
    if name.components().count() > 1 {
        path::absolute(name).unwrap_or_else(|_| name.to_owned())
    } else {
        name.to_owned()
    }
}

/// Ends the Python process.
impl Drop for Mujoco {
    fn drop(&mut self) {
        // The process may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Reads a limb from a row of numbers, in the order that the script describes.
fn limb_state(row: &[f32; 17]) -> LimbState {
    let [x, y, z, qx, qy, qz, qw, vx, vy, vz, wx, wy, wz, touches, fx, fy, fz] = *row;
    LimbState {
        pose: Pose::from_parts(Vector::new(x, y, z), Rotation::from_xyzw(qx, qy, qz, qw)),
        velocity_m_s: Vector::new(vx, vy, vz),
        angular_velocity_rad_s: Vector::new(wx, wy, wz),
        contact_n: (touches > 0.0).then_some(Vector::new(fx, fy, fz)),
    }
}

impl MujocoResult {
    /// Summarizes the same trials in this program (`here`) and in MuJoCo (`there`).
    fn of(here: &[ExamEnd], there: &[ExamEnd]) -> Self {
        let both = [here, there];
        let count = |is: fn(&ExamEnd) -> bool| {
            both.map(|ends| ends.iter().filter(|end| is(end)).count() as u32)
        };
        // Trials without a way in this program have no ratio.
        let both_ways = here.iter().zip(there).filter(|(here, _)| here.way > 0.0);
        let kept = both_ways.map(|(here, there)| there.way / here.way).collect();
        Self {
            trials: there.len() as u32,
            climbed: count(|end| end.steps >= CLIMBED_STEPS),
            landed: count(|end| end.has_landed),
            way: both.map(|ends| median(ends.iter().map(|end| end.way).collect())),
            kept: median(kept),
        }
    }
}

/// Returns the number of trials for a champion, in both engines together.
pub const fn mujoco_trials() -> u32 {
    2 * TRIALS
}

#[cfg(test)]
mod tests {
    use super::*;

    fn end(steps: u32, way: f32) -> ExamEnd {
        ExamEnd {
            steps,
            way,
            landed_s: None,
            arrived_s: None,
            has_landed: steps == 10,
            is_disqualified: false,
        }
    }

    #[test]
    fn the_kept_share_compares_trials_from_the_same_start() {
        let here = [end(10, 1.0), end(4, 0.5), end(0, 0.0)];
        let there = [end(5, 0.6), end(4, 0.5), end(2, 0.4)];
        let result = MujocoResult::of(&here, &there);
        assert_eq!((result.trials, result.climbed, result.landed), (3, [2, 2], [1, 0]));
        assert_eq!((result.way, result.kept), ([0.5, 0.5], 0.8), "the third has no way here");
    }

    #[test]
    fn a_relative_path_of_python_is_looked_for_where_the_program_was_started() {
        let here = std::env::current_dir().expect("there is one");
        for name in ["venv/bin/python", "./python"] {
            let found = program(OsStr::new(name));
            assert!(found.starts_with(&here) && found.ends_with("python"), "{}", found.display());
        }
        assert_eq!(program(OsStr::new("python3")), Path::new("python3"));
        let absolute = here.join("venv/bin/python");
        assert_eq!(program(absolute.as_os_str()), absolute);
    }

    #[test]
    fn s10_a_missing_folder_for_temporary_files_is_named_instead_of_python() {
        let missing = tempfile::tempdir().expect("a folder").path().join("none");
        let told = working_folder(&missing).expect_err("no folder").to_string();
        let path = missing.display().to_string();
        assert!(
            told.starts_with(&format!("{path}: a temporary folder cannot be made: ")),
            "{told}"
        );
        assert!(told.ends_with("; TMPDIR names the folder for temporary files"), "{told}");
        assert_eq!(told.matches(&path).count(), 1, "{told}");
    }

    #[test]
    fn numbers_from_the_script_become_limbs_in_its_order() {
        let row = std::array::from_fn(|index| index as f32);
        let limb = limb_state(&row);
        assert_eq!(limb.pose.translation.to_array(), [0.0, 1.0, 2.0]);
        assert_eq!(limb.pose.rotation.to_array(), [3.0, 4.0, 5.0, 6.0]);
        assert_eq!(limb.velocity_m_s.to_array(), [7.0, 8.0, 9.0]);
        assert_eq!(limb.angular_velocity_rad_s.to_array(), [10.0, 11.0, 12.0]);
        assert_eq!(limb.contact_n.map(|force| force.to_array()), Some([14.0, 15.0, 16.0]));
    }
}
