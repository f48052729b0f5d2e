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

/// Paths of settings, relative to `genome`, in groups.
pub type SettingNames = &'static [&'static [&'static str]];

/// Paths of the settings of the frequency of a beat or of waves.
pub const FREQUENCY_SETTINGS: &[&str] = &["wave.frequency_min_hz", "wave.frequency_max_hz"];
/// Paths of the settings of a servo and of the bends that it follows.
pub const SERVO_SETTINGS: &[&str] = &[
    "wave.angle_range_rad",
    "wave.stiffness_min_nm_per_rad",
    "wave.stiffness_max_nm_per_rad",
    "wave.servo_damping_nms_per_rad",
];
/// Paths of the settings of twists with targets of their own.
pub const TWIST_SETTINGS: &[&str] = &["wave.twist_range_rad"];

/// Function that takes the name of a list in a genome, its length, and the lengths that it may have in any file.
pub type LengthVisitor<'a> = &'a mut dyn FnMut(Arguments<'_>, usize, RangeInclusive<usize>);

/// The course of the joints' commands, for a controller whose genes alone determine it, without senses.
#[derive(Debug, Clone, PartialEq)]
pub struct JointCommands {
    /// Name of the commanded quantity, with its unit.
    pub quantity: &'static str,
    /// Least range of a chart's axis, to either side of 0.
    pub least_range: f64,
    /// Whether each point's value holds until the next point. Otherwise the points are samples of a smooth curve.
    pub is_held: bool,
    /// For each joint, the courses about its bend and its twist axis: times in seconds, and values.
    pub joints: Vec<[Vec<(f64, f64)>; 2]>,
}

/// Widens a symmetric range of weights so that it contains all weights among the genes of a controller.
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
    /// Returns the paths of the settings that only matter to some kinds of controllers, and that matter to this kind.
    fn settings() -> SettingNames
    where
        Self: Sized;

    /// Returns genes that are all zero, in the layout that a space prescribes for a shape.
    fn zeroed(space: &GenomeSpace, shape: GenomeShape) -> Self
    where
        Self: Sized;

    /// Visits every gene in a fixed order, with its range in `space`. The order influences the bits of a run.
    fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>);

    /// Returns the number of joints that the controller drives.
    fn joints(&self) -> usize;

    /// Estimates the frequency of the motion, in Hz; `None` where the first gene that is a frequency gives it.
    fn estimated_frequency_hz(&self) -> Option<f32> {
        None
    }

    /// Removes learned data that has no effect on what the snake does. Most controllers have no learned data.
    fn compact(&mut self) {}

    /// Visits every list of genes, except that of the joints.
    fn lengths(&self, _visit: LengthVisitor<'_>) {}

    /// Checks the values that are neither genes nor lengths of lists.
    ///
    /// # Errors
    /// Returns the first value that is not allowed.
    fn check_rest(&self) -> Result<(), Invalid> {
        Ok(())
    }

    /// Widens those ranges of a space so that they contain these genes which are settings, other than the ranges of frequencies, stiffness
    /// and damping.
    fn widen(&self, _space: &mut GenomeSpace) {}

    /// Draws all genes of a zeroed genome at random: every gene anywhere in its range.
    fn randomize(&mut self, body: &mut BodyGenes, space: &GenomeSpace, rng: &mut ChaCha8Rng) {
        let mut draw = |gene: Gene<'_>, value: &mut f32| *value = gene.range.random(rng);
        let genes = &mut Genes::to(&mut draw);
        body.genes(space, genes);
        self.genes(space, genes);
    }

    /// Shifts all genes of body and controller at random: torques by at most ±`shift_nm`, other genes by the same share of their ranges.
    fn mutate(
        &mut self,
        body: &mut BodyGenes,
        space: &GenomeSpace,
        shift_nm: f32,
        rng: &mut ChaCha8Rng,
    ) {
        let share = space.shift_share(shift_nm);
        let mut shift =
            |gene: Gene<'_>, value: &mut f32| *value = gene.range.shift(*value, share, rng);
        let genes = &mut Genes::to(&mut shift);
        body.genes(space, genes);
        self.genes(space, genes);
    }

    /// Adds the bits of learned data, which is not a part of the genes, to a genome's hash.
    fn hash_learned(&self, _hash: &mut Xxh3Default) {}

    /// Completes a mutation by which a strategy has changed all genes, for kinds whose genes mutate by rules of their own. `before` holds
    /// the values of the genes before the mutation, in the order of [`Self::genes`].
    fn after_mutation(&mut self, _before: &[f32], _space: &GenomeSpace, _rng: &mut ChaCha8Rng) {}

    /// Returns a few features that summarise all genes, where these are too many to compare; `None` for kinds without a summary.
    fn summary(&self, _space: &GenomeSpace) -> Option<Vec<Feature>> {
        None
    }

    /// Returns the commands that the genes alone determine for a trial of this length, in seconds; `None` where they depend on senses.
    fn commands(&self, _duration_s: f64) -> Option<JointCommands> {
        None
    }
}
