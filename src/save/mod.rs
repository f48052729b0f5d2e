//! The only place that touches files: runs, champions and presets as text, plots and tables, written so that
//! a kill at any instant loses nothing that was finished.
//!
//! The save format is a set of types of its own, one module per version (`v1` to `v4`), apart from the core's
//! types, so that the core may change without breaking a file. What is read is checked before it is
//! used; what is wrong with it is said with the file, the field, the value and what is allowed.

mod champion;
mod change;
mod checkpoint;
mod comparison;
mod files;
mod folder;
pub mod library;
mod lineage;
mod lock;
mod log;
mod mirror;
mod own_preset;
mod picture;
mod plan;
mod poses;
mod preferences;
mod preset;
mod record;
mod run;
mod settings;
mod v1;
mod v2;
mod v3;
mod v4;

pub use champion::{
    LoadedChampion, load_champion, parse_champion, shipped_champion, store_champion,
};
pub use change::parse_changes;
pub use checkpoint::{Knowledge, parse_checkpoint};
pub use comparison::{
    CURVE_POINTS, ComparedBest, ComparedRun, Comparison, MOST_RUNS, load_comparison,
    store_comparison,
};
pub use files::SaveError;
#[cfg(test)]
pub use files::names_in;
pub use folder::{
    RunSummary, SavesFolder, fingerprint, load_generation, load_run, run_name, settings_fingerprint,
};
pub use lineage::{BornRecord, LineageRecord, MOST_SPREAD, parse_lineage};
pub use own_preset::{OwnPreset, check_own_name};
pub use picture::{Picture, store_csv, store_picture, store_text};
pub use plan::{load_plan, parse_plan};
pub use preferences::{Preferences, PreferencesFile, UI_SCALES};
pub use preset::{
    DEFAULT_PRESET, Preset, load_preset, parse_preset, shipped_presets, store_preset,
};
pub use record::{GenerationRecord, StatisticsRecord, load_log, parse_evaluations, parse_records};
pub use run::{Earlier, Progress, RunFolder};
