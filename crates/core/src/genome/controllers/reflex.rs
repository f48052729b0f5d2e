//! A gait with reflexes: the senses move the target angles and shift the phases of the waves.

use serde::{Deserialize, Serialize};

use super::encoding::{ControllerEncoding, ControllerInfo};
use super::gait::Gait;
use super::servo::twists;
use crate::check::{Invalid, within};
use crate::genome::gene::{Gene, GeneRange, GeneVisitor, GenomeShape};
use crate::genome::limits::LARGEST_LIMIT_RAD;
use crate::genome::network_space::WEIGHT_RANGE;
use crate::genome::space::GenomeSpace;

/// The inputs of a joint's reflex, about its bend or its twist axis; the last is the bias.
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

/// A gait whose targets move by `reach · tanh(Σ weight · sense)`, with the same weights for all joints, and whose phases
/// are shifted by load and resistance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReflexGait {
    /// The gait.
    pub gait: Gait,
    /// Greatest angle by which the senses move a target, in radians.
    pub reach_rad: f32,
    /// Weights of the senses about the bend axes: see [`REFLEX_INPUTS`].
    pub bend_weights: [f32; REFLEX_INPUTS.len()],
    /// Weights of the senses about the twist axes.
    pub twist_weights: [f32; REFLEX_INPUTS.len()],
    /// Strength σ of the rule `dφ/dt = -σ N cos φ`, by which the load N of the limb behind a joint draws the phase φ of
    /// the joint's wave, in rad/s (Owaki, Kano, Nagasawa, Tero and Ishiguro, 2013).
    pub load_phase_rad_per_s: f32,
    /// Rate at which resistance ahead of a joint's front limb delays the phase, in rad/s at full resistance.
    pub blocked_phase_rad_per_s: f32,
}

/// The range of rates of phase in a file, in rad/s.
const PHASE_RATES: std::ops::RangeInclusive<f32> = -60.0..=60.0;

impl ControllerEncoding for ReflexGait {
    fn info() -> &'static ControllerInfo {
        &ControllerInfo {
            name: "reflex",
            title: "Reflex",
            words: "A gait whose target angles and phases yield to what the snake senses.",
            senses_surroundings: true,
            settings: &[
                "wave.frequency_min_hz",
                "wave.frequency_max_hz",
                "wave.harmonics",
                "wave.angle_range_rad",
                "wave.twist_range_rad",
                "wave.stiffness_min_nm_per_rad",
                "wave.stiffness_max_nm_per_rad",
                "wave.servo_damping_nms_per_rad",
                "network.reflex_weight_range",
                "network.reflex_reach_rad",
                "network.reflex_phase_rad_per_s",
            ],
        }
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

    fn genes(&mut self, space: &GenomeSpace, visit: GeneVisitor<'_>) {
        self.gait.genes(space, visit);
        let network = &space.network;
        let range = GeneRange::Between(0.0, network.reflex_reach_rad);
        let (field, name) = (format_args!("reach_rad"), format_args!("reflex reach"));
        visit(Gene { field, name, unit: "rad", range }, &mut self.reach_rad);
        let most = network.reflex_weight_range;
        let twist = if twists(space) { most } else { 0.0 };
        for (axis, weights, most) in
            [("bend", &mut self.bend_weights, most), ("twist", &mut self.twist_weights, twist)]
        {
            for (index, (weight, input)) in weights.iter_mut().zip(REFLEX_INPUTS).enumerate() {
                let range = GeneRange::Between(-most, most);
                let field = format_args!("{axis}_weights[{index}]");
                let name = format_args!("{axis} reflex from {input}");
                visit(Gene { field, name, unit: "", range }, weight);
            }
        }
        let most = network.reflex_phase_rad_per_s;
        let range = GeneRange::Between(-most, most);
        let (field, name) = (format_args!("load_phase_rad_per_s"), format_args!("phase from load"));
        visit(Gene { field, name, unit: "rad/s", range }, &mut self.load_phase_rad_per_s);
        let field = format_args!("blocked_phase_rad_per_s");
        let name = format_args!("phase from resistance");
        visit(Gene { field, name, unit: "rad/s", range }, &mut self.blocked_phase_rad_per_s);
    }

    fn lengths(&self, visit: &mut dyn FnMut(&'static str, usize)) {
        self.gait.lengths(visit);
    }

    fn joints(&self) -> usize {
        self.gait.joints()
    }

    fn frequency_hz(&self) -> f32 {
        self.gait.frequency_hz()
    }

    fn check(&self) -> Result<(), Invalid> {
        let inside = |error: Invalid| error.inside("reflex");
        self.gait.check().map_err(inside)?;
        within("reach_rad", self.reach_rad, 0.0..=LARGEST_LIMIT_RAD).map_err(inside)?;
        for (field, weights) in
            [("bend_weights", &self.bend_weights), ("twist_weights", &self.twist_weights)]
        {
            for (index, weight) in weights.iter().enumerate() {
                within(&format!("{field}[{index}]"), *weight, WEIGHT_RANGE).map_err(inside)?;
            }
        }
        within("load_phase_rad_per_s", self.load_phase_rad_per_s, PHASE_RATES).map_err(inside)?;
        within("blocked_phase_rad_per_s", self.blocked_phase_rad_per_s, PHASE_RATES).map_err(inside)
    }

    fn widen(&self, space: &mut GenomeSpace) {
        self.gait.widen(space);
        let network = &mut space.network;
        network.reflex_reach_rad = network.reflex_reach_rad.max(self.reach_rad);
        let weights = self.bend_weights.iter().chain(&self.twist_weights);
        network.reflex_weight_range =
            weights.map(|weight| weight.abs()).fold(network.reflex_weight_range, f32::max);
        let rates = [self.load_phase_rad_per_s, self.blocked_phase_rad_per_s];
        network.reflex_phase_rad_per_s =
            rates.iter().map(|rate| rate.abs()).fold(network.reflex_phase_rad_per_s, f32::max);
    }
}
