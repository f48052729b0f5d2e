//! Events of a rollout for the timeline: first touch of the stairs, steps climbed and lost, landing.

use crate::studio::stage::lane::Lane;
use snakes_core::score::KeyframeHistory;
use snakes_core::world::Stairs;

/// An event of a snake's climb.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ClimbEvent {
    /// Time of the event, in simulated seconds.
    pub time_s: f64,
    /// Kind of the event.
    pub kind: ClimbEventKind,
}

/// Kind of an event of a climb.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ClimbEventKind {
    /// A limb touched the stairs for the first time.
    Touched,
    /// The middle block climbed to this step; the lowest is 1.
    Climbed(u32),
    /// The middle block fell back to this step; 0 is the ground.
    Lost(u32),
    /// The middle block reached the last step or the landing for the first time.
    Landed,
}

/// Minimum time for which the middle block must stay on a step, in seconds. At the edge of a step it may move back and forth.
const STAYS_S: f64 = 0.25;

impl ClimbEvent {
    /// Describes the event for a hover text.
    pub fn words(self) -> String {
        let time_s = self.time_s;
        match self.kind {
            ClimbEventKind::Touched => format!("First touch of the stairs, {time_s:.2} s"),
            ClimbEventKind::Climbed(step) => format!("Step {step} climbed, {time_s:.2} s"),
            ClimbEventKind::Lost(0) => format!("Fell off the stairs, {time_s:.2} s"),
            ClimbEventKind::Lost(step) => format!("Fell back to step {step}, {time_s:.2} s"),
            ClimbEventKind::Landed => format!("Top of the stairs reached, {time_s:.2} s"),
        }
    }
}

/// Returns the events of a lane's rollout in the order of time, as far as they are known. For a recording, only the landing is known.
pub(super) fn events(lane: &Lane) -> Vec<ClimbEvent> {
    match lane.history() {
        Some(history) => of_history(history, &lane.trial().stairs, lane.step_s),
        None => {
            let landed_s = lane.landed_s(f64::INFINITY);
            let landed = landed_s.map(|time_s| ClimbEvent { time_s, kind: ClimbEventKind::Landed });
            landed.into_iter().collect()
        }
    }
}

fn of_history(history: &KeyframeHistory, stairs: &Stairs, step_s: f64) -> Vec<ClimbEvent> {
    let sample_s = step_s * f64::from(history.sample_steps());
    let positions = history.middles_m().iter();
    let levels: Vec<u32> = positions.map(|at| stairs.steps_under(at.to_array())).collect();
    let at_step = |step: Option<u32>, kind| {
        step.map(|step| ClimbEvent { time_s: f64::from(step) * step_s, kind })
    };
    let mut events = changes(&levels, sample_s);
    if history.landed_at_step().is_some() {
        // The landing has a separate mark.
        let first = events.iter().position(|of| of.kind == ClimbEventKind::Climbed(stairs.steps));
        if let Some(index) = first {
            events.remove(index);
        }
    }
    events.extend(at_step(history.touched_stairs_at_step(), ClimbEventKind::Touched));
    events.extend(at_step(history.landed_at_step(), ClimbEventKind::Landed));
    events.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    events
}

/// Returns the lasting changes of the step under the middle block. `levels` has the step in each sample.
fn changes(levels: &[u32], sample_s: f64) -> Vec<ClimbEvent> {
    let samples = (STAYS_S / sample_s.max(1.0e-6)).ceil().max(1.0) as usize;
    let mut events = Vec::new();
    let mut now = levels.first().copied().unwrap_or(0);
    for (index, level) in levels.iter().enumerate() {
        let after = &levels[index..levels.len().min(index + samples)];
        let [least, most] = [after.iter().min(), after.iter().max()].map(|of| of.copied());
        let time_s = index as f64 * sample_s;
        let mut push = |kind| events.push(ClimbEvent { time_s, kind });
        match (least, most) {
            (Some(least), _) if *level > now && least > now => {
                push(ClimbEventKind::Climbed(least));
                now = least;
            }
            (_, Some(most)) if *level < now && most < now => {
                push(ClimbEventKind::Lost(most));
                now = most;
            }
            _ => {}
        }
    }
    events
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::testing::climber_lane;
    use ClimbEventKind::{Climbed, Landed, Lost, Touched};

    #[test]
    fn steps_climbed_and_lost_are_marked_but_not_a_hop_at_an_edge() {
        // There is a sample every tenth of a second.
        let levels = [0, 0, 1, 1, 1, 2, 1, 1, 1, 3, 3, 3, 3, 1, 1, 1, 1];
        let kinds: Vec<_> =
            changes(&levels, 0.1).into_iter().map(|of| (of.time_s, of.kind)).collect();
        let seconds = |samples: usize| samples as f64 * 0.1;
        let expected = [(seconds(2), Climbed(1)), (seconds(9), Climbed(3)), (seconds(13), Lost(1))];
        assert_eq!(kinds, expected);
    }

    #[test]
    fn the_champion_touches_the_stairs_climbs_its_steps_and_lands() {
        let mut lane = climber_lane(0, "climber");
        assert_eq!(events(&lane), [], "not known yet");
        lane.finish_lookahead();
        let events = events(&lane);
        assert_eq!(events[0].kind, Touched, "{events:?}");
        assert!(events.is_sorted_by(|a, b| a.time_s <= b.time_s));
        let climbed = events.iter().filter(|of| matches!(of.kind, Climbed(_))).count();
        assert!((3..20).contains(&climbed), "{events:?}");
        let landed: Vec<_> = events.iter().filter(|of| of.kind == Landed).collect();
        assert_eq!(landed.len(), 1);
        assert_eq!(Some(landed[0].time_s), lane.landed_s(f64::INFINITY));
        let fall = ClimbEvent { time_s: 1.5, kind: Lost(0) };
        assert_eq!(fall.words(), "Fell off the stairs, 1.50 s");
    }
}
