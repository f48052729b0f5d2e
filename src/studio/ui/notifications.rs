//! Short messages over the stage: news and problems.

use std::time::Duration;

use bevy::prelude::*;
use bevy_egui::egui::accesskit::{Live, Role};
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};

use super::theme;
use super::viewport::StageArea;
use crate::studio::commands::{Command, RunCommand};

/// Messages that are displayed over the stage, the oldest first.
#[derive(Resource, Debug, Default)]
pub(crate) struct Notices {
    list: Vec<Notice>,
    /// Whether only problems and important news are drawn.
    pub is_quiet: bool,
}

#[derive(Debug, Default)]
struct Notice {
    text: String,
    /// Subject of the message; a new message on the same subject replaces it. `None` for no subject.
    subject: Option<&'static str>,
    /// Label of each button of the message, and the commands that it sends.
    offers: Vec<(String, Vec<Command>)>,
    is_problem: bool,
    /// Whether the message is also drawn in the presenting mode.
    is_important: bool,
    /// Display time of the message.
    lasts: Duration,
    shown_for: Duration,
    /// Height of the message's card when it was drawn last, in points.
    height: f32,
}

/// Display time of a message without a problem or a button.
const NEWS: Duration = Duration::from_secs(8);
/// Display time of a problem, which takes longer to read, and of a message with buttons, which take time to reach.
const PROBLEM: Duration = Duration::from_secs(16);
/// Display time of a message with a button that appears only once.
const LASTING: Duration = Duration::from_secs(60);
/// Maximum number of messages; a new one then removes the oldest. More would cover the stage.
const MAX_NOTICES: usize = 4;

impl Notice {
    fn new(text: String) -> Self {
        Self { text, lasts: NEWS, ..Self::default() }
    }

    /// Draws the message's card, at most this wide in points. A clicked button sends its commands. Returns the card's height, and whether
    /// a button was clicked.
    fn show(&self, ui: &mut egui::Ui, width: f32) -> (f32, bool) {
        let palette = theme::of(ui);
        let edge = if self.is_problem { palette.problem } else { palette.accent };
        let mut is_taken = false;
        let card = palette.card(edge).show(ui, |ui| {
            ui.set_max_width(width);
            let text = egui::RichText::new(&self.text).color(palette.text);
            // The card is right-aligned, its text left-aligned.
            let lines = egui::Layout::top_down(egui::Align::Min);
            let label = ui.with_layout(lines, |ui| ui.label(text)).inner;
            // Screen readers announce the message.
            ui.ctx().accesskit_node_builder(label.id, |node| {
                node.set_role(Role::Status);
                node.set_live(Live::Polite);
            });
            if !self.offers.is_empty() {
                let row = egui::Layout::left_to_right(egui::Align::Center);
                let size = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
                ui.allocate_ui_with_layout(size, row, |ui| {
                    for (label, commands) in &self.offers {
                        if ui.button(label).clicked() {
                            is_taken = true;
                            Command::send_all(commands.iter().cloned(), ui);
                        }
                    }
                });
            }
        });
        (card.response.rect.height(), is_taken)
    }
}

impl Notices {
    /// Shows a message.
    pub fn info(&mut self, text: String) {
        self.push(Notice::new(text));
    }

    /// Shows a message that is also drawn in the presenting mode.
    pub fn important(&mut self, text: String) {
        self.push(Notice { is_important: true, ..Notice::new(text) });
    }

    /// Shows a message that replaces earlier ones on the same subject.
    pub fn update(&mut self, subject: &'static str, text: String) {
        self.push(Notice { subject: Some(subject), ..Notice::new(text) });
    }

    /// Shows a message with buttons, which replaces earlier ones on the same subject. Each button has a label and sends
    /// a command.
    pub fn offer<const N: usize>(
        &mut self,
        subject: &'static str,
        text: String,
        offers: [(&str, Command); N],
    ) {
        let offers = offers.map(|(label, command)| (label.to_owned(), vec![command])).into();
        self.push(Notice { subject: Some(subject), offers, lasts: PROBLEM, ..Notice::new(text) });
    }

    /// Shows a message with a button that begins the next run, whose plan is prepared.
    pub fn offer_next_run(&mut self, text: String) {
        let begin = [RunCommand::Reset, RunCommand::Start].map(Command::Run).into();
        let offers = vec![("Begin a new run".to_owned(), begin)];
        self.push(Notice { offers, lasts: PROBLEM, ..Notice::new(text) });
    }

    /// Shows a message with a button for a minute.
    pub fn lasting_offer(&mut self, text: String, label: &str, command: Command) {
        let offers = vec![(label.to_owned(), vec![command])];
        self.push(Notice { offers, lasts: LASTING, ..Notice::new(text) });
    }

    /// Shows and logs a problem.
    pub fn problem(&mut self, text: String) {
        error!("{text}");
        self.push(Notice {
            is_problem: true,
            is_important: true,
            lasts: PROBLEM,
            ..Notice::new(text)
        });
    }

    /// Shows why a command was refused, if it was. A refusal is not an error of the program, so it is logged as a
    /// warning.
    pub fn refusal(&mut self, text: Option<String>) {
        if let Some(text) = text {
            warn!("not done: {text}");
            self.push(Notice { is_problem: true, lasts: PROBLEM, ..Notice::new(text) });
        }
    }

    /// Shows and logs a problem, if `text` is one.
    pub fn problems(&mut self, text: Option<String>) {
        text.into_iter().for_each(|text| self.problem(text));
    }

    /// Returns the number of displayed messages.
    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Returns the latest message.
    #[cfg(test)]
    pub fn last(&self) -> Option<&str> {
        self.list.last().map(|notice| notice.text.as_str())
    }

    /// Returns the commands of the latest message's buttons, each with the label of its button.
    #[cfg(test)]
    pub fn last_offers(&self) -> Vec<(String, Command)> {
        let offers = self.list.last().map_or(&[][..], |notice| &notice.offers).iter();
        let labelled = |(label, commands): &(String, Vec<Command>)| {
            commands.iter().map(|command| (label.clone(), command.clone())).collect::<Vec<_>>()
        };
        offers.flat_map(labelled).collect()
    }

    /// Returns the messages to draw, the oldest first.
    fn drawn(&self) -> impl DoubleEndedIterator<Item = &Notice> {
        self.list.iter().filter(|notice| !self.is_quiet || notice.is_important)
    }

    /// Counts the latest messages that fit into this height, in points; at least one.
    fn fitting(&self, height: f32) -> usize {
        let heights = self.drawn().rev().map(|notice| notice.height + theme::GAP);
        let ends = heights.scan(0.0, |sum, height| {
            *sum += height;
            Some(*sum)
        });
        ends.take_while(|end| *end <= height).count().max(1)
    }

    /// Draws the messages in the lower right corner of `room`. A message whose button is clicked is removed. Returns the
    /// rectangle that the messages cover.
    fn show(&mut self, context: &egui::Context, room: egui::Rect) -> Option<egui::Rect> {
        // Older messages that do not fit are hidden until later ones disappear.
        let fitting = self.fitting(room.height());
        // The rest of the room's width is for the card's margins.
        let width = theme::NOTICE_WIDTH.min(room.width() - theme::GAP * 3.0);
        let has_buttons = self.drawn().any(|notice| !notice.offers.is_empty());
        let (is_quiet, mut taken) = (self.is_quiet, None);
        let shown = egui::Area::new(egui::Id::new("notices"))
            .pivot(egui::Align2::RIGHT_BOTTOM)
            .fixed_pos(room.max)
            // If no message has a button, clicks reach the stage behind the messages.
            .interactable(has_buttons)
            .show(context, |ui| {
                ui.spacing_mut().item_spacing.y = theme::GAP;
                ui.with_layout(egui::Layout::top_down(egui::Align::Max), |ui| {
                    let drawn = self.list.iter_mut().enumerate().rev();
                    let drawn = drawn.filter(|(_, notice)| !is_quiet || notice.is_important);
                    for (index, notice) in drawn.take(fitting) {
                        let (height, is_taken) = notice.show(ui, width);
                        if notice.height.to_bits() != height.to_bits() {
                            // egui places the area by its previous size. If the buttons were drawn there, they would
                            // move away from the pointer in the next frame.
                            context.request_discard("a message of another height");
                        }
                        notice.height = height;
                        taken = taken.or(is_taken.then_some(index));
                    }
                });
            });
        let is_empty = self.drawn().next().is_none();
        if let Some(index) = taken {
            self.list.remove(index);
        }
        (!is_empty).then(|| shown.response.rect.expand(theme::GAP / 2.0))
    }

    fn push(&mut self, new: Notice) {
        // A repeated message replaces the earlier one and restarts its display time.
        let is_same = |notice: &Notice| new.subject.is_some() && notice.subject == new.subject;
        self.list.retain(|notice| notice.text != new.text && !is_same(notice));
        self.list.push(new);
        let surplus = self.list.len().saturating_sub(MAX_NOTICES);
        self.list.drain(..surplus);
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Notices>()
        .init_resource::<StageArea>()
        .add_systems(EguiPrimaryContextPass, draw);
}

fn draw(
    mut contexts: EguiContexts,
    mut notices: ResMut<Notices>,
    time: Res<Time<Real>>,
    mut area: ResMut<StageArea>,
    mut send: MessageWriter<Command>,
) -> Result {
    notices.list.iter_mut().for_each(|notice| notice.shown_for += time.delta());
    notices.list.retain(|notice| notice.shown_for < notice.lasts);
    // The stairs rise to the upper right, so the largest free area is above the ground at the lower right.
    let room = area.messages_room.shrink(theme::GAP * 1.5);
    let context = contexts.ctx_mut()?;
    area.messages = notices.show(context, room);
    send.write_batch(Command::take_sent(context));
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;

    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    use super::*;

    #[test]
    fn only_the_latest_messages_are_kept() {
        let mut notices = Notices::default();
        for number in 0..10 {
            notices.info(number.to_string());
        }
        notices.info("7".to_owned());
        let texts: Vec<&str> = notices.list.iter().map(|notice| notice.text.as_str()).collect();
        assert_eq!(texts, ["6", "8", "9", "7"]);
    }

    #[test]
    fn messages_without_room_wait_behind_the_latest() {
        let mut notices = Notices::default();
        (0..4).for_each(|number| notices.info(number.to_string()));
        assert_eq!(notices.fitting(150.0), 4, "not drawn yet");
        notices.list.iter_mut().for_each(|notice| notice.height = 60.0);
        assert_eq!(notices.fitting(600.0), 4);
        assert_eq!(notices.fitting(150.0), 2);
        assert_eq!(notices.fitting(10.0), 1, "the latest is always shown");
    }

    #[test]
    fn a_refused_command_is_answered_like_a_problem() {
        let mut notices = Notices::default();
        notices.refusal(None);
        assert_eq!(notices.last(), None, "it was followed");
        notices.refusal(Some("Nothing to race yet".to_owned()));
        assert_eq!(notices.last(), Some("Nothing to race yet"));
        assert!(notices.list[0].is_problem);
    }

    #[test]
    fn a_message_replaces_the_earlier_one_about_its_subject() {
        let mut notices = Notices::default();
        notices.update("undo", "Deleted a save".to_owned());
        notices.info("Something else".to_owned());
        notices.offer("undo", "Restored".to_owned(), [("Redo", Command::Redo)]);
        let texts: Vec<&str> = notices.list.iter().map(|notice| notice.text.as_str()).collect();
        assert_eq!(texts, ["Something else", "Restored"]);
        assert!(notices.list[1].lasts > NEWS, "a button takes time to reach");
    }

    #[test]
    fn a_button_moved_for_one_frame_when_the_text_above_it_grew_by_a_line() {
        let notices = RefCell::new(Notices::default());
        let offer = |text: &str| {
            notices.borrow_mut().offer("best", text.to_owned(), [("Show it", Command::Redo)]);
        };
        let room = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(600.0, 500.0));
        offer("Generation 4 is the best so far: 3.34 m, climbs 1 step");
        let mut harness = Harness::new_ui(|ui| _ = notices.borrow_mut().show(ui.ctx(), room));
        harness.run();
        let below = harness.get_by_label("Show it").rect();
        offer("Generation 5 is the best so far: 3.63 m, lies beside step 1 of the stairs");
        harness.step();
        assert_eq!(harness.get_by_label("Show it").rect(), below);
    }

    #[test]
    fn a_presentation_hides_news_but_neither_problems_nor_important_news() {
        let mut notices = Notices::default();
        notices.info("small news".to_owned());
        notices.important("the run is finished".to_owned());
        notices.problem("it failed".to_owned());
        let all = ["small news", "the run is finished", "it failed"];
        for (is_quiet, drawn) in [(false, &all[..]), (true, &all[1..]), (false, &all)] {
            notices.is_quiet = is_quiet;
            assert!(notices.drawn().map(|notice| &notice.text).eq(drawn), "{is_quiet}");
        }
    }
}
