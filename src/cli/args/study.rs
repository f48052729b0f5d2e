//! The flags of `snakes study`.

use super::robust::suite_help;

/// The flags of `snakes study`.
#[derive(Debug, clap::Args)]
pub struct StudyArgs {
    /// Name of a built-in study, or path of your own [default: none, and the built-in studies are listed]
    pub study: Option<String>,
    /// Make and show only these arms; the others are still compared with
    #[arg(long, value_name = "A,B", value_delimiter = ',')]
    pub arms: Vec<String>,
    /// The arm with which the others are compared [default: the study's, or the first if that is not among them]
    #[arg(long, value_name = "ARM")]
    pub baseline: Option<String>,
    /// Strategies of a study of methods, in this order [default: the study's]
    #[arg(long, value_name = "A,B", value_delimiter = ',')]
    pub strategies: Vec<String>,
    /// Controllers of a study of methods, in this order [default: the study's]
    #[arg(long, value_name = "X,Y", value_delimiter = ',')]
    pub controllers: Vec<String>,
    /// Number of seeds, beginning with --seed [default: the study's]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub seeds: Option<String>,
    /// Evaluations that a run may spend [default: the study's]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub evaluations: Option<String>,
    #[arg(long, value_name = "NAME", help = suite_help("the study's"))]
    pub suite: Vec<String>,
    /// Print the values that a study may name, as the table in docs/studies.md
    #[arg(long, conflicts_with = "study")]
    pub markdown: bool,
    /// Rounds of the run of POET, of the study poet only [default: 100]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub rounds: Option<String>,
}
