//! Rotations that have the same bits on every processor, for all that is computed around an engine's step.
//!
//! glam, on which rapier is built, multiplies rotations with the vector instructions of each kind of processor. On x86-64 and 64-bit ARM it
//! adds the parts of a product in one order, and these functions add them in this order everywhere, one number at a time.

use super::{Rotation, Vector};

/// Returns the product of two rotations: `second` acts first, and `first` after it.
pub(super) fn product(first: Rotation, second: Rotation) -> Rotation {
    let (a, b) = (first, second);
    Rotation::from_xyzw(
        (a.w * b.x + a.x * b.w) + (a.y * b.z - a.z * b.y),
        (a.w * b.y - a.x * b.z) + (a.y * b.w + a.z * b.x),
        (a.w * b.z + a.x * b.y) + (a.z * b.w - a.y * b.x),
        (a.w * b.w - a.x * b.x) - (a.y * b.y + a.z * b.z),
    )
}

/// Rotates a vector.
pub(super) fn turned(rotation: Rotation, vector: Vector) -> Vector {
    let axis = Vector::new(rotation.x, rotation.y, rotation.z);
    let w = rotation.w;
    let square = axis.dot(axis);
    vector * (w * w - square) + axis * (vector.dot(axis) * 2.0) + axis.cross(vector) * (w * 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, stream};
    use rand::RngExt;

    #[test]
    #[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
    fn on_this_processor_they_have_the_bits_of_glam() {
        let mut rng = stream(1, 1, 1, Purpose::Birth);
        let mut number = || rng.random_range(-1.0_f32..1.0);
        for _ in 0..10_000 {
            let [a, b] = [0, 1]
                .map(|_| Rotation::from_xyzw(number(), number(), number(), number()).normalize());
            let vector = Vector::new(number(), number(), number()) * 9.0;
            assert_eq!(product(a, b), a * b);
            assert_eq!(turned(a, vector), a * vector);
        }
    }
}
