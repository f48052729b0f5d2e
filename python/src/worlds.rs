//! Many worlds, stepped on several threads without Python's lock.

use std::sync::Arc;

use numpy::ndarray::{Array2, ArrayView1};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use snakes_core::genome::{SERVO_DAMPING_RANGE, STIFFNESS_RANGE_NM_PER_RAD};
use snakes_core::schema;
use snakes_core::score::{Evaluation, PerturbationRange};

use crate::batch::threads_of;
use crate::convert::{changes_in, whole};
use crate::errors::{crashed, invalid, refused};
use crate::problem::Problem;
use crate::world::{ActionKind, StepResult, World, WorldRules, middle_body};

/// Worlds of an environment. Methods take flags, one per world; worlds whose flag is not set stay unchanged.
#[pyclass(module = "snakes_and_stairs._core")]
pub struct Worlds {
    rules: Arc<WorldRules>,
    limits: Arc<[f32]>,
    senses: usize,
    worlds: Vec<Option<World>>,
    /// Values of the senses, one row for each world.
    sensed: Array2<f32>,
    threads: usize,
    /// Threads, and the id of the process that started them, because threads do not survive a fork.
    pool: Option<(u32, ThreadPool)>,
}

/// Maximum number of worlds of one environment. Each takes about 70 KiB.
const MOST_WORLDS: u64 = 65_536;
/// Maximum number of physics steps of one action.
const MOST_STEPS_PER_ACTION: u64 = 1000;

fn within(field: &str, value: f64, range: std::ops::RangeInclusive<f64>) -> PyResult<f32> {
    if range.contains(&value) {
        return Ok(value as f32);
    }
    Err(refused(field, value, &format!("{} to {}", range.start(), range.end())))
}

/// Reads the ranges of perturbations from Python: None for no perturbation, True for the usual ranges, or a dictionary, in which
/// missing ranges are 0.
fn perturbation_of(value: Option<&Bound<'_, PyAny>>) -> PyResult<Option<PerturbationRange>> {
    let Some(value) = value.filter(|value| !value.is_none()) else { return Ok(None) };
    if let Ok(is_usual) = value.extract::<bool>() {
        return Ok(is_usual.then(PerturbationRange::default));
    }
    let mut range = PerturbationRange {
        friction: 0.0,
        rise: 0.0,
        density: 0.0,
        start_m: 0.0,
        turn_deg: 0.0,
        tread: 0.0,
        step_rate: 0.0,
        shove_m_s: 0.0,
        ..PerturbationRange::default()
    };
    for (name, text) in changes_in("perturbation", "", Some(value))? {
        let path = schema::find(&range, &name).map_err(|error| {
            let allowed = error.allowed.replace("(nearest) ", "");
            refused("perturbation", format!("{name:?}"), &allowed)
        })?;
        schema::set_text(&mut range, &path, &text)
            .map_err(|error| invalid(error.inside("perturbation")))?;
    }
    schema::check(&range).map_err(|error| invalid(error.inside("perturbation")))?;
    Ok(Some(range))
}

impl Worlds {
    fn check_flags(&self, field: &str, length: usize) -> PyResult<()> {
        let worlds = self.worlds.len();
        if length == worlds {
            return Ok(());
        }
        Err(refused(field, format!("of length {length}"), &format!("{worlds}, one per world")))
    }

    /// Starts the threads, unless one is enough or they already run in this process.
    fn prepare_pool(&mut self) -> PyResult<()> {
        let process = std::process::id();
        let is_ready = self.pool.as_ref().is_some_and(|(of, _)| *of == process);
        if is_ready || self.threads <= 1 {
            return Ok(());
        }
        let pool = ThreadPoolBuilder::new()
            .num_threads(self.threads)
            .thread_name(|index| format!("worlds-{index}"))
            .build()
            .map_err(|error| PyRuntimeError::new_err(format!("threads: {error}")))?;
        // The threads of a parent process's pool do not exist in this process, so the pool must not wait for their end.
        std::mem::forget(self.pool.replace((process, pool)));
        Ok(())
    }

    /// Calls `work` on all threads with the index, the world and the row of senses of each world.
    fn each<T: Send>(
        &mut self,
        py: Python<'_>,
        work: impl Fn(usize, &mut Option<World>, &mut [f32]) -> T + Sync + Send,
    ) -> PyResult<Vec<T>> {
        self.prepare_pool()?;
        let Self { worlds, sensed, pool, threads, senses, .. } = self;
        let Some(rows) = sensed.as_slice_mut() else { return Ok(Vec::new()) };
        let width = (*senses).max(1);
        let results = py.detach(|| match pool {
            Some((_, pool)) if worlds.len() > 1 => {
                // With a few portions per thread their durations even out, and distributing them costs little.
                let portion = (worlds.len() / (8 * *threads)).max(1);
                pool.install(|| {
                    let each = worlds.par_iter_mut().zip(rows.par_chunks_mut(width)).enumerate();
                    each.with_min_len(portion)
                        .map(|(index, (world, row))| work(index, world, row))
                        .collect()
                })
            }
            _ => {
                let each = worlds.iter_mut().zip(rows.chunks_mut(width)).enumerate();
                each.map(|(index, (world, row))| work(index, world, row)).collect()
            }
        });
        Ok(results)
    }

    /// Returns a value of each world, or `missing` for worlds without an episode.
    fn of<'py, T: numpy::Element + Copy>(
        &self,
        py: Python<'py>,
        missing: T,
        value: impl Fn(&World) -> T,
    ) -> Bound<'py, PyArray1<T>> {
        let value = |world: &Option<World>| world.as_ref().map_or(missing, &value);
        let values: Vec<T> = self.worlds.iter().map(value).collect();
        values.into_pyarray(py)
    }
}

/// Observations, rewards, and the flags of terminated and of truncated episodes.
type Stepped<'py> = (
    Bound<'py, PyArray2<f32>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<bool>>,
    Bound<'py, PyArray1<bool>>,
);

#[pymethods]
impl Worlds {
    #[new]
    #[pyo3(signature = (
        problem, count, actions, steps_per_action, stiffness_nm_per_rad=None, damping_nms_per_rad=None,
        perturbation=None, disqualification_penalty=0.0, threads=None,
    ))]
    fn new(
        problem: &Problem,
        count: &Bound<'_, PyAny>,
        actions: &str,
        steps_per_action: &Bound<'_, PyAny>,
        stiffness_nm_per_rad: Option<f64>,
        damping_nms_per_rad: Option<f64>,
        perturbation: Option<&Bound<'_, PyAny>>,
        disqualification_penalty: f64,
        threads: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (trial, space) = (problem.settings.trial.clone(), &problem.settings.genome);
        let count = whole("num_envs", count, 1..=MOST_WORLDS)? as usize;
        let steps_per_action =
            whole("steps_per_action", steps_per_action, 1..=MOST_STEPS_PER_ACTION)? as u32;
        let actions = match actions {
            "targets" => ActionKind::Targets,
            "torques" => ActionKind::Torques,
            _ => return Err(refused("actions", format!("{actions:?}"), "targets, torques")),
        };
        let servo = [
            ("stiffness_nm_per_rad", stiffness_nm_per_rad, STIFFNESS_RANGE_NM_PER_RAD),
            ("damping_nms_per_rad", damping_nms_per_rad, SERVO_DAMPING_RANGE),
        ];
        let wave = &space.wave;
        let middle = (wave.stiffness_min_nm_per_rad + wave.stiffness_max_nm_per_rad) / 2.0;
        let mut servo_values = [middle, wave.servo_damping_nms_per_rad];
        for ((field, given, range), value) in servo.into_iter().zip(&mut servo_values) {
            let Some(given) = given else { continue };
            if actions == ActionKind::Torques {
                return Err(refused(
                    field,
                    given,
                    "None with actions=\"torques\", which no servo follows",
                ));
            }
            *value = within(field, given, f64::from(*range.start())..=f64::from(*range.end()))?;
        }
        let [stiffness_nm_per_rad, damping_nms_per_rad] = servo_values;
        within("disqualification_penalty", disqualification_penalty, 0.0..=1.0e6)?;
        let rules = WorldRules {
            genome: middle_body(space, &trial),
            trial,
            actions,
            steps_per_action,
            stiffness_nm_per_rad,
            damping_nms_per_rad,
            perturbation: perturbation_of(perturbation)?,
            disqualification_penalty,
        };
        rules.trial.check_genome(&rules.genome).map_err(invalid)?;
        let senses = rules.senses().len();
        Ok(Self {
            limits: rules.action_limits().into(),
            senses,
            rules: Arc::new(rules),
            worlds: (0..count).map(|_| None).collect(),
            sensed: Array2::zeros((count, senses)),
            threads: threads_of(threads)?.min(count),
            pool: None,
        })
    }

    fn __len__(&self) -> usize {
        self.worlds.len()
    }

    /// Greatest action of each joint axis in either direction.
    #[getter]
    fn action_limits<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f32>> {
        self.limits.to_vec().into_pyarray(py)
    }

    /// Returns a dictionary about each sense, in the order of an observation.
    #[getter]
    fn senses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        let body = self.rules.body();
        let weight_n = body.mass_kg() * self.rules.trial.physics.gravity_m_s2;
        let limb_weight_n = weight_n / body.limbs() as f32;
        for (index, (name, info)) in self.rules.senses().into_iter().enumerate() {
            let sense = PyDict::new(py);
            sense.set_item("index", index)?;
            sense.set_item("name", name)?;
            // A force F is sensed as F / (F + W/n), a share without a unit, which is one half at the weight W/n of a limb.
            let is_share = info.scale.is_none();
            sense.set_item("unit", if is_share { "" } else { info.unit })?;
            sense.set_item("scale", info.scale.unwrap_or(1.0))?;
            sense.set_item("half_force_n", is_share.then_some(limb_weight_n))?;
            sense.set_item("low", info.range[0])?;
            sense.set_item("high", info.range[1])?;
            list.append(sense)?;
        }
        Ok(list)
    }

    /// Stiffness of the servo in N·m/rad, and its damping in N·m·s/rad.
    #[getter]
    fn servo(&self) -> (f64, f64) {
        (self.rules.stiffness_nm_per_rad.into(), self.rules.damping_nms_per_rad.into())
    }

    /// Physics steps per simulated second, without perturbations.
    #[getter]
    fn physics_steps_per_s(&self) -> u32 {
        self.rules.trial.physics.steps_per_s
    }

    /// Begins an episode in each flagged world, with the perturbation of its seed. Returns the senses of all worlds.
    fn reset<'py>(
        &mut self,
        py: Python<'py>,
        flags: PyReadonlyArray1<'_, bool>,
        seeds: PyReadonlyArray1<'_, u64>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let (flags, seeds) = (flags.as_array().to_vec(), seeds.as_array().to_vec());
        self.check_flags("flags", flags.len())?;
        self.check_flags("seeds", seeds.len())?;
        let rules = Arc::clone(&self.rules);
        let built = self.each(py, |index, world, row| {
            if flags.get(index) != Some(&true) {
                return Ok(());
            }
            let new = World::new(&rules, seeds.get(index).copied().unwrap_or(0))?;
            new.sense(row);
            *world = Some(new);
            Ok::<(), PyErr>(())
        })?;
        built.into_iter().collect::<PyResult<()>>()?;
        Ok(self.sensed.clone().into_pyarray(py))
    }

    /// Holds an action in each flagged world. Returns the senses of all worlds and, for the flagged ones, the reward and whether
    /// the episode was terminated or truncated.
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        flags: PyReadonlyArray1<'_, bool>,
        actions: PyReadonlyArray2<'_, f32>,
    ) -> PyResult<Stepped<'py>> {
        let (flags, actions) = (flags.as_array().to_vec(), actions.as_array());
        self.check_flags("flags", flags.len())?;
        let (expected, found) = ((self.worlds.len(), self.limits.len()), actions.dim());
        if expected != found {
            let (value, allowed) = (format!("of shape {found:?}"), format!("shape {expected:?}"));
            return Err(refused("action", value, &allowed));
        }
        for (index, action) in actions.outer_iter().enumerate() {
            self.check_step(index, flags[index], action)?;
        }
        let actions: Vec<f32> = actions.iter().copied().collect();
        let (rules, limits) = (Arc::clone(&self.rules), Arc::clone(&self.limits));
        let width = limits.len();
        let results = self.each(py, |index, world, row| match world {
            Some(world) if flags.get(index) == Some(&true) => {
                let action = actions.get(index * width..(index + 1) * width).unwrap_or_default();
                let result = world.step(&rules, &limits, action);
                world.sense(row);
                result
            }
            _ => StepResult::default(),
        })?;
        let array =
            |value: fn(&StepResult) -> bool| -> Vec<bool> { results.iter().map(value).collect() };
        let rewards: Vec<f64> = results.iter().map(|result| result.reward).collect();
        Ok((
            self.sensed.clone().into_pyarray(py),
            rewards.into_pyarray(py),
            array(|result| result.terminated).into_pyarray(py),
            array(|result| result.truncated).into_pyarray(py),
        ))
    }

    /// Returns the state of all worlds, for the dictionary `info`.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let state = PyDict::new(py);
        let of = |value: fn(&World) -> f64| self.of(py, f64::NAN, value);
        state.set_item("time_s", of(|world| world.rollout().time_s().into()))?;
        state.set_item("y_m", of(|world| world.rollout().middle_m().y.into()))?;
        let energy_j = of(|world| world.rollout().simulation().effort().energy_j.into());
        state.set_item("energy_j", energy_j)?;
        let steps_climbed = |world: &World| {
            let (rollout, middle) = (world.rollout(), world.rollout().middle_m());
            i64::from(rollout.stairs().steps_under(middle.to_array()))
        };
        state.set_item("steps_climbed", self.of(py, 0, steps_climbed))?;
        Ok(state)
    }

    /// Returns the evaluation of each flagged world so far; None for the other worlds.
    fn evaluations<'py>(
        &self,
        py: Python<'py>,
        flags: PyReadonlyArray1<'_, bool>,
    ) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        self.check_flags("flags", flags.as_array().len())?;
        for (world, is_asked) in self.worlds.iter().zip(flags.as_array()) {
            let Some(world) = world.as_ref().filter(|_| *is_asked) else {
                list.append(py.None())?;
                continue;
            };
            let Evaluation { fitness, disqualified, trace_hash, steps, .. } = world.evaluation();
            let is_on_landing = disqualified.is_none() && world.rollout().is_on_landing();
            let result = PyDict::new(py);
            result.set_item("fitness", f64::from(fitness))?;
            result.set_item("disqualified", disqualified.map(|reason| reason.words()))?;
            result.set_item("on_landing", is_on_landing)?;
            // The hash is text, as in files, because NumPy's usual integers cannot hold it.
            result.set_item("trace_hash", format!("{trace_hash:016x}"))?;
            result.set_item("physics_steps", steps)?;
            list.append(result)?;
        }
        Ok(list)
    }

    /// Returns the poses of a world's limbs, head first: x, y, z in m and a quaternion x, y, z, w.
    fn poses<'py>(
        &self,
        py: Python<'py>,
        index: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let last = (self.worlds.len() as u64).saturating_sub(1);
        let index = whole("index", index, 0..=last)?;
        let Some(world) = self.worlds.get(index as usize).and_then(Option::as_ref) else {
            return Err(PyRuntimeError::new_err("poses before reset: call reset() first"));
        };
        let rollout = world.rollout();
        let poses = rollout.body().limb_poses(rollout.poses());
        let numbers = poses.iter().flat_map(|pose| {
            let (at, turn) = (pose.translation, pose.rotation);
            [at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w]
        });
        let array = Array2::from_shape_vec((poses.len(), 7), numbers.collect());
        Ok(array.map_err(|error| crashed(error.to_string()))?.into_pyarray(py))
    }
}

impl Worlds {
    /// Refuses a step in a flagged world that has no episode, or whose episode is over.
    fn check_step(&self, index: usize, flag: bool, action: ArrayView1<'_, f32>) -> PyResult<()> {
        if !flag {
            return Ok(());
        }
        match &self.worlds[index] {
            None => return Err(PyRuntimeError::new_err("step before reset: call reset() first")),
            Some(world) if world.is_over() => {
                let message = format!("the episode of world {index} is over: call reset() first");
                return Err(PyRuntimeError::new_err(message));
            }
            Some(_) => (),
        }
        match action.iter().position(|value| !value.is_finite()) {
            None => Ok(()),
            Some(axis) => {
                let field = format!("action[{index}, {axis}]");
                Err(refused(&field, action[axis], "finite numbers"))
            }
        }
    }
}
