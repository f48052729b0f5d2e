//! How the trials of an exam ended, as JSON and as a table.

use serde_json::{Map, Value, json};

use snakes_core::schema::Choices;
use snakes_core::score::{EndingCount, EndingKind, Endings, Trick};
use snakes_core::world::Disqualification;
use snakes_lab::run::markdown::markdown_table;
use snakes_lab::run::short;

/// Adds how trials ended to an object of JSON: `endings`, a list of kinds with the numbers of trials and the median step, and `tricks`,
/// the number of trials with each trick.
pub fn add_endings(object: &mut Value, endings: &Endings) {
    let Endings { counts, tricks } = endings;
    let each = counts.iter().map(|EndingCount { kind, reason, trials, step }| {
        let reason = reason.map(Disqualification::words);
        json!({"ending": kind.choice().name, "reason": reason, "trials": trials, "step": short(*step)})
    });
    let tricks = Trick::OPTIONS.iter().zip(tricks);
    let tricks: Map<_, _> =
        tricks.map(|(trick, used)| (trick.choice().name.to_owned(), (*used).into())).collect();
    object["endings"] = each.collect();
    object["tricks"] = Value::Object(tricks);
}

/// Makes a Markdown table of how trials ended: a row for each champion and suite, a column for each way that occurs, with the median
/// of the steps, and one for each trick that occurs.
pub fn endings_table(rows: &[(String, &str, &Endings)]) -> String {
    let counts = rows.iter().flat_map(|(.., endings)| &endings.counts);
    let mut ways: Vec<_> = counts.map(|count| (count.kind, count.reason)).collect();
    ways.sort_unstable();
    ways.dedup();
    let is_used = |trick: &usize| rows.iter().any(|(.., endings)| endings.tricks[*trick] > 0);
    let tricks: Vec<usize> = (0..Trick::OPTIONS.len()).filter(is_used).collect();
    let titles = ways.iter().map(|(kind, reason)| match reason {
        Some(reason) => format!("{}: {}", kind.choice().title, reason.words()),
        None => kind.choice().title.to_owned(),
    });
    let used = tricks.iter().map(|trick| Trick::OPTIONS[*trick].choice().title.to_owned());
    let head = ["champion", "suite"].map(str::to_owned).into_iter().chain(titles).chain(used);
    let row = |(name, suite, endings): &(String, &str, &Endings)| -> Vec<String> {
        let count = |way: &(EndingKind, Option<Disqualification>)| {
            let count = endings.counts.iter().find(|count| (count.kind, count.reason) == *way);
            count.map_or_else(|| "–".to_owned(), cell)
        };
        let used = tricks.iter().map(|trick| match endings.tricks[*trick] {
            0 => "–".to_owned(),
            trials => trials.to_string(),
        });
        let names = [name.clone(), (*suite).to_owned()];
        names.into_iter().chain(ways.iter().map(count)).chain(used).collect()
    };
    let head: Vec<String> = head.collect();
    markdown_table([head].into_iter().chain(rows.iter().map(row)), 2)
}

/// Formats the number of trials that ended in a way, with the median step if the way names one: "14 from 4".
fn cell(EndingCount { kind, trials, step, .. }: &EndingCount) -> String {
    let place = match kind {
        EndingKind::OffTheSide => "from",
        EndingKind::FellBack => "to",
        EndingKind::Stuck => "at",
        EndingKind::OutOfTime => "on",
        _ => return trials.to_string(),
    };
    format!("{trials} {place} {step}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::score::Ending;

    fn endings() -> Endings {
        let of = |kind, step, flung| Ending {
            kind,
            step,
            at_s: 0.0,
            reason: None,
            tricks: [false, false, flung],
        };
        Endings::of(
            [
                of(EndingKind::Landed, 10, true),
                of(EndingKind::OffTheSide, 3, false),
                of(EndingKind::OffTheSide, 6, false),
            ]
            .iter(),
        )
    }

    #[test]
    fn the_table_has_a_column_for_each_way_and_each_trick_that_occurs() {
        let (found, none) = (endings(), Endings::default());
        let rows = [("climber".to_owned(), "MuJoCo", &found), ("b".to_owned(), "ODE", &none)];
        let expected = "\
| champion | suite  | landed | fell off the side | was flung |
|:---------|:-------|-------:|------------------:|----------:|
| climber  | MuJoCo |      1 |        2 from 4.5 |         1 |
| b        | ODE    |      – |                 – |         – |
";
        assert_eq!(endings_table(&rows), expected);
    }

    #[test]
    fn json_has_every_trick_and_the_ways_that_occur() {
        let mut line = json!({"trials": 3});
        add_endings(&mut line, &endings());
        let expected = json!({
            "trials": 3,
            "endings": [
                {"ending": "landed", "reason": null, "trials": 1, "step": 10.0},
                {"ending": "off-the-side", "reason": null, "trials": 2, "step": 4.5},
            ],
            "tricks": {"leapt-over": 0, "went-around": 0, "flung": 1},
        });
        assert_eq!(line, expected);
    }
}
