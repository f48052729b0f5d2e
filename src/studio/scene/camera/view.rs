//! A camera view: yaw, pitch, distance, and the distance that shows all given points.

use bevy::prelude::*;

use crate::studio::commands::camera_mode::CameraMode;

/// Camera position relative to its target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CameraView {
    /// Yaw about z, in radians: 0 looks from +x, so that the stairs rise to the right.
    pub yaw_rad: f32,
    /// Pitch above the horizon, in radians.
    pub pitch_rad: f32,
    /// Distance from the target, in metres. With several lanes in view it is a zoom relative to [`Self::DEFAULT_M`].
    pub distance_m: f32,
    /// Offset of the target, in metres; relative to the snake if the camera follows it.
    pub offset: Vec3,
}

impl CameraView {
    /// Default distance, in metres.
    pub const DEFAULT_M: f32 = 24.0;
    /// Range of distances, in metres.
    pub const DISTANCE_M: std::ops::RangeInclusive<f32> = 3.0..=120.0;
    /// Range of pitches, in radians: never quite overhead, never below the ground.
    pub const PITCH_RAD: std::ops::RangeInclusive<f32> = 0.02..=1.55;

    /// Initial view of a camera mode. Several lanes are seen more from behind, so that none hides the next.
    pub fn of(camera_mode: CameraMode, lanes: usize) -> Self {
        let (yaw_rad, pitch_rad, offset) = match camera_mode {
            // From the right, slightly behind and above, to show the stairs and the snake.
            CameraMode::Follow | CameraMode::Free if lanes <= 1 => {
                (-0.55, 0.36, Vec3::new(0.0, 3.0, 0.5))
            }
            CameraMode::Follow | CameraMode::Free => (-0.75, 0.5, Vec3::new(0.0, 1.0, 0.0)),
            CameraMode::Side => (0.0, 0.04, Vec3::new(0.0, 2.0, 1.0)),
            CameraMode::Top => (0.0, *Self::PITCH_RAD.end(), Vec3::new(0.0, 2.0, 0.0)),
        };
        Self { yaw_rad, pitch_rad, distance_m: Self::DEFAULT_M, offset }
    }

    fn turn(&self) -> Quat {
        Quat::from_rotation_z(self.yaw_rad) * Quat::from_rotation_y(-self.pitch_rad)
    }

    /// Camera transform for a target.
    pub fn looking_at(&self, target: Vec3) -> Transform {
        let eye = target + self.turn() * Vec3::X * self.distance_m;
        Transform::from_translation(eye).looking_at(target, Vec3::Z)
    }

    /// Interpolates towards another view.
    pub fn towards(&self, goal: &Self, share: f32) -> Self {
        let mix = |from: f32, to: f32| from + (to - from) * share;
        Self {
            yaw_rad: mix(self.yaw_rad, goal.yaw_rad),
            pitch_rad: mix(self.pitch_rad, goal.pitch_rad),
            distance_m: mix(self.distance_m, goal.distance_m),
            offset: self.offset.lerp(goal.offset, share),
        }
    }

    /// Whether two views look the same.
    pub fn is_near(&self, other: &Self) -> bool {
        (self.yaw_rad - other.yaw_rad).abs() < 1.0e-3
            && (self.pitch_rad - other.pitch_rad).abs() < 1.0e-3
            && (self.distance_m - other.distance_m).abs() < 1.0e-3 * other.distance_m
            && self.offset.distance(other.offset) < 2.0e-3
    }

    /// Moves back and aside until all points are in view and none of the snakes' is below the card: `card` covers a
    /// part of the picture from its left edge on, in fractions from the upper left corner. `aspect` is width over
    /// height. The previous distance acts as a zoom relative to [`Self::DEFAULT_M`].
    pub fn framing(
        self,
        target: Vec3,
        points: &[Vec3],
        snakes: &[Vec3],
        aspect: f32,
        card: Option<Rect>,
    ) -> Self {
        let beside = |left_share: f32| self.framing_beside(target, points, aspect, left_share);
        let Some(card) = card else { return beside(0.0) };
        let is_covered = |view: &Self| {
            snakes.iter().any(|at| {
                let place = view.share_of_picture(target + view.offset, *at, aspect);
                place.x < card.max.x + CARD_MARGIN
                    && place.y > card.min.y - CARD_MARGIN
                    && place.y < card.max.y + CARD_MARGIN
            })
        };
        // The narrowest strip at the left that has to stay free of everything.
        let (mut covered, mut free) = (0.0, (card.max.x + CARD_MARGIN).min(MAX_ASIDE));
        if !is_covered(&beside(covered)) {
            return beside(covered);
        }
        for _ in 0..SEARCH_STEPS {
            let middle = (covered + free) / 2.0;
            if is_covered(&beside(middle)) { covered = middle } else { free = middle }
        }
        beside(free)
    }

    /// Moves back and aside until all points are in view and none is in the leftmost `left_share` of the picture.
    fn framing_beside(self, target: Vec3, points: &[Vec3], aspect: f32, left_share: f32) -> Self {
        let zoom = self.distance_m / Self::DEFAULT_M;
        let target = target + self.offset;
        let points = points.iter().copied();
        let distance_m = self.distance_beside(target, points, aspect, left_share) * zoom;
        let half_width_m = distance_m * libm::tanf(VERTICAL_VIEW_RAD / 2.0) * aspect;
        let right = self.turn() * Vec3::Y;
        Self { distance_m, offset: self.offset - right * (half_width_m * left_share), ..self }
    }

    /// Where a point is in the picture of a view of `target`, in fractions from the upper left corner.
    fn share_of_picture(&self, target: Vec3, point: Vec3, aspect: f32) -> Vec2 {
        let at = self.turn().inverse() * (point - target);
        // In the view's frame x points at the eye, y to the right, z up.
        let half_height_m =
            (self.distance_m - at.x).max(0.01) * libm::tanf(VERTICAL_VIEW_RAD / 2.0);
        let half_width_m = half_height_m * aspect.max(0.1);
        Vec2::new(0.5 + at.y / half_width_m / 2.0, 0.5 - at.z / half_height_m / 2.0)
    }

    /// Distance from `target` at which all points are in view, in metres. `aspect` is width over height.
    pub fn distance_to_see(
        &self,
        target: Vec3,
        points: impl IntoIterator<Item = Vec3>,
        aspect: f32,
    ) -> f32 {
        self.distance_beside(target, points, aspect, 0.0)
    }

    /// As [`Self::distance_to_see`], with the leftmost `left_share` of the picture free: the camera is moved to the left
    /// by that share of half the picture's width at the target.
    fn distance_beside(
        &self,
        target: Vec3,
        points: impl IntoIterator<Item = Vec3>,
        aspect: f32,
        left_share: f32,
    ) -> f32 {
        let into_view = self.turn().inverse();
        let upright = libm::tanf(VERTICAL_VIEW_RAD / 2.0);
        let across = upright * aspect.max(0.1);
        // Edges of the content, in halves of the picture's width from its middle.
        let (right, left) = (1.0 / MARGIN, 2.0 * left_share - 1.0 / MARGIN);
        let room = across * (right - left_share);
        let needed = points.into_iter().map(|point| {
            // In the view's frame x points at the eye, y to the right, z up.
            let at = into_view * (point - target);
            let to_right = (at.y + right * across * at.x) / room;
            let to_left = (-at.y - left * across * at.x) / room;
            to_right.max(to_left).max(at.x + at.z.abs() * MARGIN / upright)
        });
        needed.fold(*Self::DISTANCE_M.start(), f32::max).min(*Self::DISTANCE_M.end())
    }
}

/// Maximum fraction of the picture that is left free for a card.
const MAX_ASIDE: f32 = 0.42;
/// Distance between a card and the centre of the nearest limb, as a fraction of the picture.
const CARD_MARGIN: f32 = 0.035;
/// Halvings of the strip that is left free: to a hundredth of the picture.
const SEARCH_STEPS: u32 = 6;
/// Bevy's default field of view, in radians.
const VERTICAL_VIEW_RAD: f32 = std::f32::consts::FRAC_PI_4;
/// Ratio of the picture's width to its content.
const MARGIN: f32 = 1.12;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn framing_fits_all_points_tightly() {
        let points = [Vec3::new(12.0, -7.0, 0.0), Vec3::new(-12.0, 21.0, 5.0), Vec3::ZERO];
        for camera_mode in CameraMode::ALL {
            for aspect in [0.7, 1.6] {
                let mut view = CameraView::of(camera_mode, 6);
                let target = Vec3::new(0.0, 7.0, 2.0);
                view.distance_m = view.distance_to_see(target, points, aspect);
                let into_eye = view.looking_at(target).to_matrix().inverse();
                let half = libm::tanf(VERTICAL_VIEW_RAD / 2.0);
                let places = points.map(|point| {
                    let at = into_eye.transform_point3(point);
                    (at.x / at.z).abs().max((at.y / at.z).abs() * aspect) / (half * aspect)
                });
                let most = places.into_iter().fold(0.0, f32::max);
                assert!(
                    (0.8..=1.0 / MARGIN + 0.01).contains(&most),
                    "{camera_mode:?} {aspect}: {most}"
                );
            }
        }
    }

    #[test]
    fn the_left_of_the_picture_can_stay_free() {
        let points = [Vec3::new(12.0, -7.0, 0.0), Vec3::new(-12.0, 21.0, 5.0), Vec3::ZERO];
        let (target, aspect) = (Vec3::new(0.0, 7.0, 2.0), 1.6);
        for camera_mode in CameraMode::ALL {
            for left_share in [0.0, 0.1, 0.25] {
                let view = CameraView::of(camera_mode, 6)
                    .framing_beside(target, &points, aspect, left_share);
                let places =
                    points.map(|point| view.share_of_picture(target + view.offset, point, aspect));
                let left = places.iter().map(|at| at.x).fold(1.0, f32::min);
                let right = places.iter().map(|at| at.x).fold(0.0, f32::max);
                assert!(left > left_share && right < 1.0, "{camera_mode:?}: {left} to {right}");
            }
        }
    }

    #[test]
    fn a_place_in_the_picture_is_where_the_camera_draws_it() {
        let (target, aspect, point) = (Vec3::new(0.0, 7.0, 2.0), 1.6, Vec3::new(3.0, 9.0, 1.0));
        let view = CameraView::of(CameraMode::Follow, 1);
        let at = view.looking_at(target).to_matrix().inverse().transform_point3(point);
        let half = libm::tanf(VERTICAL_VIEW_RAD / 2.0);
        let expected =
            Vec2::new(0.5 + at.x / -at.z / half / aspect / 2.0, 0.5 - at.y / -at.z / half / 2.0);
        let found = view.share_of_picture(target, point, aspect);
        assert!(found.distance(expected) < 1.0e-3, "{found} for {expected}");
    }

    #[test]
    fn no_snake_of_a_race_is_behind_the_leaderboard() {
        let (target, aspect) = (Vec3::new(0.0, 7.0, 2.0), 1.6);
        // Ten lanes, whose snakes have come between 0 and 21 m.
        let snakes: Vec<Vec3> = (0..10)
            .flat_map(|lane| {
                let (x, y) = (27.0 - 6.0 * lane as f32, 21.0 - (lane * 7 % 10) as f32 * 2.3);
                [Vec3::new(x, y - 9.0, 0.5), Vec3::new(x, y, 1.5)]
            })
            .collect();
        let card = Rect::new(0.01, 0.35, 0.3, 0.98);
        for camera_mode in CameraMode::ALL {
            let start = CameraView::of(camera_mode, 10);
            let view = start.framing(target, &snakes, &snakes, aspect, Some(card));
            for snake in &snakes {
                let at = view.share_of_picture(target + view.offset, *snake, aspect);
                assert!(!card.contains(at), "{camera_mode:?}: {snake} is at {at}");
                assert!((0.0..=1.0).contains(&at.x) && (0.0..=1.0).contains(&at.y), "{at}");
            }
            let plain = start.framing(target, &snakes, &snakes, aspect, None);
            assert!(view.distance_m >= plain.distance_m);
        }
    }

    #[test]
    fn a_card_that_covers_no_snake_does_not_move_the_camera() {
        let snakes = [Vec3::new(0.0, 7.0, 6.0), Vec3::new(0.0, 8.0, 6.0)];
        let view = CameraView::of(CameraMode::Side, 2);
        let target = Vec3::new(0.0, 7.0, 5.0);
        let card = Some(Rect::new(0.0, 0.9, 0.2, 1.0));
        assert_eq!(
            view.framing(target, &snakes, &snakes, 1.6, card),
            view.framing(target, &snakes, &snakes, 1.6, None)
        );
    }

    #[test]
    fn the_shots_go_around() {
        let around =
            std::iter::successors(Some(CameraMode::Follow), |camera_mode| Some(camera_mode.next()));
        let seen: Vec<CameraMode> = around.take(5).collect();
        assert_eq!((&seen[..4], seen[4]), (&CameraMode::ALL[..], CameraMode::Follow));
    }
}
