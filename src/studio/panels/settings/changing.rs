//! A slider that is being dragged, and the time at which its value takes effect.

/// Time without movement after which a slider's value takes effect, in seconds.
const REST_S: f64 = 0.35;
/// Time without movement after which a setting of the world takes effect, in seconds. It is shorter because the effect
/// is visible on the stage.
const SETTLED_S: f64 = 0.12;
/// Time after which a setting of the world takes effect even while its slider moves, in seconds: long enough to see the
/// snake's reaction.
const MOVING_S: f64 = 0.3;

/// A slider that is being dragged.
#[derive(Debug)]
pub(super) struct Changing {
    /// ID of the control.
    pub id: String,
    /// Value at which the slider is.
    pub so_far: f32,
    /// Time of the slider's last movement, in seconds.
    moved_s: f64,
    /// Time at which the value last took effect, or of the first movement if it has not yet, in seconds.
    effective_s: f64,
    /// Whether the slider's value has taken effect.
    is_effective: bool,
}

impl Changing {
    /// Records that a slider has moved to a value at a time, in seconds. `earlier` is the state of the same drag before.
    pub fn moved(id: &str, so_far: f32, now_s: f64, earlier: Option<Self>) -> Self {
        let effective_s = earlier.map_or(now_s, |earlier| earlier.effective_s);
        Self { id: id.to_owned(), so_far, moved_s: now_s, effective_s, is_effective: false }
    }

    /// Returns whether the value must take effect now although the slider is still held.
    pub fn takes_effect(&self, now_s: f64) -> bool {
        let is_of_world = self.id.starts_with("trial.");
        let is_settled = now_s - self.moved_s > if is_of_world { SETTLED_S } else { REST_S };
        let is_due = is_of_world && now_s - self.effective_s > MOVING_S;
        !self.is_effective && (is_settled || is_due)
    }

    /// Marks the value as effective. Returns whether it was already.
    pub fn take_effect(&mut self, now_s: f64) -> bool {
        self.effective_s = now_s;
        std::mem::replace(&mut self.is_effective, true)
    }
}
