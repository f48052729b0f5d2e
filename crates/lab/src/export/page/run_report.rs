//! The parts of a page about a run: its fitness by generation, its settings, and the command that repeats it.

use super::markup::escaped;
use crate::export::source::ExportedRun;
use snakes_core::evolve::{SettingChanges, Statistics, fields, run_hash};
use snakes_core::save::shipped_presets;

/// Width and height of the chart, in its own units.
const SIZE: [f32; 2] = [720.0, 260.0];
/// Margins of the chart: left, top, right, bottom.
const MARGINS: [f32; 4] = [56.0, 14.0, 14.0, 34.0];

/// Returns markup about a run. Its buttons refer to champions by their indices in the page's data.
pub fn of(run: &ExportedRun) -> String {
    let buttons: String = run
        .generations
        .iter()
        .enumerate()
        .map(|(index, number)| {
            format!(
                "<button data-champion=\"{index}\" aria-pressed=\"false\" aria-label=\"Champion of generation {number}\">\
                 {number}</button>\n"
            )
        })
        .collect();
    let evaluations: u64 = run.records.iter().map(|record| u64::from(record.evaluations)).sum();
    let settings = &run.plan.settings;
    let rows: String = fields(settings)
        .iter()
        .map(|(path, value)| {
            format!("<tr><td><code>{}</code></td><td>{}</td></tr>\n", escaped(path), escaped(value))
        })
        .collect();
    let has_ended = run.plan.has_ended(&run.records);
    let generations = run.plan.generations_in_words(run.records.len() as u32, has_ended);
    let stopped = match has_ended {
        true => String::new(),
        false => format!(
            "<p class=\"note\">Stopped after {generations}. The run hash is that of these; the command computes the whole \
             run.</p>\n"
        ),
    };
    let changes = match run.plan.changes == SettingChanges::default() {
        true => String::new(),
        false => "<p class=\"note\">Settings changed while it evolved; these are the last ones, and the command alone \
              does not repeat it.</p>\n"
            .to_owned(),
    };
    format!(
        "<section id=\"run\"><h2>Fitness by generation</h2>\n{}\n\
         <div class=\"row\" id=\"generations\" role=\"group\" aria-label=\"Champion of generation\">\n{buttons}</div>\n\
         <table>\n<tr><th scope=\"row\">Evaluations</th><td>{evaluations}</td></tr>\n\
         <tr><th scope=\"row\">Run hash</th><td>{:016x}</td></tr>\n\
         <tr><th scope=\"row\">Repeat it</th><td><code>{}</code></td></tr></table>\n{stopped}{changes}\
         <details><summary>All settings</summary><table>\n{rows}</table></details></section>\n",
        chart(run),
        run_hash(&run.records),
        escaped(&command(run)),
    )
}

/// Returns the command that repeats the run: the preset, and every setting that differs from the preset.
fn command(run: &ExportedRun) -> String {
    let plan = &run.plan;
    let shipped = shipped_presets().unwrap_or_default();
    let preset = shipped.iter().find(|preset| preset.name == plan.preset);
    let mut words = String::from("snakes --no-render");
    let mut add = |text: String| {
        words.push(' ');
        words += &text;
    };
    if preset.is_some() {
        add(format!("--preset {}", plan.preset));
    }
    add(format!("--seed {}", plan.seed));
    if let Some(founder) = &plan.founder {
        add(format!("--from \"{}.ron\"", founder.name()));
    }
    let usual = preset.map(|preset| fields(&preset.settings)).unwrap_or_default();
    for (path, value) in fields(&plan.settings) {
        if !usual.contains(&(path.clone(), value.clone())) {
            let quoted = value.contains([' ', '[', '(', '"']);
            add(if quoted {
                format!("--set '{path}={value}'")
            } else {
                format!("--set {path}={value}")
            });
        }
    }
    words
}

/// Draws a chart of the best, the median and the mean fitness as SVG.
fn chart(run: &ExportedRun) -> String {
    let statistics: Vec<_> = run
        .records
        .iter()
        .filter_map(|record| record.statistics.map(|of| (record.generation as f32, of)))
        .collect();
    let (Some((first, _)), Some((last, _))) = (statistics.first(), statistics.last()) else {
        return String::from("<p class=\"note\">No individual stayed healthy.</p>");
    };
    let values = statistics.iter().flat_map(|(_, of)| [of.best, of.median, of.mean]);
    let (low, high) =
        values.fold((f64::MAX, f64::MIN), |(low, high), value| (low.min(value), high.max(value)));
    let [left, top, right, bottom] = MARGINS;
    let [width, height] = [SIZE[0] - left - right, SIZE[1] - top - bottom];
    let x = |generation: f32| left + width * (generation - first) / (last - first).max(1.0);
    let y = |value: f64| top + height * (1.0 - ((value - low) / (high - low).max(1e-9)) as f32);
    let line = |of: fn(&Statistics) -> f64, style: &str| {
        let points = statistics.iter().map(|(generation, statistics)| {
            format!("{:.1},{:.1}", x(*generation), y(of(statistics)))
        });
        let points = points.collect::<Vec<_>>().join(" ");
        format!("<polyline points=\"{points}\" fill=\"none\" {style}/>")
    };
    let text = |x: f32, y: f32, anchor: &str, text: &str| {
        format!(
            "<text x=\"{x:.0}\" y=\"{y:.0}\" text-anchor=\"{anchor}\" fill=\"var(--weak)\" font-size=\"13\">{text}</text>"
        )
    };
    let end = SIZE[1] - 10.0;
    [
        format!(
            "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"Best fitness from {:.2} to {:.2} over {} generations\">",
            SIZE[0],
            SIZE[1],
            statistics[0].1.best,
            statistics[statistics.len() - 1].1.best,
            run.records.len()
        ),
        line(|of| of.mean, "stroke=\"var(--weak)\" stroke-dasharray=\"3 4\""),
        line(|of| of.median, "stroke=\"var(--twist)\" stroke-width=\"1.5\""),
        line(|of| of.best, "stroke=\"var(--accent)\" stroke-width=\"2.5\""),
        text(left - 8.0, y(high) + 4.0, "end", &format!("{high:.1}")),
        text(left - 8.0, y(low) + 4.0, "end", &format!("{low:.1}")),
        text(left, end, "start", &format!("generation {first}")),
        text(SIZE[0] - right, end, "end", &format!("{last}")),
        "</svg>\n<p class=\"note\"><span style=\"color: var(--accent)\">best</span>, \
         <span style=\"color: var(--twist)\">median</span>, mean (dashed)</p>"
            .to_owned(),
    ]
    .join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::evolve::{GenerationRecord, RunPlan, Settings, StrategyKind};

    #[test]
    fn r1_a_page_calls_a_run_stopped_only_if_evaluations_are_left() {
        let mut settings = Settings::default();
        settings.evolution.strategy = StrategyKind::CmaEs;
        (settings.evolution.population, settings.evolution.generations) = (200, 40);
        let mut records = vec![GenerationRecord::of_test(1, 800)];
        records.extend((2..=37).map(|generation| GenerationRecord::of_test(generation, 200)));
        let plan = RunPlan::new("climb", 1, settings);
        let mut run = ExportedRun { plan, records, generations: Vec::new() };
        assert!(!of(&run).contains("Stopped"), "800 and 36 * 200 are all of its 8,000 evaluations");
        run.records.pop();
        assert!(of(&run).contains("Stopped after 36 of at most 40 generations."));
    }
}
