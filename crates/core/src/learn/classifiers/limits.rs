//! Limits of a classifier system. They bound the memory that a file can request.

/// Maximum number of actions of a classifier system.
pub const MOST_ACTIONS: usize = 256;
/// Maximum number of rules of a classifier system.
pub const MOST_RULES: u32 = 100_000;
/// Maximum absolute value of the reward of one decision, in units of reward.
pub const MOST_REWARD: f32 = 1.0e6;
