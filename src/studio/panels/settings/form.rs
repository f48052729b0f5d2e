//! Controls of settings, and the values that are being dragged or typed.
//!
//! A change of the world also starts a what-if lane on the stage. To avoid a restart for every pixel of a drag, a
//! slider takes effect at intervals: see [`Changing::takes_effect`]. Typed text takes effect when its field loses the
//! focus. Invalid text stays in the field, with the reason below.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use bevy_egui::egui;

use super::changing::Changing;
use super::values::Values;
use crate::studio::commands::{Command, PlanCommand, StageCommand};
use crate::studio::state::current_run::CurrentRun;
use crate::studio::ui::buttons::CommandButton;
use crate::studio::ui::icons::{Icon, small_icon_button};
use crate::studio::ui::theme;
use snakes_core::schema::{ListedSetting, Section, Setting, SettingKind, SettingValue};

/// Values that are being dragged or typed in the controls of a panel.
#[derive(Debug, Default)]
pub struct Sheet {
    pub(super) values: Arc<Values>,
    /// Slider that is being dragged, if any.
    pub(super) changing: Option<Changing>,
    /// Unfinished or invalid text, by the ID of its control.
    pub(super) typed: BTreeMap<String, Typed>,
    /// Number of the last frame in which the panel was drawn.
    pub(super) drawn_in: u64,
    /// Titles of the sections whose advanced settings are unfolded.
    pub(super) unfolded: BTreeSet<String>,
    /// Advanced settings that had unusual values, by their full names. They stay above the fold until the fold is used or another preset
    /// is selected. Otherwise a control would disappear under the pointer when it reaches the usual value.
    pub(super) kept: BTreeSet<String>,
    /// Whether the run in progress accepts changes, with the reason if not; `None` if no run is in progress.
    takes_changes: Option<Result<(), &'static str>>,
    /// Commands of the user: see [`Sheet::send`].
    pub(super) sent: Vec<Command>,
}

/// Typed text that has not taken effect.
#[derive(Debug)]
pub(super) struct Typed {
    pub text: String,
    /// Reason why the text is invalid; `None` while it is only unfinished.
    pub problem: Option<String>,
    /// Value of the setting when the text was typed. If the value changes, the text is removed.
    pub beside: String,
    /// Number of the last frame in which the text's control was drawn.
    pub seen_in: u64,
}

impl Sheet {
    /// Reads the current settings. Must be called before anything is drawn.
    pub fn begin(&mut self, ui: &egui::Ui, run: &CurrentRun) {
        let frame = ui.ctx().cumulative_frame_nr();
        if frame > self.drawn_in + 1 {
            // A drag is forgotten if the panel was hidden before it ended.
            self.changing = None;
        }
        self.drawn_in = frame;
        self.takes_changes = run.is_under_way().then(|| run.takes_changes());
        if !self.values.are_of(run) {
            if self.values.preset_name != run.plan_next.preset {
                self.kept.clear();
            }
            self.values = Arc::new(Values::of(run));
        }
    }

    /// Sends the user's commands. Must be called after everything is drawn.
    pub fn send(&mut self, ui: &egui::Ui) {
        Command::send_all(self.sent.drain(..), ui);
    }

    /// Returns whether a visible field contains invalid text.
    pub fn has_problem(&self) -> bool {
        let is_on_show = |typed: &Typed| typed.seen_in + 1 >= self.drawn_in;
        self.typed.values().any(|typed| typed.problem.is_some() && is_on_show(typed))
    }

    /// Stores unfinished or invalid text.
    pub fn keep(&mut self, id: &str, text: String, problem: Option<String>, beside: &str) {
        let (beside, seen_in) = (beside.to_owned(), self.drawn_in);
        self.typed.insert(id.to_owned(), Typed { text, problem, beside, seen_in });
    }

    /// Returns the sections of those settings of the next run whose full names begin with `prefix`.
    pub fn sections(&self, prefix: &str) -> Vec<Section> {
        let listed = self.values.listed.iter().filter(|listed| listed.path.starts_with(prefix));
        let mut sections: Vec<Section> = listed.map(|listed| listed.section).collect();
        // The settings of a section are adjacent.
        sections.dedup();
        sections
    }

    /// Returns the settings of a section.
    pub fn in_section(&self, section: Section) -> impl Iterator<Item = &ListedSetting> {
        self.values.listed.iter().filter(move |listed| listed.section == section)
    }

    /// Draws the settings of a section for which `is_wanted` holds.
    pub fn entries(
        &mut self,
        ui: &mut egui::Ui,
        section: Section,
        is_wanted: impl Fn(&ListedSetting) -> bool,
    ) {
        let values = Arc::clone(&self.values);
        let listed = values.listed.iter().filter(|listed| listed.section == section);
        for listed in listed.filter(|listed| is_wanted(listed)) {
            self.entry(ui, listed);
        }
    }

    /// Draws the first setting for which `is_wanted` holds, if it has an effect at present.
    pub fn knob(&mut self, ui: &mut egui::Ui, is_wanted: impl Fn(&str) -> bool) {
        let values = Arc::clone(&self.values);
        let mut used = values.listed.iter().filter(|listed| listed.is_used);
        if let Some(listed) = used.find(|listed| is_wanted(&listed.path)) {
            self.entry(ui, listed);
        }
    }

    /// Draws the button that resets a section, if a setting differs from the preset.
    pub(super) fn reset_section(&mut self, ui: &mut egui::Ui, section: Section) {
        let back = |listed: &ListedSetting| {
            Some((listed.path.clone(), self.values.changed_from(listed)?.to_string()))
        };
        let back: Vec<_> = self.in_section(section).filter_map(back).collect();
        if back.is_empty() {
            return;
        }
        let name = &self.values.preset_name;
        let hint = format!("Reset all settings of \"{}\" to the preset {name}", section.title);
        let back = Command::Plan(PlanCommand::SetFields(back));
        self.sent.extend(CommandButton::new("Reset section", hint, back).small().pressed(ui));
    }

    /// Draws a setting.
    pub fn entry(&mut self, ui: &mut egui::Ui, listed: &ListedSetting) {
        let values = Arc::clone(&self.values);
        let setting = &listed.setting;
        let live = values.live.get(&listed.path).copied().unwrap_or(Ok(()));
        let answer = self.takes_changes.map(|answer| answer.and(live));
        let shown = Shown {
            listed,
            hint: hint(setting, answer),
            values: &values,
            stored: listed.value.to_string(),
            text: setting.shown_value(&listed.value),
            is_from_next_generation: answer == Some(Ok(())),
        };
        let new = match &setting.kind {
            SettingKind::Number(range) => self.number(ui, &shown, range),
            SettingKind::List(_) => self.list(ui, &shown),
            SettingKind::Choice(choices) => self.choice(ui, &shown, &choices()),
            SettingKind::Switch => self.on_off(ui, &shown),
            SettingKind::Absent(_) => None,
        };
        self.sent.extend(new.map(|text| Command::Plan(PlanCommand::set(&listed.path, &text))));
    }

    /// Draws the sweep button beside a number of the world, and the reset button if the value differs from the preset.
    /// Returns the preset's value after a click on the reset button.
    pub(super) fn buttons(&mut self, ui: &mut egui::Ui, shown: &Shown) -> Option<String> {
        let ListedSetting { path, setting, .. } = shown.listed;
        let name = setting.label;
        let is_number = matches!(setting.kind, SettingKind::Number(_));
        if is_number && path.starts_with("trial.") {
            let label = format!("Sweep {name}");
            let hint =
                format!("Show the snake on the stage with five values of \"{name}\" side by side");
            if small_icon_button(ui, Icon::Sweep, &label, &hint).clicked() {
                self.sent.push(Command::Stage(StageCommand::Sweep(path.clone())));
            }
        }
        let preset = self.values.changed_from(shown.listed)?;
        let in_words = match preset {
            SettingValue::None => "off".to_owned(),
            other => setting.shown_value(other),
        };
        let hint = format!("Reset to the preset's value: {in_words}");
        let button = small_icon_button(ui, Icon::Reset, &format!("Reset {name}"), &hint);
        button.clicked().then(|| preset.to_string())
    }
}

/// A setting that is being drawn.
pub(super) struct Shown<'a> {
    pub listed: &'a ListedSetting,
    /// Text of the setting's tooltip.
    pub hint: String,
    /// All settings of the next run.
    pub values: &'a Values,
    /// Value as text, in the unit of files.
    pub stored: String,
    /// Value as text, in the unit of panels.
    pub text: String,
    is_from_next_generation: bool,
}

impl Shown<'_> {
    /// Draws the setting's label.
    pub fn name(&self, ui: &mut egui::Ui, width: f32) -> egui::Response {
        ui.set_max_width(width);
        if self.is_from_next_generation {
            // A dot marks a setting that may change during the run.
            let size = egui::Vec2::splat(theme::GAP);
            let (rect, response) = ui.allocate_exact_size(size, egui::Sense::hover());
            ui.painter().circle_filled(rect.center(), theme::GAP * 0.375, theme::of(ui).accent);
            response.on_hover_text("A change takes effect from the next generation");
        }
        ui.add(egui::Label::new(self.listed.setting.title()).wrap()).on_hover_text(&self.hint)
    }
}

/// Returns the text of a setting's tooltip: its effect, its range, and when a change takes effect.
fn hint(setting: &Setting, answer: Option<Result<(), &'static str>>) -> String {
    let mut hint = format!("{}.", setting.hint.trim_end_matches('.'));
    let allowed = setting.shown_range_in_words();
    if !allowed.is_empty() {
        hint += &format!("\nAllowed: {allowed}.");
    }
    if setting.display.is_some() {
        hint += &format!("\nFiles and --set have {} instead.", setting.unit);
    }
    if let Some(answer) = answer {
        let when = answer.err().unwrap_or("Takes effect from the next generation");
        hint += &format!("\n{}.", when.trim_end_matches('.'));
    }
    hint
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::settings::every_setting;

    #[test]
    fn a_tooltip_has_the_hint_the_range_and_when_a_change_takes_effect() {
        let all = every_setting();
        let listed = all.iter().find(|listed| listed.path == "evolution.generations");
        let generations = &listed.expect("a setting").setting;
        let said = hint(generations, Some(Ok(())));
        assert!(said.starts_with("Number of generations in a run."), "{said}");
        assert!(said.contains("\nAllowed: 1 to 10000, whole numbers."), "{said}");
        assert!(said.ends_with("\nTakes effect from the next generation."), "{said}");
        let later = "Takes effect with the next run, because the archive depends on it";
        let said = hint(generations, Some(Err(later)));
        assert!(said.ends_with(&format!("\n{later}.")), "{said}");
        assert!(!hint(generations, None).contains("next"), "no run is under way");
    }
}
