//! Executes the actions that a screen reader requests.
//!
//! Windowing crates pass the panels' labels to the screen reader. This module passes the screen reader's requests, such
//! as a click on a button, to egui.

use bevy::a11y::ActionRequest;
use bevy::prelude::*;
use bevy_egui::input::EguiInputEvent;
use bevy_egui::{EguiInputSet, PrimaryEguiContext, egui};

pub(crate) fn plugin(app: &mut App) {
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
