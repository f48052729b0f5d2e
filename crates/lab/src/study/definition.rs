//! The definition of a study, which is data in RON: arms, seeds, values and demands.

use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::path::Path;

use serde::de::Error;
use serde::{Deserialize, Deserializer};

use super::measure::Measure;
use crate::run::judge::{JUDGES, Judge};
use snakes_core::check::{Invalid, quoted};
use snakes_core::evolve::StrategyKind;
use snakes_core::genome::ControllerKind;
use snakes_core::save::{
    DEFAULT_PRESET, SaveError, load_definition, load_preset, parse_definition,
};
use snakes_core::schema::Choices;
use snakes_core::score::ExamSuite;

/// A study: runs of several arms over several seeds, all measured by the same values.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// Name of the study, which is also the stem of its files.
    pub name: String,
    /// Title of the study in tables and pictures.
    pub title: String,
    /// Question of the study, in a sentence or two.
    #[serde(default)]
    pub about: String,
    /// Preset of the arms without a preset of their own.
    #[serde(default = "default_preset")]
    pub preset: String,
    /// First seed; the others follow one by one.
    #[serde(default = "default_first_seed")]
    pub first_seed: u64,
    /// Number of seeds.
    #[serde(default = "default_seeds")]
    pub seeds: u64,
    /// Evaluations that a run may spend. `None` for the generations of the preset.
    pub evaluations: Option<u32>,
    /// Stairs of all arms: a name, or the path of a file. `None` for the stairs of the presets.
    pub stairs: Option<String>,
    /// Settings that all arms change.
    #[serde(default)]
    pub settings: Changes,
    /// Whether trials last as long as those of the exam on other stairs.
    #[serde(default)]
    pub exam_length: bool,
    /// Strategies that are combined with controllers. Each pair that fits together is an arm.
    pub methods: Option<Methods>,
    /// Arms besides those of `methods`.
    #[serde(default)]
    pub arms: Vec<Arm>,
    /// Name of the arm with which the others are compared. `None` for the first arm.
    pub baseline: Option<String>,
    /// Suites of the exam for champions, given in files by their names.
    #[serde(default, deserialize_with = "suites_by_name")]
    pub suites: Vec<ExamSuite>,
    /// Other programs' physics engines in which champions are examined, given in files by their names.
    #[serde(default, deserialize_with = "judges_by_name")]
    pub judges: Vec<&'static Judge>,
    /// Names of the values in the table and the picture, besides those of the demands.
    #[serde(default)]
    pub show: Vec<String>,
    /// Names of the values that are compared with those of the baseline.
    #[serde(default)]
    pub compare: Vec<String>,
    /// Published numbers of lists of values, by the name of the list. They are shown beside the numbers of the runs.
    #[serde(default)]
    pub references: BTreeMap<String, Vec<f64>>,
    /// Number of newborns whose motion is compared between the physics engines. `None` for no comparison.
    pub newborns: Option<u32>,
    /// Whether the built-in champions are examined in the other physics engine.
    #[serde(default)]
    pub built_in_champions: bool,
    /// Demands on the results.
    #[serde(default)]
    pub demands: Vec<Demand>,
    /// Names of the arms that are run and shown; empty for all. Other arms serve only for comparison.
    #[serde(skip)]
    pub selected: Vec<String>,
}

/// Strategies and controllers to be combined. An empty list stands for all.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Methods {
    /// Strategies of the arms.
    pub strategies: Vec<StrategyKind>,
    /// Controllers of the arms.
    pub controllers: Vec<ControllerKind>,
}

/// An arm: runs with one preset, one list of changed settings and one budget, with all seeds.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Arm {
    /// Name of the arm.
    pub name: String,
    /// Title in tables and pictures; empty for the name.
    #[serde(default)]
    pub title: String,
    /// Preset of the arm; `None` for the preset of the study.
    pub preset: Option<String>,
    /// Settings that the arm changes.
    #[serde(default)]
    pub settings: Changes,
    /// Evaluations that a run of the arm may spend; `None` for those of the study.
    pub evaluations: Option<u32>,
    /// Factor on the evaluations of the study; `None` for 1.
    pub evaluations_times: Option<u32>,
    /// Goal of a run, whose evaluations are counted; `None` for no goal.
    pub goal: Option<Goal>,
    /// Whether a run ends with the generation that reaches the goal.
    #[serde(default)]
    pub stops_at_goal: bool,
    /// Which champions of the arm take the exam.
    #[serde(default)]
    pub examined: Examined,
    /// Name of the arm with which this arm is compared; `None` for the baseline of the study.
    pub baseline: Option<String>,
    /// Strategy and controller, if the arm belongs to the study's methods.
    #[serde(skip)]
    pub method: Option<(StrategyKind, ControllerKind)>,
}

/// The goal of a run.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub enum Goal {
    /// A snake ends on the landing.
    Landing,
    /// The middle of a generation's champion moves at least this far towards the stairs, in m.
    Way(f32),
    /// A generation's champion climbs at least this number of steps.
    Steps(u32),
}

/// Which champions of an arm take the exam.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
pub enum Examined {
    /// The champions of all seeds.
    #[default]
    All,
    /// Only the best champion of all seeds: one that landed before others, then the one with the most steps, then the fittest.
    Best,
    /// No champion.
    Never,
}

/// A demand on the results of arms.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Demand {
    /// Names of the arms that must meet the demand; empty for all.
    #[serde(default)]
    pub arms: Vec<String>,
    /// The measure of an arm that the demand bounds.
    pub measure: Measure,
    /// Name of the arm with which an arm is compared; `None` for the baseline.
    pub against: Option<String>,
    /// Whether the measure must not exceed the bounds, for measures that usually must reach them.
    #[serde(default)]
    pub at_most: bool,
    /// Bound that the measure must meet.
    pub must: Option<f64>,
    /// Bound that is hard to meet, but realistic.
    pub hard: Option<f64>,
}

/// Changed settings by their names, with values as a file may write them: `{"surface.friction": 0.8, "strategy": "ga"}`.
pub type Changes = BTreeMap<String, Plain>;

/// A value of a setting in a file.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum Plain {
    /// True or false.
    Bool(bool),
    /// A whole number.
    Whole(i64),
    /// A number with a fraction.
    Number(f64),
    /// A word, or a number as text.
    Text(String),
}

impl Display for Plain {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bool(value) => value.fmt(formatter),
            Self::Whole(value) => value.fmt(formatter),
            Self::Number(value) => value.fmt(formatter),
            Self::Text(value) => formatter.write_str(value),
        }
    }
}

fn suites_by_name<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<ExamSuite>, D::Error> {
    let names = Vec::<String>::deserialize(deserializer)?;
    suites_named("suites", &names).map_err(D::Error::custom)
}

fn judges_by_name<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Vec<&'static Judge>, D::Error> {
    let names = Vec::<String>::deserialize(deserializer)?;
    if let Some(unknown) = names.iter().find(|name| Judge::named(name).is_none()) {
        let allowed = JUDGES.iter().map(|judge| judge.name).collect::<Vec<_>>().join(", ");
        let refused = Invalid::new("judges", format!("{unknown:?}"), allowed);
        return Err(D::Error::custom(refused));
    }
    let is_named = |judge: &&Judge| names.iter().any(|name| name == judge.name);
    Ok(JUDGES.iter().filter(is_named).collect())
}

/// Returns the suites with these names, each once, in the usual order of suites.
///
/// # Errors
/// A name is unknown.
pub fn suites_named(field: &str, names: &[String]) -> Result<Vec<ExamSuite>, Invalid> {
    let named = names.iter().map(|name| ExamSuite::named(field, name));
    let mut suites = named.collect::<Result<Vec<_>, _>>()?;
    suites.sort_unstable();
    suites.dedup();
    Ok(suites)
}

fn default_preset() -> String {
    DEFAULT_PRESET.to_owned()
}

fn default_first_seed() -> u64 {
    1
}

fn default_seeds() -> u64 {
    10
}

/// The built-in studies: name and text of the definition.
const BUILT_IN: [(&str, &str); 11] = [
    ("table1", include_str!("../../../../assets/studies/table1.ron")),
    ("methods", include_str!("../../../../assets/studies/methods.ron")),
    ("families", include_str!("../../../../assets/studies/families.ron")),
    ("bodies", include_str!("../../../../assets/studies/bodies.ron")),
    ("body-sizes", include_str!("../../../../assets/studies/body-sizes.ron")),
    ("soft", include_str!("../../../../assets/studies/soft.ron")),
    ("creatures", include_str!("../../../../assets/studies/creatures.ron")),
    ("stairs", include_str!("../../../../assets/studies/stairs.ron")),
    ("ladder", include_str!("../../../../assets/studies/ladder.ron")),
    ("engines", include_str!("../../../../assets/studies/engines.ron")),
    ("transfer", include_str!("../../../../assets/studies/transfer.ron")),
];

/// Returns the studies that are built into the program.
///
/// # Errors
/// A built-in study is broken. A test rules this out.
pub fn built_in_studies() -> Result<Vec<Study>, SaveError> {
    BUILT_IN.iter().map(|(name, text)| built_in(name, text)).collect()
}

fn built_in(name: &str, text: &str) -> Result<Study, SaveError> {
    let path = Path::new(name);
    Study::prepared(path, parse_definition(path, text)?)
}

impl Study {
    /// Loads the built-in study with this name, or else the study in the file with this path.
    ///
    /// # Errors
    /// There is neither, or the file does not define a study.
    pub fn load(named: &str) -> Result<Self, SaveError> {
        if let Some((name, text)) = BUILT_IN.iter().find(|(name, _)| *name == named) {
            return built_in(name, text);
        }
        let path = Path::new(named);
        if !path.exists() && !named.contains(['/', '\\', '.']) {
            let names = BUILT_IN.map(|(name, _)| name).join(", ");
            let source = Invalid::new("study", quoted(named), format!("{names}, poet, or a file"));
            return Err(SaveError::Study(source));
        }
        Self::prepared(path, load_definition(path)?)
    }

    fn prepared(path: &Path, mut study: Self) -> Result<Self, SaveError> {
        study.set_methods().and_then(|()| study.check()).map_err(SaveError::invalid(path))?;
        Ok(study)
    }

    /// Makes an arm of each method, in the order of the named strategies and controllers.
    ///
    /// # Errors
    /// A named strategy fits no controller, or it evolves stairs, so that results on different stairs would be compared.
    pub fn set_methods(&mut self) -> Result<(), Invalid> {
        self.arms.retain(|arm| arm.method.is_none());
        let Some(Methods { strategies, controllers }) = &self.methods else { return Ok(()) };
        let varies =
            load_preset(&self.preset).is_ok_and(|preset| preset.settings.genome.bodies.vary);
        let is_usual = |kind: &StrategyKind| {
            kind.info().varies_bodies == varies && !kind.info().evolves_stairs
        };
        let all = StrategyKind::ALL.into_iter().filter(is_usual);
        let strategies = if strategies.is_empty() { all.collect() } else { strategies.clone() };
        for strategy in strategies {
            let fits = |kind: &ControllerKind| strategy.improves(*kind);
            let of_strategy: Vec<ControllerKind> = match controllers.as_slice() {
                [] => strategy.controllers().collect(),
                some => some.iter().copied().filter(fits).collect(),
            };
            if of_strategy.is_empty() {
                let names: Vec<&str> = strategy.controllers().map(ControllerKind::name).collect();
                let allowed = format!("a list with one of {} for {strategy}", names.join(", "));
                let given: Vec<&str> = controllers.iter().map(|kind| kind.name()).collect();
                return Err(Invalid::new("controllers", given.join(","), allowed));
            }
            self.arms.extend(of_strategy.into_iter().map(|controller| Arm {
                name: format!("{strategy}-{controller}").replace('_', "-"),
                title: format!("{}, {}", strategy.title(), controller.name()),
                method: Some((strategy, controller)),
                ..Arm::default()
            }));
        }
        Ok(())
    }

    /// Makes the first arm the baseline if the study names one that is not among its arms, as when other methods are chosen than the
    /// study's.
    pub fn forget_lacking_baseline(&mut self) {
        let is_there = |name: &String| self.arms.iter().any(|arm| arm.name == *name);
        self.baseline = self.baseline.take().filter(is_there);
    }

    /// Returns the arm with this name.
    ///
    /// # Errors
    /// There is no such arm.
    pub fn named(&self, field: &str, name: &str) -> Result<&Arm, Invalid> {
        self.arms.iter().find(|arm| arm.name == name).ok_or_else(|| {
            let names: Vec<&str> = self.arms.iter().map(|arm| arm.name.as_str()).collect();
            Invalid::new(field, quoted(name), names.join(", "))
        })
    }

    /// Returns the arm with which another arm is compared; `None` for the baseline itself.
    pub fn baseline_of(&self, arm: &Arm) -> Option<&Arm> {
        let name = arm.baseline.as_ref().or(self.baseline.as_ref());
        let baseline = match name {
            Some(name) => self.arms.iter().find(|arm| arm.name == *name)?,
            None => self.arms.first()?,
        };
        (baseline.name != arm.name).then_some(baseline)
    }

    /// Returns the seeds of the study.
    pub fn seeds(&self) -> std::ops::Range<u64> {
        self.first_seed..self.first_seed + self.seeds
    }

    /// Returns the arms that are run and shown.
    pub fn selected_arms(&self) -> impl Iterator<Item = &Arm> {
        let is_selected = |name: &String| self.selected.is_empty() || self.selected.contains(name);
        self.arms.iter().filter(move |arm| is_selected(&arm.name))
    }

    /// Returns each pair of an arm and a demand that the arm must meet, in the order of the arms.
    pub fn demands_by_arm(&self) -> Vec<(&Arm, &Demand)> {
        let concerns =
            |demand: &Demand, arm: &Arm| demand.arms.is_empty() || demand.arms.contains(&arm.name);
        let of_arm = |arm| {
            let demands = self.demands.iter().filter(move |demand| concerns(demand, arm));
            demands.map(move |demand| (arm, demand))
        };
        self.selected_arms().flat_map(of_arm).collect()
    }

    /// Returns the names of the values that are shown: those in `show` and `compare`, and those of the demands. If there are none,
    /// returns some usual values.
    pub fn shown(&self) -> Vec<String> {
        let mut shown: Vec<String> = self.show.clone();
        let measured = self.demands.iter().flat_map(|demand| demand.measure.values());
        for name in self.compare.iter().cloned().chain(measured) {
            if !shown.contains(&name) {
                shown.push(name);
            }
        }
        if shown.is_empty() {
            shown =
                ["fitness", "steps_climbed", "landed", "first_landing"].map(str::to_owned).to_vec();
        }
        shown
    }
}

impl Arm {
    /// Returns the title of the arm, or its name if the title is empty.
    pub fn title(&self) -> &str {
        if self.title.is_empty() { &self.name } else { &self.title }
    }
}
