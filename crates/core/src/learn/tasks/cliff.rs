//! The cliff (Sutton & Barto, "Reinforcement Learning", 2nd edition, 2018, example 6.6): the shortest path to the goal leads along a
//! cliff, and a fall costs 100 and leads back to the start.

use super::grid::GridWorld;

/// The world with a cliff between start and goal, in the lowest row. Every move costs 1. A fall does not end the episode.
pub struct Cliff;

/// Reward of a move.
const MOVE: f32 = -1.0;
/// Reward of a move over the cliff.
const FALL: f32 = -100.0;

impl GridWorld for Cliff {
    const ROWS: u32 = 4;
    const COLUMNS: u32 = 12;
    const START: (u32, u32) = (3, 0);
    const GOAL: (u32, u32) = (3, 11);

    fn outcome(cell: (u32, u32), action: u16) -> ((u32, u32), f32) {
        match Self::beside(cell, action) {
            (3, 1..=10) => (Self::START, FALL),
            next => (next, MOVE),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learn::tasks::grid::shortest_path;

    #[test]
    fn the_shortest_way_along_the_cliff_has_13_moves() {
        assert_eq!(shortest_path::<Cliff>(), 13);
    }

    #[test]
    fn a_fall_costs_100_and_leads_back_to_the_start() {
        let start = Cliff::state(Cliff::START);
        assert_eq!(Cliff::act(start, 1), (Some(start), -100.0));
        assert_eq!(Cliff::act(Cliff::state((2, 5)), 2), (Some(start), -100.0));
    }

    #[test]
    fn the_edge_of_the_world_holds_and_the_goal_ends() {
        let corner = Cliff::state((0, 0));
        assert_eq!(
            (Cliff::act(corner, 0), Cliff::act(corner, 3)),
            ((Some(corner), -1.0), (Some(corner), -1.0))
        );
        assert_eq!(Cliff::act(Cliff::state((2, 11)), 2), (None, -1.0));
    }
}
