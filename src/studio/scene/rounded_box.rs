//! A box with rounded edges and corners, which catch the light.
//!
//! Each face is a grid whose outer cells are bent over the edges, like a cube inflated to a sphere. The flat middle of
//! a face is a single cell.

use bevy::prelude::*;

use super::mesh_builder::MeshBuilder;

impl MeshBuilder {
    /// A box of a size, edges included, around a centre. A box that is too thin gets a smaller radius.
    pub fn rounded_box(&mut self, centre: Vec3, size: Vec3, radius: f32, segments: usize) {
        let half = size / 2.0;
        let radius = radius.min(half.min_element() * 0.999);
        let inner = half - Vec3::splat(radius);
        let segments = segments.max(1);
        for axis in 0..3 {
            for side in [1.0, -1.0] {
                let (mut right, mut up) = ((axis + 1) % 3, (axis + 2) % 3);
                if side < 0.0 {
                    // The opposite face.
                    std::mem::swap(&mut right, &mut up);
                }
                let cells = 2 * segments + 1;
                self.patch(cells, cells, |column, row| {
                    let mut on_box = Vec3::ZERO;
                    on_box[axis] = half[axis] * side;
                    on_box[right] = place(column, segments, half[right], radius);
                    on_box[up] = place(row, segments, half[up], radius);
                    let within = on_box.clamp(-inner, inner);
                    let normal = (on_box - within).normalize_or_zero();
                    (centre + within + normal * radius, normal)
                });
            }
        }
    }
}

/// Positions of a face's cell corners along one axis before bending: equal angles within each rounded edge.
fn place(corner: usize, segments: usize, half: f32, radius: f32) -> f32 {
    let from_edge = |steps: usize| {
        let angle = std::f32::consts::FRAC_PI_4 * (1.0 - steps as f32 / segments as f32);
        radius - radius * libm::tanf(angle)
    };
    if corner <= segments {
        from_edge(corner) - half
    } else {
        half - from_edge(2 * segments + 1 - corner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::scene::mesh_builder::tests::closed_volume;

    #[test]
    fn every_vertex_lies_on_the_rounded_box_and_faces_outward() {
        let (centre, size, radius) = (Vec3::new(0.0, 1.0, -2.0), Vec3::new(1.0, 2.0, 0.8), 0.1);
        let mut solid = MeshBuilder::default();
        solid.rounded_box(centre, size, radius, 3);
        let inner = size / 2.0 - Vec3::splat(radius);
        for (position, normal) in solid.positions.iter().zip(&solid.normals) {
            let from_inner = *position - centre - (*position - centre).clamp(-inner, inner);
            assert!((from_inner.length() - radius).abs() < 1.0e-5, "{position}");
            assert!((from_inner / radius - *normal).length() < 1.0e-4, "{normal} at {position}");
        }
    }

    #[test]
    fn a_rounded_box_is_closed_and_slightly_smaller_than_the_box() {
        for (size, radius) in [(Vec3::new(1.0, 2.0, 0.8), 0.1), (Vec3::splat(0.1), 0.4)] {
            let mut solid = MeshBuilder::default();
            solid.rounded_box(Vec3::ONE, size, radius, 3);
            let share = closed_volume(&solid) / size.element_product();
            assert!((0.5..1.0).contains(&share), "{share}");
        }
    }
}
