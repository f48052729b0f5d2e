//! The machines panel, for other computers that take part in the evaluations: address of their server, state of the
//! connection, workers, queues, and the commands to type on the other computers.

mod queues;
mod rows;
mod workers;

use bevy_egui::egui;

use crate::studio::commands::{Command, MachinesCommand};
use crate::studio::state::current_run::CurrentRun;
use crate::studio::state::machines::{KnownServer, LinkState, MachinesLink, checked};
use crate::studio::ui::buttons::accent_button;
use crate::studio::ui::lane_dot::dot;
use crate::studio::ui::text_rows::{at_right, explain, problem, text_field, title};
use crate::studio::ui::theme;

use queues::queues;
use rows::command_line;
use workers::{in_threads, used, workers, workers_in_words};

/// The machines panel, with its text field.
#[derive(Debug, Default)]
pub(super) struct MachinesPanel {
    /// Text of the address field while it is edited; `None` while the field shows the address that was used last.
    text: Option<String>,
    /// Reason why the text is no valid address, if it is not.
    problem: Option<String>,
}

/// Command that starts a NATS server.
const SERVER: &str = "nats-server -js";

impl MachinesPanel {
    /// Draws the panel and sends the user's commands.
    pub fn ui(&mut self, ui: &mut egui::Ui, link: &MachinesLink, run: &CurrentRun) {
        title(ui, "Machines");
        explain(
            ui,
            "Other computers can evaluate snakes of your run, too. No result depends on it.",
        );
        self.address(ui, link);
        match &link.state {
            LinkState::Off => {
                state(ui, theme::of(ui).text_weak, "Not connected");
                first_steps(ui);
            }
            LinkState::Connecting(reason) => {
                ui.horizontal_wrapped(|ui| {
                    ui.spinner();
                    ui.label(format!("Connecting to {}…", link.address));
                });
                reason.iter().for_each(|reason| problem(ui, reason));
            }
            LinkState::Failed(reason) => {
                state(ui, theme::of(ui).problem, "Not connected");
                problem(ui, reason);
                first_steps(ui);
            }
            LinkState::Connected(known) => connected(ui, link, known, run),
        }
    }

    /// Draws the address field and the button beside it.
    fn address(&mut self, ui: &mut egui::Ui, link: &MachinesLink) {
        let is_off = matches!(link.state, LinkState::Off | LinkState::Failed(_));
        let mut text = self.text.clone().unwrap_or_else(|| link.address.to_owned());
        let (mut is_asked, mut is_left) = (false, false);
        ui.add_space(theme::GAP / 2.0);
        ui.horizontal(|ui| {
            let name = ui.label("Server");
            at_right(ui, |ui| {
                let (label, hint) = match &link.state {
                    LinkState::Connected(_) => {
                        ("Disconnect", "Compute on this computer only, from the next generation on")
                    }
                    LinkState::Connecting(_) => ("Cancel", "Stop connecting"),
                    _ => ("Connect", "Let the workers of this server compute, too"),
                };
                let can_connect = !is_off || !text.trim().is_empty();
                let button = match is_off && can_connect {
                    true => accent_button(ui, label),
                    false => egui::Button::new(label),
                };
                let response = ui.add_enabled(can_connect, button).on_hover_text(hint);
                let response = response.on_disabled_hover_text("Type the server's address first");
                is_asked = response.clicked() && is_off;
                is_left = response.clicked() && !is_off;
                let field = text_field(&mut text)
                    .hint_text("nats://HOST:4222")
                    .desired_width(ui.available_width())
                    .interactive(is_off);
                let response = ui.add(field).labelled_by(name.id);
                let hint = "Address of the NATS server: nats://HOST:PORT, or tls://HOST:PORT";
                let response = response.on_hover_text(hint);
                if response.changed() {
                    (self.text, self.problem) = (Some(text.clone()), None);
                }
                let is_entered =
                    response.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
                is_asked |= is_entered && can_connect;
            });
        });
        if is_left {
            Command::Machines(MachinesCommand::Disconnect).send(ui);
        } else if is_asked {
            match checked(&text) {
                Ok(url) => {
                    (self.text, self.problem) = (None, None);
                    Command::Machines(MachinesCommand::Connect(url)).send(ui);
                }
                Err(problem) => self.problem = Some(problem),
            }
        }
        if let Some(reason) = &self.problem {
            problem(ui, reason);
        }
    }
}

/// Draws the state of the connection, with a coloured dot.
fn state(ui: &mut egui::Ui, color: egui::Color32, text: &str) {
    ui.horizontal(|ui| {
        dot(ui, color, theme::LANE_DOT);
        ui.add(egui::Label::new(egui::RichText::new(text).strong()).wrap());
    });
}

/// Draws instructions for the first connection.
fn first_steps(ui: &mut egui::Ui) {
    title(ui, "How to begin");
    ui.label(
        "1. Start a NATS server on one computer. The command comes with the package nats-server.",
    );
    command_line(ui, SERVER);
    ui.label("2. Type that computer's address above, and choose Connect. On this computer it is nats://127.0.0.1:4222.");
    ui.label(
        "3. Start workers on other computers. The command appears here once you are connected.",
    );
    explain(
        ui,
        "Whoever reaches the server can use the workers. The window connects without credentials, so start the server in a \
         network that you trust.",
    );
}

/// Draws what is known about a connected server.
fn connected(ui: &mut egui::Ui, link: &MachinesLink, known: &KnownServer, run: &CurrentRun) {
    let palette = theme::of(ui);
    match (&known.problem, &known.machines) {
        (Some(reason), _) => {
            state(ui, palette.problem, "A request to the server failed; asking again");
            problem(ui, reason);
        }
        (None, None) => state(ui, palette.accent, "Connected; looking for workers…"),
        (None, Some(machines)) => {
            let words = workers_in_words(machines, &known.proof);
            state(ui, palette.accent, &format!("Connected: {words}"));
        }
    }
    let used = known.machines.as_ref().map_or(0, |machines| used(machines, &known.proof).count());
    explain(ui, &evaluating_computers(run, used));
    if let Some(machines) = &known.machines {
        let (heading, other) = match machines.workers.is_empty() {
            true => ("No worker is there yet", "a second computer"),
            false => ("Add a worker", "one more computer"),
        };
        if !machines.workers.is_empty() {
            workers(ui, machines, &known.proof);
        }
        title(ui, heading);
        explain(ui, &format!("Type this on {other}, where this program is installed:"));
        let address = &link.address;
        command_line(ui, &format!("snakes worker --nats {address}"));
        let is_own =
            |part: &str| ["//127.", "//localhost", "//[::1]"].iter().any(|own| part.contains(own));
        if address.split(',').all(is_own) {
            explain(
                ui,
                "This address works on this computer only. On another one, type this computer's name or number in the \
                 network in its place.",
            );
        }
        queues(ui, address, known, machines);
    }
}

/// Describes which computers evaluate the run. `workers` is the number of the workers that are used.
fn evaluating_computers(run: &CurrentRun, workers: usize) -> String {
    let threads = format!("{} of this computer", in_threads(run.threads() as u32));
    match (run.is_under_way(), run.is_shared_by_now()) {
        (false, _) => format!("Workers and {threads} compute your next run."),
        (true, _) if workers == 0 => {
            format!("As long as no worker is there, your run has only {threads}.")
        }
        (true, false) => {
            format!("Workers join your run with its next generation, beside {threads}.")
        }
        (true, true) => format!("The workers and {threads} compute your run."),
    }
}

#[cfg(test)]
mod tests;
