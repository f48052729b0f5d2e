//! Short messages over the stage: what was found, what went wrong.

use std::time::Duration;

use bevy::prelude::*;
use bevy_egui::egui::accesskit::{Live, Role};
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};

use super::look;

/// The messages on show, the oldest first.
#[derive(Resource, Debug, Default)]
pub(super) struct Notices(Vec<Notice>);

#[derive(Debug)]
struct Notice {
    text: String,
    is_problem: bool,
    shown_for: Duration,
}

/// How long good news stays.
const NEWS: Duration = Duration::from_secs(8);
/// How long a problem stays, which takes longer to read and matters more.
const PROBLEM: Duration = Duration::from_secs(16);
/// More than this many at once would cover the stage; the oldest goes.
const MOST: usize = 4;

impl Notice {
    fn is_over(&self) -> bool {
        self.shown_for >= if self.is_problem { PROBLEM } else { NEWS }
    }
}

impl Notices {
    /// Something good to know.
    pub fn news(&mut self, text: String) {
        self.push(text, false);
    }

    /// Something that went wrong.
    pub fn problem(&mut self, text: String) {
        error!("{text}");
        self.push(text, true);
    }

    /// What went wrong, if anything did.
    pub fn problems(&mut self, text: Option<String>) {
        text.into_iter().for_each(|text| self.problem(text));
    }

    /// How many are on show.
    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    fn push(&mut self, text: String, is_problem: bool) {
        // Said again, it is said once, and for longer.
        self.0.retain(|notice| notice.text != text);
        self.0.push(Notice { text, is_problem, shown_for: Duration::ZERO });
        let surplus = self.0.len().saturating_sub(MOST);
        self.0.drain(..surplus);
    }
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Notices>().add_systems(EguiPrimaryContextPass, draw);
}

fn draw(mut contexts: EguiContexts, mut notices: ResMut<Notices>, time: Res<Time<Real>>) -> Result {
    notices.0.iter_mut().for_each(|notice| notice.shown_for += time.delta());
    notices.0.retain(|notice| !notice.is_over());
    let context = contexts.ctx_mut()?;
    egui::Area::new(egui::Id::new("notices"))
        .anchor(egui::Align2::RIGHT_TOP, [-look::GAP * 2.0, look::NOTICES_TOP])
        .interactable(false)
        .show(context, |ui| {
            ui.spacing_mut().item_spacing.y = look::GAP;
            ui.with_layout(egui::Layout::top_down(egui::Align::Max), |ui| {
                for notice in notices.0.iter().rev() {
                    let palette = look::of(ui);
                    let edge = if notice.is_problem { palette.problem } else { palette.accent };
                    palette.card(edge).show(ui, |ui| {
                        ui.set_max_width(look::NOTICE_WIDTH);
                        let text = egui::RichText::new(&notice.text).color(palette.text);
                        // The card keeps to the right; its lines begin at the left.
                        let lines = egui::Layout::top_down(egui::Align::Min);
                        let label = ui.with_layout(lines, |ui| ui.label(text)).inner;
                        // A screen reader says it when it comes.
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
    fn only_the_latest_notices_are_kept() {
        let mut notices = Notices::default();
        for number in 0..10 {
            notices.news(number.to_string());
        }
        notices.news("7".to_owned());
        let texts: Vec<&str> = notices.0.iter().map(|notice| notice.text.as_str()).collect();
        assert_eq!(texts, ["6", "8", "9", "7"]);
    }
}
