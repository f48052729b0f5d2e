//! A study as data that can be written as RON: arms, seeds, values and demands.

use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::path::Path;

use serde::de::Error;
use serde::{Deserialize, Deserializer};

use super::measure::Measure;
use snakes_core::check::{Invalid, quoted};
use snakes_core::evolve::StrategyKind;
use snakes_core::genome::ControllerKind;
use snakes_core::save::{
    DEFAULT_PRESET, SaveError, load_definition, load_preset, parse_definition,
};
use snakes_core::schema::Choices;
use snakes_core::score::ExamSuite;

/// A study: runs of several arms over several seeds, each of which is measured by the same values.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// Its name, which is that of its files.
    pub name: String,
    /// Its title.
    pub title: String,
    /// Its question, in a sentence or two.
    #[serde(default)]
    pub about: String,
    /// The preset of the arms that name none.
    #[serde(default = "default_preset")]
    pub preset: String,
    /// The first seed.
    #[serde(default = "default_first_seed")]
    pub first_seed: u64,
    /// Number of seeds.
    #[serde(default = "default_seeds")]
    pub seeds: u64,
    /// Evaluations that a run may spend; none for the generations of the preset.
    #[serde(default)]
    pub evaluations: Option<u32>,
    /// Stairs of all arms, instead of those of their presets: a name, or the path of a file.
    #[serde(default)]
    pub stairs: Option<String>,
    /// Changed settings of all arms.
    #[serde(default)]
    pub settings: Changes,
    /// Whether trials last as long as those of the exam on other stairs.
    #[serde(default)]
    pub exam_length: bool,
    /// Strategies that are crossed with controllers; each pair that fits together is an arm.
    #[serde(default)]
    pub methods: Option<Methods>,
    /// Arms beside those of `methods`.
    #[serde(default)]
    pub arms: Vec<Arm>,
    /// The arm with which the others are compared; the first, if none is named.
    #[serde(default)]
    pub baseline: Option<String>,
    /// Suites of the exam that champions take, in files by their names.
    #[serde(default, deserialize_with = "suites_by_name")]
    pub suites: Vec<ExamSuite>,
    /// Values in the table and the picture, beside those that demands are about.
    #[serde(default)]
    pub show: Vec<String>,
    /// Values that are compared with those of the baseline.
    #[serde(default)]
    pub compare: Vec<String>,
    /// For a list of numbers: the published ones, which stand beside those of the runs.
    #[serde(default)]
    pub references: BTreeMap<String, Vec<f64>>,
    /// Number of newborns whose motion is compared between the physics engines; none are, unless it is given.
    #[serde(default)]
    pub newborns: Option<u32>,
    /// Whether the built-in champions are examined in the other physics engine.
    #[serde(default)]
    pub built_in_champions: bool,
    /// Demands on the results.
    #[serde(default)]
    pub demands: Vec<Demand>,
    /// The names of the arms that are made and shown; all, if it is empty. The others are only compared with.
    #[serde(skip)]
    pub selected: Vec<String>,
}

/// Strategies and controllers. An empty list stands for all.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Methods {
    /// The strategies.
    #[serde(default)]
    pub strategies: Vec<StrategyKind>,
    /// The controllers.
    #[serde(default)]
    pub controllers: Vec<ControllerKind>,
}

/// An arm: runs with one preset, one list of changed settings and one budget, over all seeds.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Arm {
    /// Its name.
    pub name: String,
    /// Its title in tables and pictures; the name, if it is empty.
    #[serde(default)]
    pub title: String,
    /// Its preset; that of the study, if none is named.
    #[serde(default)]
    pub preset: Option<String>,
    /// Changed settings.
    #[serde(default)]
    pub settings: Changes,
    /// Evaluations that a run may spend, instead of those of the study.
    #[serde(default)]
    pub evaluations: Option<u32>,
    /// How many times the evaluations of the study a run may spend instead.
    #[serde(default)]
    pub evaluations_times: Option<u32>,
    /// A goal.
    #[serde(default)]
    pub goal: Option<Goal>,
    /// Whether a run ends with the generation that reaches the goal.
    #[serde(default)]
    pub stops_at_goal: bool,
    /// The champions that take the exam.
    #[serde(default)]
    pub examined: Examined,
    /// The arm with which it is compared, instead of the study's.
    #[serde(default)]
    pub baseline: Option<String>,
    /// Its strategy and controller, if it is one of the study's methods.
    #[serde(skip)]
    pub method: Option<(StrategyKind, ControllerKind)>,
}

/// The goal of a run.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub enum Goal {
    /// Any snake ends on the landing.
    Landing,
    /// The middle of a generation's champion moves so far towards the stairs, in m.
    Way(f32),
    /// A generation's champion climbs so many steps.
    Steps(u32),
}

/// Which champions take the exam.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
pub enum Examined {
    /// The champions of all seeds.
    #[default]
    All,
    /// The best champion of all seeds: one that landed, of several the one with the most steps, of equals the fittest.
    Best,
    /// No champion.
    Never,
}

/// A demand on the results of arms.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Demand {
    /// The arms, each of which has to meet it.
    #[serde(default)]
    pub arms: Vec<String>,
    /// The measure of an arm that the demand bounds.
    pub measure: Measure,
    /// The arm with which it is compared, where that is not the baseline.
    #[serde(default)]
    pub against: Option<String>,
    /// Whether less is better where more usually is.
    #[serde(default)]
    pub at_most: bool,
    /// The bound that the measure has to reach.
    #[serde(default)]
    pub must: Option<f64>,
    /// A bound that is hard to reach, but realistic.
    #[serde(default)]
    pub hard: Option<f64>,
}

/// Settings by their names, with their values as a file may write them: `{"surface.friction": 0.8, "strategy": "ga"}`.
pub type Changes = BTreeMap<String, Plain>;

/// A value of a setting.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum Plain {
    /// Yes or no.
    Bool(bool),
    /// A whole number.
    Whole(i64),
    /// Any number.
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

/// The suites of a list of names, each once, in the order of the list of suites.
///
/// # Errors
/// An unknown name.
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

/// The built-in studies: name and definition.
const BUILT_IN: [(&str, &str); 10] = [
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
];

/// The studies that come with the program.
///
/// # Errors
/// None that a test did not find.
pub fn built_in_studies() -> Result<Vec<Study>, SaveError> {
    BUILT_IN.iter().map(|(name, text)| built_in(name, text)).collect()
}

fn built_in(name: &str, text: &str) -> Result<Study, SaveError> {
    let path = Path::new(name);
    Study::prepared(path, parse_definition(path, text)?)
}

impl Study {
    /// The built-in study of this name, or else the one in this file.
    ///
    /// # Errors
    /// There is neither, or the file is no study.
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

    /// Makes an arm of each method, in the order in which strategies and controllers are named.
    ///
    /// # Errors
    /// A named strategy fits to no controller, or evolves stairs, so that results on different stairs would be compared.
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

    /// The arm of a name.
    ///
    /// # Errors
    /// There is none.
    pub fn named(&self, field: &str, name: &str) -> Result<&Arm, Invalid> {
        self.arms.iter().find(|arm| arm.name == name).ok_or_else(|| {
            let names: Vec<&str> = self.arms.iter().map(|arm| arm.name.as_str()).collect();
            Invalid::new(field, quoted(name), names.join(", "))
        })
    }

    /// The arm with which another is compared; none for the baseline itself.
    pub fn baseline_of(&self, arm: &Arm) -> Option<&Arm> {
        let name = arm.baseline.as_ref().or(self.baseline.as_ref());
        let baseline = match name {
            Some(name) => self.arms.iter().find(|arm| arm.name == *name)?,
            None => self.arms.first()?,
        };
        (baseline.name != arm.name).then_some(baseline)
    }

    /// The seeds.
    pub fn seeds(&self) -> std::ops::Range<u64> {
        self.first_seed..self.first_seed + self.seeds
    }

    /// The arms that are made and shown.
    pub fn selected_arms(&self) -> impl Iterator<Item = &Arm> {
        let is_selected = |name: &String| self.selected.is_empty() || self.selected.contains(name);
        self.arms.iter().filter(move |arm| is_selected(&arm.name))
    }

    /// The demands, each with an arm that has to meet it, in the order of the arms.
    pub fn demands_by_arm(&self) -> Vec<(&Arm, &Demand)> {
        let concerns =
            |demand: &Demand, arm: &Arm| demand.arms.is_empty() || demand.arms.contains(&arm.name);
        let of_arm = |arm| {
            let demands = self.demands.iter().filter(move |demand| concerns(demand, arm));
            demands.map(move |demand| (arm, demand))
        };
        self.selected_arms().flat_map(of_arm).collect()
    }

    /// The values that are shown: those that the study names, and those that its demands are about.
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
    /// Its title, or its name if it has none.
    pub fn title(&self) -> &str {
        if self.title.is_empty() { &self.name } else { &self.title }
    }
}
