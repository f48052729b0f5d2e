//! Chart of the snakes of each generation in bands, such as species, and of two numbers of the best snake.

use std::collections::BTreeMap;

use super::fitness::axis_of_finished;
use super::view::{ChartHit, ChartView, HitShape};
use crate::studio::commands::pick::Pick;
use snakes_core::evolve::{IndividualId, Settings, SpeciesCount};
use snakes_lab::plot::{Axis, Chart, Figure, Role, Series, Shape, with_unit};
use snakes_lab::run::GenerationReport;

/// Maximum number of generations that are drawn. In each, a layer is level over a short width, which takes two points.
const MAX_DRAWN: usize = 600;
/// Half of the width over which a layer is level, in generations.
const LEVEL: f64 = 0.25;

/// Texts of a chart of bands, and the numbers of the best snake.
pub(super) struct Bands {
    /// Title of the whole figure.
    pub title: &'static str,
    /// Name of the stack of bands.
    pub name: &'static str,
    /// First sentence of the note below the figure.
    pub note: &'static str,
    /// Returns the name of the band with this number, such as "Species 4".
    pub band: fn(u32) -> String,
    /// Describes a number of bands, such as "3 species".
    pub count: fn(usize) -> String,
    /// Name of the snakes that belong to none of the recorded bands.
    pub rest: &'static str,
    /// Heading of the column for the bands in the table.
    pub column: &'static str,
    /// Returns the bands of a generation, in ascending order of their numbers.
    pub counts: fn(&GenerationReport) -> Vec<SpeciesCount>,
    /// Whether a band shows its name and is in the legend, instead of showing its number, and is as high as its share of the generation
    /// instead of its number of snakes.
    pub is_named: bool,
    /// Chart of two numbers of the best snake, below the bands.
    pub best: Option<BestNumbers>,
}

/// Texts of a chart of two numbers of the best snake of each generation.
pub(super) struct BestNumbers {
    /// Name of the chart.
    pub name: &'static str,
    /// Name of the vertical axis.
    pub axis: &'static str,
    /// Names of the two numbers.
    pub names: [&'static str; 2],
    /// Headings of the columns for the two numbers in the table.
    pub columns: [&'static str; 2],
    /// Returns the two numbers of a generation; `None` without a best snake.
    pub of: fn(&GenerationReport) -> Option<[f64; 2]>,
    /// Describes the two numbers, in one line for each.
    pub words: fn([f64; 2]) -> String,
}

impl Bands {
    /// Returns the height in the chart of one snake of a generation.
    fn height(&self, report: &GenerationReport) -> f64 {
        if self.is_named { 100.0 / f64::from(report.evaluations.max(1)) } else { 1.0 }
    }
}

/// A generation with its bands.
struct Banded<'a> {
    report: &'a GenerationReport,
    counts: Vec<SpeciesCount>,
}

/// Creates the chart of the finished generations. It is empty if no generation has recorded bands.
pub(super) fn view(
    bands: &'static Bands,
    settings: &Settings,
    reports: &[GenerationReport],
) -> ChartView {
    let banded = |report| Banded { report, counts: (bands.counts)(report) };
    let known: Vec<Banded<'_>> =
        reports.iter().map(banded).filter(|banded| !banded.counts.is_empty()).collect();
    let Some(latest) = known.last() else {
        return ChartView::new(Figure::of_several(bands.title, Vec::new()), Vec::new());
    };
    let every = known.len().div_ceil(MAX_DRAWN).max(1);
    // The steps are chosen so that the latest generation is always drawn.
    let skipped = (known.len() - 1) % every;
    let drawn: Vec<&Banded<'_>> = known.iter().skip(skipped).step_by(every).collect();
    let mut lives = Lives::new();
    for Banded { report, counts } in &known {
        for species in counts {
            lives.entry(species.id).or_insert([report.generation; 2])[1] = report.generation;
        }
    }
    let x = axis_of_finished(reports.len());
    let most = known.iter().map(|banded| banded.report.evaluations).max().unwrap_or(1);
    let y = match bands.is_named {
        true => Axis::count("Share of the snakes, %", 0.0..=100.0),
        false => Axis::count("Snakes", 0.0..=f64::from(most)),
    };
    let stack = Chart::new(x.clone(), y, layers(bands, &drawn, &lives)).named(bands.name);
    let unit = settings.trial.fitness.unit();
    let of_report = |banded: &&Banded<'_>| hits(bands, banded, &lives, unit, every as f64);
    let (mut charts, mut all_hits) =
        (vec![stack], vec![drawn.iter().flat_map(of_report).collect()]);
    if let Some(best) = &bands.best {
        let (chart, points) = best_numbers(best, &known, x);
        charts.push(chart);
        all_hits.push(points);
    }
    let (now, ever) = (count_in_words(bands, latest), lives.len());
    let note = format!(
        "{} Generation {}: {now}. Recorded since the start: {ever}.",
        bands.note, latest.report.generation
    );
    let best_fitness = with_unit("best fitness", unit);
    let heads = ["generation", bands.column, "snakes", &best_fitness];
    let of_best = bands.best.iter().flat_map(|best| best.columns);
    let figure = Figure::of_several(bands.title, charts).with_note(note).with_numbers(
        heads.into_iter().chain(of_best),
        known.iter().flat_map(|banded| records(bands, banded)),
    );
    ChartView::new(figure, all_hits)
}

/// First and last generation of each band, by the band's number.
type Lives = BTreeMap<u32, [u32; 2]>;

/// Returns the number of snakes in the bands below this one, and in this band. Bands are stacked by their numbers.
fn place(species: &[SpeciesCount], id: u32) -> [u32; 2] {
    let before = species.partition_point(|count| count.id < id);
    let low = species[..before].iter().map(|count| count.size).sum();
    let size = species.get(before).filter(|count| count.id == id).map_or(0, |count| count.size);
    [low, size]
}

/// Creates a layer for each band. It begins in the generation before the band's first one and ends in that after the
/// last one, with height zero.
fn layers(bands: &Bands, drawn: &[&Banded<'_>], lives: &Lives) -> Vec<Series> {
    let layer = |(&id, &[first, last]): (&u32, &[u32; 2])| {
        let from = drawn.partition_point(|banded| banded.report.generation < first);
        let to = drawn.partition_point(|banded| banded.report.generation <= last);
        // The band exists only between two drawn generations.
        if from == to {
            return None;
        }
        let seen = drawn.get(from.saturating_sub(1)..(to + 1).min(drawn.len()))?;
        let ends = seen.iter().flat_map(|Banded { report, counts }| {
            let [low, size] = place(counts, id).map(|of| f64::from(of) * bands.height(report));
            let x = f64::from(report.generation);
            [x - LEVEL, x + LEVEL].map(|x| [x, low, low + size])
        });
        let name = if bands.is_named { (bands.band)(id) } else { String::new() };
        Some(Series::new(&name, Role::Species(id), Shape::Layer(ends.collect())))
    };
    let species = lives.iter().filter_map(layer);
    // The log contains only the largest bands of a generation.
    let rest = drawn.iter().flat_map(|Banded { report, counts }| {
        let low = counts.iter().map(|count| count.size).sum::<u32>();
        let x = f64::from(report.generation);
        let ends =
            [low, report.evaluations.max(low)].map(|of| f64::from(of) * bands.height(report));
        [x - LEVEL, x + LEVEL].map(|x| [x, ends[0], ends[1]])
    });
    let rest: Vec<[f64; 3]> = rest.collect();
    let has_rest = rest.iter().any(|[_, low, high]| high > low);
    let rest = Series::new(bands.rest, Role::Others, Shape::Layer(rest));
    species.chain(has_rest.then_some(rest)).collect()
}

/// Returns the hover targets of the bands in a generation, which is drawn `width` generations wide.
fn hits(
    bands: &'static Bands,
    banded: &Banded<'_>,
    lives: &Lives,
    unit: &'static str,
    width: f64,
) -> Vec<ChartHit> {
    let (generation, evaluations) = (banded.report.generation, banded.report.evaluations);
    let count = count_in_words(bands, banded);
    let x = f64::from(generation);
    let hit = |species: &SpeciesCount| {
        let SpeciesCount { id, size, best } = *species;
        let ends = place(&banded.counts, id).map(|of| f64::from(of) * bands.height(banded.report));
        let area = [x - width / 2.0, x + width / 2.0, ends[0], ends[0] + ends[1]];
        let first = lives.get(&id).map_or(generation, |life| life[0]);
        let (band, count) = ((bands.band)(id), count.clone());
        let words = move || {
            let best = match best {
                Some(best) => format!("best {best:.2}{unit}"),
                None => "all disqualified".to_owned(),
            };
            format!(
                "{band} in generation {generation}\n{size} of {evaluations} snakes, {best}\nfirst in \
                 generation {first}\n{count} in this generation"
            )
        };
        ChartHit::new(HitShape::Area(area), words)
    };
    banded.counts.iter().map(hit).collect()
}

/// Describes the number of bands in a generation. If only the largest are recorded, there are more.
fn count_in_words(bands: &Bands, Banded { report, counts }: &Banded<'_>) -> String {
    let recorded: u32 = counts.iter().map(|species| species.size).sum();
    let count = (bands.count)(counts.len());
    match report.evaluations.saturating_sub(recorded) {
        0 => count,
        _ => format!("more than {count}"),
    }
}

/// Creates the chart of two numbers of the best snake of each generation.
fn best_numbers(
    best: &'static BestNumbers,
    generations: &[Banded<'_>],
    x: Axis,
) -> (Chart, Vec<ChartHit>) {
    let numbers = |Banded { report, .. }: &Banded<'_>| (best.of)(report);
    let known: Vec<(&GenerationReport, [f64; 2])> =
        generations.iter().filter_map(|banded| Some((banded.report, numbers(banded)?))).collect();
    let along = |index: usize| {
        let point = |(report, numbers): &(&GenerationReport, [f64; 2])| {
            [f64::from(report.generation), numbers[index]]
        };
        Shape::Line(known.iter().map(point).collect())
    };
    let most = known.iter().flat_map(|(_, numbers)| numbers).copied().fold(1.0, f64::max);
    let hit = |(report, numbers): &(&GenerationReport, [f64; 2])| {
        let (generation, numbers) = (report.generation, *numbers);
        let individual = report.champion.as_ref()?.origin.individual;
        let words =
            move || format!("{} of generation {generation}\n{}", best.name, (best.words)(numbers));
        let target = HitShape::Column([f64::from(generation), numbers[0]]);
        let place = IndividualId { generation, individual };
        Some(ChartHit::of(target, words, Pick::Generation(generation), place))
    };
    let hits = known.iter().filter_map(hit).collect();
    let [first, second] = best.names;
    let series = vec![
        Series::new(first, Role::First, along(0)),
        Series::new(second, Role::Second, along(1)),
    ];
    let y = Axis::count(best.axis, -most * 0.06..=most * 1.12);
    (Chart::new(x, y, series).named(best.name), hits)
}

/// Returns the rows of the table for a generation, one for each band.
fn records(bands: &Bands, Banded { report, counts }: &Banded<'_>) -> Vec<Vec<String>> {
    let of_best = bands.best.iter().flat_map(|best| {
        let numbers = (best.of)(report);
        [0, 1].map(|i| numbers.map_or(String::new(), |numbers| numbers[i].to_string()))
    });
    let of_best: Vec<String> = of_best.collect();
    let generation = report.generation.to_string();
    let row = |species: &SpeciesCount| {
        let best = species.best.map_or(String::new(), |best| best.to_string());
        let id = if bands.is_named { (bands.band)(species.id) } else { species.id.to_string() };
        let all = [generation.clone(), id, species.size.to_string(), best];
        all.into_iter().chain(of_best.iter().cloned()).collect()
    };
    counts.iter().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::charts::band_kinds::SPECIES;
    use crate::studio::state::current_run::species_run;

    fn count(id: u32, size: u32) -> SpeciesCount {
        SpeciesCount { id, size, best: Some(1.5) }
    }

    /// Creates the chart of a run of 6 snakes with these species. `first` is the number of the first generation.
    fn view_of(first: u32, generations: &[&[SpeciesCount]]) -> ChartView {
        let run = species_run();
        let of = |(generation, species): (u32, &&[SpeciesCount])| {
            let mut report = run.reports[0].clone();
            (report.record.generation, report.record.evaluations) = (generation, 6);
            report.record.species = species.to_vec();
            report
        };
        let reports: Vec<GenerationReport> = (first..).zip(generations).map(of).collect();
        view(SPECIES, run.settings(), &reports)
    }

    /// Returns the points of a species' layer.
    fn layer(view: &ChartView, id: u32) -> Vec<[f64; 3]> {
        let mut series = view.figure.charts[0].series.iter();
        match series.find(|series| series.role == Role::Species(id)).map(|of| &of.shape) {
            Some(Shape::Layer(ends)) => ends.clone(),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_layer_lasts_from_birth_to_extinction_and_lies_on_the_older_ones() {
        let generations: [&[_]; 5] = [
            &[count(1, 6)],
            &[count(1, 4), count(2, 2)],
            &[count(2, 5), count(3, 1)],
            &[count(3, 6)],
            &[count(3, 6)],
        ];
        let view = view_of(1, &generations);
        let expected = [
            [0.75, 6.0, 6.0],
            [1.25, 6.0, 6.0],
            [1.75, 4.0, 6.0],
            [2.25, 4.0, 6.0],
            [2.75, 0.0, 5.0],
            [3.25, 0.0, 5.0],
            [3.75, 0.0, 0.0],
            [4.25, 0.0, 0.0],
        ];
        assert_eq!(layer(&view, 2), expected);
        assert_eq!(layer(&view, 1).last(), Some(&[3.25, 0.0, 0.0]));
        assert_eq!(layer(&view, 3)[0], [1.75, 6.0, 6.0], "it is born in generation 3");
        let note = "Generation 5: 1 species. Recorded since the start: 3.";
        assert!(view.figure.note.ends_with(note));
    }

    #[test]
    fn a_generation_of_neat_is_stacked_without_gaps() {
        let run = species_run();
        let view = view(SPECIES, run.settings(), &run.reports);
        for report in &run.reports {
            assert!(report.species.len() > 1, "{:?}", report.species);
            let at = f64::from(report.generation) + LEVEL;
            let mut top = 0.0;
            for species in &report.species {
                let ends = layer(&view, species.id);
                let [_, low, high] = ends.iter().find(|end| end[0] == at).expect("there");
                assert_eq!((*low, high - low), (top, f64::from(species.size)));
                top = *high;
            }
            assert_eq!(top, f64::from(report.evaluations));
        }
        let [network] = &view.figure.charts[1..] else { panic!("two charts") };
        let Shape::Line(links) = &network.series[0].shape else { panic!("a line") };
        // In the first generation, each of 21 inputs is linked to each of 4 outputs.
        assert_eq!(links[0], [1.0, 84.0]);
        let words = view.hits[1][0].words();
        assert_eq!(words, "Best network of generation 1\n84 links\n0 hidden nodes");
    }

    #[test]
    fn a_species_has_a_hover_text_and_rows_in_the_table() {
        let few: &[_] = &[count(4, 2), SpeciesCount { best: None, ..count(9, 1) }];
        let view = view_of(7, &[few]);
        let words: Vec<String> = view.hits[0].iter().map(ChartHit::words).collect();
        let expected = "Species 4 in generation 7\n2 of 6 snakes, best 1.50 m\nfirst in generation 7\n\
                        more than 2 species in this generation";
        assert_eq!(words[0], expected);
        assert!(words[1].contains("1 of 6 snakes, all disqualified"));
        let table = view.figure.table();
        assert_eq!(table[0][..4], ["generation", "species", "snakes", "best fitness (m)"]);
        assert_eq!(table[1][..5], ["7", "4", "2", "1.5", "84"]);
        assert_eq!(table[2][..4], ["7", "9", "1", ""]);
        let names: Vec<&str> = view.figure.listed().iter().map(|series| &*series.name).collect();
        assert!(names.contains(&"smaller species"), "3 of 6 snakes are in none: {names:?}");
    }

    #[test]
    fn logs_without_species_give_an_empty_chart_until_their_run_continues() {
        assert!(view_of(1, &[&[], &[]]).figure.is_empty());
        let view = view_of(1, &[&[], &[], &[count(5, 6)]]);
        assert_eq!(layer(&view, 5), [[2.75, 0.0, 6.0], [3.25, 0.0, 6.0]]);
    }

    #[test]
    fn ten_thousand_generations_are_thinned_out_together() {
        let [even, odd] = [[count(1, 4), count(2, 2)], [count(1, 1), count(2, 5)]];
        let all: Vec<&[SpeciesCount]> =
            (0..10_000).map(|i| if i % 2 == 0 { &even[..] } else { &odd[..] }).collect();
        let view = view_of(1, &all);
        let (lower, upper) = (layer(&view, 1), layer(&view, 2));
        assert!(lower.len() <= 2 * MAX_DRAWN && lower.len() > MAX_DRAWN, "{}", lower.len());
        assert_eq!(lower.last().map(|end| end[0]), Some(10_000.0 + LEVEL));
        assert!(lower.iter().zip(&upper).all(|(a, b)| a[0] == b[0] && a[2] == b[1]));
        assert_eq!(view.figure.table().len(), 20_001);
    }
}
