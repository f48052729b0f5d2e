//! The left panel and the caption under the stage.
//!
//! A panel is a struct with a `ui` method. It sees what is, and sends commands; it changes nothing.

mod archive_map;
mod axes;
mod caption;
mod champions;
mod chart;
mod curves;
mod evolution;
mod explore;
mod front_plot;
mod knobs;
mod method;
mod number_field;
mod world;

use bevy::prelude::*;
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};

use super::command::Command;
use super::evolution::Evolution;
use super::exhibit::Source;
use super::keys::KEYS;
use super::look;
use super::stage::Stage;
use super::{Opened, Opening};
use crate::evolve::Origin;

use caption::caption;
use champions::{ChampionsPanel, Shown};
use chart::ChartPanel;
use evolution::EvolutionPanel;
use explore::ExplorePanel;
use world::WorldPanel;

/// The part of the window that is left for the stage.
#[derive(Resource, Debug, Default)]
pub(super) struct StageArea {
    /// Where it begins, in points from the window's left edge.
    pub left_points: f32,
}

/// The panels, with what they remember between frames.
#[derive(Resource)]
struct Panels {
    evolution: EvolutionPanel,
    chart: ChartPanel,
    champions: ChampionsPanel,
    explore: ExplorePanel,
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
    /// What the run found besides champions, and how methods compare.
    Explore,
    /// The world and the snake: tune them.
    World,
}

impl FromWorld for Panels {
    fn from_world(world: &mut World) -> Self {
        let comparison = world.get_resource::<Opened>().and_then(|opened| opened.0.as_ref());
        Self {
            evolution: EvolutionPanel::default(),
            chart: ChartPanel,
            champions: ChampionsPanel,
            explore: ExplorePanel::new(comparison),
            world: WorldPanel::default(),
            // Who opens a comparison wants to see it.
            tab: if comparison.is_some() { Tab::Explore } else { Tab::Run },
            is_dressed: false,
        }
    }
}

impl Shown {
    /// Whether it is this individual of the current run.
    fn is(self, generation: u32, individual: u32) -> bool {
        self == Self::Found { generation, individual }
    }
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
    theme: Res<look::Theme>,
    mut send: MessageWriter<Command>,
) -> Result {
    let context = contexts.ctx_mut()?.clone();
    if !panels.is_dressed {
        look::apply(&context);
        panels.is_dressed = true;
    }
    look::show(&context, *theme);
    let stage = stages.iter().next();
    let shown = stage.and_then(|stage| match stage.exhibit().source() {
        Source::Opening => Some(Shown::Opening),
        Source::Run(run) if run == evolution.number() => {
            let Origin { generation, individual, .. } = stage.exhibit().champion().origin;
            Some(Shown::Found { generation, individual })
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
    let frame =
        egui::Frame::new().fill(look::of_context(&context).panel).inner_margin(look::GAP as i8 * 2);
    let panel = egui::Panel::left("panel")
        .exact_size(look::PANEL_WIDTH)
        .resizable(false)
        .frame(frame)
        .show(&mut root, |ui| {
            heading(ui, &evolution, &mut panels.tab);
            // At the bottom, where the growing list does not push it away.
            egui::Panel::bottom("keys").frame(egui::Frame::new()).show_separator_line(false).show(
                ui,
                |ui| {
                    // What is explored takes all the room there is.
                    let has_room =
                        window.height() > look::TALL_WINDOW && panels.tab != Tab::Explore;
                    ui.push_id(panels.tab == Tab::Explore, |ui| keys(ui, has_room));
                },
            );
            egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                let panels = &mut *panels;
                match panels.tab {
                    Tab::Run => {
                        panels.evolution.ui(ui, &evolution, &mut asked);
                        panels.chart.ui(ui, evolution.settings(), evolution.reports());
                        let reports = evolution.reports();
                        panels.champions.ui(ui, &opening.0.champion, reports, shown, &mut asked);
                    }
                    Tab::Explore => panels.explore.ui(ui, &evolution, shown, &mut asked),
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
            let (preset, seed) = (evolution.preset(), evolution.seed());
            let origin = egui::RichText::new(format!("{preset}, seed {seed}"));
            let hint = format!("Preset {preset}, seed {seed}");
            ui.add(egui::Label::new(origin.color(look::of(ui).text_weak)).truncate())
                .on_hover_text(hint);
        });
    });
    ui.horizontal(|ui| {
        for (choice, name, hint) in [
            (Tab::Run, "Run", "Steer evolution, replay its champions"),
            (Tab::Explore, "Explore", "Replay what else the run found, see how methods compare"),
            (Tab::World, "World", "Tune the surface, the snake and the stairs"),
        ] {
            ui.selectable_value(tab, choice, name).on_hover_text(hint);
        }
    });
    ui.separator();
}

/// A section's title.
fn title(ui: &mut egui::Ui, text: &str) {
    ui.add_space(look::GAP);
    ui.label(egui::RichText::new(text).size(look::TITLE_SIZE).strong());
}

/// A section's title, with something at the right end of its line.
fn title_and(ui: &mut egui::Ui, text: &str, right: impl FnOnce(&mut egui::Ui)) {
    ui.add_space(look::GAP);
    // A line of text is lower than a line of buttons.
    ui.spacing_mut().interact_size.y -= look::GAP * 0.75;
    ui.horizontal(|ui| {
        ui.label(egui::RichText::new(text).size(look::TITLE_SIZE).strong());
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), right);
    });
    ui.spacing_mut().interact_size.y += look::GAP * 0.75;
}

/// A line that explains.
fn explain(ui: &mut egui::Ui, text: &str) {
    ui.label(egui::RichText::new(text).color(look::of(ui).text_weak));
}

/// A clickable row over the whole width: a name at the left, what there is to say of it at the right.
fn row(ui: &mut egui::Ui, is_shown: bool, name: &str, about: &str) -> egui::Response {
    let color = if is_shown { look::of(ui).text } else { look::of(ui).text_weak };
    let about = egui::RichText::new(about).color(color);
    let button = egui::Button::new(name).right_text(about).selected(is_shown);
    ui.add(button.min_size(egui::vec2(ui.available_width(), 0.0)))
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
                ui.label(egui::RichText::new(key).color(look::of(ui).accent));
                ui.label(effect);
                ui.end_row();
            }
        });
    });
}
