//! Fetching messages from a stream. A server that has lost its store has no streams and no consumers, and does not
//! answer requests. After each new connection and each failed request, consumers are therefore looked up again.

use std::sync::Arc;
use std::time::{Duration, Instant};

use async_nats::jetstream::Message;
use async_nats::jetstream::consumer::PullConsumer;
use async_nats::jetstream::consumer::pull::Batch;
use futures_util::StreamExt;
use tokio::sync::watch;

use super::broker::{Broker, PullSource};
use super::names::PULL_WAIT;
use super::trouble::Trouble;

/// The outcome of a fetch.
pub enum Pulled {
    /// A message that was fetched.
    Message(Box<Message>),
    /// No message arrived for some seconds.
    Nothing,
    /// The server has lost its store: the consumer had to be created again.
    StoreLost,
}

/// Fetches messages with one request after another.
pub struct Puller {
    broker: Arc<Broker>,
    source: PullSource,
    most: usize,
    renewals: watch::Receiver<u64>,
    /// The consumer, or `None` until the server has confirmed that it exists.
    consumer: Option<PullConsumer>,
    request: Option<(Instant, Batch)>,
}

/// The server ends a request after [`PULL_WAIT`]. If it is this much later, it does not know the consumer.
const ANSWER_MARGIN: Duration = Duration::from_secs(2);

impl Puller {
    /// Creates a puller that fetches from `source`, up to `most` messages per request. The consumer must exist.
    pub fn new(broker: &Arc<Broker>, source: PullSource, most: usize) -> Self {
        let renewals = broker.connection.renewals();
        Self { broker: Arc::clone(broker), source, most, renewals, consumer: None, request: None }
    }

    /// Returns the next message, or `Pulled::Nothing` if none arrives soon.
    pub async fn next(&mut self) -> Result<Pulled, Trouble> {
        let is_lost = self.consumer.is_none() && self.find_consumer().await?;
        if is_lost {
            return Ok(Pulled::StoreLost);
        }
        let pulled = self.pull().await;
        if pulled.is_err() {
            (self.consumer, self.request) = (None, None);
        }
        pulled
    }

    /// Finds or creates the consumer. Returns whether it had to be created.
    async fn find_consumer(&mut self) -> Result<bool, Trouble> {
        self.renewals.mark_unchanged();
        let (consumer, is_new) = self.broker.consumer(&self.source).await?;
        self.consumer = Some(consumer);
        Ok(is_new)
    }

    async fn pull(&mut self) -> Result<Pulled, Trouble> {
        let Some(consumer) = &self.consumer else { return Ok(Pulled::Nothing) };
        let (since, messages) = match &mut self.request {
            Some(request) => request,
            none => {
                let request = consumer.batch().max_messages(self.most).expires(PULL_WAIT);
                let messages = request.messages().await?;
                none.insert((Instant::now(), messages))
            }
        };
        let end = *since + PULL_WAIT + ANSWER_MARGIN;
        tokio::select! {
            // Messages that have already arrived come first: the server would deliver them again only after a while.
            biased;
            message = messages.next() => match message {
                Some(Ok(message)) => Ok(Pulled::Message(Box::new(message))),
                Some(Err(error)) => Err(Trouble::of(&*error)),
                None => {
                    self.request = None;
                    Ok(Pulled::Nothing)
                }
            },
            _ = self.renewals.changed() => {
                (self.consumer, self.request) = (None, None);
                Ok(Pulled::Nothing)
            }
            () = tokio::time::sleep_until(end.into()) => Err(Trouble::NoAnswer),
        }
    }
}
