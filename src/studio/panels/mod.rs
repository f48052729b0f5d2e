//! Panels around the stage, and controls on its edges: the player and the torques below, the camera bar above, the
//! leaderboard beside it.
//!
//! A panel is a struct with a `ui` method, which reads the state and sends commands but does not change the state. The
//! commands wait in egui's context until the frame is drawn: see [`Command::send`].

mod body;
mod champions;
mod charts;
mod click_limits;
pub mod help;
mod lessons;
mod library;
mod machines;
mod on_stage;
mod own_files;
mod player;
pub mod quit_question;
mod run;
mod senses;
mod settings;
mod shown;
pub mod situation;
mod stairs;
mod tab_names;
mod tab_viewer;
#[cfg(test)]
mod testing;
mod thumbnail;
mod undo_buttons;
mod world;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};
use egui_dock::DockArea;

use super::commands::actions::Situation;
use super::commands::modal::Modal;
use super::commands::{Command, WindowCommand};
use super::stage::StageMode;
use super::stage::lane::Lane;
use super::stage::opening::OpeningChampions;
use super::stage::staged_champion::ChampionSource;
use super::state::body_editor::BodyEditor;
use super::state::current_run::CurrentRun;
use super::state::files::Files;
use super::state::lessons::{LESSONS, Lessons};
use super::state::library::Library;
use super::state::machines::MachinesLink;
use super::state::options::Options;
use super::state::shares::Shares;
use super::state::stairs_exams::StairsExams;
use super::ui::accessible::named;
use super::ui::theme;
use super::ui::viewport::StageArea;
use super::workspace::Workspace;
use super::workspace::layout::style;
use super::workspace::scale::UiScale;
use snakes_lab::run::names::with_title;

use body::BodyPanel;
use champions::{ChampionsPanel, ChampionsView, FOLLOW_COMMAND};
use charts::{ChartsPanel, FitnessChart};
use click_limits::{leave_keyboard_to_stage, set_click_limits};
use help::command_palette::CommandPalette;
use help::key_list::key_overlay;
use help::menu::menu;
use help::tour::{TOUR_CARD, Tour};
use lessons::lessons;
use library::LibraryPanel;
use machines::MachinesPanel;
use on_stage::OnStage;
use player::cards::{CardSituation, around_stage};
use player::presented_caption::{PresentedCaption, caption_band};
use player::stage_card::CardStates;
use player::timeline::{TimelinePanel, TimelineSpan};
use quit_question::{quit_question, unfinished};
use run::EvolutionPanel;
use senses::{SensesPanel, SensesView};
use shown::ShownLane;
use stairs::StairsPanel;
use tab_names::{fit_tabs, small_tabs};
use world::WorldPanel;
use world::surface_readout::ReadLanes;

pub(super) use super::commands::panel::PanelKind;
pub(super) use help::tour::highlighted_panel;

/// All panels, with their state between frames.
#[derive(Resource, Default)]
struct Panels {
    evolution: EvolutionPanel,
    fitness: FitnessChart,
    charts: ChartsPanel,
    champions: ChampionsPanel,
    saves: LibraryPanel,
    world: WorldPanel,
    senses: SensesPanel,
    body: BodyPanel,
    stairs: StairsPanel,
    machines: MachinesPanel,
    timeline: TimelinePanel,
    palette: CommandPalette,
    tour: Tour,
    cards: CardStates,
    /// Rectangles of the panels in this frame, in points.
    panel_rects: Vec<(PanelKind, egui::Rect)>,
    is_styled: bool,
    letters: theme::GlyphWarmUp,
}

pub(super) fn plugin(app: &mut App) {
    let comparison = app.world().get_resource::<Options>();
    let charts = ChartsPanel::new(comparison.and_then(|opened| opened.comparison.as_ref()));
    app.add_plugins(bevy_egui::EguiPlugin::default())
        .insert_resource(Panels { charts, ..Panels::default() })
        .add_systems(EguiPrimaryContextPass, draw);
}

/// State that the panels read.
#[derive(SystemParam)]
struct PanelData<'w, 's> {
    run: Res<'w, CurrentRun>,
    opening: Res<'w, OpeningChampions>,
    on_stage: OnStage<'w, 's>,
    theme: Res<'w, theme::Theme>,
    lessons: Res<'w, Lessons>,
    exams: Res<'w, StairsExams>,
    bodies: Res<'w, BodyEditor>,
    machines: Res<'w, MachinesLink>,
    saves: Res<'w, Library>,
    files: Res<'w, Files>,
    shares: Res<'w, Shares>,
}

fn draw(
    mut contexts: EguiContexts,
    mut panels: ResMut<Panels>,
    mut workspace: ResMut<Workspace>,
    mut area: ResMut<StageArea>,
    data: PanelData,
    mut send: MessageWriter<Command>,
) -> Result {
    let context = contexts.ctx_mut()?.clone();
    let is_first = !panels.is_styled;
    if is_first {
        theme::apply(&context);
        panels.is_styled = true;
        panels.world.sheet.unfold(&workspace.unfolded);
        panels.evolution.sheet.unfold(&workspace.unfolded);
    }
    context.set_theme(egui::Theme::from(*data.theme));
    workspace.scale.fit(context.content_rect().size() * context.zoom_factor());
    let is_presenting = workspace.is_presenting;
    let scale = match is_presenting {
        true => UiScale::presenting(context.content_rect().size() * context.zoom_factor()),
        false => workspace.scale.shown(),
    };
    panels.letters.warm_up(&context, scale, is_presenting);
    set_click_limits(&context);
    leave_keyboard_to_stage(&context);
    // A new scale takes effect in the next frame.
    let is_settled = context.zoom_factor() == scale;
    context.set_zoom_factor(scale);
    let on_stage = &data.on_stage;
    let (scene, files) =
        ((&*on_stage.mode, &*on_stage.way_back), (&*on_stage.history, &*data.shares));
    let situation = Situation::of(&data.run, scene, &workspace, files);
    let mut root = egui::Ui::new(
        context.clone(),
        "root".into(),
        egui::UiBuilder::new()
            .layer_id(egui::LayerId::background())
            .max_rect(context.content_rect()),
    );
    let mut lanes: Vec<&Lane> = on_stage.lanes.iter().collect();
    lanes.sort_by_key(|lane| lane.number);
    let focused = lanes.iter().find(|lane| lane.number == on_stage.selection.lane);
    let focused = focused.or(lanes.first()).copied();
    panels.panel_rects.clear();
    let panels = &mut *panels;
    if let Some(label) = workspace.sought.take() {
        label.clone_into(&mut panels.world.search);
    }
    let (shows_torques, is_larger) = (workspace.shows_torques(), workspace.scale.chosen > 1.0);
    panels.timeline.shows_torques = shows_torques;
    panels.timeline.limb = on_stage.selection.limb;
    panels.timeline.offers_why = !matches!(*on_stage.mode, StageMode::Generation { .. });
    let is_on = |command: &Command| match command {
        Command::Window(WindowCommand::ToggleTorques) => Some(shows_torques),
        Command::Window(WindowCommand::ToggleLarger) => Some(is_larger),
        &FOLLOW_COMMAND => on_stage.following.offered(&data.run),
        _ => on_stage.is_on(command, *data.theme),
    };
    if is_settled {
        fit_tabs(&context, &mut workspace.layout);
    }
    let mut viewer = Viewer {
        small_tabs: small_tabs(&context, &workspace.layout),
        panels: &mut *panels,
        data: &data,
        lanes: &lanes,
        focused,
        stage: None,
    };
    if is_first && !is_settled {
        // Nothing is drawn until the scale has taken effect, because the saved layout would otherwise be measured at the wrong scale.
    } else if is_presenting {
        caption_band(&mut root, &PresentedCaption::of(&lanes, on_stage, &data.run));
        viewer.reserve_stage(&mut root);
        if workspace.is_black() {
            // Black covers the whole window, so that the audience looks at the presenter.
            let layer = egui::LayerId::new(egui::Order::Foreground, egui::Id::new("black screen"));
            let whole = context.content_rect();
            context.layer_painter(layer).rect_filled(whole, 0.0, egui::Color32::BLACK);
        }
    } else if workspace.is_bare {
        viewer.stage(&mut root);
    } else {
        let frame = bar_frame(theme::of_context(&context), theme::GAP as i8 / 4);
        egui::Panel::top("menu").frame(frame).show(&mut root, |ui| {
            let preset = with_title(&data.run.preset_in_words());
            let about = format!("{preset}, seed {}", data.run.plan_now.seed);
            let share = data.shares.progress();
            let right = (about.as_str(), share.as_ref());
            menu(ui, situation, &is_on, &data.files.recent, right);
        });
        let mut seen = lanes.iter().filter(|lane| !lane.is_ghost);
        let senses = |lane: &&Lane| lane.staged.champion().genome.senses_surroundings();
        workspace.layout.offer(PanelKind::Senses, seen.any(senses));
        let style = style(&root);
        let size = root.available_size();
        DockArea::new(workspace.layout.state_in(size, is_settled))
            .style(style)
            .hidable_tab_bars(true)
            .show_leaf_close_all_buttons(false)
            // Close buttons would leave too little room for the names. A right-click on a tab closes its panel.
            .show_close_buttons(false)
            .show_secondary_button_hint(false)
            .show_inside(&mut root, &mut viewer);
    }
    if let Some(stage) = viewer.stage {
        let (mut cards, mut messages_room) = (Vec::new(), stage);
        if let Some(lane) = focused.filter(|_| !is_presenting) {
            let tour = matches!(workspace.modal(), Some(Modal::Tour(_)))
                .then(|| context.memory(|memory| memory.area_rect(egui::Id::new(TOUR_CARD))));
            let is_in_sight = |kind| panels.panel_rects.iter().any(|(of, _)| *of == kind);
            let lesson = data.lessons.view().filter(|_| !is_in_sight(PanelKind::Lessons));
            let of = CardSituation {
                is_on: &is_on,
                progress: data.run.progress(),
                lesson: lesson.map(|view| view.index),
                tour: tour.flatten(),
                messages: area.messages_size(),
            };
            let (snakes, state) = ((&lanes[..], lane), (&of, &mut panels.cards));
            (cards, messages_room) = around_stage(&context, stage, on_stage, snakes, state);
        }
        area.set(&context, stage, cards, messages_room);
    }
    workspace.is_menu_open = egui::Popup::is_any_open(&context);
    match workspace.modal() {
        Some(Modal::Keys) => key_overlay(&context),
        Some(Modal::CommandPalette) => {
            let lessons = LESSONS.each_ref().map(|lesson| lesson.title);
            panels.palette.ui(&context, situation, &lessons);
        }
        Some(Modal::Tour(step)) => {
            let target = highlighted_panel(step)
                .and_then(|kind| panels.panel_rects.iter().find(|(of, _)| *of == kind))
                .map(|(_, place)| *place);
            let player_commands = on_stage.playback.commands;
            panels.tour.ui(&context, step, target, player_commands);
        }
        Some(Modal::Quit) => {
            let work = unfinished(&data.shares, &data.exams, &data.bodies, &data.saves);
            quit_question(&context, &work);
        }
        None => {}
    }
    panels.palette.is_open &= workspace.modal() == Some(Modal::CommandPalette);
    send.write_batch(Command::take_sent(&context));
    Ok(())
}

/// Returns the frame of the bars above and below the stage. `margin` is the space above and below their contents, in points.
fn bar_frame(palette: &theme::Palette, margin: i8) -> egui::Frame {
    let margin = egui::Margin::symmetric(theme::GAP as i8 * 2, margin);
    egui::Frame::new().fill(palette.panel).inner_margin(margin)
}

/// Draws the tabs of the dock area.
struct Viewer<'v, 'w, 's> {
    /// Panels whose tab names are drawn smaller, and the sizes of the names in points.
    small_tabs: Vec<(PanelKind, f32)>,
    panels: &'v mut Panels,
    data: &'v PanelData<'w, 's>,
    lanes: &'v [&'v Lane],
    /// Lane whose numbers the panels show.
    focused: Option<&'v Lane>,
    /// Rectangle of the stage in points; `None` until it is drawn in this frame.
    stage: Option<egui::Rect>,
}

impl Viewer<'_, '_, '_> {
    /// Draws the player at the bottom, and reserves the rest for the stage.
    fn stage(&mut self, ui: &mut egui::Ui) {
        if let Some(lane) = self.focused {
            let frame = bar_frame(theme::of(ui), theme::GAP as i8);
            egui::Panel::bottom("timeline").resizable(false).frame(frame).show(ui, |ui| {
                let is_of_lesson = lane.staged.source() == ChampionSource::Lesson;
                let hides_future = is_of_lesson && self.data.lessons.hides_result();
                let span = TimelineSpan::of(self.lanes.iter().copied(), hides_future);
                let (playback, run) = (&self.data.on_stage.playback, self.data.run.number);
                self.panels.timeline.ui(ui, lane, playback, span, run);
            });
        }
        self.reserve_stage(ui);
    }

    fn reserve_stage(&mut self, ui: &mut egui::Ui) {
        let stage = ui.available_rect_before_wrap();
        // The stage is not an egui widget, but accessibility tools and tests need its name and its rectangle.
        let place = ui.interact(stage, ui.id().with("the stage"), egui::Sense::hover());
        named(place, egui::WidgetType::Other, "The stage");
        self.stage = Some(stage);
    }

    fn panel(&mut self, ui: &mut egui::Ui, kind: PanelKind) {
        let shown = ShownLane::all(self.lanes, self.data.run.number);
        let PanelData { run, opening, on_stage, .. } = self.data;
        let (lanes, focused, history) = (self.lanes, self.focused, &on_stage.history);
        let panels = &mut *self.panels;
        match kind {
            PanelKind::Stage => {}
            PanelKind::Run => {
                let fitness = &mut panels.fitness;
                let chart = |ui: &mut egui::Ui| {
                    fitness.ui(ui, run, theme::CHART_HEIGHT, &shown);
                };
                panels.evolution.ui(ui, run, chart);
            }
            PanelKind::World => {
                let read = ReadLanes::of(lanes, focused, on_stage);
                panels.world.ui(ui, run, history, &read);
            }
            PanelKind::Charts => {
                panels.charts.ui(ui, run, &shown, focused.map(|lane| &lane.staged));
            }
            PanelKind::Champions => {
                let view = ChampionsView {
                    opening: &opening.0,
                    reports: &run.reports,
                    shown: &shown,
                    leaders: &|generation| run.leaders(generation).len(),
                    follows: on_stage.following.offered(run),
                };
                panels.champions.ui(ui, &view);
            }
            PanelKind::Lessons => lessons(ui, &self.data.lessons),
            PanelKind::Senses => {
                let view = SensesView::of(lanes, focused, on_stage);
                panels.senses.ui(ui, view.as_ref(), &self.data.exams);
            }
            PanelKind::Body => {
                let limb = on_stage.selection.limb;
                panels.body.ui(ui, self.data.bodies.edited(), focused, limb);
            }
            PanelKind::Stairs => panels.stairs.ui(ui, run, history, focused),
            PanelKind::Library => panels.saves.ui(ui, &self.data.saves, history),
            PanelKind::Machines => panels.machines.ui(ui, &self.data.machines, run),
        }
    }
}
