//! Overlays that can be drawn over the scene.

use snakes_core::check::Invalid;

/// An overlay of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Overlay {
    /// Contact points and forces.
    Contacts,
    /// Joint torques.
    Torques,
    /// Path of the middle limb.
    Trail,
    /// Distance of the middle limb along the lane.
    FitnessLine,
    /// Collision shapes of the physics engine.
    Wireframe,
}

impl Overlay {
    /// All overlays, in the order of their buttons.
    pub const ALL: [Self; 5] =
        [Self::Contacts, Self::Torques, Self::Trail, Self::FitnessLine, Self::Wireframe];

    /// The overlay with this one-word, lower-case name.
    ///
    /// # Errors
    /// No overlay that can be drawn in a picture has this name.
    pub fn named(name: &str) -> Result<Self, Invalid> {
        match name {
            "contacts" => Ok(Self::Contacts),
            "torques" => Ok(Self::Torques),
            "trail" => Ok(Self::Trail),
            "line" => Ok(Self::FitnessLine),
            _ => Err(Invalid::new("show", format!("{name:?}"), "contacts, torques, trail or line")),
        }
    }

    /// The name that [`Self::named`] knows, if pictures can have the overlay.
    pub fn short_name(self) -> Option<&'static str> {
        match self {
            Self::Contacts => Some("contacts"),
            Self::Torques => Some("torques"),
            Self::Trail => Some("trail"),
            Self::FitnessLine => Some("line"),
            Self::Wireframe => None,
        }
    }

    /// Label of the button, and its tooltip.
    pub fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Contacts => ("Contacts", "Contact points and forces (V)"),
            Self::Torques => ("Torques", "Bend and twist torques of the joints (J)"),
            Self::Trail => ("Trail", "Path of the middle block (B)"),
            Self::FitnessLine => ("Fitness line", "Distance of the middle block (L)"),
            Self::Wireframe => ("Collision shapes", "Shapes that the physics engine uses (D)"),
        }
    }
}
