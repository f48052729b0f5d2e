//! Grid worlds of the "woods" family: an animat among obstacles sees its eight neighbour cells and looks for food.
//!
//! Woods1 is from Wilson, "ZCS: a zeroth level classifier system" (1994), Woods2 from Wilson, "Classifier fitness based on accuracy"
//! (1995), and Maze4 from Lanzi's studies of XCS (1997, 1999). Actions 0 to 7 go north, northeast and so on clockwise. A move against an
//! obstacle changes nothing but counts as a step. Worlds without a wall around them are tori.

use rand::Rng;
use rand::RngExt;

/// Number of steps after which an episode ends.
pub const MOST_STEPS: u32 = 50;
/// Reward of food.
pub const FOOD: f32 = 1000.0;
/// Number of actions: one per neighbouring cell.
pub const DIRECTIONS: usize = 8;

const WOODS1: [&str; 5] = [".....", ".OOF.", ".OOO.", ".OOO.", "....."];

/// Woods2 has two kinds of food, F and G, and two kinds of rock, O and Q, which behave alike.
const WOODS2: [&str; 15] = [
    "..............................",
    ".QQF..QQF..OQF..QQG..OQG..OQF.",
    ".OOO..QOO..OQO..OOQ..QQO..QQQ.",
    ".OOQ..OQQ..OQQ..QQO..OOO..QQO.",
    "..............................",
    "..............................",
    ".QOF..QOG..QOF..OOF..OOG..QOG.",
    ".QQO..QOO..OOO..OQO..QQO..QOO.",
    ".QQQ..OOO..OQO..QOQ..QOQ..OQO.",
    "..............................",
    "..............................",
    ".QOG..QOF..OOG..OQF..OOG..OOF.",
    ".OOQ..OQQ..QQO..OQQ..QQO..OQQ.",
    ".QQO..OOO..OQO..OOQ..OQQ..QQQ.",
    "..............................",
];

const MAZE4: [&str; 8] = [
    "OOOOOOOO", "O..O..FO", "OO..O..O", "OO.O..OO", "O......O", "OO.O...O", "O....O.O", "OOOOOOOO",
];

/// A grid world of cells that are free, food or rock.
#[derive(Debug, Clone)]
pub struct Woods {
    width: usize,
    cells: Vec<u8>,
    /// Number of bits by which a neighbouring cell is described.
    cell_bits: usize,
}

impl Woods {
    /// Returns the 5 by 5 torus with one food and eight rocks.
    pub fn woods1() -> Self {
        Self::new(&WOODS1, 2)
    }

    /// Returns the 30 by 15 torus with two kinds of food and of rocks.
    pub fn woods2() -> Self {
        Self::new(&WOODS2, 3)
    }

    /// Returns Lanzi's maze of 26 free cells.
    pub fn maze4() -> Self {
        Self::new(&MAZE4, 2)
    }

    fn new(rows: &[&str], cell_bits: usize) -> Self {
        Self { width: rows[0].len(), cells: rows.concat().into_bytes(), cell_bits }
    }

    /// Returns the number of bits of a situation.
    pub fn bits(&self) -> usize {
        DIRECTIONS * self.cell_bits
    }

    /// Returns the cells in which an episode may start.
    pub fn free_cells(&self) -> Vec<usize> {
        (0..self.cells.len()).filter(|&cell| self.cells[cell] == b'.').collect()
    }

    /// Draws a random free cell.
    pub fn draw(&self, rng: &mut impl Rng) -> usize {
        let free = self.free_cells();
        free[rng.random_range(0..free.len())]
    }

    /// Returns the situation in a cell: its neighbours clockwise from the north, each with its bits. The first bit of a neighbour is set
    /// for food, the second if the neighbour is not empty. The third, where there is one, tells the kind.
    pub fn situation(&self, cell: usize) -> u32 {
        let code = |neighbour: usize| match self.cells[neighbour] {
            b'.' => 0b000,
            b'O' => 0b010,
            b'Q' => 0b110,
            b'F' => 0b011,
            _ => 0b111,
        };
        (0..DIRECTIONS).fold(0, |bits, direction| {
            bits | code(self.neighbour(cell, direction)) << (direction * self.cell_bits)
        })
    }

    /// Returns the cell after an action, and whether food is there.
    pub fn after(&self, cell: usize, action: usize) -> (usize, bool) {
        let next = self.neighbour(cell, action);
        match self.cells[next] {
            b'.' => (next, false),
            b'O' | b'Q' => (cell, false),
            _ => (next, true),
        }
    }

    fn neighbour(&self, cell: usize, direction: usize) -> usize {
        let (width, height) = (self.width, self.cells.len() / self.width);
        let right = [0, 1, 1, 1, 0, width - 1, width - 1, width - 1][direction];
        let down = [height - 1, height - 1, 0, 1, 1, 1, 0, height - 1][direction];
        (cell / width + down) % height * width + (cell % width + right) % width
    }

    /// Returns the sum of the shortest distances to food from all free cells, and the number of these cells, by breadth-first search.
    pub fn optimum(&self) -> (u32, u32) {
        let mut distances: Vec<Option<u32>> =
            self.cells.iter().map(|cell| b"FG".contains(cell).then_some(0)).collect();
        for distance in 0.. {
            let free = self.free_cells().into_iter().filter(|&cell| distances[cell].is_none());
            let found: Vec<usize> = free
                .filter(|&cell| {
                    (0..DIRECTIONS).any(|d| distances[self.neighbour(cell, d)] == Some(distance))
                })
                .collect();
            if found.is_empty() {
                break;
            }
            found.iter().for_each(|&cell| distances[cell] = Some(distance + 1));
        }
        let free = self.free_cells();
        (free.iter().filter_map(|&cell| distances[cell]).sum(), free.len() as u32)
    }

    /// Returns the mean number of steps to food from every free cell with a fixed policy, each at most [`MOST_STEPS`].
    pub fn mean_steps(&self, act: impl Fn(u32) -> usize) -> f64 {
        let steps = |start: usize| {
            let mut cell = start;
            for step in 1..=MOST_STEPS {
                let (next, is_food) = self.after(cell, act(self.situation(cell)));
                if is_food {
                    return step;
                }
                cell = next;
            }
            MOST_STEPS
        };
        let free = self.free_cells();
        f64::from(free.iter().map(|&cell| steps(cell)).sum::<u32>()) / free.len() as f64
    }
}

#[test]
fn optima_are_the_published_ones() {
    assert_eq!(Woods::woods1().optimum(), (27, 16));
    let (sum, cells) = Woods::woods2().optimum();
    assert_eq!(f64::from(sum) / f64::from(cells), 1.6875);
    assert_eq!(Woods::maze4().optimum(), (91, 26));
}

#[test]
fn bumps_stay_food_ends_and_a_torus_has_no_edge() {
    let woods = Woods::woods1();
    assert_eq!(woods.after(0, 0), (20, false), "north of the first row is the last");
    assert_eq!(woods.after(0, 3), (0, false), "a rock in the southeast");
    assert_eq!(woods.after(4, 5), (8, true), "food in the southwest");
    assert_eq!(woods.after(4, 2), (0, false));
    assert_eq!(woods.situation(4) >> 10 & 0b11, 0b11);
    assert_eq!(woods.situation(4).count_ones(), 3 - 1);
}
