//! The Dyna maze (Sutton & Barto, "Reinforcement Learning", 2nd edition, 2018, example 8.1): the only reward is at the goal, behind walls.

use super::grid::GridWorld;

/// A maze with three walls. A move into a wall leads nowhere; reaching the goal has the reward 1.
pub struct DynaMaze;

/// Rows and columns of the cells that are walls.
const WALLS: [(u32, u32); 7] = [(1, 2), (2, 2), (3, 2), (4, 5), (0, 7), (1, 7), (2, 7)];

impl GridWorld for DynaMaze {
    const ROWS: u32 = 6;
    const COLUMNS: u32 = 9;
    const START: (u32, u32) = (2, 0);
    const GOAL: (u32, u32) = (0, 8);

    fn outcome(cell: (u32, u32), action: u16) -> ((u32, u32), f32) {
        let next = Self::beside(cell, action);
        let next = if WALLS.contains(&next) { cell } else { next };
        (next, if next == Self::GOAL { 1.0 } else { 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learn::tasks::grid::shortest_path;

    #[test]
    fn the_shortest_way_through_the_maze_has_14_moves() {
        assert_eq!(shortest_path::<DynaMaze>(), 14);
    }

    #[test]
    fn a_wall_holds_a_move_and_the_goal_rewards_it() {
        assert_eq!(DynaMaze::outcome((2, 1), 1), ((2, 1), 0.0));
        assert_eq!(DynaMaze::outcome((2, 0), 3), ((2, 0), 0.0));
        assert_eq!(DynaMaze::act(DynaMaze::state((1, 8)), 0), (None, 1.0));
    }
}
