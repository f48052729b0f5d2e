//! All access to files: runs, champions and presets as text, plots and tables. Files are written so that a kill at any instant loses
//! nothing that was finished.
//!
//! The outermost type of a file belongs to this module; most types within it are types of the core, written directly. From the first
//! release on, every released format stays readable (see `v5`). Everything that is read is checked before it is used; an error names the
//! file, the field, the value and the allowed values.

mod champion;
mod champion_exam;
mod change;
mod checkpoint;
mod copies;
mod engine_2;
mod files;
mod folder;
pub mod library;
mod lineage;
mod lock;
mod log;
mod notes;
mod own_files;
mod picture;
mod plan;
mod poet_study;
mod poses;
mod preferences;
mod preset;
mod record;
mod replaced;
mod run;
mod run_name;
mod same_engine;
mod stairs_file;
mod study;
mod v5;
mod whole_file;
mod whole_folder;

pub use champion::{
    LoadedChampion, champion_text, load_champion, load_champion_and_note, parse_champion,
    shipped_champion, store_champion,
};
pub use champion_exam::{check_examinable, exam_in_words, store_exam};
pub use change::parse_changes;
pub use checkpoint::{SearchState, parse_checkpoint};
pub use copies::ChampionCopies;
pub use files::{SaveError, load_text, read_bytes};
pub use folder::{RunSummary, SavesFolder, load_generation, load_run, saved_at, within_run};
pub use lineage::{IndividualRecord, LineageRecord, MAX_SPREAD, parse_lineage};
pub use notes::{EntryNotes, check_notes, check_run_name};
pub use own_files::{KnownFiles, OwnFile, OwnKind};
pub use picture::{
    Picture, encoded_csv, encoded_picture, load_picture, store_csv, store_picture, store_text,
};
pub use plan::{is_run, load_plan, parse_plan};
pub use poet_study::{ControlRun, HardStairs, PoetStudy, load_poet_study, store_poet_study};
pub use preferences::{
    LONGEST_ADDRESS, MAX_RECENT, Preferences, PreferencesFile, QUALITIES, THEMES, UI_SCALES,
};
pub use preset::{
    DEFAULT_PRESET, Preset, load_preset, parse_preset, settings_in_words, shipped_preset_names,
    shipped_presets, store_preset,
};
pub use record::{load_log, parse_evaluations, parse_records};
pub use run::{ExistingRun, RunFolder, SavedProgress};
pub use run_name::{fingerprint, run_name, settings_fingerprint};
pub use stairs_file::{
    NamedStairs, built_in_stairs, built_in_stairs_names, is_stairs_file, load_stairs, parse_stairs,
};
pub use study::{
    CURVE_POINTS, MAX_STUDY_RUNS, Protocol, StudiedArm, StudiedRun, StudyRuns, StudyValue,
    load_definition, load_study, parse_definition, store_study,
};
pub use whole_file::UnfinishedFile;
pub use whole_folder::UnfinishedFolder;
