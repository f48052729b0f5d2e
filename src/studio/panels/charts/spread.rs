//! Histogram of the fitness in the latest generation. A click on a bar replays its best snake.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use super::fitness::fitness_axis;
use super::view::{ChartHit, ChartView, HitShape};
use crate::studio::commands::pick::Pick;
use crate::studio::ui::plot_axes::{number, step};
use snakes_core::evolve::{IndividualId, Settings};
use snakes_core::score::Evaluation;
use snakes_core::world::Disqualification;
use snakes_lab::plot::{Axis, Chart, Figure, Role, Series, Shape, extent};
use snakes_lab::run::Generation;

/// Minimum and maximum of the desired number of bars.
const BAR_COUNTS: RangeInclusive<f64> = 6.0..=30.0;

/// A bar of the histogram.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Bin {
    /// Lower end of the bar, in units of fitness.
    from: f64,
    /// Upper end of the bar, in units of fitness; exclusive except in the last bar.
    to: f64,
    count: u32,
    /// Index and fitness of the best snake in the bar.
    best: (u32, f32),
}

/// Creates the histogram of a generation.
pub(super) fn view(settings: &Settings, generation: &Generation) -> ChartView {
    let unit = settings.trial.fitness.unit();
    let bins = bins(&generation.evaluations);
    let number_of = generation.number;
    let bars = bins.iter().map(|bin| [(bin.from + bin.to) / 2.0, f64::from(bin.count)]);
    let width = bins.first().map_or(1.0, |bin| bin.to - bin.from);
    let bars = Shape::Bars { width, bars: bars.collect() };
    let max = bins.iter().map(|bin| bin.count).max().unwrap_or(0);
    let ends = bins.iter().flat_map(|bin| [bin.from, bin.to]);
    let top = f64::from(max.max(1)) * 1.06;
    let x = fitness_axis(settings.trial.fitness, ends);
    let y = Axis::count("Snakes", 0.0..=top);
    let chart = Chart::new(x, y, vec![Series::new("snakes", Role::First, bars)]);
    let hits = bins.iter().map(|bin| {
        let Bin { from, to, count, best: (individual, fitness) } = *bin;
        let range = format!("from {} to {}{unit}", number(from), number(to));
        let snakes = if count == 1 { "snake" } else { "snakes" };
        let words = format!(
            "{count} {snakes} {range}\nBest of them: snake {}, {fitness:.2}{unit}",
            individual + 1
        );
        let place = IndividualId { generation: number_of, individual };
        let area = HitShape::Area([from, to, 0.0, top]);
        ChartHit::of(area, move || words.clone(), Pick::Individual(place), place)
    });
    let hits = hits.collect();
    let title = format!("Fitness within generation {number_of}");
    let note = disqualified(&generation.evaluations);
    ChartView::new(Figure::of(&title, chart).with_note(note), vec![hits])
}

/// Sorts healthy snakes into bins of equal, round width. Leaves out empty bins.
fn bins(evaluations: &[Evaluation]) -> Vec<Bin> {
    let healthy: Vec<(u32, f32)> = (0..)
        .zip(evaluations)
        .filter(|(_, evaluation)| evaluation.disqualified.is_none())
        .map(|(index, evaluation)| (index, evaluation.fitness))
        .collect();
    let values = healthy.iter().map(|(_, fitness)| f64::from(*fitness));
    let [min, max] = extent(values).unwrap_or_default();
    let wanted = (healthy.len() as f64).sqrt().clamp(*BAR_COUNTS.start(), *BAR_COUNTS.end());
    // `step` divides its range into about six parts.
    let width = step((max - min).max(1.0e-3) * 6.0 / wanted);
    let mut bins: BTreeMap<i64, Bin> = BTreeMap::new();
    for (individual, fitness) in healthy {
        let place = libm::floor(f64::from(fitness) / width);
        let from = place * width;
        let new = Bin { from, to: from + width, count: 0, best: (individual, f32::MIN) };
        let bin = bins.entry(place as i64).or_insert(new);
        bin.count += 1;
        // Among equally fit snakes, the first counts as the best.
        if fitness > bin.best.1 {
            bin.best = (individual, fitness);
        }
    }
    bins.into_values().collect()
}

/// Describes how many snakes were disqualified for each reason.
fn disqualified(evaluations: &[Evaluation]) -> String {
    let mut counts: BTreeMap<Disqualification, usize> = BTreeMap::new();
    for reason in evaluations.iter().filter_map(|evaluation| evaluation.disqualified) {
        *counts.entry(reason).or_default() += 1;
    }
    let reasons: Vec<String> =
        counts.iter().map(|(reason, count)| format!("{count}: {}", reason.words())).collect();
    let number: usize = counts.values().sum();
    if number == 0 {
        return format!("None of {} were disqualified.", evaluations.len());
    }
    format!("{number} of {} were disqualified: {}.", evaluations.len(), reasons.join("; "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn evaluation(fitness: f32, disqualified: Option<Disqualification>) -> Evaluation {
        Evaluation { disqualified, ..Evaluation::of_fitness(fitness) }
    }

    #[test]
    fn bars_count_every_healthy_snake_once_and_know_their_best() {
        let values = [-7.2, -7.1, -7.15, -6.0, -3.5, -3.6, 1.9];
        let mut evaluations: Vec<Evaluation> =
            values.iter().map(|value| evaluation(*value, None)).collect();
        evaluations.push(evaluation(99.0, Some(Disqualification::TooFast)));
        let bins = bins(&evaluations);
        assert_eq!(bins.iter().map(|bin| bin.count).sum::<u32>(), 7);
        for bin in &bins {
            let within = |value: &&f32| (bin.from..bin.to).contains(&f64::from(**value));
            assert_eq!(values.iter().filter(within).count() as u32, bin.count, "{bin:?}");
            let best = values.iter().filter(within).copied().fold(f32::MIN, f32::max);
            assert_eq!((values[bin.best.0 as usize], bin.best.1), (best, best));
        }
        assert!(bins.len() > 2);
        assert_eq!(super::bins(&evaluations[7..]), []);
        assert_eq!(super::bins(&[evaluation(2.0, None), evaluation(2.0, None)])[0].best, (0, 2.0));
    }

    #[test]
    fn the_disqualified_are_counted_by_reason() {
        let evaluations = [
            evaluation(1.0, None),
            evaluation(1.0, Some(Disqualification::TooFast)),
            evaluation(1.0, Some(Disqualification::JointBroke)),
            evaluation(1.0, Some(Disqualification::TooFast)),
        ];
        let words = disqualified(&evaluations);
        assert!(words.starts_with("3 of 4 were disqualified: 1: joint pulled apart; "), "{words}");
        assert!(words.ends_with("2: speed limit exceeded."), "{words}");
        assert_eq!(disqualified(&evaluations[..1]), "None of 1 were disqualified.");
    }
}
