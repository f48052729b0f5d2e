//! Traffic of a coordinator with the server: results, notices, and requests for trials and genomes.

use std::sync::Arc;

use async_nats::Subscriber;
use futures_util::StreamExt;
use tokio::sync::mpsc::Sender;

use super::common::Common;
use crate::broker::{Broker, PullSource};
use crate::hello::WorkerNotice;
use crate::names::shared_subject;
use crate::packing::pack;
use crate::puller::{Pulled, Puller};
use crate::store::RETRY_PAUSE;
use crate::wire::ResultBatch;
use snakes_core::check::hash_of;
use snakes_lab::run::headless::say;

/// Maximum number of results that are fetched with one request.
const MOST_FETCHED: usize = 256;

/// A message that arrived from the server.
pub enum News {
    /// Results of a batch.
    Results(ResultBatch),
    /// A notice of a worker.
    Notice(WorkerNotice),
    /// A notice of any run, which shows that the connection works.
    ServerIsHeard,
    /// The server has lost its store.
    StoreLost,
}

/// Fetches the results of a run.
pub async fn fetch_results(broker: Arc<Broker>, run: String, news: Sender<News>) {
    const TASK: &str = "no results arrive";
    let mut puller = Puller::new(&broker, PullSource::Results(run.clone()), MOST_FETCHED);
    loop {
        match puller.next().await {
            Ok(Pulled::Message(message)) => {
                broker.connection.succeeded(TASK);
                match ResultBatch::decode(&message.payload) {
                    Ok(results) if results.run == run => {
                        if news.send(News::Results(results)).await.is_err() {
                            return;
                        }
                    }
                    Ok(_) => {}
                    Err(error) => say(&format!("a result is ignored: {error}")),
                }
                // Without an acknowledgement the results arrive again, but count only once.
                let _ = message.ack().await;
            }
            Ok(Pulled::Nothing) => broker.connection.succeeded(TASK),
            Ok(Pulled::StoreLost) => {
                if news.send(News::StoreLost).await.is_err() {
                    return;
                }
            }
            Err(trouble) => {
                broker.connection.failed(TASK, &trouble);
                tokio::time::sleep(RETRY_PAUSE).await;
            }
        }
    }
}

/// Receives the notices of workers and of runs. The run's own notices come back as well, so they show each second that
/// the server can be heard.
pub async fn hear_notices(mut workers: Subscriber, mut runs: Subscriber, news: Sender<News>) {
    loop {
        let heard = tokio::select! {
            Some(message) = workers.next() => match WorkerNotice::read(&message.payload) {
                Ok(notice) => News::Notice(notice),
                Err(_) => continue,
            },
            Some(_) = runs.next() => News::ServerIsHeard,
            else => return,
        };
        if news.send(heard).await.is_err() {
            return;
        }
    }
}

/// Answers workers that request the trial or the genome that tasks share.
pub async fn answer_shared(broker: Arc<Broker>, run: String, common: Arc<Common>) {
    let subject = shared_subject(&run, "*");
    let Ok(mut requests) = broker.client.subscribe(subject).await else { return };
    while let Some(request) = requests.next().await {
        let hash = request.subject.rsplit('.').next().unwrap_or_default();
        let text = hash_of("hash", hash).ok().and_then(|hash| common.texts.get(hash));
        if let (Some(reply), Some(text)) = (request.reply, text) {
            let _ = broker.client.publish(reply, pack(text.to_string()).into()).await;
        }
    }
}
