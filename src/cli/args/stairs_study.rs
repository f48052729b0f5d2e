//! The flags of `snakes stairs-study`.

/// The flags of `snakes stairs-study`.
#[derive(Debug, clap::Args)]
pub struct StairsStudyArgs {
    /// Number of seeds, starting with --seed
    #[arg(long, value_name = "N", default_value_t = 5)]
    pub seeds: u64,
    /// Evaluations that each run of a generalist may spend; each has nine trials, and a specialist has nine times as many
    #[arg(long, value_name = "M", default_value_t = 6000)]
    pub evaluations: u32,
}
