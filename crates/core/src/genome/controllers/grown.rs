//! A network that grew: mutations added its nodes and links one by one.

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3Default;

use super::encoding::{ControllerEncoding, FREQUENCY_SETTINGS, SERVO_SETTINGS, SettingNames};
use super::servo::ServoGenes;
use crate::check::{Invalid, within};
use crate::genome::gene::{Genes, GenomeShape};
use crate::genome::space::GenomeSpace;
use crate::learn::neat::{NeatRules, NetworkGenome};

/// Names of those inputs of a grown network that the snake has once. They follow the bend of each joint and the touch of each limb. The
/// last one is the bias.
pub const GROWN_INPUTS: [&str; 12] = [
    "head gap",
    "head step up",
    "head pitch",
    "head blocked",
    "middle gap",
    "middle step up",
    "middle pitch",
    "tail pitch",
    "speed ahead",
    "beat, sine",
    "beat, cosine",
    "bias",
];

/// A network for the whole snake, with the nodes and links that it has grown. Its outputs are the bend targets of the joints from the
/// head. Servos hold the twists straight.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GrownGenes {
    /// Number of joints that the network drives.
    pub joints: u32,
    /// Servos that turn the joints to their targets.
    pub servo: ServoGenes,
    /// Frequency of the beat, in Hz.
    pub frequency_hz: f32,
    /// The network. Its inputs are the bends of the joints, the touches of the limbs, and [`GROWN_INPUTS`].
    pub network: NetworkGenome,
}

impl GrownGenes {
    /// Returns the numbers of inputs and outputs of the network of a snake with this many joints.
    pub fn ends(joints: usize) -> [u16; 2] {
        let inputs = joints + joints + 1 + GROWN_INPUTS.len();
        [inputs, joints].map(|count| u16::try_from(count).unwrap_or(u16::MAX))
    }

    /// Returns the name of an input of a snake with this many joints; empty for an input that does not exist.
    pub fn input_name(index: usize, joints: usize) -> String {
        if index < joints {
            return format!("joint {} bend", index + 1);
        }
        let index = index - joints;
        if index <= joints {
            return format!("block {} touch", index + 1);
        }
        GROWN_INPUTS.get(index - joints - 1).copied().unwrap_or("").to_owned()
    }
}

impl ControllerEncoding for GrownGenes {
    fn settings() -> SettingNames {
        &[FREQUENCY_SETTINGS, SERVO_SETTINGS]
    }

    fn zeroed(space: &GenomeSpace, shape: GenomeShape) -> Self {
        let [inputs, outputs] = Self::ends(shape.joints);
        Self {
            joints: shape.joints as u32,
            servo: ServoGenes { twist_range_rad: 0.0, ..ServoGenes::zeroed(space) },
            frequency_hz: 1.0,
            network: NetworkGenome { inputs, outputs, parameters: Vec::new(), links: Vec::new() },
        }
    }

    fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        self.servo.genes_without_twist(space, genes);
        space.wave.frequency_gene(&mut self.frequency_hz, genes);
    }

    fn joints(&self) -> usize {
        self.joints as usize
    }

    fn check_rest(&self) -> Result<(), Invalid> {
        let [inputs, outputs] = Self::ends(self.joints as usize);
        within("network.inputs", self.network.inputs, inputs..=inputs)?;
        within("network.outputs", self.network.outputs, outputs..=outputs)?;
        within("network.parameters", self.network.parameters.len(), 0..=0)?;
        self.network.check(&NeatRules::default()).map_err(|error| error.inside("network"))
    }

    fn widen(&self, space: &mut GenomeSpace) {
        self.servo.widen_without_twist(space);
    }

    fn hash_learned(&self, hash: &mut Xxh3Default) {
        for link in &self.network.links {
            for number in [link.from, link.to, u32::from(link.enabled), link.innovation] {
                hash.update(&number.to_le_bytes());
            }
            hash.update(&link.weight.to_bits().to_le_bytes());
        }
    }
}
