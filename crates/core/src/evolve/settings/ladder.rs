//! Settings of the ladder: stairs whose rise grows as the population learns to climb them.

use crate::check::Invalid;
use crate::schema::{PerPart, number, setting_group, whole};
use crate::world::LEAST_RISE_M;

setting_group! {
    /// Settings of a ladder of stairs: a run begins on low stairs, whose rise grows up to that of the trial as the snakes succeed.
    #[derive(Copy)]
    pub struct LadderSettings in "Ladder of stairs": "Begins with low stairs, and raises them as the snakes succeed." {
        /// Rise of the first stairs, in m. With 0 there is no ladder.
        first_rise_m: f32 = 0.0,
            number("First rise", 0.0..=5.0)
                .without(0.0, LEAST_RISE_M)
                .unit("m")
                .hint("Rise of the first stairs; 0 begins with the rise of the stairs themselves")
                .slider(0.0, 1.0)
                .fixed(BEGUN);

        /// Increase of the rise from one rung to the next, in m.
        step_m: f32 = 0.05,
            number("Rung", 0.001..=1.0).used_if(*first_rise_m > 0.0)
                .unit("m")
                .hint("How much the rise grows from one rung to the next")
                .slider(0.01, 0.2)
                .fixed(BEGUN);

        /// Share of a generation that has to succeed before the rise grows by a rung.
        share: f32 = 0.7,
            number("Success of a rung", 0.01..=1.0).used_if(*first_rise_m > 0.0)
                .hint("Share of a generation that has to succeed before the rise grows")
                .slider(0.1, 1.0)
                .fixed(BEGUN);

        /// Share of the way to the landing that a snake has to cover to succeed on a rung.
        way: f32 = 0.85,
            number("Way of a success", 0.01..=1.0).advanced().used_if(*first_rise_m > 0.0)
                .hint("Share of the way to the landing that a snake has to cover to succeed")
                .slider(0.1, 1.0)
                .fixed(BEGUN);

        /// Number of generations without a success after which the rise falls by a rung.
        patience: u32 = 15,
            whole("Patience", 1..=1000).advanced().used_if(*first_rise_m > 0.0)
                .hint("Number of generations without a success after which the rise falls by a rung")
                .slider(1.0, 50.0)
                .fixed(BEGUN);
    }
}

const BEGUN: &str =
    "Takes effect with the next run, because this one has begun to climb its ladder.";

impl LadderSettings {
    /// Returns whether there is a ladder.
    pub fn is_used(&self) -> bool {
        self.first_rise_m > 0.0
    }

    /// Checks that the ladder, if there is one, leads up to stairs with `rises_m`, and that the strategy named `strategy` can use a ladder.
    pub(super) fn check_with(
        &self,
        strategy: &str,
        can_climb: bool,
        rises_m: &PerPart,
    ) -> Result<(), Invalid> {
        if !self.is_used() {
            return Ok(());
        }
        let refused = |allowed: String| {
            Err(Invalid::new("evolution.ladder.first_rise_m", self.first_rise_m, allowed))
        };
        if !can_climb {
            return refused(format!(
                "0 with evolution.strategy {strategy}, which compares snakes of different generations"
            ));
        }
        match rises_m {
            PerPart::All(rise_m) if self.first_rise_m <= *rise_m => Ok(()),
            PerPart::All(rise_m) => {
                refused(format!("0, or {LEAST_RISE_M} m to {rise_m} m, the rise of the stairs"))
            }
            PerPart::Each(_) => refused("0 with steps of different heights".to_owned()),
        }
    }
}
