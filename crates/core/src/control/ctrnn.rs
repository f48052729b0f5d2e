//! The controller with a continuous-time recurrent network.

use super::network::{place, servos};
use super::servo::JointServos;
use super::{Activity, Controller, NetworkActivity, NodeColumn, Observation, Senses};
use crate::genome::controllers::{CTRNN_INPUTS, CTRNN_NEURONS, CtrnnGenes, ServoGenes};
use crate::world::JointTorque;

/// Computes a continuous-time recurrent network with three leaky neurons at each joint.
#[derive(Debug, Clone)]
pub struct CtrnnController {
    genes: CtrnnGenes,
    servo: JointServos,
    /// Share of the distance to its input that each neuron's state covers in a step: 1 - exp(-h/τ), which is exact for a constant input.
    /// Unlike Euler's method, it is stable for every time constant.
    shares: [f32; CTRNN_NEURONS],
    /// States of the neurons of each joint.
    states: Vec<[f32; CTRNN_NEURONS]>,
    /// Outputs of the neurons of each joint, 0 to 1.
    outputs: Vec<[f32; CTRNN_NEURONS]>,
}

impl CtrnnController {
    /// Creates the controller before the first step, with all states 0.
    pub fn new(genes: CtrnnGenes) -> Self {
        let joints = genes.joints as usize;
        let mut controller = Self {
            servo: servos(&genes.servo),
            shares: [0.0; CTRNN_NEURONS],
            states: vec![[0.0; CTRNN_NEURONS]; joints],
            outputs: vec![[0.0; CTRNN_NEURONS]; joints],
            genes,
        };
        controller.compute_outputs();
        controller
    }

    fn compute_outputs(&mut self) {
        for (outputs, states) in self.outputs.iter_mut().zip(&self.states) {
            for ((output, state), neuron) in outputs.iter_mut().zip(states).zip(&self.genes.neurons)
            {
                *output = 1.0 / (1.0 + libm::expf(-(state + neuron.bias)));
            }
        }
    }

    fn inputs(&self, joint: usize, observation: &Observation) -> [f32; CTRNN_INPUTS.len()] {
        let senses = &observation.perception;
        let first = |index: Option<usize>| {
            index.and_then(|index| self.outputs.get(index)).map_or(0.0, |outputs| outputs[0])
        };
        let own = senses.joints[joint];
        let (front, rear) = (senses.limbs[joint], senses.limbs[joint + 1]);
        [
            first(joint.checked_sub(1)),
            first(Some(joint + 1)),
            own.bend,
            own.bend_rate,
            front.touch,
            front.blocked,
            front.pitch,
            front.gap,
            front.step_up,
            rear.touch,
            rear.load,
            rear.pitch,
            place(joint, senses.joints.len()),
        ]
    }
}

impl Controller for CtrnnController {
    fn needs(&self) -> Senses {
        Senses::ALL
    }

    fn act(&mut self, observation: &Observation, torques: &mut [JointTorque]) {
        if self.shares[0] == 0.0 {
            let step_s = 1.0 / observation.steps_per_s as f32;
            for (share, neuron) in self.shares.iter_mut().zip(&self.genes.neurons) {
                *share = 1.0 - libm::expf(-step_s / neuron.time_constant_s());
            }
        }
        for joint in 0..self.states.len() {
            let inputs = self.inputs(joint, observation);
            for (index, neuron) in self.genes.neurons.iter().enumerate() {
                let mut sum = 0.0;
                for (output, weight) in self.outputs[joint].iter().zip(&neuron.own) {
                    sum += output * weight;
                }
                for (input, weight) in inputs.iter().zip(&neuron.inputs) {
                    sum += input * weight;
                }
                let state = &mut self.states[joint][index];
                *state += (sum - *state) * self.shares[index];
            }
        }
        self.compute_outputs();
        let ServoGenes { bend_range_rad, twist_range_rad, .. } = self.genes.servo;
        let targets = self.outputs.iter().map(|[bend, twist, _]| {
            [(2.0 * bend - 1.0) * bend_range_rad, (2.0 * twist - 1.0) * twist_range_rad]
        });
        self.servo.pull(observation, targets, torques);
    }

    /// Shows the neurons of a joint. Inputs that are neurons of neighbouring joints have the values that are read in the next step.
    fn activity(&self, observation: &Observation, joint: usize) -> Option<Activity> {
        observation.perception.joints.get(joint)?;
        let inputs = self.inputs(joint, observation);
        let mut shown = NetworkActivity { joint: Some(joint), ..NetworkActivity::default() };
        for (name, value) in CTRNN_INPUTS.iter().zip(inputs) {
            shown.add(NodeColumn::Input, *name, value);
        }
        let names = ["neuron 1: bend target", "neuron 2: twist target", "neuron 3"];
        for (name, value) in names.into_iter().zip(*self.outputs.get(joint)?) {
            shown.add_sigmoid(NodeColumn::Output, name, value);
        }
        for (index, neuron) in self.genes.neurons.iter().enumerate() {
            for (from, weight) in neuron.inputs.iter().enumerate() {
                shown.link(from, inputs.len() + index, *weight);
            }
            for (from, weight) in neuron.own.iter().enumerate() {
                shown.link(inputs.len() + from, inputs.len() + index, *weight);
            }
        }
        Some(Activity::Network(shown))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::limb_neurons::tests::standing;
    use crate::genome::{ControllerGenes, ControllerKind};
    use crate::score::Trial;

    #[test]
    fn a_neuron_leaks_towards_its_input_at_the_same_speed_at_every_step_rate() {
        let genome = Trial::default().random_genome_of(ControllerKind::Ctrnn, 0);
        let ControllerGenes::Ctrnn(mut genes) = genome.controller else { panic!("ctrnn") };
        for neuron in &mut genes.neurons {
            neuron.log_time_constant = 0.0;
            neuron.own = [0.0; 3];
            neuron.inputs = [0.0; CTRNN_INPUTS.len()];
        }
        // The pitch of the front limb, 0.5, pulls the first neuron towards 2.
        genes.neurons[0].inputs[6] = 4.0;
        for steps_per_s in [30, 60, 240] {
            let mut observation = Observation { steps_per_s, ..standing() };
            observation.perception.limbs.iter_mut().for_each(|limb| limb.pitch = 0.5);
            let mut controller = CtrnnController::new(genes.clone());
            let mut torques = [JointTorque::default(); 4];
            (0..steps_per_s).for_each(|_| controller.act(&observation, &mut torques));
            let expected = 2.0 * (1.0 - libm::expf(-1.0));
            let found = controller.states[2][0];
            assert!((found - expected).abs() < 1e-4, "{found} at {steps_per_s} steps per second");
        }
    }
}
