//! Whole-program tests: one binary, one module per concern.
#![expect(clippy::expect_used, reason = "a helper of a test fails by panicking, as tests do")]

mod architecture;
mod bad_input;
mod bodies;
mod champions;
#[cfg(all(feature = "cluster", target_os = "linux"))]
mod cluster;
mod data_page;
mod determinism;
mod docs;
mod episodes;
mod exports;
#[cfg(feature = "studio")]
mod features;
#[cfg(target_os = "linux")]
mod few_threads;
mod fuzz;
mod headless;
mod hostile;
mod keep;
mod learned_files;
#[cfg(target_os = "linux")]
mod limits;
#[cfg(unix)]
mod names;
mod opening;
#[cfg(unix)]
mod other_hands;
mod program;
mod same_bits;
mod soak;
mod studies;
#[cfg(all(feature = "studio", target_os = "linux"))]
mod window;
