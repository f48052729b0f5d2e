//! Which values the parents of the next generation have: a line for each parent over all that can differ, each value
//! at its place between the least and the greatest that it may have.

use super::view::{Hit, Target, View};
use crate::evolve::Settings;
use crate::plot::{Axis, Chart, Figure, Role, Series, Shape};
use crate::run::Ancestor;
use crate::studio::casting::Pick;
use crate::studio::panels::axes::number;
use std::sync::Arc;

/// More lines nobody could tell apart.
const MOST_PARENTS: usize = 40;
/// The brightest colours of the ramp are too light for a line on a light panel.
const BRIGHTEST: f32 = 0.85;

/// The chart of the parents, each with how many children it will have. None, if nobody's genes are known.
pub(super) fn view(settings: &Settings, parents: &[(Arc<Ancestor>, u32)]) -> Option<View> {
    let unit = settings.trial.fitness.unit();
    let mut known: Vec<_> = parents
        .iter()
        .filter_map(|(parent, children)| Some((parent, parent.genome.as_ref()?, *children)))
        .collect();
    // The best are drawn over the others, and are those that are left if there are too many.
    let fitness = |parent: &Ancestor| parent.fitness.unwrap_or(f32::MIN);
    known.sort_by(|a, b| fitness(a.0).total_cmp(&fitness(b.0)));
    let surplus = known.len().saturating_sub(MOST_PARENTS);
    let known = &known[surplus..];
    let healthy = || known.iter().filter_map(|(parent, ..)| parent.fitness);
    let (least, most) = (healthy().fold(f32::MAX, f32::min), healthy().fold(f32::MIN, f32::max));
    let mut names = Vec::new();
    let mut series = Vec::new();
    let mut hits = Vec::new();
    let mut values: Vec<Vec<f32>> = Vec::new();
    for (parent, genome, children) in known {
        let features = settings.genome.features(genome);
        let at = parent.place;
        let name = format!("generation {}, snake {}", at.generation, at.individual + 1);
        let reached = match parent.fitness {
            Some(fitness) => format!("fitness {fitness:.2}{unit}"),
            None => "disqualified".to_owned(),
        };
        let place = (0..features.len()).map(|index| index as f64);
        let points: Vec<[f64; 2]> =
            place.zip(&features).map(|(x, feature)| [x, feature.share]).collect();
        for (point, feature) in points.iter().zip(&features) {
            let space = if feature.unit.is_empty() { "" } else { " " };
            let words = format!(
                "{}: {}{space}{}\nGeneration {}, snake {}: {reached}\n{children} of the next generation come from it",
                feature.name,
                number(f64::from(feature.value)),
                feature.unit,
                at.generation,
                at.individual + 1,
            );
            let target = Target::Point(*point);
            hits.push(Hit::of(target, move || words.clone(), Pick::Individual(at), at));
        }
        values.push(features.iter().map(|feature| feature.value).collect());
        if names.is_empty() {
            let name = |feature: &crate::genome::Feature| match feature.unit {
                "" => feature.name.clone(),
                unit => format!("{} ({unit})", feature.name),
            };
            names = (0..).map(f64::from).zip(features.iter().map(name)).collect();
        }
        let share =
            parent.fitness.map_or(0.0, |of| (of - least) / (most - least).max(f32::MIN_POSITIVE));
        let role = Role::Share(share.clamp(0.0, 1.0) * BRIGHTEST);
        series.push(Series::new(&format!("{name}, {reached}"), role, Shape::Line(points)));
    }
    if names.is_empty() {
        return None;
    }
    let last = (names.len() - 1) as f64;
    let aside = (last * 0.03).max(0.3);
    let x = Axis { names, ..Axis::new("Value", "", -aside..=last + aside) };
    let y = Axis::new("Place in its range, 0 least and 1 greatest", "", -0.05..=1.05);
    let chart = Chart { name: String::new(), x, y, series, marks: Vec::new() };
    let left_out = match surplus {
        0 => String::new(),
        _ => format!(" The best {MOST_PARENTS} of {} are shown.", surplus + known.len()),
    };
    let note = if least < most {
        format!(
            "A line is a parent; the brighter, the fitter: from {least:.2} to {most:.2}{unit}.{left_out}"
        )
    } else {
        format!("A line is a parent.{left_out}")
    };
    // Whoever takes the numbers away wants the values, not their places.
    let numbers = Some(columns(&chart, &values));
    let figure = Figure { note, numbers, ..Figure::of("The parents' values", chart) };
    Some(View::new(figure, vec![hits]))
}

/// A row for each value with its unit, a column for each parent.
fn columns(chart: &Chart, values: &[Vec<f32>]) -> Vec<Vec<String>> {
    let parents = chart.series.iter().map(|series| series.name.clone());
    let head = [chart.x.name.clone()].into_iter().chain(parents).collect();
    let row = |(index, (_, name)): (usize, &(f64, String))| {
        let of_parents =
            values.iter().map(|of| of.get(index).map_or(String::new(), f32::to_string));
        [name.clone()].into_iter().chain(of_parents).collect()
    };
    [head].into_iter().chain(chart.x.names.iter().enumerate().map(row)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::{RunPlan, StrategyKind};
    use crate::genome::ControllerKind;
    use crate::run::{Control, Experiment, pool};

    #[test]
    fn every_value_of_every_parent_can_be_read_and_its_parent_replayed() {
        let mut settings = Settings::default();
        settings.evolution.strategy = StrategyKind::Ga;
        settings.evolution.population = 10;
        settings.genome.controller = ControllerKind::Gait;
        settings.trial.duration_s = 0.5;
        let mut experiment = Experiment::new(RunPlan::new("test", 1, settings.clone()));
        let pool = pool(1).expect("a pool");
        experiment.run_generation(&pool, &Control::default()).expect("not cancelled");
        let parents = experiment.parents();
        let view = view(&settings, &parents).expect("their genes are known");
        let dimension = settings.genome.dimension(settings.trial.descent());
        assert_eq!(view.hits[0].len(), parents.len() * dimension);
        let frequency = view.hits[0].iter().find(|hit| hit.words().starts_with("frequency: "));
        assert!(frequency.expect("a gene").words().contains(" Hz\nGeneration 1, snake "));
        let table = view.figure.table();
        assert_eq!((table.len(), table[0].len()), (1 + dimension, 1 + parents.len()));
        assert_eq!(table[3][0], "density (kg/m³)");
        let best = parents.iter().max_by(|(a, _), (b, _)| {
            let fitness = |of: &Ancestor| of.fitness.unwrap_or(f32::MIN);
            fitness(a).total_cmp(&fitness(b))
        });
        let genome = best.expect("somebody").0.genome.as_ref().expect("known");
        assert_eq!(table[3].last(), Some(&genome.density_kg_m3.to_string()), "the value itself");
        let nobody: Vec<_> = parents
            .iter()
            .map(|(parent, children)| {
                (Arc::new(Ancestor { genome: None, ..(**parent).clone() }), *children)
            })
            .collect();
        assert!(super::view(&settings, &nobody).is_none());
    }
}
