//! The program's strategies, driven from Python: ask, evaluate, tell.

use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard};

use numpy::{IntoPyArray, PyReadonlyArray1};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use serde::{Deserialize, Serialize};
use snakes_core::evolve::{
    Candidate, Founder, Origin, RunPlan, Strategy, StrategyKind, StrategyState, begin, resume,
};
use snakes_core::genome::{Genome, Segment};
use snakes_core::score::{Evaluation, FITNESS_RANGE, Scored};
use snakes_core::world::Disqualification;
use snakes_lab::run::caught;

use crate::batch::{score_all, threads_of};
use crate::champion::{Champion, evaluated};
use crate::convert::{restorer, seed_of, whole};
use crate::errors::{crashed, invalid, refused};
use crate::evaluations::Evaluations;
use crate::problem::Problem;

/// A strategy in progress, as a Python class.
#[pyclass(frozen, module = "snakes_and_stairs._core")]
pub struct Search {
    problem: Py<Problem>,
    plan: RunPlan,
    founder: Option<Py<Champion>>,
    state: Mutex<SearchState>,
}

/// The state of a search in the form in which pickle stores it as text.
#[derive(Serialize, Deserialize)]
struct Packed {
    strategy: StrategyState,
    is_asked: bool,
    finished: u32,
    evaluated: u64,
}

/// Restores a search from what pickle stored.
#[pyfunction]
pub fn unpacked_search(
    py: Python<'_>,
    problem: Py<Problem>,
    seed: u64,
    founder: Option<Py<Champion>>,
    text: &str,
) -> PyResult<Search> {
    let Packed { strategy, is_asked, finished, evaluated } =
        serde_json::from_str(text).map_err(|error| PyValueError::new_err(error.to_string()))?;
    let plan = Search::plan(&problem, seed, founder.as_ref())?;
    let strategy = py
        .detach(|| caught(|| resume(&plan, finished, &strategy)))
        .map_err(crashed)?
        .map_err(invalid)?;
    let asked = is_asked.then(|| strategy.ask());
    let state = Mutex::new(SearchState { strategy, asked, finished, evaluated });
    Ok(Search { problem, plan, founder, state })
}

struct SearchState {
    strategy: Box<dyn Strategy>,
    /// Candidates of the generation in progress, if they were requested.
    asked: Option<Vec<Candidate>>,
    finished: u32,
    evaluated: u64,
}

impl SearchState {
    /// Returns the genomes of the generation in progress. Requests them from the strategy if necessary.
    fn genomes(&mut self) -> Vec<Genome> {
        let asked = self.asked.get_or_insert_with(|| self.strategy.ask());
        asked.iter().map(|candidate| candidate.genome.clone()).collect()
    }

    /// Returns the candidates of the generation in progress, or an error that names `use_of_them` if they were not requested.
    fn asked(&self, use_of_them: &str) -> PyResult<&[Candidate]> {
        self.asked.as_deref().ok_or_else(|| {
            let message = format!("{use_of_them} without ask: call ask() or evaluate() first");
            PyRuntimeError::new_err(message)
        })
    }
}

impl Search {
    /// Locks the state. If another thread panicked during a change, the search cannot continue.
    fn state(&self) -> PyResult<MutexGuard<'_, SearchState>> {
        self.state.lock().map_err(|_| PyRuntimeError::new_err("the search failed before"))
    }

    /// Returns the plan of a search, checked.
    fn plan(problem: &Py<Problem>, seed: u64, founder: Option<&Py<Champion>>) -> PyResult<RunPlan> {
        let of = problem.get();
        let mut plan = RunPlan::new(&of.preset, seed, of.settings.clone());
        if let Some(champion) = founder {
            let founder = Founder::new("a champion", champion.get().genome().clone());
            plan = plan.starting_from(founder).map_err(invalid)?;
        }
        let evolution = &plan.settings.evolution;
        let kind = evolution.strategy;
        if kind.info().evolves_stairs {
            let allowed = "a strategy whose snakes all have the stairs of the problem; the command snakes runs this one";
            return Err(refused("evolution.strategy", kind.name(), allowed));
        }
        if evolution.ladder.is_used() {
            let allowed = "0: a search has no ladder, whose rungs the command snakes climbs";
            let field = "evolution.ladder.first_rise_m";
            return Err(refused(field, evolution.ladder.first_rise_m, allowed));
        }
        Ok(plan)
    }

    /// Lets the strategy learn from results. `hashes` are those of the results' genomes; without hashes, results must be in the
    /// order of the candidates.
    fn learn(&self, scored: Vec<Scored>, hashes: Option<&[u64]>) -> PyResult<()> {
        let mut state = self.state()?;
        let candidates = state.asked("tell")?.to_vec();
        if scored.len() != candidates.len() {
            let allowed = format!("{}, as many as were asked for", candidates.len());
            return Err(refused("number of results", scored.len(), &allowed));
        }
        let mut pairs = candidates.iter().zip(hashes.unwrap_or_default());
        if let Some(index) = pairs.position(|(candidate, hash)| candidate.genome.hash() != *hash) {
            let field = format!("results[{index}]");
            let allowed = "results of the genomes that were asked for, in their order";
            return Err(refused(&field, "of another genome", allowed));
        }
        let (evaluations, episodes) =
            scored.into_iter().map(|scored| (scored.evaluation, scored.episode)).unzip();
        let evaluations: Vec<Evaluation> = evaluations;
        let strategy = &mut state.strategy;
        caught(|| {
            strategy.learn(episodes);
            strategy.tell(&candidates, &evaluations);
        })
        .map_err(crashed)?;
        state.asked = None;
        state.finished += 1;
        state.evaluated += candidates.len() as u64;
        Ok(())
    }
}

#[pymethods]
impl Search {
    #[new]
    #[pyo3(signature = (problem, seed, founder=None))]
    fn new(
        py: Python<'_>,
        problem: Py<Problem>,
        seed: &Bound<'_, PyAny>,
        founder: Option<Py<Champion>>,
    ) -> PyResult<Self> {
        let plan = Self::plan(&problem, seed_of(seed)?, founder.as_ref())?;
        let strategy = py.detach(|| caught(|| begin(&plan))).map_err(crashed)?;
        let state = SearchState { strategy, asked: None, finished: 0, evaluated: 0 };
        Ok(Self { problem, plan, founder, state: Mutex::new(state) })
    }

    /// Packs the search for pickle: it goes on with the same bits.
    #[expect(clippy::type_complexity, reason = "a function and its arguments")]
    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, (Py<Problem>, u64, Option<Py<Champion>>, String))> {
        let packed = {
            let SearchState { strategy, asked, finished, evaluated } = &*self.state()?;
            Packed {
                strategy: strategy.state(),
                is_asked: asked.is_some(),
                finished: *finished,
                evaluated: *evaluated,
            }
        };
        let text = serde_json::to_string(&packed).map_err(|error| crashed(error.to_string()))?;
        let founder = self.founder.as_ref().map(|founder| founder.clone_ref(py));
        let arguments = (self.problem.clone_ref(py), self.plan.seed, founder, text);
        Ok((restorer(py, "unpacked_search")?, arguments))
    }

    #[getter]
    fn problem(&self, py: Python<'_>) -> Py<Problem> {
        self.problem.clone_ref(py)
    }

    #[getter]
    fn strategy(&self) -> &'static str {
        self.plan.settings.evolution.strategy.info().name
    }

    #[getter]
    fn seed(&self) -> u64 {
        self.plan.seed
    }

    /// Number of finished generations.
    #[getter]
    fn generation(&self) -> PyResult<u32> {
        Ok(self.state()?.finished)
    }

    /// Number of evaluations from which the strategy has learned so far.
    #[getter]
    fn evaluations(&self) -> PyResult<u64> {
        Ok(self.state()?.evaluated)
    }

    /// Number of snakes in the next generation.
    #[getter]
    fn population(&self) -> PyResult<usize> {
        Ok(self.state()?.strategy.population())
    }

    /// Whether a run with these settings would be over.
    #[getter]
    fn is_over(&self) -> PyResult<bool> {
        let state = self.state()?;
        let next = state.strategy.population() as u64;
        Ok(self.plan.is_over(state.finished, state.evaluated, next))
    }

    /// Returns the genomes of the next generation: the rows of an array, or dictionaries.
    fn ask<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let genomes = self.state()?.genomes();
        self.problem.get().described(py, &genomes)
    }

    /// Evaluates the next generation as a run does.
    #[pyo3(signature = (threads=None))]
    fn evaluate(
        &self,
        py: Python<'_>,
        threads: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Evaluations> {
        let threads = threads_of(threads)?;
        let (genomes, generation) = {
            let mut state = self.state()?;
            (state.genomes(), state.finished + 1)
        };
        let trial = self.plan.trial_in(generation);
        let scored = score_all(py, &genomes, &trial, threads)?;
        Ok(Evaluations::new(&genomes, scored, &trial.stairs))
    }

    /// Returns a snake of the generation in progress as a champion.
    fn champion(&self, py: Python<'_>, index: &Bound<'_, PyAny>) -> PyResult<Champion> {
        let (mut candidates, generation) = {
            let state = self.state()?;
            (state.asked("champion")?.to_vec(), state.finished + 1)
        };
        let last = (candidates.len() as u64).saturating_sub(1);
        let index = whole("index", index, 0..=last)?;
        if candidates.is_empty() {
            return Err(refused("index", index, "nothing: the generation is empty"));
        }
        let genome = candidates.swap_remove(index as usize).genome;
        let (preset, seed) = (self.plan.preset.clone(), self.plan.seed);
        let origin = Origin { preset, seed, generation, individual: index as u32 };
        evaluated(py, genome, self.plan.trial_in(generation), origin)
    }

    /// Writes a snake of the generation in progress to a file, as a champion.
    fn save_champion(
        &self,
        py: Python<'_>,
        path: PathBuf,
        index: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        self.champion(py, index)?.store(&path)
    }

    /// Lets the strategy learn from evaluations of the generation in progress.
    fn tell(&self, results: &Evaluations) -> PyResult<()> {
        self.learn(results.scored.clone(), Some(&results.genomes))
    }

    /// Lets the strategy learn from a fitness that the user computed.
    #[pyo3(signature = (fitness, disqualified=None))]
    fn tell_fitness(
        &self,
        fitness: PyReadonlyArray1<'_, f64>,
        disqualified: Option<PyReadonlyArray1<'_, bool>>,
    ) -> PyResult<()> {
        let kind = self.plan.settings.evolution.strategy;
        let needs_more = matches!(kind, StrategyKind::MapElites | StrategyKind::Novelty)
            || self.state()?.strategy.learns_from_episodes();
        if needs_more {
            let allowed =
                "the result of evaluate(): this strategy also learns from how the snakes moved";
            return Err(refused(
                &format!("results of {}", self.strategy()),
                "fitness alone",
                allowed,
            ));
        }
        let fitness = fitness.as_array();
        let disqualified = disqualified.as_ref().map(|flags| flags.as_array());
        if let Some(flags) = disqualified
            && flags.len() != fitness.len()
        {
            let allowed = format!("{}, as many as fitness has", fitness.len());
            return Err(refused("number of flags in disqualified", flags.len(), &allowed));
        }
        let scored = fitness.iter().enumerate().map(|(index, &value)| {
            let is_out = disqualified.is_some_and(|flags| flags[index]);
            let fitness = if is_out { 0.0 } else { value as f32 };
            if !FITNESS_RANGE.contains(&fitness) {
                let (least, most) = (FITNESS_RANGE.start(), FITNESS_RANGE.end());
                let allowed = format!("{least} to {most}, or disqualified");
                return Err(refused(&format!("fitness[{index}]"), value, &allowed));
            }
            let evaluation = Evaluation {
                fitness,
                centre_y_m: 0.0,
                disqualified: is_out.then_some(Disqualification::NotFinite),
                trace_hash: 0,
                steps: 0,
                effort: None,
                behaviour: None,
                ending: None,
            };
            Ok(Scored { evaluation, episode: None })
        });
        let scored = scored.collect::<PyResult<_>>()?;
        self.learn(scored, None)
    }

    /// Returns the elites of MAP-Elites; None for a strategy without an archive.
    fn archive<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        // The archive is copied, so that the lock is free when a warning lets other Python threads run.
        let Some(archive) = self.state()?.strategy.archive() else { return Ok(None) };
        let problem = self.problem.get();
        let (space, shape) = (&problem.settings.genome, problem.settings.trial.genome_shape());
        let elites = PyList::empty(py);
        for (cell, elite) in archive.elites() {
            // The archive's coordinates are those of the strategy, with 32 bits.
            let genome = elite.genes.genome(space, shape);
            let entry = PyDict::new(py);
            let [column, row] = archive.place(cell);
            entry.set_item("column", column)?;
            entry.set_item("row", row)?;
            entry.set_item("fitness", f64::from(elite.fitness))?;
            entry.set_item("generation", elite.generation)?;
            entry.set_item("individual", elite.individual)?;
            if genome.body.has_own_blocks() {
                // Genomes with bodies of their own differ in length, so the elite has the length, width and height of each block
                // instead.
                let sizes = |of: &Segment| [of.length_m, of.width_m, of.height_m].map(f64::from);
                let blocks: Vec<[f64; 3]> = genome.body.segments.iter().map(sizes).collect();
                entry.set_item("blocks", blocks)?;
            } else {
                entry.set_item("genome", problem.point_of_genome(py, &genome)?.into_pyarray(py))?;
            }
            elites.append(entry)?;
        }
        let dictionary = PyDict::new(py);
        dictionary.set_item("x", archive.x.label)?;
        dictionary.set_item("y", archive.y.label)?;
        dictionary.set_item("columns", archive.x.cells)?;
        dictionary.set_item("rows", archive.y.cells)?;
        dictionary.set_item("coverage", archive.coverage())?;
        dictionary.set_item("qd_score", archive.qd_score())?;
        dictionary.set_item("elites", elites)?;
        Ok(Some(dictionary))
    }

    fn __repr__(&self) -> PyResult<String> {
        let state = self.state()?;
        let (strategy, seed) = (self.strategy(), self.plan.seed);
        let (finished, evaluated) = (state.finished, state.evaluated);
        Ok(format!(
            "<Search by {strategy}, seed {seed}: {finished} generations, {evaluated} evaluations>"
        ))
    }
}
