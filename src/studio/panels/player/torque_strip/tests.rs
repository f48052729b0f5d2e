//! Tests of clicks and drags on the torque strip.

use super::*;
use crate::studio::panels::testing::{Sent, climber_lane, panel, shows};
use crate::studio::stage::staged_champion::StagedChampion;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use snakes_core::save::shipped_champion;

const SPAN: TimelineSpan = TimelineSpan { end_s: 15.0, hides_future: false };

/// Creates a strip whose state are the moments that were requested. Its end, in simulated seconds, depends on them.
fn strip_until(lane: &Lane, end_s: fn(&[f64]) -> f64) -> Harness<'_, Vec<f64>> {
    let mut strip = TorqueStrip::default();
    let draw = move |ui: &mut egui::Ui, moments: &mut Vec<f64>| {
        let span = TimelineSpan { end_s: end_s(moments), ..SPAN };
        moments.extend(strip.ui(ui, (lane, None), 1.0, span, 60.0));
    };
    Harness::builder().with_size(egui::vec2(600.0, 100.0)).build_ui_state(draw, Vec::new())
}

/// Creates a strip with torques at the time `now_s`, in simulated seconds, and points at the mark of the landing.
fn pointed_at_landing(lane: &Lane, now_s: f64, span: TimelineSpan, width: f32) -> Sent<'_> {
    let mut strip = TorqueStrip::default();
    let mut harness = panel([width, 140.0], move |ui| {
        strip.ui(ui, (lane, None), now_s, span, theme::TORQUE_STRIP_HEIGHT);
    });
    let strip = harness.get_by_label("Time, in simulated seconds").rect();
    let share = lane.landed_s(f64::INFINITY).expect("it climbs") / 15.0;
    harness.hover_at(strip.lerp_inside(egui::vec2(share as f32, 0.05)));
    harness.run();
    harness
}

#[test]
fn a_click_or_a_drag_seeks_to_the_time_under_the_pointer() {
    let lane = climber_lane(0, "climber");
    let mut harness = strip_until(&lane, |_| SPAN.end_s);
    let strip = harness.get_by_label("Time, in simulated seconds").rect();
    let at = |share: f32| strip.lerp_inside(egui::vec2(share, 0.5));
    harness.hover_at(at(0.5));
    harness.drag_at(at(0.5));
    harness.drop_at(at(0.5));
    harness.run();
    let clicked = harness.state().last().copied().expect("a moment");
    assert!((clicked - 7.5).abs() < 0.1, "{clicked} s");
    harness.drag_at(at(0.2));
    harness.run();
    harness.hover_at(at(2.0));
    harness.run();
    let dragged = harness.state().last().copied().expect("a moment");
    assert_eq!(dragged, 15.0, "beyond the end is the end");
    harness.drop_at(at(2.0));
}

#[test]
fn a_strip_that_grows_while_it_is_pressed_keeps_its_scale_until_the_release() {
    let lane = climber_lane(0, "climber");
    // When the pointer goes back for the first time, the pull that ended the trial is undone.
    let mut harness = strip_until(&lane, |moments| if moments.is_empty() { 4.0 } else { 15.0 });
    let strip = harness.get_by_label("Time, in simulated seconds").rect();
    let at = strip.lerp_inside(egui::vec2(0.25, 0.5));
    harness.hover_at(at);
    harness.drag_at(at);
    harness.run();
    harness.run();
    harness.drop_at(at);
    harness.run();
    let moments = harness.state().clone();
    assert!(moments.len() > 2, "{moments:?}");
    assert!(moments.iter().all(|moment| (moment - 1.0).abs() < 0.05), "{moments:?}");
    harness.drag_at(at);
    harness.run();
    let next = harness.state().last().copied().expect("a moment");
    assert!((next - 3.75).abs() < 0.1, "{next} s on the new scale");
}

#[test]
fn the_legend_names_unit_and_marks_and_a_mark_has_a_hover_text() {
    let mut lane = climber_lane(0, "climber");
    lane.finish_lookahead();
    for width in [900.0, 420.0] {
        let harness = pointed_at_landing(&lane, 1.0, SPAN, width);
        let legend = harness.get_by_label_contains("Legend: ").rect();
        assert!(legend.right() <= width, "{legend:?}");
        assert!(shows(&harness, "N·m, bend, twist"), "{width}");
        assert!(shows(&harness, "step climbed, step lost") || width < 500.0, "{width}");
        let hover = harness.query_all_by_label_contains("Top of the stairs reached").count();
        assert_eq!(hover, 1, "{width}");
        assert!(harness.query_all_by_label_contains("Joint 4 (tail): bend").count() == 1);
    }
}

#[test]
fn with_a_hidden_future_marks_and_torques_appear_only_once_they_have_happened() {
    let loaded = shipped_champion().expect("well formed");
    let mut lane = Lane::new(StagedChampion::from_lesson(&loaded.champion), 0);
    lane.finish_lookahead();
    let landed_s = lane.landed_s(f64::INFINITY).expect("it climbs");
    let span = TimelineSpan { hides_future: true, ..SPAN };
    for (now_s, is_seen) in [(1.0, false), (landed_s + 0.1, true)] {
        let harness = pointed_at_landing(&lane, now_s, span, 600.0);
        for text in ["Top of the stairs reached", "Joint 4 (tail): bend"] {
            assert_eq!(shows(&harness, text), is_seen, "{text} at {now_s} s");
        }
    }
}

#[test]
fn a_selected_limb_limits_the_rows_to_its_joints() {
    let lane = climber_lane(0, "climber");
    for (limb, joints) in [(None, vec![0, 1, 2, 3]), (Some(0), vec![0]), (Some(2), vec![1, 2])] {
        assert_eq!(joints_of(&lane.body, limb), joints);
    }
}
