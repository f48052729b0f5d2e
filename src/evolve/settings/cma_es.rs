//! Settings of CMA-ES.

use serde::{Deserialize, Serialize};

use super::size::{GenomeSize, LARGEST_POPULATION, LARGEST_SAMPLE};
use crate::check::{Invalid, within};
use crate::schema::{Choice, Choices, Section, SettingGroup, Walk, choice, number, switch, whole};

/// Settings of CMA-ES.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CmaEsSettings {
    /// Standard deviation of the first generation, as a share of each gene's range.
    pub step: f32,
    /// Whether bad individuals count too, by making their directions less likely.
    pub active: bool,
    /// The reaction when a search has ended.
    pub restarts: RestartKind,
    /// Number of random genomes in a first generation of their own, the best of which is the start of the search. 0:
    /// the search starts in the middle of all ranges.
    pub newborns: u32,
}

impl Default for CmaEsSettings {
    fn default() -> Self {
        Self { step: 0.3, active: true, restarts: RestartKind::Bipop, newborns: 0 }
    }
}

impl CmaEsSettings {
    /// The section of these settings.
    pub const SECTION: Section =
        Section { title: "CMA-ES", about: "Learns in which directions variation pays off." };

    /// Checks that a generation fits into memory.
    pub(super) fn check_size(population: u32, size: &GenomeSize<'_>) -> Result<(), Invalid> {
        let genes = size.coordinates();
        size.check_generation(population, genes)?;
        within("evolution.population", population, 2..=LARGEST_POPULATION)?;
        size.check_count("evolution.population", population, genes, LARGEST_SAMPLE)
    }
}

/// Why a run keeps what its CMA-ES began with.
pub const LEARNED: &str =
    "Takes effect with the next run, because the state of CMA-ES depends on it.";

impl SettingGroup for CmaEsSettings {
    fn walk(&mut self, walk: &mut Walk<'_>) {
        let Self { step, active, restarts, newborns } = self;
        walk.section(Self::SECTION);
        walk.setting(
            number("step", "Initial step size", 1.0e-6..=10.0)
                .hint("Spread of the first generation, as a share of each gene's range. Small steps search nearby")
                .slider(0.01, 1.0)
                .logarithmic_from(0.01)
                .fixed(LEARNED),
            step,
        );
        walk.setting(
            switch("active", "Also learn from poor snakes")
                .hint("Directions that lead to poor snakes become less likely (active CMA-ES)")
                .fixed(LEARNED),
            active,
        );
        walk.setting(
            choice("restarts", "Restarts")
                .hint("How the search continues after it has converged")
                .fixed(LEARNED),
            restarts,
        );
        // They are a generation of their own, beyond the budget.
        walk.setting(
            whole("newborns", "Random snakes first", 0..=10_000)
                .hint(
                    "The search starts at the best of this many random snakes; at 0, in the middle of all ranges",
                )
                .slider(0.0, 1000.0)
                .fixed(LEARNED),
            newborns,
        );
    }
}

impl Choices for RestartKind {
    const OPTIONS: &'static [Self] = &[Self::None, Self::Ipop, Self::Bipop];

    fn choice(self) -> Choice {
        match self {
            Self::None => Choice::new("none", "None", "The search continues where it is."),
            Self::Ipop => Choice::new(
                "ipop",
                "Larger population",
                "A new search with twice the population (IPOP).",
            ),
            Self::Bipop => Choice::new(
                "bipop",
                "Larger or smaller population",
                "New searches, some with twice the population, some with a small one (BIPOP).",
            ),
        }
    }
}

/// What follows when a search has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RestartKind {
    /// Nothing: its distribution no longer changes.
    None,
    /// A search with twice the population, up to 2⁹ times the first.
    Ipop,
    /// Either that, or a search with a small population and a small step, whichever kind has used fewer
    /// evaluations. As in Hansen's pycma 4.5, the first search counts as small, and a small one ends after half
    /// of the evaluations that the large ones have used.
    Bipop,
}
