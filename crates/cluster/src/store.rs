//! Storing messages on the server, even across restarts and lost connections.

use std::time::Duration;

use async_nats::jetstream::context::PublishErrorKind;
use async_nats::jetstream::message::PublishMessage;
use async_nats::jetstream::stream::{LastRawMessageErrorKind, Stream};

use super::broker::Broker;
use super::trouble::Trouble;

/// Removes the messages with this subject, the latest first, and returns how many there were.
///
/// A purge of the subject would be one request, but leaves `nats-server` 2.9 in the belief that its store is as full as before.
///
/// # Errors
/// A request failed.
pub async fn remove(stream: &Stream, subject: &str) -> Result<u64, Trouble> {
    let (mut removed, mut refused) = (0, None);
    loop {
        let sequence = match stream.get_last_raw_message_by_subject(subject).await {
            Ok(message) => message.sequence,
            Err(error) if error.kind() == LastRawMessageErrorKind::NoMessageFound => {
                return Ok(removed);
            }
            Err(error) => return Err(error.into()),
        };
        match (refused.take(), stream.delete_message(sequence).await) {
            (_, Ok(is_deleted)) => removed += u64::from(is_deleted),
            (Some(before), Err(error)) if before == sequence => return Err(error.into()),
            // Another program may have taken the message meanwhile, so that an earlier message is the latest now.
            (_, Err(_)) => refused = Some(sequence),
        }
    }
}

/// Pause before a request that failed is repeated.
pub const RETRY_PAUSE: Duration = Duration::from_millis(500);

/// Publishes a message repeatedly until the server has stored it, however long this takes. The server stores messages
/// with the same `id` only once. `task` describes the failure in a few words, for the user. While the server's store is
/// full, `make_room` is called before each repetition, and returns whether it made room, so that no pause is needed.
///
/// Never returns if the server refuses the message for good, which [`super::connection::ServerConnection::refusal`] tells.
pub async fn publish_until_stored(
    broker: &Broker,
    task: &'static str,
    subject: &str,
    id: &str,
    bytes: &[u8],
    make_room: impl AsyncFn() -> bool,
) {
    let mut renewals = broker.connection.renewals();
    loop {
        let message = PublishMessage::build().payload(bytes.to_vec().into()).message_id(id);
        let publish =
            async { broker.jetstream.send_publish(subject.to_owned(), message).await?.await };
        let stored = tokio::select! {
            stored = publish => stored,
            // An answer through the lost connection may never come.
            _ = renewals.changed() => continue,
        };
        let Err(error) = stored else {
            broker.connection.succeeded(task);
            return;
        };
        let trouble = match error.kind() {
            // The next attempt shows whether making the streams helped.
            PublishErrorKind::StreamNotFound => {
                broker.make_streams().await.err().unwrap_or(Trouble::NoAnswer)
            }
            _ => error.into(),
        };
        if matches!(trouble, Trouble::Full(_)) && make_room().await {
            continue;
        }
        broker.connection.failed(task, &trouble);
        tokio::time::sleep(RETRY_PAUSE).await;
    }
}
