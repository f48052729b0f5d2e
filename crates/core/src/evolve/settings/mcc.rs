//! Settings of minimal criterion coevolution.

use super::PoetSettings;
use super::size::{GenomeSize, LARGEST_SAMPLE, LARGEST_STATE_GENES};
use crate::check::Invalid;
use crate::schema::{number, setting_group, switch, whole};

setting_group! {
    /// Settings of minimal criterion coevolution (Brant and Stanley, "Minimal Criterion Coevolution", 2017, with the resource
    /// limit of "Diversity Preservation in Minimal Criterion Coevolution through Resource Limitation", 2020).
    pub struct MccSettings in "Minimal criterion coevolution":
        "Two queues without any fitness: snakes that climb some stairs, and stairs that some snake climbs."
    {
        /// Share of the way that a snake has to cover to climb stairs.
        criterion: f32 = 0.85,
            number("Criterion", 0.05..=1.1)
                .hint("Share of the way that a snake has to cover to climb stairs. To cover more has no advantage")
                .slider(0.05, 1.0);

        /// Maximum number of snakes in the queue of snakes.
        snake_queue: u32 = 60,
            whole("Queue of snakes", 2..=1000)
                .hint("Maximum number of snakes that have children in turn. When another one comes, the oldest is removed")
                .slider(2.0, 200.0);

        /// Number of children of snakes in a generation.
        snake_children: u32 = 12,
            whole("Children of snakes", 1..=200)
                .hint("How many children of snakes are tried on all stairs in a generation")
                .slider(1.0, 50.0);

        /// Standard deviation of each gene of a child around its parent, as a share of the gene's range.
        child_step: f32 = 0.05,
            number("Step of a child", 0.001..=1.0)
                .hint("Spread of children around their parents, as a share of each gene's range")
                .slider(0.01, 0.5)
                .logarithmic_from(0.01);

        /// Maximum number of stairs in the queue of stairs.
        stairs_queue: u32 = 12,
            whole("Queue of stairs", 1..=100)
                .hint("Maximum number of stairs that have mutants in turn. When another one comes, the oldest is removed")
                .slider(1.0, 40.0);

        /// Number of mutants of stairs in a generation.
        stairs_children: u32 = 4,
            whole("Mutants of stairs", 1..=50)
                .hint("How many mutants of stairs are tried with all snakes in a generation")
                .slider(1.0, 20.0);

        /// Number of snakes that may enter the queue of snakes by climbing the same stairs.
        uses_of_stairs: u32 = 5,
            whole("Uses of stairs", 1..=1000)
                .hint("How many snakes may enter their queue by climbing the same stairs. Without a limit, most snakes would be those of easy stairs")
                .slider(1.0, 50.0);

        /// Number of snakes that a search on the first stairs has to find before coevolution begins.
        first_snakes: u32 = 20,
            whole("First snakes", 1..=1000).advanced()
                .hint("How many snakes a search on the first stairs has to find before coevolution begins; at most as many as their queue holds")
                .slider(1.0, 100.0);

        /// Rise of a step of the first stairs, in m.
        start_rise_m: f32 = 0.1,
            number("Rise at the start", 0.1..=1.2)
                .unit("m")
                .hint("Rise of the first stairs; their steps and treads are those of the trial")
                .slider(0.1, 1.2)
                .fixed("Takes effect with the next run, because this one has begun on its first stairs.");

        /// Whether mutants of stairs may also have landings, missing steps, ramps and steps down.
        special_steps: bool = true,
            switch("Special steps")
                .hint("Whether mutants may also have a landing, a missing step, ramps or steps down");
    }

    fn check_together(&self) -> Result<(), Invalid> {
        if self.first_snakes <= self.snake_queue {
            return Ok(());
        }
        let allowed = format!("up to {}, the queue of snakes", self.snake_queue);
        Err(Invalid::new("first_snakes", self.first_snakes, allowed))
    }
}

impl MccSettings {
    /// Checks that a generation, and the snakes that are kept for the stairs of a run, fit into memory.
    pub(super) fn check_size(&self, size: &GenomeSize<'_>) -> Result<(), Invalid> {
        let field = "evolution.mcc.snake_queue";
        let at_once =
            self.snake_children * self.stairs_queue + self.stairs_children * self.snake_queue;
        size.check_count(field, at_once, size.genes(), LARGEST_SAMPLE)?;
        let kept = PoetSettings::MOST_STAIRS as u32 + self.snake_queue;
        size.check_count(field, kept, size.genes(), LARGEST_STATE_GENES)
    }
}
