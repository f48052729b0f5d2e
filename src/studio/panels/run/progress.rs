//! Progress of a run: generations, speed, remaining time and disqualifications.

use bevy_egui::egui;
use indicatif::HumanCount;

use crate::studio::state::current_run::{CurrentRun, RunStatus};
use crate::studio::ui::text_rows::weak;
use crate::studio::ui::theme;
use snakes_core::evolve::{EvolutionSettings, Settings, StrategyKind};
use snakes_lab::run::GenerationReport;

/// Number of latest generations over which the speed is averaged.
const MEASURED_GENERATIONS: usize = 5;

/// Draws the progress of the run.
pub(crate) fn progress(ui: &mut egui::Ui, run: &CurrentRun) {
    let (done, population) = run.progress();
    let finished = run.reports.len();
    let random_first = random_first(run.settings(), finished, run.founder().is_some());
    let population = random_first.unwrap_or(population);
    let generations = run.settings().evolution.generations;
    let (text, share) = match run.status() {
        RunStatus::Finished if finished < generations as usize => {
            (finished_early(finished, generations, run.plan_now.budget()), 1.0)
        }
        RunStatus::Finished => (format!("Finished after generation {finished}"), 1.0),
        status => {
            let suffix = match status {
                RunStatus::Ready => ", ready to start",
                RunStatus::Paused => ", paused",
                RunStatus::Running | RunStatus::Finished => "",
            };
            let most = run.plan_now.most_generations_in_words();
            // The last generation is finished for a moment before the run is.
            let current = (finished + 1).min(generations as usize);
            let text = format!("Generation {current} of {most}{suffix}");
            (text, done as f32 / population.max(1) as f32)
        }
    };
    ui.label(text);
    let inside = match (run.run_hash, random_first) {
        (Some(_), _) => "finished".to_owned(),
        (None, Some(random)) => format!("{done} of {random} random snakes"),
        (None, None) => evaluated(done, population, run.settings().evolution.population),
    };
    let hint = match random_first {
        Some(random) => format!(
            "The search starts at the best of {random} random snakes. Later generations have {} snakes",
            run.settings().evolution.population
        ),
        None => "Snakes evaluated in the current generation".to_owned(),
    };
    ui.add(egui::ProgressBar::new(share).text(inside).fill(theme::of(ui).accent_soft))
        .on_hover_text(hint);
    // This line is always present, so that the layout does not move when the first generation is finished.
    let text = match evaluations_per_s(&run.reports) {
        Some(per_s) if run.status() == RunStatus::Finished => {
            format!("{} snakes per second", rounded(per_s))
        }
        Some(per_s) => {
            let reports = run.reports.iter();
            let made: u64 = reports.map(|report| u64::from(report.evaluations)).sum();
            let left = run.plan_now.budget().saturating_sub(made + u64::from(done));
            let time = duration_text(left as f64 / per_s);
            format!("{time} left, {} snakes per second", rounded(per_s))
        }
        None => "The time left appears after the first generation".to_owned(),
    };
    let hint = "Estimated from the latest generations, including those of earlier sessions";
    ui.add(egui::Label::new(weak(ui, text)).wrap()).on_hover_text(hint);
    if let Some(latest) = run.reports.last() {
        let (out, all, reasons) = (latest.disqualified, latest.evaluations, reasons_text(latest));
        let disqualified = weak(ui, format!("Disqualified: {out} of {all}{reasons}"));
        let hint =
            "In the latest finished generation. The limits are in the Change panel, under Advanced";
        ui.add(egui::Label::new(disqualified).wrap()).on_hover_text(hint);
    }
}

/// Describes how many of the evaluations of a generation are finished. Snakes that survive from the generation before are
/// not evaluated again.
fn evaluated(done: u32, all: u32, population: u32) -> String {
    let new = if all < population { " new" } else { "" };
    format!("{done} of {all}{new} snakes")
}

/// Describes a run that ended after fewer generations than planned. The number of evaluations is limited, too, and some generations were
/// larger than planned, such as the first of CMA-ES.
fn finished_early(finished: usize, planned: u32, budget: u64) -> String {
    format!(
        "Finished after {finished} generations: the limit of {} snakes is reached. {planned} generations were planned, but some had more snakes than usual.",
        HumanCount(budget)
    )
}

/// Returns the number of random snakes that CMA-ES evaluates first, until the first generation is finished.
fn random_first(settings: &Settings, finished: usize, has_founder: bool) -> Option<u32> {
    let EvolutionSettings { strategy, cma_es, .. } = &settings.evolution;
    let is_first = finished == 0 && !has_founder && *strategy == StrategyKind::CmaEs;
    // The random snakes take at most a quarter of the run's evaluations.
    let most = u32::try_from(settings.evolution.budget() / 4).unwrap_or(u32::MAX);
    Some(cma_es.newborns.min(most)).filter(|random| is_first && *random > 0)
}

/// Returns the evaluations per second over the latest generations, if there are any.
fn evaluations_per_s(reports: &[GenerationReport]) -> Option<f64> {
    let latest = || reports.iter().rev().take(MEASURED_GENERATIONS);
    let seconds: f64 = latest().map(|report| report.elapsed_s).sum();
    let evaluations: f64 = latest().map(|report| f64::from(report.evaluations)).sum();
    (seconds > 0.0 && evaluations > 0.0).then(|| evaluations / seconds)
}

/// Describes the reasons for disqualification, the most frequent first.
fn reasons_text(report: &GenerationReport) -> String {
    let mut reasons: Vec<_> = report.reasons.iter().collect();
    reasons.sort_by_key(|(_, count)| std::cmp::Reverse(**count));
    let reasons: Vec<String> =
        reasons.into_iter().map(|(reason, count)| format!("{count}: {}", reason.words())).collect();
    if reasons.is_empty() { String::new() } else { format!(" ({})", reasons.join("; ")) }
}

/// Formats a speed with a suitable number of digits.
fn rounded(per_s: f64) -> String {
    if per_s < 10.0 { format!("{per_s:.1}") } else { format!("{per_s:.0}") }
}

/// Describes the remaining time, given in seconds.
fn duration_text(seconds: f64) -> String {
    let minutes = seconds / 60.0;
    if seconds < 90.0 {
        format!("About {seconds:.0} s")
    } else if minutes < 90.0 {
        format!("About {minutes:.0} min")
    } else if minutes < 48.0 * 60.0 {
        format!("About {:.0} h", minutes / 60.0)
    } else {
        format!("About {:.0} days", minutes / (24.0 * 60.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::testing::report_of;
    use snakes_core::world::Disqualification;

    /// Returns the report of a small generation that took this time, in seconds.
    fn report(elapsed_s: f64) -> GenerationReport {
        let mut report = report_of(1);
        report.record.elapsed_s = elapsed_s;
        report
    }

    #[test]
    fn the_speed_is_measured_over_the_latest_generations() {
        assert_eq!(evaluations_per_s(&[]), None);
        let reports: Vec<GenerationReport> =
            [100.0, 2.0, 2.0, 2.0, 1.0, 1.0].map(report).into_iter().collect();
        assert_eq!(evaluations_per_s(&reports), Some(20.0 / 8.0));
        assert_eq!(evaluations_per_s(&[report(0.0)]), None, "known from nowhere");
    }

    #[test]
    fn the_random_snakes_of_the_first_generation_are_counted_before_the_start() {
        let mut settings = Settings::default();
        settings.evolution.population = 30;
        settings.evolution.generations = 200;
        settings.evolution.cma_es.newborns = 100;
        assert_eq!(random_first(&settings, 0, false), None, "another strategy has none");
        settings.evolution.strategy = StrategyKind::CmaEs;
        assert_eq!(random_first(&settings, 0, false), Some(100));
        assert_eq!(random_first(&settings, 1, false), None, "later generations have 30");
        assert_eq!(random_first(&settings, 0, true), None, "the founder takes their place");
        settings.evolution.generations = 4;
        assert_eq!(random_first(&settings, 0, false), Some(30), "at most a quarter of the budget");
    }

    #[test]
    fn a_run_that_finished_early_says_what_ended_it_and_why_before_the_planned_number() {
        assert_eq!(
            finished_early(57, 60, 6000),
            "Finished after 57 generations: the limit of 6,000 snakes is reached. 60 generations were planned, but some had more snakes than usual."
        );
    }

    #[test]
    fn a26_evaluations_are_those_of_new_snakes_if_others_survive() {
        assert_eq!(evaluated(197, 197, 200), "197 of 197 new snakes");
        assert_eq!(evaluated(7, 30, 30), "7 of 30 snakes");
    }

    #[test]
    fn the_remaining_time_has_a_suitable_unit() {
        for (seconds, words) in [
            (12.3, "About 12 s"),
            (240.0, "About 4 min"),
            (3.0 * 3600.0, "About 3 h"),
            (5.0 * 86_400.0, "About 5 days"),
        ] {
            assert_eq!(duration_text(seconds), words);
        }
    }

    #[test]
    fn the_most_frequent_reason_comes_first() {
        let mut report = report(1.0);
        report.reasons.clear();
        assert_eq!(reasons_text(&report), "");
        report.reasons.insert(Disqualification::JointBroke, 2);
        report.reasons.insert(Disqualification::LeftArena, 7);
        let expected = " (7: sideways or backward limit crossed; 2: joint pulled apart)";
        assert_eq!(reasons_text(&report), expected);
    }
}
