//! A box with rounded edges and corners, the shape of limbs in every picture and scene.
//!
//! Each face is a grid whose outer cells are bent over the edges, like a cube inflated to a sphere. The flat middle of a
//! face is a single cell.

use snakes_core::world::Vector;

/// A box with rounded edges around the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RoundedBox {
    half: Vector,
    radius: f32,
    /// Number of cells across each rounded edge.
    edge_cells: usize,
}

/// A face of a box: the axis of its normal, 0 to 2, and whether the normal points towards the axis' positive end.
pub(super) type BoxFace = (usize, bool);

impl RoundedBox {
    /// Creates a box. `size_m` includes the edges, in metres. A box that is too thin gets a smaller radius.
    pub fn new(size_m: Vector, radius_m: f32, edge_cells: usize) -> Self {
        let half = size_m / 2.0;
        let radius = radius_m.min(half.min_element() * 0.999);
        Self { half, radius, edge_cells: edge_cells.max(1) }
    }

    /// Returns the six faces of a box.
    pub fn faces() -> impl Iterator<Item = BoxFace> {
        (0..3).flat_map(|axis| [(axis, true), (axis, false)])
    }

    /// Returns the number of cells of a face in each direction.
    pub fn cells(&self) -> usize {
        2 * self.edge_cells + 1
    }

    /// Returns the position, in metres, and the normal of a corner of a face's cells. Both indices go from 0 to [`Self::cells`].
    /// Seen from outside, rows go up if columns go to the right.
    pub fn corner(&self, (axis, is_positive): BoxFace, column: usize, row: usize) -> [Vector; 2] {
        let (mut right, mut up) = ((axis + 1) % 3, (axis + 2) % 3);
        if !is_positive {
            std::mem::swap(&mut right, &mut up);
        }
        let mut on_box = Vector::ZERO;
        on_box[axis] = if is_positive { self.half[axis] } else { -self.half[axis] };
        on_box[right] = self.place(column, self.half[right]);
        on_box[up] = self.place(row, self.half[up]);
        let inner = self.half - Vector::splat(self.radius);
        let within = on_box.clamp(-inner, inner);
        let normal = (on_box - within).normalize_or_zero();
        [within + normal * self.radius, normal]
    }

    /// Returns the position of a cell's corner along one axis before it is bent. Cells have equal angles within each rounded edge.
    fn place(&self, corner: usize, half: f32) -> f32 {
        let from_edge = |cells: usize| {
            let angle = std::f32::consts::FRAC_PI_4 * (1.0 - cells as f32 / self.edge_cells as f32);
            self.radius - self.radius * libm::tanf(angle)
        };
        if corner <= self.edge_cells {
            from_edge(corner) - half
        } else {
            half - from_edge(self.cells() - corner)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_corner_lies_on_the_rounded_box_and_faces_outward() {
        let (size, radius) = (Vector::new(1.0, 2.0, 0.8), 0.1);
        let shape = RoundedBox::new(size, radius, 3);
        let inner = size / 2.0 - Vector::splat(radius);
        for face in RoundedBox::faces() {
            for (column, row) in (0..=7).flat_map(|column| (0..=7).map(move |row| (column, row))) {
                let [position, normal] = shape.corner(face, column, row);
                let from_inner = position - position.clamp(-inner, inner);
                assert!((from_inner.length() - radius).abs() < 1.0e-5, "{position}");
                assert!((from_inner / radius - normal).length() < 1.0e-4, "{normal}");
            }
        }
    }
}
