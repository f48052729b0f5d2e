//! Scale of the panels: what a person has chosen, within what the window has room for.

use bevy_egui::egui;

use snakes_core::save::UI_SCALES;

/// Minimum size of the window in points of the interface: the stage beside a panel of least width, and the player below
/// it. A scale that would leave fewer points is not used.
pub const LEAST_WINDOW: egui::Vec2 = egui::vec2(800.0, 480.0);

/// Size of a window, in logical pixels, in which the presenting mode has the scale 1.
const PRESENTED: egui::Vec2 = egui::vec2(1000.0, 625.0);

/// Scale of the panels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UiScale {
    /// The user's choice. A window that becomes larger has it again.
    chosen: f32,
    /// The largest one for which the window has room.
    largest: f32,
}

impl Default for UiScale {
    fn default() -> Self {
        Self { chosen: 1.0, largest: UI_SCALES[UI_SCALES.len() - 1] }
    }
}

impl UiScale {
    /// The chosen scale, for the preferences.
    pub fn chosen(self) -> f32 {
        self.chosen
    }

    /// The scale that is shown.
    pub fn shown(self) -> f32 {
        self.chosen.min(self.largest)
    }

    /// Chooses a scale.
    pub fn choose(&mut self, scale: f32) {
        self.chosen = scale;
    }

    /// Limits the scale to a window of this size, in logical pixels.
    pub fn fit(&mut self, window: egui::Vec2) {
        let has_room = |scale: &&f32| {
            let points = window / **scale;
            points.x >= LEAST_WINDOW.x && points.y >= LEAST_WINDOW.y
        };
        self.largest = UI_SCALES.iter().rev().find(has_room).copied().unwrap_or(UI_SCALES[0]);
    }

    /// Scale of the presenting mode in a window of this size, in logical pixels: its texts have the same share of every
    /// screen.
    pub fn presenting(window: egui::Vec2) -> f32 {
        let share = window / PRESENTED;
        // In twentieths, so that a window that is being resized does not rasterize its letters in every frame.
        ((share.x.min(share.y) * 20.0).floor() / 20.0).max(UI_SCALES[0])
    }

    /// Chooses the next larger or smaller scale.
    ///
    /// # Errors
    /// There is none, or the window is too small for it.
    pub fn change(&mut self, larger: bool) -> Result<(), &'static str> {
        let shown = self.shown();
        let next = if larger {
            UI_SCALES.iter().find(|scale| **scale > shown)
        } else {
            UI_SCALES.iter().rev().find(|scale| **scale < shown)
        };
        match next {
            None if larger => Err("The panels have their largest size."),
            None => Err("The panels have their smallest size."),
            Some(next) if *next > self.largest => {
                Err("The window is too small for larger panels. Enlarge the window first.")
            }
            Some(next) => {
                self.chosen = *next;
                Ok(())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fitted(width: f32, height: f32, chosen: f32) -> UiScale {
        let mut scale = UiScale::default();
        scale.choose(chosen);
        scale.fit(egui::vec2(width, height));
        scale
    }

    #[test]
    fn the_scale_changes_in_steps_within_its_limits() {
        let mut scale = fitted(3840.0, 2160.0, 1.0);
        assert_eq!(scale.change(true), Ok(()));
        assert_eq!(scale.shown(), 1.1);
        assert_eq!(scale.change(false), Ok(()));
        assert_eq!(scale.shown(), 1.0);
        while scale.change(true).is_ok() {}
        assert_eq!(scale.shown(), UI_SCALES[UI_SCALES.len() - 1]);
        while scale.change(false).is_ok() {}
        assert_eq!(scale.shown(), UI_SCALES[0]);
    }

    #[test]
    fn presented_texts_have_the_same_share_of_every_screen() {
        for (width, height) in [
            (1024.0, 640.0),
            (1280.0, 720.0),
            (1600.0, 900.0),
            (2560.0, 1440.0),
            (3840.0, 2160.0),
            (1200.0, 1920.0),
        ] {
            let points = egui::vec2(width, height) / UiScale::presenting(egui::vec2(width, height));
            assert!(points.x > 999.9 && points.y > 624.9, "{width} x {height}: {points}");
            assert!(points.x < 1050.0 || points.y < 660.0, "{width} x {height}: {points}");
        }
        assert_eq!(UiScale::presenting(egui::vec2(320.0, 240.0)), UI_SCALES[0]);
    }

    #[test]
    fn the_window_limits_the_scale() {
        for (width, height, largest) in [
            (1024.0, 640.0, 1.25),
            (1280.0, 720.0, 1.5),
            (1600.0, 900.0, 1.75),
            (1920.0, 1080.0, 2.0),
            (640.0, 400.0, 0.75),
        ] {
            let mut scale = fitted(width, height, 2.0);
            assert_eq!(scale.shown(), largest, "{width} x {height}");
            let refused = scale.change(true);
            assert!(refused.is_err(), "{width} x {height}");
            assert_eq!(scale.shown(), largest);
        }
    }

    #[test]
    fn a_window_that_is_enlarged_has_the_chosen_scale_again() {
        let mut scale = fitted(1024.0, 640.0, 2.0);
        assert_eq!((scale.shown(), scale.chosen()), (1.25, 2.0));
        scale.fit(egui::vec2(2560.0, 1440.0));
        assert_eq!(scale.shown(), 2.0);
        // A step counts from what is seen.
        scale.fit(egui::vec2(1024.0, 640.0));
        assert_eq!(scale.change(false), Ok(()));
        assert_eq!(scale.shown(), 1.1);
    }
}
