//! Camera modes.

use super::hinted::hinted_values;
use snakes_core::check::Invalid;

hinted_values! {
    /// View that the camera has of the stage, in the order of the buttons. Its name is the label of its button.
    #[derive(Default)]
    pub enum CameraMode {
        #[default]
        Follow = "Follow", "Follow the snake, or all of them in a race (F, Home)";
        Side = "Side", "Follow from the side (C: next camera)";
        Top = "Top", "Follow from above (C: next camera)";
        Free = "Free", "Keep the camera where it is (F). Double-click a place to centre it";
    }
}

impl CameraMode {
    /// Finds the mode with this lower-case name.
    ///
    /// # Errors
    /// No mode has this name, or it is [`Self::Free`], which has no view of its own.
    pub fn named(name: &str) -> Result<Self, Invalid> {
        let is_meant = |mode: &Self| *mode != Self::Free && mode.name().to_lowercase() == name;
        let invalid = || Invalid::new("camera", format!("{name:?}"), "follow, side or top");
        Self::ALL.into_iter().find(is_meant).ok_or_else(invalid)
    }

    /// Returns the next mode. The last mode is followed by the first.
    pub fn next(self) -> Self {
        Self::ALL[(self as usize + 1) % Self::ALL.len()]
    }
}
