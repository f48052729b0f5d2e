//! The panel to watch a run: progress, start, pause, single generation and new run, the most important settings, and all
//! others below a fold.

pub mod progress;

use bevy_egui::egui;

use super::settings::Sheet;
use crate::studio::commands::panel::PanelKind;
use crate::studio::commands::{Command, PlanCommand, RunCommand, WindowCommand};
use crate::studio::state::current_run::{CurrentRun, ListedRun, RunStatus, UnreadableRun, news_of};
use crate::studio::ui::buttons::{CommandButton, accent_button};
use crate::studio::ui::number_field::NumberField;
use crate::studio::ui::text_rows::{explain, folded, problem, row, title_text, weak};
use crate::studio::ui::theme;
use snakes_core::evolve::EvolutionSettings;
use snakes_core::genome::GenomeSpace;
use snakes_core::schema::Section;
use snakes_lab::run::THREADS_RANGE;

use progress::progress;

/// The Run panel, with its text fields.
#[derive(Debug, Default)]
pub(super) struct EvolutionPanel {
    seed: NumberField,
    threads: NumberField,
    /// Controls of the settings.
    pub sheet: Sheet,
}

impl EvolutionPanel {
    /// Draws the panel and sends the user's commands.
    /// `chart` draws the small chart below the progress.
    pub fn ui(&mut self, ui: &mut egui::Ui, run: &CurrentRun, chart: impl FnOnce(&mut egui::Ui)) {
        self.sheet.begin(ui, run);
        progress(ui, run);
        // A click on a button also ends typing in a field. The typed value must be sent before the button's command.
        let pressed = self.buttons(ui, run);
        founder(ui, run);
        chart(ui);
        more_views(ui);
        self.knobs(ui);
        let label = title_text(METHOD);
        if self.sheet.fold(ui, METHOD_KEY, label, METHOD) {
            self.method_of_evolution(ui, run);
        } else {
            next_run(ui, run);
        }
        earlier_runs(ui, run);
        self.sheet.send(ui);
        Command::send_all(pressed, ui);
    }

    /// Draws the settings that the program is for: friction, height of the steps, limits of the joints, and the size of
    /// mutations in the selected strategy.
    fn knobs(&mut self, ui: &mut egui::Ui) {
        let fixed = ["trial.surface.friction", "trial.stairs.rise_m", "trial.agent.bend_limit_rad"];
        for path in fixed {
            self.sheet.knob(ui, |of| of == path);
        }
        let of_mutation =
            ["step", "mutation_step", "mutation_range_nm", "first_step", "weight_step"];
        self.sheet.knob(ui, |path| {
            let name = path.rsplit('.').next().unwrap_or_default();
            path.starts_with("evolution.") && of_mutation.contains(&name)
        });
    }

    /// Draws the buttons of the run. Returns the command of a clicked one.
    fn buttons(&self, ui: &mut egui::Ui, run: &CurrentRun) -> Option<Command> {
        let is_wrong = self.seed.problem.is_some() || self.sheet.has_problem();
        let status = run.status();
        let is_finished = status == RunStatus::Finished;
        let differs = run.next_run_differs();
        let (longer, hint) = (run.extension_in_words(), "Evolve in the background, or pause");
        let first = match status {
            RunStatus::Running => ("Pause evolution", hint, RunCommand::Pause),
            RunStatus::Ready => ("Start evolution", hint, RunCommand::Start),
            RunStatus::Paused => ("Continue evolution", hint, RunCommand::Start),
            RunStatus::Finished => (longer.as_str(), "Evolve this run further", RunCommand::Extend),
        };
        let single = "Finish one generation, then pause";
        let single = ("One generation", single, RunCommand::SingleGeneration);
        let wrong = Some("Correct the invalid value below first").filter(|_| is_wrong);
        let shown = if is_finished { 1 } else { 2 };
        let wide = egui::vec2(theme::GAP * 10.0, 0.0);
        let button = |ui: &egui::Ui, label: &str, is_first: bool| match is_first {
            true => accent_button(ui, label).min_size(wide),
            false => egui::Button::new(label),
        };
        let new_hint = match differs {
            true => "Start a run with the changed settings; the current run stays saved",
            false => "Start a run with the next seed; the current run stays saved",
        };
        let row = ui.horizontal_wrapped(|ui| {
            let mut pressed = None;
            for (index, (label, hint, command)) in
                [first, single].into_iter().take(shown).enumerate()
            {
                let button = button(ui, label, index == 0 && !is_finished);
                let button = CommandButton::of(button, hint, Command::Run(command));
                pressed = button.pressed(ui).or(pressed);
            }
            let button = button(ui, "New run", is_finished && !is_wrong);
            let new = CommandButton::of(button, new_hint, Command::Run(RunCommand::New));
            new.unless(wrong).pressed(ui).or(pressed)
        });
        row.inner
    }

    /// Draws strategy, controller, size of the run, seed and threads.
    fn method_of_evolution(&mut self, ui: &mut egui::Ui, run: &CurrentRun) {
        preset_switch(ui, run);
        ui.horizontal(|ui| {
            let hint = "The same seed and settings always give the same run, bit for bit";
            let seed = self.seed.ui(ui, "Seed", hint, run.plan_next.seed, 0..=u64::MAX);
            Command::send_all(seed.map(|seed| Command::Plan(PlanCommand::SetSeed(seed))), ui);
            let hint = "Number of snakes evaluated at the same time. More threads than processor cores are no \
                        faster. The result does not depend on it";
            let threads = self.threads.ui(ui, "Threads", hint, run.threads(), THREADS_RANGE);
            let threads = threads.map(|threads| Command::Run(RunCommand::SetThreads(threads)));
            Command::send_all(threads, ui);
        });
        for reason in [&self.seed.problem, &self.threads.problem].into_iter().flatten() {
            problem(ui, reason);
        }
        self.sheet.section(ui, EvolutionSettings::RUN);
        self.sheet.send(ui);
        changes(ui, run);
        next_run(ui, run);
        if let Some(hash) = run.hash_in_words() {
            let hint = "Fingerprint of all results of the run. The same seed and settings give the same hash \
                        on every computer with an Intel or AMD processor (x86-64)";
            ui.label(weak(ui, hash)).on_hover_text(hint);
        }
        self.strategy(ui, run);
        self.controller(ui);
        self.sheet.send(ui);
    }

    /// Draws the selection of the strategy, with the settings of the selected strategy and of all others.
    fn strategy(&mut self, ui: &mut egui::Ui, run: &CurrentRun) {
        self.sheet.section(ui, EvolutionSettings::STRATEGY);
        let common = [EvolutionSettings::RUN, EvolutionSettings::STRATEGY];
        let sections = self.sheet.sections("evolution.").into_iter();
        let (used, others): (Vec<Section>, Vec<Section>) = sections
            .filter(|section| !common.contains(section))
            .partition(|section| self.is_used(*section));
        let selected = format!("evolution.{}.", run.next_settings().evolution.strategy);
        let own = self.sheet.sections(&selected);
        for section in &own {
            self.folded(ui, *section, true);
        }
        for section in used.into_iter().filter(|section| !own.contains(section)) {
            self.folded(ui, section, false);
        }
        let header = egui::CollapsingHeader::new("Other strategies");
        let shown = header.show(ui, |ui| {
            for section in others {
                self.folded(ui, section, false);
            }
        });
        shown.header_response.on_hover_text("Settings of the strategies that are not selected");
    }

    /// Draws the selection of the controller, with the ranges of the genome.
    fn controller(&mut self, ui: &mut egui::Ui) {
        self.sheet.section(ui, GenomeSpace::CONTROLLER);
        let sections = self.sheet.sections("genome.").into_iter();
        for section in sections.filter(|section| *section != GenomeSpace::CONTROLLER) {
            self.folded(ui, section, false);
        }
    }

    /// Returns whether a setting of a section has an effect with the selected strategy and controller.
    fn is_used(&self, section: Section) -> bool {
        self.sheet.in_section(section).any(|listed| listed.is_used)
    }

    /// Draws a section that its header unfolds.
    fn folded(&mut self, ui: &mut egui::Ui, section: Section, is_open: bool) {
        // Sections of the genome that the selected controller does not use have a dim title.
        let is_of_genome =
            self.sheet.in_section(section).any(|listed| listed.path.starts_with("genome."));
        let is_unused = is_of_genome && !self.is_used(section);
        let name = match is_unused {
            true => weak(ui, section.title),
            false => egui::RichText::new(section.title),
        };
        // The ID includes `is_open`, so that the section of a newly selected strategy is open, even if it was folded
        // among the others.
        let header = egui::CollapsingHeader::new(name)
            .id_salt((section.title, is_open))
            .default_open(is_open);
        folded(ui, header, section.about, |ui| {
            if is_unused {
                explain(ui, "The selected controller does not use these settings.");
            }
            self.sheet.section(ui, section);
        });
    }
}

/// Title of the fold with all other settings of the run.
const METHOD: &str = "Method of evolution";
/// Name by which the preferences know whether that fold is open.
const METHOD_KEY: &str = "How it learns";

/// Draws the buttons that open the panels with more about the run.
fn more_views(ui: &mut egui::Ui) {
    ui.horizontal(|ui| {
        for (label, kind) in
            [("More charts", PanelKind::Charts), ("Champions", PanelKind::Champions)]
        {
            let open = Command::Window(WindowCommand::OpenPanel(kind));
            CommandButton::new(label, kind.hint_with_key(), open).small().show(ui);
        }
    });
}

/// Draws that the next run has other settings than the current one, if it has.
fn next_run(ui: &mut egui::Ui, run: &CurrentRun) {
    if run.next_run_differs() {
        let hint = "These settings will be used by the next run. Press New run to start it.";
        ui.label(egui::RichText::new(hint).color(theme::of(ui).second));
    }
}

/// Draws the name of the snake from which a new run starts, if any, with a button for a run from scratch.
fn founder(ui: &mut egui::Ui, run: &CurrentRun) {
    let Some(name) = run.next_founder() else { return };
    ui.horizontal_wrapped(|ui| {
        ui.label(format!("\"New run\" starts from \"{name}\""));
        let hint = "Create the first generation of the next run at random";
        let forget = Command::Plan(PlanCommand::ForgetFounder);
        CommandButton::new("Start from scratch", hint, forget).small().show(ui);
    });
}

/// Draws how many settings were changed during the current run, and lists the latest changes in a tooltip.
fn changes(ui: &mut egui::Ui, run: &CurrentRun) {
    let changes = run.plan_now.changes.made();
    let text = match changes.len() {
        0 => return,
        1 => "1 setting changed during the run".to_owned(),
        several => format!("{several} settings changed during the run"),
    };
    let label = ui.label(egui::RichText::new(text).color(theme::of(ui).second));
    label.on_hover_ui(|ui| {
        let latest = &changes[changes.len().saturating_sub(MAX_LISTED_CHANGES)..];
        let lines: Vec<String> = latest.iter().map(news_of).collect();
        ui.label(lines.join("\n"));
    });
}

/// Maximum number of changes that the tooltip lists.
const MAX_LISTED_CHANGES: usize = 12;

/// Draws the button that starts the experiment of the report or, if that is the next run, one of the standard climb.
fn preset_switch(ui: &mut egui::Ui, run: &CurrentRun) {
    let (label, preset, hint) = if run.plan_next.preset == REPORT {
        ("Run the standard climb", CLIMB, "Start a run that climbs to the landing")
    } else {
        (
            "Run the report's experiment",
            REPORT,
            "Start a run with the method and the world of the report \"Evolution of Artificial Creatures in Stair \
             Climbing\"",
        )
    };
    if ui.button(label).on_hover_text(hint).clicked() {
        Command::Plan(PlanCommand::SetPreset(preset.to_owned())).send(ui);
        Command::Run(RunCommand::New).send(ui);
    }
}

/// Name of the preset of the original experiment.
const REPORT: &str = "report";
/// Name of the preset of the standard climb to the landing.
const CLIMB: &str = "climb";

/// Draws the list of other runs, which can be resumed or, if they are finished, continued for more generations.
fn earlier_runs(ui: &mut egui::Ui, run: &CurrentRun) {
    let header = egui::CollapsingHeader::new("Open an earlier run");
    let opened = header.show(ui, |ui| {
        let Some(listed) = run.listed() else {
            return explain(ui, "Loading…");
        };
        let mut earlier = listed.filter(|of| of.run.finished > 0).peekable();
        for UnreadableRun { problem, .. } in &run.others.unreadable {
            explain(ui, &format!("A run cannot be read: {problem}"));
        }
        if earlier.peek().is_none() && run.others.unreadable.is_empty() {
            explain(ui, "There are no other runs.");
        }
        for ListedRun { run: summary, name, .. } in earlier {
            let generations = summary.generations_in_words();
            let behind = generations.trim_end_matches(" generations");
            let hint = format!(
                "{generations} are finished. The current run stays saved.\n{}",
                summary.folder.display()
            );
            if row(ui, name, behind).on_hover_text(hint).clicked() {
                Command::Run(RunCommand::Continue(summary.folder.clone())).send(ui);
            }
        }
    });
    if opened.header_response.clicked() {
        Command::Run(RunCommand::ListRuns).send(ui);
    }
}

#[cfg(test)]
mod tests;
