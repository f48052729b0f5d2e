//! The coordinator's own threads that compute.

use std::sync::Arc;
use std::time::Duration;

use crossbeam_channel::bounded;
use tokio::sync::mpsc::UnboundedSender;

use super::actor::CoordinatorCommand;
use super::common::Common;
use crate::compute::{Compute, outcome_of_texts};

/// Pause of an idle thread before it requests a task again.
const IDLE_PAUSE: Duration = Duration::from_millis(10);

/// Computes tasks until the coordinator ends.
pub fn compute(
    commands: &UnboundedSender<CoordinatorCommand>,
    common: &Common,
    compute: &Arc<dyn Compute>,
) {
    loop {
        let (sender, answer) = bounded(1);
        if commands.send(CoordinatorCommand::TakeLocal(sender)).is_err() {
            return;
        }
        match answer.recv() {
            Err(_) => return,
            Ok(None) => std::thread::sleep(IDLE_PAUSE),
            Ok(Some((key, kind, of, task))) => {
                let text = common.texts.get(of).unwrap_or_default();
                let outcome = outcome_of_texts(compute, kind, &text, &task);
                if commands.send(CoordinatorCommand::Local(key, outcome)).is_err() {
                    return;
                }
            }
        }
    }
}
