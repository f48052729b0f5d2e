//! The measures that a demand can name.

use std::collections::BTreeMap;

use serde::Deserialize;

/// A measure of an arm, computed from the values of its runs.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Measure {
    /// Median of a value over the runs, or of its difference to another value of the same run.
    Median {
        /// Name of the value.
        of: String,
        /// Name of the value that is subtracted; `None` for none.
        less: Option<String>,
    },
    /// Share of the runs in which each of these values reaches its minimum.
    Share {
        /// Names of values, with their minima.
        of: BTreeMap<String, f64>,
    },
    /// Median absolute value of all numbers in a list, over all runs.
    MedianSize {
        /// Name of the list.
        of: String,
    },
    /// Number of different texts that a value has over the runs.
    Distinct {
        /// Name of the value, which must be a text.
        of: String,
    },
    /// Median difference to the baseline, seed by seed.
    Difference {
        /// Name of the value.
        of: String,
    },
    /// Probability of such a difference to the baseline by chance, by the sign test. 1 unless the arm wins more pairs than the
    /// baseline.
    SignTest {
        /// Name of the value.
        of: String,
    },
    /// Median ratio to the baseline, seed by seed.
    Ratio {
        /// Name of the value.
        of: String,
    },
    /// Sum of a value over all runs, divided by the sum of the baseline. If `trials` is given, both sums are per trial.
    TotalRatio {
        /// Name of the value, such as the successes of an exam.
        of: String,
        /// Name of the value with the number of trials; `None` for plain sums.
        trials: Option<String>,
    },
    /// 1 if the interval of the share of successful trials lies above the interval of the baseline, otherwise 0.
    Apart {
        /// Name of the value with the successful trials, as a percentage.
        of: String,
        /// Name of the value with the number of all trials.
        trials: String,
    },
    /// 1 if the 95 % intervals of the median and of the baseline's median overlap, otherwise 0.
    Overlap {
        /// Name of the value.
        of: String,
    },
    /// Greatest relative difference of a quartile of newborns between the physics engines.
    Newborns,
    /// Share of the built-in champions that keep at least the share `keep` of their way in the other physics engine.
    BuiltInChampions {
        /// Minimum share of the way, 0 to 1.
        keep: f64,
    },
}

impl Measure {
    /// Returns the names of the values that the measure uses.
    pub fn values(&self) -> Vec<String> {
        match self {
            Self::Median { of, less } => [of].into_iter().chain(less).cloned().collect(),
            Self::Share { of } => of.keys().cloned().collect(),
            Self::MedianSize { of }
            | Self::Distinct { of }
            | Self::Difference { of }
            | Self::SignTest { of }
            | Self::Ratio { of }
            | Self::TotalRatio { of, .. }
            | Self::Apart { of, .. }
            | Self::Overlap { of } => vec![of.clone()],
            Self::Newborns | Self::BuiltInChampions { .. } => Vec::new(),
        }
    }
}
