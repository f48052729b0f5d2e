//! The tour: five steps for somebody who has never seen the window.

use bevy_egui::egui;

use super::layout::PanelKind;
use crate::studio::command::Command;
use crate::studio::desk::Over;
use crate::studio::look;

/// A step: what it shows, and what it says.
struct Step {
    shows: PanelKind,
    title: &'static str,
    text: &'static str,
}

const STEPS: [Step; 5] = [
    Step {
        shows: PanelKind::Stage,
        title: "A snake that learned to climb",
        text: "Five blocks, four joints, and torques that evolved. Below it is the player: hold it, go \
               back and forth in time, change its speed. Drag to turn the camera; take a limb and pull.",
    },
    Step {
        shows: PanelKind::Run,
        title: "Evolution goes on behind it",
        text: "Here it is started and paused. Each generation tries many snakes and breeds from the \
               best. One that beats all before it takes the stage.",
    },
    Step {
        shows: PanelKind::World,
        title: "Change the world",
        text: "Every slider shows at once what it does: the same snake begins beside itself in the \
               changed world. Keep the change, or drop it with Esc. Ctrl Z takes anything back.",
    },
    Step {
        shows: PanelKind::Charts,
        title: "See what evolution does",
        text: "Fitness by generation, who descends from whom, which torques changed. Whatever is a \
               point can be clicked, and replays that very snake.",
    },
    Step {
        shows: PanelKind::Lessons,
        title: "Five short lessons",
        text: "What the first stair climbers taught their makers, each to be tried in two minutes. Your \
               own run waits, untouched. All keys: ? - any command by name: Ctrl K.",
    },
];

/// The panel that a step shows.
pub(in crate::studio) fn shown_in(step: usize) -> Option<PanelKind> {
    STEPS.get(step).map(|step| step.shows)
}

/// Draws a step beside what it shows, which lies in `target`, and adds what was asked for.
pub(super) fn tour(
    context: &egui::Context,
    index: usize,
    target: Option<egui::Rect>,
    asked: &mut Vec<Command>,
) {
    let Some(step) = STEPS.get(index) else { return };
    let palette = look::of_context(context);
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
    let (pivot, at) = place(target, screen);
    egui::Area::new(egui::Id::new("tour"))
        .order(egui::Order::Foreground)
        .pivot(pivot)
        .fixed_pos(at)
        .constrain_to(screen.shrink(look::GAP))
        .show(context, |ui| {
            palette.dialog().show(ui, |ui| {
                ui.set_width(look::TOUR_WIDTH.min(screen.width() - look::GAP * 4.0));
                ui.label(egui::RichText::new(step.title).size(look::TITLE_SIZE).strong());
                ui.label(step.text);
                ui.add_space(look::GAP / 2.0);
                ui.horizontal(|ui| buttons(ui, index, asked));
            });
        });
}

fn buttons(ui: &mut egui::Ui, index: usize, asked: &mut Vec<Command>) {
    let palette = look::of(ui);
    let go_to = |step| Command::Cover(Over::Tour(step));
    let is_last = index + 1 == STEPS.len();
    let (label, next) =
        if is_last { ("Done", Command::Uncover) } else { ("Next", go_to(index + 1)) };
    let text = egui::RichText::new(label).strong().color(palette.on_accent);
    let forward = ui.add(egui::Button::new(text).fill(palette.accent));
    if ui.memory(|memory| memory.focused().is_none()) {
        // So that Enter goes through all of it.
        forward.request_focus();
    }
    if forward.clicked() {
        asked.push(next);
    }
    if index > 0 && ui.button("Back").clicked() {
        asked.push(go_to(index - 1));
    }
    if !is_last && ui.button("Skip the tour").on_hover_text("Esc").clicked() {
        asked.push(Command::Uncover);
    }
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
        let count = format!("{} of {}", index + 1, STEPS.len());
        ui.label(egui::RichText::new(count).color(palette.text_weak));
    });
}

/// Beside what is shown, where there is more room; over the stage in a corner, where the snake is not.
fn place(target: egui::Rect, screen: egui::Rect) -> (egui::Align2, egui::Pos2) {
    let gap = look::GAP * 1.5;
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
    fn the_tour_goes_from_its_first_step_to_its_last_and_can_be_skipped_at_each() {
        for index in 0..STEPS.len() {
            let click = |label: &str| {
                let mut harness =
                    Harness::builder().with_size(egui::vec2(800.0, 600.0)).build_ui_state(
                        |ui, asked| tour(&ui.ctx().clone(), index, None, asked),
                        Vec::new(),
                    );
                harness.run();
                harness.get_by_label(label).click();
                harness.run();
                harness.state().clone()
            };
            if index + 1 < STEPS.len() {
                assert_eq!(click("Next"), [Command::Cover(Over::Tour(index + 1))]);
                assert_eq!(click("Skip the tour"), [Command::Uncover]);
            } else {
                assert_eq!(click("Done"), [Command::Uncover]);
            }
        }
    }

    #[test]
    fn enter_alone_goes_on() {
        let mut harness = Harness::builder()
            .with_size(egui::vec2(800.0, 600.0))
            .build_ui_state(|ui, asked| tour(&ui.ctx().clone(), 0, None, asked), Vec::new());
        harness.run();
        harness.key_press(egui::Key::Enter);
        harness.run();
        assert_eq!(*harness.state(), [Command::Cover(Over::Tour(1))]);
    }
}
