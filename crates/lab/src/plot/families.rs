//! The exam of all families as a chart: a group of bars for each family, a bar for each suite.

use super::{Axis, Chart, Figure, PlotError, Role, Series, Shape};
use crate::run::Quartiles;
use crate::run::families::{FamilyResults, Results};
use snakes_core::save::Picture;
use snakes_core::schema::Choices;
use snakes_core::score::ExamSuite;

/// Share of the space of a group that its bars take.
const GROUP: f64 = 0.8;

/// Plots the landings of each family in each suite of the exam.
///
/// # Errors
/// The plotting library failed.
pub fn families(results: &Results, suites: &[ExamSuite]) -> Result<Picture, PlotError> {
    super::figure(&exam_figure(results, suites))
}

fn exam_figure(results: &Results, suites: &[ExamSuite]) -> Figure {
    let examined: Vec<&FamilyResults> =
        results.0.iter().filter(|family| !family.examined.is_empty()).collect();
    let width = GROUP / suites.len().max(1) as f64;
    let series = suites.iter().enumerate().map(|(place, suite)| {
        let left = (width - GROUP) / 2.0 + width * place as f64;
        let bar = |(group, family): (usize, &&FamilyResults)| {
            let landings = family.landings(*suite).into_iter().map(|(_, landed)| landed);
            Some([group as f64 + left, Quartiles::of(landings)?.median])
        };
        let bars = examined.iter().enumerate().filter_map(bar).collect();
        // A gap between neighbours keeps them apart without their colours.
        let shape = Shape::Bars { width: width * 0.88, bars };
        Series::new(suite.choice().title, role(*suite), shape)
    });
    let mut x = Axis::new("Family", "", -0.6..=examined.len().max(1) as f64 - 0.4);
    let titles = examined.iter().map(|of| of.family.choice().title.to_owned());
    x.names = (0..).map(f64::from).zip(titles).collect();
    let chart = Chart {
        name: String::new(),
        x,
        y: Axis::new("Trials that end on the landing", "%", 0.0..=100.0),
        series: series.collect(),
        marks: Vec::new(),
    };
    let note = "Mixed stairs: median of the champions of all seeds; otherwise the best champion of all seeds. Without a bar: no \
                landing, or no senses to freeze.";
    Figure { note: note.to_owned(), ..Figure::of("Families in the exam", chart) }
}

fn role(suite: ExamSuite) -> Role {
    match suite {
        ExamSuite::Stairs => Role::First,
        ExamSuite::Surprise => Role::Third,
        ExamSuite::Shove => Role::Second,
        ExamSuite::Lesion => Role::Others,
        ExamSuite::StepRate => Role::Share(0.0),
        ExamSuite::Trials => Role::Share(0.8),
        ExamSuite::HeldOut => Role::Share(0.4),
        ExamSuite::Engine => Role::Share(0.6),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::families::fixtures::{examined, family, results};
    use crate::run::families::{DEFAULT_SUITES, Family};

    #[test]
    fn each_family_has_a_group_with_a_bar_for_each_of_its_suites() {
        let champion: Vec<(ExamSuite, u32)> =
            DEFAULT_SUITES.iter().copied().zip([50, 40, 30, 20, 10]).collect();
        let all: Vec<FamilyResults> = Family::OPTIONS
            .iter()
            .map(|of| {
                let suites = if *of == Family::Gait { &champion[..4] } else { &champion[..] };
                examined(*of, &[suites, suites])
            })
            .collect();
        let mut all = results(&all.iter().collect::<Vec<_>>());
        all.0.push(family(Family::Gait, &[3]));
        let figure = exam_figure(&all, &DEFAULT_SUITES);
        let chart = &figure.charts[0];
        assert_eq!(chart.x.names.len(), Family::OPTIONS.len(), "the last was not examined");
        let bars = |series: &Series| match &series.shape {
            Shape::Bars { bars, .. } => bars.clone(),
            _ => panic!("bars"),
        };
        let counts: Vec<usize> = chart.series.iter().map(|series| bars(series).len()).collect();
        let count = Family::OPTIONS.len();
        assert_eq!(
            counts,
            [count, count, count, count, count - 1],
            "a gait has no senses to freeze"
        );
        let heights: Vec<f64> = chart.series.iter().map(|series| bars(series)[0][1]).collect();
        assert_eq!(heights, [100.0, 80.0, 60.0, 40.0, 20.0]);
        let picture = families(&all, &DEFAULT_SUITES).expect("drawn");
        for series in &chart.series {
            let color = crate::plot::role_color(series.role);
            let pixels = picture.rgb.as_chunks::<3>().0.iter().filter(|pixel| **pixel == color);
            assert!(pixels.count() > 1000, "{}", series.name);
        }
    }
}
