//! Genomes as points of the unit cube. With them, any strategy can search in any space.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::body::BodyGenes;
use super::chain::Segment;
use super::gene::{GeneRange, Genes, GenomeShape, coordinate_count};
use super::individual::Genome;
use super::space::GenomeSpace;

/// Description of the gene that a coordinate of a point stands for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Coordinate {
    /// Dotted path of the gene in saves, such as `joints[0].bend.offset`.
    pub field: String,
    /// Name of the gene, for display.
    pub name: String,
    /// Unit of the gene; empty for a pure number.
    pub unit: &'static str,
    /// Values that the gene may have, in words.
    pub allowed: String,
}

/// Share of random bodies whose blocks are nearly alike. Without them, hardly any snake would move at first, because a body drawn anywhere
/// in its ranges hardly ever does.
const PLAIN_SHARE: f64 = 0.5;

impl GenomeSpace {
    /// Returns a genome whose genes are zero, with the layout of this space.
    pub(super) fn zeroed(&self, shape: GenomeShape) -> Genome {
        let mut body = BodyGenes::ZEROED;
        if self.bodies.vary && !self.has_creatures() {
            body.segments = (0..=shape.joints).map(|i| Segment::newborn(i, &self.bodies)).collect();
        }
        Genome { body, controller: self.controller.zeroed(self, shape) }
    }

    /// Visits the genes of a genome whose range has more than one value: one for each coordinate.
    fn search_genes(&self, mut genome: Genome, mut visit: impl FnMut(GeneRange<'_>, f32)) {
        genome.visit(self, |gene, value| {
            if !gene.range.is_point() {
                visit(gene.range, *value);
            }
        });
    }

    /// Counts the coordinates of a genome: one per gene whose range has more than one value.
    pub fn dimension(&self, shape: GenomeShape) -> usize {
        coordinate_count(|genes| self.zeroed(shape).genes(self, genes))
    }

    /// Counts the coordinates that belong to the body. They come before those of the controller.
    pub fn body_dimension(&self, shape: GenomeShape) -> usize {
        coordinate_count(|genes| self.zeroed(shape).body.genes(self, genes))
    }

    /// Describes the genes with a coordinate, in the order of the coordinates.
    pub fn coordinates(&self, shape: GenomeShape) -> Vec<Coordinate> {
        let mut coordinates = Vec::new();
        self.zeroed(shape).visit(self, |gene, _| {
            if !gene.range.is_point() {
                coordinates.push(Coordinate {
                    field: gene.field.to_string(),
                    name: gene.name.to_string(),
                    unit: gene.quantity.unit,
                    allowed: gene.range.words(),
                });
            }
        });
        coordinates
    }

    /// Returns the genome at a point of the unit cube, which has a coordinate from 0 to 1 for each gene whose range has more than one
    /// value. A point outside the cube has a genome, too: see `GeneRange::at`.
    pub fn genome_at(&self, point: &[f64], shape: GenomeShape) -> Genome {
        self.genome_by(|range, coordinate| range.at(coordinate), point, shape)
    }

    /// Returns the genome at a point, computed from all 64 bits of its coordinates: see `GeneRange::fine_at`. Strategies use
    /// [`Self::genome_at`].
    pub fn genome_at_fine(&self, point: &[f64], shape: GenomeShape) -> Genome {
        self.genome_by(|range, coordinate| range.fine_at(coordinate), point, shape)
    }

    fn genome_by(
        &self,
        at: impl Fn(GeneRange<'_>, f64) -> f32,
        point: &[f64],
        shape: GenomeShape,
    ) -> Genome {
        let mut genome = self.zeroed(shape);
        let mut coordinates = point.iter().copied();
        genome.visit(self, |gene, value| {
            let coordinate = if gene.range.is_point() { None } else { coordinates.next() };
            *value = at(gene.range, coordinate.unwrap_or(0.0));
        });
        self.bodies.repair(&mut genome.body.segments);
        genome
    }

    /// Returns the point within the unit cube that has the same genome as a point outside it.
    pub fn wrapped(&self, point: &[f64], shape: GenomeShape) -> Vec<f64> {
        let mut coordinates = point.iter();
        let mut wrapped = Vec::with_capacity(point.len());
        self.search_genes(self.zeroed(shape), |range, _| {
            wrapped.extend(coordinates.next().map(|&coordinate| range.wrapped(coordinate)));
        });
        wrapped
    }

    /// Returns the coordinates of a genome in the unit cube. From them, [`Self::genome_at`] returns the genome, except for rounding.
    pub fn point_of(&self, genome: &Genome) -> Vec<f64> {
        self.point_by(|range, value| range.coordinate(value), genome)
    }

    /// Returns the point of a genome that passes [`Self::check_genome`]. From it, [`Self::genome_at`] returns the genome to the last bit
    /// if the genome came from a point itself, otherwise except for rounding.
    pub fn exact_point_of(&self, genome: &Genome) -> Vec<f64> {
        self.point_by(|range, value| range.exact_coordinate(value), genome)
    }

    /// Returns the point of a genome that passes [`Self::check_genome`]. From it, [`Self::genome_at_fine`] returns the genome to the last
    /// bit, except for the rare values that `GeneRange::fine_coordinate` names.
    pub fn fine_point_of(&self, genome: &Genome) -> Vec<f64> {
        self.point_by(|range, value| range.fine_coordinate(value), genome)
    }

    fn point_by(&self, of: impl Fn(GeneRange<'_>, f32) -> f64, genome: &Genome) -> Vec<f64> {
        let mut point = Vec::new();
        self.search_genes(genome.clone(), |range, value| point.push(of(range, value)));
        point
    }

    /// Lets the kind of controller complete a mutation from one point to another: see `ControllerEncoding::after_mutation`. Genes that the
    /// controller does not change further keep their coordinates to the last bit, and so do genes that it resets to their values before
    /// the mutation.
    pub fn after_mutation(
        &self,
        start: &[f64],
        point: &mut [f64],
        shape: GenomeShape,
        rng: &mut ChaCha8Rng,
    ) {
        let mut before = self.genome_at(start, shape);
        let mut genome = self.genome_at(point, shape);
        let moved = self.point_of(&genome);
        let mut values = Vec::new();
        before.controller.genes(self, &mut Genes::to(&mut |_, value| values.push(*value)));
        genome.controller.encoding_mut().after_mutation(&values, self, rng);
        let last = self.point_of(&genome);
        let coordinates = point.iter_mut().zip(start).zip(self.point_of(&before));
        for (((coordinate, start), before), (moved, last)) in
            coordinates.zip(moved.iter().zip(last))
        {
            if last != *moved {
                *coordinate = if last == before { *start } else { last };
            }
        }
    }

    /// Draws a genome at random: signals by the random walk of the report, other genes anywhere in their ranges. Where bodies evolve, the
    /// number of blocks is random, too. Branching bodies are drawn until one can be built.
    pub fn random_genome(&self, shape: GenomeShape, rng: &mut ChaCha8Rng) -> Genome {
        if self.has_creatures() {
            return self.random_creature(rng);
        }
        if !self.bodies.vary {
            return self.drawn(shape, false, rng);
        }
        let joints = rng.random_range(self.bodies.limbs()) as usize - 1;
        let is_plain = rng.random_range(0.0..1.0) < PLAIN_SHARE;
        self.drawn(GenomeShape { joints, ..shape }, is_plain, rng)
    }

    /// Draws a genome at random whose body has nearly equal blocks, one more than the joints of the shape.
    pub fn random_genome_of_plain_body(&self, shape: GenomeShape, rng: &mut ChaCha8Rng) -> Genome {
        self.drawn(shape, true, rng)
    }

    fn drawn(&self, shape: GenomeShape, is_plain: bool, rng: &mut ChaCha8Rng) -> Genome {
        let Genome { mut body, mut controller } = self.zeroed(shape);
        controller.encoding_mut().randomize(&mut body, self, rng);
        if is_plain {
            self.bodies.make_plain(&mut body.segments, rng);
        }
        self.bodies.repair(&mut body.segments);
        Genome { body, controller }
    }

    /// Returns a child of the parent. Every torque of its signals is shifted at random within ±`shift_nm`, and every other gene by the
    /// same share of its own range. The joint limits are inherited.
    pub fn mutate(&self, parent: &Genome, shift_nm: f32, rng: &mut ChaCha8Rng) -> Genome {
        let Genome { mut body, mut controller } = parent.clone();
        controller.encoding_mut().mutate(&mut body, self, shift_nm, rng);
        self.bodies.repair(&mut body.segments);
        Genome { body, controller }
    }

    /// Returns a shift of torque as a share of the range of torques, at most 1.
    pub(super) fn shift_share(&self, shift_nm: f32) -> f32 {
        (shift_nm / self.torque_range_nm).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::controllers::TorqueSignals;
    use crate::genome::{ControllerGenes, ControllerKind};
    use crate::rng::{Purpose, stream};

    const SHAPE: GenomeShape = GenomeShape { joints: 4, duration_s: 2.0 };

    fn space(controller: ControllerKind) -> GenomeSpace {
        GenomeSpace { controller, ..GenomeSpace::default() }
    }

    #[test]
    fn genomes_of_every_kind_return_from_their_points() {
        for &kind in ControllerKind::ALL {
            let mut space = space(kind);
            space.wave.harmonics = 2;
            for individual in 0..20 {
                let mut rng = stream(1, 1, individual, Purpose::Birth);
                let genome = space.random_genome(SHAPE, &mut rng);
                let point = space.point_of(&genome);
                assert_eq!(point.len(), space.dimension(SHAPE), "{kind}");
                assert!(point.iter().all(|x| (0.0..=1.0).contains(x)), "{kind}: {point:?}");
                let again = space.point_of(&space.genome_at(&point, SHAPE));
                let off = point.iter().zip(&again).map(|(a, b)| (a - b).abs());
                assert!(off.fold(0.0, f64::max) < 1e-5, "{kind}");
            }
        }
    }

    #[test]
    fn every_genome_returns_from_its_fine_point_to_the_last_bit() {
        for &kind in ControllerKind::ALL {
            let mut space = space(kind);
            space.wave.harmonics = 2;
            for individual in 0..20 {
                let mut rng = stream(1, 1, individual, Purpose::Birth);
                let parent = space.random_genome(SHAPE, &mut rng);
                for genome in [space.mutate(&parent, 25.0, &mut rng), parent] {
                    let again = space.genome_at_fine(&space.fine_point_of(&genome), SHAPE);
                    let values = |mut genome: Genome| {
                        let mut bits = Vec::new();
                        genome.visit(&space, |_, value| bits.push(value.to_bits()));
                        bits
                    };
                    assert_eq!(values(again), values(genome), "{kind}");
                }
            }
        }
    }

    #[test]
    fn only_genes_with_a_choice_have_coordinates() {
        assert_eq!(space(ControllerKind::Signal).dimension(SHAPE), 3 + 8 * 20);
        assert_eq!(space(ControllerKind::Wave).dimension(SHAPE), 3 + 1 + 8 * 3);
        assert_eq!(space(ControllerKind::Gait).dimension(SHAPE), 3 + 2 + 8 * 3);
        let mut narrow = space(ControllerKind::Gait);
        narrow.density_max_kg_m3 = narrow.density_min_kg_m3;
        narrow.bend_limits_rad = vec![1.0];
        narrow.twist_limits_rad = vec![1.0, 1.0];
        assert_eq!(narrow.dimension(SHAPE), 2 + 8 * 3);
        narrow.twist_limits_rad = vec![0.0];
        assert_eq!(narrow.dimension(SHAPE), 2 + 4 * 3, "no twist, no genes of twist");
        narrow.twist_limits_rad = vec![1.0];
        let coordinates = narrow.coordinates(SHAPE);
        assert_eq!(coordinates.len(), 26);
        let Coordinate { field, name, unit, allowed } = &coordinates[0];
        let expected = ["stiffness_nm_per_rad", "stiffness", "N·m/rad", "50 to 1000"];
        assert_eq!([field, name, *unit, allowed], expected);
        let genome = narrow.genome_at(&[0.5; 26], SHAPE);
        assert_eq!((genome.body.bend_limit_rad, genome.body.density_kg_m3), (1.0, 2.0));
    }

    #[test]
    fn mutation_stays_within_its_share_of_each_range() {
        for kind in [ControllerKind::Wave, ControllerKind::Gait] {
            let space = space(kind);
            let parent = space.random_genome(SHAPE, &mut stream(1, 1, 0, Purpose::Birth));
            let child = space.mutate(&parent, 100.0, &mut stream(1, 2, 0, Purpose::Mutation));
            assert_ne!(child, parent);
            assert_eq!(
                child.body.bend_limit_rad, parent.body.bend_limit_rad,
                "limits are inherited"
            );
            for (a, b) in space.point_of(&child).iter().zip(space.point_of(&parent)) {
                let off = (a - b).abs();
                let off = off.min(1.0 - off);
                assert!(off <= 0.0501, "{kind}: {a} and {b}");
            }
        }
    }

    #[test]
    fn only_limb_neurons_complete_a_mutation() {
        for &kind in ControllerKind::ALL {
            let space = space(kind);
            let mut rng = stream(1, 1, 0, Purpose::Mutation);
            let (mut kept, mut returned) = (0, 0);
            let dimension = space.dimension(SHAPE);
            for individual in 0..50 {
                let mut birth = stream(1, 1, individual, Purpose::Birth);
                let start = space.point_of(&space.random_genome(SHAPE, &mut birth));
                let moved: Vec<f64> = start.iter().map(|x| x + 0.3).collect();
                let mut point = moved.clone();
                space.after_mutation(&start, &mut point, SHAPE, &mut rng);
                kept += point.iter().zip(&moved).filter(|(a, b)| a == b).count();
                returned += point.iter().zip(&start).filter(|(a, b)| a == b).count();
            }
            if kind == ControllerKind::LimbNeurons {
                // Six genes belong to body, servo and beat, and some neurons are new.
                let share = returned as f64 / (50 * (dimension - 6)) as f64;
                assert!((0.8..0.95).contains(&share) && kept >= 50 * 6, "{share}, {kept}");
            } else {
                assert_eq!(kept, 50 * dimension, "{kind}");
            }
        }
    }

    const FIVE_SECONDS: GenomeShape = GenomeShape { joints: 4, duration_s: 5.0 };

    fn signals(genome: &mut Genome) -> &mut TorqueSignals {
        match &mut genome.controller {
            ControllerGenes::Signal(signals) => signals,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn random_signals_are_drawn_as_the_report_says() {
        let space = GenomeSpace::default();
        let mut bends = Vec::new();
        for individual in 0..200 {
            let mut genome =
                space.random_genome(FIVE_SECONDS, &mut stream(1, 1, individual, Purpose::Birth));
            assert_eq!(signals(&mut genome).joints.len(), 4);
            assert!(signals(&mut genome).joints.iter().all(|joint| joint.bend_nm.len() == 50));
            assert!(space.twist_limits_rad.contains(&genome.body.twist_limit_rad));
            assert!((2.0..=2.5).contains(&genome.body.density_kg_m3));
            bends.push(genome.body.bend_limit_rad);
        }
        for limit in &space.bend_limits_rad {
            assert!(bends.contains(limit), "{limit} rad was never chosen in 200 genomes");
        }
    }

    #[test]
    fn mutation_changes_every_torque_by_at_most_the_shift() {
        let space = GenomeSpace::default();
        let mut parent = space.random_genome(FIVE_SECONDS, &mut stream(1, 1, 0, Purpose::Birth));
        let mut child = space.mutate(&parent, 25.0, &mut stream(1, 2, 0, Purpose::Mutation));
        assert_eq!(child.body.bend_limit_rad, parent.body.bend_limit_rad);
        let pairs =
            signals(&mut child).all_mut().flatten().zip(signals(&mut parent).all_mut().flatten());
        let pairs: Vec<(f32, f32)> = pairs.map(|(child, parent)| (*child, *parent)).collect();
        assert_eq!(pairs.len(), 400);
        for (child, parent) in pairs {
            assert!((child - parent).abs() <= 25.001, "{parent} became {child}");
            assert!(child.abs() <= 1000.0);
            assert!(child != parent || parent.abs() == 1000.0, "{parent} did not change");
        }
    }
}
