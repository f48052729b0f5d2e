//! Crossover of two bodies, aligned by the descent of their blocks.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::segment::Segment;
use super::structure::waves_mut;
use crate::genome::controllers::ControllerGenes;
use crate::genome::individual::Genome;
use crate::genome::space::GenomeSpace;

impl GenomeSpace {
    /// Returns a child of two genomes with bodies of their own. Where blocks of both parents have the same descent, the child takes their
    /// sizes, their joint and their waves, each group as a whole, from either parent. All other blocks come from the fitter parent.
    pub fn with_crossed_bodies(
        &self,
        fitter: &Genome,
        other: &Genome,
        rng: &mut ChaCha8Rng,
    ) -> Genome {
        let mut child = fitter.clone();
        let mut other = other.clone();
        let pairs = aligned(&fitter.body.segments, &other.body.segments);
        let mut of_other = || rng.random_range(0.0..1.0) < 0.5;
        for &(index, partner) in &pairs {
            let (segment, from) = (&mut child.body.segments[index], &other.body.segments[partner]);
            if of_other() {
                segment.length_m = from.length_m;
                segment.width_m = from.width_m;
                segment.height_m = from.height_m;
                segment.density_kg_m3 = from.density_kg_m3;
                segment.youngs_modulus_pa = from.youngs_modulus_pa;
            }
            if of_other() {
                segment.bend_limit_rad = from.bend_limit_rad;
                segment.twist_limit_rad = from.twist_limit_rad;
                segment.strength = from.strength;
            }
        }
        if let (ControllerGenes::Gait(gait), ControllerGenes::Gait(from)) =
            (&mut child.controller, &other.controller)
        {
            if of_other() {
                gait.stiffness_nm_per_rad = from.stiffness_nm_per_rad;
            }
            // Gaits without steering take no random number, as before there was steering.
            if (gait.steering.is_used() || from.steering.is_used()) && of_other() {
                gait.steering = from.steering;
            }
        }
        if let (Some(waves), Some(from)) =
            (waves_mut(&mut child.controller), waves_mut(&mut other.controller))
        {
            if of_other() {
                waves.frequency_hz = from.frequency_hz;
            }
            for &(index, partner) in &pairs {
                // The head has no waves.
                let joints = index.checked_sub(1).zip(partner.checked_sub(1));
                if let Some((own, theirs)) = joints.filter(|_| of_other()) {
                    waves.joints[own].clone_from(&from.joints[theirs]);
                }
            }
        }
        self.bodies.repair(&mut child.body.segments);
        child
    }
}

/// Returns the indices of blocks with equal ids in both bodies, in the order of both: a longest common subsequence.
fn aligned(a: &[Segment], b: &[Segment]) -> Vec<(usize, usize)> {
    // Entry [i][j] is the length of the longest common subsequence of `a` from i on and `b` from j on.
    let mut longest = vec![vec![0_usize; b.len() + 1]; a.len() + 1];
    for i in (0..a.len()).rev() {
        for j in (0..b.len()).rev() {
            longest[i][j] = if a[i].id == b[j].id {
                longest[i + 1][j + 1] + 1
            } else {
                longest[i + 1][j].max(longest[i][j + 1])
            };
        }
    }
    let (mut i, mut j, mut pairs) = (0, 0, Vec::new());
    while i < a.len() && j < b.len() {
        if a[i].id == b[j].id {
            pairs.push((i, j));
            (i, j) = (i + 1, j + 1);
        } else if longest[i + 1][j] >= longest[i][j + 1] {
            i += 1;
        } else {
            j += 1;
        }
    }
    pairs
}
