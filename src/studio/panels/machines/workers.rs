//! The workers on a server: a table if the panel is wide enough, or else a few lines for each worker.

use bevy_egui::egui;

use super::rows::entry;
use crate::studio::ui::text_rows::{at_right, explain, problem, title, weak};
use crate::studio::ui::theme;
use snakes_cluster::{Machines, WorkerNotice};

/// Minimum width of the table of workers, in points.
const TABLE_WIDTH: f32 = 620.0;
/// Reason why a worker is not used.
const OTHER_PROOF: &str = "Not used: it computes other bits than this computer. Use the same version of the program on both.";

/// Returns the workers whose engine computes the same bits as that of this computer.
pub(super) fn used<'m>(
    machines: &'m Machines,
    proof: &'m str,
) -> impl Iterator<Item = &'m WorkerNotice> {
    machines.workers.values().filter(move |worker| worker.proof == proof)
}

/// Describes the workers that are used.
pub(super) fn workers_in_words(machines: &Machines, proof: &str) -> String {
    let all = || used(machines, proof);
    let (count, threads) = (all().count(), all().map(|worker| worker.threads).sum::<u32>());
    let per_s: f32 = all().map(|worker| worker.per_s).sum();
    let plural = if count == 1 { "" } else { "s" };
    match count {
        0 if machines.workers.is_empty() => "no workers".to_owned(),
        0 => "no worker that can be used".to_owned(),
        _ => format!("{count} worker{plural}, {}, {per_s:.1} per second", in_threads(threads)),
    }
}

/// Formats a number of threads: "1 thread", "2 threads".
pub(super) fn in_threads(threads: u32) -> String {
    format!("{threads} thread{}", if threads == 1 { "" } else { "s" })
}

/// Draws the workers as a table or, in a narrow panel, as entries of a few lines.
pub(super) fn workers(ui: &mut egui::Ui, machines: &Machines, proof: &str) {
    title(ui, "Workers");
    if ui.available_width() < TABLE_WIDTH {
        machines.workers.values().for_each(|worker| worker_entry(ui, worker, proof));
        return;
    }
    table(ui, machines, proof);
    if machines.workers.values().any(|worker| worker.proof != proof) {
        problem(ui, OTHER_PROOF);
    }
    for worker in machines.workers.values() {
        let WorkerNotice { worker, trouble, .. } = worker;
        trouble.iter().for_each(|trouble| problem(ui, &format!("{worker} waits: {trouble}")));
    }
}

/// Draws a worker as an entry of a few lines.
fn worker_entry(ui: &mut egui::Ui, worker: &WorkerNotice, proof: &str) {
    let palette = theme::of(ui);
    let is_used = worker.proof == proof;
    let color = if is_used { palette.text } else { palette.text_weak };
    let name = egui::RichText::new(&worker.worker).strong().color(color);
    let pace = egui::RichText::new(format!("{:.1} per s", worker.per_s)).color(color);
    entry(ui, name, pace, |ui| {
        let WorkerNotice { host, evaluations, redelivered, .. } = worker;
        let threads = in_threads(worker.threads);
        let words =
            format!("on {host}: {threads}, {evaluations} evaluations, {redelivered} redelivered");
        explain(ui, &words);
        explain(ui, &worker.engine_words());
        if !is_used {
            problem(ui, OTHER_PROOF);
        }
        worker.trouble.iter().for_each(|trouble| problem(ui, &format!("Waits: {trouble}")));
    });
}

/// Draws the workers as a table.
fn table(ui: &mut egui::Ui, machines: &Machines, proof: &str) {
    let spacing = [theme::GAP * 2.0, theme::GAP / 2.0];
    egui::Grid::new("workers").num_columns(7).spacing(spacing).show(ui, |ui| {
        for (head, hint) in [
            ("Worker", "Its name, which no other worker has"),
            ("Computer", "Name of its computer"),
            ("Threads", "Number of evaluations at the same time"),
            ("Per s", "Evaluations per second, over the last five seconds"),
            ("Evaluations", "Since it started"),
            ("Redelivered", "Batches that another worker had before, and did not finish"),
            ("Engine", "Version, processor and proof: the hash of its bits in some short cases"),
        ] {
            ui.label(weak(ui, head)).on_hover_text(hint);
        }
        ui.end_row();
        for worker in machines.workers.values() {
            let is_used = worker.proof == proof;
            ui.label(&worker.worker);
            ui.label(&worker.host);
            for number in [
                worker.threads.to_string(),
                format!("{:.1}", worker.per_s),
                worker.evaluations.to_string(),
                worker.redelivered.to_string(),
            ] {
                at_right(ui, |ui| drop(ui.label(number)));
            }
            match is_used {
                true => ui.label(worker.engine_words()),
                false => {
                    let words = format!("{}: not used", worker.engine_words());
                    ui.colored_label(theme::of(ui).problem, words)
                }
            };
            ui.end_row();
        }
    });
}
