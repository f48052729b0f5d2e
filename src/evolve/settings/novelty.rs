//! Settings of novelty search.

use serde::{Deserialize, Serialize};

use super::ga::GaSettings;
use super::size::GenomeSize;
use crate::check::{Invalid, within};
use crate::evolve::archives::{Descriptor, FIXED_LAYOUT};
use crate::schema::{Section, SettingGroup, Walk, choice, number, whole};

/// Settings of novelty search. Children are made as the genetic algorithm makes them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoveltySettings {
    /// Weight of novelty: 1 is pure novelty search, 0 is the genetic algorithm.
    pub weight: f32,
    /// Number of nearest neighbours whose mean distance is the novelty.
    pub neighbours: u32,
    /// Number of individuals of each generation, chosen at random, that enter the archive.
    pub remembered: u32,
    /// Maximum size of the archive. When it is full, new behaviours replace random others.
    pub archive_limit: u32,
    /// First descriptor of behaviours, beside the final position.
    pub first: Descriptor,
    /// Second descriptor.
    pub second: Descriptor,
}

impl Default for NoveltySettings {
    fn default() -> Self {
        Self {
            weight: 0.5,
            neighbours: 15,
            remembered: 6,
            archive_limit: 2000,
            first: Descriptor::BodyHeight,
            second: Descriptor::ContactDuty,
        }
    }
}

impl NoveltySettings {
    /// The section of these settings.
    pub const SECTION: Section = Section {
        title: "Novelty search",
        about: "Rewards new behaviour. Children are created with the settings of the genetic algorithm.",
    };

    /// Checks that a generation fits into memory and can be compared.
    pub(super) fn check_size(population: u32, size: &GenomeSize<'_>) -> Result<(), Invalid> {
        GaSettings::check_size(population, size)?;
        // Each individual is compared with all others, and with the archive.
        within("evolution.population", population, 1..=10_000)
    }
}

impl SettingGroup for NoveltySettings {
    fn walk(&mut self, walk: &mut Walk<'_>) {
        let Self { weight, neighbours, remembered, archive_limit, first, second } = self;
        walk.section(Self::SECTION);
        walk.setting(
            number("weight", "Novelty weight", 0.0..=1.0)
                .hint("1 is pure novelty search, 0 uses fitness only")
                .slider(0.0, 1.0),
            weight,
        );
        walk.setting(
            whole("neighbours", "Neighbours", 1..=1000)
                .hint("Novelty is the mean distance to this number of most similar snakes")
                .slider(1.0, 50.0),
            neighbours,
        );
        walk.setting(
            whole("remembered", "Memory per generation", 0..=1000)
                .hint("Number of random snakes per generation kept for comparison with later ones")
                .slider(0.0, 50.0),
            remembered,
        );
        // Each individual is compared with all of them.
        walk.setting(
            whole("archive_limit", "Memory size", 1..=20_000)
                .hint("Maximum number of snakes kept for comparison; beyond it, new ones replace others")
                .slider(100.0, 20_000.0)
                .logarithmic_from(100.0),
            archive_limit,
        );
        walk.setting(
            choice("first", "First behaviour")
                .hint("Behaviour that distinguishes snakes, in addition to their final position")
                .fixed(FIXED_LAYOUT),
            first,
        );
        walk.setting(
            choice("second", "Second behaviour")
                .hint("A second behaviour that distinguishes snakes")
                .fixed(FIXED_LAYOUT),
            second,
        );
    }
}
