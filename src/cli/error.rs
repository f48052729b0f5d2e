//! What the command line may end with.

use crate::run::headless::HeadlessError;
use crate::run::verify::VerifyError;
use crate::save::SaveError;

/// An error of the command line, in one line.
#[derive(Debug, thiserror::Error)]
pub enum CliError {
    /// The program was called wrongly.
    #[error("{0}")]
    Usage(String),
    /// It was called well, and failed.
    #[error(transparent)]
    Headless(#[from] HeadlessError),
    /// The golden trajectories could not be computed.
    #[error(transparent)]
    Verify(#[from] VerifyError),
    /// This machine computes other bits.
    #[error(
        "{differ} of {all} trajectories differ from the reference: saves from elsewhere go another way \
         on this machine (fingerprint {fingerprint}, reference {reference}); please report it with the \
         table above, the processor and the system"
    )]
    OtherBits {
        /// How many trajectories differ.
        differ: usize,
        /// How many there are.
        all: usize,
        /// The fingerprint of this machine.
        fingerprint: String,
        /// The fingerprint of the reference.
        reference: String,
    },
    /// A plot could not be drawn.
    #[error(transparent)]
    Plot(#[from] crate::plot::PlotError),
    /// The studio could not start, or ended badly.
    #[cfg(feature = "studio")]
    #[error(transparent)]
    Studio(#[from] crate::studio::StudioError),
    /// The program was built without the studio.
    #[cfg(not(feature = "studio"))]
    #[error("this build has no studio: it opens no window and draws no figures; use --no-render")]
    NoStudio,
}

impl CliError {
    /// 2 for wrong usage, 1 for failure.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Usage(_) => 2,
            _ => 1,
        }
    }
}

impl From<SaveError> for CliError {
    fn from(error: SaveError) -> Self {
        match error {
            SaveError::UnknownPreset(invalid) => invalid.into(),
            other => Self::Headless(other.into()),
        }
    }
}
