//! Help: menu bar, command palette, keyboard shortcuts and tour.

pub mod command_palette;
pub mod key_list;
pub mod menu;
pub mod tour;
mod tour_place;
