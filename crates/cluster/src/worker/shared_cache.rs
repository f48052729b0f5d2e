//! Cache of the trials and genomes that recent batches share. Each is fetched once from its coordinator.

use std::sync::Arc;
use std::time::Duration;

use crate::broker::Broker;
use crate::compute::Shared;
use crate::latest::Latest;
use crate::names::shared_subject;
use crate::packing::unpack;
use crate::wire::{WorkBatch, hex, shared_hash};
use snakes_lab::run::headless::say;

/// Longest time that a coordinator may take to answer.
const ANSWER_WAIT: Duration = Duration::from_secs(3);

/// The trials and genomes that were used last, by hash.
pub type SharedCache = Latest<Arc<Shared>>;

impl SharedCache {
    /// Fetches the trial or the genome that the tasks of a batch share from the coordinator. Returns `None` if there is
    /// no valid answer.
    pub async fn fetch(&self, broker: &Broker, work: &WorkBatch) -> Option<Arc<Shared>> {
        let subject = shared_subject(&work.run, &hex(work.shared));
        let request = async_nats::Request::new().timeout(Some(ANSWER_WAIT));
        let answer = broker.client.send_request(subject, request).await;
        let bytes = answer.ok()?.payload;
        let read = unpack(&bytes).and_then(|text| {
            // The coordinator hashed its own text, so an equal hash means an equal trial or genome.
            let is_it = shared_hash(work.kind, &text) == work.shared;
            is_it.then(|| Shared::read(work.kind, &text)).transpose()
        });
        match read {
            Ok(Some(shared)) => {
                let shared = Arc::new(shared);
                self.keep(work.shared, Arc::clone(&shared));
                Some(shared)
            }
            // A coordinator that does not know the hash answers with another text.
            Ok(None) => None,
            Err(error) => {
                say(&format!("run {}: its trial cannot be used: {error}", work.run));
                None
            }
        }
    }
}
