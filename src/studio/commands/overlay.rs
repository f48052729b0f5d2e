//! Overlays that can be drawn over the scene.

use super::hinted::hinted_values;
use snakes_core::check::Invalid;

hinted_values! {
    /// An overlay that can be drawn over the scene, in the order of the buttons. Its name is the label of its button.
    #[derive(PartialOrd, Ord)]
    pub enum Overlay {
        Contacts = "Contacts", "Contact points and forces";
        Torques = "Torques", "Bend and twist torques of the joints";
        Trail = "Trail", "Path of the middle block";
        FitnessLine = "Fitness line", "Distance of the middle block";
        Wireframe = "Collision shapes", "Shapes that the physics engine uses";
    }
}

impl Overlay {
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
        match self {
            Self::Contacts => Some("contacts"),
            Self::Torques => Some("torques"),
            Self::Trail => Some("trail"),
            Self::FitnessLine => Some("line"),
            Self::Wireframe => None,
        }
    }
}
