//! Archive and front as figures for export. Their panels draw them on the screen.

use crate::studio::ui::plot_axes::padded_range;
use snakes_core::evolve::{Archive, ArchiveAxis, Elite, Front};
use snakes_lab::plot::{Axis, Chart, Figure, Role, Series, Shape};

/// Figure of the MAP-Elites archive. `unit` is the unit of the fitness.
pub(super) fn archive(archive: &Archive, unit: &str) -> Figure {
    let fitness = archive.elites().map(|(_, elite)| elite.fitness);
    let (min, max) = fitness.fold((f32::MAX, f32::MIN), |(l, m), x| (l.min(x), m.max(x)));
    let cells = archive.elites().map(|(cell, elite)| {
        let [column, row] = archive.place(cell);
        let [left, right] = archive.x.edges(column);
        let [bottom, top] = archive.y.edges(row);
        let share = (elite.fitness - min) / (max - min).max(f32::MIN_POSITIVE);
        ([left, right, bottom, top], share, f64::from(elite.fitness))
    });
    let axis = |axis: ArchiveAxis| {
        let [from, _] = axis.edges(0);
        let [_, to] = axis.edges(axis.cells - 1);
        Axis::new(axis.label, "", from..=to)
    };
    let name = format!("fitness from {min:.2} to {max:.2}{unit}");
    let chart = Chart {
        name: String::new(),
        x: axis(archive.x),
        y: axis(archive.y),
        series: vec![Series::new(&name, Role::Share(0.5), Shape::Cells(cells.collect()))],
        marks: Vec::new(),
    };
    let figure = Figure::of("Best snake for each kind of behaviour", chart);
    Figure { numbers: Some(rows(archive, unit)), ..figure }
}

/// Table with one row per elite: cell, fitness, generation and index.
fn rows(archive: &Archive, unit: &str) -> Vec<Vec<String>> {
    let [x, y] = [archive.x.label, archive.y.label];
    let fitness =
        if unit.is_empty() { "fitness".to_owned() } else { format!("fitness ({})", unit.trim()) };
    let ends = [format!("{x}, from"), format!("{x}, to"), format!("{y}, from"), format!("{y}, to")];
    let head = ends.into_iter().chain([fitness, "generation".to_owned(), "snake".to_owned()]);
    let row = |(cell, elite): (u32, &Elite)| {
        let [column, row] = archive.place(cell);
        let [[left, right], [bottom, top]] = [archive.x.ends(column), archive.y.ends(row)];
        vec![
            left.to_string(),
            right.to_string(),
            bottom.to_string(),
            top.to_string(),
            elite.fitness.to_string(),
            elite.generation.to_string(),
            (elite.individual + 1).to_string(),
        ]
    };
    [head.collect()].into_iter().chain(archive.elites().map(row)).collect()
}

/// Figure of the front of distance and energy.
pub(super) fn front(front: &Front) -> Figure {
    let points = front.members().map(|member| {
        let energy_j = member.evaluation.effort.map_or(0.0, |effort| f64::from(effort.energy_j));
        [f64::from(member.evaluation.centre_y_m), energy_j / 1000.0]
    });
    let points: Vec<[f64; 2]> = points.collect();
    let range = |of: usize, min| padded_range(points.iter().map(move |point| point[of]), min);
    let chart = Chart {
        name: String::new(),
        x: Axis::new("Final distance", "m", range(0, 2.0).unwrap_or(0.0..=1.0)),
        y: Axis::new("Energy", "kJ", range(1, 0.01).unwrap_or(0.0..=1.0)),
        series: vec![Series::new("Pareto front", Role::First, Shape::Line(points))],
        marks: Vec::new(),
    };
    Figure::of("Distance and energy", chart)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::state::current_run::explored_run;

    #[test]
    fn every_elite_and_every_member_has_its_row_in_the_table() {
        let run = explored_run();
        let exploration = run.exploration().expect("explored");
        let of_archive = exploration.archive.as_ref().expect("MAP-Elites keeps one");
        let table = archive(of_archive, " m").table();
        assert_eq!(table.len(), 1 + of_archive.elites().len());
        let (_, first) = of_archive.elites().next().expect("an elite");
        assert_eq!((&*table[0][4], &table[1][4]), ("fitness (m)", &first.fitness.to_string()));
        let table = front(&exploration.front).table();
        assert_eq!(table.len(), 1 + exploration.front.members().len());
        assert_eq!(table[0], ["Final distance (m)", "Pareto front (kJ)"]);
    }
}
