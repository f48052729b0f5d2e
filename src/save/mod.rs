//! The only place that touches files: champions and presets as RON, plots and tables, written whole or not at all.
//!
//! The save format is a set of types of its own, one module per version (`v1`, `v2`), apart from the core's
//! types, so that the core may change without breaking a file. What is read is checked before it is
//! used; what is wrong with it is said with the file, the field, the value and what is allowed.

mod champion;
mod files;
mod folder;
mod picture;
mod preset;
mod v1;
mod v2;

pub use champion::{LoadedChampion, load_champion, shipped_champion, store_champion};
pub use files::SaveError;
pub use folder::{SavesFolder, champion_file_name, load_run, run_name};
pub use picture::{Picture, store_csv, store_picture};
pub use preset::{DEFAULT_PRESET, Preset, load_preset, shipped_presets, store_preset};
