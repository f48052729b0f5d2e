//! Measurements besides the runs of a study: motions of newborns, and built-in champions in the other physics engine.

use super::definition::Study;
use super::newborns::{NewbornStatistics, newborn_statistics};
use crate::run::exam::examine;
use crate::run::headless::{HeadlessError, say};
use crate::run::{Cancelled, Evaluator, RunControl};
use snakes_core::save::library::shipped_champions;
use snakes_core::save::load_preset;
use snakes_core::score::ExamSuite;

/// Results of the measurements besides the runs of a study.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Findings {
    /// Statistics of the newborns' motions; empty if they were not measured.
    pub newborns: Vec<NewbornStatistics>,
    /// Number of newborns that are healthy in both engines, and number of all newborns.
    pub healthy: [usize; 2],
    /// Name of each built-in champion, and the share of its way that it keeps in the other engine. Empty if not measured.
    pub built_in: Vec<(String, f32)>,
}

impl Findings {
    /// Returns the greatest relative difference of a quartile of newborns between the engines; `None` without newborns.
    pub fn greatest_difference(&self) -> Option<f64> {
        let differences: Option<Vec<f64>> =
            self.newborns.iter().map(NewbornStatistics::greatest_difference).collect();
        differences?.into_iter().reduce(f64::max)
    }

    /// Makes the measurements that the definition of the study requests.
    ///
    /// # Errors
    /// `control` was cancelled, or the study's preset cannot be read.
    pub(super) fn of(
        study: &Study,
        evaluator: &dyn Evaluator,
        control: &RunControl,
    ) -> Result<Self, HeadlessError> {
        let cancelled = |Cancelled| HeadlessError::Cancelled { kept: None };
        let mut findings = Self::default();
        if let Some(count) = study.newborns {
            say(&format!("{count} newborns in both engines"));
            let settings = load_preset(&study.preset)?.settings;
            let (newborns, healthy) =
                newborn_statistics(&settings, study.first_seed, count, evaluator, control)
                    .map_err(cancelled)?;
            (findings.newborns, findings.healthy) = (newborns, [healthy, count as usize]);
        }
        if study.built_in_champions {
            say("built-in champions in the other engine");
            for (name, loaded) in shipped_champions() {
                let suites = [ExamSuite::Engine];
                let results =
                    examine(&loaded.champion, &suites, evaluator, control).map_err(cancelled)?;
                let kept = results.first().map(|result| (name.to_owned(), result.kept));
                findings.built_in.extend(kept);
            }
        }
        Ok(findings)
    }
}
