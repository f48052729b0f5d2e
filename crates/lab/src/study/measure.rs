//! The measures that a demand may name.

use std::collections::BTreeMap;

use serde::Deserialize;

/// A measure of an arm, in terms of the values of its runs.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Measure {
    /// The median of a value over the runs, or of its difference to another value of the same run.
    Median {
        /// The value.
        of: String,
        /// The value that is subtracted.
        #[serde(default)]
        less: Option<String>,
    },
    /// The share of the runs in which each of these values is at least the number beside it.
    Share {
        /// Values and their least numbers.
        of: BTreeMap<String, f64>,
    },
    /// The median size of all numbers of a list, over all runs.
    MedianSize {
        /// The list.
        of: String,
    },
    /// The number of different texts.
    Distinct {
        /// The text.
        of: String,
    },
    /// The median difference to the baseline, seed by seed.
    Difference {
        /// The value.
        of: String,
    },
    /// The probability of such a difference to the baseline by chance, by the sign test; 1 if the baseline is not lower.
    SignTest {
        /// The value.
        of: String,
    },
    /// The median ratio to the baseline, seed by seed.
    Ratio {
        /// The value.
        of: String,
    },
    /// The sum over all runs, divided by that of the baseline; per trial, if the value of their number is named.
    TotalRatio {
        /// The value.
        of: String,
        /// The number of trials in which it was counted.
        #[serde(default)]
        trials: Option<String>,
    },
    /// 1 if the interval of the share of successful trials lies above that of the baseline, else 0.
    Apart {
        /// The value that counts the successful trials.
        of: String,
        /// The value that counts all.
        trials: String,
    },
    /// 1 if the 95 % intervals of the median and of the baseline's median overlap, else 0.
    Overlap {
        /// The value.
        of: String,
    },
    /// The greatest relative difference of a quartile of newborns between the physics engines.
    Newborns,
    /// The share of the built-in champions that keep at least this share of their way in the other physics engine.
    BuiltInChampions {
        /// The share of the way.
        keep: f64,
    },
}

impl Measure {
    /// The names of the values that it is about.
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
