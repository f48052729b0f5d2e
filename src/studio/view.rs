//! Where a camera stands: turn, height, distance; and how far back it has to go to have all in view.

use bevy::prelude::*;

use crate::check::Invalid;

/// Where the camera is, relative to what it looks at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct View {
    /// Turn about z, in radians: 0 looks from +x, so that the stairs rise to the right.
    pub yaw_rad: f32,
    /// Height above the horizon, in radians.
    pub pitch_rad: f32,
    /// Distance from the target, in metres. With several lanes in view it counts as a share of [`Self::USUAL_M`].
    pub distance_m: f32,
    /// What is looked at, beside the snake if the camera follows it, in metres.
    pub offset: Vec3,
}

/// How to look at the stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shot {
    /// At an angle, going along with the snake, or with all of them.
    #[default]
    Follow,
    /// From the side, going along.
    Side,
    /// From above, going along.
    Top,
    /// From where it is, going nowhere.
    Free,
}

impl Shot {
    /// All of them, in the order of the button row.
    pub const ALL: [Self; 4] = [Self::Follow, Self::Side, Self::Top, Self::Free];

    /// Its name on a button.
    pub fn name(self) -> &'static str {
        match self {
            Self::Follow => "Follow",
            Self::Side => "Side",
            Self::Top => "Top",
            Self::Free => "Free",
        }
    }

    /// The one with this name, in small letters.
    ///
    /// # Errors
    /// There is none, or it is no shot of a moment.
    pub fn named(name: &str) -> Result<Self, Invalid> {
        let named = Self::ALL.into_iter().find(|shot| shot.name().to_lowercase() == name);
        let still = named.filter(|shot| *shot != Self::Free);
        still.ok_or_else(|| Invalid::new("camera", format!("{name:?}"), "follow, side or top"))
    }

    /// The one after it, around.
    pub fn next(self) -> Self {
        let place = Self::ALL.iter().position(|shot| *shot == self).unwrap_or(0);
        Self::ALL[(place + 1) % Self::ALL.len()]
    }
}

impl View {
    /// The usual distance, in metres.
    pub const USUAL_M: f32 = 24.0;
    /// Nearest and farthest distance, in metres.
    pub const DISTANCE_M: std::ops::RangeInclusive<f32> = 3.0..=120.0;
    /// Highest and lowest pitch, in radians: never quite overhead, never below the ground.
    pub const PITCH_RAD: std::ops::RangeInclusive<f32> = 0.02..=1.55;

    /// Where a shot begins; of several lanes rather from behind, so that none hides the next.
    pub fn of(shot: Shot, lanes: usize) -> Self {
        let (yaw_rad, pitch_rad, offset) = match shot {
            // From the right side, a little behind and above: stairs and snake at a glance.
            Shot::Follow | Shot::Free if lanes <= 1 => (-0.55, 0.36, Vec3::new(0.0, 3.0, 0.5)),
            Shot::Follow | Shot::Free => (-0.75, 0.5, Vec3::new(0.0, 1.0, 0.0)),
            Shot::Side => (0.0, 0.04, Vec3::new(0.0, 2.0, 1.0)),
            Shot::Top => (0.0, *Self::PITCH_RAD.end(), Vec3::new(0.0, 2.0, 0.0)),
        };
        Self { yaw_rad, pitch_rad, distance_m: Self::USUAL_M, offset }
    }

    fn turn(&self) -> Quat {
        Quat::from_rotation_z(self.yaw_rad) * Quat::from_rotation_y(-self.pitch_rad)
    }

    /// Where the camera stands to look at a target like this.
    pub fn looking_at(&self, target: Vec3) -> Transform {
        let eye = target + self.turn() * Vec3::X * self.distance_m;
        Transform::from_translation(eye).looking_at(target, Vec3::Z)
    }

    /// A share of the way to another view.
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

    /// Stands so far back, and so far aside, that all points are in view, and none in so large a share of the picture at
    /// its left. `aspect` is its width over its height. What the distance was before counts as a share of
    /// [`Self::USUAL_M`].
    pub fn framing(
        self,
        target: Vec3,
        points: impl IntoIterator<Item = Vec3>,
        aspect: f32,
        left_share: f32,
    ) -> Self {
        let zoom = self.distance_m / Self::USUAL_M;
        let target = target + self.offset;
        let distance_m = self.distance_to_see(target, points, aspect * (1.0 - left_share)) * zoom;
        let half_width_m = distance_m * libm::tanf(VERTICAL_VIEW_RAD / 2.0) * aspect;
        let right = self.turn() * Vec3::Y;
        Self { distance_m, offset: self.offset - right * (half_width_m * left_share), ..self }
    }

    /// How far from `target` the camera has to be so that all points are in view, in metres. `aspect` is the
    /// picture's width over its height.
    pub fn distance_to_see(
        &self,
        target: Vec3,
        points: impl IntoIterator<Item = Vec3>,
        aspect: f32,
    ) -> f32 {
        let into_view = self.turn().inverse();
        let upright = libm::tanf(VERTICAL_VIEW_RAD / 2.0) / MARGIN;
        let across = upright * aspect.max(0.1);
        let needed = points.into_iter().map(|point| {
            // In the view's frame x points at the eye, y to the right, z up.
            let at = into_view * (point - target);
            at.x + (at.y.abs() / across).max(at.z.abs() / upright)
        });
        needed.fold(*Self::DISTANCE_M.start(), f32::max).min(*Self::DISTANCE_M.end())
    }
}

/// Bevy's usual angle of view, in radians.
const VERTICAL_VIEW_RAD: f32 = std::f32::consts::FRAC_PI_4;
/// How much wider the picture is than what has to be in it.
const MARGIN: f32 = 1.12;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_points_are_in_view_and_one_of_them_is_near_the_edge() {
        let points = [Vec3::new(12.0, -7.0, 0.0), Vec3::new(-12.0, 21.0, 5.0), Vec3::ZERO];
        for shot in Shot::ALL {
            for aspect in [0.7, 1.6] {
                let mut view = View::of(shot, 6);
                let target = Vec3::new(0.0, 7.0, 2.0);
                view.distance_m = view.distance_to_see(target, points, aspect);
                let into_eye = view.looking_at(target).to_matrix().inverse();
                let half = libm::tanf(VERTICAL_VIEW_RAD / 2.0);
                let places = points.map(|point| {
                    let at = into_eye.transform_point3(point);
                    (at.x / at.z).abs().max((at.y / at.z).abs() * aspect) / (half * aspect)
                });
                let most = places.into_iter().fold(0.0, f32::max);
                assert!((0.8..=1.0 / MARGIN + 0.01).contains(&most), "{shot:?} {aspect}: {most}");
            }
        }
    }

    #[test]
    fn the_left_of_the_picture_can_be_left_free() {
        let points = [Vec3::new(12.0, -7.0, 0.0), Vec3::new(-12.0, 21.0, 5.0), Vec3::ZERO];
        let (target, aspect) = (Vec3::new(0.0, 7.0, 2.0), 1.6);
        for shot in Shot::ALL {
            for left_share in [0.0, 0.1, 0.25] {
                let view = View::of(shot, 6).framing(target, points, aspect, left_share);
                let into_eye = view.looking_at(target + view.offset).to_matrix().inverse();
                let half = libm::tanf(VERTICAL_VIEW_RAD / 2.0) * aspect;
                let places = points.map(|point| {
                    let at = into_eye.transform_point3(point);
                    at.x / -at.z / half
                });
                let left = places.into_iter().fold(1.0, f32::min);
                let right = places.into_iter().fold(-1.0, f32::max);
                let edge = 2.0 * left_share - 1.0;
                assert!(left > edge && right < 1.0, "{shot:?}: {left} of {edge}, {right}");
            }
        }
    }

    #[test]
    fn the_shots_go_around() {
        let around = std::iter::successors(Some(Shot::Follow), |shot| Some(shot.next()));
        let seen: Vec<Shot> = around.take(5).collect();
        assert_eq!((&seen[..4], seen[4]), (&Shot::ALL[..], Shot::Follow));
    }
}
