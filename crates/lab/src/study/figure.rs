//! The results of a study as a figure: learning curves, means by generation, and the values of all runs.

use super::definition::{Arm, Demand};
use super::measure::Measure;
use super::results::Results;
use super::values::{Form, ValueInfo, value, values};
use crate::plot::{Axis, Chart, Figure, Mark, Role, Series, Shape, extent};
use crate::statistics::Quartiles;
use snakes_core::genome::ControllerKind;
use snakes_core::save::{CURVE_POINTS, Protocol, StudiedArm, StudiedRun};

/// Maximum number of charts with the values of runs.
const MOST_CHARTS: usize = 6;
/// Maximum number of arms whose names leave space for `MOST_CHARTS` charts.
const MOST_ARMS: usize = 8;
/// Maximum number of charts with the values of runs, if there are more arms.
const FEWER_CHARTS: usize = 4;

/// Makes the figure of a study. A study of methods shows learning curves, a chart for each controller. Other studies show means by
/// generation if these are among their values, otherwise the values of all runs.
pub(super) fn study_figure(results: &Results<'_>) -> Figure {
    let study = results.study;
    let generations = generation_charts(results);
    let (note, charts) = if study.methods.is_some() {
        let runs = results.runs;
        let charts: Vec<Chart> =
            controllers(&runs.arms).into_iter().map(|kind| curves(&runs.arms, kind)).collect();
        ("Lines: median over the seeds. Bands: their middle half.", charts)
    } else if !generations.is_empty() {
        ("Thin lines: each seed. Thick line: their mean.", generations)
    } else {
        ("Each point is a run.", value_charts(results))
    };
    Figure::of_several(&study.title, charts).with_note(note)
}

/// Returns the controllers of some arms, in their usual order.
pub fn controllers(arms: &[StudiedArm]) -> Vec<ControllerKind> {
    let is_used = |kind: &ControllerKind| arms.iter().any(|arm| arm.protocol.controller == *kind);
    ControllerKind::ALL.iter().copied().filter(is_used).collect()
}

/// Returns the learning curve of an arm: the quartiles of the best fitness so far at each hundredth of the budget. Points at which
/// a run has no best fitness yet are left out.
pub fn curve(runs: &[StudiedRun]) -> Vec<(usize, Quartiles)> {
    let at = |point: usize| {
        let values: Option<Vec<f64>> =
            runs.iter().map(|run| Some(f64::from((*run.curve.get(point)?)?))).collect();
        Some((point, Quartiles::of(values?)?))
    };
    (0..CURVE_POINTS).filter_map(at).collect()
}

/// Makes a chart of the learning curves of the arms with a controller, each in the colour of its strategy.
pub fn curves(arms: &[StudiedArm], controller: ControllerKind) -> Chart {
    let of_controller = arms.iter().filter(|arm| arm.protocol.controller == controller);
    let of_controller: Vec<&StudiedArm> = of_controller.collect();
    let x_of = |protocol: &Protocol, point: usize| {
        protocol.budget as f64 * (point + 1) as f64 / CURVE_POINTS as f64
    };
    let mut series = Vec::new();
    for arm in &of_controller {
        let curve = curve(&arm.runs);
        let (role, name) = (Role::Strategy(arm.protocol.strategy), short_title(&arm.protocol));
        let band = curve.iter().map(|(point, of)| [x_of(&arm.protocol, *point), of.low, of.high]);
        let median = curve.iter().map(|(point, of)| [x_of(&arm.protocol, *point), of.median]);
        series.push(Series::new(
            &format!("{name}, middle 50 %"),
            role,
            Shape::Band(band.collect()),
        ));
        series.push(Series::new(name, role, Shape::Line(median.collect())));
    }
    // Lines are drawn over all bands.
    series.sort_by_key(|series| matches!(series.shape, Shape::Line(_)));
    let ends = series.iter().flat_map(|series| match &series.shape {
        Shape::Band(ends) => ends.iter().flat_map(|[_, low, high]| [*low, *high]).collect(),
        _ => Vec::new(),
    });
    let y = range(ends);
    let budget = of_controller.iter().map(|arm| arm.protocol.budget).max().unwrap_or(1);
    let unit = of_controller.first().map_or("", |arm| arm.protocol.fitness.unit().trim());
    let x = Axis::count("Evaluations", 0.0..=budget as f64);
    Chart::new(x, Axis::new("Best fitness so far", unit, y), series).named(controller.name())
}

/// Returns the title of a strategy without its explanation in parentheses.
pub fn short_title(protocol: &Protocol) -> &'static str {
    protocol.strategy.title().split(" (").next().unwrap_or_default()
}

/// Returns the range of some values, with a margin.
fn range(values: impl Iterator<Item = f64>) -> std::ops::RangeInclusive<f64> {
    let Some([least, most]) = extent(values) else { return 0.0..=1.0 };
    let margin = ((most - least) * 0.06).max(1e-3 * least.abs().max(most.abs())).max(1e-9);
    least - margin..=most + margin
}

/// Makes a chart for each shown list of numbers by generation: the lists of all runs, their mean, and the published numbers.
fn generation_charts(results: &Results<'_>) -> Vec<Chart> {
    let study = results.study;
    let shown = study.shown();
    let is_shown =
        |info: &&ValueInfo| info.name.starts_with("generation_means") && shown.contains(&info.name);
    let chart = |info: &ValueInfo| {
        let mut series = Vec::new();
        for arm in study.selected_arms() {
            let runs = results.of(arm);
            let line = |numbers: &[Option<f64>]| -> Vec<[f64; 2]> {
                let points = (1..).map(f64::from).zip(numbers);
                points.filter_map(|(x, y)| Some([x, (*y)?])).collect()
            };
            let length = runs.iter().map(|run| run.numbers(&info.name).len()).max().unwrap_or(0);
            let mean = |index: usize| {
                let numbers: Vec<f64> =
                    runs.iter().filter_map(|run| *run.numbers(&info.name).get(index)?).collect();
                (!numbers.is_empty()).then(|| numbers.iter().sum::<f64>() / numbers.len() as f64)
            };
            let means: Vec<Option<f64>> = (0..length).map(mean).collect();
            let each = runs.iter().map(|run| {
                Series::new("", Role::Others, Shape::Line(line(run.numbers(&info.name))))
            });
            series.extend(each);
            let name = format!("{}, mean of {} seeds", arm.title(), runs.len());
            series.push(Series::new(&name, Role::First, Shape::Line(line(&means))));
        }
        if let Some(published) = study.references.get(&info.name) {
            let points = (1..).map(f64::from).zip(published).map(|(x, y)| [x, *y]).collect();
            series.push(Series::new("published", Role::Second, Shape::Line(points)));
        }
        let all = || series.iter().flat_map(|series| series.shape.points());
        let (last, y) = (all().map(|[x, _]| *x).fold(1.0, f64::max), range(all().map(|[_, y]| *y)));
        let x = Axis::count("Generation", 0.7..=last + 0.3);
        // Published means are a fitness in metres, which other fitnesses need not be.
        let unit = if study.references.contains_key(&info.name) { "m" } else { info.unit };
        Chart::new(x, Axis::new(&info.title, unit, y), series)
    };
    values().iter().filter(is_shown).map(chart).collect()
}

/// Makes a chart for each shown number: the values of all runs, arm by arm.
fn value_charts(results: &Results<'_>) -> Vec<Chart> {
    let study = results.study;
    // Numbers that the study names in `show` come first, in its order.
    let mut shown = study.show.clone();
    shown.extend(study.shown().into_iter().filter(|name| !study.show.contains(name)));
    let infos = shown.iter().filter_map(|name| value("show", name).ok());
    let infos = infos.filter(|info| {
        matches!(info.form, Form::Number | Form::Until)
            && !["evaluations", "simulations"].contains(&info.name.as_str())
    });
    let arms: Vec<&Arm> = study.selected_arms().collect();
    let infos = infos.take(if arms.len() > MOST_ARMS { FEWER_CHARTS } else { MOST_CHARTS });
    infos.map(|info| value_chart(results, &arms, info)).collect()
}

fn value_chart(results: &Results<'_>, arms: &[&Arm], info: &ValueInfo) -> Chart {
    let (mut points, mut bands, mut medians) = (Vec::new(), Vec::new(), Vec::new());
    for (place, arm) in (0..).map(f64::from).zip(arms) {
        let numbers = results.values(arm, info);
        // Equal values are drawn beside each other.
        for (index, number) in numbers.iter().enumerate().filter(|(_, number)| number.is_finite()) {
            let is_equal = |other: &&f64| (*other - number).abs() < 1e-9;
            let equal = numbers[..index].iter().filter(is_equal).count();
            let side = if equal % 2 == 0 { -1.0 } else { 1.0 };
            points.push([place + side * 0.04 * equal.div_ceil(2) as f64, *number]);
        }
        if let Some(Quartiles { low, median, high }) = Quartiles::of(numbers)
            && median.is_finite()
        {
            let top = if high.is_finite() { high } else { median };
            bands.push([place - 0.3, place + 0.3].map(|x| [x, low, top]));
            medians.push((place, median));
        }
    }
    let y = range(points.iter().map(|[_, y]| *y));
    let median = |(place, y): (f64, f64)| {
        let ends = [place - 0.3, place + 0.3].map(|x| [x, y]);
        Series::new("median", Role::Second, Shape::Dashed(ends.to_vec()))
    };
    let band = |ends: [[f64; 3]; 2]| {
        Series::new("middle half of the runs", Role::First, Shape::Band(ends.to_vec()))
    };
    let mut series: Vec<Series> = bands.into_iter().map(band).collect();
    series.push(Series::new("runs", Role::First, Shape::Points(points)));
    series.extend(medians.into_iter().map(median));
    let mut x = Axis::new("Arm", "", -0.6..=arms.len().max(1) as f64 - 0.4);
    x.names = (0..).map(f64::from).zip(arms.iter().map(|arm| arm.name.clone())).collect();
    let demands = results.study.demands_by_arm();
    let is_about = |demand: &Demand| matches!(&demand.measure, Measure::Median { of, less: None } if *of == info.name);
    let mut marks: Vec<Mark> = Vec::new();
    for y in
        demands.iter().filter(|(_, demand)| is_about(demand)).filter_map(|(_, demand)| demand.must)
    {
        if !marks.iter().any(|mark| (mark.y - y).abs() < 1e-9) {
            marks.push(Mark { name: format!("must: {y}"), y });
        }
    }
    let y_ends = marks.iter().map(|mark| mark.y).chain([*y.start(), *y.end()]);
    let (least, most) = y_ends.fold((f64::MAX, f64::MIN), |(a, b), y| (a.min(y), b.max(y)));
    let y = Axis::new(&info.title, info.unit, least..=most);
    Chart { marks, ..Chart::new(x, y, series).named(&info.title) }
}
