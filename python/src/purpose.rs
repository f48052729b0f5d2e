//! The purposes of a problem, and which settings have an effect for each.

use pyo3::prelude::*;

use crate::errors::refused;

/// Purpose of a problem, which decides which settings have an effect.
#[derive(Clone, Copy, PartialEq)]
pub enum Use {
    Environment,
    Evaluation,
    Search,
}

impl Use {
    pub fn named(name: &str) -> PyResult<Self> {
        match name {
            "environment" => Ok(Self::Environment),
            "evaluation" => Ok(Self::Evaluation),
            "search" => Ok(Self::Search),
            _ => Err(refused("use", format!("{name:?}"), "environment, evaluation or search")),
        }
    }

    /// Refuses a setting without an effect for this purpose. `path` is its full dotted name.
    pub fn check(self, path: &str) -> PyResult<()> {
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
