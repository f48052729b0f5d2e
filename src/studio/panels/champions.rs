//! Best snake of every generation, the newest first. A click replays a snake.

mod climbs;
mod columns;
mod summary;

use bevy_egui::egui;

use super::shown::ShownLane;
use crate::studio::commands::pick::Pick;
use crate::studio::commands::{Command, PlanCommand, StageCommand};
use crate::studio::ui::buttons::{CommandButton, command_box, show_or_join};
use crate::studio::ui::check_box::check_box;
use crate::studio::ui::text_rows::explain;
use crate::studio::ui::theme;
use snakes_core::evolve::{Champion, IndividualId};
use snakes_core::save::LoadedChampion;
use snakes_lab::run::GenerationReport;

use climbs::{Climb, Climbs, landed_s};
use columns::{cells, heads};
use summary::ReportSummary;

/// The champions panel: the list, and its options.
#[derive(Default)]
pub(super) struct ChampionsPanel {
    /// Cached summary of the reports. The number of reports and the hash of the latest are its key.
    summary: Option<((usize, u64), ReportSummary)>,
    /// Whether only generations are listed that were better than all earlier ones.
    lists_better_only: bool,
    climbs: Climbs,
}

/// State that the champions panel shows.
pub(super) struct ChampionsView<'v> {
    /// Champions with which the studio was opened.
    pub opening: &'v [(String, LoadedChampion)],
    /// Reports of the run's finished generations.
    pub reports: &'v [GenerationReport],
    /// Champions of the list that are on the stage.
    pub shown: &'v [ShownLane],
    /// Returns how many of the best snakes of a generation can race; `None` is the latest generation.
    pub leaders: &'v dyn Fn(Option<u32>) -> usize,
    /// Whether the stage shows each better generation automatically; `None` if no better one can come.
    pub follows: Option<bool>,
}

impl ChampionsView<'_> {
    /// Returns whether the run keeps only the snakes that beat those of all earlier generations.
    fn has_better_only(&self) -> bool {
        self.reports.first().is_some_and(|report| report.stairs.is_some())
    }

    /// Returns the lane of a champion of the list, if the champion is on the stage.
    fn lane_of(&self, champion: Pick) -> Option<&ShownLane> {
        self.shown.iter().find(|shown| shown.champion == champion)
    }
}

impl ChampionsPanel {
    /// Draws the list and sends the user's commands.
    pub fn ui(&mut self, ui: &mut egui::Ui, view: &ChampionsView) {
        let summary = self.summary(view.reports);
        self.climbs.poll();
        let no_generation = Some("Nothing to show yet: finish a generation first")
            .filter(|_| (view.leaders)(None) <= 1);
        let one_of = |champions: usize| {
            Some("Nothing to show yet: finish two generations first").filter(|_| champions <= 1)
        };
        ui.horizontal_wrapped(|ui| {
            for (name, hint, refusal, command) in [
                (
                    "Whole generation",
                    "Show all snakes of the latest generation at once",
                    no_generation,
                    StageCommand::ShowGeneration(None),
                ),
                (
                    "Story",
                    "Play the first, the middle and the latest of the better generations",
                    one_of(summary.better.len()),
                    StageCommand::TellStory,
                ),
                (
                    "Race generations",
                    "Replay champions of several generations side by side",
                    one_of(summary.champions),
                    StageCommand::RaceGenerations,
                ),
                (
                    "Race best 10",
                    "Replay the ten best snakes of the latest generation side by side",
                    no_generation,
                    StageCommand::RaceLeaders(None),
                ),
            ] {
                CommandButton::new(name, hint, Command::Stage(command)).unless(refusal).show(ui);
            }
        });
        ui.horizontal_wrapped(|ui| {
            follow_box(ui, view.follows);
            let name = "Better ones only";
            if view.has_better_only() {
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
        if view.reports.is_empty() {
            explain(ui, "The best snake of each generation will appear here.");
        }
        self.list(ui, view, &summary);
    }

    /// Draws the rows: first the champions with which the studio was opened, then the generations, the newest first.
    fn list(&mut self, ui: &mut egui::Ui, view: &ChampionsView, summary: &ReportSummary) {
        let better = (self.lists_better_only || view.has_better_only()).then_some(&summary.better);
        let listed = better.map_or(view.reports.len(), |better| better.len());
        // Room beside the rows is reserved for the scroll bar, so that the columns do not move when it appears.
        let width = ui.available_width() - ui.spacing().scroll.allocated_width();
        heads(ui, width);
        let (height, rows) = (theme::CHAMPION_ROW_HEIGHT, view.opening.len() + listed);
        let area = egui::ScrollArea::vertical().auto_shrink(false);
        // A run may have thousands of generations, so only visible rows are drawn.
        area.show_rows(ui, height, rows, |ui, seen| {
            ui.set_max_width(width);
            for index in seen {
                if let Some((name, loaded)) = view.opening.get(index) {
                    let row = ChampionRow {
                        shown: view.lane_of(Pick::Opened(index)),
                        name,
                        champion: &loaded.champion,
                        climb: self.climbs.of_save(loaded),
                        pick: Pick::Opened(index),
                        race: None,
                    };
                    row.ui(ui);
                    continue;
                }
                let from_end = listed - 1 - (index - view.opening.len());
                let place = better.map_or(from_end, |better| better[from_end]);
                let Some(report) = view.reports.get(place) else { continue };
                let generation = report.generation;
                let name = format!("Generation {generation}");
                let Some(champion) = &report.champion else {
                    let cells = ["disqualified", "-", "-"].map(str::to_owned);
                    let hint = "All snakes of this generation were disqualified";
                    columns::row(ui, None, None, &name, &cells).on_hover_text(hint);
                    continue;
                };
                let individual = champion.origin.individual;
                let found = Pick::Individual(IndividualId { generation, individual });
                let mark = summary.best.filter(|(best, _)| *best == generation);
                let row = ChampionRow {
                    shown: view.lane_of(found),
                    name: &mark.map_or(name.clone(), |(_, mark)| format!("{name}, {mark}")),
                    champion,
                    climb: self.climbs.of(champion),
                    pick: Pick::Generation(generation),
                    race: ((view.leaders)(Some(generation)) > 1).then_some(generation),
                };
                row.ui(ui);
            }
        });
    }

    fn summary(&mut self, reports: &[GenerationReport]) -> ReportSummary {
        let now = (reports.len(), reports.last().map_or(0, |report| report.hash));
        match &self.summary {
            Some((key, summary)) if *key == now => summary.clone(),
            _ => self.summary.insert((now, ReportSummary::of(reports))).1.clone(),
        }
    }
}

/// Command of the check box for following evolution.
pub(super) const FOLLOW_COMMAND: Command = Command::Stage(StageCommand::ToggleFollowEvolution);

/// Draws the check box for following evolution, unless no better generation can come.
pub(super) fn follow_box(ui: &mut egui::Ui, follows: Option<bool>) {
    if let Some(is_on) = follows {
        let words = ("Follow evolution", "Show each better generation as soon as it is found");
        command_box(ui, is_on, words, FOLLOW_COMMAND);
    }
}

/// A row of the champions list.
struct ChampionRow<'r> {
    /// Lane of the champion, if the champion is on the stage.
    shown: Option<&'r ShownLane>,
    name: &'r str,
    champion: &'r Champion,
    climb: Option<&'r Climb>,
    pick: Pick,
    /// Generation of the champion, if its ten best snakes can race.
    race: Option<u32>,
}

impl ChampionRow<'_> {
    /// Draws the row. A click shows the champion alone; a click with Shift or Control adds the champion to the stage.
    /// The context menu starts the next run from the champion, or races the ten best snakes of its generation.
    fn ui(&self, ui: &mut egui::Ui) {
        let Self { shown, name, champion, climb, pick, .. } = *self;
        let time = landed_s(champion, climb);
        let picture = climb.map(|climb| &climb.picture);
        let response = columns::row(ui, shown, picture, name, &cells(champion, time));
        let response = response.on_hover_ui(|ui| {
            ui.label(format!("{name}: {}", champion.reached()));
            if let Ok(time_s) = time {
                ui.label(format!("Reached the top after {time_s:.2} s"));
            }
            if let Some(effort) = champion.evaluation.effort {
                let (energy_kj, speed_m_s) = (effort.energy_j / 1000.0, effort.top_speed_m_s);
                ui.label(format!("Energy {energy_kj:.1} kJ, top speed {speed_m_s:.1} m/s"));
            }
            ui.label("Click to replay. Shift-click to add it to the stage. Right-click for more.");
        });
        if response.clicked() {
            show_or_join(ui, pick).send(ui);
        }
        response.context_menu(|ui| {
            let hint = "The first generation descends from it, in the world where it was found";
            let start = Command::Plan(PlanCommand::StartFrom(pick));
            let start = CommandButton::new("Start the next run from this snake", hint, start);
            let race = self.race.map(|generation| {
                let command = Command::Stage(StageCommand::RaceLeaders(Some(generation)));
                CommandButton::new("Race best 10 of this generation", "", command)
            });
            for entry in std::iter::once(start).chain(race) {
                if entry.show(ui) {
                    ui.close();
                }
            }
        });
    }
}

#[cfg(test)]
mod tests;
