//! Common properties of all grid worlds of the tests: cells as states, and four moves as actions.

/// Moves in the order of their numbers: up, right, down, left, as (rows, columns).
const MOVES: [(i32, i32); 4] = [(-1, 0), (0, 1), (1, 0), (0, -1)];

/// A rectangular world. The state is the number of the cell, counted row by row from the upper left.
pub trait GridWorld {
    /// Number of rows.
    const ROWS: u32;
    /// Number of columns.
    const COLUMNS: u32;
    /// Number of cells, which are the states.
    const STATES: u32 = Self::ROWS * Self::COLUMNS;
    /// Number of actions.
    const ACTIONS: u16 = 4;
    /// Row and column at which an episode starts.
    const START: (u32, u32);
    /// Row and column at which an episode ends.
    const GOAL: (u32, u32);

    /// Returns the row and column after a move from a cell, and the reward.
    fn outcome(cell: (u32, u32), action: u16) -> ((u32, u32), f32);

    /// Returns the state of a cell.
    fn state((row, column): (u32, u32)) -> u32 {
        row * Self::COLUMNS + column
    }

    /// Returns the state after an action, `None` for the goal, and the reward.
    fn act(state: u32, action: u16) -> (Option<u32>, f32) {
        let (cell, reward) = Self::outcome((state / Self::COLUMNS, state % Self::COLUMNS), action);
        ((cell != Self::GOAL).then(|| Self::state(cell)), reward)
    }

    /// Returns the cell next to a cell in the direction of the action; at the edge of the world, the cell itself.
    fn beside(cell: (u32, u32), action: u16) -> (u32, u32) {
        let (rows, columns) = MOVES[usize::from(action)];
        Self::shifted(cell, rows, columns)
    }

    /// Returns the cell this many rows and columns away, clamped to the world.
    fn shifted((row, column): (u32, u32), rows: i32, columns: i32) -> (u32, u32) {
        let row = row.saturating_add_signed(rows).min(Self::ROWS - 1);
        (row, column.saturating_add_signed(columns).min(Self::COLUMNS - 1))
    }
}

/// Computes the least number of actions from start to goal, by breadth-first search.
pub fn shortest_path<W: GridWorld>() -> u32 {
    let mut distance = vec![None; W::STATES as usize];
    let mut queue = vec![W::state(W::START)];
    distance[W::state(W::START) as usize] = Some(0);
    let mut first = 0;
    while let Some(&state) = queue.get(first) {
        first += 1;
        let steps = distance[state as usize].unwrap_or(0) + 1;
        for action in 0..W::ACTIONS {
            let Some(next) = W::act(state, action).0 else { return steps };
            if distance[next as usize].is_none() {
                distance[next as usize] = Some(steps);
                queue.push(next);
            }
        }
    }
    panic!("the goal cannot be reached");
}
