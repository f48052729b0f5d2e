//! Camera modes.

use snakes_core::check::Invalid;

/// View that the camera has of the stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CameraMode {
    /// View at an angle. The camera follows the snake or all snakes.
    #[default]
    Follow,
    /// View from the side. The camera follows.
    Side,
    /// View from above. The camera follows.
    Top,
    /// The camera stays where it is.
    Free,
}

impl CameraMode {
    /// All modes, in the order of the buttons.
    pub const ALL: [Self; 4] = [Self::Follow, Self::Side, Self::Top, Self::Free];

    /// Returns the label of the mode's button.
    pub fn name(self) -> &'static str {
        match self {
            Self::Follow => "Follow",
            Self::Side => "Side",
            Self::Top => "Top",
            Self::Free => "Free",
        }
    }

    /// Finds the mode with this lower-case name.
    ///
    /// # Errors
    /// No mode has this name, or it is [`Self::Free`], which has no view of its own.
    pub fn named(name: &str) -> Result<Self, Invalid> {
        let following = [Self::Follow, Self::Side, Self::Top].into_iter();
        let mut named = following.filter(|mode| mode.name().to_lowercase() == name);
        named
            .next()
            .ok_or_else(|| Invalid::new("camera", format!("{name:?}"), "follow, side or top"))
    }

    /// Returns the next mode. The last mode is followed by the first.
    pub fn next(self) -> Self {
        Self::ALL[(self as usize + 1) % Self::ALL.len()]
    }
}
