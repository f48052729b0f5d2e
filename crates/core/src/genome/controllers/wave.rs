//! Periodic controllers: a wave for each joint axis, all at one frequency. Alone, the waves are torques.

use serde::{Deserialize, Serialize};

use super::encoding::{ControllerEncoding, ControllerInfo, JointCommands};
use crate::check::{Invalid, within};
use crate::genome::gene::{Gene, GeneRange, GeneVisitor, GenomeShape};
use crate::genome::space::{GenomeSpace, LARGEST_TORQUE_NM};
use crate::genome::wave_space::{FREQUENCY_RANGE_HZ, MOST_HARMONICS};

/// One wave per joint axis, at one shared frequency.
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
    /// About the bend axis.
    pub bend: Wave,
    /// About the twist axis.
    pub twist: Wave,
}

/// A Fourier series of few terms: `offset + Σ amplitude_k · sin(2π · k · frequency · t + phase_k)`, k = 1, 2, ...
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wave {
    /// The centre of its swing, in the unit of its controller: N·m or radians.
    pub offset: f32,
    /// The terms, from the fundamental up.
    pub harmonics: Vec<Harmonic>,
}

/// One term of a wave.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Harmonic {
    /// In the unit of the controller: N·m or radians.
    pub amplitude: f32,
    /// Phase at the start, in radians.
    pub phase_rad: f32,
}

impl Wave {
    /// Its value after `turns` periods of the fundamental, summed in double precision, which suffices for the
    /// longest trial.
    pub fn at(&self, turns: f64) -> f32 {
        // A sine is the dearest part of a controller, and half of the terms of a snake that cannot twist have no amplitude.
        let swings = self.harmonics.iter().enumerate().filter(|(_, of)| of.amplitude != 0.0);
        let terms = swings.map(|(index, harmonic)| {
            let angle = std::f64::consts::TAU * (index + 1) as f64 * turns;
            f64::from(harmonic.amplitude) * libm::sin(angle + f64::from(harmonic.phase_rad))
        });
        (f64::from(self.offset) + terms.sum::<f64>()) as f32
    }

    fn check(&self, most: f32) -> Result<(), Invalid> {
        within("offset", self.offset, -most..=most)?;
        within("harmonics", self.harmonics.len(), 1..=MOST_HARMONICS as usize)?;
        for harmonic in &self.harmonics {
            within("amplitude", harmonic.amplitude, -most..=most)?;
            // One turn is enough; a little more is no harm.
            within("phase_rad", harmonic.phase_rad, -10.0..=10.0)?;
        }
        Ok(())
    }

    /// The range of offsets and fundamental amplitudes that it needs: the k-th term has a k-th of the range.
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

/// How the names of charts count the terms of a wave.
const TERMS: [&str; MOST_HARMONICS as usize] = ["", " 2", " 3", " 4", " 5"];

impl Waves {
    /// Every wave in a fixed order: joints from the head, bend before twist.
    pub fn all_mut(&mut self) -> impl Iterator<Item = &mut Wave> {
        self.joints.iter_mut().flat_map(|joint| [&mut joint.bend, &mut joint.twist])
    }

    /// Every wave in the same order, to read.
    pub fn all(&self) -> impl Iterator<Item = &Wave> {
        self.joints.iter().flat_map(|joint| [&joint.bend, &joint.twist])
    }

    /// Checks every value; `most` is the greatest offset and amplitude.
    ///
    /// # Errors
    /// The first value that is not allowed.
    pub(super) fn check_up_to(&self, most: f32) -> Result<(), Invalid> {
        within("frequency_hz", self.frequency_hz, FREQUENCY_RANGE_HZ)?;
        for (index, joint) in self.joints.iter().enumerate() {
            for (axis, wave) in [("bend", &joint.bend), ("twist", &joint.twist)] {
                let place = format!("joints[{index}].{axis}");
                wave.check(most).map_err(|error| error.inside(&place))?;
            }
        }
        Ok(())
    }

    /// Visits the genes of waves whose offsets and amplitudes have the unit `unit` and at most these sizes, about the
    /// bend and the twist axes.
    pub(super) fn genes_up_to(
        &mut self,
        [bend, twist]: [f32; 2],
        unit: &'static str,
        space: &GenomeSpace,
        visit: GeneVisitor<'_>,
    ) {
        space.wave.frequency_gene(&mut self.frequency_hz, visit);
        // A joint that cannot turn needs no search.
        let [bend_turns, twist_turns] = space.turning_axes();
        let bend = if bend_turns { bend } else { 0.0 };
        let twist = if twist_turns { twist } else { 0.0 };
        for (joint, waves) in self.joints.iter_mut().enumerate() {
            for (axis, wave, amplitude) in
                [("bend", &mut waves.bend, bend), ("twist", &mut waves.twist, twist)]
            {
                let number = joint + 1;
                let range = GeneRange::Between(-amplitude, amplitude);
                let field = format_args!("joints[{joint}].{axis}.offset");
                let name = format_args!("joint {number} {axis}, offset");
                visit(Gene { field, name, unit, range }, &mut wave.offset);
                for (index, harmonic) in wave.harmonics.iter_mut().enumerate() {
                    let term = TERMS.get(index).copied().unwrap_or_default();
                    // A term of k times the frequency has k times the rates.
                    let most = amplitude / (index + 1) as f32;
                    let range = GeneRange::Between(0.0, most);
                    let field = format_args!("joints[{joint}].{axis}.harmonics[{index}].amplitude");
                    let name = format_args!("joint {number} {axis}, amplitude{term}");
                    visit(Gene { field, name, unit, range }, &mut harmonic.amplitude);
                    let moves = most > 0.0;
                    let range = if moves { GeneRange::Turn } else { GeneRange::Between(0.0, 0.0) };
                    let field = format_args!("joints[{joint}].{axis}.harmonics[{index}].phase_rad");
                    let name = format_args!("joint {number} {axis}, phase{term}");
                    visit(Gene { field, name, unit: "rad", range }, &mut harmonic.phase_rad);
                }
            }
        }
    }

    /// Widens a space so that it contains the frequency and the number of terms. Returns the ranges of offsets
    /// and amplitudes that these waves need about the bend and the twist axes, at least `bend` and `twist`.
    pub(super) fn widen_from(&self, [bend, twist]: [f32; 2], space: &mut GenomeSpace) -> [f32; 2] {
        let wave = &mut space.wave;
        wave.widen_frequency(self.frequency_hz);
        let harmonics = self.all().map(|wave| wave.harmonics.len() as u32).max();
        wave.harmonics = harmonics.unwrap_or(wave.harmonics);
        let needed = |range: f32, axis: fn(&JointWaves) -> &Wave| {
            self.joints.iter().map(axis).map(Wave::needed_range).fold(range, f32::max)
        };
        [needed(bend, |joint| &joint.bend), needed(twist, |joint| &joint.twist)]
    }

    /// Samples of all waves during a trial.
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
    fn info() -> &'static ControllerInfo {
        &ControllerInfo {
            name: "wave",
            title: "Wave",
            words: "Periodic torques: a wave per joint axis, one frequency.",
            senses_surroundings: false,
            settings: &[
                "torque_range_nm",
                "wave.frequency_min_hz",
                "wave.frequency_max_hz",
                "wave.harmonics",
            ],
        }
    }

    fn zeroed(space: &GenomeSpace, shape: GenomeShape) -> Self {
        let term = Harmonic { amplitude: 0.0, phase_rad: 0.0 };
        let wave = Wave { offset: 0.0, harmonics: vec![term; space.wave.harmonics as usize] };
        let joint = JointWaves { bend: wave.clone(), twist: wave };
        Self { frequency_hz: 1.0, joints: vec![joint; shape.joints] }
    }

    fn genes(&mut self, space: &GenomeSpace, visit: GeneVisitor<'_>) {
        self.genes_up_to([space.torque_range_nm; 2], "N·m", space, visit);
    }

    fn lengths(&self, visit: &mut dyn FnMut(&'static str, usize)) {
        self.all().for_each(|wave| visit("harmonics", wave.harmonics.len()));
    }

    fn joints(&self) -> usize {
        self.joints.len()
    }

    fn frequency_hz(&self) -> f32 {
        self.frequency_hz
    }

    fn check(&self) -> Result<(), Invalid> {
        self.check_up_to(LARGEST_TORQUE_NM).map_err(|error| error.inside("waves"))
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
