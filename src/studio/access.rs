//! For those who hear the window instead of seeing it: what a screen reader asks for is done.
//!
//! The panels' labels reach the screen reader by way of the windowing crates; what it asks for in return, such as a
//! click on a button, is brought to the panels here.

use bevy::a11y::ActionRequest;
use bevy::prelude::*;
use bevy_egui::input::EguiInputEvent;
use bevy_egui::{EguiInputSet, PrimaryEguiContext, egui};

pub(super) fn plugin(app: &mut App) {
    app.add_systems(PreUpdate, forward.in_set(EguiInputSet::ReadBevyMessages));
}

fn forward(
    mut requests: MessageReader<ActionRequest>,
    contexts: Query<Entity, With<PrimaryEguiContext>>,
    mut events: MessageWriter<EguiInputEvent>,
) {
    for context in &contexts {
        events.write_batch(requests.read().map(|request| EguiInputEvent {
            context,
            event: egui::Event::AccessKitActionRequest(request.0.clone()),
        }));
    }
}
