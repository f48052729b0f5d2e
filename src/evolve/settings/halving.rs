//! Settings of the report's method.

use serde::{Deserialize, Serialize};

use super::size::{GenomeSize, LARGEST_POPULATION, LARGEST_STATE_GENES};
use crate::check::Invalid;
use crate::schema::{Section, SettingGroup, Walk, number, whole};

/// Settings of the report's method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HalvingSettings {
    /// Number of the best that become parents. The report has four.
    pub parents: u32,
    /// Mutation range of the second generation, in N·m. The report has 100.
    pub mutation_range_nm: f32,
    /// Factor of the range with each further generation. The report has 0.5.
    pub mutation_decay: f32,
}

impl Default for HalvingSettings {
    fn default() -> Self {
        Self { parents: 4, mutation_range_nm: 100.0, mutation_decay: 0.5 }
    }
}

impl HalvingSettings {
    /// The section of these settings.
    pub const SECTION: Section = Section {
        title: "Halving (the report's)",
        about: "The best few become parents; children vary at random within a range that shrinks each generation.",
    };

    /// The report's run has six generations. The range halves with each, so that more would stand still.
    pub const REPORT_GENERATIONS: u32 = 6;

    /// Checks that a generation and its parents fit into memory.
    pub(super) fn check_size(&self, population: u32, size: &GenomeSize<'_>) -> Result<(), Invalid> {
        size.check_generation(population, size.genes())?;
        let parents = self.parents.min(population);
        size.check_count("evolution.halving.parents", parents, size.genes(), LARGEST_STATE_GENES)
    }
}

impl SettingGroup for HalvingSettings {
    fn walk(&mut self, walk: &mut Walk<'_>) {
        let Self { parents, mutation_range_nm, mutation_decay } = self;
        walk.section(Self::SECTION);
        walk.setting(
            whole("parents", "Parents", 1..=LARGEST_POPULATION)
                .hint("Number of best snakes that become parents. Few converge quickly, many keep more variety")
                .slider(1.0, 50.0),
            parents,
        );
        walk.setting(
            number("mutation_range_nm", "Mutation range", 0.0..=1.0e6)
                .unit("N·m")
                .hint(
                    "Maximum difference between parents and the children of the second generation",
                )
                .slider(0.0, 1000.0),
            mutation_range_nm,
        );
        walk.setting(
            number("mutation_decay", "Mutation decay", 0.0..=1.0)
                .hint("Factor by which the range changes per generation: 0.5 halves it, 1 keeps it")
                .slider(0.0, 1.0),
            mutation_decay,
        );
    }
}
