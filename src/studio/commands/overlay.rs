//! Overlays that can be drawn over the scene.

use snakes_core::check::Invalid;

/// An overlay that can be drawn over the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Overlay {
    /// Contact points and forces.
    Contacts,
    /// Joint torques.
    Torques,
    /// Path that the middle limb has taken.
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

    /// Returns the label of the button, its tooltip, and the short name.
    fn words(self) -> (&'static str, &'static str, Option<&'static str>) {
        match self {
            Self::Contacts => ("Contacts", "Contact points and forces", Some("contacts")),
            Self::Torques => ("Torques", "Bend and twist torques of the joints", Some("torques")),
            Self::Trail => ("Trail", "Path of the middle block", Some("trail")),
            Self::FitnessLine => ("Fitness line", "Distance of the middle block", Some("line")),
            Self::Wireframe => ("Collision shapes", "Shapes that the physics engine uses", None),
        }
    }

    /// Returns the label of the overlay's button.
    pub fn name(self) -> &'static str {
        self.words().0
    }

    /// Returns the tooltip of the overlay's button, without the shortcut.
    pub fn hint(self) -> &'static str {
        self.words().1
    }

    /// Finds the overlay with this one-word, lower-case name.
    ///
    /// # Errors
    /// No overlay that can be drawn in a picture has this name.
    pub fn named(name: &str) -> Result<Self, Invalid> {
        let known = Self::ALL.into_iter().find(|overlay| overlay.short_name() == Some(name));
        let allowed = "contacts, torques, trail or line";
        known.ok_or_else(|| Invalid::new("show", format!("{name:?}"), allowed))
    }

    /// Returns the name by which [`Self::named`] finds the overlay, or `None` if it cannot be drawn in pictures.
    pub fn short_name(self) -> Option<&'static str> {
        self.words().2
    }
}
