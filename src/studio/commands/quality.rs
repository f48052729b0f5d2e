//! Steps of the picture's quality.

use super::hinted::hinted_values;

hinted_values! {
    /// A step of the picture's quality, the cheapest first. Preferences have its name, one of [`snakes_core::save::QUALITIES`].
    #[derive(PartialOrd, Ord)]
    pub enum Quality {
        Fast = "fast", "Edges as they are; best without a graphics card";
        Smooth = "smooth", "Smooth edges";
        Beautiful = "beautiful", "Smooth edges, shaded corners and glowing lights; needs a graphics card";
    }
}
