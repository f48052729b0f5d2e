//! Experiments: runs on worker threads, the headless mode, studies, plots, and champions in the formats of other programs.

/// Experiments on worker threads, and the headless mode.
pub mod run;

/// Statistics over runs and trials.
pub mod statistics;

/// Plots as image files.
pub mod plot;

/// Studies: runs of several arms over several seeds, compared and held against demands.
pub mod study;

/// Meshes of limbs, stairs and their fittings.
pub mod mesh;

/// Champions in the formats of other programs.
pub mod export;
