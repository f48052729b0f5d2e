//! The values by which runs are measured: their names, titles, units and digits.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use crate::run::judge::{JUDGES, Judge, JudgeResult};
use snakes_core::check::Invalid;
use snakes_core::genome::StairsClass;
use snakes_core::save::StudyValue;
use snakes_core::schema::Choices;
use snakes_core::score::{ExamSuite, SuiteResult};

/// The form of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// A number. A run without the value is left out.
    Number,
    /// A number of evaluations up to an event. For a run without the value, the event never came, which counts as infinite.
    Until,
    /// 1 if a condition is met, otherwise 0.
    Flag,
    /// A text.
    Text,
    /// A list of numbers, such as one for each generation.
    List,
}

/// A value by which runs are measured.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ValueInfo {
    /// Name of the value in files.
    pub name: String,
    /// Title of the value in tables.
    pub title: String,
    /// Unit of the value; empty for a count or a share.
    pub unit: &'static str,
    /// Maximum number of decimal places in tables.
    pub digits: usize,
    /// Form of the value.
    pub form: Form,
    /// Description of the value in a sentence.
    pub about: String,
}

use Form::{Flag, List, Number, Text, Until};

/// Name, title, unit, digits, form and description of a value.
type ValueRow = (&'static str, &'static str, &'static str, usize, Form, &'static str);

const ROWS: [ValueRow; 27] = [
    (
        "evaluations",
        "evaluations",
        "",
        0,
        Number,
        "Snakes that were evaluated, each in all its trials.",
    ),
    (
        "simulations",
        "simulations",
        "",
        0,
        Number,
        "Simulated trials: repeats of a trial, the choice of champions and the champion's exam included.",
    ),
    ("fitness", "best fitness", "", 3, Number, "Fitness of the run's champion."),
    (
        "steps_climbed",
        "steps",
        "",
        1,
        Number,
        "Steps that the champion climbed in its own trial; 0 without a champion.",
    ),
    ("landed", "land", "", 0, Flag, "1 if the champion ended on the landing, else 0."),
    (
        "first_landing",
        "first landing",
        "",
        1,
        Until,
        "Number of the first evaluation, counted from 1, that ended on the landing.",
    ),
    (
        "goal_evaluations",
        "evaluations to the goal",
        "",
        0,
        Until,
        "Evaluations up to the end of the first generation that reached the arm's goal.",
    ),
    ("last_mean", "final mean", "", 3, Number, "Mean fitness of the last generation."),
    ("way_m", "way", "m", 2, Number, "Way of the champion's middle towards the stairs."),
    ("blocks", "blocks", "", 1, Number, "Blocks of the champion."),
    ("energy_j_per_m", "energy", "J/m", 0, Number, "Energy of the champion per metre of its way."),
    (
        "cost_of_transport",
        "cost of transport",
        "",
        2,
        Number,
        "Energy of the champion per weight and way.",
    ),
    (
        "climbing_efficiency",
        "climbing efficiency",
        "",
        3,
        Number,
        "Share of the champion's energy that lifted it.",
    ),
    (
        "rises",
        "mean rises",
        "",
        0,
        Flag,
        "1 if the mean fitness rises with every generation, else 0.",
    ),
    ("generation_means", "mean fitness", "", 2, List, "Mean fitness of each generation."),
    (
        "generation_disqualified",
        "disqualified",
        "",
        0,
        List,
        "Disqualified snakes of each generation.",
    ),
    ("rules", "rules", "", 1, Number, "Rules of the champion."),
    (
        "decisions_of_20",
        "decisions by 20 rules",
        "%",
        1,
        Number,
        "Share of its decisions that the champion's twenty most used rules make.",
    ),
    (
        "waves_used",
        "waves used",
        "",
        1,
        Number,
        "Waves that the champion uses for a tenth of its decisions or more.",
    ),
    ("ending", "endings", "", 0, Text, "How the champion's own trial ended."),
    (
        "tree",
        "trees of joints",
        "",
        0,
        Text,
        "The champion's joints as a tree: one letter for the kind of each.",
    ),
    (
        "changes",
        "changes of structure",
        "",
        1,
        Number,
        "Changes of the number of blocks in the champion's line of descent.",
    ),
    ("late_changes", "late changes", "", 1, Number, "Those in the second half of the generations."),
    (
        "filled_cells",
        "filled cells",
        "%",
        1,
        Number,
        "Feasible cells of an archive of all bodies that are filled.",
    ),
    ("qd_score", "QD score", "", 1, Number, "Quality-diversity score of that archive."),
    (
        "split_changes",
        "change by a split",
        "",
        3,
        List,
        "Change of the fitness of the last generation's best twenty when a block of theirs is split.",
    ),
    (
        "insertion_changes",
        "change by an insertion",
        "",
        3,
        List,
        "The change when a block is inserted.",
    ),
];

/// Values that are measured only if a study shows them, because they take more simulations. They describe evolving bodies.
const OF_BODIES: [&str; 6] =
    ["changes", "late_changes", "filled_cells", "qd_score", "split_changes", "insertion_changes"];

/// Returns whether a value needs the measurements of evolving bodies.
pub(super) fn is_of_bodies(name: &str) -> bool {
    OF_BODIES.contains(&name)
}

/// Returns the name of a suite as a part of names of values.
fn suite_name(suite: ExamSuite) -> String {
    suite.choice().name.replace('-', "_")
}

/// Values of each suite: suffix of the name, suffix of the title, digits, description.
const OF_SUITE: [(&str, &str, usize, &str); 5] = [
    ("", "", 1, "Landings of 100 trials"),
    ("_trials", " trials", 0, "Number of trials"),
    ("_disqualified", " disqualified", 0, "Disqualified trials"),
    ("_median_steps", " steps", 1, "Median of the steps climbed"),
    (
        "_kept",
        " kept",
        2,
        "Share of its way in its own trial that the champion keeps: the median, of step rates the least",
    ),
];

/// Values of each judge: suffix of the name, suffix of the title, digits, description.
const OF_JUDGE: [(&str, &str, usize, &str); 5] = [
    ("", "", 1, "Landings per 100 trials"),
    ("_trials", " trials", 0, "Number of trials"),
    ("_climbed", " climbed", 0, "Trials that climb at least three steps"),
    ("_way", " way", 2, "Median share of the way from the start to the landing"),
    (
        "_kept",
        " kept",
        2,
        "Median share that the champion keeps of its way in this program from the same start",
    ),
];

/// Returns all values, in the order of tables and files.
pub fn values() -> &'static [ValueInfo] {
    static VALUES: OnceLock<Vec<ValueInfo>> = OnceLock::new();
    VALUES.get_or_init(listed)
}

fn listed() -> Vec<ValueInfo> {
    let row = |(name, title, unit, digits, form, about): ValueRow| ValueInfo {
        name: name.to_owned(),
        title: title.to_owned(),
        unit,
        digits,
        form,
        about: about.to_owned(),
    };
    let mut values: Vec<ValueInfo> = ROWS.map(row).to_vec();
    let number = |name: String, title: String, digits, about: String| ValueInfo {
        name,
        title,
        unit: "",
        digits,
        form: Number,
        about,
    };
    for suite in ExamSuite::OPTIONS {
        let name = suite_name(*suite);
        for (ending, title, digits, about) in OF_SUITE {
            let about = format!("{about} in the suite {}.", suite.choice().name);
            let title = format!("{}{title}", suite.choice().title.to_lowercase());
            values.push(number(format!("exam_{name}{ending}"), title, digits, about));
        }
        if *suite == ExamSuite::HeldOut {
            for class in StairsClass::OPTIONS.iter().map(|class| class.choice().name) {
                let about =
                    format!("Held-out stairs of the class {class} on which the champion lands.");
                values.push(number(format!("exam_{name}_{class}"), class.to_owned(), 1, about));
            }
        }
    }
    for judge in &JUDGES {
        for (ending, title, digits, about) in OF_JUDGE {
            let about = format!("{about} in {}.", judge.title);
            let title = format!("{}{title}", judge.title);
            values.push(number(of_judge(judge, ending), title, digits, about));
        }
    }
    values
}

/// Returns the value with this name.
///
/// # Errors
/// There is no such value.
pub fn value(field: &str, name: &str) -> Result<&'static ValueInfo, Invalid> {
    values().iter().find(|info| info.name == name).ok_or_else(|| {
        let names: Vec<&str> = values().iter().map(|info| info.name.as_str()).collect();
        Invalid::new(field, format!("{name:?}"), names.join(", "))
    })
}

/// Returns the value with this name; `None` for an unknown name, which the check of the study refuses.
pub(super) fn info_of(name: &str) -> Option<&'static ValueInfo> {
    value("of", name).ok()
}

impl ValueInfo {
    /// Returns the title with the unit.
    pub fn label(&self) -> String {
        match self.unit {
            "" => self.title.clone(),
            unit => format!("{}, {unit}", self.title),
        }
    }
}

/// Formats a number with as many decimal places as it needs, at most `digits`. An infinite number becomes a dash.
pub fn number(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    let text = format!("{value:.digits$}");
    let text =
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    (if text == "-0" { "0" } else { text }).to_owned()
}

/// Formats a number with its sign and at most `digits` decimal places.
pub(super) fn signed(value: f64, digits: usize) -> String {
    let sign = if value >= 0.0 && value.is_finite() { "+" } else { "" };
    format!("{sign}{}", number(value, digits))
}

/// Converts a 32-bit number so that it is stored with the fewest digits that give it back.
pub(super) fn short(value: f32) -> StudyValue {
    StudyValue::Number(crate::run::short(value).as_f64().unwrap_or(0.0))
}

/// Returns the name of a suite's value, such as `exam_held_out_trials`.
pub fn of_suite(suite: ExamSuite, ending: &str) -> String {
    format!("exam_{}{ending}", suite_name(suite))
}

/// Returns the name of a judge's value, such as `exam_ode_kept`.
pub(super) fn of_judge(judge: &Judge, ending: &str) -> String {
    format!("exam_{}{ending}", judge.name)
}

/// Adds the results of a judge to the values of a run.
pub(super) fn add_judged(values: &mut BTreeMap<String, StudyValue>, result: &JudgeResult) {
    let JudgeResult { judge, trials, climbed, landed, way, kept, .. } = result;
    let landings = 100.0 * f64::from(landed[1]) / f64::from((*trials).max(1));
    let found = [
        StudyValue::Number(landings),
        StudyValue::Number((*trials).into()),
        StudyValue::Number(climbed[1].into()),
        short(way[1]),
        short(*kept),
    ];
    let names = OF_JUDGE.map(|(ending, ..)| of_judge(judge, ending));
    values.extend(names.into_iter().zip(found));
}

/// Adds the results of an exam to the values of a run.
pub(super) fn add_exam(values: &mut BTreeMap<String, StudyValue>, results: &[SuiteResult]) {
    for result in results {
        let (landed, trials) = (f64::from(result.landed), f64::from(result.trials.max(1)));
        let mut add = |ending: &str, value| {
            values.insert(of_suite(result.suite, ending), value);
        };
        add("", StudyValue::Number(100.0 * landed / trials));
        add("_trials", StudyValue::Number(result.trials.into()));
        add("_disqualified", StudyValue::Number(result.disqualified.into()));
        add("_median_steps", short(result.median_steps));
        add("_kept", short(result.kept));
        for (class, climbed, _) in result.classes() {
            add(&format!("_{class}"), StudyValue::Number(climbed.into()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_has_a_name_of_its_own_and_an_unknown_one_is_refused_with_all() {
        let all = values();
        for (index, info) in all.iter().enumerate() {
            assert!(all[..index].iter().all(|other| other.name != info.name), "{}", info.name);
            assert!(info.about.ends_with('.'), "{}", info.about);
        }
        assert_eq!(value("show", "exam_held_out_kept").expect("known").digits, 2);
        let error = value("show", "speed").expect_err("refused").to_string();
        assert!(
            error.starts_with("show is \"speed\"; allowed: evaluations, simulations"),
            "{error}"
        );
    }

    #[test]
    fn numbers_have_the_digits_that_they_need() {
        for (value, digits, text) in [
            (2.0, 3, "2"),
            (427.75, 1, "427.8"),
            (0.0500, 3, "0.05"),
            (100.0, 0, "100"),
            (-0.01, 1, "0"),
            (f64::INFINITY, 1, "–"),
        ] {
            assert_eq!(number(value, digits), text);
        }
    }
}
