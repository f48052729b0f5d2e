//! The interface of a kind of controller to the rest of the genome.

use rand_chacha::ChaCha8Rng;
use xxhash_rust::xxh3::Xxh3Default;

use crate::check::Invalid;
use crate::genome::body::BodyGenes;
use crate::genome::gene::{Feature, Gene, GeneVisitor, GenomeShape};
use crate::genome::space::GenomeSpace;

/// A row of the registry: the facts about a kind of controller that are the same for all its genomes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ControllerInfo {
    /// The name in flags and files.
    pub name: &'static str,
    /// The name at the head of a list or a chart.
    pub title: &'static str,
    /// A sentence about it.
    pub words: &'static str,
    /// Whether it senses contacts, attitude and the stairs ahead, beside its joints.
    pub senses_surroundings: bool,
    /// The settings below `genome` that only matter to some kinds, and matter to this one.
    pub settings: &'static [&'static str],
}

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

/// The genetic encoding of one kind of controller.
///
/// Everything that searches, compares, checks or counts genes follows from [`Self::genes`].
pub trait ControllerEncoding {
    /// Its row of the registry.
    fn info() -> &'static ControllerInfo
    where
        Self: Sized;

    /// Genes of zeros, in the layout that a space prescribes for a shape.
    fn zeroed(space: &GenomeSpace, shape: GenomeShape) -> Self
    where
        Self: Sized;

    /// Visits every gene in a fixed order, with its range in `space`. The order is part of the bits of a run.
    fn genes(&mut self, space: &GenomeSpace, visit: GeneVisitor<'_>);

    /// Number of joints that it drives.
    fn joints(&self) -> usize;

    /// Frequency of the motion, in Hz, or an estimate where it has no period.
    fn frequency_hz(&self) -> f32;

    /// Drops what was learned but changes nothing that the snake does. The genes of most controllers have nothing of that kind.
    fn compact(&mut self) {}

    /// Checks every value against the limits of all spaces.
    ///
    /// # Errors
    /// The first value that is not allowed.
    fn check(&self) -> Result<(), Invalid>;

    /// Visits the name and length of every list besides that of the joints, so that a message can name a list
    /// of the wrong length.
    fn lengths(&self, _visit: &mut dyn FnMut(&'static str, usize)) {}

    /// Widens a space so that it contains these genes, where ranges are settings.
    fn widen(&self, _space: &mut GenomeSpace) {}

    /// Draws all genes of a zeroed genome at random: every gene anywhere in its range.
    fn randomize(&mut self, body: &mut BodyGenes, space: &GenomeSpace, rng: &mut ChaCha8Rng) {
        let mut draw = |gene: Gene<'_>, value: &mut f32| {
            *value = gene.range.random(rng);
        };
        body.genes(space, &mut draw);
        self.genes(space, &mut draw);
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
        body.genes(space, &mut shift);
        self.genes(space, &mut shift);
    }

    /// Adds the bits of what was learned, beside the genes, to a genome's hash.
    fn hash_learned(&self, _hash: &mut Xxh3Default) {}
    /// Has the last word on a mutation by which a strategy has moved all genes, for kinds whose genes mutate by rules of
    /// their own. `before` has the values of the genes before it, in the order of [`Self::genes`].
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
