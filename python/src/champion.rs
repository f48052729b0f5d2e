//! Saved champions and runs.

use std::path::{Path, PathBuf};

use numpy::ndarray::{Array2, Array3};
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use serde_json::{Value, json};
use snakes_core::evolve::{self, GenerationRecord};
use snakes_core::genome::Genome;
use snakes_core::save::{self, LoadedChampion, load_log};
use snakes_core::schema::Choices;
use snakes_core::score::{Evaluation, Rollout, Trial};
use snakes_core::world::Disqualification;
use snakes_core::{Engine, Processors};
use snakes_lab::run;
use snakes_lab::run::headless::HeadlessError;

use crate::batch::score_all;
use crate::convert::{parsed, restorer, to_python};
use crate::errors::{crashed, invalid, unusable};
use crate::evaluations::Evaluations;

/// A saved champion, as a Python class.
#[pyclass(frozen, module = "snakes_and_stairs._core")]
pub struct Champion {
    pub loaded: LoadedChampion,
}

/// Restores a champion from what pickle stored: the text of its file, and the engine that recorded it.
#[pyfunction]
pub fn unpacked_champion(text: &str, version: u32, processors: &str) -> PyResult<Champion> {
    let mut loaded = save::parse_champion(Path::new("champion.ron"), text).map_err(unusable)?;
    let processors = Processors::named("processors", processors).map_err(invalid)?;
    loaded.engine = Engine { version, processors };
    Ok(Champion { loaded })
}

impl Champion {
    pub fn genome(&self) -> &Genome {
        &self.loaded.champion.genome
    }

    pub fn evaluation(&self) -> &Evaluation {
        &self.loaded.champion.evaluation
    }

    /// Makes a champion of this engine, without a recording and an exam.
    pub fn new(champion: evolve::Champion) -> Self {
        let engine = Engine::THIS;
        Self { loaded: LoadedChampion { champion, engine, recording: None, exam: Vec::new() } }
    }

    /// Writes the champion to a file.
    pub fn store(&self, path: &Path) -> PyResult<()> {
        save::store_champion(path, &self.loaded.champion, None).map_err(unusable)
    }

    fn json(&self) -> PyResult<Value> {
        let LoadedChampion { champion, engine, exam, recording } = &self.loaded;
        let value = |result: serde_json::Result<Value>| result.map_err(|e| crashed(e.to_string()));
        let evaluation = &champion.evaluation;
        let mut recorded = value(serde_json::to_value(evaluation))?;
        if let Some(recorded) = recorded.as_object_mut() {
            let disqualified = evaluation.disqualified.map(|reason| reason.words());
            recorded.insert("disqualified".to_owned(), json!(disqualified));
            let ending = evaluation.ending.map(|ending| ending.words());
            recorded.insert("ending".to_owned(), json!(ending));
        }
        let origin = &champion.origin;
        let exam = exam.iter().map(|result| {
            json!({
                "suite": result.suite.choice().name,
                "trials": result.trials,
                "landed": result.landed,
                "disqualified": result.disqualified,
                "median_steps": result.median_steps,
                "kept": result.kept,
                "each": result.each,
                "endings": result.endings,
            })
        });
        Ok(json!({
            "engine": engine.version,
            "is_of_this_engine": self.loaded.is_of_this_engine(),
            "origin": {
                "preset": origin.preset,
                "seed": origin.seed,
                "generation": origin.generation,
                "individual": origin.individual,
            },
            "recorded": recorded,
            "chosen_by": champion.chosen_by,
            "has_poses": recording.is_some(),
            "trial": value(serde_json::to_value(&champion.trial))?,
            "genome": value(serde_json::to_value(&champion.genome))?,
            "exam": exam.collect::<Vec<Value>>(),
        }))
    }
}

/// Evaluates a snake, and makes it a champion with this origin.
pub fn evaluated(
    py: Python<'_>,
    genome: Genome,
    trial: Trial,
    origin: evolve::Origin,
) -> PyResult<Champion> {
    let scored = score_all(py, std::slice::from_ref(&genome), &trial, 1)?;
    let evaluation = scored.first().map(|scored| scored.evaluation);
    let evaluation = evaluation.filter(|of| of.disqualified != Some(Disqualification::Crashed));
    let evaluation = evaluation.ok_or_else(|| crashed("this snake has no result".to_owned()))?;
    Ok(Champion::new(evolve::Champion { genome, trial, evaluation, chosen_by: None, origin }))
}

/// Reads a champion from its file.
#[pyfunction]
pub fn load_champion(path: PathBuf) -> PyResult<Champion> {
    let loaded = save::load_champion(&path).map_err(unusable)?;
    Ok(Champion { loaded })
}

/// Reads a run from its folder, as a dictionary with its settings, generations and champions.
#[pyfunction]
pub fn load_run<'py>(py: Python<'py>, folder: PathBuf) -> PyResult<Bound<'py, PyDict>> {
    let (plan, records) = load_log(&folder).map_err(unusable)?;
    let champions = save::load_run(&folder).map_err(unusable)?;
    let run = PyDict::new(py);
    run.set_item("preset", &plan.preset)?;
    run.set_item("seed", plan.seed)?;
    run.set_item("founder", plan.founder.as_ref().map(|founder| founder.name().to_owned()))?;
    run.set_item("settings", to_python(py, &plan.settings)?)?;
    run.set_item("generations", to_python(py, &generations_of(&records)?)?)?;
    let list = PyList::empty(py);
    for (generation, loaded) in champions {
        let entry = PyDict::new(py);
        entry.set_item("generation", generation)?;
        entry.set_item("champion", Champion { loaded })?;
        list.append(entry)?;
    }
    run.set_item("champions", list)?;
    Ok(run)
}

/// Returns the records of generations with the names that lines of JSON have for their values.
fn generations_of(records: &[GenerationRecord]) -> PyResult<Vec<Value>> {
    let mut before = 0;
    let line = |record: &GenerationRecord| {
        let mut line = serde_json::to_value(record).map_err(|error| crashed(error.to_string()))?;
        if let Some(fields) = line.as_object_mut() {
            fields.remove("first_on_landing");
            let first = record.first_on_landing.map(|index| before + u64::from(index) + 1);
            fields.insert("first_landing".to_owned(), json!(first));
            if let Some(Value::Object(statistics)) = fields.remove("statistics") {
                fields.extend(statistics);
            }
        }
        before += u64::from(record.evaluations);
        Ok(line)
    };
    records.iter().map(line).collect()
}

/// Returns the result that `snakes replay FILE --no-render --json` prints. Its `matches` is false if the replay differs from the
/// record.
#[pyfunction]
pub fn replay<'py>(py: Python<'py>, path: PathBuf) -> PyResult<Bound<'py, PyAny>> {
    let mut out = Vec::new();
    match py.detach(|| run::replay(&path, true, &mut out)) {
        Ok(()) | Err(HeadlessError::Differs { .. }) => {
            let line = String::from_utf8(out).map_err(|error| crashed(error.to_string()))?;
            parsed(py, &line)
        }
        Err(HeadlessError::Save(error)) => Err(unusable(error)),
        Err(HeadlessError::Crashed { message, .. }) => Err(crashed(message)),
        Err(HeadlessError::Output(error)) => Err(PyOSError::new_err(error.to_string())),
        Err(error) => Err(PyRuntimeError::new_err(error.to_string())),
    }
}

/// Function that restores a champion, with its arguments: text of the file, version of the engine, name of the kind of processors.
type Reduced<'py> = (Bound<'py, PyAny>, (String, u32, &'static str));

#[pymethods]
impl Champion {
    /// Returns the champion as a dictionary with the contents of its file, without the poses.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_python(py, &self.json()?)
    }

    fn __repr__(&self) -> String {
        let champion = &self.loaded.champion;
        let origin = &champion.origin;
        format!("<Champion of {}, seed {}: {}>", origin.preset, origin.seed, champion.reached())
    }

    /// Packs the champion for pickle.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        let LoadedChampion { champion, engine, recording, exam } = &self.loaded;
        let text = save::champion_text(champion, recording.as_ref(), exam).map_err(unusable)?;
        let processors = engine.processors.choice().name;
        Ok((restorer(py, "unpacked_champion")?, (text, engine.version, processors)))
    }

    /// Writes the champion to a file.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        self.store(&path)
    }

    /// Trace hash of the record, as files have it.
    #[getter]
    fn trace_hash(&self) -> String {
        format!("{:016x}", self.evaluation().trace_hash)
    }

    /// Simulates the champion again in its trial.
    fn evaluate(&self, py: Python<'_>) -> PyResult<Evaluations> {
        let champion = &self.loaded.champion;
        let scored = score_all(py, std::slice::from_ref(&champion.genome), &champion.trial, 1)?;
        let genomes = std::slice::from_ref(&champion.genome);
        Ok(Evaluations::new(genomes, scored, &champion.trial.stairs))
    }

    /// Returns the motion of the champion, simulated again: arrays with a row for each moment, beginning before the first step.
    fn trajectory<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let champion = &self.loaded.champion;
        let motion = py.detach(|| run::caught(|| Motion::of(champion))).map_err(crashed)?;
        motion.to_python(py)
    }
}

/// Names of the numbers of a joint's state, as in tables of motion.
const JOINT_STATES: [&str; 4] =
    ["joint_bend_rad", "joint_twist_rad", "joint_bend_rate_rad_s", "joint_twist_rate_rad_s"];

/// Motion of a snake, moment by moment: limbs from the head on, then joints from the head on.
#[derive(Default)]
struct Motion {
    limbs: usize,
    joints: usize,
    time_s: Vec<f64>,
    position_m: Vec<f64>,
    quaternion: Vec<f64>,
    joint_state: Vec<f64>,
}

impl Motion {
    fn of(champion: &snakes_core::evolve::Champion) -> Self {
        let mut rollout = Rollout::new(&champion.genome, &champion.trial);
        let body = rollout.body();
        let mut motion = Self { limbs: body.limbs(), joints: body.joints.len(), ..Self::default() };
        motion.observe(&rollout);
        while rollout.advance() {
            motion.observe(&rollout);
        }
        motion
    }

    fn observe(&mut self, rollout: &Rollout) {
        self.time_s.push(rollout.time_s().into());
        for pose in rollout.body().limb_poses(rollout.poses()) {
            let (at, turn) = (pose.translation, pose.rotation);
            self.position_m.extend([at.x, at.y, at.z].map(f64::from));
            self.quaternion.extend([turn.x, turn.y, turn.z, turn.w].map(f64::from));
        }
        for joint in rollout.simulation().joint_states() {
            let state = [joint.bend_rad, joint.twist_rad, joint.bend_rad_s, joint.twist_rad_s];
            self.joint_state.extend(state.map(f64::from));
        }
    }

    fn to_python<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (moments, limbs, joints) = (self.time_s.len(), self.limbs, self.joints);
        let wrong = |error: numpy::ndarray::ShapeError| PyValueError::new_err(error.to_string());
        let of_limbs = |values: &Vec<f64>, width| {
            Array3::from_shape_vec((moments, limbs, width), values.clone()).map_err(wrong)
        };
        let arrays = PyDict::new(py);
        let time_s: Bound<'py, PyArray1<f64>> = self.time_s.clone().into_pyarray(py);
        arrays.set_item("time_s", time_s)?;
        arrays.set_item("position_m", of_limbs(&self.position_m, 3)?.into_pyarray(py))?;
        arrays.set_item("rotation_xyzw", of_limbs(&self.quaternion, 4)?.into_pyarray(py))?;
        for (index, name) in JOINT_STATES.iter().enumerate() {
            let values: Vec<f64> =
                self.joint_state.iter().copied().skip(index).step_by(4).collect();
            let array = Array2::from_shape_vec((moments, joints), values).map_err(wrong)?;
            arrays.set_item(name, array.into_pyarray(py))?;
        }
        Ok(arrays)
    }
}
