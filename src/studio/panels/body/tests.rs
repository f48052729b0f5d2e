//! Tests of the body panel.

use super::*;
use crate::studio::panels::testing::{
    assert_shows, click, click_at, climber, panel, random_snake, shows,
};
use crate::studio::state::body_editor::BodyEditor;
use crate::studio::state::current_run::prepared_run;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use snakes_core::genome::ControllerKind;

/// The editor and the panel.
type Edit = (BodyEditor, BodyPanel);

/// Creates the panel while the body of the built-in champion is edited.
fn editing(width: f32) -> Harness<'static, Edit> {
    let staged = climber(0, "climber");
    let mut editor = BodyEditor::default();
    editor.apply(&BodyCommand::Edit, Some(&staged), &mut prepared_run()).expect("a gait");
    let mut harness = Harness::builder().with_size(egui::vec2(width, 800.0)).build_ui_state(
        |ui, (editor, panel): &mut Edit| panel.ui(ui, editor.edited(), None, None),
        (editor, BodyPanel::default()),
    );
    harness.run();
    harness
}

#[test]
fn a_click_selects_a_block_and_its_buttons_change_it() {
    let mut harness = editing(theme::PANEL_WIDTH);
    assert!(harness.query_by_label("Head").is_some());
    assert!(harness.query_by_label("Bend limit").is_none(), "the head has no joint");
    let blocks = harness.get_by_label("Drawing of the blocks").rect();
    // The position of the fourth of five equal blocks, with the head on the right.
    let at = egui::pos2(blocks.left() + blocks.width() * 0.3, blocks.center().y - 20.0);
    click_at(&mut harness, at);
    assert!(harness.query_by_label("Block 4 of 5").is_some());
    assert!(harness.query_all_by_label("Bend limit").next().is_some());
    click(&mut harness, "Split");
    let split = BodyCommand::Change { block: 3, change: BodyChange::Split };
    assert_eq!(Command::take_sent(&harness.ctx), [Command::Body(split)]);
}

#[test]
fn a22_limits_of_joints_are_shown_in_degrees_and_set_in_radians() {
    let mut harness = editing(theme::PANEL_WIDTH);
    harness.state_mut().1.block = 2;
    harness.run();
    let segment = harness.state().0.edited().expect("editing").segments[2].clone();
    let shown = format!("{:.1}°", segment.bend_limit_rad.to_degrees());
    let shown = shown.replace(".0°", "°");
    assert!(harness.query_by_value(&shown).is_some() || shows(&harness, &shown), "{shown}");
    assert!(!shows(&harness, " rad"));
}

#[test]
fn a11_a_body_that_cannot_be_edited_says_why_before_a_click() {
    let lane = Lane::new(random_snake(ControllerKind::Ctrnn, &[], |_| {}), 0);
    let mut of = BodyPanel::default();
    let mut harness = panel([theme::PANEL_WIDTH, 600.0], |ui| of.ui(ui, None, Some(&lane), None));
    assert!(shows(&harness, "cannot follow a changed body: only gaits and waves do"));
    click(&mut harness, "Edit this body");
    assert_eq!(*harness.state(), []);
}

#[test]
fn a_block_becomes_soft_and_rigid_again() {
    let mut harness = editing(theme::PANEL_WIDTH);
    assert!(harness.query_by_label("Young's modulus").is_none());
    click(&mut harness, "Soft");
    let edited = harness.state().0.edited().expect("editing");
    let value = BlockSize::usual_modulus_pa(&edited.segments[0]);
    let size = BlockSize::Modulus;
    let soften = BodyCommand::Set { block: 0, size, value };
    assert_eq!(Command::take_sent(&harness.ctx), [Command::Body(soften.clone())]);
    let (editor, _) = harness.state_mut();
    editor.apply(&soften, None, &mut prepared_run()).expect("allowed");
    assert_eq!(editor.edited().expect("editing").body.parts_of(0).len(), 3);
    harness.run();
    assert!(harness.query_by_label("Young's modulus").is_some());
    click(&mut harness, "Soft");
    let rigid = BodyCommand::MakeRigid { block: 0 };
    assert_eq!(Command::take_sent(&harness.ctx), [Command::Body(rigid.clone())]);
    let (editor, _) = harness.state_mut();
    editor.apply(&rigid, None, &mut prepared_run()).expect("allowed");
    let edited = editor.edited().expect("editing");
    assert_eq!((edited.body.springs.len(), edited.steps), (0, [true, false]));
}

#[test]
fn budgets_are_in_words_and_nothing_is_undone_before_the_first_change() {
    for width in [300.0, 900.0] {
        let mut harness = editing(width);
        assert_shows(&harness, &["Volume", "Length", "Torque", "the original has"]);
        click(&mut harness, "Undo");
        assert_eq!(Command::take_sent(&harness.ctx), [], "there is nothing to undo");
        click(&mut harness, "Adapt the gait");
        assert_eq!(Command::take_sent(&harness.ctx), [Command::Body(BodyCommand::Tune)]);
    }
}

#[test]
fn without_a_snake_the_panel_says_what_will_be_there() {
    let harness = panel([800.0, 600.0], |ui| BodyPanel::default().ui(ui, None, None, None));
    assert!(shows(&harness, "will appear here"));
}
