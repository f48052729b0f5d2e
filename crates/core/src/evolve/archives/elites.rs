//! The archive of MAP-Elites: a grid over two axes with at most one elite in each cell.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

use super::axis::ArchiveAxis;
use crate::check::{Invalid, within};
use crate::evolve::parents::IndividualId;
use crate::genome::{Genome, GenomeShape, GenomeSpace};
use crate::score::FITNESS_RANGE;

/// Genes of an elite, in the form in which a strategy keeps them.
#[derive(Debug, Clone, PartialEq)]
pub enum EliteGenes {
    /// Coordinates of the unit cube, from which the genome is made.
    Point(Vec<f64>),
    /// The genome itself.
    Genome(Box<Genome>),
}

impl EliteGenes {
    /// Returns the genome, in the space of its run.
    pub fn genome(&self, space: &GenomeSpace, shape: GenomeShape) -> Genome {
        match self {
            Self::Point(point) => space.genome_at(point, shape),
            Self::Genome(genome) => Genome::clone(genome),
        }
    }
}

/// The best individual of a cell, with its genes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Elite<G = EliteGenes> {
    /// Fitness of the elite.
    pub fitness: f32,
    /// Generation that found the elite; the first is 1.
    pub generation: u32,
    /// Index of the elite in its generation.
    pub individual: u32,
    /// Genes of the elite: coordinates of the unit cube, or a genome. The first version of the file format had coordinates only.
    #[serde(rename = "point", alias = "genes")]
    pub genes: G,
}

impl<G> Elite<G> {
    /// Returns the generation and index of the elite.
    pub fn id(&self) -> IndividualId {
        IndividualId { generation: self.generation, individual: self.individual }
    }
}

/// A grid of elites whose genes have the type `G`.
#[derive(Debug, Clone, PartialEq)]
pub struct Archive<G = EliteGenes> {
    /// Axis of the columns.
    pub x: ArchiveAxis,
    /// Axis of the rows.
    pub y: ArchiveAxis,
    /// Fitness of an agent that does not move, which counts as zero in [`Self::qd_score`].
    pub floor: f32,
    /// Elites by the number of their cell, which is row · columns + column.
    elites: BTreeMap<u32, Elite<G>>,
}

/// Effect of adding an individual to an archive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Addition {
    /// The individual filled an empty cell.
    New,
    /// The individual replaced an elite; its fitness is higher by this amount.
    Better(f32),
    /// The individual was not added, because it did not beat the elite of its cell.
    None,
}

impl<G> Archive<G> {
    /// Makes an empty archive.
    pub fn new(x: ArchiveAxis, y: ArchiveAxis, floor: f32) -> Self {
        Self { x, y, floor, elites: BTreeMap::new() }
    }

    /// Adds elites from a file, with their cells.
    ///
    /// # Errors
    /// Fails if a cell does not exist, or a fitness is out of range.
    pub fn restore(&mut self, elites: Vec<(u32, Elite<G>)>) -> Result<(), Invalid> {
        for (cell, elite) in elites {
            within("cell", cell, 0..=self.cells().saturating_sub(1))?;
            within("fitness", elite.fitness, FITNESS_RANGE)?;
            self.elites.insert(cell, elite);
        }
        Ok(())
    }

    /// Returns the number of cells.
    pub fn cells(&self) -> u32 {
        self.x.cells * self.y.cells
    }

    /// Returns the cell that contains the values of the two axes.
    pub fn cell(&self, [x, y]: [f64; 2]) -> u32 {
        self.y.place(y) * self.x.cells + self.x.place(x)
    }

    /// Returns the column and the row of a cell.
    pub fn place(&self, cell: u32) -> [u32; 2] {
        [cell % self.x.cells, cell / self.x.cells]
    }

    /// Returns a copy in which `genes` has converted the genes of each elite.
    pub fn copy_with(&self, genes: impl Fn(&G) -> EliteGenes) -> Archive {
        let copy = |(cell, elite): (&u32, &Elite<G>)| {
            let &Elite { fitness, generation, individual, genes: ref own } = elite;
            (*cell, Elite { fitness, generation, individual, genes: genes(own) })
        };
        let elites = self.elites.iter().map(copy).collect();
        Archive { x: self.x, y: self.y, floor: self.floor, elites }
    }

    /// Adds an individual to its cell if it beats the elite there.
    pub fn add(&mut self, cell: u32, elite: Elite<G>) -> Addition {
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

    /// Returns all elites with their cells, in ascending order of the cells.
    pub fn elites(&self) -> impl ExactSizeIterator<Item = (u32, &Elite<G>)> {
        self.elites.iter().map(|(cell, elite)| (*cell, elite))
    }

    /// Returns the elite of a cell. None if the cell is empty.
    pub fn elite(&self, cell: u32) -> Option<&Elite<G>> {
        self.elites.get(&cell)
    }

    /// Returns the share of the cells that have an elite.
    pub fn coverage(&self) -> f64 {
        self.elites.len() as f64 / f64::from(self.cells())
    }

    /// Returns quality and diversity in one number: the sum of the elites' fitness above [`Self::floor`] (Pugh and others, Frontiers in
    /// Robotics and AI 3 (2016)).
    pub fn qd_score(&self) -> f64 {
        self.elites.values().map(|elite| f64::from(elite.fitness - self.floor).max(0.0)).sum()
    }
}
