//! The flags of `snakes poet-study`.

/// The flags of `snakes poet-study`.
#[derive(Debug, clap::Args)]
pub struct PoetStudyArgs {
    /// Rounds of the run of POET
    #[arg(long, value_name = "N", default_value_t = 100)]
    pub rounds: u32,
}
