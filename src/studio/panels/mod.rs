//! The panels around the stage, and what lies on its edges: the player and the torques below it, the camera's buttons
//! above it, the board beside it.
//!
//! A panel is a struct with a `ui` method. It sees what is, and sends commands; it changes nothing.

mod archive_map;
mod axes;
mod board;
mod champions;
mod charts;
mod curves;
mod evolution;
mod front_plot;
mod icons;
mod key_overlay;
mod layout;
mod lessons;
mod library;
mod limb_card;
mod menu;
mod number_field;
mod palette;
mod parameters;
mod presets;
mod progress;
mod signals;
mod stage_cards;
mod timeline;
mod tour;
mod view_bar;
mod world;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};
use egui_dock::{DockArea, TabStyle, TabViewer};

use super::actions::Situation;
use super::camera::{CameraRig, StageCamera};
use super::casting::Opening;
use super::command::Command;
use super::desk::{Desk, Over};
use super::evolution::Evolution;
use super::hands::{DOUBLE_CLICK_S, Hands};
use super::lane::Lane;
use super::lessons::{LESSONS, Lessons};
use super::library::Library;
use super::overlay::Overlays;
use super::playback::Playback;
use super::stage::{Programme, end_s};
use super::stage_area::StageArea;
use super::undo::History;
use super::{Opened, look};

use champions::{ChampionsPanel, Shown};
use charts::{ChartsPanel, FitnessChart};
use evolution::EvolutionPanel;
use key_overlay::key_overlay;
use layout::style;
use lessons::lessons;
use library::LibraryPanel;
use menu::menu;
use palette::Palette;
use stage_cards::{around_stage, lesson_card};
use timeline::TimelinePanel;
use tour::tour;
use world::WorldPanel;

pub(super) use layout::{Layout, PanelKind};
pub(super) use tour::shown_in;

/// What is on the stage, as the panels see it.
#[derive(SystemParam)]
struct OnStage<'w, 's> {
    lanes: Query<'w, 's, &'static Lane>,
    programme: Res<'w, Programme>,
    playback: Res<'w, Playback>,
    hands: Res<'w, Hands>,
    rig: Res<'w, CameraRig>,
    overlays: Res<'w, Overlays>,
    history: Res<'w, History>,
    smoothing: Query<'w, 's, &'static Msaa, With<StageCamera>>,
}

/// The panels, with what they remember between frames.
#[derive(Resource)]
struct Panels {
    evolution: EvolutionPanel,
    fitness: FitnessChart,
    charts: ChartsPanel,
    champions: ChampionsPanel,
    saves: LibraryPanel,
    world: WorldPanel,
    timeline: TimelinePanel,
    palette: Palette,
    /// Where each panel was drawn in this frame, in points.
    places: Vec<(PanelKind, egui::Rect)>,
    is_dressed: bool,
    letters: look::Letters,
}

impl FromWorld for Panels {
    fn from_world(world: &mut World) -> Self {
        let comparison = world.get_resource::<Opened>().and_then(|opened| opened.0.as_ref());
        Self {
            evolution: EvolutionPanel::default(),
            fitness: FitnessChart::default(),
            charts: ChartsPanel::new(comparison),
            champions: ChampionsPanel::default(),
            saves: LibraryPanel::default(),
            world: WorldPanel::default(),
            timeline: TimelinePanel::default(),
            palette: Palette::default(),
            places: Vec::new(),
            is_dressed: false,
            letters: look::Letters::default(),
        }
    }
}

pub(super) fn plugin(app: &mut App) {
    app.add_plugins(bevy_egui::EguiPlugin::default())
        .init_resource::<Panels>()
        .add_systems(EguiPrimaryContextPass, draw);
}

/// What the panels look at.
#[derive(SystemParam)]
struct Seen<'w, 's> {
    evolution: Res<'w, Evolution>,
    opening: Res<'w, Opening>,
    on_stage: OnStage<'w, 's>,
    theme: Res<'w, look::Theme>,
    lessons: Res<'w, Lessons>,
    saves: Res<'w, Library>,
}

fn draw(
    mut contexts: EguiContexts,
    mut panels: ResMut<Panels>,
    mut desk: ResMut<Desk>,
    mut area: ResMut<StageArea>,
    seen: Seen,
    mut send: MessageWriter<Command>,
) -> Result {
    let context = contexts.ctx_mut()?.clone();
    let is_first = !panels.is_dressed;
    if is_first {
        look::apply(&context);
        panels.is_dressed = true;
    }
    look::show(&context, *seen.theme);
    panels.letters.warm_up(&context, desk.scale);
    // Presses are known by the frame in which they come: where frames are long, two that are near may seem far.
    let frame_s = context.input(|input| input.unstable_dt);
    context.options_mut(|options| {
        options.input_options.max_double_click_delay = f64::from(DOUBLE_CLICK_S + frame_s);
    });
    // Another size of the panels takes effect in the next frame.
    let is_settled = context.zoom_factor() == desk.scale;
    context.set_zoom_factor(desk.scale);
    let mut asked = Vec::new();
    let situation =
        Situation::of(&seen.evolution, &seen.on_stage.programme, &desk, &seen.on_stage.history);
    let mut root = egui::Ui::new(
        context.clone(),
        "root".into(),
        egui::UiBuilder::new()
            .layer_id(egui::LayerId::background())
            .max_rect(context.content_rect()),
    );
    let mut lanes: Vec<&Lane> = seen.on_stage.lanes.iter().collect();
    lanes.sort_by_key(|lane| lane.number());
    panels.places.clear();
    let panels = &mut *panels;
    if let Some(label) = desk.sought.take() {
        panels.world.seek(label);
    }
    let mut viewer =
        Viewer { panels: &mut *panels, seen: &seen, lanes: &lanes, stage: None, asked: &mut asked };
    if is_first && !is_settled {
        // Panels that are put where they were would be measured with another measure.
    } else if desk.is_bare {
        viewer.stage(&mut root);
    } else {
        let (preset, seed) = (seen.evolution.preset(), seen.evolution.seed());
        let fill = look::of_context(&context).panel;
        let margin = egui::Margin::symmetric(look::GAP as i8 * 2, look::GAP as i8 / 4);
        egui::Panel::top("menu").frame(egui::Frame::new().fill(fill).inner_margin(margin)).show(
            &mut root,
            |ui| {
                menu(ui, situation, &format!("{preset}, seed {seed}"), viewer.asked);
            },
        );
        let style = style(&root);
        let size = root.available_size();
        DockArea::new(desk.layout.state_in(size, is_settled))
            .style(style)
            .hidable_tab_bars(true)
            .show_leaf_close_all_buttons(false)
            // Names alone have room beside each other; a right click on one closes its panel.
            .show_close_buttons(false)
            .show_secondary_button_hint(false)
            .show_inside(&mut root, &mut viewer);
    }
    if let Some(stage) = viewer.stage {
        let mut card_width = 0.0;
        if let Some(lane) = focused(&lanes, &seen.on_stage) {
            let theme = *seen.theme;
            let around =
                around_stage(&context, stage, &seen.on_stage, &lanes, lane, theme, &mut asked);
            card_width = around.board_width;
            let is_in_sight = panels.places.iter().any(|(kind, _)| *kind == PanelKind::Lessons);
            if let Some(view) = seen.lessons.view().filter(|_| !is_in_sight) {
                lesson_card(&context, around.below_bar, view.index, &mut asked);
            }
        }
        area.set(&context, stage, card_width);
    }
    match desk.over() {
        Some(Over::Keys) => key_overlay(&context, &mut asked),
        Some(Over::Palette) => {
            let lessons = LESSONS.each_ref().map(|lesson| lesson.title);
            panels.palette.ui(&context, situation, &lessons, &mut asked);
        }
        Some(Over::Tour(step)) => {
            let target = shown_in(step)
                .and_then(|kind| panels.places.iter().find(|(of, _)| *of == kind))
                .map(|(_, place)| *place);
            tour(&context, step, target, &mut asked);
        }
        None => {}
    }
    if desk.over() != Some(Over::Palette) {
        panels.palette.close();
    }
    send.write_batch(asked);
    Ok(())
}

/// The lane whose numbers are shown.
fn focused<'l>(lanes: &[&'l Lane], on_stage: &OnStage) -> Option<&'l Lane> {
    let focused = lanes.iter().find(|lane| lane.number() == on_stage.hands.lane);
    focused.or(lanes.first()).copied()
}

/// Draws a panel wherever it is.
struct Viewer<'v, 'w, 's> {
    panels: &'v mut Panels,
    seen: &'v Seen<'w, 's>,
    lanes: &'v [&'v Lane],
    /// The part of the window that the stage has, once it is known.
    stage: Option<egui::Rect>,
    asked: &'v mut Vec<Command>,
}

impl Viewer<'_, '_, '_> {
    /// The player at the bottom; the rest is the stage's.
    fn stage(&mut self, ui: &mut egui::Ui) {
        let OnStage { playback, .. } = &self.seen.on_stage;
        if let Some(lane) = focused(self.lanes, &self.seen.on_stage) {
            let margin = egui::Margin::symmetric(look::GAP as i8 * 2, look::GAP as i8);
            let fill = look::of(ui).panel;
            egui::Panel::bottom("timeline")
                .resizable(false)
                .frame(egui::Frame::new().fill(fill).inner_margin(margin))
                .show(ui, |ui| {
                    let ends_s = end_s(self.lanes.iter().copied());
                    let run = self.seen.evolution.number();
                    self.panels.timeline.ui(ui, lane, playback, ends_s, run, self.asked);
                });
        }
        let stage = ui.available_rect_before_wrap();
        // No control of egui's, but a place with a name, for those who look for it.
        let place = ui.interact(stage, ui.id().with("the stage"), egui::Sense::hover());
        place.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Other, true, "The stage"));
        self.stage = Some(stage);
    }

    /// What of the champions' list is on the stage.
    fn shown(&self) -> Vec<Shown> {
        let run = self.seen.evolution.number();
        self.lanes.iter().filter_map(|lane| Shown::of(lane.exhibit(), run)).collect()
    }

    fn panel(&mut self, ui: &mut egui::Ui, kind: PanelKind) {
        let shown = self.shown();
        let Seen { evolution, opening, .. } = self.seen;
        let (panels, asked) = (&mut *self.panels, &mut *self.asked);
        match kind {
            PanelKind::Stage => {}
            PanelKind::Run => {
                panels.evolution.ui(ui, evolution, asked);
                panels.fitness.ui(ui, evolution, look::CHART_HEIGHT, shown.first().copied(), asked);
            }
            PanelKind::World => panels.world.ui(ui, evolution, &self.seen.on_stage.history, asked),
            PanelKind::Charts => panels.charts.ui(ui, evolution, shown.first().copied(), asked),
            PanelKind::Champions => {
                let reports = evolution.reports();
                let leaders = |generation| evolution.leaders(generation).len();
                panels.champions.ui(ui, &opening.0, reports, &shown, leaders, asked);
            }
            PanelKind::Lessons => lessons(ui, self.seen.lessons.view(), asked),
            PanelKind::Library => panels.saves.ui(ui, &self.seen.saves, asked),
        }
    }
}

impl TabViewer for Viewer<'_, '_, '_> {
    type Tab = PanelKind;

    fn id(&mut self, kind: &mut PanelKind) -> egui::Id {
        egui::Id::new(("panel", kind.name()))
    }

    fn title(&mut self, kind: &mut PanelKind) -> egui::WidgetText {
        kind.name().into()
    }

    fn ui(&mut self, ui: &mut egui::Ui, kind: &mut PanelKind) {
        // A floating window's layer moves; only what is in the window itself is a place to point at.
        self.panels.places.push((*kind, ui.clip_rect()));
        if *kind == PanelKind::Stage {
            self.stage(ui);
        } else if [PanelKind::Champions, PanelKind::Library].contains(kind) {
            self.panel(ui, *kind);
        } else {
            egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| self.panel(ui, *kind));
        }
    }

    fn on_tab_button(&mut self, kind: &mut PanelKind, response: &egui::Response) {
        let name = format!("Panel {}", kind.name());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, &name));
        response.clone().on_hover_text(kind.hint());
    }

    fn is_closeable(&self, kind: &PanelKind) -> bool {
        *kind != PanelKind::Stage
    }

    fn allowed_in_windows(&self, kind: &mut PanelKind) -> bool {
        *kind != PanelKind::Stage
    }

    fn clear_background(&self, kind: &PanelKind) -> bool {
        *kind != PanelKind::Stage
    }

    fn scroll_bars(&self, _kind: &PanelKind) -> [bool; 2] {
        // Each panel scrolls as suits it.
        [false, false]
    }

    fn tab_style_override(&self, kind: &PanelKind, style: &TabStyle) -> Option<TabStyle> {
        (*kind == PanelKind::Stage).then(|| {
            let mut style = style.clone();
            style.tab_body.inner_margin = egui::Margin::ZERO;
            style
        })
    }
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
