//! Climbs of the champions in the list: the time at which each first reached the top of the stairs, and a small picture. Records contain
//! neither, so the climbs are simulated in the background, one champion at a time, and only for visible rows.

use std::collections::BTreeMap;

use snakes_core::evolve::Champion;
use snakes_core::save::LoadedChampion;
use snakes_core::save::library::Thumbnail;
use snakes_lab::run::Lookahead;

/// Climbs that are known, and the one that is being computed.
#[derive(Default)]
pub(super) struct Climbs {
    /// Climbs by the hash of the trace, which champions that survive unchanged share.
    known: BTreeMap<u64, Climb>,
    under_way: Option<(Champion, Lookahead)>,
}

/// Climb of a champion.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Climb {
    /// Simulated time of the first arrival at the top, in seconds; `None` if the champion did not arrive, or if its time is unknown.
    landed_s: Option<f64>,
    /// Picture of the path and the final pose, from the side.
    pub picture: Thumbnail,
}

/// Returns the simulated time at which a champion landed, in seconds, or the text in its place: "…" until the climb is known,
/// and "-" if the champion does not end on the landing or its time cannot be known.
pub(super) fn landed_s(champion: &Champion, climb: Option<&Climb>) -> Result<f64, &'static str> {
    match climb {
        _ if !champion.evaluation.is_on_landing(&champion.trial.stairs) => Err("-"),
        None => Err("…"),
        Some(climb) => climb.landed_s.ok_or("-"),
    }
}

impl Climbs {
    /// Returns the climb of a champion, if it is known. Otherwise begins to compute it, unless another is being computed.
    pub fn of(&mut self, champion: &Champion) -> Option<&Climb> {
        let key = champion.evaluation.trace_hash;
        if self.under_way.is_none() && !self.known.contains_key(&key) {
            let lookahead = Lookahead::begin(&champion.genome, &champion.trial);
            self.under_way = Some((champion.clone(), lookahead));
        }
        self.known.get(&key)
    }

    /// Returns the climb of a saved champion. For a champion of another engine version the picture is drawn from its
    /// recording, because this engine would move it differently, and there is no time.
    pub fn of_save(&mut self, saved: &LoadedChampion) -> Option<&Climb> {
        if saved.is_of_this_engine() {
            return self.of(&saved.champion);
        }
        let key = saved.champion.evaluation.trace_hash;
        let recorded = || Thumbnail::of_champion(&saved.champion, saved.recording.as_ref());
        let climb = || Climb { landed_s: None, picture: recorded() };
        Some(self.known.entry(key).or_insert_with(climb))
    }

    /// Processes the result of a finished computation.
    pub fn poll(&mut self) {
        let Some((champion, lookahead)) = &mut self.under_way else { return };
        lookahead.poll();
        if lookahead.steps_done().is_some() {
            return;
        }
        let history = lookahead.history();
        let step_s = 1.0 / f64::from(champion.trial.physics.steps_per_s);
        let landed_at = history.and_then(|history| history.landed_at_step());
        let climb = Climb {
            landed_s: landed_at.map(|step| f64::from(step) * step_s),
            picture: match history {
                Some(history) => Thumbnail::of_history(champion, history),
                None => Thumbnail::of_trial(&champion.trial),
            },
        };
        self.known.insert(champion.evaluation.trace_hash, climb);
        self.under_way = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::testing::climber_lane;
    use snakes_core::save::shipped_champion;

    #[test]
    fn time_and_picture_are_those_of_the_replay_and_a_snake_below_has_no_time() {
        let loaded = shipped_champion().expect("well formed");
        let champion = &loaded.champion;
        let mut climbs = Climbs::default();
        assert_eq!(landed_s(champion, climbs.of(champion)), Err("…"));
        while climbs.of(champion).is_none() {
            climbs.poll();
        }
        let mut lane = climber_lane(0, "climber");
        lane.finish_lookahead();
        let time_s = lane.landed_s(f64::INFINITY).expect("it climbs");
        let climb = climbs.of(champion).expect("it is known");
        assert_eq!(landed_s(champion, Some(climb)), Ok(time_s));
        assert_eq!(climb.picture.parts_m.len(), 5);
        let mut below = loaded.champion;
        below.evaluation.behaviour = None;
        assert_eq!(landed_s(&below, None), Err("-"));
    }

    #[test]
    fn a_save_of_another_engine_is_drawn_from_its_recording() {
        let mut loaded = shipped_champion().expect("well formed");
        loaded.engine.version += 1;
        let picture = Climbs::default().of_save(&loaded).expect("at once").picture.clone();
        assert_eq!(picture, Thumbnail::of_champion(&loaded.champion, loaded.recording.as_ref()));
        assert!(!picture.way_m.is_empty(), "it has a recording");
    }
}
