//! CMA-ES, the covariance matrix adaptation evolution strategy, for any function of points.

mod candidate;
mod eigen;
mod rates;
mod restarts;
mod run;
mod termination;

pub use candidate::RankedCandidate;
pub use rates::CovarianceShape;
pub use restarts::{CmaParameters, RestartedCma};
pub use run::Cma;

#[cfg(test)]
mod search_tests;
