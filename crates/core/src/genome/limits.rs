//! Limits of genes in every space of genomes.

use std::ops::RangeInclusive;

use super::gene::Quantity;

/// Largest limit of a joint, in radians: less than half a turn, at which a joint angle wraps around.
pub const LARGEST_LIMIT_RAD: f32 = 3.0;
/// Range of every size of a block or a part in a file, in metres. It is equal to the range of sizes in settings.
pub const SIZE_RANGE_M: RangeInclusive<f32> = 0.1..=10.0;
/// Range of every density, in kg/m³: from a balloon to tungsten.
pub const DENSITY_RANGE_KG_M3: RangeInclusive<f32> = 0.1..=20_000.0;
/// Range of every Young's modulus, in Pa: from a soap bubble to rubber.
pub const MODULUS_RANGE_PA: RangeInclusive<f32> = 1.0..=1.0e7;

/// Quantity of a size of a block or a part.
pub const SIZE: Quantity = Quantity::new("m", SIZE_RANGE_M);
/// Quantity of a density.
pub const DENSITY: Quantity = Quantity::new("kg/m³", DENSITY_RANGE_KG_M3);
/// Quantity of a Young's modulus.
pub const MODULUS: Quantity = Quantity::new("Pa", MODULUS_RANGE_PA);
/// Quantity of a joint's limit to either side, or of another angle within such a limit.
pub const LIMIT: Quantity = Quantity::new("rad", 0.0..=LARGEST_LIMIT_RAD);
/// Quantity of a share of a whole.
pub const SHARE: Quantity = Quantity::pure(0.0..=1.0);
/// Quantity of a share to either side of a middle.
pub const SIDED_SHARE: Quantity = Quantity::pure(-1.0..=1.0);
/// Quantity of a phase. The range is larger than one turn, although one turn is enough.
pub const PHASE: Quantity = Quantity::new("rad", -10.0..=10.0);

#[cfg(test)]
mod tests {
    use crate::check::Invalid;
    use crate::genome::gene::{Gene, Genes};
    use crate::genome::{ControllerKind, Genome, GenomeShape, GenomeSpace};
    use crate::rng::{Purpose, stream};

    /// Returns a random genome of each kind of controller, and one with soft blocks of its own.
    fn genomes() -> Vec<Genome> {
        let of_kind = |&controller| GenomeSpace { controller, ..GenomeSpace::default() };
        let mut spaces: Vec<GenomeSpace> = ControllerKind::ALL.iter().map(of_kind).collect();
        let mut of_blocks = of_kind(&ControllerKind::Gait);
        (of_blocks.bodies.vary, of_blocks.bodies.soft) = (true, true);
        spaces.push(of_blocks);
        for space in &mut spaces {
            space.bodies.vary |= space.controller == ControllerKind::PartNeurons;
        }
        let shape = GenomeShape { joints: 3, duration_s: 0.5 };
        let random =
            |space: &GenomeSpace| space.random_genome(shape, &mut stream(1, 1, 0, Purpose::Birth));
        spaces.iter().map(random).collect()
    }

    fn visit_all(genome: &mut Genome, mut visit: impl FnMut(Gene<'_>, &mut f32)) {
        let (space, genes) = (GenomeSpace::default(), &mut Genes::to(&mut visit));
        genome.body.waiting_genes(&space, genes);
        genome.genes(&space, genes);
    }

    /// Returns the genome with another value of one gene; `None` if the gene is a choice from a list, which cannot have this value.
    fn with_value(genome: &Genome, index: usize, wanted: f32) -> Option<Genome> {
        let mut changed = genome.clone();
        let mut left = index;
        visit_all(&mut changed, |_, value| {
            if left == 0 {
                *value = wanted;
            }
            left = left.wrapping_sub(1);
        });
        let mut values = Vec::new();
        visit_all(&mut changed, |_, value| values.push(value.to_bits()));
        (values[index] == wanted.to_bits()).then_some(changed)
    }

    fn check(genome: &Genome) -> Result<(), Invalid> {
        genome.body.check().and_then(|()| genome.controller.check())
    }

    #[test]
    fn every_gene_may_have_its_limits_and_no_value_beyond_them() {
        for genome in genomes() {
            check(&genome).expect("its own");
            let mut genes = Vec::new();
            visit_all(&mut genome.clone(), |gene, _| {
                genes.push((gene.field.to_string(), gene.quantity));
            });
            for (index, (field, quantity)) in genes.iter().enumerate() {
                let [least, most] = quantity.limits;
                let allowed = quantity.range().words();
                for beyond in
                    [least.next_down(), most.next_up(), f32::NAN, f32::INFINITY, f32::NEG_INFINITY]
                {
                    let Some(changed) = with_value(&genome, index, beyond) else { continue };
                    let message = check(&changed).expect_err(field).to_string();
                    let expected = Invalid::new(field, beyond, &allowed).to_string();
                    assert!(message.ends_with(&expected), "{message}, not {expected}");
                }
                // A body with such parts may be impossible for another reason.
                for value in [least, most] {
                    let Some(changed) = with_value(&genome, index, value) else { continue };
                    let message = check(&changed).err().map_or(String::new(), |e| e.to_string());
                    let refused = format!("{field} is {value}; allowed: {allowed}");
                    assert!(!message.ends_with(&refused), "{message}");
                }
            }
        }
    }
}
