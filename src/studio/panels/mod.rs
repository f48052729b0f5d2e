//! The left panel and the caption under the stage.
//!
//! A panel is a struct with a `ui` method. It sees what is, and sends commands; it changes nothing.

mod champions;
mod chart;
mod evolution;

use bevy::prelude::*;
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};

use super::Opening;
use super::command::Command;
use super::evolution::Evolution;
use super::keys::KEYS;
use super::look;
use super::stage::Stage;

use champions::ChampionsPanel;
use chart::ChartPanel;
use evolution::EvolutionPanel;

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
    is_dressed: bool,
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
    let mut root = egui::Ui::new(
        context.clone(),
        "root".into(),
        egui::UiBuilder::new()
            .layer_id(egui::LayerId::background())
            .max_rect(context.viewport_rect()),
    );
    let mut asked = Vec::new();
    let panel = egui::Panel::left("panel")
        .exact_size(look::PANEL_WIDTH)
        .resizable(false)
        .frame(egui::Frame::new().fill(look::PANEL).inner_margin(look::GAP as i8 * 2))
        .show(&mut root, |ui| {
            heading(ui, &evolution);
            egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                let panels = &mut *panels;
                panels.evolution.ui(ui, &evolution, &mut asked);
                panels.chart.ui(ui, evolution.reports());
                let shown = stage.map(|stage| stage.exhibit().generation());
                panels.champions.ui(ui, &opening.0, evolution.reports(), shown, &mut asked);
                keys(ui);
            });
        });
    area.left_points = panel.response.rect.right();
    if let Some(stage) = stage {
        caption(&context, stage, area.left_points);
    }
    send.write_batch(asked);
    Ok(())
}

fn heading(ui: &mut egui::Ui, evolution: &Evolution) {
    ui.label(egui::RichText::new("Snakes & Stairs").size(22.0).strong());
    let origin = format!("Preset {}, seed {}", evolution.preset(), evolution.seed());
    ui.label(egui::RichText::new(origin).color(look::TEXT_WEAK));
    ui.separator();
}

/// A section's title.
fn title(ui: &mut egui::Ui, text: &str) {
    ui.add_space(look::GAP);
    ui.label(egui::RichText::new(text).size(15.0).strong());
}

fn keys(ui: &mut egui::Ui) {
    ui.add_space(look::GAP);
    egui::CollapsingHeader::new("Keys and mouse").show(ui, |ui| {
        egui::Grid::new("keys").num_columns(2).spacing([look::GAP * 2.0, look::GAP / 2.0]).show(
            ui,
            |ui| {
                let mouse = [
                    ("Drag", "turn the camera"),
                    ("Right drag", "move the camera"),
                    ("Wheel", "zoom"),
                ];
                for (key, effect) in KEYS.into_iter().chain(mouse) {
                    ui.label(egui::RichText::new(key).color(look::ACCENT));
                    ui.label(effect);
                    ui.end_row();
                }
            },
        );
    });
}

/// What is on the stage, how far it has come, and when.
fn caption(context: &egui::Context, stage: &Stage, left_points: f32) {
    let window = context.viewport_rect();
    let centre =
        egui::pos2((left_points + window.right()) / 2.0, window.bottom() - look::GAP * 2.0);
    // In a small window the caption must not cover the panel.
    let room = window.right() - left_points - look::GAP * 8.0;
    egui::Area::new(egui::Id::new("caption"))
        .fixed_pos(centre)
        .pivot(egui::Align2::CENTER_BOTTOM)
        .interactable(false)
        .show(context, |ui| {
            look::card(look::FIELD_HOVERED).show(ui, |ui| {
                ui.vertical_centered(|ui| {
                    ui.set_max_width(look::CAPTION_WIDTH.min(room));
                    ui.label(egui::RichText::new(stage.exhibit().caption()).size(15.0));
                    let evaluation = stage.evaluation();
                    let state = match (evaluation.disqualified, stage.is_playing()) {
                        (Some(reason), _) => format!("  disqualified: {}", reason.words()),
                        (None, false) => "  held".to_owned(),
                        (None, true) => String::new(),
                    };
                    let now = format!(
                        "{:.1} of {:.1} s    y = {:.2} m{state}",
                        stage.time_s(),
                        stage.duration_s(),
                        evaluation.fitness_m,
                    );
                    let now = egui::RichText::new(now).color(look::TEXT_WEAK).monospace();
                    ui.label(now);
                });
            });
        });
}
