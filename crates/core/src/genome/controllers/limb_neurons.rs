//! Neurons in the limbs, wired among themselves, to those of the neighbouring limbs, to senses and to a beat.
//!
//! After Miconi and Channon, *A virtual creatures model for studies in artificial evolution*, CEC 2005, pp. 565-572, whose
//! abstract says that standard McCulloch-Pitts neurons replace the more complex set of neurons of Sims' creatures. Their
//! creatures evolve bodies, too; the layout for a body that stays, with its numbers, is this program's own.
//!
//! What a neuron is and reads are choices, and every strategy searches them as coordinates: a step of CMA-ES or MAP-Elites
//! across the border between two choices changes the wiring, although neighbours in the list have nothing in common. The
//! report's strategy keeps the choices of the first generation. Only mutations of the genetic algorithm, and of novelty
//! search, which is one, have rules for them.

use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::encoding::{ControllerEncoding, ControllerInfo};
use super::neuron::LimbNeuron;
use super::servo::ServoGenes;
use crate::check::{Invalid, within};
use crate::genome::gene::{Gene, GeneRange, GeneVisitor, GenomeShape};
use crate::genome::space::GenomeSpace;
use crate::genome::wave_space::FREQUENCY_RANGE_HZ;

/// Neurons of each limb. The first drives the bend target of the joint behind the limb, the second the twist target.
pub const LIMB_NEURONS: usize = 4;

/// Four neurons in each limb. All neurons respond at once, to what they said in the step before; at the start all are 0,
/// and so are those of a neighbour that is not there.
///
/// A step of theirs is a step of the physics, so what they do by themselves becomes faster with more steps per second; the
/// beat does not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LimbNeurons {
    /// Number of joints. There is one limb more, and each has its neurons.
    pub joints: u32,
    /// The servos that follow the targets.
    pub servo: ServoGenes,
    /// Frequency of the beat, in Hz.
    pub frequency_hz: f32,
    /// Delay of the beat from each limb to the next, in radians.
    pub lag_rad: f32,
    /// The neurons: those of all limbs, or those of each limb, head first.
    pub limbs: Vec<[LimbNeuron; LIMB_NEURONS]>,
}

impl LimbNeurons {
    /// The neurons of a limb; 0 is the head.
    pub fn of_limb(&self, limb: usize) -> Option<&[LimbNeuron; LIMB_NEURONS]> {
        self.limbs.get(limb).or(self.limbs.first())
    }

    /// Number of limbs.
    pub fn limb_count(&self) -> usize {
        (self.joints as usize).saturating_add(1)
    }

    fn neurons(&self) -> impl Iterator<Item = &LimbNeuron> {
        self.limbs.iter().flatten()
    }
}

impl ControllerEncoding for LimbNeurons {
    fn info() -> &'static ControllerInfo {
        &ControllerInfo {
            name: "limb_neurons",
            title: "Limb neurons",
            words: "Four neurons in each limb, wired to one another, to the neighbouring limbs and to senses.",
            senses_surroundings: true,
            settings: &[
                "wave.frequency_min_hz",
                "wave.frequency_max_hz",
                "wave.angle_range_rad",
                "wave.twist_range_rad",
                "wave.stiffness_min_nm_per_rad",
                "wave.stiffness_max_nm_per_rad",
                "wave.servo_damping_nms_per_rad",
                "network.weight_range",
                "network.limb_neurons_shared",
            ],
        }
    }

    fn zeroed(space: &GenomeSpace, shape: GenomeShape) -> Self {
        let sets = if space.network.limb_neurons_shared { 1 } else { shape.joints + 1 };
        Self {
            joints: shape.joints as u32,
            servo: ServoGenes::zeroed(space),
            frequency_hz: 1.0,
            lag_rad: 0.0,
            limbs: vec![[LimbNeuron::ZEROED; LIMB_NEURONS]; sets],
        }
    }

    fn genes(&mut self, space: &GenomeSpace, visit: GeneVisitor<'_>) {
        self.servo.genes(space, visit);
        space.wave.frequency_gene(&mut self.frequency_hz, visit);
        let (field, name) = (format_args!("lag_rad"), format_args!("lag per limb"));
        visit(Gene { field, name, unit: "rad", range: GeneRange::Turn }, &mut self.lag_rad);
        let most = space.network.weight_range;
        let is_shared = self.limbs.len() == 1;
        for (limb, neurons) in self.limbs.iter_mut().enumerate() {
            let part = if is_shared { String::new() } else { format!("limb {} ", limb + 1) };
            for (index, neuron) in neurons.iter_mut().enumerate() {
                let field = format_args!("limbs[{limb}][{index}]");
                neuron.genes(field, format_args!("{part}neuron {}", index + 1), most, visit);
            }
        }
    }

    fn lengths(&self, visit: &mut dyn FnMut(&'static str, usize)) {
        visit("limbs with neurons of their own", self.limbs.len());
    }

    fn joints(&self) -> usize {
        self.joints as usize
    }

    fn frequency_hz(&self) -> f32 {
        self.frequency_hz
    }

    fn check(&self) -> Result<(), Invalid> {
        let inside = |error: Invalid| error.inside("limb_neurons");
        self.servo.check().map_err(inside)?;
        within("frequency_hz", self.frequency_hz, FREQUENCY_RANGE_HZ).map_err(inside)?;
        within("lag_rad", self.lag_rad, -10.0..=10.0).map_err(inside)?;
        let (sets, limbs) = (self.limbs.len(), self.limb_count());
        if sets != 1 && sets != limbs {
            return Err(inside(Invalid::new("limbs", sets, format!("1 or {limbs}"))));
        }
        for (limb, neurons) in self.limbs.iter().enumerate() {
            for (index, neuron) in neurons.iter().enumerate() {
                neuron.check(&format!("limbs[{limb}][{index}]")).map_err(inside)?;
            }
        }
        Ok(())
    }

    fn widen(&self, space: &mut GenomeSpace) {
        self.servo.widen(space);
        space.wave.widen_frequency(self.frequency_hz);
        let network = &mut space.network;
        network.limb_neurons_shared = self.limbs.len() == 1;
        let weights = self.neurons().flat_map(LimbNeuron::weights);
        network.weight_range = weights.map(f32::abs).fold(network.weight_range, f32::max);
    }

    /// A neuron's genes mutate by chance, independently of its neighbours' genes.
    fn after_mutation(&mut self, before: &[f32], space: &GenomeSpace, rng: &mut ChaCha8Rng) {
        let (mut parent, mut values) = (self.clone(), before.iter());
        parent.genes(space, &mut |_, value| *value = values.next().copied().unwrap_or(*value));
        let most = space.network.weight_range;
        for (neuron, before) in self.limbs.iter_mut().flatten().zip(parent.neurons()) {
            neuron.mutate(before, most, rng);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::controllers::{NeuronKind, NeuronSource};
    use crate::genome::{ControllerGenes, ControllerKind, Genome};
    use crate::rng::{Purpose, stream};

    const SHAPE: GenomeShape = GenomeShape { joints: 4, duration_s: 2.0 };

    fn space(is_shared: bool) -> GenomeSpace {
        let controller = ControllerKind::LimbNeurons;
        let mut space = GenomeSpace { controller, ..GenomeSpace::default() };
        space.network.limb_neurons_shared = is_shared;
        space
    }

    fn genes(genome: &mut Genome) -> &mut LimbNeurons {
        match &mut genome.controller {
            ControllerGenes::LimbNeurons(genes) => genes,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_snake_has_one_set_of_neurons_or_one_for_each_limb() {
        for (is_shared, sets) in [(true, 1), (false, 5)] {
            let space = space(is_shared);
            let mut genome = space.random_genome(SHAPE, &mut stream(1, 1, 0, Purpose::Birth));
            assert_eq!(genes(&mut genome).limbs.len(), sets);
            // Three of the body, stiffness, frequency and lag.
            assert_eq!(space.dimension(SHAPE), 6 + sets * 4 * 8);
            genome.controller.check().expect("its own");
            let other = self::space(!is_shared);
            let error = other.check_genome(&genome, SHAPE).expect_err("refused");
            assert_eq!(error.field, "limbs with neurons of their own");
            other.widened_for(&genome).check_genome(&genome, SHAPE).expect("widened");
        }
    }

    #[test]
    fn files_name_kinds_and_sources_and_refuse_others() {
        let mut genome = space(true).zeroed(SHAPE);
        let neuron = &mut genes(&mut genome).limbs[0][1];
        neuron.kind = NeuronKind::Tanh;
        neuron.inputs[2].source = NeuronSource::BeatCosine;
        let text = ron::to_string(&genome.controller).expect("written");
        assert!(
            text.contains("(kind:tanh,bias:0") && text.contains("source:beat_cosine"),
            "{text}"
        );
        assert_eq!(ron::from_str::<ControllerGenes>(&text).expect("read"), genome.controller);
        for (good, bad) in [("kind:tanh", "kind:cosine"), ("beat_cosine", "own9")] {
            let refused = ron::from_str::<ControllerGenes>(&text.replace(good, bad));
            assert!(refused.is_err(), "{bad}");
        }
    }

    #[test]
    fn hostile_genes_are_refused_with_their_place() {
        let refusal = |change: fn(&mut LimbNeurons)| {
            let mut rng = stream(1, 1, 0, Purpose::Birth);
            let mut genome = space(false).random_genome(SHAPE, &mut rng);
            change(genes(&mut genome));
            genome.controller.check().expect_err("refused").to_string()
        };
        for (change, message) in [
            (
                (|genes| genes.limbs[4][1].bias = f32::NAN) as fn(&mut LimbNeurons),
                "limb_neurons.limbs[4][1].bias is NaN; allowed: -100 to 100",
            ),
            (
                |genes| genes.limbs[0][3].inputs[2].weight = f32::INFINITY,
                "limb_neurons.limbs[0][3].inputs[2].weight is inf; allowed: -100 to 100",
            ),
            (|genes| genes.limbs.truncate(3), "limb_neurons.limbs is 3; allowed: 1 or 5"),
            (|genes| genes.limbs.clear(), "limb_neurons.limbs is 0; allowed: 1 or 5"),
            (
                |genes| genes.frequency_hz = -1.0,
                "limb_neurons.frequency_hz is -1; allowed: 0.01 to 20",
            ),
            (|genes| genes.lag_rad = 99.0, "limb_neurons.lag_rad is 99; allowed: -10 to 10"),
        ] {
            assert_eq!(refusal(change), message);
        }
    }
}
