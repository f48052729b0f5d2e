//! Small changes of genomes with bodies of their own.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::segment::Segment;
use super::space::BodySpace;
use crate::genome::gene::{GeneRange, coordinate_count};
use crate::genome::individual::Genome;
use crate::genome::space::GenomeSpace;
use crate::rng::normal;

/// Least probability that a gene mutates.
const LEAST_SHARE: f64 = 0.1;

/// Standard deviation of the logarithms of sizes in a body whose blocks are nearly alike.
const NEARLY: f64 = 0.15;

impl BodySpace {
    /// Makes the blocks of a body nearly alike, with the strongest joints and the widest limits.
    pub(in crate::genome) fn make_plain(&self, segments: &mut [Segment], rng: &mut ChaCha8Rng) {
        let Some(plain_m) = self.plain_block_m(segments.len()) else { return };
        for segment in segments {
            let mut near = |size_m: f64| (size_m * libm::exp(NEARLY * normal(rng))) as f32;
            let [length_m, width_m, height_m] = plain_m.map(&mut near);
            segment.length_m = length_m.clamp(self.length_min_m, self.length_max_m);
            segment.width_m = width_m.clamp(self.thickness_min_m, self.thickness_max_m);
            segment.height_m = height_m.clamp(self.thickness_min_m, self.thickness_max_m);
            segment.bend_limit_rad = self.bend_limit_max_rad;
            segment.twist_limit_rad = self.twist_limit_max_rad;
            segment.strength = 1.0;
        }
    }
}

impl GenomeSpace {
    /// Returns a child in which some genes have changed by normally distributed steps with the standard deviation `step`, as a share of
    /// their ranges. One gene in ten changes, but on average at least one (Sims 1994).
    pub fn with_small_changes(&self, parent: &Genome, step: f64, rng: &mut ChaCha8Rng) -> Genome {
        let mut child = parent.clone();
        let count = coordinate_count(|genes| child.genes(self, genes));
        let share = LEAST_SHARE.max(1.0 / count.max(1) as f64);
        child.visit(self, |gene, value| {
            if gene.range.is_point() || rng.random_range(0.0..1.0) >= share {
                return;
            }
            *value = match gene.range {
                GeneRange::OneOf(_) => gene.range.random(rng),
                range => range.at(range.coordinate(*value) + step * normal(rng)),
            };
        });
        self.bodies.repair(&mut child.body.segments);
        child
    }
}
