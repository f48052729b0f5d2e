//! Champions in the formats of other programs.
//!
//! Each format has a file of its own. Exports are written atomically: a file appears under its name only when it is complete. They
//! depend neither on a clock nor on the order of threads, so the same champion gives the same bytes.

mod columns;
mod error;
mod facts;
pub mod film;
mod format;
mod gltf;
mod mjcf;
mod motion;
mod order;
mod page;
mod picture;
mod progress;
mod source;
mod table_file;
mod urdf;
mod worksheet;
mod xml_text;

pub use columns::{Column, columns};
pub use error::ExportError;
pub use format::{ExportFormat, FormatInfo};
pub use mjcf::mjcf;
pub use order::ExportOrder;
pub use picture::{PICTURE_SIDES, snapshot};
pub use progress::ExportProgress;
pub use source::{ExportSource, ExportedChampion, ExportedRun};
pub use worksheet::worksheet_page;
