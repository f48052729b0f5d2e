//! How much an update moves a value, and how much later rewards count.

use crate::learn::parameters::parameters;

parameters! {
    /// The settings of the update rule.
    ///
    /// With a power between 1/2 and 1, the time to converge is polynomial in 1 / (1 - discount); with a power of 1 it is exponential
    /// (Even-Dar & Mansour, "Learning rates for Q-learning", JMLR 5, 2003). The floor keeps the table learning, because the state of a
    /// snake describes only a part of the world.
    #[derive(Copy)]
    pub struct QRule {
        /// Discount per tick: value of a reward one tick later, relative to one now. The default is 0.98 per 15 ticks.
        discount_per_tick: f32 = 0.998_654, 0.0..=1.0;
        /// Learning rate of a pair that has never been visited.
        rate_scale: f32 = 1.0, 0.001..=1.0;
        /// Power by which the learning rate decreases with the visits; 0 keeps it constant. Above 1, a table could converge to values far
        /// from the true ones.
        rate_power: f32 = 0.8, 0.0..=1.0;
        /// Least learning rate.
        rate_floor: f32 = 0.05, 0.0..=1.0;
    }
}

impl QRule {
    /// Creates a rule whose learning rate never changes.
    pub fn with_constant_rate(rate: f32, discount_per_tick: f32) -> Self {
        Self { discount_per_tick, rate_scale: rate, rate_power: 0.0, rate_floor: 0.0 }
    }

    /// Returns the learning rate of a pair after `visits` visits: max(`rate_floor`, `rate_scale` · (1 + `visits`)^-`rate_power`).
    pub fn rate(&self, visits: u16) -> f32 {
        let fall = libm::powf(1.0 + f32::from(visits), -self.rate_power);
        (self.rate_scale * fall).max(self.rate_floor)
    }

    /// Returns the value of a reward `ticks` ticks later, relative to one now.
    pub fn discount(&self, ticks: u16) -> f32 {
        libm::powf(self.discount_per_tick, f32::from(ticks))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_learning_rate_falls_with_the_visits_down_to_its_floor() {
        let rule = QRule::default();
        assert_eq!(rule.rate(0), 1.0);
        // The rate after 31 visits is 32^-0.8 = 2^-4.
        assert!((rule.rate(31) - 0.0625).abs() < 1e-7, "{}", rule.rate(31));
        assert_eq!(rule.rate(1000), 0.05);
        assert_eq!(rule.rate(u16::MAX), 0.05);
        assert!((0..u16::MAX).all(|visits| rule.rate(visits) >= rule.rate(visits + 1)));
    }

    #[test]
    fn a_constant_rate_ignores_the_visits() {
        let rule = QRule::with_constant_rate(0.5, 1.0);
        assert!([0, 1, 1000, u16::MAX].into_iter().all(|visits| rule.rate(visits) == 0.5));
        assert_eq!(rule.check(), Ok(()));
    }

    #[test]
    fn a_decision_of_fifteen_ticks_is_discounted_to_ninety_eight_percent() {
        let rule = QRule::default();
        assert!((rule.discount(15) - 0.98).abs() < 1e-5, "{}", rule.discount(15));
        assert_eq!(rule.discount(0), 1.0);
    }
}
