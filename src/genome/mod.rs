//! What evolves: the limits of the joints, the material of the body, and what drives the joints.
//!
//! Plain data that can be written down and read back. How a genome is drawn and varied is in
//! [`GenomeSpace`]; what it does to a body is decided in `score`, where it meets a trial.

mod fit;
mod gene;
mod signal;
mod space;
mod wave;

pub use gene::{Descent, Feature};
pub use signal::{JointSignals, Signals};
pub use space::{
    ControllerKind, DENSITY_RANGE_KG_M3, GenomeSpace, LARGEST_GENOME_TORQUES, LARGEST_LIMIT_RAD,
    LARGEST_TORQUE_NM, POINTS_PER_S_RANGE,
};
pub use wave::{
    FREQUENCY_RANGE_HZ, Gait, Harmonic, JointWaves, MOST_HARMONICS, SERVO_DAMPING_RANGE,
    STIFFNESS_RANGE_NM_PER_RAD, Wave, WaveSpace, Waves,
};

use xxhash_rust::xxh3::Xxh3Default;

/// One individual.
#[derive(Debug, Clone, PartialEq)]
pub struct Genome {
    /// Largest bend of every joint to either side, in radians.
    pub bend_limit_rad: f32,
    /// Largest twist of every joint to either side, in radians.
    pub twist_limit_rad: f32,
    /// Density of the material, in kg/m³.
    pub density_kg_m3: f32,
    /// What drives the joints.
    pub controller: Controller,
}

/// The genes of what drives the joints.
#[derive(Debug, Clone, PartialEq)]
pub enum Controller {
    /// Free torque signals, the report's: point after point, without a rule.
    Signal(Signals),
    /// Periodic torques. The waves are in N·m.
    Wave(Waves),
    /// Periodic joint angles, followed by a servo.
    Gait(Gait),
}

impl Controller {
    /// Of which kind it is.
    pub fn kind(&self) -> ControllerKind {
        match self {
            Self::Signal(_) => ControllerKind::Signal,
            Self::Wave(_) => ControllerKind::Wave,
            Self::Gait(_) => ControllerKind::Gait,
        }
    }

    /// How many joints it drives.
    pub fn joints(&self) -> usize {
        match self {
            Self::Signal(signals) => signals.joints.len(),
            Self::Wave(waves) | Self::Gait(Gait { waves, .. }) => waves.joints.len(),
        }
    }

    /// How many numbers it consists of.
    pub fn numbers(&self) -> usize {
        match self {
            Self::Signal(signals) => signals.all().map(Vec::len).sum(),
            Self::Wave(waves) | Self::Gait(Gait { waves, .. }) => {
                waves.all().map(|wave| 1 + 2 * wave.harmonics.len()).sum()
            }
        }
    }

    /// How often the motion repeats, in Hz. A signal has no period: half of how often its torques change
    /// their sign per second, which is the same for a sine.
    pub fn frequency_hz(&self) -> f32 {
        match self {
            Self::Signal(signals) => signals.sign_changes_per_s() / 2.0,
            Self::Wave(waves) | Self::Gait(Gait { waves, .. }) => waves.frequency_hz,
        }
    }
}

impl Genome {
    /// A hash (XXH3, 64 bits) over the bits of all genes: equal genomes have equal hashes.
    pub fn hash(&self) -> u64 {
        let mut hash = Xxh3Default::new();
        let mut take = |value: f32| hash.update(&value.to_bits().to_le_bytes());
        for value in [self.bend_limit_rad, self.twist_limit_rad, self.density_kg_m3] {
            take(value);
        }
        let take_waves = |waves: &Waves, take: &mut dyn FnMut(f32)| {
            take(waves.frequency_hz);
            for wave in waves.all() {
                take(wave.offset);
                for harmonic in &wave.harmonics {
                    take(harmonic.amplitude);
                    take(harmonic.phase_rad);
                }
            }
        };
        match &self.controller {
            Controller::Signal(signals) => {
                take(signals.points_per_s);
                signals.all().flatten().copied().for_each(take);
            }
            Controller::Wave(waves) => take_waves(waves, &mut take),
            Controller::Gait(gait) => {
                take(gait.stiffness_nm_per_rad);
                take(gait.servo_damping_nms_per_rad);
                take_waves(&gait.waves, &mut take);
            }
        }
        hash.digest()
    }
}
