//! Camera modes.

use snakes_core::check::Invalid;

/// A way in which the camera looks at the stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CameraMode {
    /// At an angle, following the snake or all snakes.
    #[default]
    Follow,
    /// From the side, following.
    Side,
    /// From above, following.
    Top,
    /// Fixed where it is.
    Free,
}

impl CameraMode {
    /// All modes, in the order of the buttons.
    pub const ALL: [Self; 4] = [Self::Follow, Self::Side, Self::Top, Self::Free];

    /// Label of the button.
    pub fn name(self) -> &'static str {
        match self {
            Self::Follow => "Follow",
            Self::Side => "Side",
            Self::Top => "Top",
            Self::Free => "Free",
        }
    }

    /// The mode with this name in lower case.
    ///
    /// # Errors
    /// No mode has this name, or it is [`Self::Free`], which has no view of its own.
    pub fn named(name: &str) -> Result<Self, Invalid> {
        let named =
            Self::ALL.into_iter().find(|camera_mode| camera_mode.name().to_lowercase() == name);
        let still = named.filter(|camera_mode| *camera_mode != Self::Free);
        still.ok_or_else(|| Invalid::new("camera", format!("{name:?}"), "follow, side or top"))
    }

    /// The next mode; the first follows the last.
    pub fn next(self) -> Self {
        let place = Self::ALL.iter().position(|camera_mode| *camera_mode == self).unwrap_or(0);
        Self::ALL[(place + 1) % Self::ALL.len()]
    }
}
