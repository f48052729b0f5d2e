//! The flags of `snakes body-study`.

/// The flags of `snakes body-study`.
#[derive(Debug, clap::Args)]
pub struct BodyStudyArgs {
    /// Number of seeds, starting with --seed
    #[arg(long, value_name = "N", default_value_t = 10)]
    pub seeds: u64,
    /// Evaluations that each run may spend
    #[arg(long, value_name = "M", default_value_t = 6000)]
    pub evaluations: u32,
    /// Study creatures instead of chains of blocks: whether they move on flat ground within 20,000 evaluations and climb low
    /// stairs within 60,000, and how different they are after --evaluations
    #[arg(long)]
    pub creatures: bool,
}
