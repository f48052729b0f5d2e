//! Tests whether two boxes overlap.

use crate::world::{Pose, Vector};

/// Depth to which parts that are not joined may overlap before a trial, in metres: the engine's own tolerance. The engine would push parts
/// apart that overlap more, and they would gain energy from it.
const OVERLAP_M: f32 = 0.005;

/// A box: its pose, and its size along its own axes, in metres.
#[derive(Debug, Clone, Copy)]
pub struct PlacedBox {
    /// Pose of the box's centre.
    pub pose: Pose,
    /// Size of the box along its own axes, in metres.
    pub size_m: [f32; 3],
}

/// Returns whether two boxes overlap by more than the tolerance. They do unless one of fifteen axes separates them: the normals of their
/// sides, and the cross products of their edges (Gottschalk, Lin and Manocha 1996).
pub fn overlap(boxes: [&PlacedBox; 2]) -> bool {
    let axes =
        boxes.map(|of| [Vector::X, Vector::Y, Vector::Z].map(|axis| of.pose.rotation * axis));
    let halves = boxes.map(|of| of.size_m.map(|size_m| size_m / 2.0));
    let between = boxes[1].pose.translation - boxes[0].pose.translation;
    let is_apart = |axis: Vector| {
        let reach = |of: usize| -> f32 {
            axes[of].iter().zip(halves[of]).map(|(own, half)| own.dot(axis).abs() * half).sum()
        };
        between.dot(axis).abs() > reach(0) + reach(1) - OVERLAP_M
    };
    let [first, second] = axes;
    let normals = first.into_iter().chain(second);
    let crossed = first.into_iter().flat_map(|a| second.map(|b| a.cross(b)));
    // The cross product of parallel edges vanishes; in this case the normals are sufficient.
    let edges = crossed.filter(|axis| axis.length_squared() > 1.0e-6).map(Vector::normalize);
    !normals.chain(edges).any(is_apart)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::Rotation;

    fn unit_box(at_m: [f32; 3], turn_rad: f32) -> PlacedBox {
        let (sin, cos) = libm::sincosf(turn_rad / 2.0);
        let turn = Rotation::from_xyzw(0.0, 0.0, sin, cos);
        PlacedBox { pose: Pose::from_parts(Vector::from(at_m), turn), size_m: [1.0; 3] }
    }

    #[test]
    fn boxes_overlap_only_if_no_axis_separates_them() {
        let still = unit_box([0.0; 3], 0.0);
        for (at_m, turn_rad, expected) in [
            ([0.99, 0.0, 0.0], 0.0, true),
            ([0.997, 0.0, 0.0], 0.0, false),
            ([1.01, 0.0, 0.0], 0.0, false),
            ([0.0, 0.0, 1.2], 0.3, false),
            // A corner reaches further than a side does.
            ([1.15, 0.0, 0.0], std::f32::consts::FRAC_PI_4, true),
            ([1.22, 0.0, 0.0], std::f32::consts::FRAC_PI_4, false),
            ([0.9, 0.9, 0.0], std::f32::consts::FRAC_PI_4, false),
            ([0.8, 0.8, 0.0], std::f32::consts::FRAC_PI_4, true),
        ] {
            let other = unit_box(at_m, turn_rad);
            assert_eq!(overlap([&still, &other]), expected, "{at_m:?} turned by {turn_rad}");
            assert_eq!(overlap([&other, &still]), expected, "{at_m:?} turned by {turn_rad}");
        }
    }
}
