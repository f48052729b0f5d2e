//! Demands on a family: a measure of its results, what it must reach, and what would be hard.

use super::measure::{Measure, Measured};
use super::results::{FamilyResults, Results};

/// What is demanded of a measure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// What is measured.
    pub measure: Measure,
    /// What it must be.
    pub must: Option<f64>,
    /// What would be hard, but realistic.
    pub hard: Option<f64>,
}

/// Whether a demand is met.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// What was measured; none if there are no results for it yet.
    pub measured: Option<Measured>,
    /// Whether it is what it must be; none without a result, or if nothing must be.
    pub meets_must: Option<bool>,
    /// Whether it is what would be hard; none likewise.
    pub meets_hard: Option<bool>,
}

impl Demand {
    /// Holds the results of a family against the demand.
    pub fn verdict(&self, family: &FamilyResults, all: &Results) -> Verdict {
        let measured = self.measure.of(family, all);
        let meets = |bound: Option<f64>| {
            let (bound, value) = (bound?, measured.as_ref()?.value);
            Some(if self.measure.is_at_most() { value <= bound } else { value >= bound })
        };
        let (meets_must, meets_hard) = (meets(self.must), meets(self.hard));
        Verdict { measured, meets_must, meets_hard }
    }
}

impl Verdict {
    /// The verdict in words, for the last column of a table.
    pub fn words(&self) -> String {
        if self.measured.is_none() {
            return "not measured".to_owned();
        }
        let one = |name: &str, meets: Option<bool>| {
            let word = if meets? { "yes" } else { "no" };
            Some(format!("{name} {word}"))
        };
        let both = [one("must:", self.meets_must), one("hard:", self.meets_hard)];
        both.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }
}
