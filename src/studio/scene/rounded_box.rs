//! A box with rounded edges as a part of a mesh: see [`RoundedBox`].

use bevy::prelude::*;

use super::mesh_builder::MeshBuilder;
use snakes_lab::export::RoundedBox;

impl MeshBuilder {
    /// A box of a size, edges included, around a centre. A box that is too thin gets a smaller radius.
    pub fn rounded_box(&mut self, centre: Vec3, size: Vec3, radius: f32, segments: usize) {
        let rounded = RoundedBox::new(size.to_array(), radius, segments);
        for face in RoundedBox::faces() {
            self.patch(rounded.cells(), rounded.cells(), |column, row| {
                let [position, normal] = rounded.corner(face, column, row).map(Vec3::from);
                (centre + position, normal)
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::scene::mesh_builder::tests::closed_volume;

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
