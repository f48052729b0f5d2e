//! Chart of the best snake's ancestors, over all other snakes of the run. A click replays an ancestor.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::fitness::{fitness_axis, generation_axis};
use super::view::{ChartHit, ChartView, HitShape, generation_and_snake, snake_of_generation};
use crate::studio::commands::pick::Pick;
use snakes_core::evolve::{IndividualId, Parents, Settings};
use snakes_lab::plot::{Chart, Figure, Role, Series, Shape};
use snakes_lab::run::{Ancestor, Ancestry, FitnessSpread};

/// Maximum number of other snakes that are drawn, because drawing takes time.
const MAX_OTHERS: usize = 3000;
/// Number of latest ancestors for which the second parent is also connected to the child. More connections would hide the main line.
const MAX_BRANCHES: usize = 150;
/// Minimum number of snakes that are drawn per generation.
const MIN_PER_GENERATION: usize = 3;

/// Creates the chart of a line of ancestry.
/// `founder` is the name of the snake from which the run started, if any.
pub(super) fn view(settings: &Settings, ancestry: &Ancestry, founder: Option<&str>) -> ChartView {
    let unit = settings.trial.fitness.unit();
    let place = |ancestor: &Ancestor| {
        let fitness = f64::from(ancestor.fitness?);
        Some([f64::from(ancestor.place.generation), fitness])
    };
    let line: Vec<[f64; 2]> = ancestry.line.iter().rev().filter_map(|of| place(of)).collect();
    let seconds: Vec<[f64; 2]> = ancestry.others.iter().filter_map(|of| place(of)).collect();
    let mut series = vec![
        Series::new("all other snakes", Role::Others, Shape::Points(others(ancestry))),
        Series::new("second parents", Role::Second, Shape::Points(seconds)),
        best(ancestry, line.clone()),
    ];
    // Empty series would need an entry in the legend.
    series.retain(|series| !series.shape.is_empty());
    if line.len() > 1 {
        // The branches connect second parents to their children.
        let others: BTreeMap<IndividualId, &Arc<Ancestor>> =
            ancestry.others.iter().map(|other| (other.place, other)).collect();
        let branches = ancestry.line.iter().take(MAX_BRANCHES).filter_map(|child| {
            let parent = others.get(&child.parents.ids().nth(1)?)?;
            Some(Shape::Dashed(vec![place(parent)?, place(child)?]))
        });
        let branches = branches.map(|branch| Series::new("", Role::Second, branch));
        let before_line = series.len() - 1;
        series.splice(before_line..before_line, branches);
    }
    let last = ancestry.spreads.last().map_or(1, |spread| spread.generation).max(2);
    let points = series.iter().flat_map(|series| series.shape.points());
    let y = fitness_axis(settings.trial.fitness, points.map(|point| point[1]));
    let chart = Chart::new(generation_axis(last.into()), y, series);
    let hit = |ancestor: &Ancestor| {
        let at = ancestor.place;
        let fitness = ancestor.fitness?;
        let (parents, is_founded) = (ancestor.parents, at.generation == 1 && founder.is_some());
        let words = move || {
            let name = generation_and_snake(at);
            format!("{name}\nfitness {fitness:.2}{unit}\n{}", origin(parents, is_founded))
        };
        let target = HitShape::Point(place(ancestor)?);
        Some(ChartHit::of(target, words, Pick::Individual(at), at))
    };
    let hits = ancestry.line.iter().chain(&ancestry.others).filter_map(|of| hit(of)).collect();
    let figure =
        Figure::of("Ancestors of the best", chart).with_note(note_on_start(ancestry, founder));
    ChartView::new(figure, vec![hits])
}

/// Returns the series of the best snake and its ancestors, or of the best snake alone, with the reason why it has none.
fn best(ancestry: &Ancestry, line: Vec<[f64; 2]>) -> Series {
    match ancestry.line.as_slice() {
        [alone] => {
            let name = match alone.parents {
                Parents::Distribution => "the best snake (without parents)",
                Parents::None => "the best snake (random: no ancestors)",
                Parents::One(_) | Parents::Two(..) | Parents::Unknown => {
                    "the best snake (ancestors not recorded)"
                }
            };
            Series::new(name, Role::First, Shape::Points(line))
        }
        _ => Series::new("the best and its ancestors", Role::First, Shape::Line(line)),
    }
}

/// Samples the fitness values of all snakes, few enough to draw.
fn others(ancestry: &Ancestry) -> Vec<[f64; 2]> {
    let generations = ancestry.spreads.len().max(1);
    let each = (MAX_OTHERS / generations).max(MIN_PER_GENERATION);
    let of = |spread: &Arc<FitnessSpread>| {
        let generation = f64::from(spread.generation);
        let count = spread.fitness.len();
        let chosen = count.min(each);
        let index = move |number: usize| number * (count - 1) / (chosen - 1).max(1);
        let points = (0..chosen).map(|number| f64::from(spread.fitness[index(number)]));
        points.map(|fitness| [generation, fitness]).collect::<Vec<_>>()
    };
    ancestry.spreads.iter().flat_map(of).collect()
}

/// Describes the origin of a snake. `is_founded` tells whether it is of the first generation of a run that started from a snake.
fn origin(parents: Parents, is_founded: bool) -> String {
    match parents {
        Parents::None if is_founded => "From the snake with which the run started".to_owned(),
        Parents::None => "Created at random".to_owned(),
        Parents::One(parent) => format!("Child of {}", snake_of_generation(parent)),
        Parents::Two(first, second) => {
            let [first, second] = [first, second].map(snake_of_generation);
            format!("Child of {first}\nand {second}")
        }
        Parents::Distribution => "Drawn around the average of the best snakes so far".to_owned(),
        Parents::Unknown => "Parents unknown".to_owned(),
    }
}

/// Describes where the line of ancestry starts.
fn note_on_start(ancestry: &Ancestry, founder: Option<&str>) -> String {
    let Some(first) = ancestry.line.last() else { return String::new() };
    let generation = first.place.generation;
    match (first.parents, founder) {
        (Parents::None, Some(founder)) if generation == 1 => {
            format!("The line starts in generation 1, which came from \"{founder}\".")
        }
        (Parents::None, _) => {
            format!("The line starts in generation {generation} with a random snake.")
        }
        (Parents::Distribution, _) => {
            "In CMA-ES each snake varies around the average of the best, so no snake has parents. Genetic algorithm, under Method of evolution, has them."
                .to_owned()
        }
        (Parents::One(_) | Parents::Two(..) | Parents::Unknown, _) => {
            format!("Ancestors before generation {generation} were not recorded.")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::charts::tests::experiment;
    use snakes_core::evolve::StrategyKind;

    /// Creates the chart after three generations of a strategy. Also returns the generation of the best snake.
    fn shown(strategy: StrategyKind, founder: Option<&str>) -> (ChartView, u32) {
        let (settings, experiment) = experiment(3, |settings| {
            settings.evolution.strategy = strategy;
            settings.evolution.population = 8;
        });
        let generation = experiment.best().expect("a healthy snake").origin.generation;
        (view(&settings, &experiment.ancestry(), founder), generation)
    }

    #[test]
    fn every_ancestor_has_a_hover_text_and_can_be_clicked() {
        let (view, generation) = shown(StrategyKind::Halving, None);
        let hits = &view.hits[0];
        assert_eq!(hits.len() as u32, generation, "one in each generation");
        let last = hits.last().expect("the first ancestor");
        assert!(last.words().contains("Created at random"), "{}", last.words());
        assert!(view.figure.note.contains("starts in generation 1"), "{}", view.figure.note);
        let place = last.place.expect("a snake");
        assert_eq!((place.generation, last.pick), (1, Some(Pick::Individual(place))));
        assert!(hits[..hits.len() - 1].iter().all(|hit| hit.words().contains("Child of")));
    }

    #[test]
    fn the_first_generation_of_a_run_that_started_from_a_snake_is_not_called_random() {
        let (view, _) = shown(StrategyKind::Halving, Some("climber, edited"));
        let start = "The line starts in generation 1, which came from \"climber, edited\".";
        assert_eq!(view.figure.note, start);
        let words = view.hits[0].last().expect("the first ancestor").words();
        assert!(words.contains("From the snake with which the run started"), "{words}");
    }

    #[test]
    fn missing_parents_are_explained() {
        let (view, _) = shown(StrategyKind::CmaEs, None);
        assert_eq!(view.hits[0].len(), 1, "the best alone");
        let note = &view.figure.note;
        assert!(note.contains("no snake has parents"), "{note}");
        assert!(note.contains(StrategyKind::Ga.title()), "{note}");
        let names: Vec<&str> = view.figure.listed().iter().map(|of| of.name.as_str()).collect();
        assert!(names.contains(&"the best snake (without parents)"), "{names:?}");
        assert!(!names.contains(&"the best and its ancestors"), "{names:?}");
    }
}
