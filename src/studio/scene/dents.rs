//! Dents: a dark patch around each limb that has sunk into a soft surface.
//!
//! The physics lets limbs sink into a soft surface, but the drawn surface is flat, so a sunken limb would look cut off.

use bevy::prelude::*;

use super::meshes::to_fading_mesh;
use super::surface_look::SurfaceLook;
use super::surface_texture::rise;
use crate::studio::stage::lane::Lane;
use snakes_core::world::{Pose, Stairs};
use snakes_lab::mesh::MeshBuilder;

/// Patch of the limb with this index; the head is 0.
#[derive(Component, Debug)]
pub(super) struct Dent(pub usize);

/// Part of a limb that has sunk into a soft surface.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Sunken {
    /// Centre of the sunken part, on the surface, in metres.
    centre: Vec3,
    /// Direction of the limb seen from above, in radians from y.
    yaw_rad: f32,
    /// Size of the sunken part across and along the limb, in metres.
    size_m: Vec2,
    /// Greatest depth of the sunken part, in metres.
    depth_m: f32,
}

/// Minimum softness of a surface, from 0 to 1, at which it shows dents. See [`SurfaceLook::soft`].
const LEAST_SOFT: f32 = 0.15;
/// Minimum depth of a drawn dent, in metres.
const LEAST_DEPTH_M: f32 = 0.006;
/// Maximum depth of a dent, in metres. A deeper point has passed through the side of a step.
const MOST_DEPTH_M: f32 = 0.8;
/// Width of a patch's rim beyond the sunken part, in metres, and its increase per metre of depth.
const RIM_M: f32 = 0.10;
const RIM_PER_M: f32 = 1.2;
/// Height of patches above the surface, in metres: above the strips of the steps.
const ABOVE_M: f32 = 0.014;
/// Number of points along each edge of a limb that are compared with the surface.
const POINTS: usize = 9;

/// Returns a square of one metre that fades out towards its edges.
pub(super) fn patch() -> Mesh {
    /// Number of cells along a side.
    const CELLS: usize = 8;
    let mut solid = MeshBuilder::default();
    solid.patch(CELLS, CELLS, |column, row| {
        let at = Vec2::new(column as f32, row as f32) / CELLS as f32 - Vec2::splat(0.5);
        [at.extend(0.0), Vec3::Z]
    });
    to_fading_mesh(solid, |at| {
        // The opacity is full up to half of the way to the edges, with rounded corners.
        let out = libm::powf(
            libm::powf((at.x * 2.0).abs(), 4.0) + libm::powf((at.y * 2.0).abs(), 4.0),
            0.25,
        );
        rise(1.0 - out, 0.0, 0.5)
    })
}

/// Returns whether a lane has a soft surface, which shows dents.
pub(super) fn is_soft(lane: &Lane) -> bool {
    let surfaces = [&lane.trial().surface, lane.trial().ground()];
    surfaces.into_iter().any(|surface| SurfaceLook::of(surface).soft >= LEAST_SOFT)
}

/// Moves the patches to the limbs that have sunk in, and hides the others.
pub(super) fn place(
    lanes: Query<(&Lane, &Children)>,
    mut dents: Query<(&Dent, &mut Transform, &mut Visibility)>,
) {
    for (lane, children) in &lanes {
        let stairs = &lane.trial().stairs;
        let mut dents = dents.iter_many_mut(children);
        while let Some((dent, mut transform, mut visibility)) = dents.fetch_next() {
            let limb = lane.drawn_poses().zip(&lane.body.parts).nth(dent.0);
            let sunken =
                limb.and_then(|(pose, plan)| sunken(&pose, Vec3::from(plan.size_m()), stairs));
            let Some(sunken) = sunken else {
                visibility.set_if_neq(Visibility::Hidden);
                continue;
            };
            visibility.set_if_neq(Visibility::Inherited);
            let rim_m = 2.0 * (RIM_M + RIM_PER_M * sunken.depth_m);
            // Half of the patch is its soft rim.
            let size = (sunken.size_m * 1.3 + Vec2::splat(rim_m)).extend(1.0);
            transform.set_if_neq(
                Transform::from_translation(sunken.centre + Vec3::Z * ABOVE_M)
                    .with_rotation(Quat::from_rotation_z(sunken.yaw_rad))
                    .with_scale(size),
            );
        }
    }
}

/// Finds the part of a limb that lies deepest below the surface; `None` if there is none.
fn sunken(pose: &Pose, size: Vec3, stairs: &Stairs) -> Option<Sunken> {
    let ahead = pose.rotation * Vec3::Y;
    let yaw_rad = libm::atan2f(-ahead.x, ahead.y);
    let half = size / 2.0;
    let points = (0..POINTS).flat_map(|along| {
        let y = half.y * (2.0 * along as f32 / (POINTS - 1) as f32 - 1.0);
        [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]]
            .map(|[x, z]| Vec3::new(half.x * x, y, half.z * z))
    });
    // Points below the surface: the point on the surface above each, and the depth.
    let below = points.filter_map(|in_limb| {
        let at = *pose * in_limb;
        let surface_z_m = stairs.surface_z_m(at.x, at.y);
        let depth_m = surface_z_m - at.z;
        let is_inside = (LEAST_DEPTH_M..MOST_DEPTH_M).contains(&depth_m);
        let climbed = stairs.steps_climbed(f64::from(at.y));
        // A point that is nearer to the riser than to the tread has entered through the riser.
        let is_through_riser = climbed > 0 && at.y - stairs.riser_y_m(climbed - 1) < depth_m;
        let is_over_edge = surface_z_m > 0.0 && is_through_riser;
        (is_inside && !is_over_edge).then(|| (at.with_z(surface_z_m), depth_m))
    });
    let (deepest, depth_m) = below.clone().reduce(|a, b| if b.1 > a.1 { b } else { a })?;
    // Extent of the points on the deepest point's tread, in the directions of the limb.
    let turn = Mat2::from_angle(-yaw_rad);
    let on_tread = below.filter(|(at, _)| at.z == deepest.z).map(|(at, _)| turn * at.truncate());
    let (least, most) =
        on_tread.fold((Vec2::MAX, Vec2::MIN), |(least, most), at| (least.min(at), most.max(at)));
    let middle = Mat2::from_angle(yaw_rad) * ((least + most) / 2.0);
    let centre = middle.extend(deepest.z);
    Some(Sunken { centre, yaw_rad, size_m: most - least, depth_m })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: Vec3 = Vec3::new(1.0, 2.0, 1.0);

    fn at(y_m: f32, z_m: f32) -> Pose {
        Pose::from_translation(Vec3::new(0.0, y_m, z_m))
    }

    #[test]
    fn a_limb_above_the_surface_has_no_dent_and_one_below_it_has_its_size() {
        let stairs = Stairs::default();
        assert_eq!(sunken(&at(-5.0, 0.5), SIZE, &stairs), None);
        let found = sunken(&at(-5.0, 0.4), SIZE, &stairs).expect("it is 10 cm deep");
        assert!((found.depth_m - 0.1).abs() < 1.0e-5);
        assert!((found.centre - Vec3::new(0.0, -5.0, 0.0)).length() < 1.0e-5);
        assert!((found.size_m - Vec2::new(1.0, 2.0)).length() < 1.0e-5);
    }

    #[test]
    fn a_dent_lies_on_the_tread_and_follows_the_turn_of_the_limb() {
        let stairs = Stairs::default();
        let turned = Pose::from_parts(Vec3::new(0.5, 30.0, 5.4), Quat::from_rotation_z(0.7));
        let found = sunken(&turned, SIZE, &stairs).expect("on the landing");
        assert!((found.centre.z, found.yaw_rad) == (5.0, found.yaw_rad));
        assert!((found.yaw_rad - 0.7).abs() < 1.0e-4, "{}", found.yaw_rad);
        assert!((found.size_m - Vec2::new(1.0, 2.0)).length() < 1.0e-3, "{}", found.size_m);
    }

    #[test]
    fn a_limb_that_presses_into_a_riser_leaves_no_dent_on_the_tread_above() {
        let stairs = Stairs::default();
        // The limb's front is 5 cm inside the first riser, at y = 3; its lower side is on the ground.
        assert_eq!(sunken(&at(2.05, 0.5), SIZE, &stairs), None);
    }

    #[test]
    fn an_arched_limb_leaves_a_dent_only_where_it_touches() {
        let tilted = Pose::from_parts(Vec3::new(0.0, -5.0, 0.95), Quat::from_rotation_x(0.6));
        let found = sunken(&tilted, SIZE, &Stairs::default()).expect("its rear touches");
        assert!(found.centre.y < -5.0 && found.size_m.y < 1.0, "{found:?}");
    }
}
