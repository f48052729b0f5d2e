//! Commands that are sent while a frame is drawn. They wait in egui's context, as commands to a viewport do.

use bevy_egui::egui;

use crate::studio::commands::Command;

/// Returns the place of the commands in the context's data.
fn place() -> egui::Id {
    egui::Id::new("outbox")
}

impl Command {
    /// Sends the command from where it is given: a `Ui` or a context.
    pub fn send(self, context: &egui::Context) {
        context.data_mut(|data| data.get_temp_mut_or_default::<Vec<Self>>(place()).push(self));
    }

    /// Sends several commands in their order.
    pub fn send_all(commands: impl IntoIterator<Item = Self>, context: &egui::Context) {
        commands.into_iter().for_each(|command| command.send(context));
    }

    /// Returns the commands that were sent since they were last taken, in their order.
    pub fn take_sent(context: &egui::Context) -> Vec<Self> {
        context.data_mut(|data| data.remove_temp(place())).unwrap_or_default()
    }
}
