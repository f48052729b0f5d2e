//! Basic and advanced settings of a section. The advanced settings are below a fold, except those with unusual values,
//! so that what is special about a surface is always visible.

use std::collections::BTreeSet;
use std::sync::Arc;

use bevy_egui::egui;

use super::form::Sheet;
use crate::studio::commands::{Command, WindowCommand};
use crate::studio::ui::accessible::named_selected;
use crate::studio::ui::text_rows::weak;
use snakes_core::schema::{ListedSetting, Section};

impl Sheet {
    /// Unfolds the advanced settings of the sections with these titles.
    pub fn unfold(&mut self, sections: &BTreeSet<String>) {
        self.unfolded.extend(sections.iter().cloned());
    }

    /// Draws the settings of a section, with the advanced ones below a fold, and the section's reset button.
    pub fn section(&mut self, ui: &mut egui::Ui, section: Section) {
        let values = Arc::clone(&self.values);
        let is_open = self.unfolded.contains(section.title);
        let listed = values.listed.iter().filter(|listed| listed.section == section);
        for listed in listed.filter(|listed| values.is_special(listed)) {
            self.kept.insert(listed.path.clone());
        }
        let kept = self.kept.clone();
        let is_below = |listed: &ListedSetting| {
            listed.setting.is_advanced && (is_open || !kept.contains(&listed.path))
        };
        self.entries(ui, section, |listed| !is_below(listed));
        let below = self.in_section(section).filter(|listed| is_below(listed)).count();
        if below > 0 {
            let label = weak(ui, format!("Advanced ({below})"));
            let said = format!("Advanced settings of {}", section.title);
            if self.fold(ui, section.title, label, &said) {
                self.entries(ui, section, is_below);
            }
        }
        self.reset_section(ui, section);
    }

    /// Draws a fold whose state is remembered, and returns whether it is open. `said` is its name for accessibility tools.
    pub fn fold(
        &mut self,
        ui: &mut egui::Ui,
        section: &'static str,
        label: egui::RichText,
        said: &str,
    ) -> bool {
        let is_open = self.unfolded.contains(section);
        let header = egui::CollapsingHeader::new(label)
            .id_salt(("advanced", section))
            .open(Some(is_open))
            .show_unindented(ui, |_| {})
            .header_response;
        let kind = egui::WidgetType::CollapsingHeader;
        if named_selected(header, kind, is_open, said).clicked() {
            self.kept.clear();
            // Removes the title of an open section, or else adds it.
            if !self.unfolded.remove(section) {
                self.unfolded.insert(section.to_owned());
            }
            let is_open = !is_open;
            self.sent.push(Command::Window(WindowCommand::Fold { section, is_open }));
        }
        is_open
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::testing::{Sent, click, panel, shows};
    use crate::studio::state::current_run::{CurrentRun, prepared_run};
    use snakes_core::score::Trial;

    /// Creates the section of the surface, with these sections unfolded.
    fn surface<'a>(run: &'a CurrentRun, unfolded: &[&str]) -> Sent<'a> {
        let mut sheet = Sheet::default();
        sheet.unfold(&unfolded.iter().map(|title| (*title).to_owned()).collect());
        panel([400.0, 900.0], move |ui| {
            sheet.begin(ui, run);
            sheet.section(ui, Trial::SURFACE);
            sheet.send(ui);
        })
    }

    #[test]
    fn advanced_settings_are_below_a_fold_that_a_click_opens_and_closes() {
        let run = prepared_run();
        let mut panel = surface(&run, &[]);
        assert!(shows(&panel, "Friction") && shows(&panel, "Softness"));
        assert!(!shows(&panel, "Creep"));
        let fold = "Advanced settings of Surface";
        click(&mut panel, fold);
        assert!(shows(&panel, "Creep") && shows(&panel, "Springiness"));
        click(&mut panel, fold);
        assert!(!shows(&panel, "Creep"));
        let command =
            |is_open| Command::Window(WindowCommand::Fold { section: "Surface", is_open });
        assert_eq!(*panel.state(), [command(true), command(false)]);
    }

    #[test]
    fn a_fold_that_was_open_is_open_again() {
        let run = prepared_run();
        assert!(shows(&surface(&run, &["Surface"]), "Creep"));
        assert!(!shows(&surface(&run, &["Joints"]), "Creep"));
    }

    #[test]
    fn an_advanced_setting_that_is_not_as_usual_is_always_shown() {
        let mut run = prepared_run();
        run.set_field("surface.slip_m_s_per_n", "0.25").expect("allowed");
        let panel = surface(&run, &[]);
        assert!(shows(&panel, "Creep") && !shows(&panel, "Springiness"), "changed");
        drop(panel);
        run.set_preset("mud").expect("shipped");
        let panel = surface(&run, &[]);
        assert!(shows(&panel, "Damping") && shows(&panel, "Springiness"), "what makes mud");
        assert!(!shows(&panel, "Bounce velocity"));
    }
}
