//! The ranges of the genes of controllers that sense their surroundings.

use std::ops::RangeInclusive;

use super::gene::{GeneRange, Quantity};
use crate::schema::{number, setting_group, switch, whole};

setting_group! {
    /// Ranges of the genes of reflexes, networks and rules.
    pub struct NetworkSpace in "Reflexes, networks and rules": "Ranges of controllers that sense their surroundings." {
        /// Greatest absolute value of a weight of a network of tanh neurons.
        weight_range: f32 = 4.0,
            number("Weight range", WEIGHT_RANGES).advanced()
                .hint("Weights of a network stay between minus and plus this value. Large weights make neurons switches")
                .slider(0.1, 20.0)
                .logarithmic_from(0.1);

        /// Number of hidden neurons of a modular or central network.
        hidden: u32 = 4,
            whole("Hidden neurons", 1..=MOST_HIDDEN)
                .hint("Neurons between senses and joints: of each joint's module, or of the whole central network")
                .slider(1.0, 16.0);

        /// Greatest absolute value of a weight of a reflex.
        reflex_weight_range: f32 = 1.0,
            number("Reflex weight range", WEIGHT_RANGES).advanced()
                .hint("Weights of the senses in a reflex stay between minus and plus this value")
                .slider(0.1, 10.0)
                .logarithmic_from(0.1);

        /// Greatest angle by which reflexes move a joint's target, in radians.
        reflex_reach_rad: f32 = 0.2,
            number("Reflex reach", 0.0..=super::LARGEST_LIMIT_RAD)
                .unit("rad")
                .hint("Maximum angle by which reflexes move a joint's target away from its gait")
                .slider(0.0, 1.5);

        /// Greatest rate at which load or resistance shifts the phase of a joint, in rad/s.
        reflex_phase_rad_per_s: f32 = 1.0,
            number("Reflex phase rate", 0.0..=60.0).advanced()
                .unit("rad/s")
                .hint("Maximum rate at which load or resistance delays or advances a joint's wave")
                .slider(0.0, 10.0);

        /// Greatest absolute value of a weight or bias of a continuous-time network.
        ctrnn_weight_range: f32 = 16.0,
            number("CTRNN weight range", WEIGHT_RANGES).advanced()
                .hint("Weights and biases of a continuous-time network stay between minus and plus this value")
                .slider(1.0, 30.0);

        /// Number of waves among which rules choose.
        library_waves: u32 = 4,
            whole("Waves to choose from", 1..=MOST_LIBRARY_WAVES as u32)
                .hint("Number of waves among which rules choose. Each has a frequency of its own")
                .slider(1.0, 8.0);

        /// Number of rules that choose among waves.
        wave_rules: u32 = 12,
            whole("Rules", 1..=MOST_WAVE_RULES as u32)
                .hint("Number of rules that choose a wave by what the snake senses")
                .slider(1.0, 32.0);

        /// Whether all limbs have the same neurons, for controllers with neurons in the limbs.
        limb_neurons_shared: bool = true,
            switch("Same neurons in all blocks")
                .hint("Neurons are the same in every block. Otherwise each block evolves its own, which multiplies the genes");
    }
}

impl NetworkSpace {
    /// Returns the range of weights and biases of tanh neurons.
    pub(super) fn weights(&self) -> GeneRange<'static> {
        GeneRange::around_zero(self.weight_range)
    }
}

/// Range that settings allow for every range of weights.
const WEIGHT_RANGES: RangeInclusive<f32> = 0.01..=100.0;
/// Greatest number of hidden neurons. With more, evolution hardly makes progress.
pub const MOST_HIDDEN: u32 = 32;
/// Greatest number of waves among which rules choose.
pub const MOST_LIBRARY_WAVES: usize = 8;
/// Greatest number of rules that choose among waves.
pub const MOST_WAVE_RULES: usize = 64;
/// Quantity of a weight or a bias.
pub const WEIGHT: Quantity = Quantity::pure(-100.0..=100.0);
