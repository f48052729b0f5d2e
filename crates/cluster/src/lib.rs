//! One run on many machines: tasks and results travel through a NATS server, in any order.
//!
//! A coordinator is an [`snakes_lab::run::Evaluator`]: it publishes genomes in batches, and an experiment puts the results in
//! the order of the individuals, so the run ends with the hash of a run on one machine. Workers pull batches. The server
//! keeps the queue (JetStream): it delivers a batch again that no worker acknowledged.
//!
//! A task is named by the hash of its content. A result that is delivered or computed twice, or was computed for a
//! coordinator that was killed, therefore counts once, and for the right task only.

mod address;
mod any_message;
mod broker;
mod compute;
mod connection;
mod coordinator;
mod error;
mod hello;
mod latest;
mod machines;
mod names;
mod outcome;
mod packing;
mod proof;
mod puller;
mod store;
mod trouble;
mod watch;
mod wire;
mod worker;

pub use address::BrokerOptions;
pub use any_message::kinds_of_message;
pub use broker::Broker;
pub use compute::{Compute, Shared, Simulator};
pub use coordinator::{Coordinator, CoordinatorOptions};
pub use error::{ClusterError, when_there_is_room};
pub use hello::{RunNotice, WorkerNotice, host_name, unique_name};
pub use machines::{Machines, RunQueue, machines, purge};
pub use outcome::Outcome;
pub use proof::proof;
pub use watch::{ServerWatch, WatchNews, WatchedRun};
pub use wire::{ResultBatch, TaskKind, TaskText, WireError, WorkBatch};
pub use worker::{WorkerOptions, work};
