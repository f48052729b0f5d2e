//! The proof of an engine: a hash that only machines share which compute the same bits and use the same message format.

use xxhash_rust::xxh3::xxh3_64;

use super::error::ClusterError;
use super::wire::{WIRE_FORMAT, hex};
use snakes_lab::run::verify::Trajectories;
use snakes_lab::run::{LocalPool, RunControl};

/// Computes the proof of this machine's engine, which takes a second or two.
///
/// # Errors
/// This machine computes other bits than the reference, or its kind of processor has no reference.
pub fn proof() -> Result<String, ClusterError> {
    let failed = |error: &dyn std::fmt::Display| ClusterError::NoProof(error.to_string());
    let pool = LocalPool::new(1).map_err(|error| failed(&error))?;
    let short =
        Trajectories::short(&pool, &RunControl::default()).map_err(|error| failed(&error))?;
    let text = format!("{WIRE_FORMAT} {:?} {}", short.processors, short.fingerprint());
    Ok(hex(xxh3_64(text.as_bytes())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_proof_is_the_same_each_time() {
        let proof = proof().expect("the reference's bits");
        assert_eq!(proof.len(), 16);
        assert_eq!(super::proof().expect("again"), proof);
    }
}
