//! The controller with the neurons of a creature.

use super::{Controller, Observation, Perception, SenseKind, Senses};
use crate::genome::controllers::{
    NeuronMoment, NeuronState, PartInput, PartNeuron, PartNeurons, PartSense, PartSource,
};
use crate::genome::{Genome, GrownPart, grow};
use crate::world::{BodyPlan, JointTorque};

/// Number of updates of the neurons in a physics step, after Sims (1994).
const UPDATES: u32 = 2;
/// Time constant with which the torques follow the neurons, in s: four steps of a sixtieth, so that a neuron that switches does not hit
/// its joint like a hammer.
const SMOOTH_S: f32 = 4.0 / 60.0;

/// Computes the neurons of all parts, step after step.
#[derive(Debug, Clone)]
pub struct PartNeuronController {
    genes: PartNeurons,
    parts: Vec<NervousPart>,
    /// Outputs of the neurons of each part, followed by those of the shared neurons.
    outputs: Vec<Vec<f64>>,
    /// Outputs of the present update: working memory.
    next: Vec<Vec<f64>>,
    states: Vec<Vec<NeuronState>>,
    /// Greatest torques of each joint about its bend and its twist axis, in N·m.
    most_nm: Vec<[f32; 2]>,
    /// Torques of the last step as shares of the greatest torques, one pair for each joint.
    shares: Vec<[f32; 2]>,
}

/// A part with the data that its neurons need.
#[derive(Debug, Clone)]
struct NervousPart {
    node: usize,
    parent: Option<usize>,
    children: Vec<usize>,
    /// Sign of the part's twists and sideways senses: -1 in a mirror image, so that it moves like the mirror image of the original.
    side: f32,
}

impl PartNeuronController {
    /// Creates the controller of a genome with this body before the first step, with all outputs 0.
    pub fn new(genes: PartNeurons, genome: &Genome, body: &BodyPlan) -> Self {
        let grown = grow(&genome.body.nodes);
        let part = |(index, part): (usize, &GrownPart)| NervousPart {
            node: part.node,
            parent: part.parent,
            children: (0..grown.len())
                .filter(|child| grown[*child].parent == Some(index))
                .collect(),
            side: if part.is_mirrored { -1.0 } else { 1.0 },
        };
        let parts: Vec<NervousPart> = grown.iter().enumerate().map(part).collect();
        let count =
            |part: &NervousPart| genes.nodes.get(part.node).map_or(0, |of| of.neurons.len());
        let counts = parts.iter().map(count).chain([genes.shared.len()]);
        let outputs: Vec<Vec<f64>> = counts.map(|count| vec![0.0; count]).collect();
        Self {
            states: outputs.iter().map(|of| vec![NeuronState::default(); of.len()]).collect(),
            shares: vec![[0.0; 2]; body.joints.len()],
            most_nm: body
                .joints
                .iter()
                .map(|of| [of.max_bend_torque_nm, of.max_twist_torque_nm])
                .collect(),
            next: outputs.clone(),
            outputs,
            parts,
            genes,
        }
    }

    /// Returns the output of a neuron. An index beyond the end of the list continues from its start.
    fn output(&self, group: usize, index: u8) -> f64 {
        let outputs = &self.outputs[group];
        outputs.get(usize::from(index) % outputs.len().max(1)).copied().unwrap_or(0.0)
    }

    /// Returns the value of an input of a neuron of a part. A shared neuron reads the senses of the first part, and has neither parent nor
    /// children.
    fn value(&self, input: &PartInput, group: usize, senses: &Perception) -> f64 {
        let part = self.parts.get(group);
        let value = match input.source {
            PartSource::Sense(sense) => {
                let side = part.map_or(1.0, |part| part.side);
                let index = if part.is_some() { group } else { 0 };
                f64::from(sensed(senses, sense, index, side))
            }
            PartSource::Own(index) => self.output(group, index),
            PartSource::Shared(index) => self.output(self.parts.len(), index),
            PartSource::Parent(index) => {
                let parent = part.and_then(|part| part.parent);
                parent.map_or(0.0, |parent| self.output(parent, index))
            }
            PartSource::Children(index) => {
                let children = part.map_or(&[][..], |part| &part.children);
                let sum: f64 = children.iter().map(|&child| self.output(child, index)).sum();
                sum / children.len().max(1) as f64
            }
        };
        value * f64::from(input.weight)
    }

    /// Computes the outputs of all neurons from those of the last update.
    fn update(&mut self, observation: &Observation, update: u32) {
        let step_s = 1.0 / (f64::from(observation.steps_per_s.max(1)) * f64::from(UPDATES));
        let mut next = std::mem::take(&mut self.next);
        let mut states = std::mem::take(&mut self.states);
        for (group, outputs) in next.iter_mut().enumerate() {
            let neurons: &[PartNeuron] = match self.parts.get(group) {
                Some(part) => self.genes.nodes.get(part.node).map_or(&[], |of| &of.neurons),
                None => &self.genes.shared,
            };
            for ((neuron, output), state) in neurons.iter().zip(outputs).zip(&mut states[group]) {
                let mut inputs = [0.0; 3];
                for (slot, input) in inputs.iter_mut().zip(&neuron.inputs) {
                    *slot = self.value(input, group, &observation.perception);
                }
                inputs[0] += f64::from(neuron.bias);
                let frequency_hz = neuron.frequency_hz.unwrap_or(0.0);
                let since_step = f64::from(frequency_hz) * f64::from(update) * step_s;
                let periods = observation.periods(frequency_hz) + since_step;
                let moment = NeuronMoment { periods, step_s };
                *output = neuron.function.respond(inputs, moment, state);
            }
        }
        self.states = states;
        self.next = std::mem::replace(&mut self.outputs, next);
    }
}

/// Returns the value of a sense of a part. The index of the joint that holds the part is that of the part minus one. `side` is -1 for a
/// mirror image.
fn sensed(senses: &Perception, sense: PartSense, part: usize, side: f32) -> f32 {
    let joint = |kind| part.checked_sub(1).map_or(0.0, |joint| senses.value(kind, joint));
    match sense {
        PartSense::Bend => joint(SenseKind::Bend),
        PartSense::Twist => joint(SenseKind::Twist) * side,
        PartSense::BendRate => joint(SenseKind::BendRate),
        PartSense::TwistRate => joint(SenseKind::TwistRate) * side,
        PartSense::Touch => senses.value(SenseKind::Touch, part),
        PartSense::Load => senses.value(SenseKind::Load, part),
        PartSense::Blocked => senses.value(SenseKind::Blocked, part),
        PartSense::Pitch => senses.value(SenseKind::Pitch, part),
        PartSense::Roll => senses.value(SenseKind::Roll, part) * side,
        PartSense::Gap => senses.value(SenseKind::Gap, part),
        PartSense::StepUp => senses.value(SenseKind::StepUp, part),
        PartSense::Yaw => senses.value(SenseKind::Yaw, part) * side,
    }
}

impl Controller for PartNeuronController {
    fn needs(&self) -> Senses {
        Senses::ALL
    }

    fn act(&mut self, observation: &Observation, torques: &mut [JointTorque]) {
        for update in 0..UPDATES {
            self.update(observation, update);
        }
        let step_s = 1.0 / observation.steps_per_s.max(1) as f32;
        let taken = 1.0 - libm::expf(-step_s / SMOOTH_S);
        for (joint, torque) in torques.iter_mut().enumerate() {
            let Some(part) = self.parts.get(joint + 1) else { continue };
            let Some(of_node) = self.genes.nodes.get(part.node) else { continue };
            let wanted = [&of_node.bend, &of_node.twist].map(|effector| {
                let value = self.value(effector, joint + 1, &observation.perception);
                value.clamp(-1.0, 1.0) as f32
            });
            let shares = &mut self.shares[joint];
            for (share, wanted) in shares.iter_mut().zip([wanted[0], wanted[1] * part.side]) {
                *share += (wanted - *share) * taken;
            }
            let [most_bend_nm, most_twist_nm] = self.most_nm[joint];
            let [bend, twist] = *shares;
            *torque = JointTorque { bend_nm: bend * most_bend_nm, twist_nm: twist * most_twist_nm };
        }
    }
}
