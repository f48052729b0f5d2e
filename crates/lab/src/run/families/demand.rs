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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::families::Family;
    use crate::run::families::fixtures::{family, results};

    #[test]
    fn a_demand_is_met_or_not_or_not_measured() {
        let demand = Demand { measure: Measure::Steps, must: Some(2.0), hard: Some(4.0) };
        for (steps, words) in [
            (&[4, 5, 4][..], "must: yes, hard: yes"),
            (&[2, 3, 3], "must: yes, hard: no"),
            (&[1, 1, 10], "must: no, hard: no"),
            (&[], "not measured"),
        ] {
            let zcs = family(Family::Zcs, steps);
            let verdict = demand.verdict(&zcs, &results(&[&zcs]));
            assert_eq!(verdict.words(), words, "{steps:?}");
        }
        let zcs = family(Family::Zcs, &[3]);
        let hard = Demand { must: None, ..demand }.verdict(&zcs, &results(&[&zcs]));
        assert_eq!((hard.meets_must, hard.meets_hard), (None, Some(false)));
        assert_eq!(hard.words(), "hard: no");
    }

    #[test]
    fn of_some_measures_less_is_better() {
        let demand = Demand { measure: Measure::FirstLanding, must: None, hard: Some(250.0) };
        for (steps, meets) in
            [(&[10, 10, 10][..], true), (&[0, 10, 10], false), (&[0, 0, 0], false)]
        {
            let reflex = family(Family::Reflex, steps);
            let verdict = demand.verdict(&reflex, &results(&[&reflex]));
            assert_eq!(verdict.meets_hard, Some(meets), "{steps:?}");
        }
    }
}
