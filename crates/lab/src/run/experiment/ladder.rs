//! The ladder of a run, which decides the rise of the stairs in each generation.

use snakes_core::check::Invalid;
use snakes_core::evolve::{GenerationRecord, LadderSettings, Rung, Settings};
use snakes_core::score::{Evaluation, ExamEnd, Trial};

/// Position on a ladder, between two generations.
#[derive(Debug, Clone, PartialEq)]
pub struct Ladder {
    settings: LadderSettings,
    /// Number of the current rung; the lowest is 0.
    rung: u32,
    /// Rise of each step of the stairs to which the ladder leads, in m.
    goal_m: f32,
    /// Number of generations since the last success or the last change of the rung.
    barren: u32,
}

impl Ladder {
    /// Returns the ladder of a run after the generations of its log, or `None` if the run has no ladder.
    ///
    /// # Errors
    /// A generation of the log has another rung than the one that follows from the generations before it.
    pub fn after(
        settings: &Settings,
        records: &[GenerationRecord],
    ) -> Result<Option<Self>, Invalid> {
        let mut ladder = Self::begin(settings);
        for record in records {
            let expected = ladder.as_ref().map(Self::rise_m);
            let found = record.rung.map(|rung| rung.rise_m);
            if found != expected {
                let words =
                    |rise_m: Option<f32>| rise_m.map_or("none".to_owned(), |m| m.to_string());
                let field = format!("rung.rise_m of generation {}", record.generation);
                return Err(Invalid::new(field, words(found), words(expected)));
            }
            if let Some((ladder, rung)) = ladder.as_mut().zip(record.rung) {
                ladder.tell(rung.successes, record.evaluations);
            }
        }
        Ok(ladder)
    }

    /// Returns the ladder at the beginning of a run, or `None` if the run has no ladder.
    pub fn begin(settings: &Settings) -> Option<Self> {
        let ladder = settings.evolution.ladder;
        let goal_m = settings.trial.stairs.step_rise_m(0);
        ladder.is_used().then_some(Self { settings: ladder, rung: 0, goal_m, barren: 0 })
    }

    /// Returns the rise of each step in the next generation, in m.
    pub fn rise_m(&self) -> f32 {
        // Rounding to a tenth of a millimetre gives 0.45 m instead of 0.45000002 m.
        let rise_m = self.settings.first_rise_m + self.rung as f32 * self.settings.step_m;
        (libm::roundf(rise_m * 1.0e4) / 1.0e4).min(self.goal_m)
    }

    /// Returns a trial on the stairs of the next generation.
    pub fn trial(&self, trial: Trial) -> Trial {
        Rung { rise_m: self.rise_m(), successes: 0 }.on(trial)
    }

    /// Returns the rung of a generation with these evaluations in this trial, including its number of successes.
    pub fn rung_of(&self, evaluations: &[Evaluation], trial: &Trial) -> Rung {
        let succeeds =
            |evaluation: &&Evaluation| ExamEnd::way_of(evaluation, trial) >= self.settings.way;
        let successes = evaluations.iter().filter(succeeds).count() as u32;
        Rung { rise_m: self.rise_m(), successes }
    }

    /// Moves up, down or not at all, after `successes` of a generation's `evaluations` reached the required way.
    pub fn tell(&mut self, successes: u32, evaluations: u32) {
        let is_climbed = successes as f32 >= self.settings.share * evaluations as f32;
        if is_climbed && self.rise_m() < self.goal_m {
            self.rung += 1;
            self.barren = 0;
        } else if successes > 0 {
            self.barren = 0;
        } else {
            self.barren += 1;
            if self.barren >= self.settings.patience {
                self.rung = self.rung.saturating_sub(1);
                self.barren = 0;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ladder() -> Ladder {
        let settings = LadderSettings { first_rise_m: 0.4, patience: 3, ..Default::default() };
        Ladder { settings, rung: 0, goal_m: 0.48, barren: 0 }
    }

    #[test]
    fn the_rise_grows_with_success_up_to_the_goal_and_falls_without() {
        let mut ladder = ladder();
        assert_eq!(ladder.rise_m(), 0.4);
        ladder.tell(69, 100);
        assert_eq!(ladder.rise_m(), 0.4, "too few");
        ladder.tell(70, 100);
        assert_eq!(ladder.rise_m(), 0.45);
        ladder.tell(100, 100);
        assert_eq!(ladder.rise_m(), 0.48, "not beyond the goal");
        ladder.tell(100, 100);
        assert_eq!(ladder.rise_m(), 0.48);
        [0, 0, 1, 0, 0].into_iter().for_each(|successes| ladder.tell(successes, 100));
        assert_eq!(ladder.rise_m(), 0.48, "a success in time");
        ladder.tell(0, 100);
        assert_eq!(ladder.rise_m(), 0.45);
        (0..20).for_each(|_| ladder.tell(0, 100));
        assert_eq!(ladder.rise_m(), 0.4, "not below the first rung");
    }

    #[test]
    fn a_log_that_its_ladder_cannot_have_is_refused() {
        let mut settings = Settings::default();
        settings.evolution.ladder = LadderSettings { first_rise_m: 0.4, ..Default::default() };
        let record = |generation, rise_m, successes| GenerationRecord {
            rung: Some(Rung { rise_m, successes }),
            ..GenerationRecord::of_test(generation, 10)
        };
        let log = [record(1, 0.4, 9), record(2, 0.45, 0)];
        let after = Ladder::after(&settings, &log).expect("allowed").expect("a ladder");
        assert_eq!(after.rise_m(), 0.45);
        let refused = |log: &[GenerationRecord], settings: &Settings| {
            Ladder::after(settings, log).expect_err("refused").to_string()
        };
        let skipped = refused(&[record(1, 0.4, 9), record(2, 0.4, 9)], &settings);
        assert_eq!(skipped, "rung.rise_m of generation 2 is 0.4; allowed: 0.45");
        let without = refused(&log, &Settings::default());
        assert_eq!(without, "rung.rise_m of generation 1 is 0.4; allowed: none");
    }
}
