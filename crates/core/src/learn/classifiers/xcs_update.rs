//! How the rules of an action set learn from its payoff.
//!
//! Texts differ in the order of updates. In this program the error is updated before the prediction, so both refer to the old prediction.
//! Then come the action set size, and last the fitness.

use super::xcs::Xcs;

impl Xcs {
    /// Moves the rules of an action set towards the payoff of their action.
    pub(super) fn update(&mut self, set: &[usize], payoff: f32) {
        let rate = self.settings.learning_rate;
        let size = set.iter().fold(0.0, |sum, &i| sum + self.rules[i].numerosity as f32);
        let fitness = set.iter().fold(0.0, |sum, &i| sum + f64::from(self.rules[i].fitness));
        for &index in set {
            let rule = &mut self.rules[index];
            rule.experience = rule.experience.saturating_add(1);
            // The first updates compute plain means, so that a new rule soon predicts the right order of magnitude.
            let young = 1.0 / rule.experience as f32;
            let step = if young > rate { young } else { rate };
            let miss = payoff - rule.prediction;
            rule.error += step * (miss.abs() - rule.error);
            rule.prediction += match self.settings.gradient && fitness > 0.0 {
                true => step * miss * (f64::from(rule.fitness) / fitness) as f32,
                false => step * miss,
            };
            rule.action_set_size += step * (size - rule.action_set_size);
        }
        self.update_fitness(set);
    }

    /// Moves the fitness of the rules of an action set towards their shares of its accuracy.
    fn update_fitness(&mut self, set: &[usize]) {
        let rate = self.settings.learning_rate;
        let weights: Vec<f64> = set
            .iter()
            .map(|&i| self.accuracy(self.rules[i].error) * f64::from(self.rules[i].numerosity))
            .collect();
        let total = weights.iter().fold(0.0, |sum, weight| sum + weight);
        if total > 0.0 {
            for (&index, weight) in set.iter().zip(&weights) {
                let fitness = &mut self.rules[index].fitness;
                *fitness = (*fitness + rate * ((weight / total) as f32 - *fitness)).clamp(0.0, 1.0);
            }
        }
    }

    /// Returns κ, the accuracy at this error: 1 below the error threshold; above it, a power law that falls from α.
    fn accuracy(&self, error: f32) -> f64 {
        let settings = &self.settings;
        if error < settings.error_threshold {
            return 1.0;
        }
        let ratio = f64::from(error) / f64::from(settings.error_threshold);
        f64::from(settings.accuracy_fall) * libm::pow(ratio, -f64::from(settings.accuracy_power))
    }
}

#[cfg(test)]
mod tests {
    use super::super::xcs_rules::samples::{experienced, near};
    use super::*;
    use crate::learn::classifiers::{XcsRule, XcsSettings};

    fn with_rules(rules: [(&str, f32, f32, u32); 2]) -> Xcs {
        let mut xcs = Xcs::new(XcsSettings::default(), 1, 2).unwrap();
        for (condition, error, fitness, numerosity) in rules {
            xcs.add(XcsRule {
                prediction: 0.0,
                error,
                fitness,
                experience: 1000,
                action_set_size: 1.0,
                numerosity,
                ..experienced(condition, 0)
            });
        }
        xcs
    }

    #[test]
    fn fitness_follows_relative_accuracy() {
        let mut xcs = with_rules([("1", 5.0, 0.5, 1), ("#", 20.0, 0.5, 3)]);
        xcs.update(&[0, 1], 0.0);
        // The errors are 4 and 16, the accuracies 1 and 0.1 · 1.6⁻⁵. The second counts three times.
        let other = 3.0 * 0.1 * 0.095_367_43;
        near(xcs.rules[0].fitness, 0.5 + 0.2 * (1.0 / (1.0 + other) - 0.5));
        near(xcs.rules[1].fitness, 0.5 + 0.2 * (other / (1.0 + other) - 0.5));
        near(xcs.rules[1].action_set_size, 1.0 + 0.2 * 3.0);
    }

    #[test]
    fn the_gradient_slows_rules_of_little_fitness() {
        let mut xcs = with_rules([("1", 0.0, 0.6, 1), ("#", 0.0, 0.2, 1)]);
        xcs.settings.gradient = true;
        xcs.update(&[0, 1], 100.0);
        near(xcs.rules[0].prediction, 15.0);
        near(xcs.rules[1].prediction, 5.0);
        near(xcs.rules[1].error, 20.0);
    }
}
