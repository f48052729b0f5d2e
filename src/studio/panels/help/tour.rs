//! Tour in five steps, shown when the studio is opened for the first time.

use bevy_egui::egui;

use crate::studio::commands::modal::Modal;
use crate::studio::commands::panel::PanelKind;
use crate::studio::commands::{Command, WindowCommand};
use crate::studio::ui::theme;

/// Step of the tour: the panel to highlight, and its text.
struct TourStep {
    highlights: PanelKind,
    title: &'static str,
    text: &'static str,
}

const STEPS: [TourStep; 5] = [
    TourStep {
        highlights: PanelKind::Stage,
        title: "A snake that learned to climb",
        text: "It has five blocks and four joints, and its movements evolved. Use the player below to \
               pause, move through time or change the speed. Drag to turn the camera; drag a limb to pull it.",
    },
    TourStep {
        highlights: PanelKind::Run,
        title: "Evolution runs in the background",
        text: "Start and pause it here. Each generation tries many snakes and breeds from the best. \
               When a snake beats all earlier ones, it appears on the stage.",
    },
    TourStep {
        highlights: PanelKind::World,
        title: "Change the world",
        text: "Move a slider to see its effect at once: a copy of the snake starts beside it in the \
               changed world. Keep the change, or discard it with Esc. Ctrl Z undoes any change.",
    },
    TourStep {
        highlights: PanelKind::Charts,
        title: "See how evolution works",
        text: "Compare the fitness of the generations, trace the ancestors of the best snake, or see which \
               torques changed. Click any point to replay that snake.",
    },
    TourStep {
        highlights: PanelKind::Lessons,
        title: "Five short lessons",
        text: "Five two-minute experiments. Your own run is paused and comes back unchanged. Press ? for \
               all shortcuts, Ctrl K to search commands.",
    },
];

/// Panel that a step highlights.
pub(crate) fn highlighted_panel(step: usize) -> Option<PanelKind> {
    STEPS.get(step).map(|step| step.highlights)
}

/// Draws a step beside the highlighted rectangle `target` and collects the user's commands.
pub(crate) fn tour(
    context: &egui::Context,
    index: usize,
    target: Option<egui::Rect>,
    commands: &mut Vec<Command>,
) {
    let Some(step) = STEPS.get(index) else { return };
    let palette = theme::of_context(context);
    let screen = context.content_rect();
    let target = target.unwrap_or(screen).intersect(screen);
    let layer = egui::LayerId::new(egui::Order::Middle, egui::Id::new("tour's frame"));
    let stroke = egui::Stroke::new(3.0, palette.accent);
    context.layer_painter(layer).rect_stroke(
        target.shrink(2.0),
        6.0,
        stroke,
        egui::StrokeKind::Inside,
    );
    let (pivot, at) = card_position(target, screen);
    egui::Area::new(egui::Id::new("tour"))
        .order(egui::Order::Foreground)
        .pivot(pivot)
        .fixed_pos(at)
        .constrain_to(screen.shrink(theme::GAP))
        .show(context, |ui| {
            palette.dialog().show(ui, |ui| {
                ui.set_width(theme::TOUR_WIDTH.min(screen.width() - theme::GAP * 4.0));
                ui.label(egui::RichText::new(step.title).size(theme::TITLE_SIZE).strong());
                ui.label(step.text);
                ui.add_space(theme::GAP / 2.0);
                ui.horizontal(|ui| buttons(ui, index, commands));
            });
        });
}

fn buttons(ui: &mut egui::Ui, index: usize, commands: &mut Vec<Command>) {
    let palette = theme::of(ui);
    let go_to = |step| Command::Window(WindowCommand::ToggleModal(Modal::Tour(step)));
    let is_last = index + 1 == STEPS.len();
    let (label, next) = if is_last {
        ("Done", Command::Window(WindowCommand::CloseModal))
    } else {
        ("Next", go_to(index + 1))
    };
    let text = egui::RichText::new(label).strong().color(palette.on_accent);
    let forward = ui.add(egui::Button::new(text).fill(palette.accent));
    if ui.memory(|memory| memory.focused().is_none()) {
        // The focus lets Enter step through the whole tour.
        forward.request_focus();
    }
    if forward.clicked() {
        commands.push(next);
    }
    if index > 0 && ui.button("Back").clicked() {
        commands.push(go_to(index - 1));
    }
    if !is_last && ui.button("Skip the tour").on_hover_text("Esc").clicked() {
        commands.push(Command::Window(WindowCommand::CloseModal));
    }
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
        let count = format!("{} of {}", index + 1, STEPS.len());
        ui.label(egui::RichText::new(count).color(palette.text_weak));
    });
}

/// Position beside the target, on the side with more room. Over the stage: the corner away from the snake.
fn card_position(target: egui::Rect, screen: egui::Rect) -> (egui::Align2, egui::Pos2) {
    let gap = theme::GAP * 1.5;
    let right = screen.right() - target.right();
    let left = target.left() - screen.left();
    if target.width() > screen.width() / 2.0 {
        (egui::Align2::RIGHT_TOP, target.right_top() + egui::vec2(-gap, gap * 4.0))
    } else if right >= left {
        (egui::Align2::LEFT_TOP, target.right_top() + egui::vec2(gap, gap * 4.0))
    } else {
        (egui::Align2::RIGHT_TOP, target.left_top() + egui::vec2(-gap, gap * 4.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn every_tour_step_can_be_continued_or_skipped() {
        for index in 0..STEPS.len() {
            let click = |label: &str| {
                let mut harness =
                    Harness::builder().with_size(egui::vec2(800.0, 600.0)).build_ui_state(
                        |ui, commands| tour(&ui.ctx().clone(), index, None, commands),
                        Vec::new(),
                    );
                harness.run();
                harness.get_by_label(label).click();
                harness.run();
                harness.state().clone()
            };
            if index + 1 < STEPS.len() {
                assert_eq!(
                    click("Next"),
                    [Command::Window(WindowCommand::ToggleModal(Modal::Tour(index + 1)))]
                );
                assert_eq!(click("Skip the tour"), [Command::Window(WindowCommand::CloseModal)]);
            } else {
                assert_eq!(click("Done"), [Command::Window(WindowCommand::CloseModal)]);
            }
        }
    }

    #[test]
    fn enter_continues_the_tour() {
        let mut harness = Harness::builder()
            .with_size(egui::vec2(800.0, 600.0))
            .build_ui_state(|ui, commands| tour(&ui.ctx().clone(), 0, None, commands), Vec::new());
        harness.run();
        harness.key_press(egui::Key::Enter);
        harness.run();
        assert_eq!(*harness.state(), [Command::Window(WindowCommand::ToggleModal(Modal::Tour(1)))]);
    }
}
