//! Every setting of a run with its words, its range and its control: one file for each group of sections.
//!
//! A section is plain data. [`Sheet`] draws it and keeps what is being dragged or typed. That no setting is missing
//! and none is made up is tested here against [`crate::evolve::fields`].

mod columns;
pub mod controller;
mod entry;
mod named;
mod number;
mod refusal;
pub mod reward;
pub mod scene;
mod sheet;
pub mod snake;
pub mod strategies;
pub mod surface;
mod values;

pub use entry::{Entry, Section};
pub use sheet::Sheet;

use crate::evolve::StrategyKind;

/// The sections of the world and the snake, in the order in which they are shown.
pub const WORLD: [&Section; 11] = [
    &surface::SURFACE,
    &surface::GROUND,
    &surface::SKIN,
    &snake::BODY,
    &snake::JOINTS,
    &scene::STAIRS,
    &scene::TIME,
    &scene::PHYSICS,
    &reward::REWARD,
    &reward::REPEATS,
    &scene::HEALTH,
];

/// All sections: those of the search, those of the world.
pub fn all_sections() -> Vec<&'static Section> {
    let of_strategies = StrategyKind::ALL.into_iter().filter_map(strategies::section_of);
    let search = [&strategies::RUN, &strategies::STRATEGY].into_iter().chain(of_strategies);
    let genome = [&controller::CONTROLLER].into_iter().chain(controller::GENOME);
    search.chain(genome).chain(WORLD).collect()
}

#[cfg(test)]
pub(super) mod tests;
