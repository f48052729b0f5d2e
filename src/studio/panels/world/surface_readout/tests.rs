//! Tests of the readings of surfaces, in panels of several widths.

use super::lane_column::in_joules;
use super::*;
use crate::studio::panels::testing::{
    self, Sent, assert_fits, assert_no_overlap, assert_shows, climber, climber_lane, shows,
};
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::ui::decimals::in_percent;
use egui_kittest::kittest::Queryable;
use snakes_core::save::shipped_champion;
use snakes_core::score::Recording;
use snakes_core::world::Surface;

/// Creates a lane of a snake at a time at which it touches the ground, and the same lane on ice.
fn on_stone_and_ice() -> [Lane; 2] {
    let stone = climber(0, "climber");
    let mut trial = stone.trial().clone();
    trial.surface.friction = 0.03;
    let ice = stone.in_world(&trial, "a long name of a changed world".to_owned());
    [(stone, 0), (ice, 1)].map(|(staged, number)| {
        let mut lane = Lane::new(staged, number);
        lane.show(1.3, None, 3000).expect("healthy");
        assert!(lane.readings.meter.surface(false, |_| true).is_some());
        lane
    })
}

fn panel<'a>(lanes: Vec<&'a Lane>, surface: ReadSurface, width: f32) -> Sent<'a> {
    testing::panel([width, 400.0], move |ui| draw(ui, &lanes, surface))
}

fn draw(ui: &mut egui::Ui, lanes: &[&Lane], surface: ReadSurface) {
    theme::apply(ui.ctx());
    let (lanes, are_named) = (lanes.to_vec(), lanes.len() > 1);
    ReadLanes { lanes, are_named, is_playing: false }.ui(ui, surface);
}

#[test]
fn the_numbers_are_those_of_the_shown_moment() {
    let [lane, _] = on_stone_and_ice();
    let reading = lane.readings.meter.surface(false, |_| true).expect("contact");
    let panel = panel(vec![&lane], ReadSurface::Stairs, 320.0);
    let grip = in_percent(reading.grip_share.expect("friction"));
    for label in [
        "On stairs and ground now".to_owned(),
        format!("{:.2} m/s", reading.slip_m_s),
        format!("Grip used: {grip}"),
        in_mm(reading.depth_m),
        in_watts(reading.lost_w),
        in_joules(lane.readings.energy_lost.expect("undisturbed").elsewhere_j()),
    ] {
        assert!(shows(&panel, &label), "{label}");
    }
}

#[test]
fn a_what_if_has_both_snakes_side_by_side_and_fits_at_every_width() {
    let lanes = on_stone_and_ice();
    for width in [280.0, 348.0, 600.0] {
        let panel = panel(lanes.iter().collect(), ReadSurface::Stairs, width);
        let [left, right] = [&lanes[0], &lanes[1]].map(|lane| {
            let reading = lane.readings.meter.surface(false, |_| true).expect("contact");
            let label = format!("{:.2} m/s", reading.slip_m_s);
            panel.get_by_label(&label).rect()
        });
        assert!(left.right() < right.left() && left.center().y == right.center().y);
        assert!(shows(&panel, "climber") && shows(&panel, "a long name"));
        assert_fits(&panel, width);
    }
}

#[test]
fn pointing_at_a_number_explains_it_limb_by_limb() {
    let [lane, _] = on_stone_and_ice();
    let reading = lane.readings.meter.surface(false, |_| true).expect("contact");
    let mut panel = panel(vec![&lane], ReadSurface::Stairs, 420.0);
    let slip = panel.get_by_label(&format!("{:.2} m/s", reading.slip_m_s)).rect();
    panel.hover_at(slip.center());
    panel.run_steps(60);
    assert!(shows(&panel, &format!("Fastest point: {:.2} m/s", reading.top_slip_m_s)));
    let limbs = (1..=5).filter(|limb| shows(&panel, &format!("Block {limb}"))).count();
    let touches = |limb: &usize| lane.readings.meter.limb(false, *limb, |_| true).is_some();
    assert_eq!(limbs, (0..5).filter(touches).count());
    assert_eq!(limbs, reading.limbs);
}

#[test]
fn without_contact_it_says_none_and_a_recording_has_no_readings() {
    let start = climber_lane(0, "climber");
    let at_start = panel(vec![&start], ReadSurface::Stairs, 320.0);
    assert!(shows(&at_start, "none") && shows(&at_start, "Slip speed"));
    let mut loaded = shipped_champion().expect("well formed");
    loaded.recording = Some(Recording::of(&loaded.champion.genome, &loaded.champion.trial));
    loaded.engine.version = 1;
    let recorded = Lane::new(StagedChampion::from_file(&loaded, 0, "climber"), 0);
    let panel = panel(vec![&recorded], ReadSurface::Stairs, 320.0);
    assert!(shows(&panel, "Not available in a recording") && !shows(&panel, "Slip speed"));
}

#[test]
fn a_ground_of_its_own_has_readings_of_its_own() {
    let [shared, _] = on_stone_and_ice();
    assert!(!shows(&panel(vec![&shared], ReadSurface::Ground, 320.0), "On the ground now"));
    let mut trial = shared.trial().clone();
    trial.ground = Some(Surface { friction: 0.5, ..Default::default() });
    let mut own = Lane::new(shared.staged.in_world(&trial, "own".to_owned()), 0);
    own.show(0.9, None, 3000).expect("healthy");
    let ground = panel(vec![&own], ReadSurface::Ground, 320.0);
    assert!(shows(&ground, "On the ground now") && shows(&ground, "of 5 blocks"));
    let stairs = panel(vec![&own], ReadSurface::Stairs, 320.0);
    assert!(shows(&stairs, "On the stairs now") && shows(&stairs, "none"), "far from them");
}

#[test]
fn the_values_of_five_snakes_are_whole_in_the_narrowest_panel() {
    let [stone, ice] = on_stone_and_ice();
    // The width includes the margins of the test's window.
    let width = 320.0 + 16.0;
    let panel = panel(vec![&stone, &ice, &stone, &ice, &stone], ReadSurface::Stairs, width);
    assert_fits(&panel, width);
    for lane in [&stone, &ice] {
        let reading = lane.readings.meter.surface(false, |_| true).expect("contact");
        let lost = in_joules(lane.readings.energy_lost.expect("undisturbed").elsewhere_j());
        let grip = format!("{:>5}", in_percent(reading.grip_share.expect("friction")));
        for label in [in_m_s(reading.slip_m_s), grip, in_watts(reading.lost_w), lost] {
            // A label that is not truncated has the width of its text in the monospaced font.
            let font = egui::TextStyle::Monospace.resolve(&panel.ctx.global_style());
            let whole = panel.ctx.fonts_mut(|fonts| {
                fonts.layout_no_wrap(label.clone(), font, egui::Color32::BLACK).size().x
            });
            let shown: Vec<f32> =
                panel.query_all_by_label(&label).map(|value| value.rect().width()).collect();
            assert!(!shown.is_empty(), "{label}");
            assert!(shown.iter().all(|width| *width >= whole - 0.5), "{label}: {shown:?}, {whole}");
        }
    }
    assert!(shows(&panel, "of 5") && !shows(&panel, "of 5 blocks"), "short in narrow columns");
    assert_eq!((in_m_s(9.99), in_m_s(12.34)), ("9.99 m/s".to_owned(), "12.3 m/s".to_owned()));
}

#[test]
fn the_columns_of_one_settings_values_are_told_apart_by_their_values() {
    let [_, ice] = on_stone_and_ice();
    let changed = |friction: &str| {
        let staged = ice.staged.in_world(ice.trial(), format!("friction {friction}"));
        let mut lane = Lane::new(staged, 1);
        lane.show(1.0, None, 3000).expect("healthy");
        lane
    };
    let lanes = ["0.05", "0.018", "0.13"].map(changed);
    let panel = panel(lanes.iter().collect(), ReadSurface::Stairs, 320.0 + 16.0);
    assert_shows(&panel, &["…0.05", "…0.018", "…0.13"]);
}

#[test]
fn a23_texts_do_not_overlap_in_the_frame_after_a_change_is_discarded() {
    let [stone, ice] = on_stone_and_ice();
    let shown = std::cell::Cell::new(2);
    let mut panel = testing::panel([384.0, 400.0], |ui| {
        draw(ui, &[&stone, &ice][..shown.get()], ReadSurface::Stairs);
    });
    shown.set(1);
    panel.step();
    assert_no_overlap(&panel, egui::Rect::EVERYTHING, 9, 1.0);
}
