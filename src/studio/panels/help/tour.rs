//! Tour in five steps, which is shown when the studio is opened for the first time. Each card points at a panel, and
//! suggests one thing to try.

use bevy_egui::egui;

use super::tour_place::{arrow, card_place, content_width};
use crate::studio::commands::modal::Modal;
use crate::studio::commands::panel::PanelKind;
use crate::studio::commands::{Command, LessonCommand, PlanCommand, PlayerCommand, RunCommand};
use crate::studio::commands::{StageCommand, WindowCommand};
use crate::studio::ui::accessible::named;
use crate::studio::ui::buttons::{CommandButton, accent_button};
use crate::studio::ui::text_rows::{at_right, explain, title_text};
use crate::studio::ui::theme;

/// A step of the tour: the panel to highlight, a text, and a thing to try.
struct TourStep {
    highlights: PanelKind,
    title: &'static str,
    text: &'static str,
    try_it: &'static str,
    /// Returns whether a command does the suggested thing.
    is_done_by: fn(&Command) -> bool,
}

const STEPS: [TourStep; 5] = [
    TourStep {
        highlights: PanelKind::Stage,
        title: "Snakes that evolve to climb",
        text: "All snakes of a generation move together, the best in full colour. Their movements evolve. Use the \
               player below to pause or move through time. Drag to turn the camera; drag a block to pull it.",
        try_it: "Pause it with Space, or click in the strip below the player",
        is_done_by: |command| {
            matches!(command, Command::Player(PlayerCommand::Toggle | PlayerCommand::Seek(_)))
        },
    },
    TourStep {
        highlights: PanelKind::Run,
        title: "Evolution runs in the background",
        text: "Start and pause it here. Each generation tries many snakes, and those of the next vary around \
               the average of the best. When one beats all earlier ones, its generation appears on the stage.",
        try_it: "Pause evolution, or start it",
        is_done_by: |command| {
            use RunCommand::{New, Pause, SingleGeneration, Start};
            matches!(command, Command::Run(Start | Pause | SingleGeneration | New))
        },
    },
    TourStep {
        highlights: PanelKind::World,
        title: "Change the world",
        text: "Move a slider to see its effect at once: a copy of the snake starts beside it in the \
               changed world. Keep the change, or discard it with Esc. Ctrl Z undoes any change.",
        try_it: "Drag the slider of Friction",
        is_done_by: |command| {
            matches!(
                command,
                Command::Plan(PlanCommand::SetField { .. } | PlanCommand::SetFields(_))
            )
        },
    },
    TourStep {
        highlights: PanelKind::Charts,
        title: "See how evolution works",
        text: "Compare the fitness of the generations, see how the snakes of a generation differ, or which torques move \
               their joints. Click any point to replay that snake.",
        try_it: "Click a point of the chart",
        is_done_by: |command| {
            matches!(command, Command::Stage(StageCommand::Show(_) | StageCommand::Join(_)))
        },
    },
    TourStep {
        highlights: PanelKind::Lessons,
        title: "Short lessons",
        text: "Two-minute experiments. Your own run is paused and comes back unchanged. Press ? for \
               all shortcuts, Ctrl K to search commands.",
        try_it: "Begin lesson 1, which ends the tour",
        is_done_by: |command| matches!(command, Command::Lesson(LessonCommand::Begin(_))),
    },
];

/// Name of the card of the tour, from which egui's ID is derived.
pub(crate) const TOUR_CARD: &str = "tour";

/// Period of the outline's pulsation, in seconds.
const PULSE_S: f64 = 1.8;
/// Assumed height of a card that has not been drawn yet, in points.
const CARD_HEIGHT: f32 = 170.0;

/// Returns the panel that a step highlights; `None` if there is no such step.
pub(crate) fn highlighted_panel(step: usize) -> Option<PanelKind> {
    STEPS.get(step).map(|step| step.highlights)
}

/// State of the tour: what has been tried since the program started.
#[derive(Debug, Default)]
pub(crate) struct Tour {
    is_done: [bool; STEPS.len()],
    /// Number of commands to the player when the step about the stage was first shown; `None` before.
    first_commands: Option<u32>,
}

impl Tour {
    /// Draws a step beside the highlighted rectangle `target`, and sends the user's commands. Those of the panels in this
    /// frame show what was tried. `player_commands` counts all commands to the player, including those of keys. A paused
    /// stage alone proves nothing, because it is also paused until the first generation is finished.
    pub fn ui(
        &mut self,
        context: &egui::Context,
        index: usize,
        target: Option<egui::Rect>,
        player_commands: u32,
    ) {
        let Some(step) = STEPS.get(index) else { return };
        let has_acted = step.highlights == PanelKind::Stage
            && player_commands > *self.first_commands.get_or_insert(player_commands);
        let sent = Command::take_sent(context);
        self.is_done[index] |= has_acted || sent.iter().any(step.is_done_by);
        let begins_lesson = sent.iter().any(|command| matches!(command, Command::Lesson(_)));
        Command::send_all(sent, context);
        if begins_lesson {
            Command::Window(WindowCommand::CloseModal).send(context);
        }
        let palette = theme::of_context(context);
        let screen = context.content_rect();
        let target = target.map(|target| target.intersect(screen));
        let id = egui::Id::new(TOUR_CARD);
        let width = content_width(target, screen);
        let known = context.memory(|memory| memory.area_rect(id)).map(|area| area.size());
        let size = known.unwrap_or(egui::vec2(width + theme::GAP * 4.0, CARD_HEIGHT));
        // If another panel is in front, the card has no target, and is placed where it covers no controls.
        let low =
            egui::Align2::CENTER_BOTTOM.align_size_within_rect(size, screen.shrink(theme::GAP));
        let place = target.map_or(low, |target| card_place(target, screen, size));
        if let Some(target) = target {
            outline(context, target);
        }
        let is_done = self.is_done[index];
        let area = egui::Area::new(id)
            .order(egui::Order::Foreground)
            .fixed_pos(place.min)
            .constrain_to(screen.shrink(theme::GAP));
        let shown = area.show(context, |ui| {
            palette.dialog().show(ui, |ui| {
                ui.set_width(width);
                ui.label(title_text(step.title));
                ui.label(step.text);
                to_try(ui, step.try_it, is_done);
                ui.add_space(theme::GAP / 2.0);
                ui.horizontal(|ui| buttons(ui, index));
            });
        });
        if let Some(points) = target.and_then(|target| arrow(shown.response.rect, target)) {
            let layer = egui::LayerId::new(egui::Order::Foreground, egui::Id::new("tour's arrow"));
            let shape = egui::Shape::convex_polygon(points, palette.accent, egui::Stroke::NONE);
            context.layer_painter(layer).add(shape);
        }
    }
}

/// Draws a pulsating outline around the target.
fn outline(context: &egui::Context, target: egui::Rect) {
    let palette = theme::of_context(context);
    let turn = context.input(|input| input.time) / PULSE_S * std::f64::consts::TAU;
    let strength = 0.5 + 0.5 * libm::sin(turn) as f32;
    let layer = egui::LayerId::new(egui::Order::Middle, egui::Id::new("tour's frame"));
    let color = palette.accent.gamma_multiply(0.65 + 0.35 * strength);
    let stroke = egui::Stroke::new(2.5 + 2.0 * strength, color);
    let rect = target.shrink(2.0);
    context.layer_painter(layer).rect_stroke(rect, 6.0, stroke, egui::StrokeKind::Inside);
}

/// Draws the suggestion, with a box that is ticked after it was tried.
fn to_try(ui: &mut egui::Ui, text: &str, is_done: bool) {
    let palette = theme::of(ui);
    ui.horizontal_wrapped(|ui| {
        let size = egui::Vec2::splat(theme::TITLE_SIZE);
        let (rect, response) = ui.allocate_exact_size(size, egui::Sense::hover());
        let name = if is_done { format!("Done: {text}") } else { format!("Try it: {text}") };
        named(response, egui::WidgetType::Label, &name);
        let painter = ui.painter();
        let rect = rect.shrink(1.0);
        let color = if is_done { palette.accent } else { palette.text_weak };
        let stroke = egui::Stroke::new(1.5, color);
        painter.rect_stroke(rect, 3.0, stroke, egui::StrokeKind::Inside);
        if is_done {
            let corners = [(0.22, 0.5), (0.43, 0.72), (0.8, 0.28)];
            let points = corners.map(|(x, y)| rect.lerp_inside(egui::vec2(x, y)));
            painter.line(points.to_vec(), egui::Stroke::new(2.0, color));
        }
        ui.label(egui::RichText::new(text).color(color).strong());
    });
}

/// Returns the command that shows a step.
fn go_to(step: usize) -> Command {
    Command::Window(WindowCommand::ToggleModal(Modal::Tour(step)))
}

fn buttons(ui: &mut egui::Ui, index: usize) {
    let end = Command::Window(WindowCommand::CloseModal);
    let is_last = index + 1 == STEPS.len();
    let (label, next) = if is_last { ("Done", end.clone()) } else { ("Next", go_to(index + 1)) };
    let forward = ui.add(accent_button(ui, label));
    // The button never takes the focus by itself, because Space would then press it instead of pausing the stage.
    // A field in which Enter ends the typing has lost the focus by now, so the focus of the frame before counts, too.
    let has_focus = ui.memory(|memory| memory.focused().is_some());
    let id = egui::Id::new("something had the focus");
    let had_focus = ui.data(|data| data.get_temp(id) == Some(true));
    ui.data_mut(|data| data.insert_temp(id, has_focus));
    let is_free = !has_focus && !had_focus;
    let enter =
        is_free && ui.input_mut(|input| input.consume_key(egui::Modifiers::NONE, egui::Key::Enter));
    if forward.clicked() || enter {
        next.send(ui);
    }
    if index > 0 {
        CommandButton::new("Back", "", go_to(index - 1)).show(ui);
    }
    if !is_last {
        CommandButton::new("Skip the tour", "Esc", end).show(ui);
    }
    at_right(ui, |ui| explain(ui, &format!("{} of {}", index + 1, STEPS.len())));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::commands::pick::Pick;
    use crate::studio::panels::testing::{Sent, clicked, panel, press, shows};
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    /// Creates a step of the tour in a window of this size, with a text field.
    fn step(size: [f32; 2], index: usize) -> Sent<'static> {
        let (mut cards, mut text) = (Tour::default(), String::new());
        panel(size, move |ui| {
            ui.text_edit_singleline(&mut text);
            cards.ui(&ui.ctx().clone(), index, None, 0);
        })
    }

    #[test]
    fn every_tour_step_can_be_continued_or_skipped() {
        for index in 0..STEPS.len() {
            let click = |label: &str| clicked(&mut step([800.0, 600.0], index), label);
            if index + 1 < STEPS.len() {
                assert_eq!(click("Next"), [go_to(index + 1)]);
                assert_eq!(click("Skip the tour"), [Command::Window(WindowCommand::CloseModal)]);
            } else {
                assert_eq!(click("Done"), [Command::Window(WindowCommand::CloseModal)]);
            }
        }
    }

    #[test]
    fn while_another_panel_is_in_front_the_card_covers_neither_tabs_nor_buttons_below_them() {
        let title = step([1024.0, 640.0], 3).get_by_label(STEPS[3].title).rect();
        assert!(title.top() > 400.0, "{title:?}");
    }

    #[test]
    fn a13_enter_continues_the_tour_and_space_is_left_to_the_stage_even_after_a_click() {
        let mut first = step([800.0, 600.0], 0);
        press(&mut first, egui::Key::Space);
        assert_eq!(*first.state(), []);
        press(&mut first, egui::Key::Enter);
        assert_eq!(*first.state(), [go_to(1)]);
        clicked(&mut first, "Next");
        press(&mut first, egui::Key::Space);
        assert_eq!(*first.state(), [go_to(1), go_to(1)]);
        assert!(first.ctx.memory(|memory| memory.focused().is_none()));
        first.get_by_role(egui::accesskit::Role::TextInput).focus();
        first.run();
        press(&mut first, egui::Key::Enter);
        assert!(first.ctx.memory(|memory| memory.focused().is_none()), "typing has ended");
        assert_eq!(*first.state(), [go_to(1), go_to(1)], "and the tour has not moved");
    }

    #[test]
    fn only_a_command_to_the_player_ticks_the_first_task_not_a_stage_that_waits() {
        let player = std::cell::RefCell::new(crate::studio::stage::playback::Playback::default());
        let mut cards = Tour::default();
        let mut harness = Harness::builder().with_size(egui::vec2(800.0, 600.0)).build_ui(|ui| {
            let player_commands = player.borrow().commands;
            cards.ui(&ui.ctx().clone(), 0, None, player_commands);
        });
        // At the first start, the stage is paused until the first generation is finished.
        player.borrow_mut().hold_at(0.0);
        harness.run();
        let words = STEPS[0].try_it;
        assert!(shows(&harness, &format!("Try it: {words}")));
        player.borrow_mut().restart();
        player.borrow_mut().apply(&PlayerCommand::SetSpeed(2.0), 1.0 / 60.0, 5.0);
        harness.run();
        assert!(shows(&harness, &format!("Try it: {words}")));
        player.borrow_mut().apply(&PlayerCommand::Toggle, 1.0 / 60.0, 5.0);
        harness.run();
        assert!(shows(&harness, &format!("Done: {words}")));
    }

    #[test]
    fn what_is_tried_is_ticked_and_a_lesson_ends_the_tour() {
        let set = PlanCommand::SetField { field: "surface.friction".into(), text: "0.5".into() };
        let tried = [
            Command::Player(PlayerCommand::Seek(3.0)),
            Command::Run(RunCommand::Pause),
            Command::Plan(set),
            Command::Stage(StageCommand::Show(Pick::Generation(1))),
            Command::Lesson(LessonCommand::Begin(0)),
        ];
        for (index, command) in tried.into_iter().enumerate() {
            let mut harness = step([800.0, 600.0], index);
            let words = STEPS[index].try_it;
            assert!(shows(&harness, &format!("Try it: {words}")), "{index}");
            let is_lesson = matches!(command, Command::Lesson(_));
            command.send(&harness.ctx);
            harness.run();
            let ends = harness.state().contains(&Command::Window(WindowCommand::CloseModal));
            assert_eq!(ends, is_lesson, "{index}");
            assert!(shows(&harness, &format!("Done: {words}")), "{index}");
        }
    }
}
