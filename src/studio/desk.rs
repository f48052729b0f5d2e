//! How the window is arranged: where the panels are, how large they are drawn, what lies over all of it.

use bevy::prelude::*;

use super::panels::{Layout, PanelKind};
use super::{Frame, Opened};
use crate::save::UI_SCALES;

/// Something that lies over the window until it is left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Over {
    /// All keys.
    Keys,
    /// The palette of commands.
    Palette,
    /// A step of the tour; the first is 0.
    Tour(usize),
}

/// How the window is arranged.
#[derive(Resource, Debug)]
pub(super) struct Desk {
    /// Where the panels are.
    pub layout: Layout,
    /// How large the panels are drawn; 1 is usual.
    pub scale: f32,
    /// Whether the stage is alone, without panels.
    pub is_bare: bool,
    /// Whether the tour was taken or skipped, now or at some time before.
    pub tour_is_over: bool,
    /// The setting that somebody is looking for, until the panel of settings has heard of it.
    pub sought: Option<&'static str>,
    over: Option<Over>,
}

impl Default for Desk {
    fn default() -> Self {
        Self {
            layout: Layout::default(),
            scale: 1.0,
            is_bare: false,
            tour_is_over: true,
            sought: None,
            over: None,
        }
    }
}

impl Desk {
    /// As it is at first, with the tour or without.
    pub fn new(tour_is_over: bool) -> Self {
        Self { tour_is_over, ..Self::default() }
    }

    /// What lies over the window.
    pub fn over(&self) -> Option<Over> {
        self.over
    }

    /// Lays something over the window; what lay there goes, and what is there already goes too.
    pub fn cover(&mut self, over: Over) {
        self.leave_tour();
        self.over = (self.over != Some(over)).then_some(over);
    }

    /// Leaves what lies over the window.
    pub fn uncover(&mut self) {
        self.leave_tour();
        self.over = None;
    }

    fn leave_tour(&mut self) {
        if matches!(self.over, Some(Over::Tour(_))) {
            self.tour_is_over = true;
        }
    }

    /// Draws the panels by a step larger or smaller.
    pub fn change_scale(&mut self, larger: bool) {
        let is_next =
            |scale: &&f32| if larger { **scale > self.scale } else { **scale < self.scale };
        let next = if larger {
            UI_SCALES.iter().find(is_next)
        } else {
            UI_SCALES.iter().rev().find(is_next)
        };
        self.scale = next.copied().unwrap_or(self.scale);
    }
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Desk>().add_systems(Update, open_first.in_set(Frame::TakeIn));
}

/// Whoever opens the window for the first time is shown around; whoever opens it with a comparison came for that.
fn open_first(mut desk: ResMut<Desk>, opened: Res<Opened>, mut is_done: Local<bool>) {
    if std::mem::replace(&mut *is_done, true) {
        return;
    }
    if opened.0.is_some() {
        desk.layout.open(PanelKind::Charts);
    } else if !desk.tour_is_over {
        desk.over = Some(Over::Tour(0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_grow_and_shrink_in_steps_up_to_their_ends() {
        let mut desk = Desk::default();
        desk.change_scale(true);
        assert_eq!(desk.scale, 1.1);
        desk.change_scale(false);
        assert_eq!(desk.scale, 1.0);
        (0..20).for_each(|_| desk.change_scale(true));
        assert_eq!(desk.scale, UI_SCALES[UI_SCALES.len() - 1]);
        (0..20).for_each(|_| desk.change_scale(false));
        assert_eq!(desk.scale, UI_SCALES[0]);
    }

    #[test]
    fn what_is_asked_for_twice_goes_and_a_tour_that_is_left_is_over() {
        let mut desk = Desk { tour_is_over: false, ..Desk::default() };
        desk.cover(Over::Keys);
        assert_eq!(desk.over(), Some(Over::Keys));
        desk.cover(Over::Keys);
        assert_eq!(desk.over(), None);
        assert!(!desk.tour_is_over);
        desk.cover(Over::Tour(0));
        desk.cover(Over::Tour(1));
        assert_eq!(desk.over(), Some(Over::Tour(1)));
        desk.uncover();
        assert!(desk.over().is_none() && desk.tour_is_over);
    }
}
