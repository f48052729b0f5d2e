//! What is measured of a family's results, as a number and in words.

use super::family::Training;
use super::results::{FamilyResults, Results};
use crate::run::report::Quartiles;
use crate::run::robust::Share;
use crate::run::sign_test::sign_test;
use snakes_core::save::{FamilyChampion, RuleUse};
use snakes_core::schema::Choices;
use snakes_core::score::ExamSuite;

/// Share of its decisions from which on a champion is said to use a wave.
const LEAST_WAVE_SHARE: f32 = 0.1;

/// A measure of a family.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// In how many of ten runs a snake lands: the champion, or, where runs end with the first landing, any snake.
    Landings,
    /// Evaluations until the first landing: median of the runs, where one that never lands counts as infinite.
    FirstLanding,
    /// Steps that the champion climbs in its own trial: median of the runs.
    Steps,
    /// Landings of 100 trials in a suite: median of the examined champions.
    Exam(ExamSuite),
    /// The same less that of the gait that was trained on the same stairs: on mixed stairs the median of the seeds.
    AboveGait(ExamSuite),
    /// Probability of such a difference to the gait by chance, over the seeds; 1 if the gait lands more often.
    SignTest(ExamSuite),
    /// Landings of 100 that are lost on other stairs with frozen senses: median of the examined champions.
    LostWithoutSenses,
    /// Number of the champion's rules: median of the runs.
    Rules,
    /// Percentage of its decisions that the twenty most used rules make: median of the runs.
    DecisionsOfTwenty,
    /// In how many of ten runs the champion uses two waves or more, each for a tenth of its decisions or more.
    SeveralWaves,
}

/// What was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// The number that is held against the demand.
    pub value: f64,
    /// The number with its spread and the number of seeds.
    pub text: String,
}

impl Measure {
    /// Whether less is better.
    pub fn is_at_most(self) -> bool {
        matches!(self, Self::FirstLanding | Self::SignTest(_) | Self::Rules)
    }

    /// What is measured.
    pub fn name(self) -> String {
        let of = |suite: ExamSuite| suite.choice().title.to_lowercase();
        match self {
            Self::Landings => "runs that land".to_owned(),
            Self::FirstLanding => "evaluations to the first landing".to_owned(),
            Self::Steps => "steps climbed".to_owned(),
            Self::Exam(suite) => format!("{}, landings of 100", of(suite)),
            Self::AboveGait(suite) => format!("{}, landings more than the gait", of(suite)),
            Self::SignTest(suite) => format!("{}, sign test against the gait", of(suite)),
            Self::LostWithoutSenses => "landings lost with frozen senses".to_owned(),
            Self::Rules => "rules".to_owned(),
            Self::DecisionsOfTwenty => "decisions by the 20 most used rules".to_owned(),
            Self::SeveralWaves => "runs that use two waves or more".to_owned(),
        }
    }

    /// A bound in words.
    pub fn bound(self, bound: f64) -> String {
        match self {
            Self::Landings | Self::SeveralWaves => format!("≥ {bound} of 10"),
            Self::SignTest(_) => format!("p < {bound}"),
            Self::AboveGait(_) => format!("≥ +{bound}"),
            Self::DecisionsOfTwenty => format!("≥ {bound} %"),
            _ if self.is_at_most() => format!("≤ {bound}"),
            _ => format!("≥ {bound}"),
        }
    }

    /// The measure of a family; none if there are no results for it.
    pub fn of(self, family: &FamilyResults, all: &Results) -> Option<Measured> {
        let of_rules = |value: &dyn Fn(RuleUse) -> f64| -> Vec<f64> {
            family.champions().filter_map(|champion| champion.rules.map(value)).collect()
        };
        match self {
            Self::Landings => {
                let stops = family.family.info().stops_at_landing;
                let champion = |of: &FamilyChampion| of.has_landed;
                let landed = family.runs.iter().filter(|run| match stops {
                    true => run.first_landing.is_some(),
                    false => run.champion.as_ref().is_some_and(champion),
                });
                of_ten(landed.count(), family.runs.len())
            }
            Self::FirstLanding => {
                let number = |landing: Option<u32>| landing.map_or(f64::INFINITY, f64::from);
                median(family.runs.iter().map(|run| number(run.first_landing)), "")
            }
            Self::Steps => {
                let steps =
                    |of: Option<&FamilyChampion>| of.map_or(0.0, |of| of.steps_climbed.into());
                median(family.runs.iter().map(|run| steps(run.champion.as_ref())), "")
            }
            Self::Exam(suite) => median(of_seeds(&family.landings(suite)), ""),
            Self::LostWithoutSenses => {
                let sighted = family.landings(ExamSuite::Stairs);
                median(of_seeds(&pairs(&sighted, &family.landings(ExamSuite::Lesion))), "")
            }
            Self::AboveGait(suite) => above_gait(suite, family, all),
            Self::SignTest(suite) => {
                let differences = paired_with_gait(suite, family, all);
                let count = |is_it: fn(f64) -> bool| {
                    differences.iter().filter(|(_, difference)| is_it(*difference)).count() as u32
                };
                let (more, fewer) = (count(|x| x > 0.0), count(|x| x < 0.0));
                let p = sign_test(more, fewer);
                let equal = differences.len() as u32 - more - fewer;
                (!differences.is_empty()).then(|| Measured {
                    value: if more > fewer { p } else { 1.0 },
                    text: format!("p = {p:.4}: more {more}, fewer {fewer}, equal {equal}"),
                })
            }
            Self::Rules => median(of_rules(&|rules| rules.count.into()), ""),
            Self::DecisionsOfTwenty => {
                median(of_rules(&|rules| 100.0 * f64::from(rules.share_of_twenty)), " %")
            }
            Self::SeveralWaves => {
                let is_used = |share: &&f32| **share >= LEAST_WAVE_SHARE;
                let uses = |of: &&FamilyChampion| of.wave_shares.iter().filter(is_used).count() > 1;
                of_ten(family.champions().filter(uses).count(), family.runs.len())
            }
        }
    }
}

/// A count of runs, expressed for ten.
fn of_ten(count: usize, runs: usize) -> Option<Measured> {
    let Share { seen, least, most } = Share::of(count as u32, runs as u32);
    (runs > 0).then(|| Measured {
        value: 10.0 * count as f64 / runs as f64,
        text: format!(
            "{count} of {runs}: {:.0} % [{:.0} {:.0}]",
            seen * 100.0,
            least * 100.0,
            most * 100.0
        ),
    })
}

/// The median with its quartiles and the number of values.
fn median(values: impl IntoIterator<Item = f64>, unit: &str) -> Option<Measured> {
    let values: Vec<f64> = values.into_iter().collect();
    let count = values.len();
    let Quartiles { low, median, high } = Quartiles::of(values)?;
    let text = match count {
        1 => format!("{}{unit}, n = 1", number(median)),
        _ => {
            let (low, high) = (number(low), number(high));
            format!("{}{unit} [{low} {high}], n = {count}", number(median))
        }
    };
    Some(Measured { value: median, text })
}

/// A number with at most one digit after the point; – for an infinite one.
pub(super) fn number(value: f64) -> String {
    match value {
        _ if !value.is_finite() => "–".to_owned(),
        _ if value == value.trunc() => format!("{value:.0}"),
        _ => format!("{value:.1}"),
    }
}

fn of_seeds(values: &[(u64, f64)]) -> impl Iterator<Item = f64> {
    values.iter().map(|(_, value)| *value)
}

/// For each seed that both have, the difference.
fn pairs(values: &[(u64, f64)], less: &[(u64, f64)]) -> Vec<(u64, f64)> {
    let difference = |&(seed, value): &(u64, f64)| {
        let (_, other) = less.iter().find(|(other, _)| *other == seed)?;
        Some((seed, value - other))
    };
    values.iter().filter_map(difference).collect()
}

fn paired_with_gait(suite: ExamSuite, family: &FamilyResults, all: &Results) -> Vec<(u64, f64)> {
    let gait = all.of(family.family.gait()).map(|gait| gait.landings(suite));
    pairs(&family.landings(suite), &gait.unwrap_or_default())
}

/// The difference to the gait: seed by seed, or between the best champions.
fn above_gait(suite: ExamSuite, family: &FamilyResults, all: &Results) -> Option<Measured> {
    let signed = |value: f64| format!("{}{}", if value < 0.0 { "" } else { "+" }, number(value));
    if family.family.info().training == Training::Standard {
        let own = family.landings(suite).first()?.1;
        let gait = all.of(family.family.gait())?.landings(suite).first()?.1;
        let text = format!("{}: {}, gait {}", signed(own - gait), number(own), number(gait));
        return Some(Measured { value: own - gait, text });
    }
    let differences = paired_with_gait(suite, family, all);
    let Quartiles { low, median, high } = Quartiles::of(of_seeds(&differences))?;
    let each: Vec<String> = of_seeds(&differences).map(signed).collect();
    let text = format!(
        "{} [{} {}], n = {}: {}",
        signed(median),
        signed(low),
        signed(high),
        differences.len(),
        each.join(" ")
    );
    Some(Measured { value: median, text })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::families::Family;
    use crate::run::families::fixtures::{examined, family, landings, results};

    fn measured(measure: Measure, of: &FamilyResults, others: &[&FamilyResults]) -> Measured {
        measure.of(of, &results(others)).expect("measured")
    }

    #[test]
    fn landings_are_of_champions_or_where_runs_stop_of_any_snake() {
        let mut rules = family(Family::Rules, &[10, 10, 4, 10]);
        let found = measured(Measure::Landings, &rules, &[]);
        assert_eq!((found.value, found.text.as_str()), (7.5, "3 of 4: 75 % [30 95]"));
        rules.runs[2].first_landing = Some(7);
        assert_eq!(measured(Measure::Landings, &rules, &[]).value, 7.5, "it is no champion");
        let stopped = FamilyResults { family: Family::Reflex, ..rules };
        assert_eq!(measured(Measure::Landings, &stopped, &[]).value, 10.0);
        assert_eq!(Measure::Landings.of(&family(Family::Rules, &[]), &Results::default()), None);
    }

    #[test]
    fn a_run_that_never_lands_counts_as_infinite_and_one_without_champion_as_no_step() {
        let most = family(Family::Modular, &[10, 10, 3]);
        let found = measured(Measure::FirstLanding, &most, &[]);
        assert_eq!((found.value, found.text.as_str()), (200.0, "200 [150 –], n = 3"));
        let few = family(Family::Modular, &[10, 2, 3]);
        assert_eq!(measured(Measure::FirstLanding, &few, &[]).value, f64::INFINITY);
        let mut xcs = family(Family::Xcs, &[4, 6, 5]);
        xcs.runs[1].champion = None;
        let found = measured(Measure::Steps, &xcs, &[]);
        assert_eq!((found.value, found.text.as_str()), (4.0, "4 [2 4.5], n = 3"));
    }

    #[test]
    fn a_family_on_mixed_stairs_is_compared_with_the_gait_seed_by_seed() {
        let suite = ExamSuite::Stairs;
        let reflex = landings(Family::MixedReflex, suite, &[40, 30, 35, 20]);
        let gait = landings(Family::MixedGait, suite, &[30, 30, 20]);
        let found = measured(Measure::AboveGait(suite), &reflex, &[&reflex, &gait]);
        assert_eq!((found.value, found.text.as_str()), (20.0, "+20 [+10 +25], n = 3: +20 +0 +30"));
        let found = measured(Measure::SignTest(suite), &reflex, &[&reflex, &gait]);
        assert_eq!(found.value, 0.5);
        assert_eq!(found.text, "p = 0.5000: more 2, fewer 0, equal 1");
        let worse = landings(Family::MixedReflex, suite, &[1; 3]);
        let found = measured(Measure::SignTest(suite), &worse, &[&gait]);
        assert_eq!(
            (found.value, found.text.as_str()),
            (1.0, "p = 0.2500: more 0, fewer 3, equal 0")
        );
        assert_eq!(Measure::AboveGait(suite).of(&reflex, &results(&[&reflex])), None);
    }

    #[test]
    fn the_best_champion_on_standard_stairs_is_compared_with_the_best_gait() {
        let suite = ExamSuite::Stairs;
        let rules = landings(Family::Rules, suite, &[40]);
        let mut gait = landings(Family::Gait, suite, &[45]);
        // Of another seed.
        gait.examined[0].seed = 8;
        let mixed = landings(Family::MixedGait, suite, &[1]);
        let found = measured(Measure::AboveGait(suite), &rules, &[&mixed, &gait]);
        assert_eq!((found.value, found.text.as_str()), (-10.0, "-10: 80, gait 90"));
    }

    #[test]
    fn frozen_senses_cost_the_landings_on_the_same_stairs() {
        let (stairs, lesion) = (ExamSuite::Stairs, ExamSuite::Lesion);
        let champions: [&[(ExamSuite, u32)]; 2] = [&[(stairs, 45), (lesion, 20)], &[(stairs, 50)]];
        let modular = examined(Family::MixedModular, &champions);
        let found = measured(Measure::LostWithoutSenses, &modular, &[]);
        assert_eq!((found.value, found.text.as_str()), (50.0, "50, n = 1"));
        assert_eq!(measured(Measure::Exam(stairs), &modular, &[]).value, 95.0);
    }

    #[test]
    fn waves_count_from_a_tenth_on_and_rules_have_medians() {
        let mut of = family(Family::Rules, &[10, 10, 10]);
        let shares = [[0.9, 0.1], [0.95, 0.05], [0.5, 0.5]];
        for (run, (shares, count)) in of.runs.iter_mut().zip(shares.iter().zip([100, 900, 200])) {
            let champion = run.champion.as_mut().expect("one");
            champion.wave_shares = shares.to_vec();
            champion.rules = Some(RuleUse { count, share_of_twenty: 0.75 });
        }
        let found = measured(Measure::SeveralWaves, &of, &[]);
        assert!((found.value - 20.0 / 3.0).abs() < 1e-9 && found.text.starts_with("2 of 3"));
        assert_eq!(measured(Measure::Rules, &of, &[]).text, "200 [150 550], n = 3");
        let found = measured(Measure::DecisionsOfTwenty, &of, &[]);
        assert_eq!(found.text, "75 % [75 75], n = 3");
    }
}
