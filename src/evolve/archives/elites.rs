//! The archive of MAP-Elites: a grid over two descriptors with at most one elite in each cell.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

use super::descriptor::Descriptor;
use crate::check::{Invalid, within};
use crate::score::{Evaluation, FITNESS_RANGE};

/// The best individual of a cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Elite {
    /// Its fitness.
    pub fitness: f32,
    /// The generation that found it; the first is 1.
    pub generation: u32,
    /// Its index in that generation.
    pub individual: u32,
    /// Its genes, as coordinates of the unit cube.
    pub point: Vec<f64>,
}

/// A grid of elites.
#[derive(Debug, Clone, PartialEq)]
pub struct Archive {
    /// Descriptor of the columns.
    pub x: Descriptor,
    /// Descriptor of the rows.
    pub y: Descriptor,
    /// Number of columns and of rows.
    pub cells: u32,
    /// The fitness of an agent that does not move, which counts as zero in [`Self::qd_score`].
    pub floor: f32,
    /// Elites by the number of their cell: row · cells + column.
    elites: BTreeMap<u32, Elite>,
}

/// The effect of an individual on an archive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Addition {
    /// It filled an empty cell.
    New,
    /// It replaced an elite; its fitness is higher by this amount.
    Better(f32),
    /// It did not beat the elite of its cell.
    None,
}

impl Archive {
    /// An empty archive.
    pub fn new(x: Descriptor, y: Descriptor, cells: u32, floor: f32) -> Self {
        Self { x, y, cells, floor, elites: BTreeMap::new() }
    }

    /// Restores elites from a file.
    ///
    /// # Errors
    /// A cell does not exist, or a fitness is out of range.
    pub fn restore(&mut self, elites: Vec<(u32, Elite)>) -> Result<(), Invalid> {
        for (cell, elite) in elites {
            within("cell", cell, 0..=(self.cells * self.cells).saturating_sub(1))?;
            within("fitness", elite.fitness, FITNESS_RANGE)?;
            self.elites.insert(cell, elite);
        }
        Ok(())
    }

    /// The cell of an agent; none if it was disqualified.
    pub fn cell(&self, evaluation: &Evaluation, start_y_m: f32) -> Option<u32> {
        if evaluation.disqualified.is_some() {
            return None;
        }
        let index = |descriptor: Descriptor| {
            let share = descriptor.share(descriptor.value(evaluation, start_y_m)?);
            Some(((share * f64::from(self.cells)) as u32).min(self.cells - 1))
        };
        Some(index(self.y)? * self.cells + index(self.x)?)
    }

    /// Adds an individual to its cell if it beats the elite there.
    pub fn add(&mut self, cell: u32, elite: Elite) -> Addition {
        let addition = match self.elites.get(&cell) {
            None => Addition::New,
            Some(known) if elite.fitness > known.fitness => {
                Addition::Better(elite.fitness - known.fitness)
            }
            Some(_) => return Addition::None,
        };
        self.elites.insert(cell, elite);
        addition
    }

    /// All elites with their cells, in the order of the cells.
    pub fn elites(&self) -> impl ExactSizeIterator<Item = (u32, &Elite)> {
        self.elites.iter().map(|(cell, elite)| (*cell, elite))
    }

    /// The elite of a cell.
    pub fn elite(&self, cell: u32) -> Option<&Elite> {
        self.elites.get(&cell)
    }

    /// Share of the cells that have an elite.
    pub fn coverage(&self) -> f64 {
        self.elites.len() as f64 / f64::from(self.cells * self.cells)
    }

    /// Quality and diversity in one number: the sum of the elites' fitness above [`Self::floor`] (Pugh and others,
    /// Frontiers in Robotics and AI 3 (2016)).
    pub fn qd_score(&self) -> f64 {
        self.elites.values().map(|elite| f64::from(elite.fitness - self.floor).max(0.0)).sum()
    }
}
