//! Chart of the best body's ancestry: a row of pictures, one for every change of the structure.

use std::cmp::Ordering;
use std::sync::Arc;

use super::view::{ChartHit, ChartView, HitShape, generation_and_snake};
use crate::studio::commands::pick::Pick;
use crate::studio::panels::shown::place_of;
use snakes_core::evolve::{IndividualId, Settings};
use snakes_core::genome::{BodyChange, Genome};
use snakes_core::world::BodyPlan;
use snakes_lab::mesh::Outlines;
use snakes_lab::plot::{Axis, Chart, Figure, Role, Series, Shape, extent, with_unit};
use snakes_lab::run::{Ancestor, Ancestry, GenerationReport};

/// Maximum number of bodies that are drawn; earlier ones are left out.
const MAX_BODIES: usize = 24;
/// Width of a metre in the chart, in columns. It is less if a body would otherwise be wider than [`WIDEST`].
const METRE: f64 = 0.4;
/// Maximum width of a body in the chart, in columns.
const WIDEST: f64 = 0.9;

/// A new structure of a body: the first individual with the structure.
struct Structure {
    place: IndividualId,
    genome: Arc<Genome>,
    fitness: Option<f32>,
    /// Fitness of the individual's parent, or of the previous record.
    before: Option<f32>,
    /// Change of the structure, in words.
    change: String,
}

/// Creates the chart of the structures in the best snake's line of descent. If parents are unknown, shows the
/// structures of the best snakes so far.
pub(super) fn view(
    settings: &Settings,
    reports: &[GenerationReport],
    ancestry: Option<&Ancestry>,
) -> ChartView {
    let ancestry = ancestry.filter(|of| of.line.len() > 1);
    let mut structures = ancestry.map(of_line).unwrap_or_default();
    // Of generations that were finished before the program started, only the champions' genomes are known.
    let is_line = !structures.is_empty();
    if !is_line {
        structures = of_records(reports);
    }
    let left_out = structures.len().saturating_sub(MAX_BODIES);
    structures.drain(..left_out);
    let agent = &settings.trial.agent;
    let bodies: Vec<BodyPlan> =
        structures.iter().map(|structure| agent.body_plan(&structure.genome)).collect();
    let seen: Vec<Vec<[f64; 4]>> = bodies.iter().map(seen_from_above).collect();
    let half_widths_m = seen.iter().flatten().map(|[left, right, ..]| left.abs().max(right.abs()));
    let widest_m = 2.0 * half_widths_m.fold(f64::MIN_POSITIVE, f64::max);
    let metre = METRE.min(WIDEST / widest_m);
    let mut blocks: [Vec<[f64; 4]>; 2] = Default::default();
    let (mut hits, mut tallest_m) = (Vec::new(), 1.0_f64);
    let drawn = structures.iter().zip(&bodies);
    for (column, ((structure, body), seen)) in (1..).zip(drawn.clone().zip(seen)) {
        let x = f64::from(column);
        let length_m = f64::from(body.length_m());
        tallest_m = tallest_m.max(length_m);
        for (index, [left, right, bottom, top]) in seen.into_iter().enumerate() {
            blocks[index % 2].push([x + left * metre, x + right * metre, bottom, top]);
        }
        let unit = settings.trial.fitness.unit();
        let words = words(structure, body.limbs(), length_m, unit);
        let area = HitShape::Area([x - 0.45, x + 0.45, 0.0, length_m]);
        let pick = Pick::Individual(structure.place);
        hits.push(ChartHit::of(area, move || words.clone(), pick, structure.place));
    }
    let [red, blue] = blocks;
    let columns = structures.len().max(4) as f64;
    let x = Axis::count(if is_line { "Structure" } else { "Best body" }, 0.4..=columns + 0.6);
    let y = Axis::new("Length", "m", 0.0..=tallest_m * 1.05);
    let series = vec![
        Series::new("first, third, fifth block", Role::Red, Shape::Boxes(red)),
        Series::new("second, fourth block", Role::Blue, Shape::Boxes(blue)),
    ];
    let kind = if is_line {
        "Each column is a structure in the line of the best snake, the oldest on the left, seen from above with the head at \
         the top."
    } else {
        "Each column is the best snake so far with another structure, the oldest on the left, seen from above with the head \
         at the top."
    };
    let earlier = match left_out {
        0 => String::new(),
        count => format!(" {count} earlier ones are not shown."),
    };
    let fitness = with_unit("fitness", settings.trial.fitness.unit());
    let heads = ["generation", "snake", "change", "blocks", "length (m)", &fitness, "gain"];
    let records = drawn.map(|(structure, body)| record(structure, body));
    let figure = Figure::of("Ancestry of the best body", Chart::new(x, y, series))
        .with_note(format!("{kind}{earlier}"))
        .with_numbers(heads, records);
    ChartView::new(figure, vec![hits])
}

/// Returns the limbs of a body from above, with the head at the top: the left, right, lower and upper end of each, in
/// metres. The middle of the body is at 0 across, and its rear end at 0 along.
fn seen_from_above(body: &BodyPlan) -> Vec<[f64; 4]> {
    let outlines = Outlines::of(body);
    let middle_m = f64::from(outlines.size_m()[0] / 2.0);
    let limb = |corners: Vec<[f32; 2]>| {
        let ends = [0, 1].map(|axis| {
            extent(corners.iter().map(|corner| f64::from(corner[axis]))).unwrap_or_default()
        });
        let [[rear_m, front_m], [left_m, right_m]] = ends;
        [left_m - middle_m, right_m - middle_m, rear_m, front_m]
    };
    outlines.seen(0).into_iter().map(limb).collect()
}

fn words(structure: &Structure, blocks: usize, length_m: f64, unit: &str) -> String {
    let name = generation_and_snake(structure.place);
    let fitness = match (structure.fitness, structure.before) {
        (Some(fitness), Some(before)) => {
            format!("fitness {fitness:.2}{unit} ({:+.2})", fitness - before)
        }
        (Some(fitness), None) => format!("fitness {fitness:.2}{unit}"),
        (None, _) => "disqualified".to_owned(),
    };
    let change = &structure.change;
    format!("{name}\n{change}\n{blocks} blocks, {length_m:.1} m long\n{fitness}")
}

/// Returns the structures in a line of descent, the oldest first, as far as genomes are known.
fn of_line(ancestry: &Ancestry) -> Vec<Structure> {
    let known = |ancestor: &Arc<Ancestor>| Some((Arc::clone(ancestor), ancestor.genome.clone()?));
    let line: Vec<(Arc<Ancestor>, Arc<Genome>)> =
        ancestry.line.iter().rev().filter_map(known).collect();
    let mut structures: Vec<Structure> = Vec::new();
    let mut parent: Option<&(Arc<Ancestor>, Arc<Genome>)> = None;
    for child in &line {
        let (ancestor, genome) = child;
        let change = match parent {
            None => Some("the first known ancestor".to_owned()),
            Some((_, from)) if from.body.block_ids() == genome.body.block_ids() => None,
            Some((_, from)) => Some(in_words(from, genome)),
        };
        if let Some(change) = change {
            structures.push(Structure {
                place: ancestor.place,
                genome: Arc::clone(genome),
                fitness: ancestor.fitness,
                before: parent.and_then(|(parent, _)| parent.fitness),
                change,
            });
        }
        parent = Some(child);
    }
    structures
}

/// Describes the change between a parent and a child with different structures.
fn in_words(parent: &Genome, child: &Genome) -> String {
    match BodyChange::between(parent, child) {
        Some(change) => change.words().to_owned(),
        None if child.body.is_branching() => {
            let [before, after] = [parent, child].map(|of| of.body.block_count());
            match after.cmp(&before) {
                Ordering::Greater => format!("{} more parts", after - before),
                Ordering::Less => format!("{} fewer parts", before - after),
                Ordering::Equal => "other joints".to_owned(),
            }
        }
        None => "another structure".to_owned(),
    }
}

/// Returns the champions that were better than all earlier ones and whose structure differs from that of the previous one.
fn of_records(reports: &[GenerationReport]) -> Vec<Structure> {
    let (mut structures, mut best): (Vec<Structure>, Option<f32>) = (Vec::new(), None);
    for report in reports {
        let Some(champion) = &report.champion else { continue };
        let fitness = champion.evaluation.fitness;
        if best.is_some_and(|best| fitness <= best) {
            continue;
        }
        let last = structures.last().map(|last| last.genome.body.block_ids());
        if last != Some(champion.genome.body.block_ids()) {
            structures.push(Structure {
                place: place_of(champion),
                genome: Arc::new(champion.genome.clone()),
                fitness: Some(fitness),
                before: best,
                change: "best so far".to_owned(),
            });
        }
        best = Some(fitness);
    }
    structures
}

/// Returns the row of the table for a structure.
fn record(structure: &Structure, body: &BodyPlan) -> Vec<String> {
    let number = |value: Option<f32>| value.map_or(String::new(), |value| value.to_string());
    let gain = structure.fitness.zip(structure.before).map(|(fitness, before)| fitness - before);
    vec![
        structure.place.generation.to_string(),
        (structure.place.individual + 1).to_string(),
        structure.change.clone(),
        body.limbs().to_string(),
        body.length_m().to_string(),
        number(structure.fitness),
        number(gain),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::evolve::{Parents, RunPlan, StrategyKind};
    use snakes_core::genome::ControllerKind;
    use snakes_core::rng::{Purpose, stream};

    fn settings() -> Settings {
        let mut settings = Settings::default();
        settings.evolution.strategy = StrategyKind::BodyGa;
        settings.genome.controller = ControllerKind::Gait;
        settings.genome.bodies.vary = true;
        settings
    }

    fn ancestor(generation: u32, fitness: Option<f32>, genome: Genome) -> Arc<Ancestor> {
        let place = IndividualId { generation, individual: 3 };
        let (genome, parents) = (Some(Arc::new(genome)), Parents::Unknown);
        Arc::new(Ancestor { place, fitness, genome, parents })
    }

    /// Creates a line of descent. Each child changes its parent's body as the list says; for `None`, it changes a gene.
    fn line(changes: &[Option<BodyChange>]) -> Ancestry {
        let plan = RunPlan::new("test", 1, settings());
        let (space, shape) = (&plan.settings.genome, plan.settings.trial.genome_shape());
        let rng = |individual| stream(5, 1, individual, Purpose::Mutation);
        let mut drawn = (0..50).map(|individual| space.random_genome(shape, &mut rng(individual)));
        let mut genome = drawn.find(|of| of.body.segments.len() == 5).expect("one in eleven");
        let mut line = Vec::new();
        for (generation, change) in (1..).zip([None].iter().chain(changes)) {
            if let Some(change) = change {
                let child = |individual| {
                    let mut rng = rng(generation * 100 + individual);
                    space.with_body_change(&genome, *change, &mut rng)
                };
                genome = (0..50).find_map(child).expect("allowed");
            }
            line.insert(0, ancestor(generation, Some(generation as f32 / 10.0), genome.clone()));
        }
        Ancestry { line, ..Ancestry::default() }
    }

    #[test]
    fn each_change_of_structure_has_its_picture_and_its_name() {
        use BodyChange::{Duplicate, Insert, Resize, Split};
        let changes = [None, Some(Split), Some(Resize), Some(Duplicate), None, Some(Insert)];
        let view = view(&settings(), &[], Some(&line(&changes)));
        let words: Vec<String> = view.hits[0].iter().map(ChartHit::words).collect();
        let expected = ["the first known ancestor", "split", "duplicated", "inserted"];
        assert_eq!(words.len(), expected.len(), "{words:?}");
        for (words, expected) in words.iter().zip(expected) {
            assert!(words.contains(expected), "{words}");
        }
        assert!(words[1].starts_with("Generation 3, snake 4\n"), "{}", words[1]);
        assert!(words[1].ends_with("fitness 0.30 m (+0.10)"), "{}", words[1]);
        assert_eq!(view.figure.table().len(), 5);
        let Shape::Boxes(red) = &view.figure.charts[0].series[0].shape else { panic!("boxes") };
        let Shape::Boxes(blue) = &view.figure.charts[0].series[1].shape else { panic!("boxes") };
        let in_column = |boxes: &[[f64; 4]], column: f64| {
            boxes.iter().filter(|of| (of[0] + of[1]) / 2.0 - column < 0.5 && of[1] > column).count()
        };
        let blocks = |column: f64| in_column(red, column) + in_column(blue, column);
        assert_eq!(blocks(2.0), blocks(1.0) + 1, "a split is a block more");
    }

    #[test]
    fn creatures_do_not_reach_into_the_next_column() {
        let mut settings = settings();
        settings.genome.controller = ControllerKind::PartNeurons;
        let shape = settings.trial.genome_shape();
        let creature = |generation: u32| {
            let mut rng = stream(generation.into(), 1, 0, Purpose::Birth);
            ancestor(generation, None, settings.genome.random_genome(shape, &mut rng))
        };
        let line = (1..=8).rev().map(creature).collect();
        let view = view(&settings, &[], Some(&Ancestry { line, ..Ancestry::default() }));
        let boxes = view.figure.charts[0].series.iter().flat_map(|series| match &series.shape {
            Shape::Boxes(boxes) => boxes.clone(),
            _ => panic!("boxes"),
        });
        let (mut boxes, mut widest) = (boxes.peekable(), 0.0_f64);
        assert!(boxes.peek().is_some());
        for [left, right, bottom, top] in boxes {
            assert_eq!(left.round(), right.round(), "within one column");
            assert!(left < right && bottom < top && bottom > -0.01, "{bottom} to {top} m");
            widest = widest.max(2.0 * (right - right.round()).abs());
        }
        assert!((widest - WIDEST).abs() < 1e-6, "the widest fills its column: {widest}");
    }

    #[test]
    fn without_parents_the_records_of_the_run_are_shown() {
        let run = crate::studio::state::current_run::bodies_run();
        let view = view(run.settings(), &run.reports, None);
        let words = view.hits[0][0].words();
        assert!(words.contains("best so far"), "{words}");
        assert!(view.figure.note.contains("best snake so far"), "{}", view.figure.note);
    }
}
