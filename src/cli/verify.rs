//! `snakes verify`: prints a table, a fingerprint, and whether this machine agrees with the reference.

use indicatif::ProgressBar;
use serde_json::json;

use super::args::Args;
use super::error::CliError;
use super::output::{cancel_on_interrupt, print, print_json};
use snakes_core::{ENGINE_VERSION, Engine, Processors};
use snakes_lab::run::verify::Trajectories;

/// Computes all cases on this machine, and compares them with the reference.
pub fn verify(args: &Args) -> Result<(), CliError> {
    let reference = Trajectories::reference()?;
    let evaluator = args.local_evaluator()?;
    let control = cancel_on_interrupt()?;
    let bar = ProgressBar::new(1);
    let computed = Trajectories::computed(&*evaluator, &control, |done, all| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    });
    bar.finish_and_clear();
    let computed = computed?;
    // Cases are matched by name: otherwise an added case would be compared with its neighbour.
    let expected = |what: &str| -> Option<&str> {
        let known = reference.trajectories.iter().find(|trajectory| trajectory.what == what)?;
        Some(known.hash.as_str())
    };
    let rows = || computed.trajectories.iter().map(|found| (found, expected(&found.what)));
    let all = computed.trajectories.len().max(reference.trajectories.len());
    let differ = all - rows().filter(|(found, known)| Some(found.hash.as_str()) == *known).count();
    let fingerprint = computed.fingerprint();
    let agrees = computed == reference;
    if args.json {
        for (found, known) in rows() {
            print_json(&json!({
                "type": "trajectory",
                "what": found.what,
                "hash": found.hash,
                "reference": known,
                "agrees": Some(found.hash.as_str()) == known,
            }))?;
        }
        print_json(&json!({
            "type": "done",
            "engine": ENGINE_VERSION,
            "processors": Processors::THIS,
            "fingerprint": fingerprint,
            "reference": reference.fingerprint(),
            "agrees": agrees,
        }))?;
    } else {
        let width = computed.trajectories.iter().map(|t| t.what.chars().count()).max().unwrap_or(0);
        let mut text = format!("{:<width$}  hash of this machine  reference\n", "trajectory");
        for (found, known) in rows() {
            let verdict = match known {
                Some(known) if found.hash == known => "the same",
                Some(known) => known,
                None => "none",
            };
            text += &format!("{:<width$}  {:<20}  {verdict}\n", found.what, found.hash);
        }
        text += &format!("\nfingerprint  {fingerprint}  (engine {})\n", Engine::THIS);
        if agrees {
            text += &format!(
                "This machine computes the reference's bits in all {} trajectories: champions \
                 saved on other machines replay exactly here, and yours replay exactly there.\n",
                all
            );
        }
        print(&text)?;
    }
    if agrees {
        return Ok(());
    }
    Err(CliError::OtherBits { differ, all, fingerprint, reference: reference.fingerprint() })
}
