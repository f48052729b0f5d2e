//! The controller with a grown network.

use super::network::{beat, servos};
use super::servo::JointServos;
use super::{Activity, Controller, NetworkActivity, NodeColumn, Observation, Senses};
use crate::genome::controllers::{GROWN_INPUTS, GrownGenes};
use crate::learn::neat::NetworkPlay;
use crate::world::JointTorque;

/// Computes a grown network. All nodes respond to the activities of the last step, so that cycles need no order.
#[derive(Debug, Clone)]
pub struct GrownController {
    genes: GrownGenes,
    servo: JointServos,
    network: NetworkPlay,
    inputs: Vec<f64>,
}

impl GrownController {
    /// Creates the controller before the first step, with all activities 0.
    pub fn new(genes: GrownGenes) -> Self {
        Self {
            servo: servos(&genes.servo),
            network: NetworkPlay::new(&genes.network),
            inputs: Vec::new(),
            genes,
        }
    }

    fn sense(&mut self, observation: &Observation) {
        let senses = &observation.perception;
        let limb = |index: usize| senses.limbs.get(index).copied().unwrap_or_default();
        let limbs = senses.limbs.len();
        let (head, middle, tail) = (limb(0), limb(limbs / 2), limb(limbs.saturating_sub(1)));
        let [sine, cosine] = beat(observation.periods(self.genes.frequency_hz), 0.0);
        let of_snake: [f32; GROWN_INPUTS.len()] = [
            head.gap,
            head.step_up,
            head.pitch,
            head.blocked,
            middle.gap,
            middle.step_up,
            middle.pitch,
            tail.pitch,
            senses.snake.speed_ahead,
            sine,
            cosine,
            1.0,
        ];
        self.inputs.clear();
        self.inputs.extend(senses.joints.iter().map(|joint| f64::from(joint.bend)));
        self.inputs.extend(senses.limbs.iter().map(|limb| f64::from(limb.touch)));
        self.inputs.extend(of_snake.map(f64::from));
    }
}

impl Controller for GrownController {
    fn needs(&self) -> Senses {
        Senses::ALL
    }

    fn act(&mut self, observation: &Observation, torques: &mut [JointTorque]) {
        self.sense(observation);
        let range_rad = self.genes.servo.bend_range_rad;
        let outputs = self.network.tick(&self.inputs);
        // An output from 0 to 1 becomes a bend to either side.
        let targets = outputs.iter().map(|output| [(2.0 * output - 1.0) as f32 * range_rad, 0.0]);
        self.servo.pull(observation, targets, torques);
    }

    fn activity(&self, _observation: &Observation, _joint: usize) -> Option<Activity> {
        if self.inputs.is_empty() {
            return None;
        }
        let genome = &self.genes.network;
        let (inputs, joints) = (usize::from(genome.inputs), self.genes.joints as usize);
        let mut shown = NetworkActivity::default();
        let mut ids = Vec::new();
        for (index, (id, value)) in self.network.activations().enumerate() {
            let value = value as f32;
            ids.push(id);
            match index.checked_sub(inputs) {
                None => shown.add(NodeColumn::Input, GrownGenes::input_name(index, joints), value),
                Some(output) if output < joints => {
                    let name = format!("joint {} bend target", output + 1);
                    shown.add_sigmoid(NodeColumn::Output, name, value);
                }
                Some(hidden) => {
                    let name = format!("hidden {}", hidden - joints + 1);
                    shown.add_sigmoid(NodeColumn::Hidden, name, value);
                }
            }
        }
        for link in genome.links.iter().filter(|link| link.enabled) {
            // Ids are in ascending order.
            let ends = [link.from, link.to].map(|id| ids.binary_search(&id).ok());
            if let [Some(from), Some(to)] = ends {
                shown.link(from, to, link.weight);
            }
        }
        Some(Activity::Network(shown))
    }
}
