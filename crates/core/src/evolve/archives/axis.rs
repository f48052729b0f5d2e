//! Axes of archives, and their division into cells.

use super::descriptor::Descriptor;
use crate::schema::Choices;

/// How the values of an axis are divided into cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AxisScale {
    /// The cells have equal width.
    Linear,
    /// The cells have an equal ratio between their ends.
    Logarithmic,
    /// Each whole number has a cell.
    Whole,
}

/// An axis of an archive: a number that distinguishes kinds of snakes, divided into cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArchiveAxis {
    /// Label of the axis, with the unit.
    pub label: &'static str,
    /// Values at the two ends of the axis. Values beyond the ends belong to the outermost cells.
    pub range: [f64; 2],
    /// How the range is divided into cells.
    pub scale: AxisScale,
    /// Number of cells into which the axis is divided.
    pub cells: u32,
}

impl ArchiveAxis {
    /// Makes the axis of a descriptor.
    pub fn of(descriptor: Descriptor, cells: u32) -> Self {
        let (scale, range) = descriptor.scale();
        Self { label: descriptor.choice().title, range, scale, cells }
    }

    /// Makes the axis of a whole number, with a cell for each number.
    pub fn of_numbers(label: &'static str, numbers: std::ops::RangeInclusive<u32>) -> Self {
        let range = [f64::from(*numbers.start()), f64::from(*numbers.end())];
        let cells = numbers.end().saturating_sub(*numbers.start()) + 1;
        Self { label, range, scale: AxisScale::Whole, cells }
    }

    /// Returns the index of the cell that contains a value, from 0.
    pub fn place(&self, value: f64) -> u32 {
        ((self.share(value) * f64::from(self.cells)) as u32).min(self.cells - 1)
    }

    /// Returns the values at the two ends of a cell; for a whole number, the number twice.
    pub fn ends(&self, place: u32) -> [f64; 2] {
        if self.scale == AxisScale::Whole {
            return [self.range[0] + f64::from(place); 2];
        }
        [place, place + 1].map(|end| self.at_share(f64::from(end) / f64::from(self.cells)))
    }

    /// Returns the edges of a cell in a drawing. The cell of a whole number extends by 0.5 to either side.
    pub fn edges(&self, place: u32) -> [f64; 2] {
        let [from, to] = self.ends(place);
        if self.scale == AxisScale::Whole { [from - 0.5, to + 0.5] } else { [from, to] }
    }

    /// Returns the position of a value along the axis: 0 at the beginning, 1 at the end and beyond.
    pub(super) fn share(&self, value: f64) -> f64 {
        let [least, most] = self.range;
        let share = match self.scale {
            AxisScale::Linear => (value - least) / (most - least),
            AxisScale::Whole => (value - least) / (most - least + 1.0),
            AxisScale::Logarithmic => {
                let log = |x: f64| libm::log(x.clamp(least, most));
                (log(value) - log(least)) / (log(most) - log(least))
            }
        };
        share.clamp(0.0, 1.0)
    }

    /// Returns the value at a position from 0 to 1 along the axis.
    fn at_share(&self, share: f64) -> f64 {
        let [least, most] = self.range;
        if self.scale == AxisScale::Logarithmic {
            least * libm::pow(most / least, share)
        } else {
            least + (most - least) * share
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_whole_number_has_its_own_cell() {
        let axis = ArchiveAxis::of_numbers("Blocks", 2..=12);
        assert_eq!(axis.cells, 11);
        for number in 2..=12 {
            assert_eq!(axis.place(f64::from(number)), number - 2);
            assert_eq!(axis.ends(number - 2), [f64::from(number); 2]);
        }
        assert_eq!((axis.place(0.0), axis.place(40.0)), (0, 10));
        assert_eq!(axis.edges(3), [4.5, 5.5]);
    }

    #[test]
    fn the_middle_of_a_cell_lies_in_it() {
        for descriptor in [Descriptor::ContactDuty, Descriptor::EnergyPerMetre] {
            let axis = ArchiveAxis::of(descriptor, 7);
            for place in 0..7 {
                let [from, to] = axis.ends(place);
                assert_eq!(axis.place((from + to) / 2.0), place, "{}", axis.label);
            }
        }
    }
}
