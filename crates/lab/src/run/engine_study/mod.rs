//! A study of the two physics engines: whether newborns move alike in both, whether champions of one keep their way in the other,
//! and whether snakes learn as well.

mod arm;
mod claims;
mod newborns;

pub use arm::kept_in_other;
pub use claims::{EngineFindings, engine_claims, engine_records};
pub use newborns::{NewbornStatistics, newborn_statistics};
