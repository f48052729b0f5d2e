//! How far a run is, how fast it goes, how long it will take, who was disqualified and why.

use bevy_egui::egui;

use crate::run::GenerationReport;
use crate::studio::evolution::{Evolution, Status};
use crate::studio::look;

/// So many of the latest generations tell how fast a run goes.
const LATEST: usize = 5;

/// Draws it.
pub(super) fn progress(ui: &mut egui::Ui, run: &Evolution) {
    let (done, population) = run.progress();
    let generations = run.settings().evolution.generations;
    let finished = run.reports().len();
    let (text, share) = match run.status() {
        // Larger generations make for fewer of them.
        Status::Finished if finished < generations as usize => {
            let tried: u64 = run.reports().iter().map(|of| u64::from(of.evaluations)).sum();
            let text = format!(
                "All {finished} generations done: {tried} snakes. Larger ones make for fewer of them"
            );
            (text, 1.0)
        }
        Status::Finished => (format!("All {finished} generations done"), 1.0),
        status => {
            let held = match status {
                Status::Ready => ", ready to start",
                Status::Paused => ", paused",
                Status::Running | Status::Finished => "",
            };
            let text = format!("Generation {} of {generations}{held}", finished + 1);
            (text, done as f32 / population.max(1) as f32)
        }
    };
    ui.label(text);
    let inside = match run.run_hash() {
        Some(_) => "finished".to_owned(),
        None => format!("{done} of {population} snakes"),
    };
    ui.add(egui::ProgressBar::new(share).text(inside).fill(look::of(ui).accent_soft))
        .on_hover_text("Evaluated snakes of the current generation");
    if let Some(hash) = run.run_hash() {
        let hint = "It stands for every bit of the run: the same seed and settings give the same one, on any computer";
        let text = egui::RichText::new(format!("Run hash {hash:016x}"));
        ui.label(text.color(look::of(ui).text_weak)).on_hover_text(hint);
    }
    let color = look::of(ui).text_weak;
    let weak = |text: String| egui::RichText::new(text).color(color);
    let pace = pace(run.reports());
    let left = left(run, done);
    // The line is always there, so that nothing moves when the first generation is finished.
    let text = match pace {
        Some(per_s) if run.status() == Status::Finished => {
            format!("{} snakes a second", count(per_s))
        }
        Some(per_s) => {
            let time = in_words(left as f64 / per_s);
            format!("{time} left, {} snakes a second", count(per_s))
        }
        None => "The time left shows after the first generation".to_owned(),
    };
    let hint = "From the latest generations, as they were evaluated in this session or before";
    ui.add(egui::Label::new(weak(text)).wrap()).on_hover_text(hint);
    if let Some(latest) = run.reports().last() {
        let why = why(latest);
        let disqualified =
            format!("Disqualified: {} of {}{why}", latest.disqualified, latest.evaluations);
        let hint = "In the latest finished generation; the limits are in the World tab";
        ui.add(egui::Label::new(weak(disqualified)).wrap()).on_hover_text(hint);
    }
}

/// Evaluations a second in the latest generations, if there are any.
fn pace(reports: &[GenerationReport]) -> Option<f64> {
    let latest = || reports.iter().rev().take(LATEST);
    let seconds: f64 = latest().map(|report| report.elapsed_s).sum();
    let evaluations: f64 = latest().map(|report| f64::from(report.evaluations)).sum();
    (seconds > 0.0 && evaluations > 0.0).then(|| evaluations / seconds)
}

/// Evaluations that are left of what the run may cost, `done` of the current generation being made.
fn left(run: &Evolution, done: u32) -> u64 {
    let made: u64 = run.reports().iter().map(|report| u64::from(report.evaluations)).sum();
    run.budget().saturating_sub(made + u64::from(done))
}

/// The reasons for which snakes were disqualified, the most frequent first.
fn why(report: &GenerationReport) -> String {
    let mut reasons: Vec<_> = report.reasons.iter().collect();
    reasons.sort_by_key(|(_, count)| std::cmp::Reverse(**count));
    let reasons: Vec<String> =
        reasons.into_iter().map(|(reason, count)| format!("{count}: {}", reason.words())).collect();
    if reasons.is_empty() { String::new() } else { format!(" ({})", reasons.join("; ")) }
}

/// A number with as many digits as it is known by.
fn count(per_s: f64) -> String {
    if per_s < 10.0 { format!("{per_s:.1}") } else { format!("{per_s:.0}") }
}

/// A time to wait, in words.
fn in_words(seconds: f64) -> String {
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
    use crate::evolve::{RunPlan, Settings};
    use crate::run::{Control, Experiment, pool};
    use crate::world::Disqualification;

    /// The report of a small generation, as if it had taken so long.
    fn report(elapsed_s: f64) -> GenerationReport {
        let mut settings = Settings::default();
        settings.evolution.population = 4;
        settings.trial.duration_s = 0.2;
        let mut experiment = Experiment::new(RunPlan::new("test", 1, settings));
        let report = experiment.run_generation(&pool(1).expect("a pool"), &Control::default());
        GenerationReport { elapsed_s, ..report.expect("not cancelled") }
    }

    #[test]
    fn the_pace_is_that_of_the_latest_generations() {
        assert_eq!(pace(&[]), None);
        let reports: Vec<GenerationReport> =
            [100.0, 2.0, 2.0, 2.0, 1.0, 1.0].map(report).into_iter().collect();
        assert_eq!(pace(&reports), Some(20.0 / 8.0));
        assert_eq!(pace(&[report(0.0)]), None, "known from nowhere");
    }

    #[test]
    fn time_is_told_in_the_unit_that_people_think_in() {
        for (seconds, words) in [
            (12.3, "About 12 s"),
            (240.0, "About 4 min"),
            (3.0 * 3600.0, "About 3 h"),
            (5.0 * 86_400.0, "About 5 days"),
        ] {
            assert_eq!(in_words(seconds), words);
        }
    }

    #[test]
    fn the_most_frequent_reason_comes_first() {
        let mut report = report(1.0);
        report.reasons.clear();
        assert_eq!(why(&report), "");
        report.reasons.insert(Disqualification::JointBroke, 2);
        report.reasons.insert(Disqualification::LeftArena, 7);
        assert_eq!(why(&report), " (7: it left the arena; 2: a joint came apart)");
    }
}
