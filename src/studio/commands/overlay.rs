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

    /// Label of the button, entry of the menu, shortcuts, and tooltip.
    fn words(self) -> (&'static str, &'static str, &'static [&'static str], &'static str) {
        match self {
            Self::Contacts => {
                ("Contacts", "Contacts and forces", &["V"], "Contact points and forces")
            }
            Self::Torques => {
                ("Torques", "Joint torques", &["J"], "Bend and twist torques of the joints")
            }
            Self::Trail => ("Trail", "Trail", &["B"], "Path of the middle block"),
            Self::FitnessLine => {
                ("Fitness line", "Fitness line", &["L"], "Distance of the middle block")
            }
            Self::Wireframe => (
                "Collision shapes",
                "Collision shapes",
                &["D"],
                "Shapes that the physics engine uses",
            ),
        }
    }

    /// Label of the button.
    pub fn name(self) -> &'static str {
        self.words().0
    }

    /// Name of the menu entry.
    pub fn entry(self) -> &'static str {
        self.words().1
    }

    /// Shortcuts that show or hide the overlay.
    pub fn keys(self) -> &'static [&'static str] {
        self.words().2
    }

    /// Tooltip of the button, without its shortcut.
    pub fn hint(self) -> &'static str {
        self.words().3
    }

    /// The overlay with this one-word, lower-case name.
    ///
    /// # Errors
    /// No overlay that can be drawn in a picture has this name.
    pub fn named(name: &str) -> Result<Self, Invalid> {
        let known = Self::ALL.into_iter().find(|overlay| overlay.short_name() == Some(name));
        let allowed = "contacts, torques, trail or line";
        known.ok_or_else(|| Invalid::new("show", format!("{name:?}"), allowed))
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
}
