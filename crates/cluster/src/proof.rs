//! The proof of an engine: a hash that only machines have that compute the same bits and speak the same format.

use xxhash_rust::xxh3::xxh3_64;

use super::error::ClusterError;
use super::wire::{WIRE_FORMAT, hex};
use snakes_lab::run::verify::Trajectories;
use snakes_lab::run::{LocalPool, RunControl};

/// Computes the proof, within a second or two.
///
/// # Errors
/// This machine computes other bits than the reference machine, or there is no reference for it.
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
