//! Settings of MAP-Elites.

use super::size::{GenomeSize, LARGEST_SAMPLE, LARGEST_STATE_GENES};
use crate::check::Invalid;
use crate::evolve::archives::{Descriptor, FIXED_LAYOUT};
use crate::schema::{Choices, choice, number, setting_group, whole};

setting_group! {
    /// Settings of MAP-Elites.
    pub struct MapElitesSettings in "MAP-Elites":
        "Keeps the best snake for each kind of behaviour in an archive and breeds from all of them."
    {
        /// Descriptor of the columns of the archive.
        x: Descriptor = Descriptor::BodyHeight,
            choice("Archive columns")
                .hint("Behaviour that distinguishes the columns of the archive")
                .fixed(FIXED_LAYOUT);

        /// Descriptor of the rows of the archive.
        y: Descriptor = Descriptor::EnergyPerMetre,
            choice("Archive rows")
                .hint("Behaviour that distinguishes the rows of the archive")
                .fixed(FIXED_LAYOUT);

        /// Number of columns of the archive, and also of its rows.
        cells: u32 = 16,
            whole("Columns and rows", 2..=100)
                .hint(
                    "Number of columns and of rows of the archive. More cells distinguish finer differences",
                )
                .slider(2.0, 50.0)
                .fixed(FIXED_LAYOUT);

        /// Standard deviation of the steps of the Gaussian emitter, as a share of each gene's range.
        step: f32 = 0.03,
            number("Mutation step", 0.0..=1.0)
                .hint("Spread of random steps from an elite, as a share of each gene's range")
                .slider(0.0, 0.3);

        /// Standard deviation of the Gaussian emitter's steps along the line to another elite, as a share of the length of the line.
        line: f32 = 0.2,
            number("Step towards another elite", 0.0..=2.0).advanced()
                .hint("Spread of steps along the line between two elites, in lengths of that line")
                .slider(0.0, 1.0);

        /// Share of each generation that the CMA-ES emitter creates.
        cma_share: f32 = 0.5,
            number("CMA-ES share", 0.0..=1.0).advanced()
                .hint("Share of each generation that CMA-ES creates around an elite")
                .slider(0.0, 1.0);

        /// Initial step size of the CMA-ES emitter around an elite, as a share of each gene's range.
        cma_step: f32 = 0.1,
            number("Size of first CMA-ES mutations", 1.0e-6..=1.0).advanced()
                .hint("Initial spread of CMA-ES around an elite, as a share of each gene's range")
                .slider(0.001, 1.0)
                .logarithmic_from(0.001);
    }

    fn check_together(&self) -> Result<(), Invalid> {
        if self.x != self.y {
            return Ok(());
        }
        Err(Invalid::new("y", self.y.choice().name, "a behaviour other than that of the archive columns"))
    }
}

impl MapElitesSettings {
    /// Checks that a generation and the archive fit into memory.
    pub(super) fn check_size(&self, population: u32, size: &GenomeSize<'_>) -> Result<(), Invalid> {
        size.check_population(population, LARGEST_SAMPLE)?;
        let genes = size.coordinates().max(1);
        let most = (LARGEST_STATE_GENES / genes).isqrt();
        if self.cells as usize <= most {
            return Ok(());
        }
        let allowed = format!("2 to {most} with {genes} genes in each cell");
        Err(Invalid::new("evolution.map_elites.cells", self.cells, allowed))
    }
}
