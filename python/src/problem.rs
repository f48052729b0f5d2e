//! A preset with changed settings, which defines the trial, the space of genomes, and the search.

use std::path::PathBuf;

use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use snakes_core::evolve::{self, Origin, Settings, fields, with_fields};
use snakes_core::genome::{ControllerKind, Genome};
use snakes_core::rng::{Purpose, stream};
use snakes_core::save::{load_preset, shipped_presets};
use snakes_core::schema;

use crate::batch::{score_all, threads_of};
use crate::champion::{Champion, evaluated};
use crate::convert::{changes_in, rows, seed_of, to_python, whole, whole_u32};
use crate::errors::{crashed, invalid, refused, unusable};
use crate::evaluations::Evaluations;

/// A preset with changed settings, as a Python class.
#[pyclass(frozen, module = "snakes_and_stairs._core")]
pub struct Problem {
    pub preset: String,
    pub settings: Settings,
}

/// Returns the names and descriptions of the shipped presets, the default first.
#[pyfunction]
pub fn presets(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let dictionary = PyDict::new(py);
    for preset in shipped_presets().map_err(unusable)? {
        dictionary.set_item(preset.name, preset.about)?;
    }
    Ok(dictionary)
}

/// Purpose of a problem, which decides which settings have an effect.
#[derive(Clone, Copy, PartialEq)]
enum Use {
    Environment,
    Evaluation,
    Search,
}

impl Use {
    fn named(name: &str) -> PyResult<Self> {
        match name {
            "environment" => Ok(Self::Environment),
            "evaluation" => Ok(Self::Evaluation),
            "search" => Ok(Self::Search),
            _ => Err(refused("use", format!("{name:?}"), "environment, evaluation or search")),
        }
    }

    /// Refuses a setting without an effect for this purpose. `path` is its full dotted name.
    fn check(self, path: &str) -> PyResult<()> {
        let is_of_trial = path.starts_with("trial.");
        let is_of_body =
            ["bend_limits_rad", "twist_limits_rad", "density_min_kg_m3", "density_max_kg_m3"]
                .iter()
                .any(|name| path.strip_prefix("genome.") == Some(name));
        let (has_effect, allowed) = match self {
            Self::Environment => (
                is_of_body || is_of_trial && !path.starts_with("trial.repeats."),
                "settings of trial except trial.repeats, and genome's limits and densities: an environment has no genome and \
                 no search",
            ),
            Self::Evaluation => (
                path.starts_with("genome.")
                    || is_of_trial && path != "trial.repeats.champion_trials",
                "settings of trial and genome: an evaluation has no search",
            ),
            Self::Search => {
                (path != "evolution.strategy", "other settings; strategy=... chooses it")
            }
        };
        if has_effect { Ok(()) } else { Err(refused("settings", format!("{path:?}"), allowed)) }
    }
}

impl Problem {
    /// Checks that rows of an array can describe the genomes completely.
    pub fn check_is_array(&self) -> PyResult<()> {
        let kind = self.settings.genome.controller;
        let is_array = !matches!(
            kind,
            ControllerKind::Grown | ControllerKind::Decisions | ControllerKind::JointDecisions
        );
        if self.settings.genome.bodies.vary {
            let allowed = "false; genomes with bodies of their own have no common length, but Search(...).evaluate() and \
                           tell() drive them";
            return Err(refused("genome.bodies.vary", true, allowed));
        }
        if is_array {
            return Ok(());
        }
        let allowed = "a controller whose genomes are arrays of numbers; Search(...).evaluate() and tell() drive this one, \
                       whose networks grow or which learns";
        Err(refused("controller", kind, allowed))
    }

    pub fn dimension(&self) -> usize {
        self.settings.genome.dimension(self.settings.trial.genome_shape())
    }

    /// Returns the genomes at the rows of an array. All 64 bits of a number count, so that every genome has a row.
    pub fn genomes_at(
        &self,
        field: &str,
        points: &PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Vec<Genome>> {
        self.check_is_array()?;
        let shape = self.settings.trial.genome_shape();
        let points = rows(field, points, self.dimension())?;
        Ok(points.iter().map(|point| self.settings.genome.genome_at_fine(point, shape)).collect())
    }

    /// Returns the point of a genome. Warns if no point gives the genome back to the last bit, because motion magnifies the least
    /// difference.
    pub fn point_of_genome(&self, py: Python<'_>, genome: &Genome) -> PyResult<Vec<f64>> {
        let (space, shape) = (&self.settings.genome, self.settings.trial.genome_shape());
        let point = space.fine_point_of(genome);
        if space.genome_at_fine(&point, shape).hash() != genome.hash() {
            let message = c"a genome has a gene that no row reaches to the last bit, so its row may move otherwise; \
                            evaluate and save the search's or the champion's own genome instead";
            // Level 2 stands for the line that called the package.
            PyErr::warn(py, &py.get_type::<PyUserWarning>(), message, 2)?;
        }
        Ok(point)
    }

    /// Returns the points of genomes as the rows of an array.
    pub fn points_of<'py>(
        &self,
        py: Python<'py>,
        genomes: &[Genome],
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.check_is_array()?;
        let points: Vec<Vec<f64>> = genomes
            .iter()
            .map(|genome| self.point_of_genome(py, genome))
            .collect::<PyResult<_>>()?;
        let shape = (genomes.len(), self.dimension());
        let array = numpy::ndarray::Array2::from_shape_vec(shape, points.concat());
        Ok(array.map_err(|error| crashed(error.to_string()))?.into_pyarray(py))
    }
}

#[pymethods]
impl Problem {
    #[new]
    #[pyo3(signature = (preset, stairs=None, settings=None, purpose="evaluation", strategy=None))]
    fn new(
        preset: &str,
        stairs: Option<&Bound<'_, PyAny>>,
        settings: Option<&Bound<'_, PyAny>>,
        purpose: &str,
        strategy: Option<&str>,
    ) -> PyResult<Self> {
        let purpose = Use::named(purpose)?;
        let preset = load_preset(preset).map_err(unusable)?;
        let mut changes = changes_in("stairs", "trial.stairs.", stairs)?;
        let others = changes_in("settings", "", settings)?;
        for (path, _) in &others {
            // A ground without a surface of its own lacks these settings, so their names cannot be looked up.
            let is_ground = path.trim_start_matches("trial.").starts_with("ground");
            let is_strategy = path.rsplit('.').next() == Some("strategy");
            let full = if is_ground {
                "trial.ground".to_owned() + "."
            } else if is_strategy {
                "evolution.strategy".to_owned()
            } else {
                schema::find(&preset.settings, path).map_err(invalid)?
            };
            purpose.check(&full)?;
        }
        changes.extend(others);
        if let Some(strategy) = strategy {
            changes.push(("evolution.strategy".to_owned(), strategy.to_owned()));
        }
        let changes = changes.iter().map(|(path, text)| (path.as_str(), text.as_str()));
        let settings = with_fields(&preset.settings, changes).map_err(invalid)?;
        settings.check_start().map_err(invalid)?;
        Ok(Self { preset: preset.name, settings })
    }

    #[getter]
    fn preset(&self) -> &str {
        &self.preset
    }

    #[getter]
    fn controller(&self) -> String {
        self.settings.genome.controller.to_string()
    }

    #[getter(dimension)]
    fn dimension_in_python(&self) -> usize {
        self.dimension()
    }

    /// Duration of a trial, in s.
    #[getter]
    fn duration_s(&self) -> f64 {
        self.settings.trial.duration_s.into()
    }

    #[getter]
    fn steps(&self) -> u32 {
        self.settings.trial.stairs.steps
    }

    /// Returns all settings: full dotted names, and values as text.
    #[getter]
    fn settings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dictionary = PyDict::new(py);
        for (path, value) in fields(&self.settings) {
            dictionary.set_item(path, value)?;
        }
        Ok(dictionary)
    }

    /// Returns a dictionary about the gene of each coordinate.
    #[getter]
    fn genes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        self.check_is_array()?;
        let list = PyList::empty(py);
        let coordinates = self.settings.genome.coordinates(self.settings.trial.genome_shape());
        for (index, coordinate) in coordinates.into_iter().enumerate() {
            let gene = PyDict::new(py);
            gene.set_item("index", index)?;
            gene.set_item("field", coordinate.field)?;
            gene.set_item("name", coordinate.name)?;
            gene.set_item("unit", coordinate.unit)?;
            gene.set_item("allowed", coordinate.allowed)?;
            list.append(gene)?;
        }
        Ok(list)
    }

    /// Returns the points of random genomes, with which a run of this seed would begin.
    fn random<'py>(
        &self,
        py: Python<'py>,
        count: &Bound<'py, PyAny>,
        seed: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.check_is_array()?;
        let count = whole("count", count, 0..=evolve::LARGEST_POPULATION.into())?;
        let seed = seed_of(seed)?;
        let (space, shape) = (&self.settings.genome, self.settings.trial.genome_shape());
        let genome =
            |index| space.random_genome(shape, &mut stream(seed, 1, index, Purpose::Birth));
        let genomes: Vec<Genome> = (0..count as u32).map(genome).collect();
        self.points_of(py, &genomes)
    }

    /// Returns the genomes at points as dictionaries.
    fn decode<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        to_python(py, &self.genomes_at("points", &points)?)
    }

    /// Returns the point of a champion's genome.
    fn point_of<'py>(
        &self,
        py: Python<'py>,
        champion: &Champion,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.check_is_array()?;
        let (genome, shape) = (champion.genome(), self.settings.trial.genome_shape());
        let space = &self.settings.genome;
        space.check_genome(genome, shape).map_err(|error| invalid(error.inside("champion")))?;
        Ok(self.point_of_genome(py, genome)?.into_pyarray(py))
    }

    #[pyo3(signature = (points, threads=None))]
    fn evaluate(
        &self,
        py: Python<'_>,
        points: PyReadonlyArray2<'_, f64>,
        threads: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Evaluations> {
        let (genomes, trial) = (self.genomes_at("genomes", &points)?, &self.settings.trial);
        let scored = score_all(py, &genomes, trial, threads_of(threads)?)?;
        Ok(Evaluations::new(&genomes, scored, &trial.stairs))
    }

    /// Writes the snake at a point to a file, as a champion that the program can replay.
    fn save_champion(
        &self,
        py: Python<'_>,
        path: PathBuf,
        points: PyReadonlyArray2<'_, f64>,
        seed: &Bound<'_, PyAny>,
        generation: &Bound<'_, PyAny>,
        individual: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let mut genomes = self.genomes_at("genome", &points)?;
        let (Some(genome), true) = (genomes.pop(), genomes.is_empty()) else {
            let rows = points.as_array().nrows();
            return Err(refused("genome", format!("{rows} rows"), "one row"));
        };
        let origin = Origin {
            preset: self.preset.clone(),
            seed: seed_of(seed)?,
            generation: whole_u32("generation", generation)?,
            individual: whole_u32("individual", individual)?,
        };
        evaluated(py, genome, self.settings.trial.clone(), origin)?.store(&path)
    }
}
