//! Fitness over the generations: the best, the middle, the mean, and between what the middle half lies.

use std::ops::RangeInclusive;

use super::view::{Hit, Target, View};
use crate::evolve::{Place, Settings};
use crate::plot::{Axis, Chart, Figure, Mark, Role, Series, Shape};
use crate::run::{GenerationReport, Statistics};
use crate::score::Fitness;
use crate::studio::casting::Pick;

/// The report's run has six generations: with fewer, the axis is as long as for these.
const FEWEST_GENERATIONS: f64 = 6.0;
/// From how far below the landing the best has it in sight, in metres.
const LANDING_IN_SIGHT_M: f64 = 6.0;

/// The chart of the finished generations.
pub(super) fn view(settings: &Settings, reports: &[GenerationReport]) -> View {
    let unit = settings.trial.fitness.unit();
    let known: Vec<(f64, &Statistics)> = reports
        .iter()
        .filter_map(|report| Some((f64::from(report.generation), report.statistics.as_ref()?)))
        .collect();
    let along = |value: fn(&Statistics) -> f64| -> Vec<[f64; 2]> {
        known.iter().map(|(generation, statistics)| [*generation, value(statistics)]).collect()
    };
    let band = known.iter().filter_map(|(generation, statistics)| {
        let (low, high) = statistics.quartiles?;
        Some([*generation, low, high])
    });
    let band: Vec<[f64; 3]> = band.collect();
    let series = vec![
        Series::new("middle half", Role::Third, Shape::Band(band)),
        Series::new("mean", Role::Second, Shape::Line(along(|statistics| statistics.mean))),
        Series::new("median", Role::Third, Shape::Dashed(along(|statistics| statistics.median))),
        Series::new("best", Role::First, Shape::Line(along(|statistics| statistics.best))),
    ];
    let ends = known.iter().flat_map(|(_, statistics)| {
        let low = statistics.quartiles.map_or(statistics.mean, |(low, _)| low);
        [statistics.best, statistics.mean, statistics.median, low]
    });
    let frame = Frame::new(settings, reports.len(), ends);
    let marks = frame.marks.iter();
    let chart = Chart {
        name: String::new(),
        x: Axis::new("Generation", "", frame.x),
        y: Axis::new(what(settings.trial.fitness), unit.trim(), frame.y),
        series,
        marks: marks.map(|(name, y)| Mark { name: (*name).to_owned(), y: *y }).collect(),
    };
    let hits = reports.iter().filter_map(|report| hit(report, unit)).collect();
    View::new(Figure::of("Fitness by generation", chart), vec![hits])
}

/// What there is to say of a generation.
fn hit(report: &GenerationReport, unit: &'static str) -> Option<Hit> {
    let Statistics { mean, best, median, std, worst, quartiles, .. } = report.statistics?;
    let GenerationReport { generation, disqualified, evaluations, .. } = *report;
    let words = move || {
        let quarters = quartiles.map_or(String::new(), |(low, high)| {
            format!("middle half {low:.2} to {high:.2}{unit}\n")
        });
        format!(
            "Generation {generation}\nbest {best:.2}{unit}\n{quarters}median {median:.2}{unit}\n\
             mean {mean:.2}{unit}, std.dev. {std:.2}{unit}\nworst {worst:.2}{unit}\n\
             {disqualified} of {evaluations} disqualified"
        )
    };
    let target = Target::Column([f64::from(report.generation), best]);
    let Some(champion) = &report.champion else { return Some(Hit::new(target, words)) };
    let (generation, individual) = (report.generation, champion.origin.individual);
    Some(Hit::of(target, words, Pick::Generation(generation), Place { generation, individual }))
}

/// What the chart reaches over.
#[derive(Debug, Clone, PartialEq)]
struct Frame {
    x: RangeInclusive<f64>,
    y: RangeInclusive<f64>,
    /// Places on the stairs, by name.
    marks: Vec<(&'static str, f64)>,
}

impl Frame {
    fn new(settings: &Settings, finished: usize, values: impl Iterator<Item = f64>) -> Self {
        let trial = &settings.trial;
        let (mut least, mut most) = (f64::MAX, f64::MIN);
        for value in values.filter(|value| value.is_finite()) {
            (least, most) = (least.min(value), most.max(value));
        }
        let mut marks = Vec::new();
        // A height or a number of steps has no place along the stairs.
        if trial.fitness.is_along_y() {
            let first_riser_m = f64::from(trial.stairs.first_riser_y_m);
            let landing_m = f64::from(trial.stairs.riser_y_m(trial.stairs.steps));
            marks.push(("the first step", first_riser_m));
            least = least.min(f64::from(trial.start_y_m));
            if most > landing_m - LANDING_IN_SIGHT_M && trial.stairs.steps > 0 {
                marks.push(("the landing", landing_m));
            }
            most = marks.iter().map(|(_, y_m)| *y_m).fold(most, f64::max);
        } else if least > most {
            (least, most) = (0.0, 1.0);
        }
        let margin = ((most - least) * 0.06).max(0.5);
        let last = (finished as f64).max(FEWEST_GENERATIONS);
        let aside = (last - 1.0) * 0.04;
        Self { x: 1.0 - aside..=last + aside, y: least - margin..=most + margin, marks }
    }
}

/// What is shown.
pub(super) fn what(fitness: Fitness) -> &'static str {
    match fitness {
        Fitness::Centre => "Centre's y",
        Fitness::Climb => "Place on the stairs",
        Fitness::Head => "Head's y",
        Fitness::CentreOfMass => "Centre of mass's y",
        Fitness::Height => "Height of the middle block",
        Fitness::FurthestY => "Furthest y",
        Fitness::StepsClimbed => "Steps climbed",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::RunPlan;
    use crate::run::{Control, Experiment, pool};

    #[test]
    fn it_reaches_over_all_generations_and_to_the_landing_once_that_is_in_sight() {
        let settings = Settings::default();
        let of = |finished, values: &[f64]| Frame::new(&settings, finished, values.iter().copied());
        let early = of(0, &[]);
        assert!(*early.x.end() > 6.0 && *early.x.end() < 7.0);
        assert_eq!(early.marks, [("the first step", 3.0)]);
        assert!(early.y.contains(&-7.2) && early.y.contains(&3.0));
        let late = of(120, &[-7.0, 12.0, 29.0]);
        assert!(late.x.contains(&120.0) && late.y.contains(&29.0));
        assert_eq!(late.marks, [("the first step", 3.0), ("the landing", 23.0)]);
        assert_eq!(of(20, &[10.0]).marks.len(), 1, "far below the landing");
    }

    #[test]
    fn a_generation_is_read_out_in_full_and_its_champion_is_to_be_replayed() {
        let mut settings = Settings::default();
        settings.evolution.population = 8;
        settings.trial.duration_s = 0.5;
        let mut experiment = Experiment::new(RunPlan::new("test", 1, settings.clone()));
        let pool = pool(1).expect("a pool");
        let report = experiment.run_generation(&pool, &Control::default()).expect("not cancelled");
        let view = view(&settings, std::slice::from_ref(&report));
        let [hit] = &view.hits[0][..] else { panic!("one generation") };
        assert_eq!(hit.pick, Some(Pick::Generation(1)));
        for word in ["Generation 1", "best", "middle half", "median", "mean", "worst"] {
            assert!(hit.words().contains(word), "{word} in {}", hit.words());
        }
        let head = view.figure.table()[0].join(";");
        let expected = "Generation;middle half, lower end (m);middle half, upper end (m);mean (m);\
                        median (m);best (m)";
        assert_eq!(head, expected);
        // Logs of earlier versions have no quartiles.
        let mut old = report;
        if let Some(statistics) = &mut old.statistics {
            statistics.quartiles = None;
        }
        let view = super::view(&settings, &[old]);
        assert!(!view.hits[0][0].words().contains("middle half"));
    }
}
