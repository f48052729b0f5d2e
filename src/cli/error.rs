//! The errors of the command line.

use std::path::PathBuf;

#[cfg(feature = "studio")]
use crate::studio::film::FilmError;
#[cfg(feature = "cluster")]
use snakes_cluster::ClusterError;
use snakes_core::check::Invalid;
use snakes_core::save::SaveError;
use snakes_lab::export::ExportError;
use snakes_lab::run::headless::HeadlessError;
use snakes_lab::run::verify::VerifyError;

/// An error of the command line, in one line.
#[derive(Debug, thiserror::Error)]
pub enum CliError {
    /// The arguments are wrong.
    #[error("{0}")]
    Usage(String),
    /// The arguments are right, but a command without a window failed.
    #[error(transparent)]
    Headless(#[from] HeadlessError),
    /// A folder to resume holds several runs, which were listed.
    #[error("{}: holds {count} runs; give --resume the folder of one of them", folder.display())]
    SeveralRuns {
        /// Path of the folder.
        folder: PathBuf,
        /// Number of runs in the folder.
        count: usize,
    },
    /// The cases of `snakes verify` could not be computed.
    #[error(transparent)]
    Verify(#[from] VerifyError),
    /// The workers on other machines could not be used.
    #[cfg(feature = "cluster")]
    #[error(transparent)]
    Cluster(#[from] ClusterError),
    /// This build has no support for other machines.
    #[cfg(not(feature = "cluster"))]
    #[error(
        "this build computes on this computer only; build it with the feature cluster to use --nats"
    )]
    NoCluster,
    /// A worker sent wrong results after right ones. Holds the reason as one line.
    #[error("{0}")]
    Tainted(String),
    /// The evaluator can evaluate nothing more. Holds the reason, and how far the work came, as one line.
    #[error("{0}")]
    Refused(String),
    /// This machine computes other bits than the reference.
    #[error(
        "{differ} of {all} trajectories differ from the reference: champions saved on other machines move \
         differently on this one (fingerprint {fingerprint}, reference {reference}); please report this with \
         the table above, the processor and the operating system"
    )]
    OtherBits {
        /// Number of trajectories that differ.
        differ: usize,
        /// Number of all trajectories.
        all: usize,
        /// Fingerprint of this machine.
        fingerprint: String,
        /// Fingerprint of the reference.
        reference: String,
    },
    /// A champion could not be exported.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// A film could not be made.
    #[cfg(feature = "studio")]
    #[error(transparent)]
    Film(#[from] FilmError),
    /// A plot could not be drawn.
    #[error(transparent)]
    Plot(#[from] snakes_lab::plot::PlotError),
    /// The studio could not start, or ended with an error.
    #[cfg(feature = "studio")]
    #[error(transparent)]
    Studio(#[from] crate::studio::StudioError),
    /// The program was built without the studio.
    #[cfg(not(feature = "studio"))]
    #[error("this build has no studio: it opens no window and draws no pictures; use --no-render")]
    NoStudio,
}

/// Returns a function that replaces the field in an error by the flag that gave the value.
pub fn of_flag(flag: &str) -> impl Fn(Invalid) -> Invalid {
    move |invalid| Invalid { field: flag.to_owned(), ..invalid }
}

impl CliError {
    /// Returns the exit code: 2 for wrong usage, 1 for failure.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Usage(_) | Self::SeveralRuns { .. } | Self::Export(ExportError::Invalid(_)) => 2,
            #[cfg(feature = "studio")]
            Self::Film(FilmError::Export(ExportError::Invalid(_))) => 2,
            #[cfg(feature = "cluster")]
            Self::Cluster(ClusterError::Invalid(_)) => 2,
            _ => 1,
        }
    }
}

impl From<Invalid> for CliError {
    fn from(invalid: Invalid) -> Self {
        Self::Usage(invalid.to_string())
    }
}

impl From<SaveError> for CliError {
    fn from(error: SaveError) -> Self {
        match error {
            SaveError::Unknown(invalid) => of_flag(&format!("--{}", invalid.field))(invalid).into(),
            SaveError::Study(invalid) => invalid.into(),
            other => Self::Headless(other.into()),
        }
    }
}
