//! A genome from elsewhere: whether it belongs into a space, the space into which it does, its point there.

use std::fmt::Write;

use super::gene::Range;
use super::{Controller, Descent, Gait, Genome, GenomeSpace, Wave, Waves};
use crate::check::Invalid;

impl Range<'_> {
    /// Whether a gene may have this value.
    fn has(self, value: f32) -> bool {
        match self {
            Self::Between(least, most) => (least..=most).contains(&value),
            Self::Turn => value.is_finite(),
            Self::OneOf(values) => values.contains(&value),
        }
    }

    /// What a gene may have, in words.
    fn words(self) -> String {
        match self {
            Self::Between(least, most) if least == most => least.to_string(),
            Self::Between(least, most) => format!("{least} to {most}"),
            Self::Turn => "an angle".to_owned(),
            Self::OneOf(values) => {
                let mut text = String::from("one of");
                for value in values {
                    let _ = write!(text, " {value}");
                }
                text
            }
        }
    }

    /// A coordinate at which the value stands, to the last bit where there is one.
    fn exact_coordinate(self, value: f32) -> f64 {
        let near = self.coordinate(value);
        let Self::Between(..) = self else { return near };
        // The value at a coordinate depends on its nearest 32-bit float.
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
}

impl GenomeSpace {
    /// Checks that this space could have brought a genome forth: its kind, its size, and every gene.
    ///
    /// # Errors
    /// The first thing about it that does not fit, by its name in saves.
    pub fn check_genome(&self, genome: &Genome, descent: Descent) -> Result<(), Invalid> {
        let same =
            |field: &str, found: &dyn std::fmt::Display, expected: &dyn std::fmt::Display| {
                let (found, expected) = (found.to_string(), expected.to_string());
                if found == expected { Ok(()) } else { Err(Invalid::new(field, found, expected)) }
            };
        same("controller", &genome.controller.kind(), &self.controller)?;
        same("controller joints", &genome.controller.joints(), &descent.joints)?;
        match &genome.controller {
            Controller::Signal(signals) => {
                same("points_per_s", &signals.points_per_s, &self.points_per_s)?;
                let points = self.points(descent.duration_s);
                let mut lengths = signals.all().map(Vec::len);
                lengths.try_for_each(|length| same("points of a signal", &length, &points))?;
            }
            Controller::Wave(waves) => self.check_harmonics(waves)?,
            Controller::Gait(gait) => {
                self.check_harmonics(&gait.waves)?;
                let expected = self.wave.servo_damping_nms_per_rad;
                let found = gait.servo_damping_nms_per_rad;
                same("servo_damping_nms_per_rad", &found, &expected)?;
            }
        }
        let (mut index, mut wrong) = (0, None);
        self.visit(&mut genome.clone(), |gene, range| {
            if wrong.is_none() && !range.has(*gene) {
                wrong = Some((index, *gene, range.words()));
            }
            index += 1;
        });
        match wrong {
            None => Ok(()),
            Some((index, value, allowed)) => {
                Err(Invalid::new(gene_name(genome, index), value, allowed))
            }
        }
    }

    fn check_harmonics(&self, waves: &Waves) -> Result<(), Invalid> {
        let expected = self.wave.harmonics;
        match waves.all().map(|wave| wave.harmonics.len()).find(|&n| n != expected as usize) {
            Some(found) => Err(Invalid::new("harmonics", found, expected.to_string())),
            None => Ok(()),
        }
    }

    /// This space, made as wide as it takes for a genome to belong into it. What the genome leaves open stays.
    #[must_use]
    pub fn widened_for(&self, genome: &Genome) -> Self {
        let mut space = Self { controller: genome.controller.kind(), ..self.clone() };
        for (limits, limit) in [
            (&mut space.bend_limits_rad, genome.bend_limit_rad),
            (&mut space.twist_limits_rad, genome.twist_limit_rad),
        ] {
            if !limits.contains(&limit) {
                limits.push(limit);
            }
        }
        space.density_min_kg_m3 = space.density_min_kg_m3.min(genome.density_kg_m3);
        space.density_max_kg_m3 = space.density_max_kg_m3.max(genome.density_kg_m3);
        match &genome.controller {
            Controller::Signal(signals) => {
                space.points_per_s = signals.points_per_s;
                let torques = signals.all().flatten().map(|torque_nm| torque_nm.abs());
                space.torque_range_nm = torques.fold(space.torque_range_nm, f32::max);
            }
            Controller::Wave(waves) => {
                space.widen_frequencies(waves);
                space.torque_range_nm = widest(waves).fold(space.torque_range_nm, f32::max);
            }
            Controller::Gait(gait) => {
                let Gait { waves, stiffness_nm_per_rad, servo_damping_nms_per_rad } = gait;
                space.widen_frequencies(waves);
                let wave = &mut space.wave;
                wave.angle_range_rad = widest(waves).fold(wave.angle_range_rad, f32::max);
                wave.stiffness_min_nm_per_rad =
                    wave.stiffness_min_nm_per_rad.min(*stiffness_nm_per_rad);
                wave.stiffness_max_nm_per_rad =
                    wave.stiffness_max_nm_per_rad.max(*stiffness_nm_per_rad);
                wave.servo_damping_nms_per_rad = *servo_damping_nms_per_rad;
            }
        }
        space
    }

    fn widen_frequencies(&mut self, waves: &Waves) {
        let wave = &mut self.wave;
        wave.frequency_min_hz = wave.frequency_min_hz.min(waves.frequency_hz);
        wave.frequency_max_hz = wave.frequency_max_hz.max(waves.frequency_hz);
        let harmonics = waves.all().map(|wave| wave.harmonics.len() as u32).max();
        wave.harmonics = harmonics.unwrap_or(wave.harmonics);
    }

    /// The point of the unit cube of a genome that passes [`Self::check_genome`]: [`Self::genome_at`] gives the
    /// genome again, to the last bit if it came from a point itself, else but for rounding.
    pub fn exact_point_of(&self, genome: &Genome) -> Vec<f64> {
        let mut point = Vec::new();
        self.visit(&mut genome.clone(), |gene, range| {
            if !range.is_point() {
                point.push(range.exact_coordinate(*gene));
            }
        });
        point
    }
}

/// The ranges that the terms of waves take: a term of k times the frequency has the k-th part of it.
fn widest(waves: &Waves) -> impl Iterator<Item = f32> {
    let of_wave = |wave: &Wave| {
        let terms = wave.harmonics.iter().zip(1_u8..).map(|(harmonic, k)| {
            let (k, mut range) = (f32::from(k), harmonic.amplitude.abs() * f32::from(k));
            while range.is_finite() && range / k < harmonic.amplitude.abs() {
                range = range.next_up();
            }
            range
        });
        terms.fold(wave.offset.abs(), f32::max)
    };
    waves.all().map(of_wave)
}

/// What saves call the gene of that index, in the order of [`GenomeSpace::visit`].
fn gene_name(genome: &Genome, index: usize) -> String {
    let body = ["bend_limit_rad", "twist_limit_rad", "density_kg_m3"];
    if let Some(name) = body.get(index) {
        return (*name).to_owned();
    }
    let index = index - body.len();
    let axis = |of_joint: usize, joint: usize, part: &str| {
        format!("joints[{joint}].{}{part}", ["bend", "twist"][of_joint.min(1)])
    };
    let (waves, index) = match &genome.controller {
        Controller::Signal(signals) => {
            let points = signals.all().next().map_or(1, Vec::len).max(1);
            let (signal, point) = (index / points, index % points);
            return axis(signal % 2, signal / 2, &format!("_nm[{point}]"));
        }
        Controller::Gait(_) if index == 0 => return "stiffness_nm_per_rad".to_owned(),
        Controller::Gait(gait) => (&gait.waves, index - 1),
        Controller::Wave(waves) => (waves, index),
    };
    let Some(index) = index.checked_sub(1) else { return "frequency_hz".to_owned() };
    let genes = 1 + 2 * waves.all().next().map_or(0, |wave| wave.harmonics.len());
    let (wave, gene) = (index / genes, index % genes);
    let part = match gene.checked_sub(1) {
        None => ".offset".to_owned(),
        Some(term) => {
            format!(".harmonics[{}].{}", term / 2, ["amplitude", "phase_rad"][term % 2])
        }
    };
    axis(wave % 2, wave / 2, &part)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::ControllerKind;
    use crate::rng::{Purpose, stream};
    use rand::RngExt;

    const DESCENT: Descent = Descent { joints: 4, duration_s: 2.0 };

    fn space(controller: ControllerKind) -> GenomeSpace {
        let mut space = GenomeSpace { controller, ..GenomeSpace::default() };
        space.wave.harmonics = 2;
        space
    }

    #[test]
    fn a_genome_from_a_point_comes_back_from_its_point_in_every_bit() {
        for kind in ControllerKind::ALL {
            let space = space(kind);
            for individual in 0..50 {
                let mut rng = stream(1, 1, individual, Purpose::Birth);
                let dimension = space.dimension(DESCENT);
                let point: Vec<f64> = (0..dimension).map(|_| rng.random_range(0.0..1.0)).collect();
                let genome = space.genome_at(&point, DESCENT);
                space.check_genome(&genome, DESCENT).expect("its own");
                let again = space.genome_at(&space.exact_point_of(&genome), DESCENT);
                let phases_aside = |mut genome: Genome| {
                    // A turn begins anew where it ends: what is left of its last bit means the same.
                    if let Controller::Wave(waves) | Controller::Gait(Gait { waves, .. }) =
                        &mut genome.controller
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
    fn newborns_and_children_belong_into_their_space() {
        for kind in ControllerKind::ALL {
            let space = space(kind);
            for individual in 0..20 {
                let mut rng = stream(2, 1, individual, Purpose::Birth);
                let parent = space.birth(DESCENT, &mut rng);
                let child = space.mutated(&parent, 300.0, &mut rng);
                for genome in [parent, child] {
                    space.check_genome(&genome, DESCENT).expect("its own");
                }
            }
        }
    }

    #[test]
    fn what_does_not_fit_is_named() {
        let gaits = space(ControllerKind::Gait);
        let gait = gaits.birth(DESCENT, &mut stream(1, 1, 0, Purpose::Birth));
        let refusal = |space: &GenomeSpace, genome: &Genome, descent| {
            space.check_genome(genome, descent).expect_err("refused").to_string()
        };
        let signals = space(ControllerKind::Signal);
        assert_eq!(refusal(&signals, &gait, DESCENT), "controller is gait; allowed: signal");
        let longer = Descent { joints: 6, ..DESCENT };
        assert_eq!(refusal(&gaits, &gait, longer), "controller joints is 4; allowed: 6");
        let mut other = gaits.clone();
        other.wave.harmonics = 1;
        assert_eq!(refusal(&other, &gait, DESCENT), "harmonics is 2; allowed: 1");
        let mut genome = gait.clone();
        genome.density_kg_m3 = 9.0;
        assert_eq!(refusal(&gaits, &genome, DESCENT), "density_kg_m3 is 9; allowed: 2 to 2.5");
        genome = Genome { bend_limit_rad: 0.7, ..gait.clone() };
        let message = refusal(&gaits, &genome, DESCENT);
        assert_eq!(message, "bend_limit_rad is 0.7; allowed: one of 0.6 0.8 1 1.8");
        let mut genome = gait;
        let Controller::Gait(Gait { waves, .. }) = &mut genome.controller else { panic!("a gait") };
        waves.joints[2].twist.harmonics[1].amplitude = 0.6;
        let message = refusal(&gaits, &genome, DESCENT);
        assert_eq!(message, "joints[2].twist.harmonics[1].amplitude is 0.6; allowed: 0 to 0.5");
        let mut signal = signals.birth(DESCENT, &mut stream(1, 1, 0, Purpose::Birth));
        let Controller::Signal(torques) = &mut signal.controller else { panic!("signals") };
        torques.joints[3].bend_nm[7] = -2000.0;
        let message = refusal(&signals, &signal, DESCENT);
        assert_eq!(message, "joints[3].bend_nm[7] is -2000; allowed: -1000 to 1000");
    }

    #[test]
    fn a_space_can_be_widened_for_any_genome() {
        for (kind, other) in [
            (ControllerKind::Signal, ControllerKind::Gait),
            (ControllerKind::Wave, ControllerKind::Signal),
            (ControllerKind::Gait, ControllerKind::Wave),
        ] {
            let mut wide = space(kind);
            wide.wave.harmonics = 3;
            wide.wave.angle_range_rad = 2.9;
            wide.wave.frequency_max_hz = 9.0;
            wide.wave.servo_damping_nms_per_rad = 7.0;
            wide.torque_range_nm = 5000.0;
            wide.bend_limits_rad = vec![0.33];
            wide.density_max_kg_m3 = 50.0;
            let narrow = space(other);
            for individual in 0..20 {
                let mut rng = stream(3, 1, individual, Purpose::Birth);
                let genome = wide.birth(DESCENT, &mut rng);
                assert!(narrow.check_genome(&genome, DESCENT).is_err());
                let widened = narrow.widened_for(&genome);
                widened.check_genome(&genome, DESCENT).expect("widened");
                widened.check().expect("a space that is allowed");
                assert_eq!(widened.widened_for(&genome), widened, "wide enough");
            }
        }
    }
}
