//! Charts of the run: how it goes, what it found, where it comes from, how it compares. Each can be pointed at to read
//! its values, clicked to replay whoever is there, and written into a file.

mod draw;
mod family;
mod fitness;
mod found;
mod parents;
mod runs;
mod spread;
mod thin;
mod torques;
mod view;

use std::sync::Arc;

use bevy_egui::egui;

use super::archive_map::archive_map;
use super::champions::Shown;
use super::curves::CurvesPanel;
use super::front_plot::front_plot;
use super::{explain, title, title_and};
use crate::evolve::{Place, StrategyKind};
use crate::plot::Figure;
use crate::save::Comparison;
use crate::studio::command::Command;
use crate::studio::evolution::Evolution;
use crate::studio::export::{Export, Format};
use crate::studio::look;
use torques::Torques;
use view::View;

/// Which chart is on show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Kind {
    #[default]
    Fitness,
    Spread,
    Family,
    Torques,
    Parents,
    Front,
    Archive,
    Runs,
    Methods,
}

impl Kind {
    const ALL: [Self; 9] = [
        Self::Fitness,
        Self::Spread,
        Self::Family,
        Self::Torques,
        Self::Parents,
        Self::Front,
        Self::Archive,
        Self::Runs,
        Self::Methods,
    ];

    /// Its name on the button that chooses it, and what it shows.
    fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Fitness => ("Fitness", "Best, mean and median of each generation"),
            Self::Spread => ("Spread", "How many of the latest generation reached what"),
            Self::Family => ("Ancestors", "Whom the best descends from"),
            Self::Torques => (
                "Torques",
                "The torques of who is on the stage, or else of the best, and of its parent, joint by joint",
            ),
            Self::Parents => ("Parents", "Which values the next generation's parents have"),
            Self::Front => ("Front", "Who gets furthest for the least energy"),
            Self::Archive => ("Archive", "The best of every kind of behaviour, by MAP-Elites"),
            Self::Runs => ("Runs", "This run and others, over each other"),
            Self::Methods => ("Methods", "How methods compare, over many runs"),
        }
    }

    /// How the names of its files begin.
    fn file_name(self) -> &'static str {
        match self {
            Self::Fitness => "fitness",
            Self::Spread => "spread",
            Self::Family => "ancestors",
            Self::Torques => "torques",
            Self::Parents => "parents",
            Self::Front => "front",
            Self::Archive => "archive",
            Self::Runs => "runs",
            Self::Methods => "methods",
        }
    }

    /// What will appear there, and when.
    fn awaits(self) -> &'static str {
        match self {
            Self::Fitness => {
                "The fitness of each generation will appear here once the first is finished."
            }
            Self::Spread => {
                "How the latest generation's fitness is spread will appear here once this session has finished one."
            }
            Self::Family => {
                "The ancestors of the best will appear here once a generation is finished."
            }
            Self::Torques => "The torques are being worked out ...",
            Self::Parents => {
                "The parents' values will appear here once this session has finished a generation, if the method has \
                 parents: random search and CMA-ES have none."
            }
            Self::Front => "Who gets furthest for the least energy will appear here.",
            Self::Archive => "The best of every kind will appear here.",
            Self::Runs => "This run's lines will appear here once a generation is finished.",
            Self::Methods => {
                "None is open. \"snakes compare\" makes one, \"snakes --comparison FILE\" opens it."
            }
        }
    }
}

/// What a view was worked out from: nothing of it has changed as long as this has not.
type Version = (u32, u64, usize, u64);

/// The panel, with the chart that is on show.
pub(super) struct ChartsPanel {
    kind: Kind,
    known: Option<(Kind, Version, Option<View>)>,
    /// The same of the archive or the front, which have panels of their own.
    figure: Option<(Kind, Version, Arc<Figure>)>,
    torques: Torques,
    curves: Option<CurvesPanel>,
    has_asked_for_runs: bool,
}

impl ChartsPanel {
    /// The panel, with a comparison of methods if one is open.
    pub fn new(comparison: Option<&Comparison>) -> Self {
        Self {
            // Whoever opened one came for it.
            kind: if comparison.is_some() { Kind::Methods } else { Kind::default() },
            known: None,
            figure: None,
            torques: Torques::default(),
            curves: comparison.map(CurvesPanel::new),
            has_asked_for_runs: false,
        }
    }

    /// Draws the panel and adds what was asked for.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        run: &Evolution,
        shown: Option<Shown>,
        asked: &mut Vec<Command>,
    ) {
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = look::GAP / 2.0;
            for kind in Kind::ALL {
                let (name, hint) = kind.words();
                ui.selectable_value(&mut self.kind, kind, name).on_hover_text(hint);
            }
        });
        let tallest = ui.available_width() * look::TALLEST_CHART;
        let height =
            (ui.available_height() - look::WITHOUT_PLOT).min(tallest).max(look::PLOT_HEIGHT);
        match self.kind {
            Kind::Front | Kind::Archive => self.found(ui, run, height, shown, asked),
            Kind::Methods => self.methods(ui, height, asked),
            Kind::Torques => self.torques(ui, run, height, shown, asked),
            kind => self.worked_out(ui, run, kind, height, shown, asked),
        }
    }

    /// A chart that is worked out from what the run has found.
    fn worked_out(
        &mut self,
        ui: &mut egui::Ui,
        run: &Evolution,
        kind: Kind,
        height: f32,
        shown: Option<Shown>,
        asked: &mut Vec<Command>,
    ) {
        if kind == Kind::Runs && !self.has_asked_for_runs {
            self.has_asked_for_runs = true;
            asked.push(Command::ListRuns);
        }
        let version = run.version();
        if !matches!(&self.known, Some((of, at, _)) if (*of, *at) == (kind, version)) {
            self.known = Some((kind, version, view_of(kind, run)));
        }
        let view = self.known.as_ref().and_then(|(.., view)| view.as_ref());
        let view = view.filter(|view| !view.figure.is_empty()).ok_or(kind.awaits());
        view_or_why(ui, kind, view, height, place(shown), asked);
        if kind == Kind::Runs {
            runs::choice(ui, run, asked);
        }
    }

    fn torques(
        &mut self,
        ui: &mut egui::Ui,
        run: &Evolution,
        height: f32,
        shown: Option<Shown>,
        asked: &mut Vec<Command>,
    ) {
        let view = match self.torques.follow(run, place(shown)) {
            Ok(()) => self.torques.view(&run.settings().trial).ok_or(Kind::Torques.awaits()),
            Err(missing) => Err(missing),
        };
        // Who is on the stage is what it is about: nobody in it is marked.
        view_or_why(ui, Kind::Torques, view, height, None, asked);
    }

    /// The front, or the archive.
    fn found(
        &mut self,
        ui: &mut egui::Ui,
        run: &Evolution,
        height: f32,
        shown: Option<Shown>,
        asked: &mut Vec<Command>,
    ) {
        let (kind, version) = (self.kind, run.version());
        let unit = run.settings().trial.fitness.unit();
        let exploration = run.exploration();
        let front = exploration.map(|of| &of.front).filter(|front| front.members().len() > 0);
        let archive = exploration.and_then(|of| of.archive.as_ref());
        let archive = archive.filter(|archive| archive.elites().len() > 0);
        if !matches!(&self.figure, Some((of, at, _)) if (*of, *at) == (kind, version)) {
            let figure = match kind {
                Kind::Front => front.map(found::front),
                _ => archive.map(|archive| found::archive(archive, unit)),
            };
            self.figure = figure.map(|figure| (kind, version, Arc::new(figure)));
        }
        match &self.figure {
            Some((.., figure)) => header(ui, figure, kind.file_name(), asked),
            None => title(ui, kind.words().0),
        }
        match (kind, front, archive) {
            (Kind::Front, Some(front), _) => front_plot(ui, front, shown, height, asked),
            (Kind::Front, None, _) if exploration.is_some() => {
                explain(ui, "Nobody has got ahead of the start yet.");
            }
            (Kind::Archive, _, Some(archive)) => {
                archive_map(ui, archive, unit, shown, height, asked);
            }
            (Kind::Archive, ..) if run.settings().evolution.strategy != StrategyKind::MapElites => {
                explain(
                    ui,
                    "MAP-Elites keeps one: the best of every kind of behaviour. Choose it as the strategy in the Run panel, and begin a run.",
                );
            }
            _ => explain(ui, kind.awaits()),
        }
    }

    fn methods(&mut self, ui: &mut egui::Ui, height: f32, asked: &mut Vec<Command>) {
        match &mut self.curves {
            Some(curves) => {
                header(ui, &curves.figure(), Kind::Methods.file_name(), asked);
                curves.ui(ui, height);
            }
            None => {
                title(ui, "Comparison of methods");
                explain(ui, Kind::Methods.awaits());
            }
        }
    }
}

/// Draws a chart, or says why there is none yet.
fn view_or_why(
    ui: &mut egui::Ui,
    kind: Kind,
    view: Result<&View, &str>,
    height: f32,
    shown: Option<Place>,
    asked: &mut Vec<Command>,
) {
    match view {
        Ok(view) => {
            header(ui, &view.figure, kind.file_name(), asked);
            draw::draw(ui, kind.file_name(), view, height, shown, asked);
        }
        Err(why) => {
            title(ui, kind.words().0);
            explain(ui, why);
        }
    }
}

/// The chart of fitness alone, for where one steers the run.
#[derive(Default)]
pub(super) struct FitnessChart {
    known: Option<(Version, View)>,
}

impl FitnessChart {
    /// Draws the chart, so many points high, and adds what was asked for.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        run: &Evolution,
        height: f32,
        shown: Option<Shown>,
        asked: &mut Vec<Command>,
    ) {
        let version = run.version();
        if !matches!(&self.known, Some((at, _)) if *at == version) {
            self.known = Some((version, fitness::view(run.settings(), run.reports())));
        }
        let Some((_, view)) = &self.known else { return };
        header(ui, &view.figure, Kind::Fitness.file_name(), asked);
        draw::draw(ui, "fitness alone", view, height, place(shown), asked);
    }
}

/// A chart's data; none, if there is nothing to show yet.
fn view_of(kind: Kind, run: &Evolution) -> Option<View> {
    let settings = run.settings();
    let exploration = run.exploration();
    match kind {
        Kind::Fitness => Some(fitness::view(settings, run.reports())),
        Kind::Spread => Some(spread::view(settings, exploration?.generation.as_ref()?)),
        Kind::Family => Some(family::view(settings, &exploration?.descent)),
        Kind::Parents => parents::view(settings, &exploration?.parents),
        Kind::Runs => Some(runs::view(run)),
        Kind::Torques | Kind::Front | Kind::Archive | Kind::Methods => None,
    }
}

/// Who is on the stage, if that is somebody of the current run.
fn place(shown: Option<Shown>) -> Option<Place> {
    match shown? {
        Shown::Found { generation, individual } => Some(Place { generation, individual }),
        Shown::Opening(_) => None,
    }
}

/// A chart's title, and the buttons that write it into a file.
fn header(ui: &mut egui::Ui, figure: &Arc<Figure>, name: &'static str, asked: &mut Vec<Command>) {
    let is_empty = figure.is_empty();
    title_and(ui, &figure.title, |ui| {
        for (label, hint, format) in [
            ("CSV", "Write the numbers into a file, as a table", Format::Csv),
            ("PNG", "Write the chart into a file, as a picture of 1600 by 900 pixels", Format::Png),
        ] {
            let button = ui.add_enabled(!is_empty, egui::Button::new(label).small());
            let not_yet = "There is nothing in it yet";
            if button.on_hover_text(hint).on_disabled_hover_text(not_yet).clicked() {
                let figure = Arc::clone(figure);
                asked.push(Command::Export(Export { figure, name, format }));
            }
        }
    });
}

#[cfg(test)]
mod tests;
