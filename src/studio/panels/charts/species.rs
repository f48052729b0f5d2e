//! Chart of the species of networks, and of the size of the best snake's network.

use super::bands::{Bands, BestNumbers};
use snakes_core::genome::ControllerGenes;
use snakes_lab::run::GenerationReport;

/// Texts of the chart of species by generation.
pub(super) static SPECIES: Bands = Bands {
    title: "Species by generation",
    name: "Species",
    note: "Each band is a species; its height is the number of its snakes.",
    band: |number| format!("Species {number}"),
    count: |count| format!("{count} species"),
    rest: "smaller species",
    column: "species",
    best: BestNumbers {
        name: "Best network",
        axis: "Links and hidden nodes",
        names: ["links of the best network", "its hidden nodes"],
        columns: ["links of the best network", "hidden nodes of the best network"],
        of: network_size,
        words: |[links, hidden]| {
            let nodes = if hidden == 1.0 { "node" } else { "nodes" };
            format!("{links} links\n{hidden} hidden {nodes}")
        },
    },
};

/// Returns the numbers of enabled links and of hidden nodes in the best snake's network.
fn network_size(report: &GenerationReport) -> Option<[f64; 2]> {
    let ControllerGenes::Grown(genes) = &report.champion.as_ref()?.genome.controller else {
        return None;
    };
    Some([genes.network.enabled_links() as f64, genes.network.hidden().len() as f64])
}
