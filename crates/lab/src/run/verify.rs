//! Checks that this machine computes the same bits as the reference machine.
//!
//! Short runs together cover everything that affects bits: each controller, each strategy, each feature of surface, body and
//! stairs. Their hashes are in `assets/golden.ron` and `assets/golden-arm64.ron`, which are embedded in the program. A test checks
//! that each setting is changed by one of the runs.

mod cases;
mod drawn_points;

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3Default;

use super::evaluator::Evaluator;
use super::experiment::Experiment;
use super::run_control::{Cancelled, RunControl};
use snakes_core::check::Invalid;
use snakes_core::evolve::RunPlan;
use snakes_core::save::SaveError;
use snakes_core::schema::is_default;
use snakes_core::world::PhysicsEngine;
use snakes_core::{ENGINE_VERSION, Processors};

pub use cases::golden_plans;
use drawn_points::{DRAWN_POINTS, hash_of_drawn_points};

/// A case with at most this number of evaluations is short.
const SHORT_BUDGET: u64 = 12;
/// Maximum number of short cases.
const SHORT_CASES: usize = 12;

/// A computation and the hash of its bits.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Trajectory {
    /// Description of the computation.
    pub what: String,
    /// Hash over all bits of the computation, in 16 hexadecimal digits.
    pub hash: String,
}

/// Results of the physics engine on one kind of processor.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Trajectories {
    /// Version of the engine.
    pub engine: u32,
    /// Kind of processor.
    #[serde(default, skip_serializing_if = "is_default")]
    pub processors: Processors,
    /// Hashes of the computations, in a fixed order.
    pub trajectories: Vec<Trajectory>,
}

/// Errors of a comparison of trajectories.
#[derive(Debug, thiserror::Error)]
pub enum VerifyError {
    /// An embedded preset is broken. A test rules this out.
    #[error(transparent)]
    Preset(#[from] SaveError),
    /// A case is not allowed. A test rules this out.
    #[error(transparent)]
    Case(#[from] Invalid),
    /// The embedded reference is broken. A test rules this out.
    #[error("the reference is broken: {0}")]
    Reference(#[from] ron::error::SpannedError),
    /// This build has another kind of processor than all references.
    #[error(
        "there is no reference for this processor, or for a build without SIMD; there are some for x86-64 and arm64"
    )]
    NoReference,
    /// This machine computes other bits than its reference. Holds the description of the computation.
    #[error("{0}: this machine computes other bits than the reference (see snakes verify)")]
    OtherBits(String),
    /// The interrupt key was pressed.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Trajectory {
    fn of(what: String, hash: u64) -> Self {
        Self { what, hash: format!("{hash:016x}") }
    }
}

impl Trajectories {
    /// Returns one hash over the engine's version and all results, in 16 hexadecimal digits.
    pub fn fingerprint(&self) -> String {
        let mut hash = Xxh3Default::new();
        hash.update(&self.engine.to_le_bytes());
        for Trajectory { what, hash: bits } in &self.trajectories {
            hash.update(what.as_bytes());
            hash.update(bits.as_bytes());
        }
        format!("{:016x}", hash.digest())
    }

    /// Returns the reference results of this engine on this kind of processor.
    ///
    /// # Errors
    /// There is no reference for this kind of processor, or the reference is broken, which a test rules out.
    pub fn reference() -> Result<Self, VerifyError> {
        Self::reference_of(Processors::THIS)
    }

    fn reference_of(processors: Processors) -> Result<Self, VerifyError> {
        let text = match processors {
            Processors::X86_64 => include_str!("../../../../assets/golden.ron"),
            Processors::Arm64 => include_str!("../../../../assets/golden-arm64.ron"),
            Processors::Other => return Err(VerifyError::NoReference),
        };
        Ok(ron::from_str(text)?)
    }

    /// Computes some short cases, which show within a second or two whether this machine computes the same bits as the reference
    /// machine.
    ///
    /// # Errors
    /// [`VerifyError::NoReference`] or [`VerifyError::OtherBits`], if the bits cannot be compared or differ;
    /// [`VerifyError::Cancelled`], if `control` was cancelled.
    pub fn short(evaluator: &dyn Evaluator, control: &RunControl) -> Result<Self, VerifyError> {
        let reference = Self::reference()?;
        let is_short = |(_, plan): &&(String, RunPlan)| plan.budget() <= SHORT_BUDGET;
        let mut trajectories = Vec::new();
        let cases = golden_plans()?;
        let in_lanes = |(_, plan): &&(String, RunPlan)| is_in_lanes(plan);
        let of_rapier = cases.iter().filter(|case| is_short(case) && !in_lanes(case));
        let of_rapier = of_rapier.take(SHORT_CASES);
        let of_lanes = cases.iter().filter(in_lanes).take(1);
        for (what, plan) in of_rapier.chain(of_lanes) {
            trajectories.push(trajectory(what.clone(), plan.clone(), evaluator, control)?);
        }
        trajectories.push(Trajectory::of(DRAWN_POINTS.to_owned(), hash_of_drawn_points()));
        match trajectories.iter().find(|found| !reference.trajectories.contains(found)) {
            Some(other) => Err(VerifyError::OtherBits(other.what.clone())),
            None => Ok(Self { engine: ENGINE_VERSION, processors: Processors::THIS, trajectories }),
        }
    }

    /// Computes all cases on this machine. Calls `progress` with the number of finished computations and the number of all.
    ///
    /// # Errors
    /// [`VerifyError::Cancelled`], if `control` was cancelled.
    pub fn computed(
        evaluator: &dyn Evaluator,
        control: &RunControl,
        mut progress: impl FnMut(usize, usize),
    ) -> Result<Self, VerifyError> {
        let cases = golden_plans()?;
        let all = cases.len() + 1;
        let mut trajectories = Vec::with_capacity(all);
        for (index, (what, plan)) in cases.into_iter().enumerate() {
            progress(index, all);
            trajectories.push(trajectory(what, plan, evaluator, control)?);
        }
        trajectories.push(Trajectory::of(DRAWN_POINTS.to_owned(), hash_of_drawn_points()));
        progress(all, all);
        Ok(Self { engine: ENGINE_VERSION, processors: Processors::THIS, trajectories })
    }
}

/// Computes a case, and returns the hash of its run.
fn trajectory(
    what: String,
    plan: RunPlan,
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<Trajectory, Cancelled> {
    let mut experiment = Experiment::new(plan);
    while !experiment.is_over() {
        experiment.run_generation(evaluator, control)?;
    }
    Ok(Trajectory::of(what, experiment.run_hash()))
}

fn is_in_lanes(plan: &RunPlan) -> bool {
    plan.settings.trial.physics.engine == PhysicsEngine::Lanes
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::evolve::fields;
    use snakes_core::save::load_preset;

    #[test]
    fn every_setting_is_changed_by_some_case() {
        let mut report = load_preset("report").expect("well formed").settings;
        report.trial.ground = Some(report.trial.surface.clone());
        let unchanged = fields(&report);
        let cases = golden_plans().expect("allowed");
        let changed = |(path, value): &(String, String)| {
            cases.iter().any(|(_, plan)| {
                fields(&plan.settings).iter().any(|(p, v)| p == path && v != value)
            })
        };
        // A setting that is newer than the reference is not written while it has its default value, which has no effect. Its case
        // belongs to the next reference.
        let written = serde_json::to_value(&report).expect("written");
        let is_written =
            |path: &str| written.pointer(&format!("/{}", path.replace('.', "/"))).is_some();
        let missing: Vec<&String> = unchanged
            .iter()
            .filter(|field| !changed(field) && is_written(&field.0))
            .map(|(path, _)| path)
            .collect();
        assert_eq!(
            missing,
            Vec::<&String>::new(),
            "add a case to crates/lab/src/run/verify/cases.rs"
        );
    }

    #[test]
    fn no_two_cases_have_the_same_hash() {
        let reference = Trajectories::reference().expect("well formed");
        assert_eq!(reference.engine, ENGINE_VERSION);
        let mut hashes: Vec<&String> = reference.trajectories.iter().map(|t| &t.hash).collect();
        let all = hashes.len();
        hashes.sort();
        hashes.dedup();
        assert_eq!(hashes.len(), all, "two cases compute the same");
    }

    /// A reference without its processors would fail `snakes verify` even where all bits are equal.
    #[test]
    fn each_reference_names_its_processors_and_holds_the_same_cases() {
        let names = |of: &Trajectories| -> Vec<String> {
            of.trajectories.iter().map(|trajectory| trajectory.what.clone()).collect()
        };
        let first = Trajectories::reference_of(Processors::X86_64).expect("well formed");
        for processors in [Processors::X86_64, Processors::Arm64] {
            let reference = Trajectories::reference_of(processors).expect("well formed");
            assert_eq!((reference.engine, reference.processors), (ENGINE_VERSION, processors));
            assert_eq!(names(&reference), names(&first), "{processors:?}");
        }
    }

    #[test]
    fn the_references_of_all_processors_agree_in_lanes() {
        let cases = golden_plans().expect("well formed");
        let is_of_lanes =
            |what: &String| cases.iter().any(|(case, plan)| case == what && is_in_lanes(plan));
        let of_lanes = |processors| -> Vec<Trajectory> {
            let reference = Trajectories::reference_of(processors).expect("well formed");
            let all = reference.trajectories.into_iter();
            all.filter(|trajectory| is_of_lanes(&trajectory.what)).collect()
        };
        let first = of_lanes(Processors::X86_64);
        assert!(first.len() >= 20);
        assert_eq!(of_lanes(Processors::Arm64), first);
    }

    #[test]
    fn a_changed_hash_changes_the_fingerprint() {
        let reference = Trajectories::reference().expect("well formed");
        let mut other = reference.clone();
        other.trajectories[7].hash.replace_range(0..1, "x");
        assert_ne!(reference.fingerprint(), other.fingerprint());
    }
}
