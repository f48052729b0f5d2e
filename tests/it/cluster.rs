//! Runs on several machines: each must end with the hash of a run on this one.
//!
//! The tests start a real `nats-server`. Without one they are skipped with a line, or fail if the environment variable
//! `SNAKES_CLUSTER_TESTS=required` is set, as in CI. `SNAKES_FAULT_ROUNDS=10` repeats each fault ten times, at other random times.

mod faults;
mod hashes;
mod liars;
mod limits;
mod proxy;
mod refusals;
mod scale;
mod server;
mod windows;
mod words;
