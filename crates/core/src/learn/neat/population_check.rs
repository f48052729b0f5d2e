//! Checks of a population that was read from a file.

use std::collections::BTreeMap;

use super::genome::NetworkGenome;
use super::population::{LARGEST_NEAT_POPULATION, NeatPopulation};
use super::species::{FitnessProgress, SpeciesSummary};
use crate::check::{Invalid, within};

impl NeatPopulation {
    /// Checks a population that was read from a file.
    ///
    /// # Errors
    /// Returns an error if a setting, genome or species is not allowed, or if they do not belong together.
    pub fn check(&self) -> Result<(), Invalid> {
        self.rules.check().map_err(|error| error.inside("rules"))?;
        within("genomes", self.genomes.len(), 1..=LARGEST_NEAT_POPULATION)?;
        within("threshold", self.threshold, 0.0..=1e9)?;
        check_progress(&self.progress).map_err(|error| error.inside("progress"))?;
        self.check_genomes()?;
        self.check_species()?;
        within("evaluated", self.evaluated.len(), 0..=LARGEST_NEAT_POPULATION)?;
        self.evaluated.iter().try_for_each(check_summary).map_err(|error| error.inside("evaluated"))
    }

    fn check_genomes(&self) -> Result<(), Invalid> {
        let shape = |genome: &NetworkGenome| {
            let NetworkGenome { inputs, outputs, parameters, .. } = genome;
            format!("{inputs} inputs, {outputs} outputs, {} parameters", parameters.len())
        };
        // An innovation number must mean the same link in every genome.
        let mut ends = BTreeMap::new();
        for (place, genome) in self.genomes.iter().enumerate() {
            let inside = |error: Invalid| error.inside(&format!("genomes[{place}]"));
            genome.check(&self.rules).map_err(inside)?;
            self.innovations.check(genome).map_err(inside)?;
            let (first, own) = (shape(&self.genomes[0]), shape(genome));
            if own != first {
                return Err(Invalid::new(format!("genomes[{place}]"), own, first));
            }
            for link in &genome.links {
                let own = (link.from, link.to);
                let (from, to) = *ends.entry(link.innovation).or_insert(own);
                if own != (from, to) {
                    let value = format!("{} to {}", own.0, own.1);
                    let field = format!("genomes[{place}].links[innovation {}]", link.innovation);
                    return Err(Invalid::new(field, value, format!("{from} to {to}")));
                }
            }
        }
        Ok(())
    }

    fn check_species(&self) -> Result<(), Invalid> {
        within("memberships", self.memberships.len(), self.genomes.len()..=self.genomes.len())?;
        within("next_species", self.next_species, 1..=u32::MAX - 1)?;
        within("records", self.records.len(), 1..=self.genomes.len())?;
        for pair in self.records.windows(2) {
            within("records.id", pair[1].id, pair[0].id.saturating_add(1)..=u32::MAX)?;
        }
        for record in &self.records {
            within("records.id", record.id, 1..=self.next_species - 1)?;
            check_progress(&record.progress).map_err(|error| error.inside("records.progress"))?;
            if !self.memberships.contains(&record.id) {
                return Err(Invalid::new("records.id", record.id, "species with members"));
            }
        }
        let known = |id: &&u32| self.records.iter().any(|record| record.id == **id);
        match self.memberships.iter().find(|id| !known(id)) {
            Some(id) => Err(Invalid::new("memberships", id, "ids of records")),
            None => Ok(()),
        }
    }
}

fn check_progress(progress: &FitnessProgress) -> Result<(), Invalid> {
    within("best", progress.best.unwrap_or(0.0), f64::MIN..=f64::MAX)
}

fn check_summary(summary: &SpeciesSummary) -> Result<(), Invalid> {
    within("best_fitness", summary.best_fitness, f64::MIN..=f64::MAX)?;
    within("mean_fitness", summary.mean_fitness, f64::MIN..=f64::MAX)
}
