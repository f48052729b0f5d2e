//! Trials and genomes that the tasks of recent batches share: fetched from the coordinator once.

use std::sync::Arc;
use std::time::Duration;

use crate::broker::Broker;
use crate::compute::Shared;
use crate::latest::Latest;
use crate::names::shared_subject;
use crate::packing::unpack;
use crate::wire::{WorkBatch, hex, shared_hash};
use snakes_lab::run::headless::say;

/// How long a coordinator may take to answer.
const ANSWER_WAIT: Duration = Duration::from_secs(3);

/// The trials and genomes that were used last.
pub type SharedCache = Latest<Arc<Shared>>;

impl SharedCache {
    /// The trial or the genome that the tasks of a batch share, from its coordinator; none if that does not answer, or sends something else.
    pub async fn fetch(&self, broker: &Broker, work: &WorkBatch) -> Option<Arc<Shared>> {
        let subject = shared_subject(&work.run, &hex(work.shared));
        let request = async_nats::Request::new().timeout(Some(ANSWER_WAIT));
        let answer = broker.client().send_request(subject, request).await;
        let bytes = answer.ok()?.payload;
        let read = unpack(&bytes).and_then(|text| {
            // The coordinator's hash is of its own text, so equal hashes mean an equal trial.
            let is_it = shared_hash(work.kind, &text) == work.shared;
            is_it.then(|| Shared::read(work.kind, &text)).transpose()
        });
        match read {
            Ok(Some(shared)) => {
                let shared = Arc::new(shared);
                self.keep(work.shared, Arc::clone(&shared));
                Some(shared)
            }
            // A coordinator that has ended answers with nothing.
            Ok(None) => None,
            Err(error) => {
                say(&format!("run {}: its trial cannot be used: {error}", work.run));
                None
            }
        }
    }
}
