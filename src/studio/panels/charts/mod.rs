//! Charts of a run: fitness, distribution, ancestors, search results and comparisons. Charts have hover texts, replay
//! snakes on click, and can be exported.

mod ancestors;
mod archive_map;
mod archive_pictures;
mod bands;
mod blocks;
mod bodies;
mod chart_kind;
mod downsample;
mod draw;
mod fitness;
mod layer_labels;
mod learning_curves;
mod legend;
mod parents;
mod pareto_front;
mod runs;
mod species;
mod spread;
mod stairs;
mod torques;
mod view;

use std::sync::Arc;

use bevy_egui::egui;

use super::shown::ShownLane;
use crate::studio::commands::chart_export::{ChartExport, ChartFormat};
use crate::studio::commands::{Command, RunCommand};
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::state::current_run::CurrentRun;
use crate::studio::ui::text_rows::{explain, title, title_and};
use crate::studio::ui::theme;
use snakes_core::save::StudyRuns;
use snakes_lab::plot::Figure;

use blocks::BLOCKS;
use chart_kind::ChartKind;
use learning_curves::CurvesPanel;
use species::SPECIES;
use torques::TorqueComparison;
use view::{ChartView, Version};

/// The charts panel, with the selected chart.
#[derive(Default)]
pub(super) struct ChartsPanel {
    kind: ChartKind,
    known: Option<(ChartKind, Version, Option<ChartView>)>,
    torques: TorqueComparison,
    curves: Option<CurvesPanel>,
    has_listed_runs: bool,
}

impl ChartsPanel {
    /// Creates the panel, with an optional study of methods.
    pub fn new(comparison: Option<&StudyRuns>) -> Self {
        Self {
            // A study with which the program was started is shown first.
            kind: if comparison.is_some() { ChartKind::Methods } else { ChartKind::default() },
            curves: comparison.map(CurvesPanel::new),
            ..Self::default()
        }
    }

    /// Draws the panel and collects the user's commands. `selected` is the selected snake on the stage.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        run: &CurrentRun,
        shown: &[ShownLane],
        selected: Option<&StagedChampion>,
        commands: &mut Vec<Command>,
    ) {
        let strategy = run.settings().evolution.strategy;
        let has_study = self.curves.is_some();
        let is_offered = |kind: ChartKind| kind.is_offered(strategy, has_study);
        if !is_offered(self.kind) {
            self.kind = ChartKind::default();
        }
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = theme::GAP / 2.0;
            for kind in ChartKind::ALL.into_iter().filter(|kind| is_offered(*kind)) {
                let (name, hint) = kind.labels();
                ui.selectable_value(&mut self.kind, kind, name).on_hover_text(hint);
            }
        });
        let tallest = ui.available_width() * theme::MAX_CHART_ASPECT;
        let height = (ui.available_height() - theme::CHART_CONTROLS_HEIGHT)
            .min(tallest)
            .max(theme::PLOT_HEIGHT);
        match self.kind {
            ChartKind::Methods => self.methods(ui, height, commands),
            ChartKind::Torques => self.torques(ui, run, height, selected, commands),
            kind => self.run_chart(ui, run, kind, height, shown, commands),
        }
    }

    /// Draws a chart of the run's results.
    fn run_chart(
        &mut self,
        ui: &mut egui::Ui,
        run: &CurrentRun,
        kind: ChartKind,
        height: f32,
        shown: &[ShownLane],
        commands: &mut Vec<Command>,
    ) {
        if kind == ChartKind::Runs && !self.has_listed_runs {
            self.has_listed_runs = true;
            commands.push(Command::Run(RunCommand::ListRuns));
        }
        let version = run.version();
        if !matches!(&self.known, Some((of, at, _)) if (*of, *at) == (kind, version)) {
            self.known = Some((kind, version, view_of(kind, run)));
        }
        let view = self.known.as_ref().and_then(|(.., view)| view.as_ref());
        let view = view.filter(|view| !view.figure.is_empty()).ok_or_else(|| reason(kind, run));
        view_or_reason(ui, kind, view, height, shown, commands);
        if kind == ChartKind::Runs {
            runs::run_list(ui, run, commands);
        }
    }

    fn torques(
        &mut self,
        ui: &mut egui::Ui,
        run: &CurrentRun,
        height: f32,
        selected: Option<&StagedChampion>,
        commands: &mut Vec<Command>,
    ) {
        let view = self.torques.update(run, selected);
        let view = view.and_then(|()| self.torques.view().ok_or(ChartKind::Torques.empty_text()));
        // No individual is highlighted, because the chart shows only the selected snake.
        view_or_reason(ui, ChartKind::Torques, view, height, &[], commands);
    }

    fn methods(&mut self, ui: &mut egui::Ui, height: f32, commands: &mut Vec<Command>) {
        match &mut self.curves {
            Some(curves) => {
                header(ui, curves.figure(), (ChartKind::Methods, false), commands);
                curves.ui(ui, height);
            }
            None => {
                title(ui, "Comparison of methods");
                explain(ui, ChartKind::Methods.empty_text());
            }
        }
    }
}

/// Draws a chart, or the reason why it is empty.
fn view_or_reason(
    ui: &mut egui::Ui,
    kind: ChartKind,
    view: Result<&ChartView, &str>,
    height: f32,
    shown: &[ShownLane],
    commands: &mut Vec<Command>,
) {
    match view {
        Ok(view) => {
            header(ui, &view.figure, (kind, view.is_of_run), commands);
            draw::draw(ui, kind.labels().0, view, height, shown, commands);
        }
        Err(why) => {
            title(ui, kind.labels().0);
            explain(ui, why);
        }
    }
}

/// The fitness chart of the Watch panel, cached.
#[derive(Default)]
pub(super) struct FitnessChart {
    known: Option<(Version, ChartView)>,
}

impl FitnessChart {
    /// Draws the chart `height` points high, and collects the user's commands.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        run: &CurrentRun,
        height: f32,
        shown: &[ShownLane],
        commands: &mut Vec<Command>,
    ) {
        let version = run.version();
        if !matches!(&self.known, Some((at, _)) if *at == version) {
            self.known = Some((version, fitness::view(run.settings(), run.reports())));
        }
        let Some((_, view)) = &self.known else { return };
        draw::draw(ui, "fitness alone", view, height, shown, commands);
    }
}

/// Computes the view of a chart, if there is data for it.
fn view_of(kind: ChartKind, run: &CurrentRun) -> Option<ChartView> {
    let settings = run.settings();
    let exploration = run.exploration();
    match kind {
        ChartKind::Fitness => Some(fitness::view(settings, run.reports())),
        ChartKind::Spread => Some(spread::view(settings, exploration?.generation.as_ref()?)),
        ChartKind::Species => Some(bands::view(&SPECIES, settings, run.reports())),
        ChartKind::Blocks => Some(bands::view(&BLOCKS, settings, run.reports())),
        ChartKind::Bodies => {
            Some(bodies::view(settings, run.reports(), exploration.map(|of| &of.ancestry)))
        }
        ChartKind::Stairs => Some(stairs::view(
            run.settings().evolution.strategy,
            run.reports(),
            exploration?.stairs.as_ref()?,
        )),
        ChartKind::Front => Some(pareto_front::view(settings, &exploration?.front)),
        ChartKind::Archive => Some(archive_map::view(settings, exploration?.archive.as_ref()?)),
        ChartKind::Ancestors => Some(ancestors::view(settings, &exploration?.ancestry)),
        ChartKind::Parents => parents::view(settings, &exploration?.parents),
        ChartKind::Runs => Some(runs::view(run)),
        ChartKind::Torques | ChartKind::Methods => None,
    }
}

/// Returns the reason why a chart of the run is empty.
fn reason(kind: ChartKind, run: &CurrentRun) -> &'static str {
    match kind {
        ChartKind::Front if run.exploration().is_some() => {
            "No snake has ended ahead of its starting position yet."
        }
        _ => kind.empty_text(),
    }
}

/// Draws the title of a chart and its export buttons. `is_of_run` tells whether the chart is about the current run.
fn header(
    ui: &mut egui::Ui,
    figure: &Arc<Figure>,
    (kind, is_of_run): (ChartKind, bool),
    commands: &mut Vec<Command>,
) {
    let is_empty = figure.is_empty();
    title_and(ui, &figure.title, |ui| {
        for (label, hint, format) in [
            ("CSV", "Save the numbers as a table", ChartFormat::Csv),
            ("PNG", "Save the chart as a picture of 1600 by 900 pixels", ChartFormat::Png),
        ] {
            let button = ui.add_enabled(!is_empty, egui::Button::new(label).small());
            let not_yet = "The chart is still empty";
            if button.on_hover_text(hint).on_disabled_hover_text(not_yet).clicked() {
                let figure = Arc::clone(figure);
                commands.push(Command::Run(RunCommand::ExportChart(ChartExport {
                    figure,
                    name: kind.file_name(),
                    format,
                    is_of_run,
                })));
            }
        }
    });
}

#[cfg(test)]
mod tests;
