//! What can be told of a genome in a few numbers with names: its genes, or, where these are hundreds of torques, what
//! they amount to.

use super::Range;
use crate::genome::{Controller, Genome, GenomeSpace, Waves};

/// A number of a genome.
#[derive(Debug, Clone, PartialEq)]
pub struct Feature {
    /// What it is.
    pub name: String,
    /// Its unit; nothing for a pure number.
    pub unit: &'static str,
    /// Its value.
    pub value: f32,
    /// Where in its range that is, from 0 to 1.
    pub share: f64,
}

impl GenomeSpace {
    /// The features of a genome of this space, in a fixed order: limits and density, then what drives the joints.
    /// What cannot differ is left out.
    pub fn features(&self, genome: &Genome) -> Vec<Feature> {
        let mut names = names(genome).into_iter();
        let mut features = Vec::new();
        self.visit(&mut genome.clone(), |gene, range| {
            if let Some((name, unit)) = names.next()
                && !range.is_point()
            {
                let share = range.coordinate(*gene).clamp(0.0, 1.0);
                features.push(Feature { name, unit, value: *gene, share });
            }
        });
        if let Controller::Signal(signals) = &genome.controller {
            let mut add = |name: String, unit, value: f32, most: f32| {
                let share = Range::Between(0.0, most.max(f32::MIN_POSITIVE)).coordinate(value);
                features.push(Feature { name, unit, value, share: share.clamp(0.0, 1.0) });
            };
            // Torques that change their sign with every point are as fast as can be.
            let most_hz = signals.points_per_s / 2.0;
            add("rhythm".to_owned(), "Hz", genome.controller.frequency_hz(), most_hz);
            for (joint, signals) in (1..).zip(&signals.joints) {
                for (axis, torques) in [("bend", &signals.bend_nm), ("twist", &signals.twist_nm)] {
                    let sum: f32 = torques.iter().map(|torque| torque.abs()).sum();
                    let mean = sum / torques.len().max(1) as f32;
                    let name = format!("joint {joint} {axis}, strength");
                    add(name, "N·m", mean, self.torque_range_nm);
                }
            }
        }
        features
    }
}

/// Names and units of the genes in the order in which the space shows them; of torque signals, none.
fn names(genome: &Genome) -> Vec<(String, &'static str)> {
    let mut names: Vec<(String, &'static str)> =
        [("bend limit", "rad"), ("twist limit", "rad"), ("density", "kg/m³")]
            .map(|(name, unit)| (name.to_owned(), unit))
            .into();
    let mut name_waves = |waves: &Waves, unit| {
        names.push(("frequency".to_owned(), "Hz"));
        for (joint, waves) in (1..).zip(&waves.joints) {
            for (axis, wave) in [("bend", &waves.bend), ("twist", &waves.twist)] {
                names.push((format!("joint {joint} {axis}, offset"), unit));
                for term in 1..=wave.harmonics.len() {
                    let term = if term == 1 { String::new() } else { format!(" {term}") };
                    names.push((format!("joint {joint} {axis}, amplitude{term}"), unit));
                    names.push((format!("joint {joint} {axis}, phase{term}"), "rad"));
                }
            }
        }
    };
    match &genome.controller {
        Controller::Signal(_) => {}
        Controller::Wave(waves) => name_waves(waves, "N·m"),
        Controller::Gait(gait) => {
            name_waves(&gait.waves, "rad");
            names.insert(3, ("stiffness".to_owned(), "N·m/rad"));
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::{ControllerKind, Descent};
    use crate::rng::{Purpose, stream};

    #[test]
    fn every_gene_of_a_wave_has_its_name_and_its_place_in_its_range() {
        let descent = Descent { joints: 4, duration_s: 2.0 };
        for kind in ControllerKind::ALL {
            let mut space = GenomeSpace { controller: kind, ..GenomeSpace::default() };
            space.wave.harmonics = 2;
            let genome = space.birth(descent, &mut stream(1, 1, 0, Purpose::Birth));
            let features = space.features(&genome);
            let expected = match kind {
                ControllerKind::Signal => 3 + 1 + 8,
                ControllerKind::Wave | ControllerKind::Gait => space.dimension(descent),
            };
            assert_eq!(features.len(), expected, "{kind}");
            assert!(features.iter().all(|of| (0.0..=1.0).contains(&of.share)), "{kind}");
            let value = |name: &str| {
                let feature = features.iter().find(|feature| feature.name == name);
                feature.map(|feature| (feature.value, feature.unit))
            };
            assert_eq!(value("bend limit"), Some((genome.bend_limit_rad, "rad")));
            match &genome.controller {
                Controller::Signal(_) => {
                    assert_eq!(value("rhythm"), Some((genome.controller.frequency_hz(), "Hz")));
                }
                Controller::Wave(waves) => {
                    let last = waves.joints[3].twist.harmonics[1];
                    let name = "joint 4 twist, amplitude 2";
                    assert_eq!(value(name), Some((last.amplitude, "N·m")));
                }
                Controller::Gait(gait) => {
                    let stiffness = gait.stiffness_nm_per_rad;
                    assert_eq!(value("stiffness"), Some((stiffness, "N·m/rad")));
                    assert_eq!(value("frequency"), Some((gait.waves.frequency_hz, "Hz")));
                    let first = gait.waves.joints[0].bend.harmonics[0];
                    assert_eq!(value("joint 1 bend, phase"), Some((first.phase_rad, "rad")));
                }
            }
        }
    }
}
