//! Readings of contacts and of energy, from the shipped champion on several surfaces.

use super::*;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::staged_champion::StagedChampion;
use snakes_core::save::{load_preset, shipped_champion};
use snakes_core::score::Trial;
use snakes_core::world::Vector;

/// Creates a lane with the shipped champion in an edited world.
fn lane_in(edit: impl FnOnce(&mut Trial)) -> Lane {
    let staged = StagedChampion::from_file(&shipped_champion().expect("well formed"), 0, "one");
    let mut trial = staged.trial().clone();
    edit(&mut trial);
    Lane::new(staged.in_world(&trial, "edited".to_owned()), 0)
}

/// Creates a lane with the shipped champion, on the surface of a preset if one is named.
fn lane(preset: Option<&str>) -> Lane {
    let preset = preset.map(|name| load_preset(name).expect("shipped"));
    lane_in(|trial| preset.into_iter().for_each(|of| trial.surface = of.settings.trial.surface))
}

fn reading(lane: &Lane) -> Option<SurfaceReading> {
    lane.readings.meter.surface(false, |_| true)
}

#[test]
fn a_jump_gives_the_readings_of_playing_to_the_same_moment() {
    let (mut played, mut sought) = (lane(None), lane(None));
    sought.finish_lookahead();
    let mut seen = 0;
    for step in 1..=600 {
        played.show(f64::from(step) / 60.0, None, 3000).expect("healthy");
    }
    for back in 0..30 {
        let time_s = 10.0 - f64::from(back) / 3.0;
        let mut again = lane(None);
        again.show(time_s, None, 3000).expect("healthy");
        sought.show(time_s, None, 3000).expect("healthy");
        for is_playing in [false, true] {
            let of = |lane: &Lane| lane.readings.meter.surface(is_playing, |_| true);
            assert_eq!(of(&sought), of(&again), "at {time_s} s");
        }
        if back == 0 {
            assert_eq!(reading(&sought), reading(&played));
        }
        assert_eq!(sought.readings.energy_lost, again.readings.energy_lost);
        seen += usize::from(reading(&sought).is_some());
    }
    assert!(seen > 15, "it touches something at {seen} moments");
}

#[test]
fn while_the_stage_plays_a_reading_stays_for_an_eighth_of_a_second() {
    let mut lane = lane(None);
    let (mut held, mut fresh) = (0, 0);
    let mut before = (None, None);
    for step in 1..=240 {
        lane.show(f64::from(step) / 60.0, None, 3000).expect("healthy");
        let meter = &lane.readings.meter;
        let now = (meter.surface(true, |_| true), meter.surface(false, |_| true));
        held += usize::from(now.0 != before.0);
        fresh += usize::from(now.1 != before.1);
        before = now;
    }
    assert!((15..=35).contains(&held), "{held} changes in 4 s");
    assert!(fresh > 2 * held, "{fresh} changes without holding");
}

#[test]
fn ice_uses_nearly_all_grip_glue_little_and_mud_is_dented_and_takes_energy() {
    let over_time = |mut lane: Lane| {
        let mut readings = Vec::new();
        for quarter in 1..=56 {
            lane.show(f64::from(quarter) / 4.0, None, 3000).expect("healthy");
            readings.extend(reading(&lane));
        }
        let mean = |of: fn(&SurfaceReading) -> f32| {
            readings.iter().map(of).sum::<f32>() / readings.len() as f32
        };
        [mean(|one| one.grip_share.unwrap_or(0.0)), mean(|one| one.depth_m), mean(|one| one.lost_w)]
    };
    let [own, ice, mud] = [None, Some("ice"), Some("mud")].map(|preset| over_time(lane(preset)));
    let glue = over_time(lane_in(|trial| trial.surface.friction = 5.0));
    assert!(ice[0] > 0.85 && own[0] < 0.85 && glue[0] < 0.4, "{ice:?} {own:?} {glue:?}");
    assert!(mud[1] > 0.2 && own[1] < 0.05, "{mud:?} {own:?}");
    assert!(mud[2] > 3.0 * own[2], "{mud:?} {own:?}");
}

#[test]
fn the_fine_print_of_a_limb_covers_only_that_limb() {
    let mut lane = lane(Some("mud"));
    lane.show(1.0, None, 3000).expect("healthy");
    let meter = &lane.readings.meter;
    let all = meter.surface(false, |_| true).expect("it lies in mud");
    let limbs: Vec<_> = (0..5).filter_map(|limb| meter.limb(false, limb, |_| true)).collect();
    let deepest_m = limbs.iter().map(|limb| limb.depth_m).fold(0.0, f32::max);
    assert!(limbs.len() > 2 && limbs.iter().all(|limb| limb.limbs == 1), "{limbs:?}");
    assert_eq!(deepest_m, all.depth_m);
    assert_eq!(meter.surface(false, |touched| touched == TouchedSurface::Limb(0)), None);
}

#[test]
fn a_fast_step_rate_takes_no_more_samples() {
    let mut lane = lane_in(|trial| trial.physics.steps_per_s = 960);
    lane.show(2.0, None, 3000).expect("healthy");
    let samples = lane.readings.meter.samples.len();
    assert!((20..=25).contains(&samples), "{samples} samples of 0.375 s");
}

/// Presets with all kinds of surfaces; `None` is the champion's own surface.
const SURFACES: [Option<&str>; 6] =
    [None, Some("ice"), Some("rubber"), Some("moon"), Some("mud"), Some("trampoline")];

#[test]
fn on_every_surface_contacts_and_stops_lose_energy_and_slipping_limbs_give_none() {
    for preset in SURFACES {
        let mut lane = lane(preset);
        let (mut given_w, mut taken_w) = (0.0, 0.0);
        for step in 1..=840 {
            lane.show(f64::from(step) / 60.0, None, 3000).expect("healthy");
            if step % 6 == 0 {
                let lost = lane.readings.energy_lost.expect("undisturbed");
                // The lost energy rises steadily: at 5 kW, the torques lose some hundred watts in impacts and stops.
                let least_j = if step >= 30 { (0.1 * lost.total_j).max(-10.0) } else { -10.0 };
                assert!(lost.elsewhere_j() > least_j, "{preset:?} after step {step}: {lost:?}");
            }
            for patch in lane.replay.simulation().expect("simulated").contact_patches() {
                given_w -= patch.friction_w.min(0.0);
                taken_w += patch.friction_w.max(0.0);
            }
        }
        assert!(given_w < 0.1 * taken_w, "{preset:?}: {given_w} W given, {taken_w} W taken");
    }
}

#[test]
fn a_dent_in_the_ground_is_as_deep_as_the_lowest_corner_of_the_limb_is_below_it() {
    for preset in [Some("mud"), Some("trampoline")] {
        let mut lane = lane(preset);
        let mut deepest_m = 0.0_f32;
        for step in 1..=300 {
            lane.show(f64::from(step) / 60.0, None, 3000).expect("healthy");
            for patch in lane.replay.simulation().expect("simulated").contact_patches() {
                if patch.touched != TouchedSurface::Ground {
                    continue;
                }
                let half = lane.body.parts[patch.limb].size_m().map(|size| size / 2.0);
                let pose = lane.replay.poses()[patch.limb];
                let corners = (0..8_u8).map(|corner| {
                    let side = |axis: usize| if corner & (1 << axis) == 0 { 1.0 } else { -1.0 };
                    let at = std::array::from_fn(|axis| side(axis) * half[axis]);
                    (pose * Vector::from_array(at)).z
                });
                let lowest_z_m = corners.fold(f32::MAX, f32::min);
                assert!(
                    patch.depth_m <= -lowest_z_m + 0.05,
                    "{preset:?}: {patch:?}, {lowest_z_m} m"
                );
                deepest_m = deepest_m.max(patch.depth_m);
            }
        }
        assert!(deepest_m > 0.3, "{preset:?}: {deepest_m} m");
    }
}
