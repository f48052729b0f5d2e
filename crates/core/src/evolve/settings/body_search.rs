//! Settings of the strategies that vary bodies.

use super::size::{GenomeSize, LARGEST_POPULATION, LARGEST_STATE_GENES};
use crate::check::Invalid;
use crate::evolve::archives::FIXED_LAYOUT;
use crate::schema::{SettingRow, choice, choices, number, setting_group, whole};

setting_group! {
    /// Settings of the genetic algorithm over bodies.
    pub struct BodyGaSettings in "Genetic algorithm of bodies":
        "Blocks come, go, divide and merge; parents are selected and crossed block by block."
    {
        /// Protection of bodies whose structure has just changed from bodies that have adapted their gaits.
        protection: BodyProtection = BodyProtection::Age,
            choice("Protection of new bodies")
                .hint("A changed body moves by the gait of its parent, and would lose against bodies that have adapted theirs");

        /// Number of candidates in a tournament.
        tournament_size: u32 = 3,
            whole("Tournament size", 1..=1000)
                .hint("Number of snakes drawn at random, the best of which becomes a parent")
                .slider(1.0, 20.0);

        /// Share of the children that have two parents.
        two_parents: f32 = 0.3,
            share_with_two_parents();

        /// Standard deviation of a gene's mutation, as a share of the gene's range.
        mutation_step: f32 = 0.08,
            step_of_mutation();

        /// Number of best individuals that are copied unchanged into the next generation.
        kept_best: u32 = 2,
            whole("Elites", 0..=LARGEST_POPULATION)
                .hint("Number of best snakes copied unchanged into the next generation")
                .slider(0.0, 20.0);
    }
}

setting_group! {
    /// Settings of MAP-Elites over bodies.
    pub struct BodyMapElitesSettings in "MAP-Elites of bodies":
        "Keeps the best snake for each number of blocks and each length, and breeds from all of them."
    {
        /// Number of rows of the archive, from lengths of 4 m to the longest body.
        length_cells: u32 = 16,
            whole("Lengths", 2..=100)
                .hint("Number of rows of the archive, from bodies of 4 m to the longest. Its columns are the numbers of blocks")
                .slider(2.0, 50.0)
                .fixed(FIXED_LAYOUT);

        /// Share of the children that have two parents.
        two_parents: f32 = 0.3,
            share_with_two_parents();

        /// Standard deviation of a gene's mutation, as a share of the gene's range.
        mutation_step: f32 = 0.08,
            step_of_mutation();
    }
}

impl BodyMapElitesSettings {
    /// Checks that a generation and the archive fit into memory.
    pub(super) fn check_size(&self, population: u32, size: &GenomeSize<'_>) -> Result<(), Invalid> {
        size.check_population(population, LARGEST_STATE_GENES)?;
        let columns = size.space.bodies.limbs().count();
        let most = LARGEST_STATE_GENES / size.coordinates().max(1) / columns.max(1);
        if self.length_cells as usize <= most {
            return Ok(());
        }
        let allowed = format!("2 to {most} with the genes of the largest body in each cell");
        Err(Invalid::new("evolution.body_map_elites.length_cells", self.length_cells, allowed))
    }
}

/// Makes the row of the share of children whose blocks come from two parents.
fn share_with_two_parents() -> SettingRow<f32> {
    number("Share with two parents", 0.0..=1.0)
        .advanced()
        .hint("Share of children whose blocks come from two parents, aligned by descent")
        .slider(0.0, 1.0)
}

/// Makes the row of the mutation step of bodies that evolve. About one gene in ten mutates in a child.
pub(super) fn step_of_mutation() -> SettingRow<f32> {
    number("Step of mutation", 1.0e-4..=0.5)
        .hint("As a share of each gene's range. About one gene in ten mutates in a child")
        .slider(0.001, 0.5)
        .logarithmic_from(0.001)
}

choices! {
    /// Protection of bodies whose structure has just changed.
    pub enum BodyProtection {
        None = "none", "None", "Only the fitness counts.";
        /// Parents come from the Pareto front of fitness and the generations since the structure last changed.
        Age = "age", "Age", "A younger body may be worse: a snake only loses against one that is better and no older.";
    }
}

impl IslandSettings {
    /// Checks that the budget of a run suffices for at least one generation.
    ///
    /// # Errors
    /// Fails if one generation of all islands has more evaluations than the whole run.
    pub(super) fn check_size(
        &self,
        [population, generations]: [u32; 2],
        size: &GenomeSize<'_>,
    ) -> Result<(), Invalid> {
        let bodies = &size.space.bodies;
        let islands = u64::from(bodies.limbs_max.saturating_sub(bodies.limbs_min)) + 1;
        let first = islands * u64::from(self.candidates);
        if u64::from(population) * u64::from(generations) >= first {
            return Ok(());
        }
        let least = first.div_ceil(u64::from(population.max(1)));
        let allowed = format!(
            "at least {least} at this population: one generation of islands has {first} evaluations"
        );
        Err(Invalid::new("evolution.generations", generations, allowed))
    }
}

setting_group! {
    /// Settings of the strategy of islands.
    pub struct IslandSettings in "Islands":
        "A CMA-ES for each number of blocks; those that learn fastest get the evaluations."
    {
        /// Number of candidates of each island in a generation.
        candidates: u32 = 12,
            whole("Candidates per island", 4..=1000)
                .hint("Number of snakes of each number of blocks in a generation")
                .slider(4.0, 60.0)
                .fixed(super::cma_es::LEARNED);

        /// Standard deviation of every gene in the first generation, as a share of the gene's range.
        first_step: f32 = 0.15,
            number("First step", 0.001..=1.0)
                .hint("Standard deviation of the first candidates around the best newborn, as a share of each gene's range")
                .slider(0.01, 0.5)
                .logarithmic_from(0.01)
                .fixed(super::cma_es::LEARNED);

        /// First standard deviation of the genes of the body, as a share of that of the controller's genes. It is small, because a gait has
        /// to be learned for bodies that are nearly equal.
        body_share: f32 = 0.1,
            number("Share of the body", 0.001..=1.0).advanced()
                .hint("First step of the genes of the body, as a share of the first step of the other genes")
                .slider(0.01, 1.0)
                .logarithmic_from(0.01)
                .fixed(super::cma_es::LEARNED);
    }
}
