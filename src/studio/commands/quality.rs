//! Steps of the picture's quality.

use snakes_core::save::QUALITIES;

/// A step of the picture's quality, the cheapest first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quality {
    /// Edges are not smoothed. For machines without a graphics card.
    Fast,
    /// Smooth edges.
    Smooth,
    /// Smooth edges, shaded corners, sharp shadows where things touch, and glowing lights.
    Beautiful,
}

impl Quality {
    /// All steps, the cheapest first.
    pub const ALL: [Self; 3] = [Self::Fast, Self::Smooth, Self::Beautiful];

    /// Returns the step's name in the menu and in the preferences.
    pub fn name(self) -> &'static str {
        QUALITIES[self as usize]
    }

    /// Returns the tooltip of the step's menu entry.
    pub fn hint(self) -> &'static str {
        match self {
            Self::Fast => "Edges as they are; best without a graphics card",
            Self::Smooth => "Smooth edges",
            Self::Beautiful => {
                "Smooth edges, shaded corners and glowing lights; needs a graphics card"
            }
        }
    }

    /// Finds the step with this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|quality| quality.name() == name)
    }
}
