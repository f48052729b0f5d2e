//! Runs on several machines: each must end with the hash of a run on this one.
//!
//! The tests start a real `nats-server`. Where there is none they are skipped and say so, unless the environment variable
//! `SNAKES_CLUSTER_TESTS=required` is set, as it is in CI. `SNAKES_FAULT_ROUNDS=10` repeats each fault ten times, at
//! other random instants.

mod faults;
mod hashes;
mod liars;
mod proxy;
mod refusals;
mod scale;
mod server;
mod windows;
mod words;
