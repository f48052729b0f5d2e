//! `snakes bench`: the speed of the simulation, as a table or JSON.

use std::path::Path;
use std::time::Duration;

use indicatif::ProgressBar;

use super::args::Args;
use super::error::CliError;
use super::output::{print, print_json};
use snakes_core::evolve::Champion;
use snakes_core::save::load_champion;
use snakes_core::schema::Choices;
use snakes_lab::run::bench::{BenchReport, Workload, bench};
use snakes_lab::run::headless::HeadlessError;

/// Duration of the benchmark, enough for about twenty rounds of every variant.
const BENCH_DURATION: Duration = Duration::from_secs(6);

/// Measures the speed with a saved champion, or else with newborns of a run, and prints the figures.
pub fn print_bench(args: &Args, champion: Option<&Path>) -> Result<(), CliError> {
    let workload = match champion {
        Some(file) => workload_of(file)?,
        None => Workload::newborns(&args.settings_of_run()?.1),
    };
    let bar = ProgressBar::new(100);
    let report = bench(&workload, args.threads()?, BENCH_DURATION, |share| {
        bar.set_position((share * 100.0) as u64);
    });
    bar.finish_and_clear();
    let report = report.map_err(HeadlessError::from)?;
    if args.json {
        let mut line = serde_json::json!(report);
        line["type"] = "bench".into();
        return print_json(&line);
    }
    print(&table(&report))
}

fn workload_of(file: &Path) -> Result<Workload, CliError> {
    let Champion { genome, trial, .. } = load_champion(file)?.champion;
    Workload::champion(genome, trial).ok_or_else(|| {
        let reason = "is disqualified before its trial ends; only a whole trial is measured";
        CliError::Usage(format!("{}: the champion {reason}", file.display()))
    })
}

fn table(report: &BenchReport) -> String {
    let engine = match report.simd {
        Some(simd) => format!("{}, {} lanes, {simd}", report.engine.choice().name, report.lanes),
        None => report.engine.choice().name.to_owned(),
    };
    format!(
        "engine                   {engine}\n\
         threads                  {}\n\
         steps_per_s              {:.0}\n\
         sim_s_per_s              {:.1}  ({:.1} per thread)\n\
         one thread               {:.1} sim_s_per_s\n\
         bare rapier, one thread  {:.1} sim_s_per_s\n\
         ratio to bare rapier     {:.3}\n\
         scaling over one thread  {:.3}\n",
        report.threads,
        report.steps_per_s,
        report.sim_s_per_s,
        report.sim_s_per_s_per_thread,
        report.one_thread_sim_s_per_s,
        report.bare_rapier_sim_s_per_s,
        report.ratio_to_bare_rapier,
        report.scaling,
    )
}
