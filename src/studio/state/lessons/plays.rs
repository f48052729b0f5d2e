//! Complete playbacks of a scene's snake, each at one speed.

use crate::studio::stage::lane::Lane;
use crate::studio::stage::playback::Playback;
use crate::studio::stage::staged_champion::ChampionSource;
use snakes_core::score::Evaluation;

/// Complete playbacks of one snake.
#[derive(Debug, Default)]
pub(crate) struct Plays {
    /// Finished playbacks in their order, at most one per speed.
    pub finished: Vec<Play>,
    current: CurrentPlay,
    /// Displayed time when the playback was last observed, in simulated seconds.
    time_s: f64,
}

/// A complete playback at one speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Play {
    /// Playback speed, in simulated seconds per real second.
    pub speed: f32,
    /// Evaluation of the snake that was simulated during the playback.
    pub evaluation: Evaluation,
}

/// The playback in progress.
#[derive(Debug, Default)]
enum CurrentPlay {
    /// No playback has begun since the last one ended.
    #[default]
    None,
    /// All of the playback so far had this speed, in simulated seconds per real second.
    At(f32),
    /// The playback so far had several speeds.
    Mixed,
}

/// Number of playbacks at different speeds that a comparison needs.
pub(super) const PLAYS_TO_COMPARE: usize = 2;

impl Plays {
    /// Returns whether all playbacks ended with the same bits; `None` if there are too few to compare.
    pub fn are_equal(&self) -> Option<bool> {
        let (first, others) = self.finished.split_first()?;
        let is_equal = |play: &Play| play.evaluation.agrees_with(&first.evaluation);
        (self.finished.len() >= PLAYS_TO_COMPARE).then(|| others.iter().all(is_equal))
    }

    /// Observes the playback of a lesson's snake. Only an undisturbed snake that is alone on the stage counts.
    pub fn follow_stage(&mut self, playback: &Playback, lanes: &[&Lane]) {
        match lanes {
            [lane] if is_undisturbed(lane) => {
                let ended = lane.replay.is_over().then(|| lane.evaluation());
                self.follow(playback.speed(), playback.time_s(), ended.as_ref());
            }
            _ => self.current = CurrentPlay::None,
        }
    }

    /// Observes a playback: its speed, its displayed time in simulated seconds, and the evaluation of the snake if it
    /// has ended.
    pub fn follow(&mut self, speed: f32, time_s: f64, ended: Option<&Evaluation>) {
        let goes_back = time_s < self.time_s;
        self.time_s = time_s;
        if goes_back || time_s <= 0.0 {
            self.current = CurrentPlay::None;
        }
        if time_s <= 0.0 {
            return;
        }
        if let Some(evaluation) = ended {
            if let CurrentPlay::At(speed) = std::mem::take(&mut self.current) {
                self.finished.retain(|play| play.speed != speed);
                self.finished.push(Play { speed, evaluation: *evaluation });
            }
            return;
        }
        self.current = match self.current {
            CurrentPlay::None => CurrentPlay::At(speed),
            CurrentPlay::At(before) if before == speed => CurrentPlay::At(speed),
            _ => CurrentPlay::Mixed,
        };
    }
}

fn is_undisturbed(lane: &Lane) -> bool {
    let staged = &lane.staged;
    staged.source() == ChampionSource::Lesson && !staged.is_changed() && !lane.replay.is_disturbed()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn speeds(plays: &Plays) -> Vec<f32> {
        plays.finished.iter().map(|play| play.speed).collect()
    }

    #[test]
    fn a_playback_counts_once_it_was_watched_to_its_end_at_one_speed() {
        let end = Evaluation::of_fitness(26.0);
        let mut plays = Plays::default();
        plays.follow(1.0, 0.0, None);
        plays.follow(1.0, 15.0, Some(&end));
        assert!(speeds(&plays).is_empty(), "it stood at its end from the beginning");
        // The speed is changed before the start.
        for (speed, time_s) in [(1.0, 0.0), (4.0, 0.0), (4.0, 5.0), (4.0, 14.0)] {
            plays.follow(speed, time_s, None);
        }
        plays.follow(4.0, 15.0, Some(&end));
        plays.follow(2.0, 15.0, Some(&end));
        assert_eq!(speeds(&plays), [4.0], "a speed chosen at the end is not that of the playback");
        for (speed, time_s) in [(2.0, 0.0), (2.0, 5.0), (0.25, 6.0), (0.25, 14.0)] {
            plays.follow(speed, time_s, None);
        }
        plays.follow(0.25, 15.0, Some(&end));
        assert_eq!(speeds(&plays), [4.0], "two speeds in one playback");
        plays.follow(0.25, 1.0, None);
        plays.follow_stage(&Playback::default(), &[]);
        plays.follow(0.25, 15.0, Some(&end));
        assert_eq!(speeds(&plays), [4.0], "without the snake");
    }
}
