//! The left panel, and what stands around the stage: the player and the torques below it, the camera's buttons
//! above it, the board beside it.
//!
//! A panel is a struct with a `ui` method. It sees what is, and sends commands; it changes nothing.

mod archive_map;
mod axes;
mod board;
mod champions;
mod chart;
mod curves;
mod evolution;
mod explore;
mod front_plot;
mod icons;
mod knobs;
mod limb_card;
mod method;
mod number_field;
mod signals;
mod timeline;
mod view_bar;
mod world;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};

use super::camera::{CameraRig, StageCamera};
use super::casting::Opening;
use super::command::Command;
use super::evolution::Evolution;
use super::exhibit::{Exhibit, Source};
use super::hands::Hands;
use super::keys::KEYS;
use super::lane::Lane;
use super::overlay::Overlays;
use super::playback::Playback;
use super::stage::{Programme, end_s};
use super::{Opened, look};
use crate::evolve::Origin;

use board::board;
use champions::{ChampionsPanel, Shown};
use chart::ChartPanel;
use evolution::EvolutionPanel;
use explore::ExplorePanel;
use limb_card::limb_card;
use timeline::TimelinePanel;
use view_bar::view_bar;
use world::WorldPanel;

/// The part of the window that is left for the stage, in points.
#[derive(Resource, Debug, Default)]
pub(super) struct StageArea {
    /// Where it begins, from the window's left edge.
    pub left_points: f32,
    /// Where it ends, from the window's bottom edge.
    pub bottom_points: f32,
    /// Size of the window.
    window: Vec2,
}

impl StageArea {
    /// Whether a point of the window lies on the stage.
    pub fn contains(&self, point: Vec2) -> bool {
        point.x >= self.left_points && point.y <= self.window.y - self.bottom_points
    }

    /// Width over height.
    pub fn aspect(&self) -> f32 {
        let size = self.rect().size();
        if size.x > 0.0 && size.y > 0.0 { size.x / size.y } else { 1.0 }
    }

    /// The stage in the window.
    pub fn rect(&self) -> egui::Rect {
        let end = egui::pos2(self.window.x, self.window.y - self.bottom_points);
        egui::Rect::from_min_max(egui::pos2(self.left_points, 0.0), end)
    }
}

/// What is on the stage, as the panels see it.
#[derive(SystemParam)]
struct OnStage<'w, 's> {
    lanes: Query<'w, 's, &'static Lane>,
    programme: Res<'w, Programme>,
    playback: Res<'w, Playback>,
    hands: Res<'w, Hands>,
    rig: Res<'w, CameraRig>,
    overlays: Res<'w, Overlays>,
    smoothing: Query<'w, 's, &'static Msaa, With<StageCamera>>,
}

/// The panels, with what they remember between frames.
#[derive(Resource)]
struct Panels {
    evolution: EvolutionPanel,
    chart: ChartPanel,
    champions: ChampionsPanel,
    explore: ExplorePanel,
    world: WorldPanel,
    timeline: TimelinePanel,
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
            timeline: TimelinePanel::default(),
            // Who opens a comparison wants to see it.
            tab: if comparison.is_some() { Tab::Explore } else { Tab::Run },
            is_dressed: false,
        }
    }
}

impl Shown {
    /// How an exhibit is listed, if it is; `run` is the number of the current run.
    fn of(exhibit: &Exhibit, run: u32) -> Option<Self> {
        match exhibit.source() {
            Source::Opening(index) => Some(Self::Opening(index)),
            Source::Run(of) if of == run => {
                let Origin { generation, individual, .. } = exhibit.champion().origin;
                Some(Self::Found { generation, individual })
            }
            Source::Run(_) => None,
        }
    }

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
    on_stage: OnStage,
    theme: Res<look::Theme>,
    mut send: MessageWriter<Command>,
) -> Result {
    let context = contexts.ctx_mut()?.clone();
    if !panels.is_dressed {
        look::apply(&context);
        panels.is_dressed = true;
    }
    look::show(&context, *theme);
    let mut lanes: Vec<&Lane> = on_stage.lanes.iter().collect();
    lanes.sort_by_key(|lane| lane.number());
    let shown: Vec<Shown> =
        lanes.iter().filter_map(|lane| Shown::of(lane.exhibit(), evolution.number())).collect();
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
                    keys(ui, window.height() * look::MOST_KEYS_SHARE);
                },
            );
            egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                let panels = &mut *panels;
                match panels.tab {
                    Tab::Run => {
                        panels.evolution.ui(ui, &evolution, &mut asked);
                        panels.chart.ui(ui, evolution.settings(), evolution.reports());
                        let reports = evolution.reports();
                        let leaders = |generation| evolution.leaders(generation).len();
                        panels.champions.ui(ui, &opening.0, reports, &shown, leaders, &mut asked);
                    }
                    Tab::Explore => {
                        panels.explore.ui(ui, &evolution, shown.first().copied(), &mut asked)
                    }
                    Tab::World => panels.world.ui(ui, &evolution, &mut asked),
                }
            });
        });
    area.left_points = panel.response.rect.right();
    area.window = Vec2::new(window.width(), window.height());
    let focused = lanes.iter().find(|lane| lane.number() == on_stage.hands.lane);
    if let Some(lane) = focused.or(lanes.first()) {
        let below = egui::Panel::bottom("timeline")
            .resizable(false)
            .frame(
                frame.inner_margin(egui::Margin::symmetric(look::GAP as i8 * 2, look::GAP as i8)),
            )
            .show(&mut root, |ui| {
                let ends_s = end_s(lanes.iter().copied());
                let (playback, run) = (&on_stage.playback, evolution.number());
                panels.timeline.ui(ui, lane, playback, ends_s, run, &mut asked);
            });
        area.bottom_points = below.response.rect.height();
        around_stage(&context, &area, &on_stage, &lanes, lane, *theme, &mut asked);
    }
    send.write_batch(asked);
    Ok(())
}

/// The cards over the stage's edges.
fn around_stage(
    context: &egui::Context,
    area: &StageArea,
    on_stage: &OnStage,
    lanes: &[&Lane],
    focused: &Lane,
    theme: look::Theme,
    asked: &mut Vec<Command>,
) {
    let stage = area.rect().shrink(look::GAP * 1.5);
    let palette = look::of_context(context);
    let card = |name: &str, pivot: egui::Align2, at: egui::Pos2| {
        egui::Area::new(egui::Id::new(name)).pivot(pivot).fixed_pos(at).constrain_to(stage)
    };
    let frame = palette.card(palette.field_hovered);
    let bar = card("view", egui::Align2::LEFT_TOP, stage.left_top()).show(context, |ui| {
        let small = egui::Margin::symmetric(look::GAP as i8 / 2, look::GAP as i8 / 2);
        frame.inner_margin(small).show(ui, |ui| {
            let is_smooth = on_stage.smoothing.iter().any(|msaa| *msaa != Msaa::Off);
            view_bar(ui, on_stage.rig.shot(), &on_stage.overlays, is_smooth, theme, asked);
        });
    });
    if *on_stage.programme != Programme::Solo {
        let at = bar.response.rect.left_bottom() + egui::vec2(0.0, look::GAP);
        card("board", egui::Align2::LEFT_TOP, at).show(context, |ui| {
            frame.show(ui, |ui| {
                let time_s = on_stage.playback.time_s();
                board(ui, lanes, &on_stage.programme, focused.number(), time_s, asked);
            });
        });
    }
    if let Some(limb) = on_stage.hands.limb {
        // The pointer goes through it, to the snake that may be behind.
        let place = card("limb", egui::Align2::RIGHT_BOTTOM, stage.right_bottom());
        place.interactable(false).show(context, |ui| {
            frame.show(ui, |ui| limb_card(ui, focused, limb));
        });
    }
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

fn keys(ui: &mut egui::Ui, most_height: f32) {
    ui.add_space(look::GAP);
    egui::CollapsingHeader::new("Keys and mouse").show(ui, |ui| {
        let spacing = [look::GAP * 2.0, look::GAP / 4.0];
        let list =
            egui::ScrollArea::vertical().max_height(most_height).min_scrolled_height(most_height);
        list.id_salt("keys").show(ui, |ui| {
            egui::Grid::new("keys").num_columns(2).spacing(spacing).show(ui, |ui| {
                let mouse = [
                    ("Drag", "turn the camera; pull a limb"),
                    ("Right drag", "move the camera"),
                    ("Wheel", "zoom"),
                    ("Double click", "look at what is there"),
                ];
                for (key, effect) in KEYS.into_iter().chain(mouse) {
                    ui.label(egui::RichText::new(key).color(look::of(ui).accent));
                    ui.label(effect);
                    ui.end_row();
                }
            });
        });
    });
}
