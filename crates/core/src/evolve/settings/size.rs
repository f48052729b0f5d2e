//! Limits of memory: the most numbers that generations and checkpoints may contain.

use crate::check::Invalid;
use crate::genome::{GenomeShape, GenomeSpace};

/// Maximum number of individuals in a generation.
pub const LARGEST_POPULATION: u32 = 100_000;
/// Maximum number of coordinates in all candidates of one iteration of CMA-ES, which take 64 MiB.
pub const LARGEST_SAMPLE: usize = 1 << 23;
/// Maximum number of genes in one generation. As torque points they take 100 MB.
pub const LARGEST_GENERATION_GENES: usize = 25_000_000;
/// Maximum number of genes in the state of a strategy. A checkpoint writes each gene in 12 to 20 characters.
pub const LARGEST_STATE_GENES: usize = 2_000_000;

/// Size of the genomes of a run.
#[derive(Debug)]
pub struct GenomeSize<'a> {
    /// Space of the genomes.
    pub space: &'a GenomeSpace,
    /// Joints and duration for which the genomes are made.
    pub shape: GenomeShape,
    /// Number of torque points of a genome of signals.
    pub torque_points: usize,
}

impl GenomeSize<'_> {
    /// Returns the number of coordinates of a genome as a point of the unit cube.
    pub fn coordinates(&self) -> usize {
        self.space.dimension(self.shape)
    }

    /// Returns the number of genes of a genome that is kept whole.
    pub fn genes(&self) -> usize {
        if self.is_of_points() { self.torque_points } else { self.coordinates() }
    }

    /// Returns whether the genes of the controller are torque points.
    fn is_of_points(&self) -> bool {
        self.space.controller.uses("points_per_s")
    }

    /// Checks that a generation of `population` points has at most `limit` coordinates.
    ///
    /// # Errors
    /// Fails if the generation has more coordinates.
    pub fn check_population(&self, population: u32, limit: usize) -> Result<(), Invalid> {
        self.check_count("evolution.population", population, self.coordinates(), limit)
    }

    /// Checks that `count` individuals of `genes_each` genes have at most `limit` genes together.
    ///
    /// # Errors
    /// Fails if the individuals have more genes; the error names the setting `field`, which determines their number.
    pub fn check_count(
        &self,
        field: &str,
        count: u32,
        genes_each: usize,
        limit: usize,
    ) -> Result<(), Invalid> {
        let most = limit / genes_each.max(1);
        if count as usize <= most {
            return Ok(());
        }
        let noun = if self.is_of_points() { "torque points" } else { "genes" };
        Err(Invalid::new(field, count, format!("1 to {most} with {genes_each} {noun} each")))
    }
}
