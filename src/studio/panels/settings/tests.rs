//! Tests that every setting is shown once, and that every control sends the value that was entered.

use std::collections::BTreeSet;

use bevy_egui::egui;
use egui_kittest::kittest::Queryable;

use super::*;
use crate::studio::commands::{Command, PlanCommand};
use crate::studio::panels::testing::{self, Sent, set};
use crate::studio::state::current_run::{CurrentRun, prepared_run};
use snakes_core::evolve::{fields, with_field, with_fields};
use snakes_core::schema::{
    ListedSetting, NumberRange, Parts, Section, SettingKind, SettingValue, list,
};

/// Creates a run in which all optional settings have values, and lower bounds of ranges are at their minimum.
fn run_with_all_given() -> CurrentRun {
    let mut run = prepared_run();
    let given = [
        ("evolution.strategy", "cma_es"),
        ("trial.ground.friction", "0.5"),
        ("trial.agent.density_kg_m3", "2"),
        ("trial.agent.bend_limit_rad", "1"),
        ("trial.agent.twist_limit_rad", "1"),
        ("trial.agent.youngs_modulus_pa", "40000"),
        ("genome.density_min_kg_m3", "0.1"),
        ("genome.wave.frequency_min_hz", "0.01"),
        ("genome.wave.stiffness_min_nm_per_rad", "0"),
    ];
    run.set_fields(&given).expect("allowed");
    run
}

/// Returns an allowed number that differs from the current one.
fn another(range: &NumberRange, now: &str, is_allowed: impl Fn(&str) -> bool) -> String {
    let [least, most] = range.slider.unwrap_or([range.least, range.most]);
    let places = [0.5, 0.25, 0.1, 0.02, 0.0].map(|share| least + (most - least) * share);
    let places = places.map(|place| if range.is_whole { place.ceil() } else { place }.to_string());
    let mut others = places.into_iter().filter(|text| text != now && is_allowed(text));
    others.next().expect("an allowed one")
}

/// Creates a panel with one setting.
fn panel_of<'a>(run: &'a CurrentRun, field: &str) -> Sent<'a> {
    let all = list(run.next_settings());
    let listed = all.into_iter().find(|listed| listed.path == field).expect("a setting");
    let mut sheet = Sheet::default();
    testing::panel_at_60_hz([320.0, 400.0], move |ui| {
        sheet.begin(ui, run);
        sheet.entry(ui, &listed);
        sheet.send(ui);
    })
}

/// Role of the only field.
const FIELD: egui::accesskit::Role = egui::accesskit::Role::TextInput;

/// Types into the only field, whose text is selected when it gets the focus, and presses Enter.
fn type_into(harness: &mut Sent<'_>, text: &str) {
    harness.get_by_role(FIELD).focus();
    harness.run();
    harness.get_by_role(FIELD).type_text(text);
    harness.run();
    testing::press(harness, egui::Key::Enter);
}

#[test]
fn every_setting_is_shown_once_by_the_panels() {
    let run = run_with_all_given();
    let mut sheet = Sheet::default();
    let context = egui::Context::default();
    drop(context.run_ui(egui::RawInput::default(), |ui| sheet.begin(ui, &run)));
    let sections: Vec<Section> = ["evolution.", "genome.", "trial."]
        .into_iter()
        .flat_map(|prefix| sheet.sections(prefix))
        .collect();
    let titles: BTreeSet<&str> = sections.iter().map(|section| section.title).collect();
    assert_eq!(titles.len(), sections.len(), "each section is there once: {sections:?}");
    let mut shown: Vec<String> = sections
        .into_iter()
        .flat_map(|section| sheet.in_section(section).map(|listed| listed.path.clone()))
        .collect();
    shown.sort();
    let there: Vec<String> =
        fields(run.next_settings()).into_iter().map(|(field, _)| field).collect();
    assert_eq!(shown, there);
}

#[test]
fn every_control_sends_the_value_that_was_entered() {
    let run = run_with_all_given();
    let settings = run.next_settings();
    for listed in list(settings) {
        let (full, now) = (listed.path, listed.value.to_string());
        let mut panel = panel_of(&run, &full);
        let expected = match &listed.setting.kind {
            SettingKind::Number(range) => {
                let is_allowed = |text: &str| with_field(settings, &full, text).is_ok();
                let text = another(range, &now, is_allowed);
                // The user types the value in the unit of panels.
                let shown = listed.setting.shown_text(&text);
                type_into(&mut panel, &shown);
                listed.setting.stored_text(&shown).expect("a number")
            }
            SettingKind::List(_) => {
                type_into(&mut panel, "45, 90");
                format!("[{}, {}]", 45.0_f32.to_radians(), 90.0_f32.to_radians())
            }
            SettingKind::Choice(choices) => {
                let choices = choices();
                let taken = |name: &str| with_field(settings, &full, name).is_ok();
                let other = choices.iter().find(|choice| choice.name != now && taken(choice.name));
                let other = other.expect("two that are allowed");
                panel.get_by_role(egui::accesskit::Role::ComboBox).click();
                panel.run();
                panel.get_by_label(other.title).click();
                other.name.to_owned()
            }
            SettingKind::Switch => {
                panel.get_by_role(egui::accesskit::Role::CheckBox).click();
                if now == "true" { "false".to_owned() } else { "true".to_owned() }
            }
            SettingKind::Absent(_) => panic!("{full} is not there"),
        };
        panel.run();
        let sent = match &panel.state()[..] {
            [Command::Plan(PlanCommand::SetField { field, text })] => (field.clone(), text.clone()),
            other => panic!("{full}: {other:?}"),
        };
        assert_eq!(sent, (full.clone(), expected.clone()));
        let mut changes = vec![(full.as_str(), expected.as_str())];
        changes.extend(settings.partner_changes(&full, &expected));
        let changed = with_fields(settings, changes).expect(&full);
        assert_ne!(changed, *settings, "{full} = {expected}");
    }
}

#[test]
fn every_setting_has_a_label_a_hint_and_a_unit_and_every_choice_a_sentence() {
    let mut labels = BTreeSet::new();
    for listed in every_setting() {
        let ListedSetting { path: full, section, setting: entry, .. } = listed;
        assert!(entry.hint.len() > 5 && !entry.hint.ends_with('.'), "{full}: {}", entry.hint);
        assert!(entry.label.chars().next().is_some_and(char::is_uppercase), "{full}");
        assert!(!entry.label.contains('_'), "{full}");
        let has_unit = ["_m", "_s", "_rad", "_hz", "_nm"].iter().any(|unit| full.ends_with(unit));
        let says_unit = !entry.unit.is_empty() || entry.label.ends_with("per second");
        assert!(!has_unit || says_unit, "{full} has a unit");
        // Labels are unique within a section.
        assert!(labels.insert((section.title, entry.label)), "{full}");
        let SettingKind::Choice(choices) = entry.kind else { continue };
        for choice in choices() {
            assert!(choice.sentence.len() > 15 && choice.sentence.ends_with('.'), "{choice:?}");
        }
    }
}

#[test]
fn invalid_text_stays_with_its_reason_and_nothing_is_sent() {
    let run = prepared_run();
    let mut panel = panel_of(&run, "trial.stairs.rise_m");
    type_into(&mut panel, "9");
    assert_eq!(*panel.state(), []);
    let said = "Rise is \"9\"; allowed: -5 to -0.01 or 0.01 to 5 m";
    assert!(panel.query_by_label_contains(said).is_some());
    assert_eq!(panel.get_by_role(FIELD).value().as_deref(), Some("9"), "to be corrected");
    type_into(&mut panel, "4");
    assert_eq!(*panel.state(), [set("trial.stairs.rise_m", "4")], "beyond the slider's end");
}

/// Clicks on a label, and returns the commands that were sent.
fn clicked(run: &CurrentRun, field: &str, label: &str) -> Vec<Command> {
    testing::clicked(&mut panel_of(run, field), label)
}

#[test]
fn one_value_becomes_a_list_and_back() {
    let mut run = prepared_run();
    let width = "trial.agent.limb_width_m";
    let switch = "Block width: block by block";
    let commands = clicked(&run, width, switch);
    assert_eq!(commands, [set(width, "[1, 1, 1, 1, 1]")]);
    run.set_field(width, "[1.5, 1, 1, 1, 1]").expect("allowed");
    let commands = clicked(&run, width, switch);
    assert_eq!(commands, [set(width, "1.5")]);
    let torque = "trial.agent.max_bend_torque_nm";
    let commands = clicked(&run, torque, "Maximum bend torque: joint by joint");
    assert_eq!(commands, [set(torque, "[1000, 1000, 1000, 1000]")]);
}

#[test]
fn one_limb_changes_without_the_others() {
    let mut run = prepared_run();
    run.set_field("trial.agent.limb_width_m", "[1.5, 1, 1, 1, 1]").expect("allowed");
    let mut panel = panel_of(&run, "trial.agent.limb_width_m");
    let slider = "Block width of block 3";
    let role = egui::accesskit::Role::Slider;
    let rail = panel.get_by_role_and_label(role, slider).rect();
    panel.drag_at(rail.left_center() + egui::vec2(6.0, 0.0));
    panel.run();
    panel.drop_at(rail.center());
    panel.run();
    let [Command::Plan(PlanCommand::SetField { field, text })] = &panel.state()[..] else {
        panic!("one command")
    };
    assert_eq!(field, "trial.agent.limb_width_m");
    let numbers = values::numbers(text).expect("a list");
    assert_eq!((numbers.len(), numbers[0], numbers[1]), (5, 1.5, 1.0));
    assert!((1.2..2.0).contains(&numbers[2]), "half way along the rail: {}", numbers[2]);
}

#[test]
fn a_limit_is_optional() {
    let mut run = prepared_run();
    let commands = clicked(&run, "trial.agent.bend_limit_rad", "Bend limit, °");
    assert_eq!(commands, [set("trial.agent.bend_limit_rad", "1")]);
    run.set_field("trial.agent.bend_limit_rad", "0.5").expect("allowed");
    let mut panel = panel_of(&run, "trial.agent.bend_limit_rad");
    panel.get_by_role(egui::accesskit::Role::CheckBox).click();
    panel.run();
    assert_eq!(*panel.state(), [set("trial.agent.bend_limit_rad", "none")]);
}

#[test]
fn only_settings_that_allow_a_list_have_one_value_per_part() {
    let run = run_with_all_given();
    for listed in list(run.next_settings()) {
        let full = listed.path;
        let SettingKind::Number(range) = listed.setting.kind else { continue };
        let value: f32 = listed.value.to_string().parse().expect("a number");
        let list = SettingValue::List(vec![value; range.parts.count().max(2)]).to_string();
        let listed = with_field(run.next_settings(), &full, &list);
        assert_eq!(listed.is_ok(), range.parts != Parts::One, "{full}");
    }
}

#[test]
fn sliders_contain_the_values_of_the_built_in_presets() {
    let mut beyond = Vec::new();
    for preset in snakes_core::save::shipped_presets().expect("well formed") {
        for listed in list(&preset.settings) {
            let (full, entry) = (listed.path, listed.setting);
            let SettingKind::Number(NumberRange { slider: Some([least, most]), .. }) = entry.kind
            else {
                continue;
            };
            let Ok(value) = listed.value.to_string().parse::<f32>() else { continue };
            // Large frictions, such as 150 in the engine's manual, all have a similar effect.
            if !(least..=most).contains(&value) && entry.label != "Friction" {
                beyond.push(format!("{full} = {value} of {}", preset.name));
            }
        }
    }
    assert!(beyond.is_empty(), "{beyond:?}");
}

#[test]
fn angles_are_shown_and_typed_in_degrees_and_set_in_radians() {
    let mut run = prepared_run();
    let limit = "trial.agent.bend_limit_rad";
    run.set_field(limit, "0.6").expect("allowed");
    let mut panel = panel_of(&run, limit);
    assert_eq!(panel.get_by_role(FIELD).value().as_deref(), Some("34.38"));
    type_into(&mut panel, "34.38");
    assert_eq!(*panel.state(), [], "the value keeps the digits that are not shown");
    type_into(&mut panel, "200");
    assert!(panel.query_by_label_contains("allowed: 0 to 171.88°").is_some());
    type_into(&mut panel, "57.25");
    let radians = (57.25_f64.to_radians() as f32).to_string();
    assert_eq!(*panel.state(), [set(limit, &radians)]);
    drop(panel);
    run.set_field(limit, &radians).expect("allowed");
    let panel = panel_of(&run, limit);
    assert_eq!(panel.get_by_role(FIELD).value().as_deref(), Some("57.25"));
}

#[test]
fn no_text_of_a_panel_has_radians() {
    let run = run_with_all_given();
    for listed in list(run.next_settings()) {
        let setting = listed.setting;
        let shown = [setting.title(), setting.shown_range_in_words(), setting.hint.to_owned()];
        // A stiffness per radian is not an angle.
        let is_angle = setting.unit == "rad";
        let words = shown.iter().flat_map(|text| text.split(|c: char| !c.is_alphanumeric()));
        assert!(!is_angle || words.clone().all(|word| word != "rad"), "{}", listed.path);
        assert_eq!(is_angle, setting.display.is_some(), "{}", listed.path);
    }
}
