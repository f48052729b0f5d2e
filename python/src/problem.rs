//! A preset with changed settings, which defines the trial, the space of genomes, and the search.

use std::path::PathBuf;

use numpy::{IntoPyArray, PyArray2, PyReadonlyArray2};
use pyo3::exceptions::{PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use serde::{Deserialize, Serialize};
use snakes_core::evolve::{self, Origin, Settings, fields, with_fields};
use snakes_core::genome::{BodyGenes, ControllerKind, Genome};
use snakes_core::rng::{Purpose, stream};
use snakes_core::save::{load_preset, shipped_presets};
use snakes_core::schema;
use snakes_core::score::Rollout;
use snakes_lab::run::caught;

use crate::batch::{score_all, threads_of};
use crate::champion::{Champion, evaluated};
use crate::convert::{changes_in, restorer, rows, seed_of, to_python, whole, whole_as, whole_u32};
use crate::errors::{crashed, invalid, refused, unusable};
use crate::evaluations::Evaluations;
use crate::purpose::Use;
use crate::world_rules::at_rest;

/// A preset with changed settings, as a Python class.
#[pyclass(frozen, module = "snakes_and_stairs._core")]
pub struct Problem {
    pub preset: String,
    pub settings: Settings,
    /// Genes of the body of an environment that has one of its own; None for the body in the middle of the settings' ranges.
    pub body: Option<BodyGenes>,
}

/// A problem in the form in which pickle stores it as text.
#[derive(Serialize, Deserialize)]
struct Packed {
    preset: String,
    settings: Settings,
    body: Option<BodyGenes>,
}

/// Restores a problem from the text that pickle stored.
#[pyfunction]
pub fn unpacked_problem(text: &str) -> PyResult<Problem> {
    let Packed { preset, settings, body } =
        serde_json::from_str(text).map_err(|error| PyValueError::new_err(error.to_string()))?;
    settings.check().map_err(invalid)?;
    Ok(Problem { preset, settings, body })
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

/// Number of bodies of a run among which one is drawn.
const MOST_DRAWN: u32 = 100;

impl Problem {
    /// Returns whether the rows of an array can describe the genomes completely.
    fn is_array(&self) -> bool {
        let genome = &self.settings.genome;
        !genome.bodies.vary
            && !matches!(
                genome.controller,
                ControllerKind::Grown
                    | ControllerKind::Decisions
                    | ControllerKind::JointDecisions
                    | ControllerKind::PartNeurons
            )
    }

    /// Refuses what only an array can have, if genomes are dictionaries.
    fn check_is_array(&self, field: &str) -> PyResult<()> {
        if self.is_array() {
            return Ok(());
        }
        let allowed = "a problem whose genomes are arrays of numbers; here bodies or networks grow, or a controller learns, so a \
                       genome is a dictionary: see random()";
        Err(refused(field, "asked for", allowed))
    }

    pub fn dimension(&self) -> PyResult<usize> {
        self.check_is_array("dimension")?;
        Ok(self.settings.genome.dimension(self.settings.trial.genome_shape()))
    }

    /// Returns the genomes at the rows of an array, all of whose 64 bits count, so that every genome has a row; or those in a text of
    /// JSON, a list of genomes as champions' files have them.
    pub fn genomes_in(&self, field: &str, genomes: &Bound<'_, PyAny>) -> PyResult<Vec<Genome>> {
        let (space, trial) = (&self.settings.genome, &self.settings.trial);
        let shape = trial.genome_shape();
        if let Ok(points) = genomes.extract::<PyReadonlyArray2<'_, f64>>() {
            if !self.is_array() {
                return Err(refused(
                    field,
                    "an array",
                    "a list of dictionaries, as random() gives them",
                ));
            }
            let points = rows(field, &points, self.dimension()?)?;
            return Ok(points.iter().map(|point| space.genome_at_fine(point, shape)).collect());
        }
        let text: String = genomes.extract()?;
        let genomes: Vec<Genome> = serde_json::from_str(&text).map_err(|error| {
            let allowed = "genomes as decode() and random() give them";
            refused(field, format!("unreadable ({error})"), allowed)
        })?;
        for (index, genome) in genomes.iter().enumerate() {
            let checked =
                space.check_genome(genome, shape).and_then(|()| trial.check_genome(genome));
            checked.map_err(|error| invalid(error.inside(&format!("{field}[{index}]"))))?;
        }
        Ok(genomes)
    }

    /// Returns genomes in the form that [`Self::genomes_in`] reads: the rows of an array, or dictionaries.
    pub fn described<'py>(
        &self,
        py: Python<'py>,
        genomes: &[Genome],
    ) -> PyResult<Bound<'py, PyAny>> {
        if self.is_array() {
            return Ok(self.points_of(py, genomes)?.into_any());
        }
        to_python(py, &genomes)
    }

    /// Returns the random genomes with which a run of this seed begins.
    fn first_genomes(&self, count: u32, seed: u64) -> Vec<Genome> {
        let (space, shape) = (&self.settings.genome, self.settings.trial.genome_shape());
        let genome =
            |index| space.random_genome(shape, &mut stream(seed, 1, index, Purpose::Birth));
        (0..count).map(genome).collect()
    }

    /// Returns the first body of a run of this seed that comes to rest on the ground, which few random creatures do.
    fn drawn_body(&self, seed: u64) -> PyResult<BodyGenes> {
        let trial = &self.settings.trial;
        let rests = |body: &BodyGenes| {
            let genome = at_rest(body.clone(), trial);
            trial.check_genome(&genome).is_ok()
                && caught(|| !Rollout::new(&genome, trial).is_over()).unwrap_or(false)
        };
        let mut bodies = self.first_genomes(MOST_DRAWN, seed).into_iter().map(|genome| genome.body);
        let allowed = "a seed with a body that comes to rest on the ground";
        bodies.find(rests).ok_or_else(|| refused("body", seed, allowed))
    }

    /// Gives an environment a body: that of a champion with its blocks, that of a run of a seed, or, without a choice, that of the
    /// settings, and where bodies evolve that of seed 1.
    fn choose_body(&mut self, body: Option<&Bound<'_, PyAny>>, has_agent: bool) -> PyResult<()> {
        let Some(body) = body.filter(|body| !body.is_none()) else {
            if self.settings.genome.bodies.vary {
                self.body = Some(self.drawn_body(1)?);
            }
            return Ok(());
        };
        if let Ok(champion) = body.cast::<Champion>() {
            let champion = &champion.get().loaded.champion;
            if has_agent && self.settings.trial.agent != champion.trial.agent {
                let allowed = "no settings of trial.agent beside body=..., which has its own";
                return Err(refused("settings", "of trial.agent", allowed));
            }
            self.settings.trial.agent = champion.trial.agent.clone();
            self.body = Some(champion.genome.body.clone());
            return Ok(());
        }
        let allowed = "None, a seed, a champion or the path of its file";
        let seed = whole_as("body", body, 0..=u64::MAX, allowed)?;
        self.body = Some(self.drawn_body(seed)?);
        Ok(())
    }

    /// Returns the origin of a snake that Python found.
    pub fn origin(
        &self,
        seed: &Bound<'_, PyAny>,
        generation: &Bound<'_, PyAny>,
        individual: &Bound<'_, PyAny>,
    ) -> PyResult<Origin> {
        Ok(Origin {
            preset: self.preset.clone(),
            seed: seed_of(seed)?,
            generation: whole_u32("generation", generation)?,
            individual: whole_u32("individual", individual)?,
        })
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
    fn points_of<'py>(
        &self,
        py: Python<'py>,
        genomes: &[Genome],
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let points: Vec<Vec<f64>> = genomes
            .iter()
            .map(|genome| self.point_of_genome(py, genome))
            .collect::<PyResult<_>>()?;
        let shape = (genomes.len(), self.dimension()?);
        let array = numpy::ndarray::Array2::from_shape_vec(shape, points.concat());
        Ok(array.map_err(|error| crashed(error.to_string()))?.into_pyarray(py))
    }
}

#[pymethods]
impl Problem {
    #[new]
    #[pyo3(signature = (preset, stairs=None, settings=None, purpose="evaluation", strategy=None, body=None))]
    fn new(
        preset: &str,
        stairs: Option<&Bound<'_, PyAny>>,
        settings: Option<&Bound<'_, PyAny>>,
        purpose: &str,
        strategy: Option<&str>,
        body: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let purpose = Use::named(purpose)?;
        let preset = load_preset(preset).map_err(unusable)?;
        let mut changes = changes_in("stairs", "trial.stairs.", stairs)?;
        let others = changes_in("settings", "", settings)?;
        let mut has_agent = false;
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
            has_agent |= full.starts_with("trial.agent.");
        }
        changes.extend(others);
        if let Some(strategy) = strategy {
            changes.push(("evolution.strategy".to_owned(), strategy.to_owned()));
        }
        let changes = changes.iter().map(|(path, text)| (path.as_str(), text.as_str()));
        let settings = with_fields(&preset.settings, changes).map_err(invalid)?;
        settings.check_start().map_err(invalid)?;
        let mut problem = Self { preset: preset.name, settings, body: None };
        if purpose == Use::Environment {
            problem.choose_body(body, has_agent)?;
        }
        Ok(problem)
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
    fn dimension_in_python(&self) -> PyResult<usize> {
        self.dimension()
    }

    /// Packs the problem for pickle.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        let Self { preset, settings, body } = self;
        let packed =
            Packed { preset: preset.clone(), settings: settings.clone(), body: body.clone() };
        let text = serde_json::to_string(&packed).map_err(|error| crashed(error.to_string()))?;
        Ok((restorer(py, "unpacked_problem")?, (text,)))
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
        self.check_is_array("genes")?;
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

    /// Returns random genomes, with which a run of this seed would begin.
    fn random<'py>(
        &self,
        py: Python<'py>,
        count: &Bound<'py, PyAny>,
        seed: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let count = whole("count", count, 0..=evolve::LARGEST_POPULATION.into())?;
        self.described(py, &self.first_genomes(count as u32, seed_of(seed)?))
    }

    /// Returns genomes as dictionaries.
    fn decode<'py>(
        &self,
        py: Python<'py>,
        genomes: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        to_python(py, &self.genomes_in("genomes", genomes)?)
    }

    /// Returns a champion's genome: its row, or a dictionary.
    fn genome_of<'py>(&self, py: Python<'py>, champion: &Champion) -> PyResult<Bound<'py, PyAny>> {
        let (genome, shape) = (champion.genome(), self.settings.trial.genome_shape());
        let space = &self.settings.genome;
        space.check_genome(genome, shape).map_err(|error| invalid(error.inside("champion")))?;
        if self.is_array() {
            return Ok(self.point_of_genome(py, genome)?.into_pyarray(py).into_any());
        }
        to_python(py, genome)
    }

    #[pyo3(signature = (genomes, threads=None))]
    fn evaluate(
        &self,
        py: Python<'_>,
        genomes: &Bound<'_, PyAny>,
        threads: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Evaluations> {
        let (genomes, trial) = (self.genomes_in("genomes", genomes)?, &self.settings.trial);
        let scored = score_all(py, &genomes, trial, threads_of(threads)?)?;
        Ok(Evaluations::new(&genomes, scored, &trial.stairs))
    }

    /// Writes a snake to a file, as a champion that the program can replay.
    fn save_champion(
        &self,
        py: Python<'_>,
        path: PathBuf,
        genome: &Bound<'_, PyAny>,
        seed: &Bound<'_, PyAny>,
        generation: &Bound<'_, PyAny>,
        individual: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let mut genomes = self.genomes_in("genome", genome)?;
        let count = genomes.len();
        let (Some(genome), true) = (genomes.pop(), count == 1) else {
            return Err(refused("genome", format!("{count} genomes"), "one"));
        };
        let origin = self.origin(seed, generation, individual)?;
        evaluated(py, genome, self.settings.trial.clone(), origin)?.store(&path)
    }
}
