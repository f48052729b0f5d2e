//! Tests of the Change panel: sliders, resets, the search, and the alignment of columns.

use super::*;
use crate::studio::panels::testing::{
    Sent, assert_fits, click, every_section, panel_at_60_hz, sent_by, set, shows, type_into,
};
use crate::studio::state::current_run::prepared_run;
use crate::studio::state::undo::UndoDirection;
use egui_kittest::kittest::Queryable;

/// Calls `act` on the panel. Returns the commands that were sent.
fn sent(run: &CurrentRun, act: impl FnOnce(&mut Sent<'_>)) -> Vec<Command> {
    sent_at(run, theme::PANEL_WIDTH, &UndoHistory::default(), act)
}

/// Calls `act` on the panel, with this width in points and this history. Returns the commands that were sent.
fn sent_at(
    run: &CurrentRun,
    width: f32,
    history: &UndoHistory,
    act: impl FnOnce(&mut Sent<'_>),
) -> Vec<Command> {
    let mut panel = WorldPanel::default();
    panel.sheet.unfold(&every_section());
    let harness = panel_at_60_hz([width, 4000.0], |ui| {
        theme::apply(ui.ctx());
        panel.ui(ui, run, history, &ReadLanes::default());
    });
    sent_by(harness, act)
}

#[test]
fn the_ground_surface_starts_as_a_copy_of_the_stairs() {
    let commands = sent(&prepared_run(), |harness| {
        harness.get_by_label("The ground has its own surface").click();
    });
    assert_eq!(commands, [set("ground.friction", "1")]);
}

#[test]
fn a_changed_world_offers_a_new_run() {
    let mut run = prepared_run();
    run.single_generation().expect("started");
    run.set_field("surface.friction", "0.5").expect("allowed");
    let commands = sent(&run, |harness| harness.get_by_label("New run in this world").click());
    assert_eq!(commands, [Command::Run(RunCommand::New)]);
}

#[test]
fn a_disabled_button_for_a_new_run_says_why() {
    let mut run = prepared_run();
    for reason in ["start it in the Watch panel", "change a setting first"] {
        let commands = sent(&run, |harness| {
            harness.get_by_label("New run in this world").hover();
            harness.run_steps(60);
            assert!(shows(harness, reason), "{reason}");
        });
        assert_eq!(commands, []);
        run.single_generation().expect("started");
    }
}

#[test]
fn a_changed_value_can_be_reset_alone_or_with_its_section() {
    let mut run = prepared_run();
    run.set_preset("report").expect("shipped");
    let calm = sent(&run, |harness| {
        assert!(harness.query_by_label("Reset Friction").is_none(), "nothing differs");
    });
    assert_eq!(calm, []);
    run.set_field("surface.friction", "0.5").expect("allowed");
    run.set_field("surface.bounce", "0.25").expect("allowed");
    let preset = run.preset_settings().expect("shipped").trial.surface.clone();
    let (friction, bounce) = (preset.friction.to_string(), preset.bounce.to_string());
    let commands = sent(&run, |harness| harness.get_by_label("Reset Friction").click());
    assert_eq!(commands, [set("trial.surface.friction", &friction)]);
    let commands = sent(&run, |harness| harness.get_by_label("Reset section").click());
    let back = [("friction", friction), ("bounce", bounce)]
        .map(|(field, text)| (format!("trial.surface.{field}"), text));
    assert_eq!(commands, [Command::Plan(PlanCommand::SetFields(back.to_vec()))]);
}

#[test]
fn the_search_finds_settings_of_closed_sections_and_of_the_run_panel() {
    let run = prepared_run();
    let assert_finds = |word: &'static str, found: &'static str| {
        sent(&run, move |harness| {
            type_into(harness, "Find a setting", word);
            assert!(shows(harness, found), "{word}: {found}");
        })
    };
    assert_finds("moon", "Gravity, m/s²");
    assert_finds("Tournament", "Selection");
    assert_finds("joint DAMP", "Joint damping, N·m·s/rad");
    assert_finds("xyz", "No setting matches.");
}

#[test]
fn a10_settings_whose_section_or_name_has_the_words_come_before_those_that_mention_them() {
    let run = prepared_run();
    sent(&run, |harness| {
        type_into(harness, "Find a setting", "joint");
        let top = |label: &str| harness.query_all_by_label(label).next().map(|of| of.rect().top());
        let joints = top("Joints").expect("the section");
        let field = harness.get_by_label("Find a setting").rect();
        assert!(joints < field.bottom() + theme::GAP * 4.0, "{joints}");
        // This run uses neither decisions nor a network.
        for unused in ["XCS", "Hidden neurons"] {
            let last = harness.query_all_by_label(unused).map(|of| of.rect().top());
            let last = last.fold(f32::MAX, f32::min);
            let damping = top("Joint damping, N·m·s/rad").expect("a setting in use");
            assert!(last > damping, "{unused}: {last}");
        }
    });
}

#[test]
fn undo_and_redo_are_disabled_without_history() {
    let mut run = prepared_run();
    let mut history = UndoHistory::default();
    let off = sent_at(&run, 400.0, &history, |harness| harness.get_by_label("Undo").click());
    assert_eq!(off, []);
    let before = run.plan_next.clone();
    run.set_field("surface.friction", "0.5").expect("allowed");
    history.note(&set("trial.surface.friction", "0.5"), before, &run.plan_next);
    let on = sent_at(&run, 400.0, &history, |harness| harness.get_by_label("Undo").click());
    assert_eq!(on, [Command::Undo]);
    let step = history.take(UndoDirection::Back);
    history.complete(UndoDirection::Back, step, None);
    let on = sent_at(&run, 400.0, &history, |harness| harness.get_by_label("Redo").click());
    assert_eq!(on, [Command::Redo]);
}

#[test]
fn columns_align_and_fit_at_every_panel_width() {
    use egui::accesskit::Role;
    let mut run = prepared_run();
    // With these values, the rows are widest: reset buttons, lists of limbs, limits.
    let given = [
        ("trial.surface.soft_cfm_m_s_per_n", "0.00012345"),
        ("trial.agent.limb_width_m", "[1, 1.5, 1, 1, 1]"),
        ("trial.agent.bend_limit_rad", "1"),
        ("trial.agent.joint_damping_nms_per_rad", "12.5"),
    ];
    run.set_fields(&given).expect("allowed");
    for width in [300.0, theme::PANEL_WIDTH, 459.0, 480.0, 600.0, 900.0] {
        sent_at(&run, width, &UndoHistory::default(), |harness| {
            for title in [ADVANCED, "Body", "Repeated trials", "Disqualification"] {
                click(harness, title);
            }
            let rect = |label: &str| harness.get_by_role_and_label(Role::Slider, label).rect();
            let one = rect("Friction");
            for other in
                ["Softness (CFM), m/s per N", "Block length, m", "Joint damping, N·m·s/rad"]
            {
                let other = rect(other);
                let are_aligned = one.left() == other.left() && one.width() == other.width();
                assert!(are_aligned, "{one:?} and {other:?} at {width} points");
            }
            assert_fits(harness, width);
        });
    }
}
