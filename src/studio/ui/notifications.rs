//! Short messages over the stage: news and problems.

use std::time::Duration;

use bevy::prelude::*;
use bevy_egui::egui::accesskit::{Live, Role};
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};

use super::theme;

/// Displayed messages, the oldest first.
#[derive(Resource, Debug, Default)]
pub(crate) struct Notices(Vec<Notice>);

#[derive(Debug)]
struct Notice {
    text: String,
    is_problem: bool,
    shown_for: Duration,
}

/// Display time of news.
const NEWS: Duration = Duration::from_secs(8);
/// Display time of a problem, which takes longer to read.
const PROBLEM: Duration = Duration::from_secs(16);
/// Maximum number of messages. More would cover the stage; the oldest is removed.
const MAX_NOTICES: usize = 4;

impl Notice {
    fn is_over(&self) -> bool {
        self.shown_for >= if self.is_problem { PROBLEM } else { NEWS }
    }
}

impl Notices {
    /// Shows a message.
    pub fn info(&mut self, text: String) {
        self.push(text, false);
    }

    /// Shows and logs a problem.
    pub fn problem(&mut self, text: String) {
        error!("{text}");
        self.push(text, true);
    }

    /// Shows and logs a problem, if there is one.
    pub fn problems(&mut self, text: Option<String>) {
        text.into_iter().for_each(|text| self.problem(text));
    }

    /// Number of displayed messages.
    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// The latest message.
    #[cfg(test)]
    pub fn last(&self) -> Option<&str> {
        self.0.last().map(|notice| notice.text.as_str())
    }

    fn push(&mut self, text: String, is_problem: bool) {
        // A repeated message replaces the earlier one and restarts its display time.
        self.0.retain(|notice| notice.text != text);
        self.0.push(Notice { text, is_problem, shown_for: Duration::ZERO });
        let surplus = self.0.len().saturating_sub(MAX_NOTICES);
        self.0.drain(..surplus);
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Notices>().add_systems(EguiPrimaryContextPass, draw);
}

fn draw(mut contexts: EguiContexts, mut notices: ResMut<Notices>, time: Res<Time<Real>>) -> Result {
    notices.0.iter_mut().for_each(|notice| notice.shown_for += time.delta());
    notices.0.retain(|notice| !notice.is_over());
    let context = contexts.ctx_mut()?;
    egui::Area::new(egui::Id::new("notices"))
        .anchor(egui::Align2::RIGHT_TOP, [-theme::GAP * 2.0, theme::NOTICES_TOP])
        .interactable(false)
        .show(context, |ui| {
            ui.spacing_mut().item_spacing.y = theme::GAP;
            ui.with_layout(egui::Layout::top_down(egui::Align::Max), |ui| {
                for notice in notices.0.iter().rev() {
                    let palette = theme::of(ui);
                    let edge = if notice.is_problem { palette.problem } else { palette.accent };
                    palette.card(edge).show(ui, |ui| {
                        ui.set_max_width(theme::NOTICE_WIDTH);
                        let text = egui::RichText::new(&notice.text).color(palette.text);
                        // The card is right-aligned, its text left-aligned.
                        let lines = egui::Layout::top_down(egui::Align::Min);
                        let label = ui.with_layout(lines, |ui| ui.label(text)).inner;
                        // Screen readers announce the message.
                        ui.ctx().accesskit_node_builder(label.id, |node| {
                            node.set_role(Role::Status);
                            node.set_live(Live::Polite);
                        });
                    });
                }
            });
        });
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_latest_messages_are_kept() {
        let mut notices = Notices::default();
        for number in 0..10 {
            notices.info(number.to_string());
        }
        notices.info("7".to_owned());
        let texts: Vec<&str> = notices.0.iter().map(|notice| notice.text.as_str()).collect();
        assert_eq!(texts, ["6", "8", "9", "7"]);
    }
}
