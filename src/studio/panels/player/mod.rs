//! Panels on the edges of the stage: the player below it, the camera buttons above it, the leaderboard beside it.

pub mod camera_bar;
mod card_places;
pub mod cards;
mod climb_events;
pub mod generation_card;
pub mod leaderboard;
pub mod limb_card;
pub mod overlay_legend;
pub mod presented_caption;
pub mod stage_card;
mod strip_marks;
pub mod timeline;
pub mod torque_strip;
