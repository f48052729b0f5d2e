//! Whom the best descends from: its line over the cloud of all the others, to click and replay.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::fitness::what;
use super::view::{Hit, Target, View};
use crate::evolve::{Parents, Place, Settings};
use crate::plot::{Axis, Chart, Figure, Role, Series, Shape};
use crate::run::{Ancestor, Descent, Spread};
use crate::studio::casting::Pick;
use crate::studio::panels::axes::around;

/// More points of all the others would take too long to draw.
const MOST_OTHERS: usize = 3000;
/// Of so many of the latest in the line the second parent is joined to its child; more would hide the line.
const MOST_BRANCHES: usize = 150;
/// Of every generation at least so many are drawn.
const FEWEST_OF_GENERATION: usize = 3;

/// The chart of a line of descent.
pub(super) fn view(settings: &Settings, descent: &Descent) -> View {
    let unit = settings.trial.fitness.unit();
    let place = |ancestor: &Ancestor| {
        let fitness = f64::from(ancestor.fitness?);
        Some([f64::from(ancestor.place.generation), fitness])
    };
    let line: Vec<[f64; 2]> = descent.line.iter().rev().filter_map(|of| place(of)).collect();
    let seconds: Vec<[f64; 2]> = descent.others.iter().filter_map(|of| place(of)).collect();
    let mut series = vec![
        Series::new("everybody else", Role::Others, Shape::Points(others(descent))),
        Series::new("second parents", Role::Second, Shape::Points(seconds)),
        Series::new("the best and its ancestors", Role::First, Shape::Line(line.clone())),
    ];
    // What is not there needs no place in the legend.
    series.retain(|series| match &series.shape {
        Shape::Points(points) | Shape::Line(points) => !points.is_empty(),
        _ => true,
    });
    if line.len() > 1 {
        // Where it branches.
        let others: BTreeMap<Place, &Arc<Ancestor>> =
            descent.others.iter().map(|other| (other.place, other)).collect();
        let branches = descent.line.iter().take(MOST_BRANCHES).filter_map(|child| {
            let parent = others.get(&child.parents.places().nth(1)?)?;
            Some(Shape::Dashed(vec![place(parent)?, place(child)?]))
        });
        let branches = branches.map(|branch| Series::new("", Role::Second, branch));
        let before_line = series.len() - 1;
        series.splice(before_line..before_line, branches);
    }
    let last = descent.spreads.last().map_or(1, |spread| spread.generation).max(2);
    let values = series.iter().flat_map(|series| match &series.shape {
        Shape::Points(points) | Shape::Line(points) | Shape::Dashed(points) => points.as_slice(),
        _ => &[],
    });
    let aside = f64::from(last - 1) * 0.04;
    let chart = Chart {
        name: String::new(),
        x: Axis::new("Generation", "", 1.0 - aside..=f64::from(last) + aside),
        y: Axis::new(
            what(settings.trial.fitness),
            unit.trim(),
            around(values.map(|value| value[1]), 1.0).unwrap_or(0.0..=1.0),
        ),
        series,
        marks: Vec::new(),
    };
    let hit = |ancestor: &Ancestor| {
        let at = ancestor.place;
        let fitness = ancestor.fitness?;
        let parents = ancestor.parents;
        let words = move || {
            format!(
                "Generation {}, snake {}\nfitness {fitness:.2}{unit}\n{}",
                at.generation,
                at.individual + 1,
                origin(parents)
            )
        };
        let target = Target::Point(place(ancestor)?);
        Some(Hit::of(target, words, Pick::Individual(at), at))
    };
    let hits = descent.line.iter().chain(&descent.others).filter_map(|of| hit(of)).collect();
    let note = about(descent);
    View::new(Figure { note, ..Figure::of("Ancestors of the best", chart) }, vec![hits])
}

/// Some of everybody's fitness, so many that they can be drawn.
fn others(descent: &Descent) -> Vec<[f64; 2]> {
    let generations = descent.spreads.len().max(1);
    let each = (MOST_OTHERS / generations).max(FEWEST_OF_GENERATION);
    let of = |spread: &Arc<Spread>| {
        let generation = f64::from(spread.generation);
        let count = spread.fitness.len();
        let chosen = count.min(each);
        let index = move |number: usize| number * (count - 1) / (chosen - 1).max(1);
        let points = (0..chosen).map(|number| f64::from(spread.fitness[index(number)]));
        points.map(|fitness| [generation, fitness]).collect::<Vec<_>>()
    };
    descent.spreads.iter().flat_map(of).collect()
}

/// Whom somebody comes from, in words.
fn origin(parents: Parents) -> String {
    let name =
        |place: Place| format!("snake {} of generation {}", place.individual + 1, place.generation);
    match parents {
        Parents::Newborn => "Drawn from nothing".to_owned(),
        Parents::One(parent) => format!("Child of {}", name(parent)),
        Parents::Two(first, second) => format!("Child of {}\nand {}", name(first), name(second)),
        Parents::Distribution => "Drawn around what the search had learned".to_owned(),
        Parents::Unknown => "Its parents are not known".to_owned(),
    }
}

/// How the line begins.
fn about(descent: &Descent) -> String {
    let Some(first) = descent.line.last() else { return String::new() };
    let generation = first.place.generation;
    match first.parents {
        Parents::Newborn => {
            format!("The line begins in generation {generation}, with a snake drawn from nothing.")
        }
        Parents::Distribution => {
            "The search draws everybody around the mean of what it has learned of all before: \
                                  nobody has parents of its own."
                .to_owned()
        }
        Parents::One(_) | Parents::Two(..) | Parents::Unknown => {
            format!("Who came before generation {generation} was not written down.")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::{RunPlan, StrategyKind};
    use crate::run::{Control, Experiment, pool};

    /// What three generations of a strategy show.
    fn shown(strategy: StrategyKind) -> (View, u32) {
        let mut settings = Settings::default();
        settings.evolution.strategy = strategy;
        settings.evolution.population = 8;
        settings.trial.duration_s = 0.5;
        let mut experiment = Experiment::new(RunPlan::new("test", 1, settings.clone()));
        let pool = pool(1).expect("a pool");
        for _ in 0..3 {
            experiment.run_generation(&pool, &Control::default()).expect("not cancelled");
        }
        let generation = experiment.best().expect("somebody was healthy").origin.generation;
        (view(&settings, &experiment.descent()), generation)
    }

    #[test]
    fn every_ancestor_can_be_clicked_and_read() {
        let (view, generation) = shown(StrategyKind::Halving);
        let hits = &view.hits[0];
        assert_eq!(hits.len() as u32, generation, "one in each generation");
        let last = hits.last().expect("the first ancestor");
        assert!(last.words().contains("Drawn from nothing"), "{}", last.words());
        assert!(view.figure.note.contains("begins in generation 1"), "{}", view.figure.note);
        let place = last.place.expect("somebody");
        assert_eq!((place.generation, last.pick), (1, Some(Pick::Individual(place))));
        assert!(hits[..hits.len() - 1].iter().all(|hit| hit.words().contains("Child of")));
    }

    #[test]
    fn where_nobody_has_parents_it_says_why() {
        let (view, _) = shown(StrategyKind::CmaEs);
        assert_eq!(view.hits[0].len(), 1, "the best alone");
        assert!(view.figure.note.contains("nobody has parents"), "{}", view.figure.note);
    }
}
