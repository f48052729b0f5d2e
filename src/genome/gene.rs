//! A genome as a row of genes, each with its range: what lets any strategy search in any space.

mod features;

pub use features::Feature;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::f32::consts::TAU;

use super::signal::shifted;
use super::wave::{Wave, Waves};
use super::{Controller, ControllerKind, Gait, Genome, GenomeSpace, JointSignals, Signals};

/// What values a gene may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Range<'a> {
    /// Any from one end to the other.
    Between(f32, f32),
    /// An angle, where a full turn is the same as none, in radians.
    Turn,
    /// One of a list.
    OneOf(&'a [f32]),
}

/// For whom genomes are: the number of joints, and how long they have to last.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Descent {
    /// Joints of the snake.
    pub joints: usize,
    /// Length of the trial, in seconds.
    pub duration_s: f32,
}

impl Range<'_> {
    /// Whether there is nothing to choose.
    pub(super) fn is_point(self) -> bool {
        match self {
            Self::Between(least, most) => least >= most,
            Self::Turn => false,
            Self::OneOf(values) => values.iter().all(|value| Some(value) == values.first()),
        }
    }

    /// The value at a coordinate. A turn goes on where it ends; what lies beyond the ends of another range is
    /// reflected, so that every coordinate means something and a small step is a small step.
    pub(super) fn at(self, coordinate: f64) -> f32 {
        let folded = self.folded(coordinate);
        match self {
            Self::Between(least, most) => {
                let share = folded as f32;
                (least + (most - least) * share).clamp(least, most)
            }
            Self::Turn => TAU * folded as f32,
            Self::OneOf(values) => {
                let index = (folded * values.len() as f64) as usize;
                values.get(index).or(values.last()).copied().unwrap_or(0.0)
            }
        }
    }

    /// The coordinate from 0 to 1 that means the same.
    fn folded(self, coordinate: f64) -> f64 {
        if !coordinate.is_finite() {
            return 0.0;
        }
        if self == Self::Turn {
            return coordinate - libm::floor(coordinate);
        }
        let folded = coordinate - 2.0 * libm::floor(coordinate / 2.0);
        if folded > 1.0 { 2.0 - folded } else { folded }
    }

    /// A coordinate of a value: [`Self::at`] gives that value again, but for rounding.
    pub(super) fn coordinate(self, value: f32) -> f64 {
        match self {
            Self::Between(least, most) => f64::from((value - least) / (most - least)),
            Self::Turn => f64::from(value / TAU),
            Self::OneOf(values) => {
                let index = values.iter().position(|known| *known == value).unwrap_or(0);
                (index as f64 + 0.5) / values.len() as f64
            }
        }
    }
}

impl GenomeSpace {
    /// Shows every gene of a genome and its range to `visit`, in a fixed order.
    pub(super) fn visit(&self, genome: &mut Genome, mut visit: impl FnMut(&mut f32, Range<'_>)) {
        let waves_in = |waves: &mut Waves,
                        amplitude: f32,
                        visit: &mut dyn FnMut(&mut f32, Range<'_>)| {
            let wave = &self.wave;
            let frequencies = Range::Between(wave.frequency_min_hz, wave.frequency_max_hz);
            visit(&mut waves.frequency_hz, frequencies);
            let mut wave_in = |wave: &mut Wave, amplitude: f32| {
                visit(&mut wave.offset, Range::Between(-amplitude, amplitude));
                for (index, harmonic) in wave.harmonics.iter_mut().enumerate() {
                    // A term of k times the frequency has k times the rates.
                    let most = amplitude / (index + 1) as f32;
                    visit(&mut harmonic.amplitude, Range::Between(0.0, most));
                    let phases = if most > 0.0 { Range::Turn } else { Range::Between(0.0, 0.0) };
                    visit(&mut harmonic.phase_rad, phases);
                }
            };
            // What turns no joint is nothing to search for.
            let moves = |limits: &[f32]| limits.iter().any(|limit| *limit > 0.0);
            let bend = if moves(&self.bend_limits_rad) { amplitude } else { 0.0 };
            let twist = if moves(&self.twist_limits_rad) { amplitude } else { 0.0 };
            for joint in &mut waves.joints {
                wave_in(&mut joint.bend, bend);
                wave_in(&mut joint.twist, twist);
            }
        };
        visit(&mut genome.bend_limit_rad, Range::OneOf(&self.bend_limits_rad));
        visit(&mut genome.twist_limit_rad, Range::OneOf(&self.twist_limits_rad));
        let densities = Range::Between(self.density_min_kg_m3, self.density_max_kg_m3);
        visit(&mut genome.density_kg_m3, densities);
        match &mut genome.controller {
            Controller::Signal(signals) => {
                let torques = Range::Between(-self.torque_range_nm, self.torque_range_nm);
                signals.all_mut().flatten().for_each(|torque_nm| visit(torque_nm, torques));
            }
            Controller::Wave(waves) => waves_in(waves, self.torque_range_nm, &mut visit),
            Controller::Gait(gait) => {
                let wave = &self.wave;
                let stiffnesses =
                    Range::Between(wave.stiffness_min_nm_per_rad, wave.stiffness_max_nm_per_rad);
                visit(&mut gait.stiffness_nm_per_rad, stiffnesses);
                waves_in(&mut gait.waves, wave.angle_range_rad, &mut visit);
            }
        }
    }

    /// A genome whose genes wait for values.
    fn blank(&self, descent: Descent) -> Genome {
        let Descent { joints, duration_s } = descent;
        let waves = || Waves::flat(joints, self.wave.harmonics);
        let controller = match self.controller {
            ControllerKind::Signal => {
                let signal = vec![0.0; self.points(duration_s)];
                let joint = JointSignals { bend_nm: signal.clone(), twist_nm: signal };
                let points_per_s = self.points_per_s;
                Controller::Signal(Signals { points_per_s, joints: vec![joint; joints] })
            }
            ControllerKind::Wave => Controller::Wave(waves()),
            ControllerKind::Gait => Controller::Gait(Gait {
                waves: waves(),
                stiffness_nm_per_rad: 0.0,
                servo_damping_nms_per_rad: self.wave.servo_damping_nms_per_rad,
            }),
        };
        Genome { bend_limit_rad: 0.0, twist_limit_rad: 0.0, density_kg_m3: 0.0, controller }
    }

    /// How many coordinates a genome has: one per gene with anything to choose.
    pub fn dimension(&self, descent: Descent) -> usize {
        let mut count = 0;
        self.visit(&mut self.blank(descent), |_, range| count += usize::from(!range.is_point()));
        count
    }

    /// The genome at a point of the unit cube: a coordinate per gene with anything to choose, from 0 to 1.
    /// Every point of the space around the cube means a genome too: see [`Range::at`].
    pub fn genome_at(&self, point: &[f64], descent: Descent) -> Genome {
        let mut genome = self.blank(descent);
        let mut coordinates = point.iter().copied();
        self.visit(&mut genome, |gene, range| {
            let coordinate = if range.is_point() { None } else { coordinates.next() };
            *gene = range.at(coordinate.unwrap_or(0.0));
        });
        genome
    }

    /// The point of the unit cube that means the same as a point beyond it.
    pub fn folded(&self, point: &[f64], descent: Descent) -> Vec<f64> {
        let mut coordinates = point.iter();
        let mut folded = Vec::with_capacity(point.len());
        self.visit(&mut self.blank(descent), |_, range| {
            if !range.is_point()
                && let Some(coordinate) = coordinates.next()
            {
                folded.push(range.folded(*coordinate));
            }
        });
        folded
    }

    /// The coordinates of a genome in the unit cube: [`Self::genome_at`] gives it again, but for rounding.
    pub fn point_of(&self, genome: &Genome) -> Vec<f64> {
        let mut point = Vec::new();
        self.visit(&mut genome.clone(), |gene, range| {
            if !range.is_point() {
                point.push(range.coordinate(*gene));
            }
        });
        point
    }

    /// Draws a periodic genome from nothing: every gene anywhere in its range.
    pub(super) fn drawn(&self, descent: Descent, rng: &mut ChaCha8Rng) -> Genome {
        let mut genome = self.blank(descent);
        self.visit(&mut genome, |gene, range| *gene = range.at(rng.random_range(0.0..1.0)));
        genome
    }

    /// Shifts every gene of a genome, but for its joint limits, at random by at most `share` of its range.
    pub(super) fn shift_all(&self, genome: &mut Genome, share: f32, rng: &mut ChaCha8Rng) {
        self.visit(genome, |gene, range| match range {
            Range::Between(least, most) => {
                let (middle, half) = ((least + most) / 2.0, (most - least) / 2.0);
                let shifted = middle + shifted(*gene - middle, share * half, half, rng);
                // Rounding could leave the range.
                *gene = shifted.clamp(least, most);
            }
            Range::Turn => {
                let turn = rng.random_range(-share / 2.0..=share / 2.0);
                *gene = range.at(range.coordinate(*gene) + f64::from(turn));
            }
            Range::OneOf(_) => {}
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, stream};

    const DESCENT: Descent = Descent { joints: 4, duration_s: 2.0 };

    fn space(controller: ControllerKind) -> GenomeSpace {
        GenomeSpace { controller, ..GenomeSpace::default() }
    }

    #[test]
    fn every_kind_of_genome_comes_back_from_its_point() {
        for kind in ControllerKind::ALL {
            let mut space = space(kind);
            space.wave.harmonics = 2;
            for individual in 0..20 {
                let mut rng = stream(1, 1, individual, Purpose::Birth);
                let genome = space.birth(DESCENT, &mut rng);
                let point = space.point_of(&genome);
                assert_eq!(point.len(), space.dimension(DESCENT), "{kind}");
                assert!(point.iter().all(|x| (0.0..=1.0).contains(x)), "{kind}: {point:?}");
                let again = space.point_of(&space.genome_at(&point, DESCENT));
                let off = point.iter().zip(&again).map(|(a, b)| (a - b).abs());
                assert!(off.fold(0.0, f64::max) < 1e-5, "{kind}");
            }
        }
    }

    #[test]
    fn dimensions_are_those_of_the_genes_that_can_differ() {
        assert_eq!(space(ControllerKind::Signal).dimension(DESCENT), 3 + 8 * 20);
        assert_eq!(space(ControllerKind::Wave).dimension(DESCENT), 3 + 1 + 8 * 3);
        assert_eq!(space(ControllerKind::Gait).dimension(DESCENT), 3 + 2 + 8 * 3);
        let mut narrow = space(ControllerKind::Gait);
        narrow.density_max_kg_m3 = narrow.density_min_kg_m3;
        narrow.bend_limits_rad = vec![1.0];
        narrow.twist_limits_rad = vec![1.0, 1.0];
        assert_eq!(narrow.dimension(DESCENT), 2 + 8 * 3);
        narrow.twist_limits_rad = vec![0.0];
        assert_eq!(narrow.dimension(DESCENT), 2 + 4 * 3, "no twist, no genes of twist");
        narrow.twist_limits_rad = vec![1.0];
        let genome = narrow.genome_at(&[0.5; 26], DESCENT);
        assert_eq!((genome.bend_limit_rad, genome.density_kg_m3), (1.0, 2.0));
    }

    #[test]
    fn beyond_its_ends_a_range_is_reflected_and_a_turn_goes_on() {
        let range = Range::Between(2.0, 4.0);
        for (coordinate, value) in
            [(0.25, 2.5), (-0.25, 2.5), (1.25, 3.5), (2.25, 2.5), (-1.0, 4.0)]
        {
            assert_eq!(range.at(coordinate), value, "at {coordinate}");
        }
        assert_eq!(range.at(f64::INFINITY), 2.0);
        assert!((Range::Turn.at(1.25) - Range::Turn.at(0.25)).abs() < 1e-6);
        assert!((Range::Turn.at(-0.75) - Range::Turn.at(0.25)).abs() < 1e-6);
        let list = Range::OneOf(&[1.0, 2.0, 3.0]);
        for (coordinate, value) in [(0.1, 1.0), (0.5, 2.0), (1.0, 3.0), (1.2, 3.0), (-0.4, 2.0)] {
            assert_eq!(list.at(coordinate), value, "at {coordinate}");
        }
    }

    #[test]
    fn a_shift_stays_within_its_share_of_each_range() {
        for kind in [ControllerKind::Wave, ControllerKind::Gait] {
            let space = space(kind);
            let parent = space.birth(DESCENT, &mut stream(1, 1, 0, Purpose::Birth));
            let mut child = parent.clone();
            space.shift_all(&mut child, 0.1, &mut stream(1, 2, 0, Purpose::Mutation));
            assert_ne!(child, parent);
            assert_eq!(child.bend_limit_rad, parent.bend_limit_rad, "limits are inherited");
            for (a, b) in space.point_of(&child).iter().zip(space.point_of(&parent)) {
                let off = (a - b).abs();
                let off = off.min(1.0 - off);
                assert!(off <= 0.0501, "{kind}: {a} and {b}");
            }
        }
    }
}
