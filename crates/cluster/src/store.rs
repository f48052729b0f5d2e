//! Storing messages on the server, even across restarts and lost connections.

use std::time::Duration;

use async_nats::jetstream::context::PublishErrorKind;
use async_nats::jetstream::message::PublishMessage;

use super::broker::Broker;

/// Pause before a request that failed is repeated.
pub const RETRY_PAUSE: Duration = Duration::from_millis(500);

/// Publishes a message repeatedly until the server has stored it, however long this takes. The server stores messages
/// with the same `id` only once. `task` describes the failure in a few words, for the user.
pub async fn publish_until_stored(
    broker: &Broker,
    task: &'static str,
    subject: &str,
    id: &str,
    bytes: &[u8],
) {
    let mut renewals = broker.connection().renewals();
    loop {
        let message = PublishMessage::build().payload(bytes.to_vec().into()).message_id(id);
        let publish =
            async { broker.jetstream().send_publish(subject.to_owned(), message).await?.await };
        let stored = tokio::select! {
            stored = publish => stored,
            // An answer through the lost connection may never come.
            _ = renewals.changed() => continue,
        };
        let Err(error) = stored else {
            broker.connection().succeeded(task);
            return;
        };
        if error.kind() == PublishErrorKind::StreamNotFound {
            // The next attempt shows whether creating the streams helped.
            let _ = broker.make_streams().await;
        }
        broker.connection().failed(task, &error.into());
        tokio::time::sleep(RETRY_PAUSE).await;
    }
}
