//! The kinds of bands: species of networks, and numbers of blocks in evolving bodies.

use super::bands::Bands;
use snakes_core::genome::ControllerGenes;

/// Texts of the chart of species by generation.
pub(super) const SPECIES: &Bands = &Bands {
    title: "Species by generation",
    name: "Species",
    note: "Each band is a species; its height is the number of its snakes.",
    band: |number| format!("Species {number}"),
    count: |count| format!("{count} species"),
    rest: "smaller species",
    column: "species",
    best: "Best network",
    best_axis: "Links and hidden nodes",
    best_names: ["links of the best network", "its hidden nodes"],
    best_columns: ["links of the best network", "hidden nodes of the best network"],
    best_of: |report| {
        let ControllerGenes::Grown(genes) = &report.champion.as_ref()?.genome.controller else {
            return None;
        };
        Some([genes.network.enabled_links() as f64, genes.network.hidden().len() as f64])
    },
    best_words: |[links, hidden]| {
        let nodes = if hidden == 1.0 { "node" } else { "nodes" };
        format!("{links} links\n{hidden} hidden {nodes}")
    },
};

/// Texts of the chart of the numbers of blocks by generation.
pub(super) const BLOCKS: &Bands = &Bands {
    title: "Blocks by generation",
    name: "Blocks",
    note: "Each band is a number of blocks; its height is the number of snakes that have it.",
    band: |blocks| format!("Bodies of {blocks} blocks"),
    count: |count| match count {
        1 => "one number of blocks".to_owned(),
        _ => format!("{count} different numbers of blocks"),
    },
    rest: "others",
    column: "blocks",
    best: "Best body",
    best_axis: "Blocks, and length in m",
    best_names: ["blocks of the best body", "its length in m"],
    best_columns: ["blocks of the best body", "length of the best body (m)"],
    best_of: |report| {
        let body = report.champion.as_ref()?.body();
        Some([body.limbs() as f64, f64::from(body.length_m())])
    },
    best_words: |[blocks, length_m]| format!("{blocks} blocks\n{length_m:.1} m long"),
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::charts::bands::view;
    use crate::studio::state::current_run::bodies_run;

    #[test]
    fn every_snake_is_in_the_band_of_its_number_of_blocks() {
        let run = bodies_run();
        let generation = run.exploration().expect("explored").generation.as_ref().expect("two");
        let report = run.reports().last().expect("two generations");
        for band in &report.species {
            let blocks = generation.genomes.iter().map(|genome| genome.body.segments.len());
            let count = blocks.filter(|blocks| *blocks == band.id as usize).count();
            assert_eq!(band.size as usize, count, "{} blocks", band.id);
        }
        let all: u32 = report.species.iter().map(|band| band.size).sum();
        assert_eq!(all, report.evaluations);
        let view = view(BLOCKS, run.settings(), run.reports());
        let words = view.hits[0][0].words();
        assert!(words.starts_with("Bodies of 2 blocks in generation 1\n"), "{words}");
        let best = view.hits[1][0].words();
        let blocks =
            run.reports()[0].champion.as_ref().expect("healthy").genome.body.segments.len();
        assert!(
            best.starts_with(&format!("Best body of generation 1\n{blocks} blocks\n")),
            "{best}"
        );
    }
}
