//! Comparisons of every arm with its baseline: a test, a corrected probability, a difference and an effect size.

use super::definition::Arm;
use super::results::Results;
use super::values::{ValueInfo, value};
use crate::statistics::{PairedDifference, Share, holm, superiority};

/// Comparison of an arm with its baseline by one value.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmComparison<'a> {
    /// The arm that is compared.
    pub arm: &'a Arm,
    /// The arm with which it is compared.
    pub baseline: &'a Arm,
    /// The value by which they are compared.
    pub value: &'static ValueInfo,
    /// Differences between runs with the same seeds.
    pub difference: PairedDifference,
    /// Probability of the sign test, corrected for the number of comparisons by this value (Holm).
    pub corrected_p: f64,
    /// Probability that a run of the arm has a greater value than a run of the baseline. `None` unless both have runs.
    pub superiority: Option<Share>,
}

/// Compares all arms with their baselines by each value in the study's `compare`.
pub fn comparisons<'a>(results: &Results<'a>) -> Vec<ArmComparison<'a>> {
    let study = results.study;
    let mut all = Vec::new();
    for name in &study.compare {
        let Ok(value) = value("compare", name) else { continue };
        let against = |arm: &'a Arm| Some((arm, study.baseline_of(arm)?));
        let mut of_value: Vec<ArmComparison<'a>> = Vec::new();
        for (arm, baseline) in study.selected_arms().filter_map(against) {
            let pairs = results.pairs(arm, baseline, value);
            // A single pair, such as that of two best champions, shows no difference between arms.
            if pairs.len() < 2 {
                continue;
            }
            let numbers = |arm: &Arm| results.values(arm, value);
            of_value.push(ArmComparison {
                arm,
                baseline,
                value,
                difference: PairedDifference::of(&pairs),
                corrected_p: 1.0,
                superiority: superiority(&numbers(arm), &numbers(baseline)),
            });
        }
        let corrected = holm(&of_value.iter().map(|of| of.difference.p).collect::<Vec<_>>());
        of_value.iter_mut().zip(corrected).for_each(|(of, p)| of.corrected_p = p);
        all.extend(of_value);
    }
    all
}
