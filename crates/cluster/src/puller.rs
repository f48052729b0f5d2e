//! Fetching messages. A server that has lost its store has neither streams nor consumers, and leaves requests without an
//! answer: they are made again after each new connection, and when a request is refused or not answered.

use std::sync::Arc;
use std::time::{Duration, Instant};

use async_nats::jetstream::Message;
use async_nats::jetstream::consumer::PullConsumer;
use async_nats::jetstream::consumer::pull::Batch;
use futures_util::StreamExt;
use tokio::sync::watch;

use super::broker::{Broker, PullSource};
use super::connection::Trouble;
use super::names::PULL_WAIT;

/// The outcome of a fetch.
pub enum Pulled {
    /// A message.
    Message(Box<Message>),
    /// No message for some seconds.
    Nothing,
    /// The server has lost what it stored: the consumer had to be made again.
    StoreLost,
}

/// Fetches messages, from one request after the other.
pub struct Puller {
    broker: Arc<Broker>,
    source: PullSource,
    most: usize,
    renewals: watch::Receiver<u64>,
    /// None until it is known that the server has it.
    consumer: Option<PullConsumer>,
    request: Option<(Instant, Batch)>,
}

/// The server ends a request after [`PULL_WAIT`]. If it has not done so this much later, it does not know the consumer.
const ANSWER_MARGIN: Duration = Duration::from_secs(2);

impl Puller {
    /// Fetches from `source`, up to `most` messages with a request. The consumer must have been made before.
    pub fn new(broker: &Arc<Broker>, source: PullSource, most: usize) -> Self {
        let renewals = broker.connection().renewals();
        Self { broker: Arc::clone(broker), source, most, renewals, consumer: None, request: None }
    }

    /// The next message, if one comes soon.
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

    /// Finds the consumer or makes it. Returns whether it had to be made.
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
            // Messages that have arrived come first: the server would deliver them again only after a while.
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
