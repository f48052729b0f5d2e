//! An experiment going on: worker threads, pause and cancel, statistics, and the headless mode.

mod background;
pub mod bench;
pub mod calibrate;
pub mod compare;
mod control;
mod errand;
mod experiment;
pub mod headless;
mod keeper;
mod librarian;
mod lineage;
mod listing;
mod lookahead;
mod panics;
mod reading;
mod report;
pub mod robust;
mod side_by_side;
pub mod table1;
mod threads;
pub mod verify;

pub use background::{Background, Event, Exploration};
pub use control::{Cancelled, Control};
pub use errand::Errand;
pub use experiment::Experiment;
pub use keeper::{ChangeError, Keeper, KeptRun, RunSource};
pub use librarian::{Librarian, Reading};
pub use lineage::{Ancestor, Descent, Generation, Spread};
pub use listing::Listing;
pub use lookahead::Lookahead;
pub use panics::caught;
pub use reading::LogReading;
pub use report::{Crash, GenerationReport, Statistics};
pub use side_by_side::{SideBySide, Told};
pub use threads::{THREADS_RANGE, available_cores, pool};
