//! A gene: its name, its unit, its range, and the position of a value in that range.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::f32::consts::TAU;
use std::fmt::{Arguments, Display};
use std::ops::RangeInclusive;

use crate::check::Invalid;

/// Values that determine the layout of a genome: the number of joints that it drives, and the length of the trial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GenomeShape {
    /// Number of joints of the snake.
    pub joints: usize,
    /// Length of the trial, in seconds.
    pub duration_s: f32,
}

/// A gene as a visitor receives it, beside its value. Its names are formatted only where they are needed.
#[derive(Debug, Clone, Copy)]
pub struct Gene<'a> {
    /// Dotted path of the gene, for messages, such as `joints[0].bend.offset`.
    pub field: Arguments<'a>,
    /// Name of the gene, for charts, such as "joint 1 bend, offset".
    pub name: Arguments<'a>,
    /// Unit of the gene, and the limits of its value in every space.
    pub quantity: Quantity,
    /// Values that the gene may have in the space.
    pub range: GeneRange<'a>,
}

/// The quantity that a gene measures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    /// Unit of the quantity; empty for a pure number.
    pub unit: &'static str,
    /// Least and greatest value in any file. The ranges of spaces lie within these limits.
    pub limits: [f32; 2],
}

impl Quantity {
    /// Creates a quantity with a unit and limits.
    pub const fn new(unit: &'static str, limits: RangeInclusive<f32>) -> Self {
        Self { unit, limits: [*limits.start(), *limits.end()] }
    }

    /// Returns the range of values in any file.
    pub(super) fn range(self) -> GeneRange<'static> {
        let [least, most] = self.limits;
        GeneRange::Between(least, most)
    }

    /// Creates a pure number with limits.
    pub const fn pure(limits: RangeInclusive<f32>) -> Self {
        Self::new("", limits)
    }
}

/// Passes the genes of a genome one by one to a function.
pub struct Genes<'a> {
    /// Text in front of the path of each visited gene.
    field: &'a dyn Display,
    /// Text in front of the name of each visited gene.
    name: &'a dyn Display,
    visit: &'a mut dyn FnMut(Gene<'_>, &mut f32),
}

impl<'a> Genes<'a> {
    /// Creates a visitor that passes each gene to a function.
    pub fn to(visit: &'a mut dyn FnMut(Gene<'_>, &mut f32)) -> Self {
        Self { field: &"", name: &"", visit }
    }

    /// Visits the genes of a part of the genome, with additional text in front of their paths and names.
    pub fn inside(
        &mut self,
        field: impl Display,
        name: impl Display,
        visit_part: impl FnOnce(&mut Genes<'_>),
    ) {
        let (before_field, before_name) = (self.field, self.name);
        visit_part(&mut Genes {
            field: &format_args!("{before_field}{field}"),
            name: &format_args!("{before_name}{name}"),
            visit: self.visit,
        });
    }

    /// Visits a gene. The order of all genes influences the bits of a run.
    pub fn gene(
        &mut self,
        field: impl Display,
        name: impl Display,
        quantity: Quantity,
        range: GeneRange<'_>,
        value: &mut f32,
    ) {
        let (before_field, before_name) = (self.field, self.name);
        let field = format_args!("{before_field}{field}");
        let name = format_args!("{before_name}{name}");
        (self.visit)(Gene { field, name, quantity, range }, value);
    }
}

/// Checks each visited gene against the range that `allowed` returns for it; `None` allows every value.
///
/// # Errors
/// Returns the first gene whose value is not allowed.
pub fn check_genes(
    allowed: impl for<'g> Fn(&Gene<'g>) -> Option<GeneRange<'g>>,
    genes: impl FnOnce(&mut Genes<'_>),
) -> Result<(), Invalid> {
    let mut result = Ok(());
    genes(&mut Genes::to(&mut |gene, value| {
        let refused = allowed(&gene).filter(|range| result.is_ok() && !range.contains(*value));
        if let Some(range) = refused {
            result = Err(Invalid::new(gene.field.to_string(), *value, range.words()));
        }
    }));
    result
}

/// Checks each visited gene against its limits in every space.
///
/// # Errors
/// Returns the first gene with a value beyond its limits.
pub fn check_limits(genes: impl FnOnce(&mut Genes<'_>)) -> Result<(), Invalid> {
    check_genes(|gene| Some(gene.quantity.range()), genes)
}

/// Counts the visited genes whose range has more than one value: those with a coordinate.
pub fn coordinate_count(genes: impl FnOnce(&mut Genes<'_>)) -> usize {
    let mut count = 0;
    genes(&mut Genes::to(&mut |gene, _| count += usize::from(!gene.range.is_point())));
    count
}

/// Widens a range so that it contains a value.
pub fn widen([least, most]: [&mut f32; 2], value: f32) {
    (*least, *most) = (least.min(value), most.max(value));
}

/// A number of a genome that people can compare: a gene, or a summary of many genes.
#[derive(Debug, Clone, PartialEq)]
pub struct Feature {
    /// Name of the feature.
    pub name: String,
    /// Unit of the feature; empty for a pure number.
    pub unit: &'static str,
    /// Value of the feature.
    pub value: f32,
    /// Position of the value in its range, from 0 to 1.
    pub share: f64,
}

impl Feature {
    pub(super) fn new(name: String, unit: &'static str, value: f32, range: GeneRange<'_>) -> Self {
        Self { name, unit, value, share: range.coordinate(value).clamp(0.0, 1.0) }
    }
}

/// The range of values that a gene may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GeneRange<'a> {
    /// Only this value, which is a setting of the space that the genome carries.
    Fixed(f32),
    /// Any value from the first to the second.
    Between(f32, f32),
    /// Any value from the first to the second, both positive. Equal ratios are equally far apart.
    Ratio(f32, f32),
    /// Any angle in radians; a full turn is equal to 0.
    Turn,
    /// Any value of this list.
    OneOf(&'a [f32]),
}

impl GeneRange<'_> {
    /// Returns the range of values up to this size on both sides of 0.
    pub fn around_zero(most: f32) -> Self {
        Self::Between(-most, most)
    }

    /// Returns whether the range has only one value, so that a search needs no coordinate for the gene.
    pub fn is_point(self) -> bool {
        match self {
            Self::Fixed(_) => true,
            Self::Between(least, most) | Self::Ratio(least, most) => least >= most,
            Self::Turn => false,
            Self::OneOf(values) => values.iter().all(|value| Some(value) == values.first()),
        }
    }

    /// Returns the value at a coordinate. Outside 0 to 1, the coordinate of a turn repeats, and the coordinate of any other range is
    /// reflected at its ends. Every coordinate therefore has a value, and a small step remains a small step.
    pub fn at(self, coordinate: f64) -> f32 {
        let wrapped = self.wrapped(coordinate);
        match self {
            Self::Fixed(value) => value,
            Self::Between(least, most) => {
                let share = wrapped as f32;
                (least + (most - least) * share).clamp(least, most)
            }
            Self::Ratio(least, most) => {
                let ratio = f64::from(most) / f64::from(least);
                ((f64::from(least) * libm::pow(ratio, wrapped)) as f32).clamp(least, most)
            }
            Self::Turn => TAU * wrapped as f32,
            Self::OneOf(values) => {
                let index = (wrapped * values.len() as f64) as usize;
                values.get(index).or(values.last()).copied().unwrap_or(0.0)
            }
        }
    }

    /// Returns the coordinate from 0 to 1 that has the same value as any coordinate.
    pub fn wrapped(self, coordinate: f64) -> f64 {
        if !coordinate.is_finite() {
            return 0.0;
        }
        if self == Self::Turn {
            return coordinate - libm::floor(coordinate);
        }
        let wrapped = coordinate - 2.0 * libm::floor(coordinate / 2.0);
        if wrapped > 1.0 { 2.0 - wrapped } else { wrapped }
    }

    /// Returns a coordinate of a value, from which [`Self::at`] returns the value, except for rounding.
    pub fn coordinate(self, value: f32) -> f64 {
        match self {
            Self::Fixed(_) => 0.0,
            Self::Between(least, most) => f64::from((value - least) / (most - least)),
            Self::Ratio(least, most) => {
                let log = |value: f32| libm::log(f64::from(value));
                (log(value) - log(least)) / (log(most) - log(least))
            }
            Self::Turn => f64::from(value / TAU),
            Self::OneOf(values) => {
                let index = values.iter().position(|known| *known == value).unwrap_or(0);
                (index as f64 + 0.5) / values.len() as f64
            }
        }
    }

    /// Returns a coordinate at which [`Self::at`] returns the value to the last bit, if there is one, otherwise one nearby.
    pub fn exact_coordinate(self, value: f32) -> f64 {
        let near = self.coordinate(value);
        let Self::Between(..) = self else { return near };
        // The value depends only on the coordinate rounded to a 32-bit float.
        let (mut below, mut above) = (near as f32, near as f32);
        for _ in 0..4 {
            for candidate in [below, above] {
                if (0.0..=1.0).contains(&candidate) && self.at(candidate.into()) == value {
                    return candidate.into();
                }
            }
            (below, above) = (below.next_down(), above.next_up());
        }
        near
    }

    /// Returns the value at a coordinate, computed in 64 bits and rounded once. [`Self::at`] only uses coordinates rounded to 32 bits, so
    /// it leaves out most values of a range.
    pub fn fine_at(self, coordinate: f64) -> f32 {
        let wrapped = self.wrapped(coordinate);
        match self {
            Self::Between(least, most) => {
                let (low, high) = (f64::from(least), f64::from(most));
                ((low + wrapped * (high - low)) as f32).clamp(least, most)
            }
            Self::Turn => (wrapped * f64::from(TAU)) as f32,
            Self::Fixed(_) | Self::Ratio(..) | Self::OneOf(_) => self.at(coordinate),
        }
    }

    /// Returns a coordinate at which [`Self::fine_at`] returns the value to the last bit. For an angle beyond a full turn there is none.
    /// Nor is there one for a value so close to 0, within a range on both sides of 0, that even 64 bits cannot tell it from its
    /// neighbours. For these it returns a coordinate nearby.
    pub fn fine_coordinate(self, value: f32) -> f64 {
        let near = match self {
            Self::Between(least, most) => {
                let (low, high) = (f64::from(least), f64::from(most));
                (f64::from(value) - low) / (high - low)
            }
            Self::Turn => f64::from(value) / f64::from(TAU),
            Self::Ratio(..) => self.coordinate(value),
            Self::Fixed(_) | Self::OneOf(_) => return self.coordinate(value),
        };
        let (mut below, mut above) = (near, near);
        for _ in 0..4 {
            for candidate in [below, above] {
                if (0.0..=1.0).contains(&candidate) && self.fine_at(candidate) == value {
                    return candidate;
                }
            }
            (below, above) = (below.next_down(), above.next_up());
        }
        near
    }

    /// Returns whether a gene with this range may have this value.
    pub fn contains(self, value: f32) -> bool {
        match self {
            Self::Fixed(only) => value == only,
            Self::Between(least, most) | Self::Ratio(least, most) => {
                (least..=most).contains(&value)
            }
            Self::Turn => value.is_finite(),
            Self::OneOf(values) => values.contains(&value),
        }
    }

    /// Describes the allowed values in words.
    pub fn words(self) -> String {
        match self {
            Self::Fixed(only) => only.to_string(),
            Self::Between(least, most) | Self::Ratio(least, most) if least == most => {
                least.to_string()
            }
            Self::Between(least, most) | Self::Ratio(least, most) => format!("{least} to {most}"),
            Self::Turn => "an angle".to_owned(),
            Self::OneOf(values) => {
                values.iter().fold("one of".to_owned(), |text, value| format!("{text} {value}"))
            }
        }
    }

    /// Draws a value at random. All coordinates are equally likely.
    pub fn random(self, rng: &mut ChaCha8Rng) -> f32 {
        match self {
            Self::Fixed(value) => value,
            _ => self.at(rng.random_range(0.0..1.0)),
        }
    }

    /// Shifts a value at random by at most `share` of the range. A choice from a list stays as it is.
    pub fn shift(self, value: f32, share: f32, rng: &mut ChaCha8Rng) -> f32 {
        match self {
            Self::Between(least, most) => {
                let (middle, half) = ((least + most) / 2.0, (most - least) / 2.0);
                let shifted = middle + shifted(value - middle, share * half, half, rng);
                // Rounding could move the value out of the range.
                shifted.clamp(least, most)
            }
            Self::Ratio(..) | Self::Turn => {
                let by = rng.random_range(-share / 2.0..=share / 2.0);
                let moved = self.coordinate(value) + f64::from(by);
                self.at(if self == Self::Turn { moved } else { moved.clamp(0.0, 1.0) })
            }
            Self::Fixed(_) | Self::OneOf(_) => value,
        }
    }
}

/// Shifts a value at random within ±`by` and clamps it to ±`range`.
pub fn shifted(value: f32, by: f32, range: f32, rng: &mut ChaCha8Rng) -> f32 {
    (value + rng.random_range(-by..=by)).clamp(-range, range)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_reflect_beyond_their_ends_and_turns_repeat() {
        let range = GeneRange::Between(2.0, 4.0);
        for (coordinate, value) in
            [(0.25, 2.5), (-0.25, 2.5), (1.25, 3.5), (2.25, 2.5), (-1.0, 4.0)]
        {
            assert_eq!(range.at(coordinate), value, "at {coordinate}");
        }
        assert_eq!(range.at(f64::INFINITY), 2.0);
        assert!((GeneRange::Turn.at(1.25) - GeneRange::Turn.at(0.25)).abs() < 1e-6);
        assert!((GeneRange::Turn.at(-0.75) - GeneRange::Turn.at(0.25)).abs() < 1e-6);
        let list = GeneRange::OneOf(&[1.0, 2.0, 3.0]);
        for (coordinate, value) in [(0.1, 1.0), (0.5, 2.0), (1.0, 3.0), (1.2, 3.0), (-0.4, 2.0)] {
            assert_eq!(list.at(coordinate), value, "at {coordinate}");
        }
    }

    #[test]
    fn in_a_range_of_ratios_half_way_is_the_geometric_mean() {
        let range = GeneRange::Ratio(0.5, 8.0);
        for (coordinate, value) in [(0.0, 0.5), (0.5, 2.0), (0.75, 4.0), (1.0, 8.0), (-0.5, 2.0)] {
            assert!((range.at(coordinate) - value).abs() < 1e-6, "at {coordinate}");
        }
        assert!((range.coordinate(4.0) - 0.75).abs() < 1e-7);
        let mut value = 0.5_f32;
        while value < 8.0 {
            assert_eq!(range.fine_at(range.fine_coordinate(value)), value);
            value = value.next_up() * 1.001;
        }
        assert!(GeneRange::Ratio(2.0, 2.0).is_point() && !range.contains(8.1));
    }

    #[test]
    fn fine_coordinates_reach_every_value() {
        let torque = GeneRange::Between(-1000.0, 1000.0);
        let mut value = 312.5_f32;
        let mut left_out = 0;
        for _ in 0..2000 {
            for value in [value, -value] {
                assert_eq!(torque.fine_at(torque.fine_coordinate(value)), value);
                left_out += u32::from(torque.at(torque.exact_coordinate(value)) != value);
            }
            value = value.next_up();
        }
        assert!(left_out > 1000, "coordinates of 32 bits reach all but {left_out} of 4000 values");
        for value in [-1000.0, 1000.0, 0.0, 1e-5, -1e-5, 999.99994] {
            assert_eq!(torque.fine_at(torque.fine_coordinate(value)), value);
        }
        for value in [0.0, 1e-30, 1.0, std::f32::consts::PI, TAU] {
            assert_eq!(GeneRange::Turn.fine_at(GeneRange::Turn.fine_coordinate(value)), value);
        }
        let stiffness = GeneRange::Between(50.0, 1000.0);
        for (coordinate, value) in [(-0.5, 525.0), (1.5, 525.0), (2.0, 50.0), (f64::NAN, 50.0)] {
            assert_eq!(stiffness.fine_at(coordinate), value, "reflected at {coordinate}");
        }
        let list = GeneRange::OneOf(&[1.0, 2.0, 3.0]);
        assert_eq!(list.fine_at(list.fine_coordinate(2.0)), 2.0);
    }
}
