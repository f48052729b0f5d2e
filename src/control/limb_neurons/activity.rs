//! The neurons of the limbs at a moment, for display.

use super::LimbNeuronController;
use crate::control::{NetworkActivity, NodeColumn, Observation};
use crate::genome::controllers::{
    LIMB_NEURONS, LimbNeuron, NEURON_SOURCES, NeuronInput, NeuronKind, NeuronSource,
};

/// The neurons of all limbs.
#[derive(Debug, Clone, PartialEq)]
pub struct LimbActivity {
    /// The limbs, head first.
    pub limbs: Vec<ActiveLimb>,
}

/// The neurons of a limb.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ActiveLimb {
    /// The neurons.
    pub neurons: [LimbNeuron; LIMB_NEURONS],
    /// Their outputs.
    pub outputs: [f32; LIMB_NEURONS],
    /// The values of all sources, in the order of [`NeuronSource::ALL`].
    pub values: [f32; NEURON_SOURCES],
}

impl LimbNeuronController {
    /// The limbs; none before the first step.
    pub(super) fn limbs(&self, observation: &Observation) -> Option<LimbActivity> {
        // An observation before the first step has no senses.
        if observation.perception.limbs.is_empty() {
            return None;
        }
        let periods = observation.periods(self.genes.frequency_hz);
        let limb = |(limb, outputs): (usize, &[f32; LIMB_NEURONS])| {
            Some(ActiveLimb {
                neurons: *self.genes.of_limb(limb)?,
                outputs: *outputs,
                values: self.values(limb, observation, periods),
            })
        };
        let limbs = self.outputs.iter().enumerate().map(limb).collect::<Option<_>>()?;
        Some(LimbActivity { limbs })
    }
}

impl LimbActivity {
    /// What a neuron does, by its place: the first two drive the joint behind their limb. The tail has none behind it.
    pub fn purpose(&self, limb: usize, neuron: usize) -> &'static str {
        match neuron {
            0 if limb + 1 < self.limbs.len() => "bend target",
            1 if limb + 1 < self.limbs.len() => "twist target",
            _ => "",
        }
    }

    /// The network of a limb: the values that its neurons read, and the neurons. A neuron that is off has no links.
    pub fn network(&self, limb: usize) -> Option<NetworkActivity> {
        let ActiveLimb { neurons, outputs, values } = self.limbs.get(limb)?;
        let works = |neuron: &&LimbNeuron| neuron.kind != NeuronKind::Off;
        let inputs = || neurons.iter().filter(works).flat_map(|neuron| neuron.inputs);
        let is_read = |source| inputs().any(|input| input.source == source && input.weight != 0.0);
        let mut shown = NetworkActivity::default();
        let mut places = [0; NEURON_SOURCES];
        // The first sources are the limb's own neurons.
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

#[cfg(test)]
mod tests {
    use super::super::tests::standing;
    use super::*;
    use crate::control::Controller;
    use crate::genome::{ControllerGenes, ControllerKind, GenomeSpace};
    use crate::rng::{Purpose, stream};
    use crate::score::Trial;
    use crate::world::JointTorque;

    #[test]
    fn the_links_of_a_limb_carry_what_its_neurons_sum_up_in_the_next_step() {
        let controller = ControllerKind::LimbNeurons;
        let mut space = GenomeSpace { controller, ..GenomeSpace::default() };
        space.network.limb_neurons_shared = false;
        let mut rng = stream(1, 1, 0, Purpose::Birth);
        let genome = space.random_genome(Trial::default().genome_shape(), &mut rng);
        let ControllerGenes::LimbNeurons(mut genes) = genome.controller else { panic!("neurons") };
        genes.limbs[1][3].kind = NeuronKind::Off;
        let mut controller = LimbNeuronController::new(genes);
        assert_eq!(controller.activity(&Observation::default(), 0), None);
        let mut observation = standing();
        let mut torques = [JointTorque::default(); 4];
        for step in 0..5 {
            observation.step = step;
            observation.perception.limbs[step as usize].touch = 1.0;
            controller.act(&observation, &mut torques);
        }
        let shown = controller.limbs(&observation).expect("it has acted");
        controller.act(&observation, &mut torques);
        for (limb, active) in shown.limbs.iter().enumerate() {
            let network = shown.network(limb).expect("a limb");
            let first = network.nodes.len() - LIMB_NEURONS;
            for (index, neuron) in active.neurons.iter().enumerate() {
                let links = network.links.iter().filter(|link| link.to == first + index);
                let sum: f32 = links.map(|link| network.nodes[link.from].value * link.weight).sum();
                let next = controller.outputs[limb][index];
                let expected = match neuron.kind {
                    NeuronKind::Off => 0.0,
                    NeuronKind::Tanh => libm::tanhf(sum + neuron.bias),
                    NeuronKind::Step => f32::from(u8::from(sum + neuron.bias >= 0.0)),
                    NeuronKind::Sigmoid => 1.0 / (1.0 + libm::expf(-sum - neuron.bias)),
                };
                assert!((next - expected).abs() < 1e-5, "limb {limb}, neuron {index}");
            }
        }
        let names = |limb: usize| -> Vec<String> {
            let network = shown.network(limb).expect("a limb");
            network.nodes.iter().rev().take(4).rev().map(|node| node.name.clone()).collect()
        };
        assert_eq!(names(1)[3], "neuron 4 (off)");
        assert!(
            names(4).iter().all(|name| !name.contains("target")),
            "no joint is behind the tail"
        );
        assert_eq!(shown.purpose(3, 0), "bend target");
    }
}
