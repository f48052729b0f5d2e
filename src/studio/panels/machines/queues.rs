//! The runs on a server, with the number of waiting batches and results of each.

use std::collections::BTreeSet;

use bevy_egui::egui;

use super::rows::{command_line, entry};
use crate::studio::state::machines::KnownServer;
use crate::studio::ui::text_rows::{explain, problem, title, weak};
use snakes_cluster::Machines;

/// Draws the runs on the server, that of this window first.
pub(super) fn queues(ui: &mut egui::Ui, address: &str, known: &KnownServer, machines: &Machines) {
    title(ui, "Runs on the server");
    let names: BTreeSet<&String> = machines.runs.keys().chain(machines.queues.keys()).collect();
    let is_own = |name: &&String| known.own_run.as_ref() == Some(*name);
    let (own, others): (Vec<&String>, Vec<&String>) = names.iter().copied().partition(is_own);
    if names.is_empty() {
        explain(ui, "None.");
    }
    for name in own.iter().chain(&others) {
        queue(ui, name, own.contains(name), machines);
        if !machines.runs.contains_key(*name) {
            explain(ui, "No program waits for it any more. This removes what is left of it:");
            command_line(ui, &format!("snakes machines --nats {address} --purge {name}"));
        }
    }
}

/// Draws the waiting batches and results of a run.
fn queue(ui: &mut egui::Ui, name: &str, is_own: bool, machines: &Machines) {
    let (run, queue) = (machines.runs.get(name), machines.queues.get(name));
    let place = match run {
        _ if is_own => "this window".to_owned(),
        Some(run) => format!("on {}", run.host),
        None => String::new(),
    };
    let pending = run.map(|run| format!("{} evaluations pending, ", run.pending));
    let (batches, results) = queue.map_or((0, 0), |queue| (queue.batches, queue.results));
    let words =
        format!("{}{batches} batches and {results} results waiting", pending.unwrap_or_default());
    let set_aside = run.map_or(&[][..], |run| &run.set_aside);
    let place = weak(ui, place);
    let trouble = run.and_then(|run| run.trouble.as_ref());
    entry(ui, egui::RichText::new(name).strong(), place, |ui| {
        explain(ui, &words);
        trouble.iter().for_each(|trouble| problem(ui, &format!("Waits: {trouble}")));
        if !set_aside.is_empty() {
            let names = set_aside.join(", ");
            problem(ui, &format!("Set aside, because their results were wrong: {names}"));
        }
    });
}
