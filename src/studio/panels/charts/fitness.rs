//! Chart of the fitness by generation: best, mean, median and the middle 50 %.

use super::view::{ChartHit, ChartView, HitShape};
use crate::studio::commands::pick::Pick;
use snakes_core::evolve::{GenerationRecord, IndividualId, Settings, Statistics};
use snakes_core::schema::Choices;
use snakes_core::score::Fitness;
use snakes_lab::plot::{Axis, Chart, Figure, Mark, Role, Series, Shape, extent};
use snakes_lab::run::GenerationReport;

/// Minimum end of the axis of generations: the six generations of the report's experiment.
const MIN_GENERATIONS: f64 = 6.0;
/// Maximum distance below the landing at which the landing is marked, in metres.
const LANDING_SHOWN_BELOW_M: f64 = 6.0;
/// Space above the highest value, as a share of the range of values.
const HEADROOM: f64 = 0.12;

/// Creates the fitness chart of the finished generations.
pub(super) fn view(settings: &Settings, reports: &[GenerationReport]) -> ChartView {
    let unit = settings.trial.fitness.unit();
    let known: Vec<(f64, &Statistics)> = reports
        .iter()
        .filter_map(|report| Some((f64::from(report.generation), report.statistics.as_ref()?)))
        .collect();
    let along = |value: fn(&Statistics) -> f64| -> Vec<[f64; 2]> {
        known.iter().map(|(generation, statistics)| [*generation, value(statistics)]).collect()
    };
    let band = known.iter().filter_map(|(generation, statistics)| {
        let (low, high) = statistics.quartiles()?;
        Some([*generation, low, high])
    });
    let band: Vec<[f64; 3]> = band.collect();
    let series = vec![
        Series::new("middle 50 %", Role::Third, Shape::Band(band)),
        Series::new("mean", Role::Second, Shape::Line(along(|statistics| statistics.mean))),
        Series::new("median", Role::Third, Shape::Dashed(along(|statistics| statistics.median))),
        Series::new("best", Role::First, Shape::Line(along(|statistics| statistics.best))),
    ];
    let ends = known.iter().flat_map(|(_, statistics)| {
        let low = statistics.quartiles().map_or(statistics.mean, |(low, _)| low);
        [statistics.best, statistics.mean, statistics.median, low]
    });
    let chart = Chart { series, ..frame(settings, reports.len(), ends) };
    let hits = reports.iter().filter_map(|report| hit(report, unit)).collect();
    ChartView::new(Figure::of("Fitness by generation", chart), vec![hits])
}

/// Returns the hover text and the click target of a generation.
fn hit(report: &GenerationReport, unit: &'static str) -> Option<ChartHit> {
    let statistics = report.statistics?;
    let Statistics { mean, best, median, std, worst, .. } = statistics;
    let GenerationRecord { generation, disqualified, evaluations, .. } = report.record;
    let words = move || {
        let quarters = statistics.quartiles().map_or(String::new(), |(low, high)| {
            format!("middle 50 % {low:.2} to {high:.2}{unit}\n")
        });
        format!(
            "Generation {generation}\nbest {best:.2}{unit}\n{quarters}median {median:.2}{unit}\n\
             mean {mean:.2}{unit}, std.dev. {std:.2}{unit}\nworst {worst:.2}{unit}\n\
             {disqualified} of {evaluations} disqualified"
        )
    };
    let target = HitShape::Column([f64::from(report.generation), best]);
    let Some(champion) = &report.champion else { return Some(ChartHit::new(target, words)) };
    let place = IndividualId { generation, individual: champion.origin.individual };
    Some(ChartHit::of(target, words, Pick::Generation(generation), place))
}

/// Returns the axis of generations up to the last one, which is at least the second.
pub(super) fn generation_axis(last: f64) -> Axis {
    let aside = (last - 1.0) * 0.04;
    Axis::count("Generation", 1.0 - aside..=last + aside)
}

/// Returns the axis of this number of finished generations. It is long enough for a short run.
pub(super) fn axis_of_finished(generations: usize) -> Axis {
    generation_axis((generations as f64).max(MIN_GENERATIONS))
}

/// Returns the axis around these values of fitness.
pub(super) fn fitness_axis(fitness: Fitness, values: impl IntoIterator<Item = f64>) -> Axis {
    Axis::around(fitness.choice().title, fitness.unit().trim(), values, 1.0)
}

/// Creates the fitness chart without its series: the axes, and marks at positions on the stairs.
fn frame(settings: &Settings, finished: usize, values: impl Iterator<Item = f64>) -> Chart {
    let trial = &settings.trial;
    let [mut min, mut max] = extent(values).unwrap_or([f64::MAX, f64::MIN]);
    let mut marks = Vec::new();
    // Only a distance can be compared to positions on the stairs.
    if trial.fitness.is_along_y() {
        let landing_m = f64::from(trial.stairs.landing_y_m());
        let is_near = max > landing_m - LANDING_SHOWN_BELOW_M && trial.stairs.steps > 0;
        min = min.min(f64::from(trial.start_y_m));
        let first_riser_m = f64::from(trial.stairs.first_riser_y_m);
        let landing = is_near.then_some(("landing", landing_m));
        for (name, y) in [("first step", first_riser_m)].into_iter().chain(landing) {
            marks.push(Mark { name: name.to_owned(), y });
            max = max.max(y);
        }
    } else if min > max {
        (min, max) = (0.0, 1.0);
    }
    let margin = ((max - min) * 0.06).max(0.5);
    // Otherwise the line of a best snake at the top of the stairs would coincide with the frame.
    let headroom = ((max - min) * HEADROOM).max(1.0);
    let unit = trial.fitness.unit().trim();
    let y = Axis::new(trial.fitness.choice().title, unit, min - margin..=max + headroom);
    Chart { marks, ..Chart::new(axis_of_finished(finished), y, Vec::new()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::testing::report_of;

    #[test]
    fn the_axes_cover_all_generations_and_the_landing_once_it_is_near() {
        let settings = Settings::default();
        let of = |finished, values: &[f64]| {
            let chart = frame(&settings, finished, values.iter().copied());
            let marks: Vec<(String, f64)> =
                chart.marks.into_iter().map(|mark| (mark.name, mark.y)).collect();
            (chart.x.range, chart.y.range, marks)
        };
        let (first_step, landing) = (("first step".to_owned(), 3.0), ("landing".to_owned(), 21.0));
        let (x, y, marks) = of(0, &[]);
        assert!(*x.end() > 6.0 && *x.end() < 7.0);
        assert_eq!(marks, std::slice::from_ref(&first_step));
        assert!(y.contains(&-7.2) && y.contains(&3.0));
        let (x, y, marks) = of(120, &[-7.0, 12.0, 29.0]);
        assert!(x.contains(&120.0) && y.contains(&29.0));
        assert_eq!(marks, [first_step, landing]);
        assert_eq!(of(20, &[10.0]).2.len(), 1, "far below the landing");
        let height = y.end() - y.start();
        assert!(y.end() - 29.0 > height * 0.09, "the best line keeps off the frame: {y:?}");
    }

    #[test]
    fn a_generation_has_a_full_hover_text_and_replays_its_champion() {
        let settings = Settings::default();
        let report = report_of(1);
        let view = view(&settings, std::slice::from_ref(&report));
        let [hit] = &view.hits[0][..] else { panic!("one generation") };
        assert_eq!(hit.pick, Some(Pick::Generation(1)));
        for word in ["Generation 1", "best", "middle 50 %", "median", "mean", "worst"] {
            assert!(hit.words().contains(word), "{word} in {}", hit.words());
        }
        let head = view.figure.table()[0].join(";");
        let expected = "Generation;middle 50 %, lower end (m);middle 50 %, upper end (m);mean (m);\
                        median (m);best (m)";
        assert_eq!(head, expected);
        // Logs of earlier versions have no quartiles.
        let mut old = report;
        if let Some(statistics) = &mut old.record.statistics {
            (statistics.lower_quartile, statistics.upper_quartile) = (None, None);
        }
        let view = super::view(&settings, &[old]);
        assert!(!view.hits[0][0].words().contains("middle 50 %"));
    }
}
