//! A camera view: yaw, pitch, distance, and the computation of the distance that shows all given points.

use bevy::prelude::*;

use crate::studio::commands::camera_mode::CameraMode;

/// Camera position relative to its target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CameraView {
    /// Yaw of the camera about z, in radians: 0 looks from +x, so that the stairs rise to the right.
    pub yaw_rad: f32,
    /// Pitch of the camera above the horizon, in radians.
    pub pitch_rad: f32,
    /// Distance of the camera from its target, in metres. With several lanes in view it acts as a zoom relative to [`Self::DEFAULT_M`].
    pub distance_m: f32,
    /// Offset of the camera's target, in metres; relative to the snake if the camera follows it.
    pub offset: Vec3,
}

impl CameraView {
    /// Default distance of the camera from its target, in metres.
    pub const DEFAULT_M: f32 = 24.0;
    /// Allowed distances of the camera from its target, in metres.
    pub const DISTANCE_M: std::ops::RangeInclusive<f32> = 3.0..=120.0;
    /// Allowed pitches, in radians: never exactly overhead, never below the ground.
    pub const PITCH_RAD: std::ops::RangeInclusive<f32> = 0.02..=1.55;

    /// Returns the initial view of a camera mode. Several lanes are seen more from behind, so that they do not hide each other.
    pub fn of(camera_mode: CameraMode, lanes: usize) -> Self {
        let (yaw_rad, pitch_rad, offset) = match camera_mode {
            // The view is from the right, slightly behind and above, to show the stairs and the snake.
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

    /// Returns the transform of the camera for this target.
    pub fn looking_at(&self, target: Vec3) -> Transform {
        let eye = target + self.turn() * Vec3::X * self.distance_m;
        Transform::from_translation(eye).looking_at(target, Vec3::Z)
    }

    /// Interpolates between this view, at share 0, and another one, at share 1.
    pub fn towards(&self, goal: &Self, share: f32) -> Self {
        Self {
            yaw_rad: self.yaw_rad.lerp(goal.yaw_rad, share),
            pitch_rad: self.pitch_rad.lerp(goal.pitch_rad, share),
            distance_m: self.distance_m.lerp(goal.distance_m, share),
            offset: self.offset.lerp(goal.offset, share),
        }
    }

    /// Returns whether two views look the same.
    pub fn is_near(&self, other: &Self) -> bool {
        (self.yaw_rad - other.yaw_rad).abs() < 1.0e-3
            && (self.pitch_rad - other.pitch_rad).abs() < 1.0e-3
            && (self.distance_m - other.distance_m).abs() < 1.0e-3 * other.distance_m
            && self.offset.distance(other.offset) < 2.0e-3
    }

    /// Moves back and aside until all points are in view and no point of the snakes is below a cover. `covers` are
    /// parts of the picture at its left or right edge, in fractions from the upper left corner. `aspect` is width over
    /// height. The previous distance acts as a zoom relative to [`Self::DEFAULT_M`].
    pub fn framing(
        self,
        target: Vec3,
        points: &[Vec3],
        snakes: &[Vec3],
        aspect: f32,
        covers: &[Rect],
    ) -> Self {
        let is_at_left: fn(&Rect) -> bool = |cover| cover.center().x < 0.5;
        let at_left = || covers.iter().filter(|cover| is_at_left(cover));
        let at_right = || covers.iter().filter(|cover| !is_at_left(cover));
        let widest = |ends: f32| (ends + CARD_MARGIN).min(MAX_ASIDE);
        let left = widest(at_left().map(|cover| cover.max.x).fold(-CARD_MARGIN, f32::max));
        let right = widest(at_right().map(|cover| 1.0 - cover.min.x).fold(-CARD_MARGIN, f32::max));
        let bottom = widest(at_right().map(|cover| 1.0 - cover.min.y).fold(-CARD_MARGIN, f32::max));
        // Finds the nearest view whose margins keep the snakes clear of the covers. Each margin is no wider than needed.
        let view = |margins: FreeMargins| self.framing_beside(target, points, aspect, margins);
        let clear = |most: FreeMargins, counts: fn(&Rect) -> bool| -> Option<Self> {
            let covers = covers.iter().filter(|cover| counts(cover));
            let is_clear = |view: &Self| !view.covers_any(target, snakes, aspect, covers.clone());
            let nearest = view(FreeMargins::default());
            if is_clear(&nearest) {
                return Some(nearest);
            }
            let part = |share: f32| {
                let FreeMargins { left, right, bottom } = most;
                view(FreeMargins {
                    left: left * share,
                    right: right * share,
                    bottom: bottom * share,
                })
            };
            let (mut too_little, mut enough) = (0.0, 1.0);
            for _ in 0..SEARCH_STEPS {
                let share = (too_little + enough) / 2.0;
                if is_clear(&part(share)) { enough = share } else { too_little = share }
            }
            Some(part(enough)).filter(is_clear)
        };
        let beside_left = FreeMargins { left, ..FreeMargins::default() };
        let without_messages = clear(beside_left, is_at_left).unwrap_or_else(|| view(beside_left));
        if at_right().next().is_none() {
            return without_messages;
        }
        // Messages at the lower right leave two options: the snakes go above or beside them. The option with the larger snakes is chosen.
        let margins = [(0.0, bottom), (right, 0.0), (right, bottom)].into_iter().flat_map(
            |(right, bottom)| [0.0, left].map(|left| FreeMargins { left, right, bottom }),
        );
        let views = margins.filter_map(|margins| clear(margins, |_| true));
        let nearest = views.min_by(|a, b| a.distance_m.total_cmp(&b.distance_m));
        // Messages disappear after some seconds, which is better than tiny snakes.
        let most_m = without_messages.distance_m * MAX_FURTHER;
        nearest.filter(|view| view.distance_m <= most_m).unwrap_or(without_messages)
    }

    /// Moves aside, at the same distance, as little as is needed so that no point of the snakes is below a cover. If
    /// this is not possible, returns the view unchanged.
    pub fn beside(self, target: Vec3, snakes: &[Vec3], aspect: f32, covers: &[Rect]) -> Self {
        if covers.is_empty() {
            return self;
        }
        let half_width_m = self.distance_m * libm::tanf(VERTICAL_VIEW_RAD / 2.0) * aspect.max(0.1);
        let right = self.turn() * Vec3::Y;
        let moved =
            |share: f32| Self { offset: self.offset + right * (half_width_m * share), ..self };
        let is_free = |view: &Self| {
            let is_in_sight = |at: &Vec3| {
                let place = view.share_of_picture(target + view.offset, *at, aspect);
                (0.0..=1.0).contains(&place.x)
            };
            snakes.iter().all(is_in_sight)
                && !view.covers_any(target, snakes, aspect, covers.iter())
        };
        let steps = (0..=SHIFTS).flat_map(|step| [step as f32, -(step as f32)]);
        let mut views = steps.map(|step| moved(step * MAX_ASIDE / SHIFTS as f32));
        views.find(is_free).unwrap_or(self)
    }

    /// Returns whether a point of the snakes is below a cover or close to its edge.
    fn covers_any<'c>(
        &self,
        target: Vec3,
        snakes: &[Vec3],
        aspect: f32,
        covers: impl Iterator<Item = &'c Rect> + Clone,
    ) -> bool {
        snakes.iter().any(|at| {
            let place = self.share_of_picture(target + self.offset, *at, aspect);
            covers.clone().any(|cover| cover.inflate(CARD_MARGIN).contains(place))
        })
    }

    /// Moves back and aside until all points are in view and none is in the free margins.
    fn framing_beside(self, target: Vec3, points: &[Vec3], aspect: f32, free: FreeMargins) -> Self {
        let zoom = self.distance_m / Self::DEFAULT_M;
        let target = target + self.offset;
        let points = points.iter().copied();
        let distance_m = self.distance_to_see(target, points, aspect, free) * zoom;
        let half_height_m = distance_m * libm::tanf(VERTICAL_VIEW_RAD / 2.0);
        // The offset puts the target into the middle between the margins.
        let aside = Vec3::Y * (aspect * (free.left - free.right)) + Vec3::Z * free.bottom;
        let offset = self.offset - self.turn() * aside * half_height_m;
        Self { distance_m, offset, ..self }
    }

    /// Returns the position of a point in a view of `target`, in fractions of the picture from the upper left corner.
    fn share_of_picture(&self, target: Vec3, point: Vec3, aspect: f32) -> Vec2 {
        let at = self.turn().inverse() * (point - target);
        // In the frame of the view, x points at the eye, y to the right, z up.
        let half_height_m =
            (self.distance_m - at.x).max(0.01) * libm::tanf(VERTICAL_VIEW_RAD / 2.0);
        let half_width_m = half_height_m * aspect.max(0.1);
        Vec2::new(0.5 + at.y / half_width_m / 2.0, 0.5 - at.z / half_height_m / 2.0)
    }

    /// Returns the distance from `target` at which all points are in view beside the free margins, in metres. The target is in
    /// the middle between the margins. `aspect` is width over height.
    pub fn distance_to_see(
        &self,
        target: Vec3,
        points: impl IntoIterator<Item = Vec3>,
        aspect: f32,
        free: FreeMargins,
    ) -> f32 {
        let into_view = self.turn().inverse();
        let upright = libm::tanf(VERTICAL_VIEW_RAD / 2.0);
        let across = upright * aspect.max(0.1);
        // Edges of the content, in halves of the picture's width and height from its middle, and the width and height
        // on each side of the target.
        let edge = 1.0 / MARGIN;
        let (right, left) = (edge - 2.0 * free.right, 2.0 * free.left - edge);
        let (top, bottom) = (edge, 2.0 * free.bottom - edge);
        let wide = across * (edge - free.left - free.right);
        let high = upright * (edge - free.bottom);
        let needed = points.into_iter().map(|point| {
            // In the frame of the view, x points at the eye, y to the right, z up.
            let at = into_view * (point - target);
            let to_right = (at.y + right * across * at.x) / wide;
            let to_left = (-at.y - left * across * at.x) / wide;
            let up = (at.z + top * upright * at.x) / high;
            let down = (-at.z - bottom * upright * at.x) / high;
            to_right.max(to_left).max(up).max(down)
        });
        needed.fold(*Self::DISTANCE_M.start(), f32::max).min(*Self::DISTANCE_M.end())
    }
}

/// Margins of the picture without any points, as fractions of its width or height.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct FreeMargins {
    left: f32,
    right: f32,
    bottom: f32,
}

/// Maximum width of a free margin, as a fraction of the picture.
const MAX_ASIDE: f32 = 0.42;
/// Maximum ratio of the distances with and without messages over the stage.
const MAX_FURTHER: f32 = 1.4;
/// Number of shifts to each side that [`CameraView::beside`] tries.
const SHIFTS: u32 = 28;
/// Minimum distance between a card and the centre of the nearest limb, as a fraction of the picture.
const CARD_MARGIN: f32 = 0.035;
/// Number of halvings in the search for the width of a free margin: precise to a hundredth of the picture.
const SEARCH_STEPS: u32 = 6;
/// Vertical angle of view of the stage and of Bevy's default camera, in radians.
pub(super) const VERTICAL_VIEW_RAD: f32 = std::f32::consts::FRAC_PI_4;
/// Ratio of the picture's size to that of its content.
const MARGIN: f32 = 1.12;

/// Returns the centre of the box around points.
pub(crate) fn middle_of(points: impl IntoIterator<Item = Vec3>) -> Vec3 {
    let around = |(least, most): (Vec3, Vec3), point: Vec3| (least.min(point), most.max(point));
    let (least, most) = points.into_iter().fold((Vec3::MAX, Vec3::MIN), around);
    (least + most) / 2.0
}

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
                view.distance_m =
                    view.distance_to_see(target, points, aspect, FreeMargins::default());
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
    fn margins_of_the_picture_can_stay_free() {
        let points = [Vec3::new(12.0, -7.0, 0.0), Vec3::new(-12.0, 21.0, 5.0), Vec3::ZERO];
        let (target, aspect) = (Vec3::new(0.0, 7.0, 2.0), 1.6);
        for camera_mode in CameraMode::ALL {
            for (left, right, bottom) in [
                (0.0, 0.0, 0.0),
                (0.25, 0.0, 0.0),
                (0.1, 0.3, 0.0),
                (0.0, 0.2, 0.3),
                (0.2, 0.0, 0.4),
            ] {
                let free = FreeMargins { left, right, bottom };
                let view = CameraView::of(camera_mode, 6);
                let view = view.framing_beside(target, &points, aspect, free);
                let places =
                    points.map(|point| view.share_of_picture(target + view.offset, point, aspect));
                let from = places.iter().map(|at| at.x).fold(1.0, f32::min);
                let to = places.iter().map(|at| at.x).fold(0.0, f32::max);
                assert!(from > left && to < 1.0 - right, "{camera_mode:?}: {from} to {to}");
                let (least, most) = places.iter().fold((1.0_f32, 0.0_f32), |(least, most), at| {
                    (least.min(at.y), most.max(at.y))
                });
                assert!(least > 0.0 && most < 1.0 - bottom, "{camera_mode:?}: {least} to {most}");
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
    fn no_snake_of_a_race_is_behind_the_leaderboard_or_messages() {
        let (target, aspect) = (Vec3::new(0.0, 7.0, 2.0), 1.6);
        // Ten lanes, whose snakes are between 0 and 21 m.
        let snakes: Vec<Vec3> = (0..10)
            .flat_map(|lane| {
                let (x, y) = (27.0 - 6.0 * lane as f32, 21.0 - (lane * 7 % 10) as f32 * 2.3);
                [Vec3::new(x, y - 9.0, 0.5), Vec3::new(x, y, 1.5)]
            })
            .collect();
        let covers = [Rect::new(0.01, 0.35, 0.3, 0.98), Rect::new(0.72, 0.7, 0.99, 0.98)];
        for camera_mode in CameraMode::ALL {
            let start = CameraView::of(camera_mode, 10);
            let view = start.framing(target, &snakes, &snakes, aspect, &covers);
            for snake in &snakes {
                let at = view.share_of_picture(target + view.offset, *snake, aspect);
                let is_covered = covers.iter().any(|cover| cover.contains(at));
                assert!(!is_covered, "{camera_mode:?}: {snake} is at {at}");
                assert!((0.0..=1.0).contains(&at.x) && (0.0..=1.0).contains(&at.y), "{at}");
            }
            let plain = start.framing(target, &snakes, &snakes, aspect, &[]);
            assert!(view.distance_m >= plain.distance_m);
        }
    }

    #[test]
    fn a_card_that_covers_no_snake_does_not_move_the_camera() {
        let snakes = [Vec3::new(0.0, 7.0, 6.0), Vec3::new(0.0, 8.0, 6.0)];
        let view = CameraView::of(CameraMode::Side, 2);
        let target = Vec3::new(0.0, 7.0, 5.0);
        let card = Rect::new(0.0, 0.9, 0.2, 1.0);
        assert_eq!(
            view.framing(target, &snakes, &snakes, 1.6, &[card]),
            view.framing(target, &snakes, &snakes, 1.6, &[])
        );
    }

    #[test]
    fn the_camera_steps_aside_for_messages_over_a_snake_alone_and_only_then() {
        let (target, aspect) = (Vec3::new(0.0, -7.0, 0.5), 1.5);
        let snake: Vec<Vec3> =
            (0..5).map(|limb| Vec3::new(0.0, -11.0 + 2.0 * limb as f32, 0.5)).collect();
        let view = CameraView::of(CameraMode::Follow, 1);
        let elsewhere = Rect::new(0.0, 0.0, 0.4, 0.2);
        assert_eq!(view.beside(target, &snake, aspect, &[elsewhere]), view);
        let places = |view: &CameraView| -> Vec<Vec2> {
            snake
                .iter()
                .map(|at| view.share_of_picture(target + view.offset, *at, aspect))
                .collect()
        };
        // The rectangle that hides the snake extends from its head to the lower right corner.
        let head = places(&view)[4];
        let over_it = Rect::new(head.x - 0.1, head.y - 0.1, 1.0, 1.0);
        let aside = view.beside(target, &snake, aspect, &[over_it]);
        assert_eq!(aside.distance_m, view.distance_m);
        assert!(places(&aside).iter().all(|at| !over_it.contains(*at) && at.x > 0.0), "{aside:?}");
        assert_eq!(view.beside(target, &snake, aspect, &[Rect::new(0.0, 0.0, 1.0, 1.0)]), view);
    }

    #[test]
    fn the_shots_go_around() {
        let around =
            std::iter::successors(Some(CameraMode::Follow), |camera_mode| Some(camera_mode.next()));
        let seen: Vec<CameraMode> = around.take(5).collect();
        assert_eq!((&seen[..4], seen[4]), (&CameraMode::ALL[..], CameraMode::Follow));
    }
}
