//! Scale of the panels: the user's choice, limited by the size of the window.

use bevy_egui::egui;

use snakes_core::save::UI_SCALES;

/// Minimum size of the window in points: the stage beside a panel of minimum width, above the player. A scale that
/// would leave fewer points is not used.
pub const LEAST_WINDOW: egui::Vec2 = egui::vec2(800.0, 480.0);

/// Minimum size of the window in points at its usual scale. In a larger window, panels and their texts grow.
const USUAL_WINDOW: egui::Vec2 = egui::vec2(1280.0, 720.0);

/// Window size at which the presenting mode has the scale 1, in logical pixels.
const PRESENTED: egui::Vec2 = egui::vec2(1000.0, 625.0);

/// Reason why texts cannot be larger.
const NO_ROOM: &str = "The window is too small for larger panels. Enlarge the window first.";

/// Scale of the panels: the usual one of the window, the user's choice and the window's limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UiScale {
    /// Factor that the user chose, relative to the usual scale. It applies again when the window becomes large enough.
    pub chosen: f32,
    /// Usual scale of a window of this size.
    usual: f32,
    /// Largest scale for which the window has room.
    largest: f32,
}

impl Default for UiScale {
    fn default() -> Self {
        Self { chosen: 1.0, usual: 1.0, largest: UI_SCALES[UI_SCALES.len() - 1] }
    }
}

impl UiScale {
    /// Returns the scale in use: the allowed one that is nearest to the user's choice, or the largest that fits.
    pub fn shown(self) -> f32 {
        let wanted = self.usual * self.chosen;
        let distance = |scale: &f32| (scale - wanted).abs();
        let nearest = UI_SCALES.into_iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.unwrap_or(1.0).min(self.largest)
    }

    /// Adapts the scale to a window of this size, in logical pixels.
    pub fn fit(&mut self, window: egui::Vec2) {
        let largest = |least: egui::Vec2| {
            let has_room = |scale: &f32| {
                let points = window / *scale;
                points.x >= least.x && points.y >= least.y
            };
            UI_SCALES.into_iter().rev().find(has_room)
        };
        self.largest = largest(LEAST_WINDOW).unwrap_or(UI_SCALES[0]);
        self.usual = largest(USUAL_WINDOW).unwrap_or(1.0).max(1.0);
    }

    /// Returns the scale of the presenting mode for a window of this size, in logical pixels. Texts take the same share
    /// of every screen.
    pub fn presenting(window: egui::Vec2) -> f32 {
        let share = window / PRESENTED;
        // In steps of 0.05, so that the glyphs are not rasterized anew in every frame while the window is resized.
        ((share.x.min(share.y) * 20.0).floor() / 20.0).max(UI_SCALES[0])
    }

    /// Makes all texts a quarter larger than usual; texts that are larger already get their usual size.
    ///
    /// # Errors
    /// Says that the window is too small for larger texts.
    pub fn toggle_larger(&mut self) -> Result<(), &'static str> {
        let before = *self;
        self.chosen = if before.chosen > 1.0 { 1.0 } else { 1.25 };
        if self.chosen > 1.0 && self.shown() <= before.shown() {
            *self = before;
            return Err(NO_ROOM);
        }
        Ok(())
    }

    /// Chooses the next larger or smaller scale.
    ///
    /// # Errors
    /// Says that the scale is at its limit, or that the window is too small for the next one.
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
            Some(next) if *next > self.largest => Err(NO_ROOM),
            Some(next) => {
                let [smallest, .., largest] = UI_SCALES;
                self.chosen = (next / self.usual).clamp(smallest, largest);
                Ok(())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fitted(width: f32, height: f32, chosen: f32) -> UiScale {
        let mut scale = UiScale { chosen, ..UiScale::default() };
        scale.fit(egui::vec2(width, height));
        scale
    }

    #[test]
    fn the_scale_changes_in_steps_within_its_limits() {
        let mut scale = fitted(1280.0, 720.0, 1.0);
        assert_eq!(scale.change(true), Ok(()));
        assert_eq!(scale.shown(), 1.1);
        assert_eq!(scale.change(false), Ok(()));
        assert_eq!(scale.shown(), 1.0);
        while scale.change(true).is_ok() {}
        assert_eq!(scale.shown(), 1.5, "the largest for which there is room");
        while scale.change(false).is_ok() {}
        assert_eq!(scale.shown(), UI_SCALES[0]);
    }

    #[test]
    fn larger_for_a_projector_is_a_switch() {
        let mut scale = fitted(1280.0, 720.0, 1.0);
        for (shown, is_on) in [(1.25, true), (1.0, false), (1.25, true)] {
            assert_eq!(scale.toggle_larger(), Ok(()));
            assert_eq!((scale.shown(), scale.chosen > 1.0), (shown, is_on));
        }
        assert_eq!(scale.change(true), Ok(()));
        assert_eq!((scale.toggle_larger(), scale.shown()), (Ok(()), 1.0), "from any larger size");
        let mut small = fitted(800.0, 480.0, 1.0);
        assert_eq!((small.toggle_larger(), small.chosen), (Err(NO_ROOM), 1.0));
    }

    #[test]
    fn texts_grow_with_the_window_and_a_choice_is_relative_to_it() {
        for (width, height, usual) in [
            (800.0, 600.0, 1.0),
            (1280.0, 720.0, 1.0),
            (1600.0, 900.0, 1.25),
            (1920.0, 1080.0, 1.5),
            (3840.0, 2160.0, 2.0),
        ] {
            assert_eq!(fitted(width, height, 1.0).shown(), usual, "{width} x {height}");
        }
        let mut scale = fitted(1920.0, 1080.0, 1.0);
        assert_eq!(scale.change(false), Ok(()));
        assert_eq!(scale.shown(), 1.25);
        scale.fit(egui::vec2(1280.0, 720.0));
        assert_eq!(scale.shown(), 0.9, "smaller there, too");
        assert!((0.75..=2.0).contains(&scale.chosen));
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
        assert_eq!((scale.shown(), scale.chosen), (1.25, 2.0));
        scale.fit(egui::vec2(2560.0, 1440.0));
        assert_eq!(scale.shown(), 2.0);
        // A step starts from the scale in use, not from the user's choice.
        scale.fit(egui::vec2(1024.0, 640.0));
        assert_eq!(scale.change(false), Ok(()));
        assert_eq!(scale.shown(), 1.1);
    }
}
