//! Experiments: runs on worker threads, the headless mode, studies, plots, and champions in the formats of other programs.

/// Experiments on worker threads, and the headless mode.
pub mod run;

/// Plots as image files.
pub mod plot;

/// Champions in the formats of other programs.
pub mod export;
