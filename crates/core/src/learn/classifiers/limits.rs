//! The limits of a classifier system, which bound what a file can ask for.

/// Maximum number of actions of a classifier system.
pub const MOST_ACTIONS: usize = 256;
/// Maximum number of rules of a classifier system.
pub const MOST_RULES: u32 = 100_000;
/// Maximum size of the reward of one decision, in units of reward.
pub const MOST_REWARD: f32 = 1.0e6;
