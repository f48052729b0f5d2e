//! The demands of a study in words.

use super::definition::{Arm, Demand, Study};
use super::measure::Measure;
use super::values::{Form, info_of, number};

impl Demand {
    /// Describes the measure in words.
    pub fn words(&self, study: &Study, arm: &Arm) -> String {
        let against = self.against(study, arm).map_or("", |arm| arm.name.as_str());
        let title = |name: &str| info_of(name).map_or(name.to_owned(), |info| info.title.clone());
        match &self.measure {
            Measure::Median { of, less: None } => title(of),
            Measure::Median { of, less: Some(less) } => {
                format!("{} less {}", title(of), title(less))
            }
            Measure::Share { of } => {
                let one = |(name, least): (&String, &f64)| match info_of(name).map(|info| info.form)
                {
                    Some(Form::Flag) => title(name),
                    Some(Form::Until) => {
                        format!("reach {}", title(name).trim_start_matches("evaluations to "))
                    }
                    _ => format!("{} ≥ {least}", title(name)),
                };
                format!("runs: {}", of.iter().map(one).collect::<Vec<_>>().join(" and "))
            }
            Measure::MedianSize { of } => format!("{}, median size", title(of)),
            Measure::Distinct { of } => format!("different {}", title(of)),
            Measure::Difference { of } => format!("{}, more than {against}", title(of)),
            Measure::SignTest { of } => format!("{}, sign test against {against}", title(of)),
            Measure::Ratio { of } => format!("{}, times that of {against}", title(of)),
            Measure::TotalRatio { of, .. } => {
                format!("{} in all, times those of {against}", title(of))
            }
            Measure::Apart { of, .. } => format!("{}, interval above that of {against}", title(of)),
            Measure::Overlap { of } => {
                format!("{}, interval overlaps that of {against}", title(of))
            }
            Measure::Newborns => "quartiles of newborns, difference between engines".to_owned(),
            Measure::BuiltInChampions { keep } => {
                format!("built-in champions that keep {:.0} % in the other engine", keep * 100.0)
            }
        }
    }

    /// Describes a bound in words; a dash for `None`.
    pub fn bound(&self, bound: Option<f64>) -> String {
        let Some(bound) = bound else { return "–".to_owned() };
        let sign = if self.is_at_most() { "≤" } else { "≥" };
        match &self.measure {
            Measure::SignTest { .. } => format!("p ≤ {bound}"),
            Measure::Share { .. } | Measure::Newborns | Measure::BuiltInChampions { .. } => {
                format!("{sign} {} %", number(bound * 100.0, 1))
            }
            Measure::Difference { .. } => format!("{sign} {bound:+}"),
            Measure::Ratio { .. } | Measure::TotalRatio { .. } => format!("{sign} {bound} times"),
            Measure::Apart { .. } | Measure::Overlap { .. } => "yes".to_owned(),
            Measure::Median { of, .. } => {
                let unit = info_of(of).map_or("", |info| info.unit);
                format!("{sign} {bound} {unit}").trim_end().to_owned()
            }
            _ => format!("{sign} {bound}"),
        }
    }
}
