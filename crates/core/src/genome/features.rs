//! The features of a genome: its genes by name, or a summary where the genes are hundreds of torques.

use super::gene::{Feature, Gene, Genes};
use super::individual::Genome;
use super::space::GenomeSpace;

impl GenomeSpace {
    /// Returns the features of a genome of this space, in a fixed order: first those of the body, then those of the controller. Genes
    /// whose range has only one value are left out.
    pub fn features(&self, genome: &Genome) -> Vec<Feature> {
        let mut features = Vec::new();
        let mut add = |gene: Gene<'_>, value: &mut f32| {
            if !gene.range.is_point() {
                let name = gene.name.to_string();
                features.push(Feature::new(name, gene.quantity.unit, *value, gene.range));
            }
        };
        let Genome { mut body, mut controller } = genome.clone();
        body.genes(self, &mut Genes::to(&mut add));
        match controller.encoding().summary(self) {
            Some(summary) => features.extend(summary),
            None => controller.genes(self, &mut Genes::to(&mut add)),
        }
        features
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::{ControllerGenes, ControllerKind, GenomeShape};
    use crate::rng::{Purpose, stream};

    #[test]
    fn features_have_names_units_and_shares_of_their_ranges() {
        let shape = GenomeShape { joints: 4, duration_s: 2.0 };
        for &kind in ControllerKind::ALL {
            let mut space = GenomeSpace { controller: kind, ..GenomeSpace::default() };
            space.wave.harmonics = 2;
            let genome = space.random_genome(shape, &mut stream(1, 1, 0, Purpose::Birth));
            let features = space.features(&genome);
            let expected = match kind {
                ControllerKind::Signal => 3 + 1 + 8,
                ControllerKind::Targets => 3 + 2 + 8,
                _ => space.dimension(shape),
            };
            assert_eq!(features.len(), expected, "{kind}");
            assert!(features.iter().all(|of| (0.0..=1.0).contains(&of.share)), "{kind}");
            let value = |name: &str| {
                let feature = features.iter().find(|feature| feature.name == name);
                feature.map(|feature| (feature.value, feature.unit))
            };
            assert_eq!(value("bend limit"), Some((genome.body.bend_limit_rad, "rad")));
            if kind == ControllerKind::Signal {
                assert_eq!(value("rhythm"), Some((genome.controller.frequency_hz(), "Hz")));
            }
            if let ControllerGenes::Wave(waves) = &genome.controller {
                let last = waves.joints[3].twist.harmonics[1];
                let name = "joint 4 twist, amplitude 2";
                assert_eq!(value(name), Some((last.amplitude, "N·m")));
            }
            if let ControllerGenes::Gait(gait) = &genome.controller {
                let stiffness = gait.stiffness_nm_per_rad;
                assert_eq!(value("stiffness"), Some((stiffness, "N·m/rad")));
                assert_eq!(value("frequency"), Some((gait.waves.frequency_hz, "Hz")));
                let first = gait.waves.joints[0].bend.harmonics[0];
                assert_eq!(value("joint 1 bend, phase"), Some((first.phase_rad, "rad")));
            }
        }
    }
}
