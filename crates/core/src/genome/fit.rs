//! Checks whether a genome fits into a space, and widens a space so that a genome fits.

use super::chain::{BodySpace, Segment};
use super::creature::{CreatureSpace, grow};
use super::gene::{GeneRange, GenomeShape, check_genes};
use super::individual::Genome;
use super::space::GenomeSpace;
use crate::check::Invalid;

fn same(field: &str, found: impl ToString, expected: impl ToString) -> Result<(), Invalid> {
    let (found, expected) = (found.to_string(), expected.to_string());
    if found == expected { Ok(()) } else { Err(Invalid::new(field, found, expected)) }
}

impl GenomeSpace {
    /// Checks that this space could have produced a genome: its kind of controller, its layout, and every gene.
    ///
    /// # Errors
    /// Returns the first value that does not fit, with its name in saves.
    pub fn check_genome(&self, genome: &Genome, shape: GenomeShape) -> Result<(), Invalid> {
        same("controller", genome.controller.kind(), self.controller)?;
        // Fixed genes, which are settings, are checked first: a differing setting explains more than the differing lengths that follow
        // from it.
        let is_setting = |range: &GeneRange<'_>| matches!(range, GeneRange::Fixed(_));
        check_genes(
            |gene| Some(gene.range).filter(is_setting),
            |genes| genome.clone().genes(self, genes),
        )?;
        self.check_layout(genome, shape)?;
        check_genes(
            |gene| Some(gene.range),
            |genes| {
                let mut genome = genome.clone();
                genome.body.waiting_genes(self, genes);
                genome.genes(self, genes);
            },
        )
    }

    /// Checks that a genome has the kind of controller, the joints and the lengths of lists that this space prescribes.
    ///
    /// # Errors
    /// Returns the first difference.
    pub fn check_layout(&self, genome: &Genome, shape: GenomeShape) -> Result<(), Invalid> {
        same("controller", genome.controller.kind(), self.controller)?;
        let shape = self.shape_of(genome, shape)?;
        same("controller joints", genome.controller.joints(), shape.joints)?;
        if self.has_creatures() {
            // The layout of a creature's genome follows from its own graph.
            let mut found = Vec::new();
            genome.controller.encoding().lengths(&mut |_, length, _| found.push(length));
            let of_neurons = found.first().unwrap_or(&0);
            return same("nodes with neurons", of_neurons, genome.body.nodes.len());
        }
        let mut expected = Vec::new();
        let zeroed = self.zeroed(shape);
        zeroed.controller.encoding().lengths(&mut |_, length, _| expected.push(length));
        let (mut expected, mut result) = (expected.into_iter(), Ok(()));
        genome.controller.encoding().lengths(&mut |name, length, _| {
            let expected = expected.next().unwrap_or_default();
            if result.is_ok() {
                result = same(&name.to_string(), length, expected);
            }
        });
        result?;
        same("genes", genome.gene_count(self), zeroed.gene_count(self))
    }

    /// Returns the shape that a genome must have. Where bodies evolve, it has the genome's own number of joints.
    fn shape_of(&self, genome: &Genome, shape: GenomeShape) -> Result<GenomeShape, Invalid> {
        let segments = &genome.body.segments;
        if !self.has_creatures() {
            same("nodes", genome.body.nodes.len(), 0)?;
        }
        if !self.bodies.vary || self.has_creatures() {
            same("segments", segments.len(), 0)?;
        }
        if self.has_creatures() {
            return self.creature_shape(genome, shape);
        }
        if !self.bodies.vary {
            return Ok(shape);
        }
        if !self.bodies.is_within_limits(segments) {
            let found_m3: f64 = segments.iter().map(Segment::volume_m3).sum();
            let value = format!("{} blocks of {found_m3:.3} m³", segments.len());
            let BodySpace { limbs_min, limbs_max, volume_m3, .. } = self.bodies;
            let allowed = format!(
                "{limbs_min} to {limbs_max} blocks of {volume_m3} m³ together, within all limits of genome.bodies"
            );
            return Err(Invalid::new("segments", value, allowed));
        }
        Ok(GenomeShape { joints: segments.len() - 1, ..shape })
    }

    /// Returns the shape that the genome of a creature must have: with as many joints as grow from its graph.
    fn creature_shape(&self, genome: &Genome, shape: GenomeShape) -> Result<GenomeShape, Invalid> {
        let nodes = &genome.body.nodes;
        let grown = grow(nodes);
        if !self.allows_creature(nodes, &grown) {
            let CreatureSpace { parts_min, parts_max, .. } = self.creatures;
            let allowed = format!(
                "{parts_min} to {parts_max} parts of {} m³ together that lie apart, within all limits of genome.bodies",
                self.bodies.volume_m3
            );
            let found = format!("a graph of {} parts", grown.len());
            return Err(Invalid::new("nodes", found, allowed));
        }
        Ok(GenomeShape { joints: grown.len() - 1, ..shape })
    }

    /// Returns a genome with all genes that bodies of this space have. The genome of a founder may lack the gene of softness.
    pub fn with_all_genes(&self, mut genome: Genome) -> Genome {
        if self.bodies.vary && self.bodies.soft {
            genome.body = genome.body.with_softness();
        }
        genome
    }

    /// Returns this space, widened as far as necessary to contain a genome. Settings that do not follow from the genome stay.
    #[must_use]
    pub fn widened_for(&self, genome: &Genome) -> Self {
        let mut space = Self { controller: genome.controller.kind(), ..self.clone() };
        genome.body.widen(&mut space);
        genome.controller.widen(&mut space);
        space
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::controllers::Gait;
    use crate::genome::{ControllerGenes, ControllerKind, NetworkSpace};
    use crate::rng::{Purpose, stream};
    use rand::RngExt;

    const SHAPE: GenomeShape = GenomeShape { joints: 4, duration_s: 2.0 };

    fn space(controller: ControllerKind) -> GenomeSpace {
        let mut space = GenomeSpace { controller, ..GenomeSpace::default() };
        space.wave.harmonics = 2;
        space.wave.steering_range_rad = 1.5;
        space
    }

    #[test]
    fn genomes_from_points_return_from_their_exact_points_to_the_last_bit() {
        for &kind in ControllerKind::ALL {
            let space = space(kind);
            for individual in 0..50 {
                let mut rng = stream(1, 1, individual, Purpose::Birth);
                let dimension = space.dimension(SHAPE);
                let point: Vec<f64> = (0..dimension).map(|_| rng.random_range(0.0..1.0)).collect();
                let genome = space.genome_at(&point, SHAPE);
                space.check_genome(&genome, SHAPE).expect("its own");
                let again = space.genome_at(&space.exact_point_of(&genome), SHAPE);
                let phases_aside = |mut genome: Genome| {
                    // A full turn is the angle 0, so values that differ in the last bit can be the same angle.
                    if let ControllerGenes::Wave(waves)
                    | ControllerGenes::Gait(Gait { waves, .. }) = &mut genome.controller
                    {
                        let terms = waves.all_mut().flat_map(|wave| &mut wave.harmonics);
                        terms.for_each(|term| term.phase_rad = 0.0);
                    }
                    genome
                };
                assert_eq!(phases_aside(again), phases_aside(genome), "{kind}");
            }
        }
    }

    #[test]
    fn random_genomes_and_their_children_fit_into_their_space() {
        for &kind in ControllerKind::ALL {
            let space = space(kind);
            for individual in 0..20 {
                let mut rng = stream(2, 1, individual, Purpose::Birth);
                let parent = space.random_genome(SHAPE, &mut rng);
                let child = space.mutate(&parent, 300.0, &mut rng);
                for genome in [parent, child] {
                    space.check_genome(&genome, SHAPE).expect("its own");
                }
            }
        }
    }

    #[test]
    fn a_genome_that_does_not_fit_is_refused_with_the_field_and_its_range() {
        let gaits = space(ControllerKind::Gait);
        let gait = gaits.random_genome(SHAPE, &mut stream(1, 1, 0, Purpose::Birth));
        let refusal = |space: &GenomeSpace, genome: &Genome, shape| {
            space.check_genome(genome, shape).expect_err("refused").to_string()
        };
        let signals = space(ControllerKind::Signal);
        assert_eq!(refusal(&signals, &gait, SHAPE), "controller is gait; allowed: signal");
        let longer = GenomeShape { joints: 6, ..SHAPE };
        assert_eq!(refusal(&gaits, &gait, longer), "controller joints is 4; allowed: 6");
        let mut other = gaits.clone();
        other.wave.harmonics = 1;
        assert_eq!(refusal(&other, &gait, SHAPE), "joints[0].bend.harmonics is 2; allowed: 1");
        let mut genome = gait.clone();
        genome.body.density_kg_m3 = 9.0;
        assert_eq!(refusal(&gaits, &genome, SHAPE), "density_kg_m3 is 9; allowed: 2 to 2.5");
        genome = gait.clone();
        genome.body.bend_limit_rad = 0.7;
        let message = refusal(&gaits, &genome, SHAPE);
        assert_eq!(message, "bend_limit_rad is 0.7; allowed: one of 0.6 0.8 1 1.8");
        let mut genome = gait;
        let ControllerGenes::Gait(Gait { waves, .. }) = &mut genome.controller else {
            panic!("a gait")
        };
        waves.joints[2].twist.harmonics[1].amplitude = 0.6;
        let message = refusal(&gaits, &genome, SHAPE);
        assert_eq!(message, "joints[2].twist.harmonics[1].amplitude is 0.6; allowed: 0 to 0.5");
        let mut signal = signals.random_genome(SHAPE, &mut stream(1, 1, 0, Purpose::Birth));
        let ControllerGenes::Signal(torques) = &mut signal.controller else { panic!("signals") };
        torques.joints[3].bend_nm[7] = -2000.0;
        let message = refusal(&signals, &signal, SHAPE);
        assert_eq!(message, "joints[3].bend_nm[7] is -2000; allowed: -1000 to 1000");
    }

    #[test]
    fn a_widened_space_contains_the_genome() {
        for &kind in ControllerKind::ALL {
            let mut wide = space(kind);
            wide.wave.harmonics = 3;
            wide.wave.angle_range_rad = 2.9;
            wide.wave.frequency_max_hz = 9.0;
            wide.wave.servo_damping_nms_per_rad = 7.0;
            wide.network = NetworkSpace {
                weight_range: 8.0,
                hidden: 7,
                reflex_weight_range: 8.0,
                reflex_reach_rad: 1.0,
                reflex_phase_rad_per_s: 9.0,
                ctrnn_weight_range: 30.0,
                library_waves: 6,
                wave_rules: 3,
                limb_neurons_shared: false,
            };
            wide.torque_range_nm = 5000.0;
            wide.bend_limits_rad = vec![0.33];
            wide.density_max_kg_m3 = 50.0;
            let is_gait = kind == ControllerKind::Gait;
            let other = if is_gait { ControllerKind::Wave } else { ControllerKind::Gait };
            let narrow = space(other);
            for individual in 0..20 {
                let mut rng = stream(3, 1, individual, Purpose::Birth);
                let genome = wide.random_genome(SHAPE, &mut rng);
                assert!(narrow.check_genome(&genome, SHAPE).is_err());
                let widened = narrow.widened_for(&genome);
                widened.check_genome(&genome, SHAPE).expect("widened");
                crate::schema::check(&widened).expect("a space that is allowed");
                assert_eq!(widened.widened_for(&genome), widened, "wide enough");
            }
        }
    }
}
