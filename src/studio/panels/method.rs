//! Which method the next run uses: strategy, controller, and the way to the report's run and back.

use bevy_egui::egui;

use crate::evolve::StrategyKind;
use crate::genome::ControllerKind;
use crate::studio::command::Command;
use crate::studio::evolution::Evolution;
use crate::studio::look;

/// Draws the choices and adds what was asked for.
pub(super) fn method(ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
    let settings = run.next_settings();
    let (strategy, controller) = (settings.evolution.strategy, settings.genome.controller);
    ui.horizontal(|ui| {
        let list = egui::ComboBox::from_id_salt("strategy")
            .selected_text(strategy.title())
            .width(look::COMBO_WIDTH)
            .show_ui(ui, |ui| {
                for kind in StrategyKind::ALL {
                    let choice = ui.selectable_label(kind == strategy, kind.title());
                    if choice.on_hover_text(kind.words()).clicked() {
                        asked.push(set("evolution.strategy", kind.name()));
                    }
                }
            });
        named(&list.response, "Strategy");
        list.response.on_hover_text(format!("Strategy. {}", strategy.words()));
        let list = egui::ComboBox::from_id_salt("controller")
            .selected_text(title(controller))
            .width(look::CONTROLLER_WIDTH)
            .show_ui(ui, |ui| {
                for kind in ControllerKind::ALL {
                    let choice = ui.selectable_label(kind == controller, title(kind));
                    if choice.on_hover_text(sentence(kind)).clicked() {
                        asked.push(set("genome.controller", kind.name()));
                    }
                }
            });
        named(&list.response, "Controller");
        list.response.on_hover_text(format!("Controller. {}", sentence(controller)));
    });
}

/// Draws the way to the report's run, or back to the climb, and adds what was asked for.
pub(super) fn preset_switch(ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
    let (label, preset, hint) = if run.next_preset() == REPORT {
        ("The climb", CLIMB, "Take the preset that climbs to the top for the next run")
    } else {
        ("The report's run", REPORT, "Take the report's own method and world for the next run")
    };
    if ui.small_button(label).on_hover_text(hint).clicked() {
        asked.push(Command::SetPreset(preset.to_owned()));
    }
}

/// Names a list that has no room for its name beside it.
fn named(list: &egui::Response, name: &str) {
    list.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::ComboBox, true, name));
}

/// The preset of the report's run.
const REPORT: &str = "report";
/// The preset of the climb to the landing.
const CLIMB: &str = "climb";

fn set(field: &str, text: &str) -> Command {
    Command::SetField { field: field.to_owned(), text: text.to_owned() }
}

fn title(kind: ControllerKind) -> &'static str {
    match kind {
        ControllerKind::Signal => "Signal",
        ControllerKind::Wave => "Wave",
        ControllerKind::Gait => "Gait",
    }
}

/// What a controller is, as a sentence.
fn sentence(kind: ControllerKind) -> String {
    let mut letters = kind.words().chars();
    let first = letters.next().map(|letter| letter.to_uppercase().to_string());
    format!("{}{}.", first.unwrap_or_default(), letters.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::evolution::prepared_run;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    /// What is sent when a person clicks on one label after another.
    fn sent(run: &Evolution, labels: &[&str]) -> Vec<Command> {
        let size = egui::vec2(look::PANEL_WIDTH, 600.0);
        let mut harness = Harness::builder().with_size(size).build_ui_state(
            |ui, asked| {
                preset_switch(ui, run, asked);
                method(ui, run, asked);
            },
            Vec::new(),
        );
        for label in labels {
            match label.strip_prefix("list ") {
                Some(list) => {
                    let role = egui::accesskit::Role::ComboBox;
                    harness.get_by_role_and_label(role, list).click();
                }
                None => harness.get_by_label(label).click(),
            }
            harness.run();
        }
        harness.state().clone()
    }

    #[test]
    fn every_strategy_and_controller_can_be_chosen() {
        let run = prepared_run();
        for kind in &StrategyKind::ALL[1..] {
            let asked = sent(&run, &["list Strategy", kind.title()]);
            assert_eq!(asked, [set("evolution.strategy", kind.name())]);
        }
        for kind in &ControllerKind::ALL[1..] {
            let asked = sent(&run, &["list Controller", title(*kind)]);
            assert_eq!(asked, [set("genome.controller", kind.name())]);
        }
    }

    #[test]
    fn the_reports_run_and_the_climb_are_a_click_from_each_other() {
        let mut run = prepared_run();
        assert_eq!(sent(&run, &["The climb"]), [Command::SetPreset("climb".to_owned())]);
        run.set_preset("climb").expect("shipped");
        assert_eq!(sent(&run, &["The report's run"]), [Command::SetPreset("report".to_owned())]);
    }
}
