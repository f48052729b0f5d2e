//! Confetti from the finish when a snake lands during playback.
//!
//! The position of a piece depends only on its lane and the time since the landing, so a repeated landing looks the
//! same. After a jump in time there is no confetti, and neither in pictures without a window.

use bevy::prelude::*;

use super::landing::{FINISH_M, finish_y_m};
use super::props::in_scene;
use super::surface_texture::random;
use crate::studio::schedule::FrameSet;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::playback::Playback;
use crate::studio::ui::theme::{Palette, Theme};
use snakes_core::world::Stairs;

/// Gizmo group of the pieces, which are thick lines.
#[derive(Default, Reflect, GizmoConfigGroup)]
struct Pieces;

/// Number of pieces per landing.
const PIECES: u32 = 44;
/// Duration of the pieces' flight, in simulated seconds.
const FLIGHT_S: f64 = 2.0;
/// Width of a piece in pixels, and its length in metres.
const PIECE_PIXELS: f32 = 6.0;
const PIECE_M: f32 = 0.17;
/// Longest real time between two frames of playback, in seconds. A longer time counts as a jump.
const LONGEST_FRAME_S: f64 = 0.6;

/// Lanes with confetti in the air, and the playback time of the last frame.
#[derive(Debug, Default)]
struct Celebration {
    lanes: Vec<usize>,
    time_s: f64,
}

pub(crate) fn plugin(app: &mut App) {
    let line = GizmoLineConfig { width: PIECE_PIXELS, ..default() };
    app.insert_gizmo_config(Pieces, GizmoConfig { line, ..default() })
        .add_systems(Update, throw.in_set(FrameSet::Draw));
}

impl Celebration {
    /// Advances to the playback time. `landings` are the lanes that have landed by then, with the time of each landing in seconds.
    fn pass(&mut self, playback: &Playback, landings: impl Iterator<Item = (usize, f64)>) {
        let (before_s, now_s) = (self.time_s, playback.time_s());
        self.time_s = now_s;
        let longest_s = LONGEST_FRAME_S * f64::from(playback.speed());
        if !(0.0..=longest_s).contains(&(now_s - before_s)) {
            self.lanes.clear();
            return;
        }
        if playback.is_playing {
            let new = landings.filter(|(_, landed_s)| *landed_s > before_s && *landed_s <= now_s);
            self.lanes.extend(new.map(|(lane, _)| lane));
        }
    }
}

fn throw(
    lanes: Query<Ref<Lane>>,
    playback: Res<Playback>,
    theme: Res<Theme>,
    mut celebration: Local<Celebration>,
    mut gizmos: Gizmos<Pieces>,
) {
    if lanes.iter().any(|lane| lane.is_added()) {
        celebration.lanes.clear();
    }
    let now_s = playback.time_s();
    let racing = || lanes.iter().filter(|lane| !lane.is_ghost);
    let landings = racing().filter_map(|lane| lane.landed_s(now_s).map(|at_s| (lane.number, at_s)));
    celebration.pass(&playback, landings);
    if celebration.lanes.is_empty() {
        return;
    }
    for lane in racing().filter(|lane| celebration.lanes.contains(&lane.number)) {
        let Some(landed_s) = lane.landed_s(now_s) else { continue };
        let since_s = now_s - landed_s;
        if since_s < FLIGHT_S {
            draw(&lane, since_s as f32, theme.palette(), &mut gizmos);
        }
    }
}

/// Draws the confetti of a lane, `since_s` seconds after its landing.
fn draw(lane: &Lane, since_s: f32, palette: &Palette, gizmos: &mut Gizmos<Pieces>) {
    let opacity = ((FLIGHT_S as f32 - since_s) / 0.5).clamp(0.0, 1.0);
    for piece in 0..PIECES {
        let color = in_scene(palette.lane_color(piece as usize)).with_alpha(opacity);
        let (at, along) = piece_at(&lane.trial().stairs, lane.number, piece, since_s);
        let (at, half) = (lane.offset() + at, along * (PIECE_M / 2.0));
        gizmos.line(at - half, at + half, color);
    }
}

/// Computes the position of a piece in its lane, in metres, and its direction.
fn piece_at(stairs: &Stairs, lane: usize, piece: u32, since_s: f32) -> (Vec3, Vec3) {
    let share = |salt: u32| random(lane as u32, piece * 8 + salt, 41);
    let top_m = stairs.height_m(stairs.steps);
    let across_m = (share(0) - 0.5) * stairs.width_m;
    let start = Vec3::new(across_m, finish_y_m(stairs), top_m + FINISH_M);
    let thrown_m_s =
        Vec3::new((share(1) - 0.5) * 2.6, (share(2) - 0.5) * 4.0, 1.4 + share(3) * 2.4);
    // Paper soon falls at a constant speed, because of its drag.
    const DRAG_PER_S: f32 = 1.8;
    let falls_m_s = 1.6 + share(4) * 0.9;
    let flown_s = (1.0 - libm::expf(-DRAG_PER_S * since_s)) / DRAG_PER_S;
    let at = start + (thrown_m_s + Vec3::Z * falls_m_s) * flown_s - Vec3::Z * falls_m_s * since_s;
    let (sin, cos) = libm::sincosf(share(5) * 6.3 + since_s * (5.0 + share(6) * 6.0));
    let along = Vec3::new(cos * 0.6, sin, cos * 0.8).normalize_or(Vec3::X);
    (at.with_z(at.z.max(top_m + 0.03)), along)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LANDED_S: f64 = 3.0;

    /// Returns the lanes with confetti after frames at these times, in seconds.
    fn celebrated(times_s: &[f64], is_playing: bool) -> Vec<usize> {
        let mut celebration = Celebration::default();
        for time_s in times_s {
            let mut playback = Playback::default();
            playback.seek(*time_s, 100.0);
            if !is_playing {
                playback.hold_at(*time_s);
            }
            let landings = (*time_s >= LANDED_S).then_some((2, LANDED_S));
            celebration.pass(&playback, landings.into_iter());
        }
        celebration.lanes
    }

    #[test]
    fn confetti_flies_after_a_landing_that_was_played_and_not_after_a_jump() {
        for (times_s, is_playing, lanes) in [
            (&[2.4, 2.9, 3.1, 3.5][..], true, &[2][..]),
            // Not landed yet, a jump over the landing, a jump back, and held.
            (&[2.4, 2.9], true, &[]),
            (&[0.1, 3.1, 3.2], true, &[]),
            (&[2.9, 3.1, 1.0, 4.0], true, &[]),
            (&[2.9, 3.1], false, &[]),
        ] {
            assert_eq!(celebrated(times_s, is_playing), lanes, "{times_s:?}");
        }
    }

    #[test]
    fn a_piece_is_where_lane_and_time_put_it_and_never_below_the_landing() {
        let stairs = Stairs::default();
        let seen = |lane, since_s| (0..PIECES).map(move |piece| (lane, piece, since_s));
        for (lane, piece, since_s) in seen(0, 0.0).chain(seen(3, 0.7)).chain(seen(9, 2.0)) {
            let (at, along) = piece_at(&stairs, lane, piece, since_s);
            assert_eq!((at, along), piece_at(&stairs, lane, piece, since_s));
            assert!((5.0..12.0).contains(&at.z) && at.is_finite(), "{at}");
            assert!((at.y - 21.2).abs() < 3.0 && at.x.abs() < 5.0, "{at}");
            assert!((along.length() - 1.0).abs() < 1.0e-4);
        }
        assert_ne!(piece_at(&stairs, 0, 1, 0.5), piece_at(&stairs, 1, 1, 0.5));
    }
}
