//! Failures that would otherwise end the program without a message: a missing display, a panic, a lost graphics device.

pub mod gpu_loss;
pub mod panic_guard;
pub mod variables;
