//! The neurons of the limbs at a moment, for display.

use super::LimbNeuronController;
use crate::control::{ActiveLimb, LimbActivity, Observation};
use crate::genome::controllers::LIMB_NEURONS;

impl LimbNeuronController {
    /// Returns the neurons of all limbs; `None` before the first step.
    pub(super) fn limbs(&self, observation: &Observation) -> Option<LimbActivity> {
        // Before the first step, an observation has no senses.
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

#[cfg(test)]
mod tests {
    use super::super::tests::{random, standing};
    use super::*;
    use crate::control::Controller;
    use crate::genome::controllers::NeuronKind;
    use crate::world::JointTorque;

    #[test]
    fn the_links_of_a_limb_carry_what_its_neurons_sum_up_in_the_next_step() {
        let mut genes = random(false);
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
