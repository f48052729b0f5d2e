//! Periodic controllers: a wave for each joint axis, all with the same frequency. Without a servo, the waves are torques.

use serde::{Deserialize, Serialize};

use super::encoding::{
    ControllerEncoding, FREQUENCY_SETTINGS, JointCommands, LengthVisitor, SettingNames,
};
use crate::genome::gene::{GeneRange, Genes, GenomeShape, Quantity};
use crate::genome::limits::{LARGEST_LIMIT_RAD, PHASE};
use crate::genome::space::{GenomeSpace, TORQUE};
use crate::genome::wave_space::MOST_HARMONICS;

/// One wave per joint axis. All have the same frequency.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Waves {
    /// Frequency of the fundamental of all waves, in Hz.
    pub frequency_hz: f32,
    /// The waves of each joint, from the head.
    pub joints: Vec<JointWaves>,
}

/// The two waves of one joint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointWaves {
    /// Wave about the bend axis.
    pub bend: Wave,
    /// Wave about the twist axis.
    pub twist: Wave,
}

/// A Fourier series of few terms: `offset + Σ amplitude_k · sin(2π · k · frequency · t + phase_k)`, k = 1, 2, ...
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wave {
    /// Centre of the wave, in the unit of its controller: N·m or radians.
    pub offset: f32,
    /// Terms of the wave, from the fundamental up.
    pub harmonics: Vec<Harmonic>,
}

/// One sine term of a wave.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Harmonic {
    /// Amplitude of the term, in the unit of the controller: N·m or radians.
    pub amplitude: f32,
    /// Phase of the term at the start, in radians.
    pub phase_rad: f32,
}

impl Wave {
    /// Returns the wave's value after `turns` periods of the fundamental. It is summed in double precision, which is exact enough for the
    /// longest trial.
    pub fn at(&self, turns: f64) -> f32 {
        // Sines take most of a controller's time. Terms without amplitude are skipped, because a snake that cannot twist has none in half
        // of its terms.
        let swings = self.harmonics.iter().enumerate().filter(|(_, of)| of.amplitude != 0.0);
        let terms = swings.map(|(index, harmonic)| {
            let angle = std::f64::consts::TAU * (index + 1) as f64 * turns;
            f64::from(harmonic.amplitude) * libm::sin(angle + f64::from(harmonic.phase_rad))
        });
        (f64::from(self.offset) + terms.sum::<f64>()) as f32
    }

    /// Visits the genes. Offset and amplitudes have this quantity, and are at most `most`.
    fn genes(&mut self, quantity: Quantity, most: f32, genes: &mut Genes<'_>) {
        genes.gene("offset", "offset", quantity, GeneRange::around_zero(most), &mut self.offset);
        for (index, harmonic) in self.harmonics.iter_mut().enumerate() {
            // A term with k times the frequency has k times the rates, so its greatest amplitude is divided by k.
            let most = most / (index + 1) as f32;
            let moves = most > 0.0;
            let term = TERMS.get(index).copied().unwrap_or_default();
            let Harmonic { amplitude, phase_rad } = harmonic;
            let (field, name) =
                (format_args!("harmonics[{index}].amplitude"), format_args!("amplitude{term}"));
            genes.gene(field, name, quantity, GeneRange::Between(0.0, most), amplitude);
            let range = if moves { GeneRange::Turn } else { GeneRange::Between(0.0, 0.0) };
            let field = format_args!("harmonics[{index}].phase_rad");
            genes.gene(field, format_args!("phase{term}"), PHASE, range, phase_rad);
        }
    }

    /// Returns the range of offsets and fundamental amplitudes that contains this wave. The k-th term has a k-th of this range.
    fn needed_range(&self) -> f32 {
        let terms = self.harmonics.iter().zip(1_u8..).map(|(harmonic, k)| {
            let (k, mut range) = (f32::from(k), harmonic.amplitude.abs() * f32::from(k));
            while range.is_finite() && range / k < harmonic.amplitude.abs() {
                range = range.next_up();
            }
            range
        });
        terms.fold(self.offset.abs(), f32::max)
    }
}

/// Quantity of the offset or an amplitude of a target angle, to either side.
pub(super) const ANGLE: Quantity = Quantity::new("rad", -LARGEST_LIMIT_RAD..=LARGEST_LIMIT_RAD);
/// Suffixes by which the names in charts count the terms of a wave.
const TERMS: [&str; MOST_HARMONICS as usize] = ["", " 2", " 3", " 4", " 5"];

impl Waves {
    /// Returns every wave in a fixed order, for changes: joints from the head, bend before twist.
    pub fn all_mut(&mut self) -> impl Iterator<Item = &mut Wave> {
        self.joints.iter_mut().flat_map(|joint| [&mut joint.bend, &mut joint.twist])
    }

    /// Returns every wave in a fixed order, for reading: joints from the head, bend before twist.
    pub fn all(&self) -> impl Iterator<Item = &Wave> {
        self.joints.iter().flat_map(|joint| [&joint.bend, &joint.twist])
    }

    /// Visits the genes of waves of target angles.
    pub(super) fn angle_genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        let ranges_rad = [space.wave.angle_range_rad, space.wave.twist_range_rad];
        self.genes_up_to(ranges_rad, ANGLE, space, genes);
    }

    /// Visits the genes of waves. Offsets and amplitudes have this quantity, and are at most `bend` about the bend axes and `twist` about
    /// the twist axes.
    fn genes_up_to(
        &mut self,
        [bend, twist]: [f32; 2],
        quantity: Quantity,
        space: &GenomeSpace,
        genes: &mut Genes<'_>,
    ) {
        space.wave.frequency_gene(&mut self.frequency_hz, genes);
        // An axis about which a joint cannot turn gets a range of one value, so that it has no coordinates.
        let [bend_turns, twist_turns] = space.turning_axes();
        let bend = if bend_turns { bend } else { 0.0 };
        let twist = if twist_turns { twist } else { 0.0 };
        for (joint, waves) in self.joints.iter_mut().enumerate() {
            for (axis, wave, most) in
                [("bend", &mut waves.bend, bend), ("twist", &mut waves.twist, twist)]
            {
                let field = format_args!("joints[{joint}].{axis}.");
                let name = format_args!("joint {} {axis}, ", joint + 1);
                genes.inside(field, name, |genes| wave.genes(quantity, most, genes));
            }
        }
    }

    /// Widens a space so that it contains the number of terms. Returns the ranges of offsets and amplitudes that these waves need about
    /// the bend and the twist axes, at least `bend` and `twist`.
    pub(super) fn widen_from(&self, [bend, twist]: [f32; 2], space: &mut GenomeSpace) -> [f32; 2] {
        let terms = self.all().map(|wave| wave.harmonics.len() as u32).max();
        space.wave.harmonics = terms.unwrap_or(space.wave.harmonics);
        let needed = |range: f32, axis: fn(&JointWaves) -> &Wave| {
            self.joints.iter().map(axis).map(Wave::needed_range).fold(range, f32::max)
        };
        [needed(bend, |joint| &joint.bend), needed(twist, |joint| &joint.twist)]
    }

    /// Returns samples of all waves during a trial of this length, in seconds: times in seconds, and values.
    pub(super) fn samples(&self, duration_s: f64) -> Vec<[Vec<(f64, f64)>; 2]> {
        const SAMPLES_PER_S: f64 = 60.0;
        let count = (duration_s * SAMPLES_PER_S) as usize;
        let samples = |wave: &Wave| {
            let sample = |index: usize| {
                let time_s = index as f64 / SAMPLES_PER_S;
                (time_s, f64::from(wave.at(f64::from(self.frequency_hz) * time_s)))
            };
            (0..=count).map(sample).collect()
        };
        self.joints.iter().map(|joint| [samples(&joint.bend), samples(&joint.twist)]).collect()
    }
}

impl ControllerEncoding for Waves {
    fn settings() -> SettingNames {
        &[FREQUENCY_SETTINGS, &["torque_range_nm", "wave.harmonics"]]
    }

    fn zeroed(space: &GenomeSpace, shape: GenomeShape) -> Self {
        let term = Harmonic { amplitude: 0.0, phase_rad: 0.0 };
        let wave = Wave { offset: 0.0, harmonics: vec![term; space.wave.harmonics as usize] };
        let joint = JointWaves { bend: wave.clone(), twist: wave };
        Self { frequency_hz: 1.0, joints: vec![joint; shape.joints] }
    }

    fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        self.genes_up_to([space.torque_range_nm; 2], TORQUE, space, genes);
    }

    fn lengths(&self, visit: LengthVisitor<'_>) {
        for (joint, waves) in self.joints.iter().enumerate() {
            for (axis, wave) in [("bend", &waves.bend), ("twist", &waves.twist)] {
                let terms = wave.harmonics.len();
                let name = format_args!("joints[{joint}].{axis}.harmonics");
                visit(name, terms, 1..=MOST_HARMONICS as usize);
            }
        }
    }

    fn joints(&self) -> usize {
        self.joints.len()
    }

    fn widen(&self, space: &mut GenomeSpace) {
        let [bend_nm, twist_nm] = self.widen_from([space.torque_range_nm; 2], space);
        space.torque_range_nm = bend_nm.max(twist_nm);
    }

    fn commands(&self, duration_s: f64) -> Option<JointCommands> {
        let joints = self.samples(duration_s);
        let quantity = "torque in N·m";
        Some(JointCommands { quantity, least_range: 1000.0, is_held: false, joints })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_is_the_sum_of_its_offset_and_its_terms() {
        let term = |amplitude, phase_rad| Harmonic { amplitude, phase_rad };
        let quarter = std::f32::consts::FRAC_PI_2;
        let wave = Wave { offset: 0.5, harmonics: vec![term(2.0, 0.0), term(1.0, quarter)] };
        for (turns, expected) in [(0.0, 1.5), (0.25, 1.5), (0.5, 1.5), (0.75, -2.5), (7.25, 1.5)] {
            assert!((wave.at(turns) - expected).abs() < 1e-5, "{} at {turns}", wave.at(turns));
        }
    }
}
