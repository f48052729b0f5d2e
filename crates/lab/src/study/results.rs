//! The results of a study: the measures of its arms, each as a number and as text, checked against the demands.

use std::collections::BTreeSet;

use super::definition::{Arm, Demand, Examined, Study};
use super::findings::Findings;
use super::measure::Measure;
use super::values::{Form, ValueInfo, info_of, number, signed, values};
use crate::statistics::{PairedDifference, Quartiles, Share, median_difference, sign_test};
use snakes_core::save::{StudiedRun, StudyRuns, StudyValue};

/// A measured number, with its text.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Number that is compared with the bounds of the demand.
    pub value: f64,
    /// Text with the number, its spread and the number of runs.
    pub text: String,
}

/// Verdict on a demand.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// Measured number; `None` if there are no results for it yet.
    pub measured: Option<Measured>,
    /// Whether the number meets the bound `must`; `None` without a number or a bound.
    pub meets_must: Option<bool>,
    /// Whether the number meets the bound `hard`; `None` without a number or a bound.
    pub meets_hard: Option<bool>,
}

/// The results of a study, on which tables and figures are based.
#[derive(Debug, Clone, Copy)]
pub struct Results<'a> {
    /// Definition of the study.
    pub study: &'a Study,
    /// Finished runs of the study.
    pub runs: &'a StudyRuns,
    /// Measurements besides the runs.
    pub findings: &'a Findings,
}

impl<'a> Results<'a> {
    /// Returns the runs of an arm whose seeds belong to the study.
    pub fn of(&self, arm: &Arm) -> Vec<&'a StudiedRun> {
        let seeds = self.study.seeds();
        self.runs.of_arm(&arm.name).iter().filter(|run| seeds.contains(&run.seed)).collect()
    }

    /// Returns the numbers of a value over the runs of an arm, each with the seed of its run.
    pub fn numbers(&self, arm: &Arm, info: &ValueInfo) -> Vec<(u64, f64)> {
        let of_run = |run: &&StudiedRun| Some((run.seed, number_of(info, run)?));
        self.of(arm).iter().filter_map(of_run).collect()
    }

    /// Returns the numbers of a value over the runs of an arm.
    pub fn values(&self, arm: &Arm, info: &ValueInfo) -> Vec<f64> {
        self.of(arm).iter().filter_map(|run| number_of(info, run)).collect()
    }

    /// Returns the different texts of a value over the runs of an arm.
    pub fn texts(&self, arm: &Arm, name: &str) -> BTreeSet<&'a str> {
        self.of(arm).into_iter().filter_map(|run| text_of(run, name)).collect()
    }

    /// Returns the values that are shown, without lists.
    pub fn shown(&self) -> Vec<&'static ValueInfo> {
        let shown = self.study.shown();
        let is_shown = |info: &&ValueInfo| shown.contains(&info.name) && info.form != Form::List;
        values().iter().filter(is_shown).collect()
    }

    /// Returns the values of two arms for each seed that both have. A run without a healthy snake has `None`. Runs whose value was
    /// not measured, such as those of a champion that took no exam, are left out.
    pub fn pairs(&self, arm: &Arm, against: &Arm, info: &ValueInfo) -> Vec<[Option<f64>; 2]> {
        let others = self.of(against);
        let value = |run: &StudiedRun| {
            let number = number_of(info, run);
            (number.is_some() || run.number("fitness").is_none()).then_some(number)
        };
        let pair = |run: &&StudiedRun| {
            let other = others.iter().find(|other| other.seed == run.seed)?;
            Some([value(run)?, value(other)?])
        };
        self.of(arm).iter().filter_map(pair).collect()
    }

    /// Checks the results of an arm against a demand.
    pub fn verdict(&self, arm: &Arm, demand: &Demand) -> Verdict {
        let measured = demand.measure.of(arm, demand.against(self.study, arm), self);
        let is_at_most = demand.is_at_most();
        let meets = |bound: Option<f64>| {
            let (bound, value) = (bound?, measured.as_ref()?.value);
            Some(if is_at_most { value <= bound } else { value >= bound })
        };
        let (meets_must, meets_hard) = (meets(demand.must), meets(demand.hard));
        Verdict { measured, meets_must, meets_hard }
    }
}

/// Returns a value of a run as a number. An event that never came counts as infinite.
pub(super) fn number_of(info: &ValueInfo, run: &StudiedRun) -> Option<f64> {
    match info.form {
        Form::Until => Some(run.number(&info.name).unwrap_or(f64::INFINITY)),
        _ => run.number(&info.name),
    }
}

impl Demand {
    /// Returns the arm with which an arm is compared, if there is one.
    pub(super) fn against<'a>(&self, study: &'a Study, arm: &Arm) -> Option<&'a Arm> {
        match &self.against {
            Some(name) => study.arms.iter().find(|arm| arm.name == *name),
            None => study.baseline_of(arm),
        }
    }

    /// Returns whether the measure must not exceed its bounds.
    pub fn is_at_most(&self) -> bool {
        self.at_most
            || match &self.measure {
                Measure::SignTest { .. } | Measure::MedianSize { .. } | Measure::Newborns => true,
                Measure::Median { of, .. } => {
                    info_of(of).is_some_and(|info| info.form == Form::Until)
                }
                _ => false,
            }
    }
}

impl Measure {
    /// Computes the measure of an arm; `None` if there are no results for it.
    fn of(&self, arm: &Arm, against: Option<&Arm>, results: &Results<'_>) -> Option<Measured> {
        match self {
            Self::Median { of, less } => {
                let info = info_of(of)?;
                let Some(less) = less else { return median(results.values(arm, info), info) };
                let others = results.numbers(arm, info_of(less)?);
                let difference = |(seed, value): (u64, f64)| {
                    let (_, other) = others.iter().find(|(of, _)| *of == seed)?;
                    Some(value - other)
                };
                median(results.numbers(arm, info).into_iter().filter_map(difference), info)
            }
            Self::Share { of } => {
                let runs = results.of(arm);
                let is_met = |run: &&&StudiedRun| {
                    of.iter()
                        .all(|(name, least)| run.number(name).is_some_and(|value| value >= *least))
                };
                // If only the best champion of an arm was examined, only its run counts for values of the exam.
                let known = |run: &&&StudiedRun| {
                    of.keys().all(|name| !name.starts_with("exam_") || run.number(name).is_some())
                };
                share(runs.iter().filter(is_met).count(), runs.iter().filter(known).count())
            }
            Self::MedianSize { of } => {
                let info = info_of(of)?;
                let runs = results.of(arm);
                let numbers = runs.iter().flat_map(|run| run.numbers(of)).flatten();
                median(numbers.map(|number| number.abs()), info)
            }
            Self::Distinct { of } => {
                let (runs, texts) = (results.of(arm).len(), results.texts(arm, of).len());
                (runs > 0).then(|| Measured {
                    value: texts as f64,
                    text: format!("{texts} in {runs} runs"),
                })
            }
            Self::Difference { of } => difference(arm, against?, info_of(of)?, results),
            Self::SignTest { of } => {
                let pairs = results.pairs(arm, against?, info_of(of)?);
                let PairedDifference { more, fewer, pairs, p, .. } = PairedDifference::of(&pairs);
                let equal = pairs as u32 - more - fewer;
                (pairs > 0).then(|| Measured {
                    value: if more > fewer { sign_test(more, fewer) } else { 1.0 },
                    text: format!("p = {p:.4}: more {more}, fewer {fewer}, equal {equal}"),
                })
            }
            Self::Ratio { of } => {
                let info = ValueInfo { digits: 2, unit: "", ..info_of(of)?.clone() };
                let pairs = results.pairs(arm, against?, &info).into_iter();
                let ratio = |[a, b]: [Option<f64>; 2]| Some(a? / b?.max(f64::MIN_POSITIVE));
                median(pairs.filter_map(ratio), &info)
            }
            Self::TotalRatio { of, trials } => {
                let total = |arm: &Arm| totals(arm, of, trials.as_deref(), results);
                let ([sum, count], [other, other_count]) = (total(arm)?, total(against?)?);
                let (share, other_share) = (sum / count, other / other_count);
                let text = match trials {
                    None => format!("{} against {}", number(sum, 3), number(other, 3)),
                    Some(_) => format!(
                        "{}; {} against {}",
                        if other > 0.0 {
                            format!("{:.2} times", share / other_share)
                        } else {
                            "against none".to_owned()
                        },
                        with_interval(sum, count),
                        with_interval(other, other_count)
                    ),
                };
                let value = if sum == 0.0 { 0.0 } else { share / other_share };
                Some(Measured { value, text })
            }
            Self::Apart { of, trials } => {
                let total = |arm: &Arm| totals(arm, of, Some(trials), results);
                let ([sum, count], [other, other_count]) = (total(arm)?, total(against?)?);
                let (a, b) = (share_of(sum, count), share_of(other, other_count));
                let (a_text, b_text) =
                    (with_interval(sum, count), with_interval(other, other_count));
                Some(yes_or_no(a.least > b.most, format!("{a_text} against {b_text}")))
            }
            Self::Overlap { of } => {
                let info = info_of(of)?;
                let interval = |arm: &Arm| {
                    // A run that never reached the event counts with all its evaluations.
                    let of_run = |run: &&StudiedRun| match info.form {
                        Form::Until => run.number(of).or(run.number("evaluations")),
                        _ => run.number(of),
                    };
                    let (median, interval) =
                        median_difference(results.of(arm).iter().filter_map(of_run).collect())?;
                    Some((median, interval?))
                };
                let ((median, [low, high]), (other, [other_low, other_high])) =
                    (interval(arm)?, interval(against?)?);
                let words = |values: [f64; 3]| {
                    let [median, low, high] = values.map(|value| number(value, info.digits));
                    format!("{median} [{low} {high}]")
                };
                let text = format!(
                    "{} against {}",
                    words([median, low, high]),
                    words([other, other_low, other_high])
                );
                Some(yes_or_no(low <= other_high && other_low <= high, text))
            }
            Self::Newborns => {
                let greatest = results.findings.greatest_difference()?;
                Some(Measured { value: greatest, text: format!("{:.1} %", greatest * 100.0) })
            }
            Self::BuiltInChampions { keep } => {
                let kept = &results.findings.built_in;
                share(kept.iter().filter(|(_, kept)| f64::from(*kept) >= *keep).count(), kept.len())
            }
        }
    }
}

fn yes_or_no(is_so: bool, text: String) -> Measured {
    Measured { value: f64::from(u8::from(is_so)), text }
}

fn text_of<'a>(run: &'a StudiedRun, name: &str) -> Option<&'a str> {
    match run.values.get(name)? {
        StudyValue::Text(text) => Some(text),
        _ => None,
    }
}

/// Sums up a value over all runs of an arm, and the trials in which it was counted (1 if `trials` is `None`).
fn totals(arm: &Arm, of: &str, trials: Option<&str>, results: &Results<'_>) -> Option<[f64; 2]> {
    let runs = results.of(arm);
    let sum = |name: &str| {
        let numbers: Vec<f64> = runs.iter().filter_map(|run| run.number(name)).collect();
        (!numbers.is_empty()).then(|| numbers.iter().sum::<f64>())
    };
    // The landings of an exam are stored as a percentage of its trials.
    match trials {
        None => Some([sum(of)?, 1.0]),
        Some(trials) => {
            let landed =
                runs.iter().filter_map(|run| Some(run.number(of)? * run.number(trials)? / 100.0));
            Some([landed.sum::<f64>().round(), sum(trials)?])
        }
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "counts of trials")]
fn share_of(count: f64, of: f64) -> Share {
    Share::of(count as u32, of as u32)
}

fn with_interval(count: f64, of: f64) -> String {
    let Share { seen, least, most } = share_of(count, of);
    format!("{seen:.2} [{least:.2}, {most:.2}]")
}

/// Returns the share of a count of runs, with its interval as text; `None` without runs.
fn share(count: usize, of: usize) -> Option<Measured> {
    let Share { seen, least, most } = Share::of(count as u32, of as u32);
    let percent = [seen, least, most].map(|share| share * 100.0);
    (of > 0).then(|| Measured {
        value: seen,
        text: format!("{count} of {of}: {:.0} % [{:.0} {:.0}]", percent[0], percent[1], percent[2]),
    })
}

/// Returns the median, with its quartiles and the number of values as text; `None` without values.
fn median(values: impl IntoIterator<Item = f64>, info: &ValueInfo) -> Option<Measured> {
    let values: Vec<f64> = values.into_iter().collect();
    let count = values.len();
    let quartiles = Quartiles::of(values)?;
    let text = format!("{}, n = {count}", quartiles_text(&quartiles, count, info));
    Some(Measured { value: quartiles.median, text })
}

/// Formats a median, with its quartiles if there are several values.
pub(super) fn quartiles_text(quartiles: &Quartiles, count: usize, info: &ValueInfo) -> String {
    let [low, median, high] =
        [quartiles.low, quartiles.median, quartiles.high].map(|value| number(value, info.digits));
    let unit = if info.unit.is_empty() { String::new() } else { format!(" {}", info.unit) };
    if count == 1 { format!("{median}{unit}") } else { format!("{median}{unit} [{low} {high}]") }
}

/// Returns the difference to another arm: the median over the seeds, or between the best champions if only these were examined.
fn difference(
    arm: &Arm,
    against: &Arm,
    info: &ValueInfo,
    results: &Results<'_>,
) -> Option<Measured> {
    let signed = |value: f64| signed(value, info.digits);
    let (values, others) = (results.numbers(arm, info), results.numbers(against, info));
    let is_of_best = [arm, against].iter().any(|arm| arm.examined == Examined::Best);
    if let ([(_, value)], [(_, other)]) = (values.as_slice(), others.as_slice())
        && is_of_best
    {
        let difference = value - other;
        let text = format!(
            "{}: {}, {} {}",
            signed(difference),
            number(*value, info.digits),
            against.name,
            number(*other, info.digits)
        );
        return Some(Measured { value: difference, text });
    }
    let pairs = results.pairs(arm, against, info);
    let differences: Vec<f64> = pairs.iter().filter_map(|[a, b]| Some((*a)? - (*b)?)).collect();
    let Quartiles { low, median, high } = Quartiles::of(differences.iter().copied())?;
    let each: Vec<String> = differences.iter().map(|value| signed(*value)).collect();
    let text = match differences.len() {
        1 => format!("{}, n = 1", signed(median)),
        count => format!(
            "{} [{} {}], n = {count}: {}",
            signed(median),
            signed(low),
            signed(high),
            each.join(" ")
        ),
    };
    Some(Measured { value: median, text })
}
