//! A slider being dragged, and when its value takes effect.

/// Time without movement after which a slider takes effect, in seconds.
const REST_S: f64 = 0.35;
/// Time without movement after which a setting of the world takes effect, in seconds: shorter, because its effect is seen
/// on the stage.
const SETTLED_S: f64 = 0.12;
/// Time after which a setting of the world takes effect even while its slider moves, in seconds: long enough to see
/// the snake react.
const MOVING_S: f64 = 0.3;

/// A slider being dragged.
#[derive(Debug)]
pub(super) struct Changing {
    /// Id of the control.
    pub id: String,
    /// Current value.
    pub so_far: f32,
    /// Time of the last change, in seconds.
    moved_s: f64,
    /// Time at which it last took effect or, if it has not, of its first change, in seconds.
    effective_s: f64,
    /// Whether the current value has taken effect.
    is_effective: bool,
}

impl Changing {
    /// A slider that has moved to a value at a time, in seconds; `earlier` is the same drag before.
    pub fn moved(id: &str, so_far: f32, now_s: f64, earlier: Option<Self>) -> Self {
        let effective_s = earlier.map_or(now_s, |earlier| earlier.effective_s);
        Self { id: id.to_owned(), so_far, moved_s: now_s, effective_s, is_effective: false }
    }

    /// Whether the current value takes effect now although the slider is still held.
    pub fn takes_effect(&self, now_s: f64) -> bool {
        let is_of_world = self.id.starts_with("trial.");
        let is_settled = now_s - self.moved_s > if is_of_world { SETTLED_S } else { REST_S };
        let is_due = is_of_world && now_s - self.effective_s > MOVING_S;
        !self.is_effective && (is_settled || is_due)
    }

    /// Lets the current value take effect. Returns whether it already has.
    pub fn take_effect(&mut self, now_s: f64) -> bool {
        self.effective_s = now_s;
        std::mem::replace(&mut self.is_effective, true)
    }
}
