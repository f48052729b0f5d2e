//! Whole-program tests: one binary, one module per concern.

mod architecture;
mod bad_input;
mod determinism;
mod headless;
mod program;
#[cfg(all(feature = "studio", target_os = "linux"))]
mod window;
