//! The state of a controller at a moment, for display. It does not influence the simulation.

use super::{DecisionActivity, LimbActivity, WaveChoiceActivity};
use crate::genome::controllers::Layer;

/// The state of a controller, by its kind.
#[derive(Debug, Clone, PartialEq)]
pub enum Activity {
    /// Neurons of a network.
    Network(NetworkActivity),
    /// Decision among postures.
    Decision(DecisionActivity),
    /// Reflexes of a joint.
    Reflex(ReflexActivity),
    /// Waves chosen by rules.
    Waves(WaveChoiceActivity),
    /// Neurons of all limbs.
    Limbs(LimbActivity),
}

/// The neurons of a network, and the links between them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NetworkActivity {
    /// Joint that has this network, if each joint has one; the first joint is 0. `None` for a network of the whole snake.
    pub joint: Option<usize>,
    /// Neurons and inputs of the network.
    pub nodes: Vec<NetworkNode>,
    /// Links of the network, without those of weight 0.
    pub links: Vec<NetworkLink>,
}

/// An input or a neuron of a network.
#[derive(Debug, Clone, PartialEq)]
pub struct NetworkNode {
    /// Name of the node, in lower case.
    pub name: String,
    /// Column of the node in the network.
    pub column: NodeColumn,
    /// Activity of the node.
    pub value: f32,
    /// Activity of the node, scaled to -1 to 1, where 0 is the middle of its range.
    pub level: f32,
}

/// The column of a node in the drawing of a network.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NodeColumn {
    /// The node is an input.
    Input,
    /// The node lies between inputs and outputs.
    Hidden,
    /// The node is an output.
    Output,
}

/// A link from one node to another, by their indices in the list of nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NetworkLink {
    /// Index of the node at which the link begins.
    pub from: usize,
    /// Index of the node at which the link ends.
    pub to: usize,
    /// Factor on the signal.
    pub weight: f32,
}

/// The effect of the senses on the bend target of a joint.
#[derive(Debug, Clone, PartialEq)]
pub struct ReflexActivity {
    /// Index of the joint; the first is 0.
    pub joint: usize,
    /// Contribution of each sense to the weighted sum.
    pub pushes: Vec<ReflexPush>,
    /// Angle by which the senses together move the target, in radians.
    pub moved_rad: f32,
    /// Largest angle by which the senses can move the target, in radians.
    pub reach_rad: f32,
    /// Shift of the phase of the joint's wave since the start, in radians.
    pub shift_rad: f32,
}

/// The contribution of a sense to a reflex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReflexPush {
    /// Name of the sense.
    pub name: &'static str,
    /// Value of the sense.
    pub value: f32,
    /// Value of the sense times its weight.
    pub push: f32,
}

impl NetworkActivity {
    /// Adds a node. Its level is its activity, clamped to -1 to 1.
    pub(super) fn add(&mut self, column: NodeColumn, name: impl Into<String>, value: f32) {
        let level = value.clamp(-1.0, 1.0);
        self.nodes.push(NetworkNode { name: name.into(), column, value, level });
    }

    /// Adds a neuron whose activity ranges from 0 to 1.
    pub(super) fn add_sigmoid(&mut self, column: NodeColumn, name: impl Into<String>, value: f32) {
        let level = (2.0 * value - 1.0).clamp(-1.0, 1.0);
        self.nodes.push(NetworkNode { name: name.into(), column, value, level });
    }

    /// Adds a link, unless its weight is 0.
    pub(super) fn link(&mut self, from: usize, to: usize, weight: f32) {
        if weight != 0.0 {
            self.links.push(NetworkLink { from, to, weight });
        }
    }

    /// Adds the links of a layer. `from` is the index of its first input, `to` that of its first neuron.
    pub(super) fn link_layer(&mut self, layer: &Layer, from: usize, to: usize) {
        for (neuron, row) in layer.rows.iter().enumerate() {
            for (input, weight) in row.iter().take(layer.inputs()).enumerate() {
                self.link(from + input, to + neuron, *weight);
            }
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::genome::{ControllerKind, Genome};
    use crate::rng::{Purpose, stream};
    use crate::save::load_preset;
    use crate::score::Rollout;

    /// Returns the rollout of a random genome of a kind, after a change of the genome and this number of steps.
    pub fn played(kind: ControllerKind, steps: u32, change: impl Fn(&mut Genome)) -> Rollout {
        let mut settings = load_preset("climb").expect("shipped").settings;
        settings.genome.controller = kind;
        let mut rng = stream(1, 1, 3, Purpose::Birth);
        let shape = settings.trial.genome_shape();
        let mut genome = settings.genome.random_genome(shape, &mut rng);
        change(&mut genome);
        let mut rollout = Rollout::new(&genome, &settings.trial);
        (0..steps).for_each(|_| assert!(rollout.advance()));
        rollout
    }

    #[test]
    fn the_networks_show_their_neurons_once_there_was_a_step() {
        for (kind, inputs, joint) in [
            (ControllerKind::Modular, 18, Some(2)),
            (ControllerKind::Central, 62, None),
            (ControllerKind::Ctrnn, 13, Some(2)),
            (ControllerKind::Grown, 21, None),
        ] {
            assert_eq!(played(kind, 0, |_| ()).activity(2), None, "{kind}");
            let rollout = played(kind, 20, |_| ());
            let Some(Activity::Network(network)) = rollout.activity(2) else { panic!("{kind}") };
            let of = |column| network.nodes.iter().filter(|node| node.column == column).count();
            assert_eq!((of(NodeColumn::Input), network.joint), (inputs, joint), "{kind}");
            assert!(network.nodes.iter().all(|node| !node.name.is_empty()), "{kind}");
            assert!(network.nodes.iter().any(|node| node.level != 0.0), "{kind}");
            let ends = network.links.iter().flat_map(|link| [link.from, link.to]);
            assert!(ends.max().is_none_or(|last| last < network.nodes.len()), "{kind}");
            let is_named = |word: &str| network.nodes.iter().any(|node| node.name.contains(word));
            assert!(is_named("step up"), "{kind}");
        }
    }

    #[test]
    fn the_pushes_of_a_reflex_add_up_to_the_angle_by_which_it_moves_the_target() {
        let rollout = played(ControllerKind::Reflex, 20, |_| ());
        let Some(Activity::Reflex(reflex)) = rollout.activity(1) else { panic!("a reflex") };
        let sum: f32 = reflex.pushes.iter().map(|push| push.push).sum();
        assert!((reflex.moved_rad - reflex.reach_rad * libm::tanhf(sum)).abs() < 1e-5);
        assert!(reflex.pushes.iter().any(|push| push.push != 0.0));
    }
}
