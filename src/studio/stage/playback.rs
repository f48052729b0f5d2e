//! The clock of the stage: play, pause, speed, loop, seek. All lanes are displayed at the clock's time.
//!
//! The clock determines only which time is displayed. The rollouts determine what happens at that time.

use std::ops::RangeInclusive;

use bevy::prelude::*;

use crate::studio::commands::PlayerCommand;

/// The clock of the stage.
#[derive(Resource, Debug, Clone, PartialEq)]
pub(crate) struct Playback {
    /// Time that the stage displays, in simulated seconds.
    time_s: f64,
    speed: f32,
    /// Whether playback is running.
    pub is_playing: bool,
    /// Whether playback restarts after the end.
    pub loops: bool,
    /// Real time since the clock reached the end, in seconds.
    rested_s: f32,
    /// Whether the time was set by a seek. The next frame then draws exactly this time.
    is_sought: bool,
    /// Time from which changes of the world were last tried, in simulated seconds; `None` if the user has since gone to
    /// another time or shows something else.
    pub tried_from_s: Option<f64>,
    /// Number of commands so far that paused, played or moved the clock. The studio can also stop the clock without a command.
    pub commands: u32,
}

/// Allowed playback speeds, in simulated seconds per real second.
pub(crate) const SPEED_RANGE: RangeInclusive<f32> = 0.1..=16.0;
/// Speeds through which the keys step, in simulated seconds per real second.
const SPEEDS: [f32; 8] = [0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0];
/// Pause at the end before a loop restarts, in seconds.
pub const REST_S: f32 = 1.5;
/// Pause at the end of several snakes before a loop restarts, in seconds: time to read their places.
pub const REST_OF_SEVERAL_S: f32 = 6.0;
/// Maximum real time by which a single frame advances the clock, in seconds. After a longer gap (a dragged window, a
/// sleeping laptop) playback continues where it was instead of jumping ahead.
const MAX_CATCH_UP_S: f32 = 0.5;

impl Default for Playback {
    fn default() -> Self {
        Self {
            time_s: 0.0,
            speed: 1.0,
            is_playing: true,
            loops: true,
            rested_s: 0.0,
            is_sought: false,
            tried_from_s: None,
            commands: 0,
        }
    }
}

impl Playback {
    /// Returns the time that the stage displays, in simulated seconds.
    pub fn time_s(&self) -> f64 {
        self.time_s
    }

    /// Returns the playback speed, in simulated seconds per real second.
    pub fn speed(&self) -> f32 {
        self.speed
    }

    /// Executes a command. `step_s` is the length of a physics step and `end_s` the end of the longest lane, in simulated seconds.
    pub fn apply(&mut self, command: &PlayerCommand, step_s: f64, end_s: f64) {
        if matches!(command, PlayerCommand::Seek(_) | PlayerCommand::Step { .. }) {
            self.tried_from_s = None;
        }
        use PlayerCommand::{ChangeSpeed, SetSpeed, ToggleLoop};
        let is_of_speed = matches!(command, SetSpeed(_) | ChangeSpeed { .. } | ToggleLoop);
        self.commands += u32::from(!is_of_speed);
        match command {
            PlayerCommand::Toggle => self.toggle(end_s),
            PlayerCommand::Restart => self.restart(),
            PlayerCommand::Seek(time_s) => self.seek(*time_s, end_s),
            PlayerCommand::SeekEnd => self.hold_at(end_s),
            PlayerCommand::Step { forward } => self.step(*forward, step_s, end_s),
            PlayerCommand::SetSpeed(speed) => self.set_speed(*speed),
            PlayerCommand::ChangeSpeed { faster } => self.change_speed(*faster),
            PlayerCommand::ToggleLoop => self.loops = !self.loops,
        }
    }

    /// Plays from the start after other champions were put on the stage.
    pub fn begin(&mut self) {
        self.tried_from_s = None;
        self.restart();
    }

    /// Plays from `start_s` on, after a change of the world was tried from `tried_from_s` on, both in simulated
    /// seconds.
    pub fn play_change(&mut self, start_s: f64, tried_from_s: f64) {
        (self.time_s, self.rested_s, self.is_playing) = (start_s, 0.0, true);
        (self.is_sought, self.tried_from_s) = (true, Some(tried_from_s));
    }

    /// Plays from the start at the current speed.
    pub fn restart(&mut self) {
        (self.time_s, self.rested_s, self.is_playing) = (0.0, 0.0, true);
    }

    /// Toggles between pause and play. At the end, plays from the start.
    pub fn toggle(&mut self, end_s: f64) {
        if !self.is_playing && self.time_s >= end_s {
            self.restart();
        } else {
            self.is_playing = !self.is_playing;
        }
    }

    /// Returns to the time of an earlier clock, whether it was playing, and whether it repeated. The speed stays, because the user may
    /// have set it since then.
    pub fn restore(&mut self, earlier: &Self) {
        let Self { speed, commands, .. } = *self;
        *self = Self { is_sought: true, speed, commands, ..earlier.clone() };
    }

    /// Sets the playback speed, clamped to the allowed range.
    pub fn set_speed(&mut self, speed: f32) {
        if speed.is_finite() {
            self.speed = speed.clamp(*SPEED_RANGE.start(), *SPEED_RANGE.end());
        }
    }

    /// Selects the next higher or lower of the preset speeds.
    pub fn change_speed(&mut self, faster: bool) {
        let next = if faster {
            SPEEDS.into_iter().find(|speed| *speed > self.speed * 1.001)
        } else {
            SPEEDS.into_iter().rev().find(|speed| *speed < self.speed * 0.999)
        };
        self.speed = next.unwrap_or(self.speed);
    }

    /// Goes to a time in simulated seconds, at most to the end.
    pub fn seek(&mut self, time_s: f64, end_s: f64) {
        if time_s.is_finite() {
            (self.time_s, self.rested_s) = (time_s.clamp(0.0, end_s.max(0.0)), 0.0);
            self.is_sought = true;
        }
    }

    /// Pauses at a time in simulated seconds.
    pub fn hold_at(&mut self, time_s: f64) {
        self.is_playing = false;
        self.seek(time_s, time_s);
    }

    /// Pauses, and goes to the next or the previous physics step.
    pub fn step(&mut self, forward: bool, step_s: f64, end_s: f64) {
        self.is_playing = false;
        let place = self.time_s / step_s;
        let near = libm::round(place);
        let is_on_step = (place - near).abs() < 1.0e-3;
        let next = match (is_on_step, forward) {
            (true, true) => near + 1.0,
            (true, false) => near - 1.0,
            (false, true) => libm::ceil(place),
            (false, false) => libm::floor(place),
        };
        self.seek(next * step_s, end_s);
    }

    /// Advances by `elapsed_s` of real time, but by at most `most_s` of simulated time. `end_s` is the end of the
    /// longest lane, `rest_s` the real time at the end before a loop restarts.
    pub fn pass(&mut self, elapsed_s: f32, most_s: f64, end_s: f64, rest_s: f32) {
        // The known end can move closer while the lookahead is running.
        self.time_s = self.time_s.min(end_s);
        if std::mem::take(&mut self.is_sought) || !self.is_playing {
            return;
        }
        if self.time_s < end_s {
            let wanted_s = f64::from(elapsed_s.min(MAX_CATCH_UP_S) * self.speed);
            self.time_s = (self.time_s + wanted_s.min(most_s)).min(end_s);
            self.rested_s = 0.0;
            return;
        }
        self.time_s = end_s;
        self.rested_s += elapsed_s;
        if self.rested_s > rest_s && self.loops {
            return self.restart();
        }
        self.is_playing = self.loops;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP_S: f64 = 1.0 / 60.0;

    #[test]
    fn after_several_snakes_there_is_time_to_read_their_places_before_the_loop() {
        let restarts_after = |rest_s| {
            let mut playback = Playback { time_s: 15.0, ..Playback::default() };
            (1..100).find(|_| {
                playback.pass(0.5, 1.0, 15.0, rest_s);
                playback.time_s == 0.0
            })
        };
        assert_eq!([REST_S, REST_OF_SEVERAL_S].map(restarts_after), [Some(4), Some(13)]);
    }

    #[test]
    fn step_moves_by_exactly_one_physics_step() {
        let mut playback = Playback::default();
        playback.pass(0.0251, 1.0, 15.0, REST_S);
        let steps = |playback: &Playback| libm::round(playback.time_s() / STEP_S * 1000.0) / 1000.0;
        let mut seen = Vec::new();
        for forward in [true, true, false, false, false, false] {
            playback.step(forward, STEP_S, 15.0);
            seen.push(steps(&playback));
        }
        assert_eq!(seen, [2.0, 3.0, 2.0, 1.0, 0.0, 0.0]);
        assert!(!playback.is_playing);
    }

    #[test]
    fn playback_loops_after_a_pause_or_stops_at_the_end() {
        let mut playback = Playback::default();
        playback.set_speed(16.0);
        while playback.time_s() < 2.0 {
            playback.pass(0.1, 1.0, 2.0, REST_S);
        }
        let begins_again = |_| {
            playback.pass(0.1, 1.0, 2.0, REST_S);
            playback.time_s() < 2.0
        };
        let rests = (0..40).position(begins_again).expect("it begins again");
        assert!((14..17).contains(&rests), "{rests} frames of a tenth of a second");
        playback.loops = false;
        (0..40).for_each(|_| playback.pass(0.1, 1.0, 2.0, REST_S));
        assert_eq!((playback.time_s(), playback.is_playing), (2.0, false));
        playback.toggle(2.0);
        assert_eq!((playback.time_s(), playback.is_playing), (0.0, true), "play begins anew");
    }

    #[test]
    fn speed_and_seek_are_clamped() {
        let mut playback = Playback::default();
        for (requested, taken) in [(0.0, 0.1), (99.0, 16.0), (f32::NAN, 16.0), (1.5, 1.5)] {
            playback.set_speed(requested);
            assert_eq!(playback.speed(), taken);
        }
        playback.change_speed(true);
        assert_eq!(playback.speed(), 2.0);
        for (requested, taken) in [(-1.0, 0.0), (7.0, 7.0), (1.0e9, 15.0), (f64::NAN, 15.0)] {
            playback.seek(requested, 15.0);
            assert_eq!(playback.time_s(), taken);
        }
    }

    #[test]
    fn a_long_frame_advances_by_the_maximum_only() {
        let mut playback = Playback::default();
        playback.pass(60.0, 10.0, 100.0, REST_S);
        assert_eq!(playback.time_s(), 0.5);
        playback.set_speed(16.0);
        playback.pass(0.5, 2.0, 100.0, REST_S);
        assert_eq!(playback.time_s(), 2.5, "no more than can be simulated in a frame");
    }
}
