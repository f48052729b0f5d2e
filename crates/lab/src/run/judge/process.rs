//! The Python process in which a judge works, and the messages between it and this program.

use std::ffi::{OsStr, OsString};
use std::io::{self, BufRead, BufReader, Write};
use std::path::{self, Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use serde::{Deserialize, Serialize};

use super::{Judge, JudgeError};
use snakes_core::world::{LimbState, Pose, Rotation, Skin, Surface, Vector};

/// Environment variable that names the Python program.
pub(super) const PYTHON_VARIABLE: &str = "SNAKES_PEER_PYTHON";
const PYTHON: &str = "python3";
/// The module `judge`, which the scripts of all judges import.
const COMMON: &str = include_str!("../../../../../tests/peers/judge.py");
/// Lets the script that follows import the definitions before it.
const AS_MODULE: &str = "sys.modules['judge'] = sys.modules['__main__']";

/// A running Python process.
pub(super) struct PythonProcess {
    judge: &'static Judge,
    child: Child,
    orders: ChildStdin,
    answers: BufReader<ChildStdout>,
    /// Version of the judge's package.
    pub version: String,
    /// Working folder of the process, in which MuJoCo leaves a log of warnings.
    _folder: tempfile::TempDir,
}

/// The materials of a world.
#[derive(Serialize)]
pub(super) struct Surfaces<'o> {
    pub stairs: &'o Surface,
    pub ground: &'o Surface,
    pub skin: &'o Skin,
}

/// A message to the Python process.
#[derive(Serialize)]
#[serde(untagged)]
pub(super) enum Order<'o> {
    Model { model: &'o str, substeps: u32, air_per_s: f32, surfaces: Surfaces<'o> },
    Torques { torques: &'o [[f32; 2]] },
}

/// A message from the Python process.
#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Answer {
    Version(String),
    Limbs(Vec<[f32; 17]>),
    Broken,
    Missing(String),
    Error(String),
}

/// Makes a folder for temporary files within a folder.
fn working_folder(within: &Path) -> Result<tempfile::TempDir, JudgeError> {
    tempfile::tempdir_in(within).map_err(|error| JudgeError::NoFolder {
        within: within.to_owned(),
        reason: error.to_string().split(" at path ").next().unwrap_or_default().to_owned(),
    })
}

impl PythonProcess {
    /// Starts the Python process of a judge.
    ///
    /// # Errors
    /// [`JudgeError::Missing`], if Python or the judge's package is missing.
    pub fn start(judge: &'static Judge) -> Result<Self, JudgeError> {
        let python = std::env::var_os(PYTHON_VARIABLE).filter(|name| !name.is_empty());
        let python = python.unwrap_or_else(|| OsString::from(PYTHON));
        let missing = |reason: String| JudgeError::Missing {
            judge,
            python: python.to_string_lossy().into_owned(),
            reason,
        };
        let failed = |reason: io::Error| match reason.kind() {
            io::ErrorKind::NotFound | io::ErrorKind::PermissionDenied => {
                missing(reason.to_string())
            }
            _ => JudgeError::NotStarted { python: python.to_string_lossy().into_owned(), reason },
        };
        let folder = working_folder(&std::env::temp_dir())?;
        let mut command = Command::new(program(&python));
        let script = format!("{COMMON}\n{AS_MODULE}\n{}", judge.script);
        command.args(["-c", &script]).current_dir(folder.path());
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut child = command.spawn().map_err(failed)?;
        let (orders, answers) = child
            .stdin
            .take()
            .zip(child.stdout.take())
            .ok_or_else(|| missing("no pipes".to_owned()))?;
        let mut started = Self {
            judge,
            child,
            orders,
            answers: BufReader::new(answers),
            version: String::new(),
            _folder: folder,
        };
        match started.answer() {
            Ok(Answer::Version(version)) => started.version = version,
            Ok(Answer::Missing(reason)) | Err(JudgeError::Failed(_, reason)) => {
                return Err(missing(reason));
            }
            Ok(_) => return Err(missing("it answers otherwise than expected".to_owned())),
            Err(other) => return Err(other),
        }
        Ok(started)
    }

    /// Sends a message to the process.
    pub fn send(&mut self, order: &Order<'_>) -> Result<(), JudgeError> {
        let judge = self.judge;
        let failed = |error: io::Error| failure(judge, error.to_string());
        let mut line = serde_json::to_string(order).map_err(|error| failed(error.into()))?;
        line.push('\n');
        self.orders.write_all(line.as_bytes()).and_then(|()| self.orders.flush()).map_err(failed)
    }

    fn answer(&mut self) -> Result<Answer, JudgeError> {
        let judge = self.judge;
        let failed = |error: io::Error| failure(judge, error.to_string());
        let mut line = String::new();
        self.answers.read_line(&mut line).map_err(failed)?;
        if line.is_empty() {
            return Err(failure(judge, "it ended at once"));
        }
        serde_json::from_str(&line).map_err(|error| failed(error.into()))
    }

    /// Reads the limbs from the process; `None` if the engine cannot continue.
    pub fn limbs(&mut self) -> Result<Option<Vec<LimbState>>, JudgeError> {
        match self.answer()? {
            Answer::Limbs(rows) => Ok(Some(rows.iter().map(limb_state).collect())),
            Answer::Broken => Ok(None),
            Answer::Error(reason) | Answer::Missing(reason) => Err(failure(self.judge, reason)),
            Answer::Version(_) => Err(failure(self.judge, "it starts again")),
        }
    }
}

fn failure(judge: &Judge, reason: impl Into<String>) -> JudgeError {
    JudgeError::Failed(judge.title, reason.into())
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
impl Drop for PythonProcess {
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

#[cfg(test)]
mod tests {
    use super::*;

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
