//! The compiled part of the Python package `snakes_and_stairs`. The public interface, with all checks of types and all
//! documentation, is Python code in the same package; `snakes_and_stairs/_core.pyi` lists the contents of this module.
//!
//! All simulation and scoring happens in the core: environments advance a `score::Rollout`, evaluations call `score::score`.

mod batch;
mod champion;
mod convert;
mod errors;
mod evaluations;
mod problem;
mod purpose;
mod search;
mod world;
mod world_rules;
mod world_threads;
mod worlds;

use pyo3::prelude::*;

#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<problem::Problem>()?;
    module.add_class::<evaluations::Evaluations>()?;
    module.add_class::<search::Search>()?;
    module.add_class::<champion::Champion>()?;
    module.add_class::<worlds::Worlds>()?;
    module.add_function(wrap_pyfunction!(champion::load_champion, module)?)?;
    module.add_function(wrap_pyfunction!(champion::load_run, module)?)?;
    module.add_function(wrap_pyfunction!(champion::replay, module)?)?;
    module.add_function(wrap_pyfunction!(problem::presets, module)?)?;
    module.add_function(wrap_pyfunction!(evaluations::unpacked_evaluations, module)?)?;
    module.add_function(wrap_pyfunction!(problem::unpacked_problem, module)?)?;
    module.add_function(wrap_pyfunction!(champion::unpacked_champion, module)?)?;
    module.add_function(wrap_pyfunction!(search::unpacked_search, module)?)?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("ENGINE_VERSION", snakes_core::ENGINE_VERSION)?;
    Ok(())
}
