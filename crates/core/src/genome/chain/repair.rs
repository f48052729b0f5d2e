//! Repairs a varied body so that it meets its limits: the exact volume, the greatest length, and differences between neighbours with which
//! the engine can hold them together.

use super::limits::{EVOLVED_INERTIA_RATIO, MASS_RATIO, ratio};
use super::segment::Segment;
use super::space::BodySpace;
use crate::world::{SOFTEST_M4_S2, modulus_at_pa};

/// Number of attempts to meet all limits by changing only sizes that exceed them.
const PASSES: usize = 8;
/// Relative tolerance of a body's total volume.
const VOLUME_TOLERANCE: f64 = 1.0e-3;
/// Number of steps from the wanted body to the plain one, which are tried if the attempts fail.
const STEPS_TO_PLAIN: usize = 16;

impl BodySpace {
    /// Changes the sizes of the blocks as little as necessary, so that the body keeps all limits. It succeeds for every number of blocks
    /// that the space allows: in the worst case all blocks become equal.
    pub(in crate::genome) fn repair(&self, segments: &mut [Segment]) {
        if segments.is_empty() {
            return;
        }
        self.repair_sizes(segments);
        segments.iter_mut().for_each(Segment::stiffen);
    }

    fn repair_sizes(&self, segments: &mut [Segment]) {
        for _ in 0..PASSES {
            self.fill_volume(segments);
            if self.is_within_limits(segments) {
                return;
            }
            shrink_the_heavier(segments);
            self.shorten(segments);
        }
        let Some(plain_m) = self.plain_block_m(segments.len()) else { return };
        let count = segments.len().max(1) as f64;
        let density = segments.iter().map(|of| f64::from(of.density_kg_m3)).sum::<f64>() / count;
        let wanted = segments.to_vec();
        for step in (0..STEPS_TO_PLAIN).rev() {
            let share = step as f64 / STEPS_TO_PLAIN as f64;
            for (segment, wanted) in segments.iter_mut().zip(&wanted) {
                let [length_m, width_m, height_m] = plain_m;
                segment.length_m = between(length_m, wanted.length_m, share);
                segment.width_m = between(width_m, wanted.width_m, share);
                segment.height_m = between(height_m, wanted.height_m, share);
                segment.density_kg_m3 = between(density, wanted.density_kg_m3, share);
            }
            self.fill_volume(segments);
            if self.is_within_limits(segments) {
                return;
            }
        }
    }

    /// Returns whether a body keeps all limits of this space.
    pub(in crate::genome) fn is_within_limits(&self, segments: &[Segment]) -> bool {
        let volume_m3: f64 = segments.iter().map(Segment::volume_m3).sum();
        let wanted_m3 = f64::from(self.volume_m3);
        let length_m: f64 = segments.iter().map(|segment| f64::from(segment.length_m)).sum();
        let thickness = self.thickness_min_m..=self.thickness_max_m;
        self.limbs().contains(&(segments.len() as u32))
            && (volume_m3 - wanted_m3).abs() <= VOLUME_TOLERANCE * wanted_m3
            && length_m <= f64::from(self.longest_m) * 1.000_001
            && segments.iter().all(|segment| {
                (self.length_min_m..=self.length_max_m).contains(&segment.length_m)
                    && thickness.contains(&segment.width_m)
                    && thickness.contains(&segment.height_m)
            })
            && segments.windows(2).all(|pair| {
                ratio(pair[0].mass_kg(), pair[1].mass_kg()) <= MASS_RATIO
                    && ratio(pair[0].inertia_kg_m2(), pair[1].inertia_kg_m2())
                        <= EVOLVED_INERTIA_RATIO
            })
    }

    /// Scales all blocks by one factor until their total volume is that of the space. Each size stays within its range.
    fn fill_volume(&self, segments: &mut [Segment]) {
        for _ in 0..PASSES {
            let volume_m3: f64 = segments.iter().map(Segment::volume_m3).sum();
            let factor = libm::cbrt(f64::from(self.volume_m3) / volume_m3.max(1.0e-9)) as f32;
            for segment in segments.iter_mut() {
                segment.length_m =
                    (segment.length_m * factor).clamp(self.length_min_m, self.length_max_m);
                for side in [&mut segment.width_m, &mut segment.height_m] {
                    *side = (*side * factor).clamp(self.thickness_min_m, self.thickness_max_m);
                }
            }
        }
    }

    /// Shortens a body that is too long, and thickens it so that its volume stays the same.
    fn shorten(&self, segments: &mut [Segment]) {
        let length_m: f32 = segments.iter().map(|segment| segment.length_m).sum();
        // The goal is a little below the limit, because filling the volume lengthens the body again.
        let longest_m = self.longest_m * 0.999;
        if length_m <= longest_m {
            return;
        }
        let share = longest_m / length_m;
        for segment in segments {
            segment.length_m *= share;
            segment.width_m /= share.sqrt();
            segment.height_m /= share.sqrt();
        }
    }
}

impl Segment {
    /// Raises the modulus of a block that would fold up under its own weight to the least value at which it does not. This value depends
    /// on the sizes, so it is set after them.
    fn stiffen(&mut self) {
        let sides_m = [self.width_m, self.height_m];
        if let Some(modulus_pa) = &mut self.youngs_modulus_pa {
            let least_pa = modulus_at_pa(SOFTEST_M4_S2, sides_m, self.density_kg_m3);
            *modulus_pa = modulus_pa.max(least_pa);
        }
    }
}

/// Shrinks the heavier of two neighbours whose ratio of masses or moments of inertia is too large.
fn shrink_the_heavier(segments: &mut [Segment]) {
    for rear in 1..segments.len() {
        let [mass, inertia] = [Segment::mass_kg, Segment::inertia_kg_m2].map(|of| {
            let (front, rear) = (of(&segments[rear - 1]), of(&segments[rear]));
            (front > rear, ratio(front, rear))
        });
        // The mass grows with the third power of the sizes, the inertia with the fifth.
        let for_mass = libm::cbrt(MASS_RATIO / mass.1 * 0.98);
        let for_inertia = libm::pow(EVOLVED_INERTIA_RATIO / inertia.1 * 0.98, 0.2);
        let (front_is_heavier, factor) =
            if for_mass < for_inertia { (mass.0, for_mass) } else { (inertia.0, for_inertia) };
        if factor < 1.0 {
            let heavier = &mut segments[if front_is_heavier { rear - 1 } else { rear }];
            let factor = factor as f32;
            heavier.length_m *= factor;
            heavier.width_m *= factor;
            heavier.height_m *= factor;
        }
    }
}

/// Returns the value at a share of the way from one number to another, on a logarithmic scale.
fn between(from: f64, to: f32, share: f64) -> f32 {
    (from * libm::pow(f64::from(to) / from, share)) as f32
}
