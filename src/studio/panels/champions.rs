//! The best of every generation, the latest first, to click and replay.

use bevy_egui::egui;

use super::{explain, row};
use crate::evolve::{Champion, Origin};
use crate::run::GenerationReport;
use crate::studio::casting::{Pick, Saved};
use crate::studio::command::Command;
use crate::studio::exhibit::{Exhibit, Source};

/// What of the list is on the stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shown {
    /// A champion that the studio opened with; the first is 0.
    Opening(usize),
    /// This individual of the current run.
    Found {
        /// The generation that found it; the first is 1.
        generation: u32,
        /// Its index in that generation.
        individual: u32,
    },
}

impl Shown {
    /// How an exhibit is listed, if it is; `run` is the number of the current run.
    pub(super) fn of(exhibit: &Exhibit, run: u32) -> Option<Self> {
        match exhibit.source() {
            Source::Opening(index) => Some(Self::Opening(index)),
            Source::Run(of) if of == run => {
                let Origin { generation, individual, .. } = exhibit.champion().origin;
                Some(Self::Found { generation, individual })
            }
            Source::Library(_) | Source::Run(_) | Source::Lesson => None,
        }
    }

    /// Whether it is this individual of the current run.
    pub(super) fn is(self, generation: u32, individual: u32) -> bool {
        self == Self::Found { generation, individual }
    }
}

/// The list.
#[derive(Debug, Default)]
pub(super) struct ChampionsPanel {
    /// What it knows of the reports, and of which these are: how many, and the hash of the latest.
    known: Option<((usize, u64), Known)>,
}

/// What is found out once for each new report, not in every frame.
#[derive(Debug, Clone, Copy)]
struct Known {
    /// How many generations have a champion.
    champions: usize,
    /// The generation of the best of all.
    best: Option<u32>,
}

impl Known {
    fn of(reports: &[GenerationReport]) -> Self {
        let known = reports.iter().filter_map(|report| report.champion.as_ref());
        let fitness = |champion: &Champion| champion.evaluation.fitness;
        // Of equals, the first that was found.
        let best = known.clone().rev().max_by(|a, b| fitness(a).total_cmp(&fitness(b)));
        Self { champions: known.count(), best: best.map(|champion| champion.origin.generation) }
    }
}

impl ChampionsPanel {
    /// Draws the list and adds what was asked for.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        opening: &[Saved],
        reports: &[GenerationReport],
        shown: &[Shown],
        leaders: impl Fn(Option<u32>) -> usize,
        asked: &mut Vec<Command>,
    ) {
        let Known { champions, best } = self.follow(reports);
        ui.horizontal(|ui| {
            for (name, hint, is_on, command) in [
                (
                    "Race generations",
                    "The generations' champions side by side (N)",
                    champions > 1,
                    Command::RaceGenerations,
                ),
                (
                    "Race top ten",
                    "The best of the latest generation, side by side (M)",
                    leaders(None) > 1,
                    Command::RaceLeaders(None),
                ),
            ] {
                let button = egui::Button::new(name);
                let not_yet = "There is no such race yet";
                let response = ui.add_enabled(is_on, button).on_hover_text(hint);
                if response.on_disabled_hover_text(not_yet).clicked() {
                    asked.push(command);
                }
            }
        });
        if reports.is_empty() {
            explain(ui, "The best of each generation will appear here.");
        }
        let height = ui.spacing().interact_size.y;
        let rows = opening.len() + reports.len();
        let area = egui::ScrollArea::vertical().auto_shrink(false);
        // Only those that are seen are drawn: there may be thousands.
        area.show_rows(ui, height, rows, |ui, seen| {
            for index in seen {
                if let Some(saved) = opening.get(index) {
                    let name = if opening.len() == 1 { "Saved" } else { &saved.name };
                    let is_shown = shown.contains(&Shown::Opening(index));
                    let champion = &saved.loaded.champion;
                    entry(ui, is_shown, name, champion, Pick::Opening(index), None, asked);
                    continue;
                }
                // The latest first: that is what one waits for.
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
                entry(ui, is_shown, &name, champion, pick, race, asked);
            }
        });
    }
}

impl ChampionsPanel {
    fn follow(&mut self, reports: &[GenerationReport]) -> Known {
        let now = (reports.len(), reports.last().map_or(0, |report| report.hash));
        match self.known {
            Some((then, known)) if then == now => known,
            _ => self.known.insert((now, Known::of(reports))).1,
        }
    }
}

/// A row for somebody: a click shows it alone, one with Shift or Control puts it beside those on the stage; its menu
/// lets the next run begin from it, and the best ten of its generation race, if they can.
fn entry(
    ui: &mut egui::Ui,
    is_shown: bool,
    name: &str,
    champion: &Champion,
    pick: Pick,
    race: Option<u32>,
    asked: &mut Vec<Command>,
) {
    let response = row(ui, is_shown, name, &champion.reached()).on_hover_ui(|ui| {
        // What tells those apart that came equally far.
        if let Some(effort) = champion.evaluation.effort {
            let (energy_kj, speed_m_s) = (effort.energy_j / 1000.0, effort.top_speed_m_s);
            ui.label(format!("Spent {energy_kj:.1} kJ, and was {speed_m_s:.1} m/s fast at most"));
        }
        ui.label("Click to replay; with Shift, beside what is on the stage; right click for more");
    });
    if response.clicked() {
        let joins = ui.input(|input| input.modifiers.shift || input.modifiers.command);
        asked.push(if joins { Command::Join(pick) } else { Command::Show(pick) });
    }
    response.context_menu(|ui| {
        let found = ui.button("Begin the next run from it");
        let hint = "The first generation descends from it, in its own world";
        if found.on_hover_text(hint).clicked() {
            asked.push(Command::Found(pick));
            ui.close();
        }
        if let Some(generation) = race
            && ui.button("Race its best ten").clicked()
        {
            asked.push(Command::RaceLeaders(Some(generation)));
            ui.close();
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::{RunPlan, Settings};
    use crate::run::{Control, Experiment, pool};
    use crate::save::shipped_champion;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn the_best_is_found_anew_when_there_is_another_report_and_in_another_run() {
        let mut settings = Settings::default();
        settings.evolution.population = 4;
        settings.trial.duration_s = 0.5;
        let pool = pool(1).expect("a pool");
        let run = |seed| {
            let mut experiment = Experiment::new(RunPlan::new("test", seed, settings.clone()));
            let mut report =
                || experiment.run_generation(&pool, &Control::default()).expect("done");
            [report(), report(), report()]
        };
        let (first, second) = (run(1), run(2));
        let mut panel = ChampionsPanel::default();
        for reports in [&first[..0], &first[..1], &first[..], &second[..], &first[..2]] {
            let known = panel.follow(reports);
            let expected = Known::of(reports);
            assert_eq!((known.champions, known.best), (expected.champions, expected.best));
        }
    }

    #[test]
    fn a_click_on_a_generation_shows_its_champion() {
        let mut settings = Settings::default();
        settings.evolution.population = 4;
        settings.trial.duration_s = 0.5;
        let mut experiment = Experiment::new(RunPlan::new("test", 1, settings));
        let pool = pool(1).expect("a pool");
        let mut report = || experiment.run_generation(&pool, &Control::default()).expect("done");
        let reports = [report(), report()];
        let loaded = shipped_champion().expect("well formed");
        let opening = [Saved { name: "climber".to_owned(), loaded }];
        let mut panel = ChampionsPanel::default();
        let mut harness = Harness::new_ui_state(
            |ui, asked| {
                panel.ui(ui, &opening, &reports, &[Shown::Opening(0)], |_| 2, asked);
            },
            Vec::new(),
        );
        harness.get_by_label_contains("Generation 2").click();
        harness.run();
        assert_eq!(*harness.state(), [Command::Show(Pick::Generation(2))]);
        harness.state_mut().clear();
        harness.get_by_label_contains("Generation 1").click_modifiers(egui::Modifiers::SHIFT);
        harness.run();
        harness.get_by_label("Race generations").click();
        harness.run();
        let asked = [Command::Join(Pick::Generation(1)), Command::RaceGenerations];
        assert_eq!(*harness.state(), asked);
    }
}
