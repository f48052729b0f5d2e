//! The flags of `snakes engine-study`.

/// The flags of `snakes engine-study`.
#[derive(Debug, clap::Args)]
pub struct EngineStudyArgs {
    /// Number of seeds, starting with --seed
    #[arg(long, value_name = "N", default_value_t = 20)]
    pub seeds: u64,
    /// Evaluations that each run may spend
    #[arg(long, value_name = "M", default_value_t = 6000)]
    pub evaluations: u32,
    /// Newborns whose motions are compared
    #[arg(long, value_name = "N", default_value_t = 2000)]
    pub newborns: u32,
}
