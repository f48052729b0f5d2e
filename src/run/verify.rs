//! Does this machine compute the bits that every other one does?
//!
//! Short runs that between them reach everything that decides bits: each controller, each strategy, each
//! feature of surface, body and stairs. Their hashes stand in `assets/golden.ron`, which is part of the
//! program. Whoever adds a setting adds a run that changes it: a test counts.

mod cases;

use rayon::ThreadPool;
use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3Default;

use super::calibrate::Calibration;
use super::{Cancelled, Control, Experiment};
use crate::ENGINE_VERSION;
use crate::check::Invalid;
use crate::evolve::Settings;
use crate::save::SaveError;

use cases::cases;

/// Something that has bits, and their hash.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Trajectory {
    /// What is computed.
    pub what: String,
    /// Hash over all its bits, in 16 hexadecimal digits.
    pub hash: String,
}

/// What an engine computes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Trajectories {
    /// The engine.
    pub engine: u32,
    /// In a fixed order.
    pub trajectories: Vec<Trajectory>,
}

/// Why there is nothing to compare.
#[derive(Debug, thiserror::Error)]
pub enum VerifyError {
    /// An embedded preset is broken, which a test rules out.
    #[error(transparent)]
    Preset(#[from] SaveError),
    /// A case is not allowed, which a test rules out.
    #[error(transparent)]
    Case(#[from] Invalid),
    /// The embedded reference is broken, which a test rules out.
    #[error("the reference is broken: {0}")]
    Reference(#[from] ron::error::SpannedError),
    /// The interrupt key was pressed.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Trajectories {
    /// One hash over all, in 16 hexadecimal digits.
    pub fn fingerprint(&self) -> String {
        let mut hash = Xxh3Default::new();
        hash.update(&self.engine.to_le_bytes());
        for Trajectory { what, hash: bits } in &self.trajectories {
            hash.update(what.as_bytes());
            hash.update(bits.as_bytes());
        }
        format!("{:016x}", hash.digest())
    }

    /// What the reference machine computed with this engine.
    ///
    /// # Errors
    /// The embedded reference is broken, which a test rules out.
    pub fn reference() -> Result<Self, VerifyError> {
        Ok(ron::from_str(include_str!("../../assets/golden.ron"))?)
    }

    /// What this machine computes. `each` is told how many of how many are done.
    ///
    /// # Errors
    /// [`VerifyError::Cancelled`], if `control` was.
    pub fn computed(
        pool: &ThreadPool,
        control: &Control,
        mut each: impl FnMut(usize, usize),
    ) -> Result<Self, VerifyError> {
        let cases = cases()?;
        let all = cases.len() + 1;
        let mut trajectories = Vec::with_capacity(all);
        for (index, (what, plan)) in cases.into_iter().enumerate() {
            each(index, all);
            let mut experiment = Experiment::new(plan);
            while !experiment.is_over() {
                experiment.run_generation(pool, control)?;
            }
            let hash = format!("{:016x}", experiment.run_hash());
            trajectories.push(Trajectory { what, hash });
        }
        trajectories.push(search_for_settings()?);
        each(all, all);
        Ok(Self { engine: ENGINE_VERSION, trajectories })
    }
}

/// The numbers that the search for settings draws: random streams, logarithms, exponentials.
fn search_for_settings() -> Result<Trajectory, VerifyError> {
    let mut hash = Xxh3Default::new();
    for seed in 0..20 {
        let mut search = Calibration::new(Settings::default(), seed);
        for _ in 0..5 {
            let (values, _) = search.next_point()?;
            values.iter().for_each(|value| hash.update(&value.to_bits().to_le_bytes()));
        }
    }
    let what = "100 points of the search for settings".to_owned();
    Ok(Trajectory { what, hash: format!("{:016x}", hash.digest()) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::fields;
    use crate::save::load_preset;

    #[test]
    fn every_setting_is_changed_by_some_case() {
        let mut report = load_preset("report").expect("well formed").settings;
        report.trial.ground = Some(report.trial.surface.clone());
        let unchanged = fields(&report);
        let cases = cases().expect("allowed");
        let changed = |(path, value): &(String, String)| {
            cases.iter().any(|(_, plan)| {
                fields(&plan.settings).iter().any(|(p, v)| p == path && v != value)
            })
        };
        let missing: Vec<&String> =
            unchanged.iter().filter(|field| !changed(field)).map(|(path, _)| path).collect();
        assert_eq!(missing, Vec::<&String>::new(), "add a case to src/run/verify/cases.rs");
    }

    #[test]
    fn every_case_has_bits_of_its_own() {
        let reference = Trajectories::reference().expect("well formed");
        assert_eq!(reference.engine, ENGINE_VERSION);
        let mut hashes: Vec<&String> = reference.trajectories.iter().map(|t| &t.hash).collect();
        let all = hashes.len();
        hashes.sort();
        hashes.dedup();
        assert_eq!(hashes.len(), all, "two cases compute the same");
    }

    #[test]
    fn a_single_other_bit_gives_another_fingerprint() {
        let reference = Trajectories::reference().expect("well formed");
        let mut other = reference.clone();
        other.trajectories[7].hash.replace_range(0..1, "x");
        assert_ne!(reference.fingerprint(), other.fingerprint());
    }
}
