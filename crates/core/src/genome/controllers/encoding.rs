//! The interface of a kind of controller to the rest of the genome.

use std::fmt::Arguments;
use std::ops::RangeInclusive;

use rand_chacha::ChaCha8Rng;
use xxhash_rust::xxh3::Xxh3Default;

use crate::check::Invalid;
use crate::genome::body::BodyGenes;
use crate::genome::gene::{Feature, Gene, Genes, GenomeShape};
use crate::genome::network_space::WEIGHT;
use crate::genome::space::GenomeSpace;

/// Paths of settings below `genome`, in groups.
pub type SettingNames = &'static [&'static [&'static str]];

/// Settings of the frequency of a beat or of waves.
pub const FREQUENCY_SETTINGS: &[&str] = &["wave.frequency_min_hz", "wave.frequency_max_hz"];
/// Settings of a servo and of the bends that it follows.
pub const SERVO_SETTINGS: &[&str] = &[
    "wave.angle_range_rad",
    "wave.stiffness_min_nm_per_rad",
    "wave.stiffness_max_nm_per_rad",
    "wave.servo_damping_nms_per_rad",
];
/// Settings of twists with targets of their own.
pub const TWIST_SETTINGS: &[&str] = &["wave.twist_range_rad"];

/// Takes the name of a list in a genome, its length, and the lengths that it may have in any file.
pub type LengthVisitor<'a> = &'a mut dyn FnMut(Arguments<'_>, usize, RangeInclusive<usize>);

/// The commands that genes alone determine, for a controller that follows a fixed course.
#[derive(Debug, Clone, PartialEq)]
pub struct JointCommands {
    /// The commanded quantity with its unit.
    pub quantity: &'static str,
    /// A chart shows at least plus and minus this.
    pub least_range: f64,
    /// Whether each point holds until the next. Otherwise the points are samples of a smooth curve.
    pub is_held: bool,
    /// For each joint, about its bend and its twist axis: times in seconds, and values.
    pub joints: Vec<[Vec<(f64, f64)>; 2]>,
}

/// Widens a range of weights to both sides of 0 so that it contains all weights among the genes of a controller.
pub fn widen_weights(range: &mut f32, controller: &(impl ControllerEncoding + Clone)) {
    let mut widen = |gene: Gene<'_>, value: &mut f32| {
        if gene.quantity == WEIGHT {
            *range = range.max(value.abs());
        }
    };
    controller.clone().genes(&GenomeSpace::default(), &mut Genes::to(&mut widen));
}

/// The genetic encoding of one kind of controller.
///
/// Everything that searches, compares, checks or counts genes follows from [`Self::genes`].
pub trait ControllerEncoding {
    /// The settings that only matter to some kinds, and matter to this one.
    fn settings() -> SettingNames
    where
        Self: Sized;

    /// Genes of zeros, in the layout that a space prescribes for a shape.
    fn zeroed(space: &GenomeSpace, shape: GenomeShape) -> Self
    where
        Self: Sized;

    /// Visits every gene in a fixed order, with its range in `space`. The order is part of the bits of a run.
    fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>);

    /// Number of joints that it drives.
    fn joints(&self) -> usize;

    /// An estimate of the frequency of the motion, in Hz; none where the first gene that is a frequency says it.
    fn estimated_frequency_hz(&self) -> Option<f32> {
        None
    }

    /// Drops what was learned but changes nothing that the snake does. The genes of most controllers have nothing of that kind.
    fn compact(&mut self) {}

    /// Visits every list of genes besides that of the joints.
    fn lengths(&self, _visit: LengthVisitor<'_>) {}

    /// Checks what is neither a gene nor the length of a list.
    ///
    /// # Errors
    /// The first value that is not allowed.
    fn check_rest(&self) -> Result<(), Invalid> {
        Ok(())
    }

    /// Widens a space so that it contains these genes, where ranges other than those of frequencies, stiffness and damping
    /// are settings.
    fn widen(&self, _space: &mut GenomeSpace) {}

    /// Draws all genes of a zeroed genome at random: every gene anywhere in its range.
    fn randomize(&mut self, body: &mut BodyGenes, space: &GenomeSpace, rng: &mut ChaCha8Rng) {
        let mut draw = |gene: Gene<'_>, value: &mut f32| {
            *value = gene.range.random(rng);
        };
        let genes = &mut Genes::to(&mut draw);
        body.genes(space, genes);
        self.genes(space, genes);
    }

    /// Shifts all genes at random by at most ±`shift_nm`, or by the same share of their ranges.
    fn mutate(
        &mut self,
        body: &mut BodyGenes,
        space: &GenomeSpace,
        shift_nm: f32,
        rng: &mut ChaCha8Rng,
    ) {
        let share = space.shift_share(shift_nm);
        let mut shift = |gene: Gene<'_>, value: &mut f32| {
            *value = gene.range.shift(*value, share, rng);
        };
        let genes = &mut Genes::to(&mut shift);
        body.genes(space, genes);
        self.genes(space, genes);
    }

    /// Adds the bits of what was learned, beside the genes, to a genome's hash.
    fn hash_learned(&self, _hash: &mut Xxh3Default) {}

    /// Completes a mutation by which a strategy has moved all genes, for kinds whose genes mutate by rules of their own.
    /// `before` holds the values of the genes before the mutation, in the order of [`Self::genes`].
    fn after_mutation(&mut self, _before: &[f32], _space: &GenomeSpace, _rng: &mut ChaCha8Rng) {}

    /// A few features that stand for all genes, where these are too many to compare.
    fn summary(&self, _space: &GenomeSpace) -> Option<Vec<Feature>> {
        None
    }

    /// The commands that the genes alone determine for a trial; none where they depend on senses.
    fn commands(&self, _duration_s: f64) -> Option<JointCommands> {
        None
    }
}
