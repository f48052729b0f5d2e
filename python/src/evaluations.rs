//! Results of a batch of evaluations, as arrays.

use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};
use snakes_core::genome::Genome;
use snakes_core::learn::Episode;
use snakes_core::score::{Behaviour, Evaluation, Scored};
use snakes_core::world::{Disqualification, Effort, Stairs};

use crate::convert::restorer;
use crate::errors::{crashed, invalid};

/// The results of a batch of evaluations, one per snake, in order.
#[pyclass(frozen, module = "snakes_and_stairs._core")]
pub struct Evaluations {
    pub scored: Vec<Scored>,
    /// Hash of each genome, by which a search recognizes the owner of a result.
    pub genomes: Vec<u64>,
    stairs: Stairs,
}

/// Evaluations in the form in which pickle stores them as text.
#[derive(Serialize, Deserialize)]
struct Packed {
    stairs: Stairs,
    results: Vec<PackedResult>,
}

#[derive(Serialize, Deserialize)]
struct PackedResult {
    genome: u64,
    disqualified: Option<Disqualification>,
    recorded: Evaluation,
    episode: Option<Episode>,
}

impl PackedResult {
    fn unpacked(self) -> PyResult<(u64, Scored)> {
        let Self { genome, disqualified, recorded, episode } = self;
        recorded.check().map_err(invalid)?;
        let evaluation = Evaluation { disqualified, ..recorded };
        if let Some(episode) = &episode {
            episode.check().map_err(invalid)?;
        }
        Ok((genome, Scored { evaluation, episode }))
    }
}

/// Restores evaluations from the text that pickle stored.
#[pyfunction]
pub fn unpacked_evaluations(text: &str) -> PyResult<Evaluations> {
    let Packed { stairs, results } =
        serde_json::from_str(text).map_err(|error| PyValueError::new_err(error.to_string()))?;
    let results: Vec<(u64, Scored)> =
        results.into_iter().map(PackedResult::unpacked).collect::<PyResult<_>>()?;
    let (genomes, scored) = results.into_iter().unzip();
    Ok(Evaluations { scored, genomes, stairs })
}

impl Evaluations {
    pub fn new(genomes: &[Genome], scored: Vec<Scored>, stairs: &Stairs) -> Self {
        let genomes = genomes.iter().map(Genome::hash).collect();
        Self { scored, genomes, stairs: stairs.clone() }
    }

    fn of<'py, T: numpy::Element>(
        &self,
        py: Python<'py>,
        value: impl Fn(&Evaluation) -> T,
    ) -> Bound<'py, PyArray1<T>> {
        let values: Vec<T> = self.scored.iter().map(|scored| value(&scored.evaluation)).collect();
        values.into_pyarray(py)
    }

    fn of_effort<'py>(
        &self,
        py: Python<'py>,
        value: impl Fn(&Effort) -> f32,
    ) -> Bound<'py, PyArray1<f64>> {
        self.of(py, |of| of.effort.as_ref().map_or(f64::NAN, |effort| value(effort).into()))
    }

    fn of_behaviour<'py>(
        &self,
        py: Python<'py>,
        value: impl Fn(&Behaviour) -> Option<f32>,
    ) -> Bound<'py, PyArray1<f64>> {
        self.of(py, |of| of.behaviour.as_ref().and_then(&value).map_or(f64::NAN, f64::from))
    }
}

#[pymethods]
impl Evaluations {
    fn __len__(&self) -> usize {
        self.scored.len()
    }

    /// Packs the results for pickle, so that they move between processes with all their bits.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        let packed = |(scored, genome): (&Scored, &u64)| PackedResult {
            genome: *genome,
            disqualified: scored.evaluation.disqualified,
            recorded: scored.evaluation,
            episode: scored.episode.clone(),
        };
        let results = self.scored.iter().zip(&self.genomes).map(packed).collect();
        let packed = Packed { stairs: self.stairs.clone(), results };
        let text = serde_json::to_string(&packed).map_err(|error| crashed(error.to_string()))?;
        Ok((restorer(py, "unpacked_evaluations")?, (text,)))
    }

    fn __repr__(&self) -> String {
        let best = self.scored.iter().map(|scored| &scored.evaluation);
        let best = best.filter(|of| of.disqualified.is_none()).map(|of| of.fitness);
        let best = best.reduce(f32::max).map_or("none".to_owned(), |best| best.to_string());
        format!("<Evaluations of {} snakes, best fitness {best}>", self.scored.len())
    }

    /// Fitness by the measure ``trial.fitness``. For a disqualified snake, the fitness after its last healthy step.
    #[getter]
    fn fitness<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.of(py, |of| of.fitness.into())
    }

    /// Fitness by which snakes are ranked: minus infinity for a disqualified snake.
    #[getter]
    fn ranking<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.of(
            py,
            |of| if of.disqualified.is_some() { f64::NEG_INFINITY } else { of.fitness.into() },
        )
    }

    /// Whether the physics broke or was exploited, or the snake left the arena. Such a snake ranks last.
    #[getter]
    fn disqualified<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        self.of(py, |of| of.disqualified.is_some())
    }

    /// Reason of each disqualification; None for a healthy snake.
    #[getter]
    fn reasons(&self) -> Vec<Option<&'static str>> {
        let reason = |scored: &Scored| scored.evaluation.disqualified.map(|why| why.words());
        self.scored.iter().map(reason).collect()
    }

    /// How each trial ended, in words, such as "fell off the side from step 4"; None for a snake that was not simulated.
    #[getter]
    fn endings(&self) -> Vec<Option<String>> {
        self.scored.iter().map(|scored| Some(scored.evaluation.ending?.words())).collect()
    }

    /// Whether the snake ended healthy, with all steps under its middle block.
    #[getter]
    fn on_landing<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        self.of(py, |of| of.is_on_landing(&self.stairs))
    }

    /// Number of steps under the middle block at the end.
    #[getter]
    fn steps_climbed<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        self.of(py, |of| of.behaviour.map_or(0, |behaviour| behaviour.steps_climbed.into()))
    }

    /// Number of healthy physics steps.
    #[getter]
    fn physics_steps<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        self.of(py, |of| of.steps.into())
    }

    /// Hash over the bits of all poses, as files have it. Equal hashes mean equal steps.
    #[getter]
    fn trace_hash<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let hashes = self.scored.iter().map(|scored| scored.evaluation.trace_hash);
        let hashes: Vec<String> = hashes.map(|hash| format!("{hash:016x}")).collect();
        py.import("numpy")?.call_method1("array", (hashes, "U16"))
    }

    /// y coordinate of the middle block at the end, in m.
    #[getter]
    fn centre_y_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.of(py, |of| of.centre_y_m.into())
    }

    /// Energy that the joints spent, in J.
    #[getter]
    fn energy_j<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.of_effort(py, |effort| effort.energy_j)
    }

    /// Greatest speed of a block, in m/s.
    #[getter]
    fn top_speed_m_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.of_effort(py, |effort| effort.top_speed_m_s)
    }

    /// Greatest gap of a joint, in m.
    #[getter]
    fn joint_drift_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.of_effort(py, |effort| effort.joint_drift_m)
    }

    /// Greatest distance of a block from the middle of the stairs, in m.
    #[getter]
    fn sideways_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.of_effort(py, |effort| effort.sideways_m)
    }

    /// Mean height of the blocks above the tread below the middle block, in m.
    #[getter]
    fn mean_height_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.of_behaviour(py, |of| Some(of.mean_height_m))
    }

    /// Mean distance of the middle block from the middle of the stairs, in m.
    #[getter]
    fn mean_sideways_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.of_behaviour(py, |of| Some(of.mean_sideways_m))
    }

    /// Mean share of the blocks that touch something, from 0 to 1.
    #[getter]
    fn contact_duty<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.of_behaviour(py, |of| Some(of.contact_duty))
    }

    /// Frequency of the controller, in Hz.
    #[getter]
    fn frequency_hz<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.of_behaviour(py, |of| Some(of.frequency_hz))
    }

    /// Energy divided by weight and distance; NaN if the snake covered no distance.
    #[getter]
    fn cost_of_transport<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.of_behaviour(py, |of| of.cost_of_transport)
    }

    /// Share of the spent energy that lifted the snake; NaN if no energy was spent.
    #[getter]
    fn climbing_efficiency<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.of_behaviour(py, |of| of.climbing_efficiency)
    }
}
