//! The path of a film's camera. It follows the snakes smoothly, because their future positions are known.

use bevy::prelude::*;

use crate::studio::commands::camera_mode::CameraMode;
use crate::studio::scene::camera::view::{CameraView, FreeMargins, middle_of};

/// Time before and after a frame over which the camera's target is averaged, in seconds of the film.
const TARGET_S: f32 = 0.8;
/// Time before and after a frame over which the camera's distance is averaged, in seconds of the film.
const DISTANCE_S: f32 = 1.2;

/// Computes the camera's transform for each frame, from the points that the frame must show. The camera of a film with
/// a single frame is the same as that of a picture.
pub fn camera_path(
    points: &[Vec<Vec3>],
    camera_mode: CameraMode,
    lanes: usize,
    (aspect, fps): (f32, u32),
) -> Vec<Transform> {
    let frames_in = |seconds: f32| libm::roundf(seconds * fps as f32) as usize;
    let middle = |points: &Vec<Vec3>| middle_of(points.iter().copied());
    let middles: Vec<Vec3> = points.iter().map(middle).collect();
    let targets = smooth(&middles, frames_in(TARGET_S));
    let (view, free) = (CameraView::of(camera_mode, lanes), FreeMargins::default());
    let needed_m: Vec<f32> = points
        .iter()
        .zip(&targets)
        .map(|(points, target)| view.distance_to_see(*target, points.iter().copied(), aspect, free))
        .collect();
    // The maximum over neighbouring frames ensures that the averaged distance still shows all points.
    let reach = frames_in(DISTANCE_S);
    let greatest_m: Vec<f32> = (0..needed_m.len())
        .map(|frame| around(&needed_m, frame, reach).1.iter().copied().fold(0.0, f32::max))
        .collect();
    let distances_m = smooth(&greatest_m, reach);
    let places = targets.iter().zip(distances_m);
    places
        .map(|(target, distance_m)| CameraView { distance_m, ..view }.looking_at(*target))
        .collect()
}

/// Returns the values of a frame and of `reach` frames on each side, with the index of the first of these frames.
fn around<T>(values: &[T], frame: usize, reach: usize) -> (usize, &[T]) {
    let begin = frame.saturating_sub(reach);
    (begin, &values[begin..(frame + reach + 1).min(values.len())])
}

/// Averages the values around each value, weighted by nearness.
fn smooth<T>(values: &[T], reach: usize) -> Vec<T>
where
    T: Copy + std::ops::Mul<f32, Output = T> + std::ops::Add<Output = T>,
{
    let smoothed = |frame: usize| {
        let (begin, near) = around(values, frame, reach);
        let weight = |index: usize| (reach + 1 - (begin + index).abs_diff(frame)) as f32;
        let sum: f32 = (0..near.len()).map(weight).sum();
        let weighted = near.iter().enumerate().map(|(index, value)| *value * (weight(index) / sum));
        weighted.reduce(|sum, value| sum + value).unwrap_or(values[frame])
    };
    (0..values.len()).map(smoothed).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the points of a snake that shakes while it advances.
    fn shaken(frame: usize) -> Vec<Vec3> {
        let y_m = frame as f32 * 0.1;
        let shaken_m = if frame.is_multiple_of(2) { 0.3 } else { -0.3 };
        vec![Vec3::new(-4.0, y_m + shaken_m, 0.5), Vec3::new(4.0, y_m + 6.0 + shaken_m, 1.5)]
    }

    #[test]
    fn the_camera_advances_evenly_although_the_snake_shakes() {
        let points: Vec<Vec<Vec3>> = (0..90).map(shaken).collect();
        let places = camera_path(&points, CameraMode::Side, 1, (16.0 / 9.0, 30));
        let ys: Vec<f32> = places.iter().map(|place| place.translation.y).collect();
        for pair in ys[25..65].windows(2) {
            let way_m = pair[1] - pair[0];
            assert!((0.08..0.12).contains(&way_m), "{way_m}");
        }
    }

    #[test]
    fn every_point_stays_in_view_and_one_frame_is_a_picture() {
        let points: Vec<Vec<Vec3>> = (0..60).map(shaken).collect();
        for camera_mode in [CameraMode::Follow, CameraMode::Side, CameraMode::Top] {
            let aspect = 16.0 / 9.0;
            let half = libm::tanf(std::f32::consts::FRAC_PI_8);
            let places = camera_path(&points, camera_mode, 1, (aspect, 30));
            for (place, points) in places.iter().zip(&points) {
                let into_eye = place.to_matrix().inverse();
                for point in points {
                    let at = into_eye.transform_point3(*point) / half;
                    assert!((at.y / at.z).abs() < 1.0 && (at.x / at.z).abs() < aspect, "{at}");
                }
            }
            let single = camera_path(&points[7..8], camera_mode, 1, (aspect, 30));
            let target = middle_of(points[7].iter().copied());
            let mut view = CameraView::of(camera_mode, 1);
            let free = FreeMargins::default();
            view.distance_m = view.distance_to_see(target, points[7].iter().copied(), aspect, free);
            assert_eq!(single, [view.looking_at(target)]);
        }
    }
}
