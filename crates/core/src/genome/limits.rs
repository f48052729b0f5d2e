//! Limits of bodies in every space of genomes.

use std::ops::RangeInclusive;

use super::gene::Quantity;

/// Half a turn is where a joint angle wraps around; a limit stays clear of it.
pub const LARGEST_LIMIT_RAD: f32 = 3.0;
/// The range of every size of a block or a part in a file, in metres: that of the sizes in settings.
pub const SIZE_RANGE_M: RangeInclusive<f32> = 0.1..=10.0;
/// The range of every density, in kg/m³: from a balloon to tungsten.
pub const DENSITY_RANGE_KG_M3: RangeInclusive<f32> = 0.1..=20_000.0;
/// The range of every Young's modulus, in Pa: from a soap bubble to rubber.
pub const MODULUS_RANGE_PA: RangeInclusive<f32> = 1.0..=1.0e7;

/// A size of a block or a part.
pub const SIZE: Quantity = Quantity::new("m", SIZE_RANGE_M);
/// A density.
pub const DENSITY: Quantity = Quantity::new("kg/m³", DENSITY_RANGE_KG_M3);
/// A Young's modulus.
pub const MODULUS: Quantity = Quantity::new("Pa", MODULUS_RANGE_PA);
/// A limit of a joint to either side, or another angle up to one.
pub const LIMIT: Quantity = Quantity::new("rad", 0.0..=LARGEST_LIMIT_RAD);
/// A share of a whole.
pub const SHARE: Quantity = Quantity::pure(0.0..=1.0);
/// A share to either side of a middle.
pub const SIDED_SHARE: Quantity = Quantity::pure(-1.0..=1.0);
/// A phase. One turn is enough; a little more is no harm.
pub const PHASE: Quantity = Quantity::new("rad", -10.0..=10.0);

#[cfg(test)]
mod tests {
    use crate::check::Invalid;
    use crate::genome::gene::{Gene, Genes};
    use crate::genome::{ControllerKind, Genome, GenomeShape, GenomeSpace};
    use crate::rng::{Purpose, stream};

    /// A random genome of each kind of controller, and one with soft blocks of its own.
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

    /// The genome with another value of one gene. None where the gene is a choice, which cannot have such a value.
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
                    let expected = format!("{field} is {beyond}; allowed: {allowed}");
                    assert!(message.ends_with(&expected), "{message}, not {expected}");
                }
                // A body of such parts may be impossible for another reason.
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
