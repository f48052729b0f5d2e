//! Checks of a study before its runs begin.

use std::ops::RangeInclusive;

use super::definition::{Examined, Goal, Study};
use super::measure::Measure;
use super::plans::is_short_for;
use super::values::{Form, of_judge, of_suite, value};
use crate::run::judge::JUDGES;
use snakes_core::check::{Invalid, name, quoted, within};
use snakes_core::schema::Choices;
use snakes_core::score::ExamSuite;

/// Allowed numbers of seeds of a study.
pub const SEEDS: RangeInclusive<u64> = 1..=10_000;

impl Study {
    /// Checks everything that can be checked without a run.
    ///
    /// # Errors
    /// The first field that is not allowed.
    pub fn check(&self) -> Result<(), Invalid> {
        name("name", &self.name)?;
        let sets_method = |name: &&String| {
            ["evolution.strategy", "genome.controller"]
                .iter()
                .any(|field| is_short_for(field, name))
        };
        if let Some(field) =
            self.settings.keys().find(sets_method).filter(|_| self.methods.is_some())
        {
            let allowed = "no value; the study names strategies and controllers as methods";
            return Err(Invalid::new(field, &self.settings[field], allowed));
        }
        within("seeds", self.seeds, SEEDS)?;
        within("first_seed", self.first_seed, 0..=u64::MAX - self.seeds)?;
        within("number of arms", self.arms.len(), 1..=1000)?;
        if self.arms.iter().all(|arm| arm.examined == Examined::Never) {
            for (field, is_given) in
                [("suites", !self.suites.is_empty()), ("judges", !self.judges.is_empty())]
            {
                if is_given {
                    let allowed = "none, because no arm has its champions examined";
                    return Err(Invalid::new(field, "given", allowed));
                }
            }
        }
        for (index, arm) in self.arms.iter().enumerate() {
            name("arms.name", &arm.name)?;
            if self.arms[..index].iter().any(|other| other.name == arm.name) {
                return Err(Invalid::new(
                    "arms.name",
                    quoted(&arm.name),
                    "a name that no other arm has",
                ));
            }
            if arm.stops_at_goal && arm.goal.is_none() {
                return Err(Invalid::new(
                    "arms.stops_at_goal",
                    true,
                    "false for an arm without a goal",
                ));
            }
            if let Some(Goal::Way(way_m)) = arm.goal {
                within("arms.goal.Way", way_m, 0.0..=1.0e4)?;
            }
            if arm.evaluations.is_some() && arm.evaluations_times.is_some() {
                let allowed = "none for an arm with evaluations of its own";
                return Err(Invalid::new("arms.evaluations_times", "given", allowed));
            }
            arm.baseline.iter().try_for_each(|name| self.named("arms.baseline", name).map(drop))?;
        }
        self.baseline.iter().try_for_each(|name| self.named("baseline", name).map(drop))?;
        self.show.iter().try_for_each(|name| self.check_measured("show", name))?;
        for name in &self.compare {
            if matches!(value("compare", name)?.form, Form::List | Form::Text) {
                return Err(Invalid::new("compare", quoted(name), "a value that is a number"));
            }
            self.check_measured("compare", name)?;
        }
        self.references.keys().try_for_each(|name| value("references", name).map(drop))?;
        self.newborns.map_or(Ok(()), |count| within("newborns", count, 1..=1_000_000))?;
        for demand in &self.demands {
            demand.arms.iter().try_for_each(|name| self.named("demands.arms", name).map(drop))?;
            demand.against.iter().try_for_each(|of| self.named("demands.against", of).map(drop))?;
            demand.measure.check(self)?;
            let is_yes_or_no =
                matches!(demand.measure, Measure::Apart { .. } | Measure::Overlap { .. });
            if demand.at_most && is_yes_or_no {
                let allowed = "false, because the measure is 1 for yes and 0 for no";
                return Err(Invalid::new("demands.at_most", true, allowed));
            }
        }
        Ok(())
    }

    /// Replaces the suites of the exam. Removes shown and compared values that only the removed suites measure.
    pub fn set_suites(&mut self, suites: Vec<ExamSuite>) {
        self.suites = suites;
        let (mut show, mut compare) = (self.show.clone(), self.compare.clone());
        show.retain(|name| self.check_measured("show", name).is_ok());
        compare.retain(|name| self.check_measured("compare", name).is_ok());
        (self.show, self.compare) = (show, compare);
    }

    /// Refuses a value that does not exist, or that only a suite or a judge measures which the study does not name.
    fn check_measured(&self, field: &str, name: &str) -> Result<(), Invalid> {
        value(field, name)?;
        let is_of = |suite: &&ExamSuite| {
            let start = of_suite(**suite, "");
            name.strip_prefix(start.as_str())
                .is_some_and(|end| end.is_empty() || end.starts_with('_'))
        };
        let judge = JUDGES.iter().find(|judge| name.starts_with(&of_judge(judge, "")));
        if let Some(judge) = judge.filter(|judge| !self.judges.contains(judge)) {
            let allowed = format!("other values, or judges with {:?}", judge.name);
            return Err(Invalid::new(field, quoted(name), allowed));
        }
        match ExamSuite::OPTIONS.iter().find(is_of).filter(|suite| !self.suites.contains(suite)) {
            Some(suite) => {
                let allowed = format!("other values, or suites with {:?}", suite.choice().name);
                Err(Invalid::new(field, quoted(name), allowed))
            }
            None => Ok(()),
        }
    }
}

impl Measure {
    /// Checks the values that the measure names.
    ///
    /// # Errors
    /// A value does not exist, or has another form than the measure needs.
    fn check(&self, study: &Study) -> Result<(), Invalid> {
        let field = "demands.measure.of";
        let is_expected = |form: Form| match self {
            Self::MedianSize { .. } => form == Form::List,
            Self::Distinct { .. } => form == Form::Text,
            _ => !matches!(form, Form::List | Form::Text),
        };
        for name in self.values() {
            if !is_expected(value(field, &name)?.form) {
                let allowed = match self {
                    Self::MedianSize { .. } => "a list",
                    Self::Distinct { .. } => "a text",
                    _ => "a number",
                };
                return Err(Invalid::new(field, format!("{name:?}"), allowed));
            }
        }
        match self {
            Self::TotalRatio { trials: Some(name), .. } | Self::Apart { trials: name, .. } => {
                value("demands.measure.trials", name).map(drop)
            }
            Self::Newborns if study.newborns.is_none() => {
                Err(Invalid::new("newborns", "none", "a number, about which a demand is"))
            }
            Self::BuiltInChampions { .. } if !study.built_in_champions => Err(Invalid::new(
                "built_in_champions",
                false,
                "true, because a demand is about them",
            )),
            Self::BuiltInChampions { keep } => within("demands.measure.keep", *keep, 0.0..=1.0),
            _ => Ok(()),
        }
    }
}
