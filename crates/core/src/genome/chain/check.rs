//! Checks whether a body of blocks can be built.

use super::genes::{segment_genes, waiting_genes};
use super::limits::{INERTIA_RATIO, check_pair};
use super::segment::{MOST_SEGMENTS, Segment};
use crate::check::{Invalid, within};
use crate::genome::gene::check_limits;
use crate::genome::space::GenomeSpace;
use crate::world::check_softness;

/// Checks that a body of these blocks can be built.
///
/// # Errors
/// Returns an error if the number of blocks, a value of a block, or the ratio of two neighbours is not allowed, or if two blocks have the
/// same id.
pub fn check_segments(segments: &[Segment]) -> Result<(), Invalid> {
    within("segments", segments.len(), 2..=MOST_SEGMENTS as usize)?;
    check_limits(|genes| {
        let (mut segments, space) = (segments.to_vec(), GenomeSpace::default());
        segment_genes(&mut segments, &space, genes);
        waiting_genes(&mut segments, &space, genes);
    })?;
    for (index, segment) in segments.iter().enumerate() {
        if let Some(modulus_pa) = segment.youngs_modulus_pa {
            let field = format!("segments[{index}].youngs_modulus_pa");
            let sides_m = [segment.width_m, segment.height_m];
            check_softness(&field, modulus_pa, sides_m, segment.density_kg_m3)?;
        }
        if segments[..index].iter().any(|earlier| earlier.id == segment.id) {
            let field = format!("segments[{index}].id");
            let allowed = "an id that no other block of the body has";
            return Err(Invalid::new(field, segment.id, allowed));
        }
    }
    segments.windows(2).enumerate().try_for_each(|(index, pair)| {
        let of = |measure: fn(&Segment) -> f64| [measure(&pair[0]), measure(&pair[1])];
        let names = format_args!("segments[{index}] and segments[{}]", index + 1);
        let values = [of(Segment::mass_kg), of(Segment::inertia_kg_m2)];
        check_pair(names, values, INERTIA_RATIO)
    })
}
