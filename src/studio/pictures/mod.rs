//! Pictures of the scene: screenshots of the window, and renderings without a window.

pub mod figures;
pub mod film;
pub mod offscreen;
pub mod render;
pub mod screenshot;
