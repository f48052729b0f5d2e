//! Chart of the gene values of the parents of the next generation: one line per parent over all genes. Each value is
//! relative to its allowed range.

use std::sync::Arc;

use super::view::{ChartHit, ChartView, HitShape, generation_and_snake};
use crate::studio::commands::pick::Pick;
use crate::studio::ui::plot_axes::number;
use snakes_core::evolve::Settings;
use snakes_core::genome::Feature;
use snakes_core::schema::DisplayUnit;
use snakes_lab::plot::{Axis, Chart, Figure, Role, Series, Shape, with_unit};
use snakes_lab::run::Ancestor;

/// Maximum number of parents' lines that can be distinguished.
const MAX_PARENTS: usize = 40;
/// Maximum share of the colour ramp that is used. The brighter colours are too light for lines on a light panel.
const MAX_BRIGHTNESS: f32 = 0.85;

/// Creates the chart of the parents, with their numbers of children. Returns `None` if no genes are known.
pub(super) fn view(settings: &Settings, parents: &[(Arc<Ancestor>, u32)]) -> Option<ChartView> {
    let unit = settings.trial.fitness.unit();
    let known = |(parent, children): &(Arc<Ancestor>, u32)| {
        let features = settings.genome.features(parent.genome.as_ref()?).into_iter();
        let features: Vec<Feature> = features.map(in_unit_of_panels).collect();
        (!features.is_empty()).then(|| (Arc::clone(parent), *children, features))
    };
    let mut known: Vec<_> = parents.iter().filter_map(known).collect();
    // The best parents are drawn on top. They are kept if there are too many parents.
    let fitness = |parent: &Ancestor| parent.fitness.unwrap_or(f32::MIN);
    known.sort_by(|a, b| fitness(&a.0).total_cmp(&fitness(&b.0)));
    let surplus = known.len().saturating_sub(MAX_PARENTS);
    known.drain(..surplus);
    let healthy = || known.iter().filter_map(|(parent, ..)| parent.fitness);
    let (min, max) = (healthy().fold(f32::MAX, f32::min), healthy().fold(f32::MIN, f32::max));
    let name = |feature: &Feature| with_unit(&feature.name, feature.unit);
    let names: Vec<(f64, String)> =
        (0..).map(f64::from).zip(known.first()?.2.iter().map(name)).collect();
    let mut series = Vec::new();
    let mut hits = Vec::new();
    for (parent, children, features) in &known {
        let at = parent.place;
        let name = generation_and_snake(at);
        let reached = match parent.fitness {
            Some(fitness) => format!("fitness {fitness:.2}{unit}"),
            None => "disqualified".to_owned(),
        };
        let place = (0..features.len()).map(|index| index as f64);
        let points: Vec<[f64; 2]> =
            place.zip(features).map(|(x, feature)| [x, feature.share]).collect();
        for (point, feature) in points.iter().zip(features) {
            let space = if feature.unit.is_empty() { "" } else { " " };
            let words = format!(
                "{}: {}{space}{}\n{name}: {reached}\nChildren in the next generation: {children}",
                feature.name,
                number(f64::from(feature.value)),
                feature.unit,
            );
            let target = HitShape::Point(*point);
            hits.push(ChartHit::of(target, move || words.clone(), Pick::Individual(at), at));
        }
        let share =
            parent.fitness.map_or(0.0, |of| (of - min) / (max - min).max(f32::MIN_POSITIVE));
        let role = Role::Share(share.clamp(0.0, 1.0) * MAX_BRIGHTNESS);
        let name = format!("{}, {reached}", name.to_lowercase());
        series.push(Series::new(&name, role, Shape::Line(points)));
    }
    let last = (names.len() - 1) as f64;
    let aside = (last * 0.03).max(0.3);
    let x = Axis { names, ..Axis::new("Gene", "", -aside..=last + aside) };
    let y = Axis::new("Value within its range (0 lowest, 1 highest)", "", -0.05..=1.05);
    // Exported files contain the values rather than their relative positions.
    let heads: Vec<String> =
        [x.name.clone()].into_iter().chain(series.iter().map(|of| of.name.clone())).collect();
    let records: Vec<Vec<String>> = (x.names.iter().enumerate())
        .map(|(index, (_, name))| {
            let value = |feature: &Feature| feature.value.to_string();
            let of_parents =
                known.iter().map(|(.., of)| of.get(index).map_or(String::new(), value));
            [name.clone()].into_iter().chain(of_parents).collect()
        })
        .collect();
    let left_out = match surplus {
        0 => String::new(),
        _ => format!(" The best {MAX_PARENTS} of {} are shown.", surplus + known.len()),
    };
    let about = "Each line is a parent of the next generation and joins the values of its genes. 0 and 1 are the \
                 ends of a gene's range.";
    let note = if min < max {
        format!(
            "{about} Violet is the least fit ({min:.2}{unit}), green the fittest ({max:.2}{unit}).{left_out}"
        )
    } else {
        format!("{about}{left_out}")
    };
    let figure = Figure::of("Gene values of the parents", Chart::new(x, y, series));
    Some(ChartView::new(figure.with_note(note).with_numbers(heads, records), vec![hits]))
}

/// Converts a feature to the unit in which panels show it: angles to degrees.
fn in_unit_of_panels(mut feature: Feature) -> Feature {
    if let Some(display) = DisplayUnit::of_unit(feature.unit) {
        feature.value = display.shown(feature.value) as f32;
        feature.unit = display.unit;
    }
    feature
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::charts::tests::experiment;
    use snakes_core::evolve::StrategyKind;
    use snakes_core::genome::ControllerKind;

    #[test]
    fn every_value_has_a_hover_text_and_replays_its_parent() {
        let (settings, experiment) = experiment(1, |settings| {
            settings.evolution.strategy = StrategyKind::Ga;
            settings.evolution.population = 10;
            settings.genome.controller = ControllerKind::Gait;
        });
        let parents = experiment.parents();
        let view = view(&settings, &parents).expect("their genes are known");
        let dimension = settings.genome.dimension(settings.trial.genome_shape());
        assert_eq!(view.hits[0].len(), parents.len() * dimension);
        let frequency = view.hits[0].iter().find(|hit| hit.words().starts_with("frequency: "));
        assert!(frequency.expect("a gene").words().contains(" Hz\nGeneration 1, snake "));
        let table = view.figure.table();
        assert_eq!((table.len(), table[0].len()), (1 + dimension, 1 + parents.len()));
        assert_eq!(table[1][0], "bend limit (°)");
        assert_eq!(table[3][0], "density (kg/m³)");
        let best = parents.iter().max_by(|(a, _), (b, _)| {
            let fitness = |of: &Ancestor| of.fitness.unwrap_or(f32::MIN);
            fitness(a).total_cmp(&fitness(b))
        });
        let genome = best.expect("a parent").0.genome.as_ref().expect("known");
        let density = genome.body.density_kg_m3.to_string();
        assert_eq!(table[3].last(), Some(&density), "the value itself");
        let without_genomes: Vec<_> = parents
            .iter()
            .map(|(parent, children)| {
                (Arc::new(Ancestor { genome: None, ..(**parent).clone() }), *children)
            })
            .collect();
        assert!(super::view(&settings, &without_genomes).is_none());
    }
}
