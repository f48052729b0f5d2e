//! Neurons in the limbs. Their inputs are neurons of the same limb and of the neighbouring limbs, senses, and a beat.
//!
//! The model follows Miconi and Channon, *A virtual creatures model for studies in artificial evolution*, CEC 2005, pp. 565-572, whose
//! abstract says that standard McCulloch-Pitts neurons replace the more complex set of neurons of Sims' creatures. Their creatures evolve
//! bodies, too. The layout for a body that does not evolve, with its numbers, is this program's own.
//!
//! The kind of a neuron and its inputs are choices. Every strategy searches them as coordinates: a step of CMA-ES or MAP-Elites across the
//! border between two choices changes the wiring, although neighbours in the list have nothing in common. The report's strategy keeps the
//! choices of the first generation. Only mutations of the genetic algorithm, and of novelty search, which is a genetic algorithm, have
//! rules for choices.

use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::encoding::{
    ControllerEncoding, FREQUENCY_SETTINGS, LengthVisitor, SERVO_SETTINGS, SettingNames,
    TWIST_SETTINGS, widen_weights,
};
use super::neuron::LimbNeuron;
use super::servo::ServoGenes;
use crate::check::Invalid;
use crate::genome::gene::{Gene, GeneRange, Genes, GenomeShape};
use crate::genome::limits::PHASE;
use crate::genome::space::GenomeSpace;

/// Number of neurons in each limb. The first drives the bend target of the joint behind the limb, the second its twist target.
pub const LIMB_NEURONS: usize = 4;

/// Four neurons in each limb. All neurons are updated at once, from the outputs of the step before. At the start all outputs are 0, and so
/// are those of a neighbouring limb that does not exist.
///
/// Neurons are updated once per physics step. What they do by themselves therefore becomes faster with more steps per second; the beat
/// does not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LimbNeurons {
    /// Number of joints. There is one limb more than joints, and each limb has neurons.
    pub joints: u32,
    /// Servos that turn the joints to their targets.
    pub servo: ServoGenes,
    /// Frequency of the beat, in Hz.
    pub frequency_hz: f32,
    /// Delay of the beat from each limb to the next, in radians.
    pub lag_rad: f32,
    /// Neurons: one set that all limbs have in common, or one set per limb, from the head.
    pub limbs: Vec<[LimbNeuron; LIMB_NEURONS]>,
}

impl LimbNeurons {
    /// Returns the neurons of a limb; 0 is the head.
    pub fn of_limb(&self, limb: usize) -> Option<&[LimbNeuron; LIMB_NEURONS]> {
        self.limbs.get(limb).or(self.limbs.first())
    }

    /// Returns the number of limbs.
    pub fn limb_count(&self) -> usize {
        (self.joints as usize).saturating_add(1)
    }

    fn neurons(&self) -> impl Iterator<Item = &LimbNeuron> {
        self.limbs.iter().flatten()
    }
}

impl ControllerEncoding for LimbNeurons {
    fn settings() -> SettingNames {
        &[
            FREQUENCY_SETTINGS,
            SERVO_SETTINGS,
            TWIST_SETTINGS,
            &["network.weight_range", "network.limb_neurons_shared"],
        ]
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

    fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        self.servo.genes(space, genes);
        space.wave.frequency_gene(&mut self.frequency_hz, genes);
        genes.gene("lag_rad", "lag per limb", PHASE, GeneRange::Turn, &mut self.lag_rad);
        let weights = space.network.weights();
        let is_shared = self.limbs.len() == 1;
        for (limb, neurons) in self.limbs.iter_mut().enumerate() {
            let part = if is_shared { String::new() } else { format!("limb {} ", limb + 1) };
            for (index, neuron) in neurons.iter_mut().enumerate() {
                let field = format_args!("limbs[{limb}][{index}].");
                let name = format_args!("{part}neuron {}, ", index + 1);
                genes.inside(field, name, |genes| neuron.genes(weights, genes));
            }
        }
    }

    fn lengths(&self, visit: LengthVisitor<'_>) {
        let limbs = self.limb_count();
        visit(format_args!("limbs"), self.limbs.len(), 1..=limbs);
    }

    fn joints(&self) -> usize {
        self.joints as usize
    }

    fn check_rest(&self) -> Result<(), Invalid> {
        match (self.limbs.len(), self.limb_count()) {
            (sets, limbs) if sets == 1 || sets == limbs => Ok(()),
            (sets, limbs) => Err(Invalid::new("limbs", sets, format!("1 or {limbs}"))),
        }
    }

    fn widen(&self, space: &mut GenomeSpace) {
        self.servo.widen(space);
        space.network.limb_neurons_shared = self.limbs.len() == 1;
        widen_weights(&mut space.network.weight_range, self);
    }

    /// Lets the genes of each neuron mutate by chance, independently of the genes of other neurons.
    fn after_mutation(&mut self, before: &[f32], space: &GenomeSpace, rng: &mut ChaCha8Rng) {
        let (mut parent, mut values) = (self.clone(), before.iter());
        let mut take =
            |_: Gene<'_>, value: &mut f32| *value = values.next().copied().unwrap_or(*value);
        parent.genes(space, &mut Genes::to(&mut take));
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
            // Three genes belong to the body, and one each to stiffness, frequency and lag.
            assert_eq!(space.dimension(SHAPE), 6 + sets * 4 * 8);
            genome.controller.check().expect("its own");
            let other = self::space(!is_shared);
            let error = other.check_genome(&genome, SHAPE).expect_err("refused");
            assert_eq!(error.field, "limbs");
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
}
