//! Chart that compares the current run with other saved runs.

use std::sync::Arc;

use bevy_egui::egui;

use super::fitness::{fitness_axis, generation_axis};
use super::view::{ChartHit, ChartView, HitShape};
use crate::studio::commands::{Command, RunCommand};
use crate::studio::state::current_run::{CurrentRun, ListedRun, MOST_COMPARED};
use crate::studio::ui::buttons::CommandButton;
use crate::studio::ui::text_rows::explain;
use crate::studio::ui::theme;
use snakes_core::evolve::{GenerationRecord, RunPlan, Statistics};
use snakes_core::save::settings_in_words;
use snakes_lab::plot::{Chart, Figure, Role, Series, Shape};

/// Colours of the other runs, in the order of their selection.
const ROLES: [Role; MOST_COMPARED] = [Role::Second, Role::Third, Role::Others];

/// Learning curves of a run.
struct Curves {
    name: Arc<str>,
    role: Role,
    /// Generation, best and median fitness of each finished generation.
    points: Vec<[f64; 3]>,
}

/// Creates the chart of the current run and of the selected other runs.
pub(super) fn view(run: &CurrentRun) -> ChartView {
    let fitness = run.settings().trial.fitness;
    let unit = fitness.unit();
    let point = |record: &GenerationRecord| {
        let Statistics { best, median, .. } = record.statistics?;
        Some([f64::from(record.generation), best, median])
    };
    let own = run.reports.iter().filter_map(|report| point(&report.record));
    let name =
        format!("this run ({}, seed {})", settings_in_words(&run.plan_now), run.plan_now.seed);
    let mut curves = vec![Curves { name: name.into(), role: Role::First, points: own.collect() }];
    let mut rewards_differ = false;
    for (compared, role) in run.others.compared.iter().zip(ROLES) {
        let Some(Ok(other)) = &compared.read else { continue };
        rewards_differ |= other.plan.settings.trial.fitness != fitness;
        let points = other.records.iter().filter_map(point);
        let mut name = title(&other.settings, &other.plan);
        if curves.iter().any(|known| *known.name == *name) {
            // The name of the folder distinguishes runs with the same preset and seed.
            name = format!("{name}, {}", compared.folder.file_name().unwrap_or_default().display());
        }
        curves.push(Curves { name: name.into(), role, points: points.collect() });
    }
    let values =
        curves.iter().flat_map(|of| &of.points).flat_map(|&[_, best, median]| [best, median]);
    let y = fitness_axis(fitness, values);
    let last = curves.iter().flat_map(|of| &of.points).map(|point| point[0]).fold(2.0, f64::max);
    let line = |of: &Curves, value: usize| -> Vec<[f64; 2]> {
        of.points.iter().map(|point| [point[0], point[value]]).collect()
    };
    let series = curves.iter().flat_map(|of| {
        let median =
            Series::new(&format!("{}: median", of.name), of.role, Shape::Dashed(line(of, 2)));
        let best = Series::new(&format!("{}: best", of.name), of.role, Shape::Line(line(of, 1)));
        [median, best]
    });
    let hit = |of: &Curves, &[generation, best, median]: &[f64; 3]| {
        let name = Arc::clone(&of.name);
        let words = move || {
            format!(
                "{name}\nGeneration {generation:.0}\nbest {best:.2}{unit}\nmedian {median:.2}{unit}"
            )
        };
        ChartHit::new(HitShape::Point([generation, best]), words)
    };
    let hits = curves.iter().flat_map(|of| of.points.iter().map(move |point| hit(of, point)));
    let hits = hits.collect();
    let chart = Chart::new(generation_axis(last), y, series.collect());
    let note = if rewards_differ {
        "These runs use different rewards, so their fitness cannot be compared."
    } else {
        ""
    };
    ChartView::new(Figure::of("Comparison of runs", chart).with_note(note), vec![hits])
}

/// Returns the title of a run whose settings have this description.
fn title(settings: &str, plan: &RunPlan) -> String {
    format!("{settings}, seed {}, {}", plan.seed, plan.settings.evolution.strategy)
}

/// Draws the list of runs to select, and the errors of runs that cannot be read.
pub(super) fn run_list(ui: &mut egui::Ui, run: &CurrentRun) {
    let others = &run.others;
    for compared in &others.compared {
        let name = compared.folder.file_name().unwrap_or_default().display();
        match &compared.read {
            None => explain(ui, &format!("Loading {name}…")),
            Some(Err(problem)) => {
                ui.colored_label(theme::of(ui).problem, format!("Not shown: {problem}"));
            }
            Some(Ok(other)) if other.records.is_empty() => {
                explain(ui, &format!("{name} has no finished generation."));
            }
            Some(Ok(_)) => {}
        }
    }
    let Some(choices) = run.listed() else { return explain(ui, "Loading the list of runs…") };
    let mut choices = choices.peekable();
    ui.horizontal(|ui| {
        match choices.peek() {
            Some(_) => ui.label(format!("Compare with up to {MOST_COMPARED} other runs:")),
            None => ui.label("There are no other runs yet."),
        };
        let list = Command::Run(RunCommand::ListRuns);
        CommandButton::new("Refresh", "Read the list of runs again", list).small().show(ui);
    });
    egui::ScrollArea::vertical().id_salt("runs").max_height(theme::PLOT_HEIGHT).show(ui, |ui| {
        for ListedRun { run: other, settings, .. } in choices {
            let mut is_shown = others.compared.iter().any(|of| of.folder == other.folder);
            let name = other.name.clone().unwrap_or_else(|| title(settings, &other.plan));
            let name = format!("{name}, {}", other.generations_in_words());
            let is_on = is_shown || others.compared.len() < MOST_COMPARED;
            let response = ui.add_enabled(is_on, egui::Checkbox::new(&mut is_shown, name));
            let hint = format!("Add this run to the chart: {}", other.folder.display());
            let refusal = format!("{MOST_COMPARED} runs are selected; deselect one of them first");
            let response = response.on_hover_text(hint).on_disabled_hover_text(refusal);
            if response.clicked() {
                Command::Run(RunCommand::Compare(other.folder.clone())).send(ui);
            }
        }
    });
}
