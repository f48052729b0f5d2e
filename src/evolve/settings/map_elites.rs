//! Settings of MAP-Elites.

use serde::{Deserialize, Serialize};

use super::size::{GenomeSize, LARGEST_SAMPLE, LARGEST_STATE_GENES};
use crate::check::Invalid;
use crate::evolve::archives::{Descriptor, FIXED_LAYOUT};
use crate::schema::{Section, SettingGroup, Walk, choice, number, whole};

/// Settings of MAP-Elites.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MapElitesSettings {
    /// Descriptor of the columns of the archive.
    pub x: Descriptor,
    /// Descriptor of its rows.
    pub y: Descriptor,
    /// Number of columns and of rows.
    pub cells: u32,
    /// Standard deviation of the steps of the Gaussian emitter, as a share of each gene's range.
    pub step: f32,
    /// Standard deviation of its steps along the line to another elite, as a share of that line.
    pub line: f32,
    /// Share of each generation that the CMA-ES emitter makes.
    pub cma_share: f32,
    /// Step at which the CMA-ES emitter begins around an elite.
    pub cma_step: f32,
}

impl Default for MapElitesSettings {
    fn default() -> Self {
        Self {
            x: Descriptor::BodyHeight,
            y: Descriptor::EnergyPerMetre,
            cells: 16,
            step: 0.03,
            line: 0.2,
            cma_share: 0.5,
            cma_step: 0.1,
        }
    }
}

impl MapElitesSettings {
    /// The section of these settings.
    pub const SECTION: Section = Section {
        title: "MAP-Elites",
        about: "Keeps the best snake for each kind of behaviour in an archive and breeds from all of them.",
    };

    /// Checks that a generation and the archive fit into memory.
    pub(super) fn check_size(&self, population: u32, size: &GenomeSize<'_>) -> Result<(), Invalid> {
        let genes = size.coordinates();
        size.check_generation(population, genes)?;
        size.check_count("evolution.population", population, genes, LARGEST_SAMPLE)?;
        let cells = self.cells * self.cells;
        let field = "evolution.map_elites.cells (squared)";
        size.check_count(field, cells, genes, LARGEST_STATE_GENES)
    }
}

impl SettingGroup for MapElitesSettings {
    fn walk(&mut self, walk: &mut Walk<'_>) {
        let Self { x, y, cells, step, line, cma_share, cma_step } = self;
        walk.section(Self::SECTION);
        walk.setting(
            choice("x", "Archive columns")
                .hint("Behaviour that distinguishes the columns of the archive")
                .fixed(FIXED_LAYOUT),
            x,
        );
        walk.setting(
            choice("y", "Archive rows")
                .hint("Behaviour that distinguishes the rows of the archive")
                .fixed(FIXED_LAYOUT),
            y,
        );
        walk.setting(
            whole("cells", "Columns and rows", 2..=100)
                .hint("Number of columns and of rows of the archive. More distinguish finer differences")
                .slider(2.0, 50.0)
                .fixed(FIXED_LAYOUT),
            cells,
        );
        walk.setting(
            number("step", "Mutation step", 0.0..=1.0)
                .hint("Spread of random steps from an elite, as a share of each gene's range")
                .slider(0.0, 0.3),
            step,
        );
        walk.setting(
            number("line", "Step towards another elite", 0.0..=2.0)
                .hint("Spread of steps along the line between two elites, in lengths of that line")
                .slider(0.0, 1.0),
            line,
        );
        walk.setting(
            number("cma_share", "CMA-ES share", 0.0..=1.0)
                .hint("Share of each generation that CMA-ES creates around an elite")
                .slider(0.0, 1.0),
            cma_share,
        );
        walk.setting(
            number("cma_step", "CMA-ES initial step size", 1.0e-6..=1.0)
                .hint("Initial spread of CMA-ES around an elite, as a share of each gene's range")
                .slider(0.001, 1.0)
                .logarithmic_from(0.001),
            cma_step,
        );
    }

    fn check_together(&self) -> Result<(), Invalid> {
        if self.x != self.y {
            return Ok(());
        }
        Err(Invalid::new("y", self.y.name(), "a descriptor other than that of x"))
    }
}
