//! The archive of bodies, with the number of blocks along x and the length of the body along y.

use super::axis::{ArchiveAxis, AxisScale};
use super::elites::Archive;
use crate::genome::{BodySpace, Genome};

/// Least length on the axis of lengths, in metres. Shorter bodies, which are rare, lie in the first row.
const SHORTEST_M: f64 = 4.0;

/// Makes an empty archive of bodies with `length_cells` rows. `floor` is the fitness of an agent that does not move.
pub fn body_archive<G>(bodies: &BodySpace, length_cells: u32, floor: f32) -> Archive<G> {
    let longest_m = f64::from(bodies.longest_m);
    let y = ArchiveAxis {
        label: "Length (m)",
        range: [SHORTEST_M.min(longest_m / 2.0), longest_m],
        scale: AxisScale::Linear,
        cells: length_cells,
    };
    Archive::new(ArchiveAxis::of_numbers("Blocks", bodies.limbs()), y, floor)
}

/// Returns the cell of a genome's body.
pub fn body_cell<G>(archive: &Archive<G>, genome: &Genome) -> u32 {
    archive.cell([genome.body.segments.len() as f64, genome.body.chain_length_m()])
}

/// Counts the cells in which a body of the space can lie.
pub fn feasible_cells<G>(archive: &Archive<G>, bodies: &BodySpace) -> usize {
    let last = archive.y.cells - 1;
    let is_feasible = |cell: &u32| {
        let [column, row] = archive.place(*cell);
        let Some([shortest_m, longest_m]) = bodies.lengths_m(bodies.limbs_min + column) else {
            return false;
        };
        let [from_m, to_m] = archive.y.ends(row);
        // The outermost cells also contain the lengths beyond the ends of the axis.
        let from_m = if row == 0 { 0.0 } else { from_m };
        let to_m = if row == last { f64::INFINITY } else { to_m };
        shortest_m < to_m && longest_m >= from_m
    };
    (0..archive.cells()).filter(is_feasible).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two blocks of at most 4 m reach 8 m of 12, which is in the row from 8 m. Twelve blocks of at least 0.4 m begin at 4.8 m, beyond the
    /// first row.
    #[test]
    fn cells_that_no_body_fits_are_not_feasible() {
        let bodies = BodySpace::default();
        let archive: Archive<()> = body_archive(&bodies, 16, 0.0);
        assert_eq!(archive.cells(), 11 * 16);
        assert_eq!(feasible_cells(&archive, &bodies), 11 * 16 - 7 - 1);
        let narrow = BodySpace { limbs_max: 2, ..bodies };
        let archive: Archive<()> = body_archive(&narrow, 4, 0.0);
        assert_eq!(feasible_cells(&archive, &narrow), 3);
    }
}
