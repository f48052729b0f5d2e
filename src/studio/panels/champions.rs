//! The best snake of every generation, newest first. A click replays it.

mod climbs;
mod columns;

use std::cmp::Ordering;
use std::sync::Arc;

use bevy_egui::egui;

use super::shown::{ShownChampion, ShownLane};
use crate::studio::commands::pick::Pick;
use crate::studio::commands::{Command, PlanCommand, StageCommand};
use crate::studio::stage::opening::NamedChampion;
use crate::studio::ui::check_box::check_box;
use crate::studio::ui::text_rows::explain;
use crate::studio::ui::theme;
use snakes_core::evolve::Champion;
use snakes_lab::run::GenerationReport;

use climbs::{Climb, Climbs, LandingTime};
use columns::{ChampionRowStyle, cells, heads, rows_width};

/// List of champions.
#[derive(Debug, Default)]
pub(super) struct ChampionsPanel {
    /// Cached summary of the reports, with the number of reports and the hash of the latest as its key.
    summary: Option<((usize, u64), ReportSummary)>,
    /// Whether only generations that improved on all before are listed.
    lists_better_only: bool,
    climbs: Climbs,
}

/// Summary that is computed once for each new report instead of in every frame.
#[derive(Debug, Clone)]
struct ReportSummary {
    /// Number of generations that have a champion.
    champions: usize,
    /// Generation of the best champion of the run.
    best: Option<u32>,
    /// Indices of the reports whose champions are better than all before.
    better: Arc<[usize]>,
}

impl ReportSummary {
    fn of(reports: &[GenerationReport]) -> Self {
        let champions = reports
            .iter()
            .filter_map(|report| Some((report.champion.as_ref()?, report.champion_rank()?)));
        // The earliest of equally good champions wins.
        let best = champions.clone().rev().max_by(|(_, a), (_, b)| {
            let pairs = a.iter().zip(b);
            pairs.fold(Ordering::Equal, |so_far, (a, b)| so_far.then(a.total_cmp(b)))
        });
        let mut most = [f32::MIN; 2];
        let is_better = |report: &GenerationReport| {
            let rank = report.champion_rank().filter(|rank| *rank > most);
            most = rank.unwrap_or(most);
            rank.is_some()
        };
        let all = reports.iter().map(is_better).enumerate();
        let better = all.filter(|(_, is_better)| *is_better).map(|(index, _)| index).collect();
        Self {
            champions: champions.count(),
            best: best.map(|(champion, _)| champion.origin.generation),
            better,
        }
    }
}

impl ChampionsPanel {
    /// Draws the list and collects the user's commands. `follows` says whether the stage shows each better generation.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        opening: &[NamedChampion],
        reports: &[GenerationReport],
        shown: &[ShownLane],
        leaders: impl Fn(Option<u32>) -> usize,
        mut follows: bool,
        commands: &mut Vec<Command>,
    ) {
        let ReportSummary { champions, best, better } = self.summary(reports);
        let has_better_only = reports.first().is_some_and(|report| report.stairs.is_some());
        self.climbs.poll();
        ui.horizontal_wrapped(|ui| {
            for (name, hint, is_on, needed, command) in [
                (
                    "Whole generation",
                    "Show all snakes of the latest generation at once (I)",
                    leaders(None) > 1,
                    "a generation",
                    Command::Stage(StageCommand::ShowGeneration(None)),
                ),
                (
                    "Story",
                    "Play the first, the middle and the latest of the better generations (S)",
                    better.len() > 1,
                    "two generations",
                    Command::Stage(StageCommand::TellStory),
                ),
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
                let disabled_hint = format!("Nothing to show yet: finish {needed} first");
                let response = ui.add_enabled(is_on, button).on_hover_text(hint);
                if response.on_disabled_hover_text(disabled_hint).clicked() {
                    commands.push(command);
                }
            }
        });
        ui.horizontal_wrapped(|ui| {
            let hint = "Show each better generation as soon as it is found (W)";
            if check_box(ui, &mut follows, "Follow evolution").on_hover_text(hint).clicked() {
                commands.push(Command::Stage(StageCommand::ToggleFollowEvolution));
            }
            let name = "Better ones only";
            if has_better_only {
                let hint = "A run whose stairs evolve keeps only the snakes that beat those of all generations before";
                ui.add_enabled_ui(false, |ui| check_box(ui, &mut true, name))
                    .inner
                    .on_disabled_hover_text(hint);
            } else {
                let hint =
                    "List only the generations whose best snake beat those of all generations before";
                check_box(ui, &mut self.lists_better_only, name).on_hover_text(hint);
            }
        });
        let lists_better_only = self.lists_better_only || has_better_only;
        if reports.is_empty() {
            explain(ui, "The best snake of each generation will appear here.");
        }
        let height = theme::CHAMPION_ROW_HEIGHT;
        let listed = if lists_better_only { better.len() } else { reports.len() };
        let rows = opening.len() + listed;
        let width = rows_width(ui);
        heads(ui, width);
        let area = egui::ScrollArea::vertical().auto_shrink(false);
        // A run may have thousands of generations, so only visible rows are drawn.
        area.show_rows(ui, height, rows, |ui, seen| {
            ui.set_max_width(width);
            for index in seen {
                if let Some(saved) = opening.get(index) {
                    let is_it =
                        |shown: &&ShownLane| shown.champion == ShownChampion::Opening(index);
                    let row = ChampionRow {
                        shown: shown.iter().find(is_it),
                        name: &saved.name,
                        champion: &saved.loaded.champion,
                        climb: self.climbs.of_save(&saved.loaded),
                        has_time: saved.loaded.is_of_this_engine(),
                    };
                    entry(ui, row, Pick::Opened(index), None, commands);
                    continue;
                }
                // The newest generation is listed first.
                let from_end = listed - 1 - (index - opening.len());
                let place = if lists_better_only { better[from_end] } else { from_end };
                let Some(report) = reports.get(place) else { continue };
                let generation = report.generation;
                let name = format!("Generation {generation}");
                let Some(champion) = &report.champion else {
                    let cells = ["disqualified", "-", "-"].map(str::to_owned);
                    let hint = "All snakes of this generation were disqualified";
                    columns::row(ui, ChampionRowStyle::default(), &name, &cells)
                        .on_hover_text(hint);
                    continue;
                };
                let individual = champion.origin.individual;
                let is_it = |shown: &&ShownLane| shown.champion.is(generation, individual);
                let pick = Pick::Generation(generation);
                let is_best = best == Some(generation);
                let name = if is_best { format!("{name}, best") } else { name };
                let race = (leaders(Some(generation)) > 1).then_some(generation);
                let row = ChampionRow {
                    shown: shown.iter().find(is_it),
                    name: &name,
                    champion,
                    climb: self.climbs.of(champion),
                    has_time: true,
                };
                entry(ui, row, pick, race, commands);
            }
        });
    }
}

impl ChampionsPanel {
    fn summary(&mut self, reports: &[GenerationReport]) -> ReportSummary {
        let now = (reports.len(), reports.last().map_or(0, |report| report.hash));
        match &self.summary {
            Some((key, summary)) if *key == now => summary.clone(),
            _ => self.summary.insert((now, ReportSummary::of(reports))).1.clone(),
        }
    }
}

/// Row of a champion.
struct ChampionRow<'r> {
    /// How it is on the stage, if it is.
    shown: Option<&'r ShownLane>,
    name: &'r str,
    champion: &'r Champion,
    climb: Option<&'r Climb>,
    /// Whether the time of its landing can be known: another engine would reach the top at another time.
    has_time: bool,
}

/// Draws the row of a champion. A click shows it alone; Shift or Control adds it to the stage. Its context menu starts
/// the next run from it, or races the best ten of its generation.
fn entry(
    ui: &mut egui::Ui,
    ChampionRow { shown, name, champion, climb, has_time }: ChampionRow<'_>,
    pick: Pick,
    race: Option<u32>,
    commands: &mut Vec<Command>,
) {
    let time = if has_time { LandingTime::of(champion, climb) } else { LandingTime::None };
    let style = ChampionRowStyle {
        is_shown: shown.is_some(),
        lane_color: shown.and_then(|shown| shown.color(theme::of(ui))),
        picture: climb.map(|climb| &climb.picture),
    };
    let response = columns::row(ui, style, name, &cells(champion, time));
    let response = response.on_hover_ui(|ui| {
        ui.label(format!("{name}: {}", champion.reached()));
        if let LandingTime::Known(time_s) = time {
            ui.label(format!("Reached the top after {time_s:.2} s"));
        }
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
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;
    use snakes_core::evolve::{RunPlan, Settings};
    use snakes_core::save::shipped_champion;
    use snakes_lab::run::{Experiment, LocalPool, RunControl};

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
            assert_eq!(summary.better, expected.better);
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
                panel.ui(
                    ui,
                    &opening,
                    &reports,
                    &[ShownLane { champion: ShownChampion::Opening(0), lane: None }],
                    |_| 2,
                    false,
                    commands,
                );
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

    #[test]
    fn better_ones_only_lists_the_generations_that_improved_on_all_before() {
        let mut settings = Settings::default();
        settings.evolution.population = 4;
        settings.trial.duration_s = 0.5;
        let mut experiment = Experiment::new(RunPlan::new("test", 1, settings));
        let pool = LocalPool::new(1).expect("threads");
        let first = experiment.run_generation(&pool, &RunControl::default()).expect("done");
        let fitnesses = [1.0, 0.5, 2.0, 2.0, 3.0];
        let reports: Vec<GenerationReport> = (1..)
            .zip(fitnesses)
            .map(|(generation, fitness)| {
                let mut report = GenerationReport { generation, ..first.clone() };
                let champion = report.champion.as_mut().expect("a healthy snake");
                champion.origin.generation = generation;
                champion.evaluation.fitness = fitness;
                report
            })
            .collect();
        let mut panel = ChampionsPanel::default();
        let mut harness = Harness::builder().with_size(egui::vec2(360.0, 400.0)).build_ui_state(
            |ui, commands| panel.ui(ui, &[], &reports, &[], |_| 2, false, commands),
            Vec::new(),
        );
        let listed = |harness: &Harness<'_, Vec<Command>>| -> Vec<u32> {
            let is_listed = |generation: &u32| {
                let name = format!("Generation {generation}");
                harness.query_by_label_contains(&name).is_some()
            };
            (1..=5).filter(is_listed).collect()
        };
        harness.run();
        assert_eq!(listed(&harness), [1, 2, 3, 4, 5]);
        for head in ["Fitness", "Time", "Energy"] {
            assert!(harness.query_by_label(head).is_some(), "{head}");
        }
        assert!(harness.query_by_label_contains("Generation 5, best, 3.00 m, -, ").is_some());
        harness.get_by_label("Better ones only").click();
        harness.run();
        assert_eq!(listed(&harness), [1, 3, 5]);
        harness.get_by_label_contains("Generation 3").click();
        harness.run();
        let command = Command::Stage(StageCommand::Show(Pick::Generation(3)));
        assert_eq!(*harness.state(), [command]);
    }
    #[test]
    fn of_a_run_whose_stairs_evolve_only_generations_with_a_champion_are_listed() {
        let mut settings = Settings::default();
        settings.evolution.population = 4;
        settings.trial.duration_s = 0.5;
        let mut experiment = Experiment::new(RunPlan::new("test", 1, settings));
        let pool = LocalPool::new(1).expect("threads");
        let first = experiment.run_generation(&pool, &RunControl::default()).expect("done");
        let stairs = snakes_core::save::StairsCount {
            rounds: 1,
            all: 1,
            active: 1,
            solved: 0,
            challenges: 0,
        };
        let report = |generation: u32| {
            let mut report = GenerationReport { generation, stairs: Some(stairs), ..first.clone() };
            report.champion = report.champion.filter(|_| generation != 2).map(|mut champion| {
                champion.origin.generation = generation;
                champion
            });
            report
        };
        let reports = [1, 2, 3].map(report);
        let mut panel = ChampionsPanel::default();
        let mut harness = Harness::builder().with_size(egui::vec2(360.0, 400.0)).build_ui_state(
            |ui, commands: &mut Vec<Command>| {
                panel.ui(ui, &[], &reports, &[], |_| 2, false, commands);
            },
            Vec::new(),
        );
        harness.run();
        for (name, is_listed) in
            [("Generation 1", true), ("Generation 2", false), ("Generation 3", true)]
        {
            assert_eq!(harness.query_by_label_contains(name).is_some(), is_listed, "{name}");
        }
        assert!(harness.query_by_label_contains("disqualified").is_none());
    }
}
