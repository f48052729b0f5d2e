//! Tests of whole populations.

use ron::ser::PrettyConfig;

use super::genome::{LinkGene, NetworkGenome};
use super::population::NeatPopulation;
use super::rules::NeatRules;

/// Returns fitness that prefers large weights and many links, so that populations have a direction.
fn fitness(population: &NeatPopulation) -> Vec<f64> {
    let links = |genome: &NetworkGenome| genome.links.clone();
    let value = |link: LinkGene| f64::from(link.weight) * if link.enabled { 1.0 } else { 0.5 };
    population.genomes.iter().map(|g| links(g).into_iter().map(value).sum()).collect()
}

fn growing() -> NeatRules {
    NeatRules { add_node: 0.2, add_link: 0.3, ..NeatRules::default() }
}

fn after(
    mut population: NeatPopulation,
    generations: std::ops::RangeInclusive<u32>,
) -> NeatPopulation {
    for generation in generations {
        population = population.next(&fitness(&population), 7, generation);
    }
    population
}

fn text(population: &NeatPopulation) -> String {
    let layout = PrettyConfig::new().compact_arrays(true).struct_names(false);
    ron::ser::to_string_pretty(population, layout).unwrap()
}

#[test]
fn a_population_goes_on_from_its_text_bit_for_bit() {
    let first = NeatPopulation::first(growing(), 3, 2, 2, 60, 7).unwrap();
    let half = after(first, 1..=15);
    let read: NeatPopulation = ron::from_str(&text(&half)).unwrap();
    assert_eq!(read.check(), Ok(()));
    assert_eq!(read, half);
    assert_eq!(text(&after(read, 16..=30)), text(&after(half, 16..=30)));
}

#[test]
fn every_generation_passes_its_own_check_and_keeps_its_size() {
    let rules = NeatRules { most_links: 25, most_hidden: 8, species_goal: 6, ..growing() };
    let mut population = NeatPopulation::first(rules, 3, 2, 1, 50, 7).unwrap();
    for generation in 1..=80 {
        // Some fitness values are NaN, some are missing.
        let mut fitness = fitness(&population);
        fitness[generation as usize % 50] = f64::NAN;
        fitness.truncate(49);
        population = population.next(&fitness, 7, generation);
        assert_eq!(population.check(), Ok(()), "generation {generation}");
        assert_eq!(population.genomes.len(), 50);
        assert_eq!(population.evaluated.iter().map(|species| species.size).sum::<u32>(), 50);
    }
    assert!(population.genomes.iter().any(|genome| genome.hidden().len() >= 4));
    assert!((2..=20).contains(&population.evaluated.len()), "{}", population.evaluated.len());
}

#[test]
fn the_champion_of_a_species_of_more_than_five_is_kept() {
    let first = NeatPopulation::first(NeatRules::default(), 3, 1, 0, 30, 7).unwrap();
    let values = fitness(&first);
    let best = (0..30).max_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap();
    let next = first.next(&values, 7, 1);
    assert_eq!(next.evaluated.len(), 1);
    assert!(next.genomes.contains(&first.genomes[best]));
    assert_eq!(next.evaluated[0].best_fitness, values[best]);
    assert_eq!(next.evaluated[0].age, 1);
    let few = NeatPopulation::first(NeatRules::default(), 3, 1, 0, 5, 7).unwrap();
    let kept = few.next(&[1.0; 5], 7, 1);
    assert!(kept.genomes.iter().filter(|genome| few.genomes.contains(genome)).count() < 5);
}

#[test]
fn a_species_without_progress_has_no_offspring() {
    // With this threshold, each genome that differs makes a species of its own.
    let rules = NeatRules {
        species_threshold: 1e-9,
        champion_species_size: 0,
        stagnation_generations: 3,
        ..NeatRules::default()
    };
    let mut population = NeatPopulation::first(rules, 2, 1, 0, 10, 7).unwrap();
    for generation in 1..=4 {
        // The first species is the best; no species improves.
        let value = |&id: &u32| if id == 1 { 2.0 } else { 1.0 };
        let values: Vec<f64> = population.memberships.iter().map(value).collect();
        population = population.next(&values, 7, generation);
        let old = population.memberships.iter().filter(|&&id| (2..=10).contains(&id)).count();
        assert!(population.memberships.contains(&1), "generation {generation}");
        assert_eq!(old == 0, generation == 4, "generation {generation}: {old}");
    }
}

#[test]
fn only_the_two_best_species_have_offspring_after_a_standstill() {
    let rules = NeatRules {
        species_threshold: 1e-9,
        champion_species_size: 0,
        standstill_generations: 2,
        ..NeatRules::default()
    };
    let mut population = NeatPopulation::first(rules, 2, 1, 0, 10, 7).unwrap();
    for generation in 1..=3 {
        let value = |&id: &u32| if [3, 4, 5].contains(&id) { 3.0 } else { 1.0 };
        let values: Vec<f64> = population.memberships.iter().map(value).collect();
        population = population.next(&values, 7, generation);
        let mut old = population.memberships.clone();
        old.retain(|&id| id <= 10);
        old.dedup();
        // Of equal species, the older ones come first.
        assert_eq!(old == [3, 4], generation == 3, "generation {generation}: {old:?}");
    }
}

#[test]
fn a_population_can_descend_from_a_genome() {
    let old = after(NeatPopulation::first(growing(), 3, 1, 1, 20, 7).unwrap(), 1..=20);
    let founder = &old.genomes[3];
    let new = NeatPopulation::descended(growing(), founder, 20, 8).unwrap();
    assert_eq!(&new.genomes[0], founder);
    assert_eq!(new.genomes[1].links.len(), founder.links.len());
    assert_ne!(&new.genomes[1], founder);
    assert_eq!(after(new, 1..=10).check(), Ok(()));
}

#[test]
fn hostile_populations_are_refused_with_field_value_and_range() {
    let good = after(NeatPopulation::first(growing(), 3, 2, 1, 20, 7).unwrap(), 1..=5);
    let refusal = |change: &dyn Fn(&mut NeatPopulation)| {
        let mut hostile = good.clone();
        change(&mut hostile);
        hostile.check().unwrap_err().to_string()
    };
    assert_eq!(refusal(&|p| p.genomes.clear()), "genomes is 0; allowed: 1 to 10000");
    assert_eq!(refusal(&|p| p.threshold = f64::NAN), "threshold is NaN; allowed: 0 to 1000000000");
    assert_eq!(refusal(&|p| p.memberships[3] = 999), "memberships is 999; allowed: ids of records");
    assert!(refusal(&|p| p.memberships.truncate(1)).contains("memberships is 1; allowed: 20"));
    let message = refusal(&|p| p.genomes[4].links[0].weight = f32::INFINITY);
    assert_eq!(message, "genomes[4].links.weight is inf; allowed: -8 to 8");
    let message = refusal(&|p| p.genomes[4].parameters.clear());
    assert!(message.starts_with("genomes[4] is 3 inputs, 2 outputs, 0 parameters; "), "{message}");
    let message = refusal(&|p| p.genomes[4].links[0].from = 900);
    assert!(message.starts_with("genomes[4].links.from is 900; allowed: 0 to "), "{message}");
    let message = refusal(&|p| p.genomes[4].links.swap(0, 1));
    assert!(message.contains("links.innovation is 0; allowed: above 1"), "{message}");
    let message = refusal(&|p| p.records[0].progress.best = Some(f64::NAN));
    assert!(message.starts_with("records.progress.best is NaN"), "{message}");
    let message = NeatPopulation::first(growing(), 500, 500, 0, 10, 7).unwrap_err().to_string();
    assert_eq!(message, "links of the first generation is 250000; allowed: 1 to 1000");
}

#[test]
fn a_population_of_large_networks_takes_less_than_a_mebibyte() {
    let rules = NeatRules { add_node: 0.0, ..growing() };
    let mut population = NeatPopulation::first(rules, 50, 4, 6, 150, 7).unwrap();
    population = after(population, 1..=3);
    for genome in &mut population.genomes {
        assert!(genome.links.len() >= 200);
        // The ids and innovation numbers have as many digits as those of an old population.
        genome.links.iter_mut().for_each(|link| link.innovation += 10_000);
        genome.links.iter_mut().for_each(|link| link.from += 1_000);
    }
    let size = text(&population).len();
    println!("{size} bytes");
    assert!(size < 1 << 20, "{size} bytes");
}
