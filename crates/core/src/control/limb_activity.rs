//! The state of neurons in the limbs at a moment, for display.

use super::{NetworkActivity, NodeColumn};
use crate::genome::controllers::{
    LIMB_NEURONS, LimbNeuron, NEURON_SOURCES, NeuronInput, NeuronKind, NeuronSource,
};

/// The neurons of all limbs.
#[derive(Debug, Clone, PartialEq)]
pub struct LimbActivity {
    /// Limbs, head first.
    pub limbs: Vec<ActiveLimb>,
}

/// The neurons of a limb.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ActiveLimb {
    /// Neurons of the limb.
    pub neurons: [LimbNeuron; LIMB_NEURONS],
    /// Outputs of the neurons.
    pub outputs: [f32; LIMB_NEURONS],
    /// Values of all sources, in the order of [`NeuronSource::ALL`].
    pub values: [f32; NEURON_SOURCES],
}

impl LimbActivity {
    /// Describes the purpose of a neuron by its index: the first two drive the joint behind their limb. The tail has no joint behind it.
    pub fn purpose(&self, limb: usize, neuron: usize) -> &'static str {
        match neuron {
            0 if limb + 1 < self.limbs.len() => "bend target",
            1 if limb + 1 < self.limbs.len() => "twist target",
            _ => "",
        }
    }

    /// Returns the network of a limb: its neurons, and the values that they read. A neuron that is off has no links.
    pub fn network(&self, limb: usize) -> Option<NetworkActivity> {
        let ActiveLimb { neurons, outputs, values } = self.limbs.get(limb)?;
        let works = |neuron: &&LimbNeuron| neuron.kind != NeuronKind::Off;
        let inputs = || neurons.iter().filter(works).flat_map(|neuron| neuron.inputs);
        let is_read = |source| inputs().any(|input| input.source == source && input.weight != 0.0);
        let mut shown = NetworkActivity::default();
        let mut places = [0; NEURON_SOURCES];
        // The first sources are the limb's own neurons, which are not inputs.
        for (index, source) in NeuronSource::ALL.into_iter().enumerate().skip(LIMB_NEURONS) {
            if is_read(source) {
                places[index] = shown.nodes.len();
                shown.add(NodeColumn::Input, source.name(), values[index]);
            }
        }
        let first = shown.nodes.len();
        for index in 0..LIMB_NEURONS {
            places[index] = first + index;
            let name = match (neurons[index].kind, self.purpose(limb, index)) {
                (NeuronKind::Off, _) => format!("neuron {} (off)", index + 1),
                (_, "") => format!("neuron {}", index + 1),
                (_, purpose) => format!("neuron {}: {purpose}", index + 1),
            };
            shown.add(NodeColumn::Output, name, outputs[index]);
        }
        for (index, neuron) in neurons.iter().enumerate().filter(|(_, neuron)| works(neuron)) {
            for NeuronInput { source, weight } in neuron.inputs {
                let from = NeuronSource::ALL.iter().position(|known| *known == source)?;
                shown.link(places[from], first + index, weight);
            }
        }
        Some(shown)
    }
}
