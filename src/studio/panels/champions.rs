//! The best snake of every generation, newest first. A click replays it.

use bevy_egui::egui;

use super::shown::ShownChampion;
use crate::evolve::Champion;
use crate::run::GenerationReport;
use crate::studio::commands::pick::Pick;
use crate::studio::commands::{Command, PlanCommand, StageCommand};
use crate::studio::stage::opening::NamedChampion;
use crate::studio::ui::text_rows::{explain, row};

/// List of champions.
#[derive(Debug, Default)]
pub(super) struct ChampionsPanel {
    /// Cached summary of the reports, with the number of reports and the hash of the latest as its key.
    summary: Option<((usize, u64), ReportSummary)>,
}

/// Summary that is computed once for each new report instead of in every frame.
#[derive(Debug, Clone, Copy)]
struct ReportSummary {
    /// Number of generations that have a champion.
    champions: usize,
    /// Generation of the best champion of the run.
    best: Option<u32>,
}

impl ReportSummary {
    fn of(reports: &[GenerationReport]) -> Self {
        let champions = reports.iter().filter_map(|report| report.champion.as_ref());
        let fitness = |champion: &Champion| champion.evaluation.fitness;
        // The earliest of equally fit champions wins.
        let best = champions.clone().rev().max_by(|a, b| fitness(a).total_cmp(&fitness(b)));
        Self { champions: champions.count(), best: best.map(|champion| champion.origin.generation) }
    }
}

impl ChampionsPanel {
    /// Draws the list and collects the user's commands.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        opening: &[NamedChampion],
        reports: &[GenerationReport],
        shown: &[ShownChampion],
        leaders: impl Fn(Option<u32>) -> usize,
        commands: &mut Vec<Command>,
    ) {
        let ReportSummary { champions, best } = self.summary(reports);
        ui.horizontal(|ui| {
            for (name, hint, is_on, needed, command) in [
                (
                    "Race generations",
                    "Replay champions of several generations side by side (N)",
                    champions > 1,
                    "two generations",
                    Command::Stage(StageCommand::RaceGenerations),
                ),
                (
                    "Race best 10",
                    "Replay the ten best snakes of the latest generation side by side (M)",
                    leaders(None) > 1,
                    "a generation",
                    Command::Stage(StageCommand::RaceLeaders(None)),
                ),
            ] {
                let button = egui::Button::new(name);
                let disabled_hint = format!("Nothing to race yet: finish {needed} first");
                let response = ui.add_enabled(is_on, button).on_hover_text(hint);
                if response.on_disabled_hover_text(disabled_hint).clicked() {
                    commands.push(command);
                }
            }
        });
        if reports.is_empty() {
            explain(ui, "The best snake of each generation will appear here.");
        }
        let height = ui.spacing().interact_size.y;
        let rows = opening.len() + reports.len();
        let area = egui::ScrollArea::vertical().auto_shrink(false);
        // A run may have thousands of generations, so only visible rows are drawn.
        area.show_rows(ui, height, rows, |ui, seen| {
            for index in seen {
                if let Some(saved) = opening.get(index) {
                    let is_shown = shown.contains(&ShownChampion::Opening(index));
                    let champion = &saved.loaded.champion;
                    entry(ui, is_shown, &saved.name, champion, Pick::Opened(index), None, commands);
                    continue;
                }
                // The newest generation is listed first.
                let Some(report) = reports.iter().rev().nth(index - opening.len()) else {
                    continue;
                };
                let generation = report.generation;
                let name = format!("Generation {generation}");
                let Some(champion) = &report.champion else {
                    row(ui, false, &name, "all disqualified");
                    continue;
                };
                let individual = champion.origin.individual;
                let is_shown = shown.iter().any(|shown| shown.is(generation, individual));
                let pick = Pick::Generation(generation);
                let is_best = best == Some(generation);
                let name = if is_best { format!("{name}, best") } else { name };
                let race = (leaders(Some(generation)) > 1).then_some(generation);
                entry(ui, is_shown, &name, champion, pick, race, commands);
            }
        });
    }
}

impl ChampionsPanel {
    fn summary(&mut self, reports: &[GenerationReport]) -> ReportSummary {
        let now = (reports.len(), reports.last().map_or(0, |report| report.hash));
        match self.summary {
            Some((key, summary)) if key == now => summary,
            _ => self.summary.insert((now, ReportSummary::of(reports))).1,
        }
    }
}

/// Draws the row of a champion. A click shows it alone; Shift or Control adds it to the stage. Its context menu starts
/// the next run from it, or races the best ten of its generation.
fn entry(
    ui: &mut egui::Ui,
    is_shown: bool,
    name: &str,
    champion: &Champion,
    pick: Pick,
    race: Option<u32>,
    commands: &mut Vec<Command>,
) {
    let response = row(ui, is_shown, name, &champion.reached()).on_hover_ui(|ui| {
        // These values distinguish champions that reached the same distance.
        if let Some(effort) = champion.evaluation.effort {
            let (energy_kj, speed_m_s) = (effort.energy_j / 1000.0, effort.top_speed_m_s);
            ui.label(format!("Energy {energy_kj:.1} kJ, top speed {speed_m_s:.1} m/s"));
        }
        ui.label("Click to replay. Shift-click to add it to the stage. Right-click for more.");
    });
    if response.clicked() {
        let joins = ui.input(|input| input.modifiers.shift || input.modifiers.command);
        commands.push(if joins {
            Command::Stage(StageCommand::Join(pick))
        } else {
            Command::Stage(StageCommand::Show(pick))
        });
    }
    response.context_menu(|ui| {
        let found = ui.button("Start the next run from this snake");
        let hint = "The first generation descends from it, in the world where it was found";
        if found.on_hover_text(hint).clicked() {
            commands.push(Command::Plan(PlanCommand::StartFrom(pick)));
            ui.close();
        }
        if let Some(generation) = race
            && ui.button("Race best 10 of this generation").clicked()
        {
            commands.push(Command::Stage(StageCommand::RaceLeaders(Some(generation))));
            ui.close();
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::{RunPlan, Settings};
    use crate::run::{Experiment, LocalPool, RunControl};
    use crate::save::shipped_champion;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn the_summary_is_updated_after_a_report_and_in_another_run() {
        let mut settings = Settings::default();
        settings.evolution.population = 4;
        settings.trial.duration_s = 0.5;
        let pool = LocalPool::new(1).expect("threads");
        let run = |seed| {
            let mut experiment = Experiment::new(RunPlan::new("test", seed, settings.clone()));
            let mut report =
                || experiment.run_generation(&pool, &RunControl::default()).expect("done");
            [report(), report(), report()]
        };
        let (first, second) = (run(1), run(2));
        let mut panel = ChampionsPanel::default();
        for reports in [&first[..0], &first[..1], &first[..], &second[..], &first[..2]] {
            let summary = panel.summary(reports);
            let expected = ReportSummary::of(reports);
            assert_eq!((summary.champions, summary.best), (expected.champions, expected.best));
        }
    }

    #[test]
    fn a_click_on_a_generation_shows_its_champion() {
        let mut settings = Settings::default();
        settings.evolution.population = 4;
        settings.trial.duration_s = 0.5;
        let mut experiment = Experiment::new(RunPlan::new("test", 1, settings));
        let pool = LocalPool::new(1).expect("threads");
        let mut report = || experiment.run_generation(&pool, &RunControl::default()).expect("done");
        let reports = [report(), report()];
        let loaded = shipped_champion().expect("well formed");
        let opening = [NamedChampion { name: "climber".to_owned(), loaded }];
        let mut panel = ChampionsPanel::default();
        let mut harness = Harness::new_ui_state(
            |ui, commands| {
                panel.ui(ui, &opening, &reports, &[ShownChampion::Opening(0)], |_| 2, commands);
            },
            Vec::new(),
        );
        harness.get_by_label_contains("Generation 2").click();
        harness.run();
        assert_eq!(*harness.state(), [Command::Stage(StageCommand::Show(Pick::Generation(2)))]);
        harness.state_mut().clear();
        harness.get_by_label_contains("Generation 1").click_modifiers(egui::Modifiers::SHIFT);
        harness.run();
        harness.get_by_label("Race generations").click();
        harness.run();
        let commands = [
            Command::Stage(StageCommand::Join(Pick::Generation(1))),
            Command::Stage(StageCommand::RaceGenerations),
        ];
        assert_eq!(*harness.state(), commands);
    }
}
