//! The controller with neurons in the limbs.

mod activity;
#[cfg(test)]
mod xor;

use super::network::{beat, servos};
use super::servo::JointServos;
use super::{Activity, Controller, Observation, Senses};
use crate::genome::controllers::{LIMB_NEURONS, LimbNeurons, NEURON_SOURCES, ServoGenes};
use crate::world::JointTorque;

/// Computes the neurons of all limbs, step after step.
#[derive(Debug, Clone)]
pub struct LimbNeuronController {
    genes: LimbNeurons,
    servo: JointServos,
    /// Outputs of the neurons of each limb, head first.
    outputs: Vec<[f32; LIMB_NEURONS]>,
    /// Outputs of the step that begins: working memory.
    next: Vec<[f32; LIMB_NEURONS]>,
}

impl LimbNeuronController {
    /// Creates the controller before the first step, with all outputs 0.
    pub fn new(genes: LimbNeurons) -> Self {
        let outputs = vec![[0.0; LIMB_NEURONS]; genes.limb_count()];
        Self { servo: servos(&genes.servo), next: outputs.clone(), outputs, genes }
    }

    /// Returns the values of all sources of a limb, in the order of `NeuronSource::ALL`. Values of a limb or a joint that does not exist
    /// are 0.
    fn values(
        &self,
        limb: usize,
        observation: &Observation,
        periods: f64,
    ) -> [f32; NEURON_SOURCES] {
        let outputs = |index: Option<usize>| {
            index.and_then(|index| self.outputs.get(index)).copied().unwrap_or_default()
        };
        let [own, front, rear] = [Some(limb), limb.checked_sub(1), Some(limb + 1)].map(outputs);
        let senses = &observation.perception;
        let joint = senses.joints.get(limb).copied().unwrap_or_default();
        let of_limb = senses.limbs.get(limb).copied().unwrap_or_default();
        let [own_1, own_2, own_3, own_4] = own;
        let [front_1, front_2, front_3, front_4] = front;
        let [rear_1, rear_2, rear_3, rear_4] = rear;
        let [sine, cosine] = beat(periods, limb as f32 * self.genes.lag_rad);
        [
            own_1,
            own_2,
            own_3,
            own_4,
            front_1,
            front_2,
            front_3,
            front_4,
            rear_1,
            rear_2,
            rear_3,
            rear_4,
            joint.bend,
            joint.bend_rate,
            of_limb.touch,
            of_limb.load,
            of_limb.blocked,
            of_limb.pitch,
            of_limb.gap,
            of_limb.step_up,
            sine,
            cosine,
        ]
    }
}

impl Controller for LimbNeuronController {
    fn needs(&self) -> Senses {
        Senses::ALL
    }

    fn act(&mut self, observation: &Observation, torques: &mut [JointTorque]) {
        let periods = observation.periods(self.genes.frequency_hz);
        for limb in 0..self.outputs.len() {
            let values = self.values(limb, observation, periods);
            if let Some(neurons) = self.genes.of_limb(limb) {
                self.next[limb] = neurons.map(|neuron| neuron.respond(&values));
            }
        }
        std::mem::swap(&mut self.outputs, &mut self.next);
        let ServoGenes { bend_range_rad, twist_range_rad, .. } = self.genes.servo;
        let targets = self
            .outputs
            .iter()
            .take(self.genes.joints as usize)
            .map(|[bend, twist, ..]| [bend * bend_range_rad, twist * twist_range_rad]);
        self.servo.pull(observation, targets, torques);
    }

    /// Shows the neurons of all limbs. Outputs among the values are those that are read in the next step.
    fn activity(&self, observation: &Observation, _joint: usize) -> Option<Activity> {
        self.limbs(observation).map(Activity::Limbs)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::control::perception::{JointSenses, LimbSenses};
    use crate::genome::controllers::{LimbNeuron, NeuronInput, NeuronKind, NeuronSource};
    use crate::genome::{ControllerGenes, ControllerKind, GenomeSpace};
    use crate::rng::{Purpose, stream};
    use crate::score::Trial;

    /// Returns random neurons: the same in all limbs, or own ones in each.
    pub fn random(is_shared: bool) -> LimbNeurons {
        let controller = ControllerKind::LimbNeurons;
        let mut space = GenomeSpace { controller, ..GenomeSpace::default() };
        space.network.limb_neurons_shared = is_shared;
        let mut rng = stream(1, 1, 0, Purpose::Birth);
        let genome = space.random_genome(Trial::default().genome_shape(), &mut rng);
        let ControllerGenes::LimbNeurons(genes) = genome.controller else { panic!("neurons") };
        genes
    }

    /// Returns an observation of a snake of five limbs that senses nothing.
    pub fn standing() -> Observation {
        let mut observation = Observation { steps_per_s: 60, ..Observation::default() };
        observation.joints = vec![Default::default(); 4];
        observation.perception.joints = vec![JointSenses::default(); 4];
        observation.perception.limbs = vec![LimbSenses::default(); 5];
        observation
    }

    /// Returns a tanh neuron that reads one value.
    fn relay(source: NeuronSource) -> LimbNeuron {
        let unused = NeuronInput { source: NeuronSource::Own1, weight: 0.0 };
        let inputs = [NeuronInput { source, weight: 1.0 }, unused, unused];
        LimbNeuron { kind: NeuronKind::Tanh, bias: 0.0, inputs }
    }

    /// Returns the outputs after each of four steps while only this limb touches.
    fn outputs_after_touch(limb: usize, neurons: [LimbNeuron; 4]) -> Vec<Vec<[f32; 4]>> {
        let mut genes = random(true);
        genes.limbs = vec![neurons];
        let mut observation = standing();
        observation.perception.limbs[limb].touch = 1.0;
        let mut controller = LimbNeuronController::new(genes);
        let mut torques = [JointTorque::default(); 4];
        let step = |_| {
            controller.act(&observation, &mut torques);
            controller.outputs.clone()
        };
        (0..4).map(step).collect()
    }

    #[test]
    fn a_touch_travels_one_limb_a_step_and_absent_neighbours_are_silent() {
        use NeuronSource::{Front1, Front3, Rear2, Rear4, Touch};
        // The first neuron passes the touch on backwards, the second forwards; the others read both.
        let mut back = relay(Front1);
        back.inputs[1] = NeuronInput { source: Touch, weight: 1.0 };
        let mut ahead = relay(Rear2);
        ahead.inputs[1] = NeuronInput { source: Touch, weight: 1.0 };
        let neurons = [back, ahead, relay(Front3), relay(Rear4)];
        for (limb, channel) in [(0, 0), (4, 1)] {
            for (step, outputs) in outputs_after_touch(limb, neurons).into_iter().enumerate() {
                for (index, output) in outputs.iter().enumerate() {
                    let distance = index.abs_diff(limb);
                    assert_eq!(output[channel] != 0.0, distance <= step, "limb {index} at {step}");
                    // Only a neighbouring limb could make these neurons respond.
                    assert_eq!(output[2..], [0.0; 2]);
                }
            }
        }
    }

    #[test]
    fn the_neighbours_of_the_ends_are_zero_even_if_every_other_neuron_fires() {
        let mut genes = random(true);
        genes.limbs[0].iter_mut().for_each(|neuron| {
            *neuron = LimbNeuron { kind: NeuronKind::Step, bias: 1.0, ..relay(NeuronSource::Own1) };
        });
        let mut controller = LimbNeuronController::new(genes);
        assert_eq!(controller.values(2, &standing(), 0.0)[..12], [0.0; 12], "at the start");
        controller.act(&standing(), &mut [JointTorque::default(); 4]);
        for (limb, expected) in [(0, [1.0, 0.0, 1.0]), (2, [1.0; 3]), (4, [1.0, 1.0, 0.0])] {
            let values = controller.values(limb, &standing(), 0.0);
            for (part, expected) in values[..12].chunks_exact(4).zip(expected) {
                assert_eq!(part, [expected; 4], "limb {limb}");
            }
        }
    }

    #[test]
    fn equal_sets_for_each_limb_act_as_one_set_for_all() {
        let shared = random(true);
        let mut own = shared.clone();
        own.limbs = vec![shared.limbs[0]; 5];
        let trial = Trial::default();
        let torques = |genes: LimbNeurons| {
            let mut controller = LimbNeuronController::new(genes);
            let mut observation = standing();
            let mut torques = [JointTorque::default(); 4];
            for step in 0..trial.physics.steps_per_s {
                observation.step = step;
                observation.perception.limbs[step as usize % 5].touch = 1.0;
                controller.act(&observation, &mut torques);
            }
            torques.map(|torque| [torque.bend_nm.to_bits(), torque.twist_nm.to_bits()])
        };
        assert_eq!(torques(shared), torques(own));
    }
}
