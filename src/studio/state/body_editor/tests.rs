//! Tests of the editor of bodies.

use super::*;
use crate::studio::state::current_run::{RunStatus, climber, prepared_run};
use snakes_core::save::shipped_champion;
use snakes_core::world::PhysicsEngine;

fn editing() -> (BodyEditor, CurrentRun) {
    let (mut editor, mut run) = (BodyEditor::default(), prepared_run());
    editor.apply(&BodyCommand::Edit, Some(&climber(0)), &mut run).expect("a gait");
    (editor, run)
}

fn lengths(editor: &BodyEditor) -> Vec<f32> {
    let edited = editor.edited().expect("editing");
    edited.body.parts.iter().map(|limb| limb.length_m).collect()
}

/// Waits until a preview is ready, or until no background work is in progress. Returns the preview.
fn preview(editor: &mut BodyEditor, run: &mut CurrentRun) -> Option<Show> {
    let mut notices = Notices::default();
    while !editor.follow(&mut notices) {
        let edited = editor.edited.as_ref().expect("editing");
        let is_idle = edited.changed_at.is_none() && edited.evaluation.is_none();
        if is_idle && edited.tuning.is_none() {
            return None;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    editor.apply(&BodyCommand::Preview, None, run).expect("allowed at any time")
}

#[test]
fn a_drag_of_a_slider_is_one_step_and_can_be_undone() {
    let (mut editor, mut run) = editing();
    let mut apply = |editor: &mut BodyEditor, command| {
        editor.apply(&command, None, &mut run).expect("allowed");
    };
    for value in [1.9, 1.7, 1.5] {
        let set = BodyCommand::Set { block: 1, size: BlockSize::Length, value };
        apply(&mut editor, set);
    }
    apply(&mut editor, BodyCommand::Change { block: 0, change: BodyChange::Split });
    assert_eq!(lengths(&editor).len(), 6);
    apply(&mut editor, BodyCommand::Undo);
    assert_eq!(lengths(&editor), [2.0, 1.5, 2.0, 2.0, 2.0]);
    apply(&mut editor, BodyCommand::Undo);
    assert_eq!(lengths(&editor), [2.0; 5]);
    apply(&mut editor, BodyCommand::Redo);
    assert_eq!(lengths(&editor)[1], 1.5);
    assert_eq!(editor.edited().expect("editing").steps, [true, true]);
}

#[test]
fn a_soft_block_does_not_change_the_engine() {
    let mut loaded = shipped_champion().expect("well formed");
    let champion = &mut loaded.champion;
    champion.trial.physics.engine = PhysicsEngine::Lanes;
    champion.evaluation = evaluate(&champion.genome, &champion.trial);
    let original = StagedChampion::from_file(&loaded, 0, "in lanes");
    let (mut editor, mut run) = (BodyEditor::default(), prepared_run());
    editor.apply(&BodyCommand::Edit, Some(&original), &mut run).expect("a gait");
    let soft = BodyCommand::Set { block: 2, size: BlockSize::Modulus, value: 40_000.0 };
    editor.apply(&soft, None, &mut run).expect("allowed");
    let shown = preview(&mut editor, &mut run).expect("a preview");
    let engines = shown.champions.iter().map(|staged| staged.trial().physics.engine);
    assert!(engines.eq([PhysicsEngine::Lanes; 2]));
}

#[test]
fn the_preview_shows_both_snakes_and_a_forbidden_body_gives_its_reason() {
    let (mut editor, mut run) = editing();
    let set = |value| BodyCommand::Set { block: 2, size: BlockSize::Width, value };
    editor.apply(&set(0.8), None, &mut run).expect("allowed");
    let champions = preview(&mut editor, &mut run).expect("both").champions;
    let blocks = |staged: &StagedChampion| staged.body().parts[2].width_m;
    assert_eq!(champions.iter().map(blocks).collect::<Vec<_>>(), [0.8, 1.0]);
    // The block has a hundredth of its neighbours' mass.
    editor.apply(&set(0.1), None, &mut run).expect("it can be set");
    let problem = editor.edited().expect("editing").problem.expect("refused");
    assert!(problem.contains("segments[2]") || problem.contains("segments[1]"), "{problem}");
    assert!(editor.apply(&BodyCommand::Evolve, None, &mut run).is_err());
    assert!(preview(&mut editor, &mut run).is_none());
    // A second drag of the same slider is a separate undo step.
    editor.apply(&BodyCommand::Undo, None, &mut run).expect("allowed");
    let width = editor.edited().expect("editing").body.parts[2].width_m;
    assert_eq!(width, 0.8);
}

#[test]
fn a_change_just_before_a_tuning_is_shown_and_the_next_tuning_tries_other_gaits() {
    let (mut editor, mut run) = editing();
    let set = BodyCommand::Set { block: 1, size: BlockSize::Height, value: 0.9 };
    editor.apply(&set, None, &mut run).expect("allowed");
    editor.apply(&BodyCommand::Tune, None, &mut run).expect("it begins");
    let undo = editor.apply(&BodyCommand::Undo, None, &mut run).expect_err("busy");
    assert!(undo.contains("being tuned"), "{undo}");
    editor.apply(&BodyCommand::CancelTuning, None, &mut run).expect("allowed");
    let champions = preview(&mut editor, &mut run).expect("both").champions;
    assert_eq!(champions[0].body().parts[1].height_m, 0.9);
    assert_eq!(editor.edited.as_ref().map(|edited| edited.attempts), Some(1));
}

#[test]
fn a_run_starts_from_the_edited_body_and_closes_the_editor() {
    let (mut editor, mut run) = editing();
    let change = BodyCommand::Change { block: 3, change: BodyChange::Duplicate };
    editor.apply(&change, None, &mut run).expect("allowed");
    editor.apply(&BodyCommand::Evolve, None, &mut run).expect("a founder");
    assert_eq!((editor.edited().is_none(), run.status()), (true, RunStatus::Running));
    assert_eq!(run.next_founder(), Some("climber, edited"));
    assert!(run.next_settings().genome.bodies.vary);
}

#[test]
fn a_changed_body_is_unsaved_until_it_is_saved_as_it_is_now() {
    let (mut editor, mut run) = editing();
    let is_unsaved = |editor: &BodyEditor| editor.edited().expect("editing").is_unsaved;
    assert!(!is_unsaved(&editor) && editor.to_save().is_err(), "nothing was changed");
    for value in [0.8, 0.9] {
        let set = BodyCommand::Set { block: 1, size: BlockSize::Height, value };
        editor.apply(&set, None, &mut run).expect("allowed");
        assert!(is_unsaved(&editor) && editor.to_save().is_err(), "not simulated yet");
        let shown = preview(&mut editor, &mut run).expect("both").champions;
        editor.note_saved(&shown[1]);
        assert!(is_unsaved(&editor), "the original was saved");
        let edited = editor.to_save().expect("simulated");
        assert_eq!(edited.champion().genome, shown[0].champion().genome);
        editor.note_saved(&edited);
        assert!(!is_unsaved(&editor));
    }
}
