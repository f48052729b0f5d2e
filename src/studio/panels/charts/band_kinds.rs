//! The kinds of bands: species of networks, numbers of blocks in evolving bodies, and ways in which trials ended.

use super::bands::{Bands, BestNumbers};
use snakes_core::evolve::BandCount;
use snakes_core::genome::ControllerGenes;
use snakes_core::schema::Choices;
use snakes_core::score::EndingKind;

/// Texts of the chart of species by generation.
pub(super) const SPECIES: &Bands = &Bands {
    title: "Species by generation",
    name: "Species",
    note: "Each band is a species; its height is the number of its snakes.",
    band: |number| format!("Species {number}"),
    count: |count| format!("{count} species"),
    rest: "smaller species",
    column: "species",
    counts: |report| report.species.clone(),
    is_named: false,
    best: Some(BestNumbers {
        name: "Best network",
        axis: "Links and hidden nodes",
        names: ["links of the best network", "its hidden nodes"],
        columns: ["links of the best network", "hidden nodes of the best network"],
        of: |report| {
            let ControllerGenes::Grown(genes) = &report.champion.as_ref()?.genome.controller else {
                return None;
            };
            Some([genes.network.enabled_links() as f64, genes.network.hidden().len() as f64])
        },
        words: |[links, hidden]| {
            let nodes = if hidden == 1.0 { "node" } else { "nodes" };
            format!("{links} links\n{hidden} hidden {nodes}")
        },
    }),
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
    counts: |report| report.species.clone(),
    is_named: false,
    best: Some(BestNumbers {
        name: "Best body",
        axis: "Blocks, and length in m",
        names: ["blocks of the best body", "its length in m"],
        columns: ["blocks of the best body", "length of the best body (m)"],
        of: |report| {
            let body = report.champion.as_ref()?.body();
            Some([body.limbs() as f64, f64::from(body.length_m())])
        },
        words: |[blocks, length_m]| format!("{blocks} blocks\n{length_m:.1} m long"),
    }),
};

/// Ways in which a trial can end, from the bottom of the chart to the top, with the number of the band. Its last digit determines the colour:
/// a landing is green.
const ENDINGS_DRAWN: [(EndingKind, u32); EndingKind::OPTIONS.len()] = [
    (EndingKind::Landed, 2),
    (EndingKind::OutOfTime, 5),
    (EndingKind::Stuck, 8),
    (EndingKind::FellBack, 14),
    (EndingKind::OffTheSide, 17),
    (EndingKind::Beside, 19),
    (EndingKind::LeftTheGround, 20),
    (EndingKind::Disqualified, 23),
];

/// Texts of the chart of the ways in which the trials of each generation ended.
pub(super) const ENDINGS: &Bands = &Bands {
    title: "How each generation ended",
    name: "Endings",
    note: "Each band is a way in which trials end; its height is the share of the snakes whose trial ended so.",
    band: |number| {
        let drawn = ENDINGS_DRAWN.iter().find(|(_, of)| *of == number);
        drawn.map_or(String::new(), |(kind, _)| kind.choice().title.to_owned())
    },
    count: |count| match count {
        1 => "one ending".to_owned(),
        _ => format!("{count} different endings"),
    },
    rest: "others",
    column: "ending",
    counts: |report| {
        let of = |(kind, id): &(EndingKind, u32)| {
            let BandCount { size, best, .. } = report.endings.iter().find(|of| of.id == *kind)?;
            Some(BandCount { id: *id, size: *size, best: *best })
        };
        ENDINGS_DRAWN.iter().filter_map(of).collect()
    },
    is_named: true,
    best: None,
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
        let report = run.reports.last().expect("two generations");
        for band in &report.species {
            let blocks = generation.genomes.iter().map(|genome| genome.body.segments.len());
            let count = blocks.filter(|blocks| *blocks == band.id as usize).count();
            assert_eq!(band.size as usize, count, "{} blocks", band.id);
        }
        let all: u32 = report.species.iter().map(|band| band.size).sum();
        assert_eq!(all, report.evaluations);
        let view = view(BLOCKS, run.settings(), &run.reports);
        let words = view.hits[0][0].words();
        assert!(words.starts_with("Bodies of 2 blocks in generation 1\n"), "{words}");
        let best = view.hits[1][0].words();
        let blocks = run.reports[0].champion.as_ref().expect("healthy").genome.body.segments.len();
        let expected = format!("Best body of generation 1\n{blocks} blocks\n");
        assert!(best.starts_with(&expected), "{best}");
    }

    #[test]
    fn every_snake_of_a_generation_is_in_the_band_of_its_ending() {
        let run = bodies_run();
        let view = view(ENDINGS, run.settings(), &run.reports);
        for report in &run.reports {
            let all: u32 = (ENDINGS.counts)(report).iter().map(|band| band.size).sum();
            assert_eq!(all, report.evaluations, "{:?}", report.endings);
        }
        let bands = view.figure.charts[0].series.iter();
        assert!(bands.clone().all(|series| !series.name.is_empty()));
        let listed = view.figure.listed();
        assert!(bands.clone().all(|band| listed.iter().any(|series| series.name == band.name)));
        assert_eq!(view.figure.charts.len(), 1);
        assert_eq!(view.figure.table()[0][..3], ["generation", "ending", "snakes"]);
        let is_drawn = |kind: &EndingKind| ENDINGS_DRAWN.iter().any(|(of, _)| of == kind);
        assert!(EndingKind::OPTIONS.iter().all(is_drawn));
    }
}
