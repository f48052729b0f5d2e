//! Helper functions for tests of panels: panels without a window, clicks, assertions, champions, reports.

use std::collections::BTreeSet;

use bevy_egui::egui;
use egui_kittest::kittest::Queryable;
use egui_kittest::{Harness, HarnessBuilder};

use super::settings::every_setting;
use crate::studio::commands::{Command, PlanCommand};
use crate::studio::stage::lane::Lane;
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::state::current_run::next_generation;
use snakes_core::evolve::{RunPlan, Settings, with_fields};
use snakes_core::genome::{ControllerKind, Genome};
use snakes_core::rng::{Purpose, stream};
use snakes_core::save::{load_preset, shipped_champion};
use snakes_lab::run::{Experiment, GenerationReport};

/// A panel without a window, and the commands that it sent.
pub(super) type Sent<'a> = Harness<'a, Vec<Command>>;

/// Creates a panel of this size, in points, and runs its first frames.
pub(super) fn panel<'a>(size: [f32; 2], draw: impl FnMut(&mut egui::Ui) + 'a) -> Sent<'a> {
    built(Harness::builder(), size, draw)
}

/// Creates a panel whose frames take a sixtieth of a second: so short that a slider does not come to rest within a drag, and that two
/// clicks count as a double click.
pub(super) fn panel_at_60_hz<'a>(size: [f32; 2], draw: impl FnMut(&mut egui::Ui) + 'a) -> Sent<'a> {
    built(Harness::builder().with_step_dt(1.0 / 60.0), size, draw)
}

fn built<'a>(
    builder: HarnessBuilder<Vec<Command>>,
    size: [f32; 2],
    mut draw: impl FnMut(&mut egui::Ui) + 'a,
) -> Sent<'a> {
    let draw = move |ui: &mut egui::Ui, sent: &mut Vec<Command>| {
        draw(ui);
        sent.extend(Command::take_sent(ui));
    };
    let mut panel = builder.with_size(egui::Vec2::from(size)).build_ui_state(draw, Vec::new());
    panel.run();
    panel
}

/// Clicks on the element with this label. Returns all commands that the panel has sent.
pub(super) fn clicked(panel: &mut Sent<'_>, label: &str) -> Vec<Command> {
    panel.get_by_label(label).click();
    panel.run();
    panel.state().clone()
}

/// Calls `act` on a panel. Returns all commands that the panel has sent.
pub(super) fn sent_by(mut panel: Sent<'_>, act: impl FnOnce(&mut Sent<'_>)) -> Vec<Command> {
    act(&mut panel);
    panel.run();
    panel.state().clone()
}

/// Returns whether a panel shows a label that contains this text.
pub(super) fn shows<S>(panel: &Harness<'_, S>, text: &str) -> bool {
    panel.query_all_by_label_contains(text).next().is_some()
}

/// Focuses the field with this label, and types into it.
pub(super) fn type_into<S>(panel: &mut Harness<'_, S>, label: &str, text: &str) {
    panel.get_by_label(label).focus();
    panel.run();
    panel.get_by_label(label).type_text(text);
    panel.run();
}

/// Presses a key.
pub(super) fn press<S>(panel: &mut Harness<'_, S>, key: egui::Key) {
    panel.key_press(key);
    panel.run();
}

/// Asserts that labels and controls fit into a panel of this width, in points.
pub(super) fn assert_fits<S>(harness: &Harness<'_, S>, width: f32) {
    use egui::accesskit::Role;
    let roles =
        [Role::Label, Role::Slider, Role::TextInput, Role::Button, Role::CheckBox, Role::ComboBox];
    for node in roles.into_iter().flat_map(|role| harness.query_all_by_role(role)) {
        let rect = node.rect();
        let is_inside = rect.left() >= 0.0 && rect.right() <= width;
        assert!(is_inside, "{rect:?} of {width} points: {node:?}");
    }
}

/// Asserts that a panel has labels that contain these texts.
pub(super) fn assert_shows<S>(panel: &Harness<'_, S>, texts: &[&str]) {
    for text in texts {
        assert!(shows(panel, text), "{text}");
    }
}

/// Clicks on the element with this label.
pub(super) fn click<S>(panel: &mut Harness<'_, S>, label: &str) {
    panel.get_by_label(label).click();
    panel.run();
}

/// Clicks at a position, in points.
pub(super) fn click_at<S>(panel: &mut Harness<'_, S>, at: egui::Pos2) {
    panel.drag_at(at);
    panel.run();
    panel.drop_at(at);
    panel.run();
}

/// Returns the titles of all sections.
pub(super) fn every_section() -> BTreeSet<String> {
    every_setting().into_iter().map(|listed| listed.section.title.to_owned()).collect()
}

/// Asserts that a part of a panel has at least `least` texts, and that no two of them overlap by more than `touch` points.
pub(super) fn assert_no_overlap<S>(
    panel: &Harness<'_, S>,
    part: egui::Rect,
    least: usize,
    touch: f32,
) {
    let texts = panel.output().shapes.iter().filter_map(|clipped| match &clipped.shape {
        egui::Shape::Text(text) if part.contains(text.pos) => {
            let rect = clipped.shape.visual_bounding_rect().shrink(touch);
            Some((text.galley.text().to_owned(), rect))
        }
        _ => None,
    });
    let texts: Vec<_> = texts.collect();
    assert!(texts.len() >= least, "{texts:?}");
    for (index, (text, rect)) in texts.iter().enumerate() {
        for (other, beside) in &texts[index + 1..] {
            assert!(!rect.intersects(*beside), "{text} {rect} and {other} {beside}");
        }
    }
}

/// Returns the command that sets a field of the next run.
pub(super) fn set(field: &str, text: &str) -> Command {
    Command::Plan(PlanCommand::SetField { field: field.to_owned(), text: text.to_owned() })
}

/// Returns the built-in climber under another name.
pub(super) fn climber(number: usize, name: &str) -> StagedChampion {
    StagedChampion::from_file(&shipped_champion().expect("well formed"), number, name)
}

/// Returns a lane of the built-in climber under another name; the first lane is 0.
pub(super) fn climber_lane(number: usize, name: &str) -> Lane {
    Lane::new(climber(number, name), number)
}

/// Creates a random snake with a controller, in a world with changes from that of the preset `climb`.
pub(super) fn random_snake(
    kind: ControllerKind,
    fields: &[(&str, &str)],
    change: impl FnOnce(&mut Genome),
) -> StagedChampion {
    let settings = load_preset("climb").expect("shipped").settings;
    let mut settings = with_fields(&settings, fields.iter().copied()).expect("allowed");
    settings.genome.controller = kind;
    let mut rng = stream(1, 1, 3, Purpose::Birth);
    let mut loaded = shipped_champion().expect("well formed");
    let champion = &mut loaded.champion;
    champion.genome = settings.genome.random_genome(settings.trial.genome_shape(), &mut rng);
    change(&mut champion.genome);
    champion.trial = settings.trial;
    StagedChampion::from_file(&loaded, 0, "a snake")
}

/// Returns the report of the first generation of a run of four snakes for half a second.
pub(super) fn report_of(seed: u64) -> GenerationReport {
    let mut settings = Settings::default();
    settings.evolution.population = 4;
    settings.trial.duration_s = 0.5;
    let mut experiment = Experiment::new(RunPlan::new("test", seed, settings));
    next_generation(&mut experiment)
}
