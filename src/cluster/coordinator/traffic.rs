//! What a coordinator exchanges with the server: batches, results, notices, and what tasks share.

use std::sync::Arc;
use std::time::Duration;

use async_nats::Subscriber;
use async_nats::jetstream::context::PublishErrorKind;
use async_nats::jetstream::message::PublishMessage;
use futures_util::StreamExt;
use tokio::sync::mpsc::Sender;

use super::SharedTexts;
use crate::cluster::broker::{Broker, one_line, result_consumer, work_stream};
use crate::cluster::hello::WorkerNotice;
use crate::cluster::names::{PULL_WAIT, shared_subject};
use crate::cluster::packing::pack;
use crate::cluster::wire::{ResultBatch, hash_of};
use crate::run::headless::say;

/// Pause before the server is asked again after it refused a request.
const RETRY_PAUSE: Duration = Duration::from_millis(500);
/// Maximum number of results that are fetched at once.
const MOST_FETCHED: usize = 256;

/// What arrived from the server.
pub enum News {
    /// Results of a batch.
    Results(ResultBatch),
    /// A worker told of itself.
    Notice(WorkerNotice),
}

/// Publishes a batch, however long that takes.
pub async fn publish(broker: Arc<Broker>, subject: String, id: String, bytes: Vec<u8>) {
    let mut complaint = String::new();
    loop {
        let message = PublishMessage::build().payload(bytes.clone().into()).message_id(&id);
        let published = async {
            let sent = broker.jetstream().send_publish(subject.clone(), message).await?;
            sent.await
        };
        let Err(error) = published.await else { return };
        if error.kind() == PublishErrorKind::StreamNotFound {
            let _ = work_stream(broker.jetstream()).await;
        }
        let problem = one_line(&error);
        if problem != complaint {
            say(&format!("{}: work cannot be stored: {problem}; trying again", broker.url()));
            complaint = problem;
        }
        tokio::time::sleep(RETRY_PAUSE).await;
    }
}

/// Fetches the results of a run.
pub async fn fetch_results(broker: Arc<Broker>, run: String, news: Sender<News>) {
    let mut complaint = String::new();
    loop {
        let fetched = async {
            let consumer = result_consumer(broker.jetstream(), &run).await?;
            loop {
                let request = consumer.batch().max_messages(MOST_FETCHED).expires(PULL_WAIT);
                let mut messages = request.messages().await.map_err(|error| one_line(&error))?;
                while let Some(message) = messages.next().await {
                    let message = message.map_err(|error| error.to_string())?;
                    match ResultBatch::decode(&message.payload) {
                        Ok(results) if results.run == run => {
                            if news.send(News::Results(results)).await.is_err() {
                                return Ok::<(), String>(());
                            }
                        }
                        Ok(_) => {}
                        Err(error) => say(&format!("a result is ignored: {error}")),
                    }
                    // Without an acknowledgement the results arrive again, and count once.
                    let _ = message.ack().await;
                }
            }
        };
        let Err(problem) = fetched.await else { return };
        if problem != complaint {
            say(&format!("{}: no results: {problem}; asking again", broker.url()));
            complaint = problem;
        }
        tokio::time::sleep(RETRY_PAUSE).await;
    }
}

/// Hears what workers tell of themselves.
pub async fn hear_workers(mut notices: Subscriber, news: Sender<News>) {
    while let Some(message) = notices.next().await {
        let Ok(notice) = WorkerNotice::read(&message.payload) else { continue };
        if news.send(News::Notice(notice)).await.is_err() {
            return;
        }
    }
}

/// Answers workers that ask for what tasks share.
pub async fn answer_shared(broker: Arc<Broker>, run: String, shared: Arc<SharedTexts>) {
    let subject = shared_subject(&run, "*");
    let Ok(mut requests) = broker.client().subscribe(subject).await else { return };
    while let Some(request) = requests.next().await {
        let hash = request.subject.rsplit('.').next().unwrap_or_default();
        let text = hash_of("hash", hash).ok().and_then(|hash| shared.get(hash));
        if let (Some(reply), Some(text)) = (request.reply, text) {
            let _ = broker.client().publish(reply, pack(text.to_string()).into()).await;
        }
    }
}
