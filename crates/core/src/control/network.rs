//! The controllers with networks of tanh neurons: one network for each joint, or one for the whole snake.

use super::perception::Perception;
use super::servo::JointServos;
use super::{Activity, Controller, NetworkActivity, NodeColumn, Observation, Senses};
use crate::genome::controllers::{
    CentralNetwork, MODULE_INPUTS, MODULE_OUTPUTS, ModularNetwork, ServoGenes, tanh_each,
};
use crate::world::JointTorque;

/// Creates the servos of a network's genes.
pub(super) fn servos(genes: &ServoGenes) -> JointServos {
    JointServos::new(genes.stiffness_nm_per_rad, genes.damping_nms_per_rad)
}

/// Returns the place of a joint along the body, from -1 at the head to 1 at the tail; 0 for a single joint.
pub(super) fn place(joint: usize, joints: usize) -> f32 {
    if joints < 2 { 0.0 } else { 2.0 * joint as f32 / (joints - 1) as f32 - 1.0 }
}

/// Returns the sine and cosine of a beat after this many periods, delayed by an angle in radians.
pub(super) fn beat(periods: f64, delay_rad: f32) -> [f32; 2] {
    let (sine, cosine) = libm::sincos(std::f64::consts::TAU * periods - f64::from(delay_rad));
    [sine as f32, cosine as f32]
}

/// Computes the same network at each joint.
#[derive(Debug, Clone)]
pub struct ModularController {
    genes: ModularNetwork,
    servo: JointServos,
    /// Activities of the hidden neurons of all modules, from the head.
    hidden: Vec<f32>,
    /// Activities of the output neurons of all modules, from the head.
    outputs: Vec<f32>,
}

impl ModularController {
    /// Creates the controller before the first step.
    pub fn new(genes: ModularNetwork) -> Self {
        let joints = genes.joints as usize;
        Self {
            servo: servos(&genes.servo),
            hidden: vec![0.0; joints * genes.hidden.neurons()],
            outputs: vec![0.0; joints * genes.outputs.neurons()],
            genes,
        }
    }

    /// Returns the inputs of a joint's module. Messages are those of the last step.
    fn inputs(
        &self,
        joint: usize,
        senses: &Perception,
        periods: f64,
    ) -> [f32; MODULE_INPUTS.len()] {
        let joints = senses.joints.len();
        let bend = |index: Option<usize>| {
            index.and_then(|index| senses.joints.get(index)).map_or(0.0, |joint| joint.bend)
        };
        let message = |index: Option<usize>| {
            let at = index.map(|index| index * self.genes.outputs.neurons() + 1);
            at.and_then(|at| self.outputs.get(at)).copied().unwrap_or(0.0)
        };
        let (own, ahead) = (senses.joints[joint], joint.checked_sub(1));
        let behind = Some(joint + 1).filter(|&behind| behind < joints);
        let (front, rear) = (senses.limbs[joint], senses.limbs[joint + 1]);
        let [sine, cosine] = beat(periods, joint as f32 * self.genes.lag_rad);
        [
            own.bend,
            own.bend_rate,
            own.twist,
            bend(ahead),
            bend(behind),
            front.touch,
            front.blocked,
            front.pitch,
            front.gap,
            front.step_up,
            rear.touch,
            rear.load,
            rear.pitch,
            place(joint, joints),
            message(ahead),
            message(behind),
            sine,
            cosine,
        ]
    }
}

impl Controller for ModularController {
    fn needs(&self) -> Senses {
        Senses::ALL
    }

    fn act(&mut self, observation: &Observation, torques: &mut [JointTorque]) {
        let periods = observation.periods(self.genes.frequency_hz);
        let senses = &observation.perception;
        // All modules read the messages of the last step before any of them writes.
        let (neurons, outputs) = (self.genes.hidden.neurons(), self.genes.outputs.neurons());
        for joint in 0..senses.joints.len() {
            let inputs = self.inputs(joint, senses, periods);
            let hidden = &mut self.hidden[joint * neurons..][..neurons];
            self.genes.hidden.weigh(&inputs, hidden);
        }
        tanh_each(&mut self.hidden);
        for (hidden, output) in
            self.hidden.chunks_exact(neurons).zip(self.outputs.chunks_exact_mut(outputs))
        {
            self.genes.outputs.weigh(hidden, output);
        }
        tanh_each(&mut self.outputs);
        let ServoGenes { bend_range_rad, twist_range_rad, .. } = self.genes.servo;
        let targets = self.outputs.chunks_exact(outputs).map(|output| {
            let twist = output.get(2).copied().unwrap_or(0.0);
            [output[0] * bend_range_rad, twist * twist_range_rad]
        });
        self.servo.pull(observation, targets, torques);
    }

    /// Shows the module of a joint. Messages among the inputs are those that are read in the next step.
    fn activity(&self, observation: &Observation, joint: usize) -> Option<Activity> {
        let senses = &observation.perception;
        senses.joints.get(joint)?;
        let inputs = self.inputs(joint, senses, observation.periods(self.genes.frequency_hz));
        let (neurons, outputs) = (self.genes.hidden.neurons(), self.genes.outputs.neurons());
        let mut shown = NetworkActivity { joint: Some(joint), ..NetworkActivity::default() };
        for (name, value) in MODULE_INPUTS.iter().zip(inputs) {
            shown.add(NodeColumn::Input, *name, value);
        }
        for (index, value) in self.hidden.iter().skip(joint * neurons).take(neurons).enumerate() {
            shown.add(NodeColumn::Hidden, format!("hidden {}", index + 1), *value);
        }
        let values = self.outputs.iter().skip(joint * outputs).take(outputs);
        for (name, value) in MODULE_OUTPUTS.iter().zip(values) {
            shown.add(NodeColumn::Output, *name, *value);
        }
        shown.link_layer(&self.genes.hidden, 0, inputs.len());
        shown.link_layer(&self.genes.outputs, inputs.len(), inputs.len() + neurons);
        Some(Activity::Network(shown))
    }
}

/// Computes one network for the whole snake.
#[derive(Debug, Clone)]
pub struct CentralController {
    genes: CentralNetwork,
    servo: JointServos,
    inputs: Vec<f32>,
    hidden: Vec<f32>,
    outputs: Vec<f32>,
}

impl CentralController {
    /// Creates the controller before the first step.
    pub fn new(genes: CentralNetwork) -> Self {
        Self {
            servo: servos(&genes.servo),
            inputs: Vec::new(),
            hidden: vec![0.0; genes.hidden.neurons()],
            outputs: vec![0.0; genes.outputs.neurons()],
            genes,
        }
    }
}

impl Controller for CentralController {
    fn needs(&self) -> Senses {
        Senses::ALL
    }

    fn act(&mut self, observation: &Observation, torques: &mut [JointTorque]) {
        let periods = observation.periods(self.genes.frequency_hz);
        self.inputs.clear();
        self.inputs.extend(observation.perception.values());
        self.inputs.extend(beat(periods, 0.0));
        self.genes.hidden.respond(&self.inputs, &mut self.hidden);
        self.genes.outputs.respond(&self.hidden, &mut self.outputs);
        let ServoGenes { bend_range_rad, twist_range_rad, .. } = self.genes.servo;
        let joints = self.genes.joints as usize;
        let targets = (0..joints).map(|joint| {
            let twist = self.outputs.get(joints + joint).copied().unwrap_or(0.0);
            [self.outputs[joint] * bend_range_rad, twist * twist_range_rad]
        });
        self.servo.pull(observation, targets, torques);
    }

    fn activity(&self, _observation: &Observation, _joint: usize) -> Option<Activity> {
        if self.inputs.is_empty() {
            return None;
        }
        let joints = self.genes.joints as usize;
        let senses = Perception::count(joints);
        let mut shown = NetworkActivity::default();
        for (index, value) in self.inputs.iter().enumerate() {
            let name = match index.checked_sub(senses) {
                None => Perception::name(index, joints),
                Some(0) => "beat, sine".to_owned(),
                Some(_) => "beat, cosine".to_owned(),
            };
            shown.add(NodeColumn::Input, name, *value);
        }
        for (index, value) in self.hidden.iter().enumerate() {
            shown.add(NodeColumn::Hidden, format!("hidden {}", index + 1), *value);
        }
        for (index, value) in self.outputs.iter().enumerate() {
            let axis = if index < joints { "bend" } else { "twist" };
            let name = format!("joint {} {axis} target", index % joints + 1);
            shown.add(NodeColumn::Output, name, *value);
        }
        let hidden = self.inputs.len();
        shown.link_layer(&self.genes.hidden, 0, hidden);
        shown.link_layer(&self.genes.outputs, hidden, hidden + self.hidden.len());
        Some(Activity::Network(shown))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::limb_neurons::tests::standing;
    use crate::genome::{ControllerGenes, ControllerKind};
    use crate::score::Trial;

    fn modular() -> ModularNetwork {
        let genome = Trial::default().random_genome_of(ControllerKind::Modular, 0);
        let ControllerGenes::Modular(network) = genome.controller else { panic!("modular") };
        network
    }

    #[test]
    fn a_touch_at_the_head_reaches_the_tail_by_messages_one_joint_a_step() {
        let mut genes = modular();
        genes.frequency_hz = 0.01;
        // The weights are reduced, because saturated neurons would hide a small message.
        let rows = genes.hidden.rows.iter_mut().chain(&mut genes.outputs.rows);
        rows.flatten().for_each(|weight| *weight *= 0.25);
        let mut plain = ModularController::new(genes);
        let mut touched = plain.clone();
        let mut torques = [JointTorque::default(); 4];
        let (still, mut touch) = (standing(), standing());
        touch.perception.limbs[0].touch = 1.0;
        for steps in 1..=4 {
            plain.act(&still, &mut torques);
            touched.act(&touch, &mut torques);
            let outputs = plain.genes.outputs.neurons();
            let differ = |joint: usize| {
                let at = joint * outputs..(joint + 1) * outputs;
                plain.outputs[at.clone()] != touched.outputs[at]
            };
            let reached = (0..4).filter(|&joint| differ(joint)).count();
            assert_eq!(reached, steps, "after {steps} steps");
        }
    }

    #[test]
    fn places_run_from_the_head_to_the_tail() {
        assert_eq!([0, 1, 2].map(|joint| place(joint, 3)), [-1.0, 0.0, 1.0]);
        assert_eq!(place(0, 1), 0.0);
    }
}
