//! The left panel and the caption under the stage.
//!
//! A panel is a struct with a `ui` method. It sees what is, and sends commands; it changes nothing.

mod caption;
mod champions;
mod chart;
mod evolution;
mod knobs;
mod number_field;
mod world;

use bevy::prelude::*;
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};

use super::Opening;
use super::command::Command;
use super::evolution::Evolution;
use super::exhibit::Source;
use super::keys::KEYS;
use super::look;
use super::stage::Stage;

use caption::caption;
use champions::{ChampionsPanel, Shown};
use chart::ChartPanel;
use evolution::EvolutionPanel;
use world::WorldPanel;

/// The part of the window that is left for the stage.
#[derive(Resource, Debug, Default)]
pub(super) struct StageArea {
    /// Where it begins, in points from the window's left edge.
    pub left_points: f32,
}

/// The panels, with what they remember between frames.
#[derive(Resource, Default)]
struct Panels {
    evolution: EvolutionPanel,
    chart: ChartPanel,
    champions: ChampionsPanel,
    world: WorldPanel,
    tab: Tab,
    is_dressed: bool,
}

/// What the left panel shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Tab {
    /// The run: steer it, see how it goes, replay its champions.
    #[default]
    Run,
    /// The world and the snake: tune them.
    World,
}

pub(super) fn plugin(app: &mut App) {
    app.add_plugins(bevy_egui::EguiPlugin::default())
        .init_resource::<StageArea>()
        .init_resource::<Panels>()
        .add_systems(EguiPrimaryContextPass, draw);
}

fn draw(
    mut contexts: EguiContexts,
    mut panels: ResMut<Panels>,
    mut area: ResMut<StageArea>,
    evolution: Res<Evolution>,
    opening: Res<Opening>,
    stages: Query<&Stage>,
    mut send: MessageWriter<Command>,
) -> Result {
    let context = contexts.ctx_mut()?.clone();
    if !panels.is_dressed {
        look::apply(&context);
        panels.is_dressed = true;
    }
    let stage = stages.iter().next();
    let shown = stage.and_then(|stage| match stage.exhibit().source() {
        Source::Opening => Some(Shown::Opening),
        Source::Run(run) if run == evolution.number() => {
            Some(Shown::Generation(stage.exhibit().generation()))
        }
        Source::Run(_) => None,
    });
    let mut asked = Vec::new();
    let window = context.viewport_rect();
    let mut root = egui::Ui::new(
        context.clone(),
        "root".into(),
        egui::UiBuilder::new().layer_id(egui::LayerId::background()).max_rect(window),
    );
    let frame = egui::Frame::new().fill(look::PANEL).inner_margin(look::GAP as i8 * 2);
    let panel = egui::Panel::left("panel")
        .exact_size(look::PANEL_WIDTH)
        .resizable(false)
        .frame(frame)
        .show(&mut root, |ui| {
            heading(ui, &evolution, &mut panels.tab);
            // At the bottom, where the growing list does not push it away.
            egui::Panel::bottom("keys")
                .frame(egui::Frame::new())
                .show_separator_line(false)
                .show(ui, |ui| keys(ui, window.height() > look::TALL_WINDOW));
            egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                let panels = &mut *panels;
                match panels.tab {
                    Tab::Run => {
                        panels.evolution.ui(ui, &evolution, &mut asked);
                        panels.chart.ui(ui, evolution.settings(), evolution.reports());
                        let reports = evolution.reports();
                        panels.champions.ui(ui, &opening.0.champion, reports, shown, &mut asked);
                    }
                    Tab::World => panels.world.ui(ui, &evolution, &mut asked),
                }
            });
        });
    area.left_points = panel.response.rect.right();
    if let Some(stage) = stage {
        caption(&context, stage, evolution.number(), area.left_points, &mut asked);
    }
    send.write_batch(asked);
    Ok(())
}

fn heading(ui: &mut egui::Ui, evolution: &Evolution, tab: &mut Tab) {
    ui.horizontal(|ui| {
        ui.label(egui::RichText::new("Snakes & Stairs").size(look::HEADING_SIZE).strong());
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.selectable_value(tab, Tab::World, "World")
                .on_hover_text("Tune the surface, the snake and the stairs");
            ui.selectable_value(tab, Tab::Run, "Run")
                .on_hover_text("Steer evolution, replay its champions");
        });
    });
    let origin = format!("Preset {}, seed {}", evolution.preset(), evolution.seed());
    ui.label(egui::RichText::new(origin).color(look::TEXT_WEAK));
    ui.separator();
}

/// A section's title.
fn title(ui: &mut egui::Ui, text: &str) {
    ui.add_space(look::GAP);
    ui.label(egui::RichText::new(text).size(look::TITLE_SIZE).strong());
}

fn keys(ui: &mut egui::Ui, is_open_at_first: bool) {
    ui.add_space(look::GAP);
    let header = egui::CollapsingHeader::new("Keys and mouse").default_open(is_open_at_first);
    header.show(ui, |ui| {
        let spacing = [look::GAP * 2.0, look::GAP / 4.0];
        egui::Grid::new("keys").num_columns(2).spacing(spacing).show(ui, |ui| {
            let mouse =
                [("Drag", "turn the camera"), ("Right drag", "move the camera"), ("Wheel", "zoom")];
            for (key, effect) in KEYS.into_iter().chain(mouse) {
                ui.label(egui::RichText::new(key).color(look::ACCENT));
                ui.label(effect);
                ui.end_row();
            }
        });
    });
}
