//! Times at which champions of the list first reached the top of the stairs. Records lack them, so they are simulated
//! in the background: one champion at a time, and only those whose rows are seen.

use std::collections::BTreeMap;
use std::fmt;

use crate::evolve::Champion;
use crate::run::Lookahead;

/// Times that are known or being computed.
#[derive(Default)]
pub(super) struct LandingTimes {
    /// Time of each rollout, in simulated seconds, by the hash of its trace: champions that survive unchanged share it.
    known: BTreeMap<u64, Option<f64>>,
    under_way: Option<(u64, f64, Lookahead)>,
}

/// Time of a landing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum LandingTime {
    /// In simulated seconds.
    Known(f64),
    /// It does not end on the landing.
    None,
    /// Not computed yet.
    Pending,
}

impl fmt::Debug for LandingTimes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("LandingTimes").field("known", &self.known).finish_non_exhaustive()
    }
}

impl LandingTimes {
    /// Time at which a champion first reached the top of the stairs. Computes it, unless another is being computed.
    pub fn of(&mut self, champion: &Champion) -> LandingTime {
        let Champion { genome, trial, evaluation, .. } = champion;
        if !evaluation.is_on_landing(&trial.stairs) {
            return LandingTime::None;
        }
        let key = evaluation.trace_hash;
        match self.known.get(&key) {
            Some(Some(time_s)) => LandingTime::Known(*time_s),
            Some(None) => LandingTime::None,
            None => {
                if self.under_way.is_none() {
                    let step_s = 1.0 / f64::from(trial.physics.steps_per_s);
                    self.under_way = Some((key, step_s, Lookahead::begin(genome, trial)));
                }
                LandingTime::Pending
            }
        }
    }

    /// Takes over a time that was computed.
    pub fn poll(&mut self) {
        let Some((key, step_s, lookahead)) = &mut self.under_way else { return };
        lookahead.poll();
        if lookahead.steps_done().is_some() {
            return;
        }
        let step = lookahead.history().and_then(|history| history.landed_at_step());
        self.known.insert(*key, step.map(|step| f64::from(step) * *step_s));
        self.under_way = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::shipped_champion;
    use crate::studio::stage::lane::Lane;
    use crate::studio::stage::staged_champion::StagedChampion;

    #[test]
    fn the_time_is_that_of_the_replay_and_a_snake_below_has_none() {
        let loaded = shipped_champion().expect("well formed");
        let mut times = LandingTimes::default();
        assert_eq!(times.of(&loaded.champion), LandingTime::Pending);
        while times.of(&loaded.champion) == LandingTime::Pending {
            times.poll();
        }
        let mut lane = Lane::new(StagedChampion::from_file(&loaded, 0, "climber"), 0);
        lane.finish_lookahead();
        let landed_s = lane.landed_s(f64::INFINITY).expect("it climbs");
        assert_eq!(times.of(&loaded.champion), LandingTime::Known(landed_s));
        let mut below = loaded.champion;
        below.evaluation.behaviour = None;
        assert_eq!(times.of(&below), LandingTime::None);
    }
}
