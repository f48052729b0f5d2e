//! Chart of the tree of evolving stairs. Each staircase is placed at the round in which it was created and at its rise; arrows show
//! transfers of snakes. A click replays the snake of a staircase. A second chart shows how many new challenges were solved.

use super::view::{ChartHit, ChartView, HitShape};
use crate::studio::commands::pick::Pick;
use snakes_core::evolve::{
    IndividualId, StairsCount, StairsNode, StairsTree, StrategyKind, Transfer,
};
use snakes_lab::plot::{Axis, Chart, Figure, Role, Series, Shape};
use snakes_lab::run::GenerationReport;

/// Maximum number of drawn transfers, the latest ones. More arrows would hide the tree.
const MOST_ARROWS: usize = 60;

/// Creates the charts of the tree of stairs of a run with this strategy.
pub(super) fn view(
    strategy: StrategyKind,
    reports: &[GenerationReport],
    tree: &StairsTree,
) -> ChartView {
    let has_challenges = strategy != StrategyKind::Mcc;
    let last = f64::from(tree.rounds.max(1));
    let aside = last * 0.04;
    let x = Axis::count("Round", -aside..=last + aside);
    let rises = tree.nodes.iter().map(|node| f64::from(node.stairs.rise_m));
    let y = Axis::around("Mean rise", "m", rises, 0.1);
    let nodes = Chart::new(x.clone(), y, series(tree, has_challenges)).named("Stairs");
    let (name, title, series, note, number): (_, _, _, _, fn(&StairsCount) -> u32) =
        if has_challenges {
            (
                "New challenges",
                "Solved so far (ANNECS)",
                "new challenges solved",
                "A new challenge was neither too easy nor too hard for the best snake when it came.",
                |count| count.challenges,
            )
        } else {
            (
                "Number of stairs",
                "Climbed so far",
                "stairs that a snake has climbed",
                "Each staircase entered the queue because a snake climbed it.",
                |count| count.solved,
            )
        };
    let progress = by_round(reports, number);
    let most = progress.last().map_or(1.0, |last| last[1]).max(1.0);
    let y = Axis::count(title, 0.0..=most * 1.05);
    let series = vec![Series::new(series, Role::Third, Shape::Line(progress))];
    let challenges = Chart::new(x, y, series).named(name);
    let hits = (0..).zip(&tree.nodes).map(|(index, node)| hit(index, node)).collect();
    let figure = Figure::of_several("Stairs that evolve", vec![nodes, challenges])
        .with_note(format!("Click stairs to see their snake climb them. {note}"))
        .with_numbers(HEADS, (1..).zip(&tree.nodes).map(record));
    ChartView::new(figure, vec![hits, Vec::new()])
}

fn place(node: &StairsNode) -> [f64; 2] {
    [node.born.into(), node.stairs.rise_m.into()]
}

/// A state of stairs: its name, its role, and whether stairs are in it.
type NodeState = (&'static str, Role, fn(&StairsNode) -> bool);

/// Returns the stairs of a tree in series by their state: solved or unsolved or, if all are solved, whether they are
/// still in their queue.
fn series(tree: &StairsTree, has_unsolved: bool) -> Vec<Series> {
    let node = |index: u32| tree.nodes.get(index as usize);
    let descents =
        tree.nodes.iter().filter_map(|child| Some([place(node(child.parent?)?), place(child)]));
    let transfer = |of: &Transfer| Some([place(node(of.from)?), place(node(of.to)?)]);
    let skipped = tree.transfers.len().saturating_sub(MOST_ARROWS);
    let transfers = tree.transfers.iter().skip(skipped).filter_map(transfer);
    let mut series = vec![
        Series::new("descent", Role::Others, Shape::Arrows(descents.collect())),
        Series::new("transfers of snakes", Role::Second, Shape::Arrows(transfers.collect())),
    ];
    let states: &[NodeState] = match has_unsolved {
        true => &[
            ("archived unsolved", Role::Others, |of| of.solved.is_none() && of.archived.is_some()),
            ("active", Role::Third, |of| of.solved.is_none() && of.archived.is_none()),
            ("solved", Role::First, |of| of.solved.is_some()),
        ],
        false => &[
            ("removed from the queue", Role::Others, |of| of.archived.is_some()),
            ("in the queue", Role::First, |of| of.archived.is_none()),
        ],
    };
    series.extend(states.iter().map(|(name, role, is_in)| {
        let nodes = tree.nodes.iter().filter(|node| is_in(node));
        Series::new(name, *role, Shape::Points(nodes.map(place).collect()))
    }));
    // Empty series would need an entry in the legend.
    series.retain(|series| !series.shape.is_empty());
    series
}

/// Returns a number at the end of each round, as points of a chart.
fn by_round(reports: &[GenerationReport], number: impl Fn(&StairsCount) -> u32) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for count in reports.iter().filter_map(|report| report.stairs) {
        let point = [f64::from(count.rounds), f64::from(number(&count))];
        match points.last_mut() {
            Some(last) if last[0] == point[0] => *last = point,
            _ => points.push(point),
        }
    }
    points
}

fn hit(index: u32, node: &StairsNode) -> ChartHit {
    let words = {
        let node = node.clone();
        move || words(index, &node)
    };
    let target = HitShape::Point(place(node));
    match &node.agent {
        Some(agent) => {
            let at = IndividualId { generation: agent.generation, individual: agent.individual };
            ChartHit::of(target, words, Pick::Stairs(index), at)
        }
        None => ChartHit::new(target, words),
    }
}

/// Describes a staircase.
fn words(index: u32, node: &StairsNode) -> String {
    let state = match (node.solved, node.archived) {
        (Some(solved), _) => format!("solved in round {solved}"),
        (None, None) => "not solved yet".to_owned(),
        (None, Some(archived)) => format!("archived unsolved in round {archived}"),
    };
    let parent = match node.parent {
        Some(parent) => format!("mutant of stairs {}", parent + 1),
        None => "the first".to_owned(),
    };
    let score = node.score;
    format!(
        "Stairs {}: {}\n{parent}, {state}\nits snake covers {score:.2} of the way",
        index + 1,
        node.stairs
    )
}

/// Headings of the columns of the table.
const HEADS: [&str; 9] = [
    "stairs",
    "shape",
    "parent",
    "round",
    "archived",
    "solved",
    "new challenge",
    "share",
    "trials",
];

/// Returns the row of the table for the stairs with this number.
fn record((number, node): (u32, &StairsNode)) -> Vec<String> {
    let text = |number: Option<u32>| number.map_or(String::new(), |number| number.to_string());
    vec![
        number.to_string(),
        node.stairs.to_string(),
        text(node.parent.map(|parent| parent + 1)),
        node.born.to_string(),
        text(node.archived),
        text(node.solved),
        node.is_new_challenge.to_string(),
        node.score.to_string(),
        node.trials.to_string(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::evolve::Agent;
    use snakes_core::genome::{GenomeShape, GenomeSpace, StairsGenome};
    use snakes_core::rng::{Purpose, stream};

    fn tree() -> StairsTree {
        let shape = GenomeShape { joints: 4, duration_s: 1.0 };
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        let genome = GenomeSpace::default().random_genome(shape, &mut rng);
        let node = |parent, born, solved, archived, rise_m| StairsNode {
            stairs: StairsGenome { rise_m, ..StairsGenome::default() },
            parent,
            born,
            archived,
            solved,
            is_new_challenge: born > 0,
            agent: Some(Agent { genome: genome.clone(), generation: 7, individual: 3 }),
            score: 0.5,
            trials: 100,
        };
        StairsTree {
            rounds: 4,
            nodes: vec![
                node(None, 0, Some(1), Some(4), 0.1),
                node(Some(0), 1, None, Some(4), 0.3),
                node(Some(0), 2, None, None, 0.5),
            ],
            transfers: vec![Transfer { round: 3, from: 1, to: 2 }],
        }
    }

    #[test]
    fn each_staircase_can_be_clicked_and_arrows_lead_from_parents_and_along_transfers() {
        let view = view(StrategyKind::Poet, &[], &tree());
        let names: Vec<&str> = view.figure.listed().iter().map(|of| of.name.as_str()).collect();
        for name in ["descent", "transfers of snakes", "archived unsolved", "active", "solved"] {
            assert!(names.contains(&name), "{name} in {names:?}");
        }
        let picks: Vec<Option<Pick>> = view.hits[0].iter().map(|hit| hit.pick).collect();
        assert_eq!(picks, [0, 1, 2].map(|index| Some(Pick::Stairs(index))));
        let text = view.hits[0][1].words();
        assert!(text.contains("mutant of stairs 1, archived unsolved in round 4"), "{text}");
        let Shape::Arrows(arrows) = &view.figure.charts[0].series[0].shape else {
            panic!("arrows")
        };
        assert_eq!(arrows.len(), 2);
        assert_eq!(view.figure.numbers.as_ref().map(Vec::len), Some(4));
    }

    #[test]
    fn the_second_chart_counts_what_the_strategy_makes() {
        let second = |strategy| view(strategy, &[], &tree()).figure.charts[1].name.clone();
        let names = [StrategyKind::Poet, StrategyKind::Mcc].map(second);
        assert_eq!(names, ["New challenges", "Number of stairs"]);
        let queue = view(StrategyKind::Mcc, &[], &tree());
        let names: Vec<&str> = queue.figure.listed().iter().map(|of| of.name.as_str()).collect();
        assert!(names.contains(&"in the queue") && !names.contains(&"solved"), "{names:?}");
    }
}
