//! Settings of MAP-Elites.

use super::LAYOUT;
use super::size::{GenomeSize, LARGEST_SAMPLE, LARGEST_STATE_GENES};
use crate::check::Invalid;
use crate::evolve::archives::Descriptor;
use crate::schema::{Choices, choice, number, setting_group, whole};

setting_group! {
    /// Settings of MAP-Elites.
    pub struct MapElitesSettings in "MAP-Elites":
        "Keeps the best of every kind of behaviour in a map, and breeds from all of them."
    {
        /// Descriptor of the columns of the archive.
        x: Descriptor = Descriptor::BodyHeight,
            choice("Columns of the map")
                .hint("The behaviour that the columns of the map tell apart")
                .fixed(LAYOUT);

        /// Descriptor of its rows.
        y: Descriptor = Descriptor::EnergyPerMetre,
            choice("Rows of the map")
                .hint("The behaviour that the rows of the map tell apart")
                .fixed(LAYOUT);

        /// Number of columns and of rows.
        cells: u32 = 16,
            whole("Columns and rows", 2..=100)
                .hint("Number of columns, and of rows. More keep finer differences apart")
                .slider(2.0, 50.0)
                .fixed(LAYOUT);

        /// Standard deviation of the steps of the Gaussian emitter, as a share of each gene's range.
        step: f32 = 0.03,
            number("Step of mutation", 0.0..=1.0)
                .hint("Spread of random steps from an elite, as a share of each gene's range")
                .slider(0.0, 0.3);

        /// Standard deviation of its steps along the line to another elite, as a share of that line.
        line: f32 = 0.2,
            number("Step towards another elite", 0.0..=2.0)
                .hint("Spread of steps along the line between two elites, in lengths of that line")
                .slider(0.0, 1.0);

        /// Share of each generation that the CMA-ES emitter makes.
        cma_share: f32 = 0.5,
            number("Share made by CMA-ES", 0.0..=1.0)
                .hint("Share of each generation that is bred by CMA-ES around an elite")
                .slider(0.0, 1.0);

        /// Step at which the CMA-ES emitter begins around an elite.
        cma_step: f32 = 0.1,
            number("Step of that CMA-ES", 1.0e-6..=1.0)
                .hint("Its first spread around the elite, as a share of each gene's range")
                .slider(0.001, 1.0)
                .logarithmic_from(0.001);
    }

    fn check_together(&self) -> Result<(), Invalid> {
        if self.x != self.y {
            return Ok(());
        }
        Err(Invalid::new("y", self.y.choice().name, "another descriptor than that of x"))
    }
}

impl MapElitesSettings {
    /// Checks that a generation and the archive fit into memory.
    pub(super) fn check_size(&self, population: u32, size: &GenomeSize<'_>) -> Result<(), Invalid> {
        size.check_population(population, LARGEST_SAMPLE)?;
        let cells = self.cells * self.cells;
        let field = "evolution.map_elites.cells (squared)";
        size.check_count(field, cells, size.coordinates(), LARGEST_STATE_GENES)
    }
}
