//! Every arm against its baseline: a test, a corrected probability, a difference and an effect size.

use super::definition::Arm;
use super::results::Results;
use super::values::{ValueInfo, value};
use crate::statistics::{PairedDifference, Superiority, holm};

/// An arm compared with its baseline by one value.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmComparison<'a> {
    /// The arm.
    pub arm: &'a Arm,
    /// The arm with which it is compared.
    pub baseline: &'a Arm,
    /// The value.
    pub value: &'static ValueInfo,
    /// The differences of the runs with the same seeds.
    pub difference: PairedDifference,
    /// The probability of the sign test, corrected for the number of arms that are compared by this value (Holm).
    pub corrected_p: f64,
    /// The probability that a run of the arm has a greater value than a run of the baseline; none without runs of both.
    pub superiority: Option<Superiority>,
}

/// Compares all arms with their baselines by each value that the study names.
pub fn comparisons<'a>(results: &Results<'a>) -> Vec<ArmComparison<'a>> {
    let study = results.study;
    let mut all = Vec::new();
    for name in &study.compare {
        let Ok(value) = value("compare", name) else { continue };
        let against = |arm: &'a Arm| Some((arm, study.baseline_of(arm)?));
        let mut of_value: Vec<ArmComparison<'a>> = Vec::new();
        for (arm, baseline) in study.selected_arms().filter_map(against) {
            let pairs = results.pairs(arm, baseline, value);
            // One pair shows no difference between arms, such as that of two best champions.
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
                superiority: Superiority::of(&numbers(arm), &numbers(baseline)),
            });
        }
        let corrected = holm(&of_value.iter().map(|of| of.difference.p).collect::<Vec<_>>());
        of_value.iter_mut().zip(corrected).for_each(|(of, p)| of.corrected_p = p);
        all.extend(of_value);
    }
    all
}
