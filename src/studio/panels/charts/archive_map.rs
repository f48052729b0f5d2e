//! Map of the MAP-Elites archive: a cell for each kind of behaviour, coloured by fitness. A click replays the cell's elite.

use super::archive_pictures::ArchivePictures;
use super::view::{ChartHit, ChartView, HitShape, generation_and_snake};
use crate::studio::commands::pick::Pick;
use crate::studio::ui::plot_axes::number;
use snakes_core::evolve::{Archive, ArchiveAxis, AxisScale, Elite, Settings};
use snakes_lab::plot::{Axis, Chart, Figure, Role, Series, Shape, extent, with_unit};

/// Creates the map of an archive, which is empty if the archive has no elites.
pub(super) fn view(settings: &Settings, archive: &Archive) -> ChartView {
    let unit = settings.trial.fitness.unit();
    let fitness = archive.elites().map(|(_, elite)| f64::from(elite.fitness));
    let [min, max] = extent(fitness).unwrap_or_default();
    let (x, y) = (axis(archive.x), axis(archive.y));
    let area = |cell: u32| {
        let [column, row] = archive.place(cell);
        let [left, right] = archive.x.edges(column).map(|edge| x.position_of(edge));
        let [bottom, top] = archive.y.edges(row).map(|edge| y.position_of(edge));
        [left, right, bottom, top]
    };
    let cells = archive.elites().map(|(cell, elite)| {
        let fitness = f64::from(elite.fitness);
        let share = (fitness - min) / (max - min).max(f64::MIN_POSITIVE);
        (area(cell), share as f32, fitness)
    });
    let cells = Shape::Cells(cells.collect());
    let of_elite = |(cell, elite): (u32, &Elite)| {
        let (fitness, kind) = (elite.fitness, kind_in_words(archive, cell));
        let place = elite.id();
        let words =
            move || format!("{kind}Fitness {fitness:.2}{unit}\n{}", generation_and_snake(place));
        ChartHit::of(HitShape::Area(area(cell)), words, Pick::Elite(cell), place)
    };
    let of_empty = |cell: u32| {
        let kind = kind_in_words(archive, cell);
        ChartHit::new(HitShape::Area(area(cell)), move || format!("{kind}Empty"))
    };
    let empty = (0..archive.cells()).filter(|cell| archive.elite(*cell).is_none());
    // The elites come first, in the order of their pictures.
    let hits = archive.elites().map(of_elite).chain(empty.map(of_empty)).collect();
    let note = format!(
        "Coverage {:.0} % ({} of {} cells). QD score {}: fitness above {}{unit}, summed over all cells.",
        archive.coverage() * 100.0,
        archive.elites().len(),
        archive.cells(),
        number(archive.qd_score()),
        number(f64::from(archive.floor))
    );
    let name = format!("fitness from {min:.2} to {max:.2}{unit}");
    let chart = Chart::new(x, y, vec![Series::new(&name, Role::Share(0.5), cells)]);
    let heads = [archive.x.label, archive.y.label].into_iter();
    let heads = heads.flat_map(|axis| [format!("{axis}, from"), format!("{axis}, to")]);
    let of_elite = [with_unit("fitness", unit), "generation".to_owned(), "snake".to_owned()];
    let figure = Figure::of("Best snake for each kind of behaviour", chart)
        .with_note(note)
        .with_numbers(heads.chain(of_elite), archive.elites().map(|of| record(archive, of)));
    let pictures = ArchivePictures::of(archive, &settings.trial.agent);
    ChartView { pictures, ..ChartView::new(figure, vec![hits]) }
}

/// Returns an axis of the map on which all cells have the same width.
fn axis(of: ArchiveAxis) -> Axis {
    let ([from, _], [_, to]) = (of.edges(0), of.edges(of.cells - 1));
    match of.scale {
        AxisScale::Linear => Axis::new(of.label, "", from..=to),
        AxisScale::Logarithmic => Axis::logarithmic(of.label, "", from..=to),
        AxisScale::Whole => Axis::count(of.label, from..=to),
    }
}

/// Describes the kind of behaviour of a cell, in one line for each axis.
fn kind_in_words(archive: &Archive, cell: u32) -> String {
    let span = |axis: ArchiveAxis, place: u32| {
        let [from, to] = axis.ends(place).map(number);
        let values = if from == to { from } else { format!("{from} to {to}") };
        format!("{}: {values}\n", axis.label)
    };
    let [column, row] = archive.place(cell);
    span(archive.x, column) + &span(archive.y, row)
}

/// Returns a row of the exported table: the ends of a cell, and the fitness, generation and number of its elite.
fn record(archive: &Archive, (cell, elite): (u32, &Elite)) -> Vec<String> {
    let [column, row] = archive.place(cell);
    let ends = [archive.x.ends(column), archive.y.ends(row)];
    let of_elite = [elite.fitness.to_string(), elite.generation.to_string()];
    let ends = ends.as_flattened().iter().map(f64::to_string);
    ends.chain(of_elite).chain([(elite.individual + 1).to_string()]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::commands::{Command, StageCommand};
    use crate::studio::panels::charts::tests::clicked;
    use crate::studio::panels::testing::shows;
    use crate::studio::state::current_run::explored_run;
    use bevy_egui::egui;
    use snakes_core::evolve::Descriptor;

    /// Clicks in the middle of a hit target. Returns the commands that were sent, and whether the hover text calls the cell empty.
    fn clicked_in(view: &ChartView, hit: &ChartHit) -> (Vec<Command>, bool) {
        let HitShape::Area([left, right, bottom, top]) = hit.target else { panic!("an area") };
        let middle = [(left + right) / 2.0, (bottom + top) / 2.0];
        let panel = clicked(view, middle, egui::Vec2::ZERO);
        (panel.state().clone(), shows(&panel, "Empty"))
    }

    #[test]
    fn a_click_on_a_cell_replays_its_elite_and_an_empty_cell_does_nothing() {
        let run = explored_run();
        let exploration = run.exploration().expect("explored");
        let archive = exploration.archive.as_ref().expect("MAP-Elites keeps one");
        let view = view(run.settings(), archive);
        let hits = &view.hits[0];
        assert_eq!(hits.len(), archive.cells() as usize);
        let (cell, elite) = archive.elites().next().expect("an elite");
        let show = Command::Stage(StageCommand::Show(Pick::Elite(cell)));
        assert_eq!(clicked_in(&view, &hits[0]), (vec![show], false));
        assert_eq!(clicked_in(&view, &hits[hits.len() - 1]), (vec![], true));
        let table = view.figure.table();
        assert_eq!(table.len(), 1 + archive.elites().len());
        assert_eq!((&*table[0][4], &table[1][4]), ("fitness (m)", &elite.fitness.to_string()));
    }

    #[test]
    fn all_cells_of_a_logarithmic_axis_are_equally_wide() {
        let of = ArchiveAxis::of(Descriptor::EnergyPerMetre, 7);
        let axis = axis(of);
        assert_eq!((*axis.range.start(), *axis.range.end()), (1.0, 4.0));
        for cell in 0..7 {
            let [from, to] = of.edges(cell).map(|edge| axis.position_of(edge));
            assert!((to - from - 3.0 / 7.0).abs() < 1.0e-9, "{from} to {to}");
        }
    }
}
