//! A gait with reflexes: the senses move the target angles and shift the phases of the waves.

use serde::{Deserialize, Serialize};

use super::encoding::{
    ControllerEncoding, FREQUENCY_SETTINGS, LengthVisitor, SERVO_SETTINGS, SettingNames,
    TWIST_SETTINGS, widen_weights,
};
use super::gait::Gait;
use super::servo::twists;
use crate::check::Invalid;
use crate::genome::gene::{GeneRange, Genes, GenomeShape, Quantity};
use crate::genome::limits::LIMIT;
use crate::genome::network_space::WEIGHT;
use crate::genome::space::GenomeSpace;

/// Names of the inputs of a joint's reflex about its bend or twist axis; the last one is the bias.
pub const REFLEX_INPUTS: [&str; 9] = [
    "own angle",
    "own rate",
    "front touch",
    "front blocked",
    "front gap",
    "front step up",
    "rear touch",
    "rear pitch",
    "bias",
];

/// A gait with reflexes. The senses move the target angles by `reach · tanh(Σ weight · sense)`, with the same weights for all joints. Load
/// and resistance shift the phases of the waves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReflexGait {
    /// The gait without reflexes.
    pub gait: Gait,
    /// Greatest angle by which the senses move a target, in radians.
    pub reach_rad: f32,
    /// Weights of the senses about the bend axes, in the order of [`REFLEX_INPUTS`].
    pub bend_weights: [f32; REFLEX_INPUTS.len()],
    /// Weights of the senses about the twist axes, in the order of [`REFLEX_INPUTS`].
    pub twist_weights: [f32; REFLEX_INPUTS.len()],
    /// Strength σ of the rule `dφ/dt = -σ N cos φ`, in rad/s, by which the load N of the limb behind a joint pulls the phase φ of the
    /// joint's wave (Owaki, Kano, Nagasawa, Tero and Ishiguro, 2013).
    pub load_phase_rad_per_s: f32,
    /// Rate at which resistance ahead of a joint's front limb delays the phase of the joint's wave, in rad/s at full resistance.
    pub blocked_phase_rad_per_s: f32,
}

/// Quantity of a rate at which a phase is shifted.
const PHASE_RATE: Quantity = Quantity::new("rad/s", -60.0..=60.0);

impl ControllerEncoding for ReflexGait {
    fn settings() -> SettingNames {
        &[
            FREQUENCY_SETTINGS,
            SERVO_SETTINGS,
            TWIST_SETTINGS,
            &[
                "wave.harmonics",
                "network.reflex_weight_range",
                "network.reflex_reach_rad",
                "network.reflex_phase_rad_per_s",
            ],
        ]
    }

    fn zeroed(space: &GenomeSpace, shape: GenomeShape) -> Self {
        Self {
            gait: Gait::zeroed(space, shape),
            reach_rad: 0.0,
            bend_weights: [0.0; REFLEX_INPUTS.len()],
            twist_weights: [0.0; REFLEX_INPUTS.len()],
            load_phase_rad_per_s: 0.0,
            blocked_phase_rad_per_s: 0.0,
        }
    }

    fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        self.gait.genes_without_steering(space, genes);
        let network = &space.network;
        let range = GeneRange::Between(0.0, network.reflex_reach_rad);
        genes.gene("reach_rad", "reflex reach", LIMIT, range, &mut self.reach_rad);
        let most = network.reflex_weight_range;
        let twist = if twists(space) { most } else { 0.0 };
        for (axis, weights, most) in
            [("bend", &mut self.bend_weights, most), ("twist", &mut self.twist_weights, twist)]
        {
            let range = GeneRange::around_zero(most);
            for (index, (weight, input)) in weights.iter_mut().zip(REFLEX_INPUTS).enumerate() {
                let field = format_args!("{axis}_weights[{index}]");
                let name = format_args!("{axis} reflex from {input}");
                genes.gene(field, name, WEIGHT, range, weight);
            }
        }
        let range = GeneRange::around_zero(network.reflex_phase_rad_per_s);
        let load = &mut self.load_phase_rad_per_s;
        genes.gene("load_phase_rad_per_s", "phase from load", PHASE_RATE, range, load);
        let (name, blocked) = ("phase from resistance", &mut self.blocked_phase_rad_per_s);
        genes.gene("blocked_phase_rad_per_s", name, PHASE_RATE, range, blocked);
    }

    fn lengths(&self, visit: LengthVisitor<'_>) {
        self.gait.lengths(visit);
    }

    fn joints(&self) -> usize {
        self.gait.joints()
    }

    fn check_rest(&self) -> Result<(), Invalid> {
        if self.gait.steering.is_used() {
            let allowed =
                "none in a gait with reflexes, whose twist reflexes move the same targets";
            return Err(Invalid::new("gait.steering", "used", allowed));
        }
        Ok(())
    }

    fn widen(&self, space: &mut GenomeSpace) {
        self.gait.widen(space);
        widen_weights(&mut space.network.reflex_weight_range, self);
        let network = &mut space.network;
        network.reflex_reach_rad = network.reflex_reach_rad.max(self.reach_rad);
        let rates = [self.load_phase_rad_per_s, self.blocked_phase_rad_per_s];
        network.reflex_phase_rad_per_s =
            rates.iter().map(|rate| rate.abs()).fold(network.reflex_phase_rad_per_s, f32::max);
    }
}
