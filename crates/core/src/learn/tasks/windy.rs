//! The windy grid world (Sutton & Barto, "Reinforcement Learning", 2nd edition, 2018, example 6.5): a crosswind shifts every move upwards,
//! so the path to the goal leads past the goal and around it.

use super::grid::GridWorld;

/// A world with a crosswind in its middle columns. Every move costs 1.
pub struct Windy;

/// Number of rows by which the wind of each column shifts a move that starts in the column.
const WIND: [i32; 10] = [0, 0, 0, 1, 1, 1, 2, 2, 1, 0];

impl GridWorld for Windy {
    const ROWS: u32 = 7;
    const COLUMNS: u32 = 10;
    const START: (u32, u32) = (3, 0);
    const GOAL: (u32, u32) = (3, 7);

    fn outcome(cell: (u32, u32), action: u16) -> ((u32, u32), f32) {
        let wind = WIND[cell.1 as usize];
        (Self::shifted(Self::beside(cell, action), -wind, 0), -1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learn::tasks::grid::shortest_path;

    #[test]
    fn the_shortest_way_through_the_wind_has_15_moves() {
        assert_eq!(shortest_path::<Windy>(), 15);
    }

    #[test]
    fn the_wind_is_that_of_the_column_in_which_a_move_starts() {
        // Moves to the right: from a calm column into the wind, and from a strong wind into a weaker one.
        assert_eq!(Windy::outcome((3, 2), 1), ((3, 3), -1.0));
        assert_eq!(Windy::outcome((5, 7), 1), ((3, 8), -1.0));
        // A move down against a wind of two rows, and a move up at the upper edge.
        assert_eq!(Windy::outcome((3, 6), 2), ((2, 6), -1.0));
        assert_eq!(Windy::outcome((0, 6), 0), ((0, 6), -1.0));
    }

    #[test]
    fn arriving_at_the_goal_ends_and_passing_over_it_does_not() {
        assert_eq!(Windy::act(Windy::state((3, 8)), 3), (Some(Windy::state((2, 7))), -1.0));
        assert_eq!(Windy::act(Windy::state((4, 8)), 3), (None, -1.0));
    }
}
