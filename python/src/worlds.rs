//! Many worlds, stepped on several threads without Python's lock.

use std::sync::Arc;

use numpy::ndarray::{Array2, Array3, ArrayView1};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArray3, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};
use snakes_core::score::{Evaluation, Repeats, Trial};
use snakes_lab::export::{PICTURE_SIDES, snapshot};
use snakes_lab::run::caught;

use crate::batch::threads_of;
use crate::champion::{Champion, evaluated};
use crate::convert::whole;
use crate::errors::{crashed, invalid, refused};
use crate::problem::Problem;
use crate::world::{StepResult, World};
use crate::world_rules::WorldRules;
use crate::world_threads::WorldThreads;

/// Worlds of an environment. Methods take flags, one per world; worlds whose flag is not set stay unchanged.
#[pyclass(module = "snakes_and_stairs._core")]
pub struct Worlds {
    /// Arguments of the constructor by name, from which a copy in another process is made.
    arguments: Py<PyDict>,
    problem: Py<Problem>,
    rules: Arc<WorldRules>,
    limits: Arc<[f32]>,
    senses: usize,
    worlds: Vec<Option<World>>,
    /// Values of the senses, one row for each world.
    sensed: Array2<f32>,
    threads: WorldThreads,
}

/// Maximum number of worlds of one environment. Each takes about 70 KiB, and four bytes for each number of the actions of its
/// episode.
const MOST_WORLDS: u64 = 65_536;
impl Worlds {
    fn check_flags(&self, field: &str, length: usize) -> PyResult<()> {
        let worlds = self.worlds.len();
        if length == worlds {
            return Ok(());
        }
        Err(refused(field, format!("of length {length}"), &format!("{worlds}, one per world")))
    }

    /// Calls `work` on all threads with the index, the world and the row of senses of each world.
    fn each<T: Send>(
        &mut self,
        py: Python<'_>,
        work: impl Fn(usize, &mut Option<World>, &mut [f32]) -> T + Sync + Send,
    ) -> PyResult<Vec<T>> {
        let Self { worlds, sensed, threads, senses, .. } = self;
        let Some(rows) = sensed.as_slice_mut() else { return Ok(Vec::new()) };
        threads.each(py, worlds, rows, *senses, work)
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
        py: Python<'_>,
        problem: Py<Problem>,
        count: &Bound<'_, PyAny>,
        actions: &str,
        steps_per_action: &Bound<'_, PyAny>,
        stiffness_nm_per_rad: Option<f64>,
        damping_nms_per_rad: Option<f64>,
        perturbation: Option<&Bound<'_, PyAny>>,
        disqualification_penalty: f64,
        threads: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let arguments = PyDict::new(py);
        arguments.set_item("problem", &problem)?;
        arguments.set_item("count", count)?;
        arguments.set_item("actions", actions)?;
        arguments.set_item("steps_per_action", steps_per_action)?;
        arguments.set_item("stiffness_nm_per_rad", stiffness_nm_per_rad)?;
        arguments.set_item("damping_nms_per_rad", damping_nms_per_rad)?;
        arguments.set_item("perturbation", perturbation)?;
        arguments.set_item("disqualification_penalty", disqualification_penalty)?;
        arguments.set_item("threads", threads)?;
        let count = whole("num_envs", count, 1..=MOST_WORLDS)? as usize;
        let rules = WorldRules::new(
            problem.get(),
            actions,
            steps_per_action,
            [stiffness_nm_per_rad, damping_nms_per_rad],
            perturbation,
            disqualification_penalty,
        )?;
        if rules.perturbation.is_none()
            && let Some(reason) = World::new(&rules, 0)?.evaluation().disqualified
        {
            let value = format!("disqualified at the start: {}", reason.words());
            return Err(refused("body", value, "a body that comes to rest on the ground"));
        }
        let senses = rules.senses().len();
        Ok(Self {
            arguments: arguments.unbind(),
            problem,
            limits: rules.action_limits().into(),
            senses,
            rules: Arc::new(rules),
            worlds: (0..count).map(|_| None).collect(),
            sensed: Array2::zeros((count, senses)),
            threads: WorldThreads::new(threads_of(threads)?.min(count)),
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
        state.set_item("fitness", of(World::fitness))?;
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

    /// Returns the poses of a world's limbs, head first: x, y, z in m and a unit quaternion x, y, z, w.
    fn poses<'py>(
        &self,
        py: Python<'py>,
        index: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let rollout = self.world("poses", index)?.rollout();
        let poses = rollout.body().limb_poses(rollout.poses());
        let numbers = poses.iter().flat_map(|pose| {
            let (at, turn) = (pose.translation, pose.rotation);
            [at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w]
        });
        let array = Array2::from_shape_vec((poses.len(), 7), numbers.collect());
        Ok(array.map_err(|error| crashed(error.to_string()))?.into_pyarray(py))
    }

    /// Returns the episode of a world, which must be over, as a champion whose genes are the actions.
    fn champion(
        &self,
        py: Python<'_>,
        index: &Bound<'_, PyAny>,
        seed: &Bound<'_, PyAny>,
        generation: &Bound<'_, PyAny>,
        individual: &Bound<'_, PyAny>,
    ) -> PyResult<Champion> {
        let world = self.world("champion", index)?;
        if self.rules.perturbation.is_some() {
            let allowed = "None for an episode that becomes a champion, whose file has a trial and no perturbed world";
            return Err(refused("perturbation", "set", allowed));
        }
        if !world.is_over() {
            let allowed = "an episode that was terminated or truncated";
            return Err(refused("the episode", "not over", allowed));
        }
        let trial = &self.rules.trial;
        let repeats = Repeats { trials: 1, champion_trials: 0, ..trial.repeats.clone() };
        let trial = Trial { repeats, ..trial.clone() };
        let genome = world.recorded(&self.rules);
        trial.check_genome(&genome).map_err(invalid)?;
        let origin = self.problem.get().origin(seed, generation, individual)?;
        let champion = evaluated(py, genome, trial, origin)?;
        if champion.evaluation().trace_hash == world.evaluation().trace_hash {
            return Ok(champion);
        }
        Err(crashed("the recorded actions move the snake otherwise than the episode".to_owned()))
    }

    /// Draws a world as a camera at its side sees it: rows of pixels of red, green and blue.
    fn picture<'py>(
        &self,
        py: Python<'py>,
        index: &Bound<'py, PyAny>,
        width: &Bound<'py, PyAny>,
        height: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let size = |field, value| whole(field, value, PICTURE_SIDES).map(|side| side as u32);
        let (width, height) = (size("width", width)?, size("height", height)?);
        let rollout = self.world("render", index)?.rollout();
        let picture = py.detach(|| caught(|| snapshot(rollout, width, height))).map_err(crashed)?;
        let shape = (height as usize, width as usize, 3);
        let array = Array3::from_shape_vec(shape, picture.rgb);
        Ok(array.map_err(|error| crashed(error.to_string()))?.into_pyarray(py))
    }

    /// The arguments with which pickle makes the worlds again, without their episodes.
    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> (Bound<'py, PyTuple>, Bound<'py, PyDict>) {
        (PyTuple::empty(py), self.arguments.bind(py).clone())
    }

    /// Returns the episodes for pickle: the seed of each, and its actions so far, from which the world follows to the last bit.
    fn __getstate__<'py>(&self, py: Python<'py>) -> Vec<Option<(u64, Bound<'py, PyArray1<f32>>)>> {
        let episode = |world: &World| (world.seed, world.actions.clone().into_pyarray(py));
        self.worlds.iter().map(|world| world.as_ref().map(episode)).collect()
    }

    /// Simulates the episodes again that pickle stored.
    fn __setstate__(
        &mut self,
        py: Python<'_>,
        state: Vec<Option<(u64, Vec<f32>)>>,
    ) -> PyResult<()> {
        self.check_flags("state", state.len())?;
        let (rules, limits) = (Arc::clone(&self.rules), Arc::clone(&self.limits));
        let restored = self.each(py, |index, world, row| {
            let Some(Some((seed, actions))) = state.get(index) else { return Ok(()) };
            let mut new = World::new(&rules, *seed)?;
            for action in actions.chunks(limits.len().max(1)) {
                new.step(&rules, &limits, action);
            }
            new.sense(row);
            *world = Some(new);
            Ok::<(), PyErr>(())
        })?;
        restored.into_iter().collect()
    }

    /// Copies the worlds in the middle of their episodes.
    fn __deepcopy__(&self, py: Python<'_>, _memo: &Bound<'_, PyAny>) -> Self {
        Self {
            arguments: self.arguments.clone_ref(py),
            problem: self.problem.clone_ref(py),
            rules: Arc::clone(&self.rules),
            limits: Arc::clone(&self.limits),
            senses: self.senses,
            worlds: self.worlds.clone(),
            sensed: self.sensed.clone(),
            threads: self.threads.unstarted(),
        }
    }
}

impl Worlds {
    /// Returns a world in an episode, for a method with this name.
    fn world(&self, method: &str, index: &Bound<'_, PyAny>) -> PyResult<&World> {
        let last = (self.worlds.len() as u64).saturating_sub(1);
        let index = whole("index", index, 0..=last)?;
        let world = self.worlds.get(index as usize).and_then(Option::as_ref);
        let message = || format!("{method} before reset: call reset() first");
        world.ok_or_else(|| PyRuntimeError::new_err(message()))
    }

    /// Refuses a step in a flagged world that has no episode, or whose episode is over.
    fn check_step(&self, index: usize, flag: bool, action: ArrayView1<'_, f32>) -> PyResult<()> {
        if !flag {
            return Ok(());
        }
        match &self.worlds[index] {
            None => return Err(PyRuntimeError::new_err("step before reset: call reset() first")),
            Some(world) if world.is_over() && !world.is_fresh() => {
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
