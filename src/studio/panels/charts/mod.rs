//! Charts of a run: fitness, distribution, ancestors, search results and comparisons. Charts have hover texts, replay
//! snakes on click, and can be exported.

mod ancestors;
mod archive_map;
mod archive_pictures;
mod band_kinds;
mod bands;
mod bodies;
mod chart_kind;
mod downsample;
mod draw;
mod fitness;
mod learning_curves;
mod legend;
mod parents;
mod pareto_front;
mod runs;
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
use crate::studio::ui::buttons::CommandButton;
use crate::studio::ui::text_rows::{explain, title, title_and};
use crate::studio::ui::theme;
use snakes_core::save::StudyRuns;

use band_kinds::{BLOCKS, ENDINGS, SPECIES};
use chart_kind::ChartKind;
use learning_curves::CurvesPanel;
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

    /// Draws the panel and sends the user's commands. `selected` is the selected snake on the stage.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        run: &CurrentRun,
        shown: &[ShownLane],
        selected: Option<&StagedChampion>,
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
                let choice = ui.selectable_value(&mut self.kind, kind, kind.name());
                choice.on_hover_text(kind.hint());
            }
        });
        let tallest = ui.available_width() * theme::MAX_CHART_ASPECT;
        let height = (ui.available_height() - theme::CHART_CONTROLS_HEIGHT)
            .min(tallest)
            .max(theme::PLOT_HEIGHT);
        let kind = self.kind;
        let (view, shown) = match kind {
            ChartKind::Methods => {
                if let Some(curves) = &mut self.curves {
                    header(ui, &curves.view, kind);
                    curves.ui(ui, height);
                }
                return;
            }
            ChartKind::Torques => {
                let known = self.torques.update(run, selected);
                let view = known.map_err(str::to_owned);
                let view = view.and_then(|()| self.torques.view().ok_or_else(|| kind.empty_text()));
                // No individual is highlighted, because the chart shows only the selected snake.
                (view, &[][..])
            }
            _ => {
                let version = run.version();
                if !matches!(&self.known, Some((of, at, _)) if (*of, *at) == (kind, version)) {
                    self.known = Some((kind, version, view_of(kind, run)));
                }
                let view = self.known.as_ref().and_then(|(.., view)| view.as_ref());
                let view = view.filter(|view| !view.figure.is_empty());
                let reason = || match kind {
                    ChartKind::Front if run.exploration().is_some() => {
                        "No snake has ended ahead of its starting position yet.".to_owned()
                    }
                    _ => kind.empty_text(),
                };
                (view.ok_or_else(reason), shown)
            }
        };
        match view {
            Ok(view) => {
                header(ui, view, kind);
                draw::draw(ui, kind.name(), view, height, shown);
            }
            Err(why) => {
                title(ui, kind.name());
                explain(ui, &why);
            }
        }
        if kind == ChartKind::Runs {
            if !self.has_listed_runs {
                self.has_listed_runs = true;
                Command::Run(RunCommand::ListRuns).send(ui);
            }
            runs::run_list(ui, run);
        }
    }
}

/// The fitness chart of the Watch panel, cached.
#[derive(Default)]
pub(super) struct FitnessChart {
    known: Option<(Version, ChartView)>,
}

impl FitnessChart {
    /// Draws the chart `height` points high, and sends the user's commands.
    pub fn ui(&mut self, ui: &mut egui::Ui, run: &CurrentRun, height: f32, shown: &[ShownLane]) {
        let version = run.version();
        if !matches!(&self.known, Some((at, _)) if *at == version) {
            self.known = Some((version, fitness::view(run.settings(), &run.reports)));
        }
        let Some((_, view)) = &self.known else { return };
        draw::draw(ui, "fitness alone", view, height, shown);
    }
}

/// Computes the view of a chart, if there is data for it.
fn view_of(kind: ChartKind, run: &CurrentRun) -> Option<ChartView> {
    let settings = run.settings();
    let exploration = run.exploration();
    match kind {
        ChartKind::Fitness => Some(fitness::view(settings, &run.reports)),
        ChartKind::Spread => Some(spread::view(settings, exploration?.generation.as_ref()?)),
        ChartKind::Endings => Some(bands::view(ENDINGS, settings, &run.reports)),
        ChartKind::Species => Some(bands::view(SPECIES, settings, &run.reports)),
        ChartKind::Blocks => Some(bands::view(BLOCKS, settings, &run.reports)),
        ChartKind::Bodies => {
            Some(bodies::view(settings, &run.reports, exploration.map(|of| &of.ancestry)))
        }
        ChartKind::Stairs => Some(stairs::view(
            settings.evolution.strategy,
            &run.reports,
            exploration?.stairs.as_ref()?,
        )),
        ChartKind::Front => Some(pareto_front::view(settings, &exploration?.front)),
        ChartKind::Archive => Some(archive_map::view(settings, exploration?.archive.as_ref()?)),
        ChartKind::Ancestors => {
            let founder = run.plan_now.founder.as_ref().map(|founder| founder.name());
            Some(ancestors::view(settings, &exploration?.ancestry, founder))
        }
        ChartKind::Parents => parents::view(settings, &exploration?.parents),
        ChartKind::Runs => Some(runs::view(run)),
        ChartKind::Torques | ChartKind::Methods => None,
    }
}

/// Draws the title of a chart and its export buttons.
fn header(ui: &mut egui::Ui, view: &ChartView, kind: ChartKind) {
    let ChartView { figure, is_of_run, .. } = view;
    let refusal = figure.is_empty().then_some("The chart is still empty");
    title_and(ui, &figure.title, |ui| {
        for (label, hint, format) in [
            ("CSV", "Save the numbers as a table", ChartFormat::Csv),
            ("PNG", "Save the chart as a picture of 1600 by 900 pixels", ChartFormat::Png),
        ] {
            let (figure, name) = (Arc::clone(figure), kind.name().to_lowercase());
            let export = ChartExport { figure, name, format, is_of_run: *is_of_run };
            let export = Command::Run(RunCommand::ExportChart(export));
            CommandButton::new(label, hint, export).small().unless(refusal).show(ui);
        }
    });
}

#[cfg(test)]
mod tests;
