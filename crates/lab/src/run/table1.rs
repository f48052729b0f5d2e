//! The report's Table 1 beside ours: the mean fitness of each generation, over several seeds.

use super::experiment::Experiment;
use super::report::GenerationReport;
use super::run_control::Cancelled;
use snakes_core::evolve::RunPlan;

/// The means of the report's Table 1, generation 1 first.
pub const REPORT_MEANS: [f64; 6] = [-7.23, -5.94, -2.05, 3.84, 5.79, 8.05];

/// One run of the protocol.
#[derive(Debug, Clone, PartialEq)]
pub struct SeedResult {
    /// Seed of the run.
    pub seed: u64,
    /// Mean fitness of each generation; none where all individuals were disqualified.
    pub means: Vec<Option<f64>>,
    /// Number of disqualified individuals in each generation.
    pub disqualified: Vec<u32>,
    /// Hash of the run.
    pub run_hash: u64,
}

impl SeedResult {
    /// Whether the mean rises with every generation.
    pub fn rises(&self) -> bool {
        self.means.windows(2).all(|pair| matches!(pair, [Some(a), Some(b)] if b > a))
    }

    /// Whether the last generation's mean is at least the report's.
    pub fn reaches_the_report(&self) -> bool {
        let last = self.means.last().copied().flatten();
        last.is_some_and(|last| last >= REPORT_MEANS[REPORT_MEANS.len() - 1])
    }
}

/// Runs the protocol once; `run` evolves one generation after the other.
///
/// # Errors
/// [`Cancelled`], if `run` was.
pub fn run_seed(
    plan: RunPlan,
    mut run: impl FnMut(&mut Experiment) -> Result<GenerationReport, Cancelled>,
) -> Result<SeedResult, Cancelled> {
    let seed = plan.seed;
    let mut experiment = Experiment::new(plan);
    let (mut means, mut disqualified) = (Vec::new(), Vec::new());
    while !experiment.is_over() {
        let report = run(&mut experiment)?;
        means.push(report.statistics.map(|statistics| statistics.mean));
        disqualified.push(report.disqualified);
    }
    Ok(SeedResult { seed, means, disqualified, run_hash: experiment.run_hash() })
}

/// The means of several seeds, generation by generation.
#[derive(Debug, Clone, PartialEq)]
pub struct Table1 {
    /// The seeds' results, in the order of the seeds.
    pub seeds: Vec<SeedResult>,
}

/// Means of a generation over all seeds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeedSpread {
    /// Mean of the seeds' means.
    pub mean: f64,
    /// Standard deviation between the seeds (divided by n - 1); 0 for one seed.
    pub std: f64,
    /// Least of the seeds' means.
    pub least: f64,
    /// Greatest of the seeds' means.
    pub greatest: f64,
}

impl Table1 {
    /// Mean and spread over the seeds, for each generation; none where no seed has a mean.
    pub fn spreads(&self) -> Vec<Option<SeedSpread>> {
        let generations = self.seeds.iter().map(|seed| seed.means.len()).max().unwrap_or(0);
        (0..generations)
            .map(|generation| {
                let means = self.seeds.iter().filter_map(|seed| *seed.means.get(generation)?);
                SeedSpread::of(&means.collect::<Vec<f64>>())
            })
            .collect()
    }

    /// Mean over the seeds of the number of individuals that were disqualified in a generation, counted from 0.
    pub fn disqualified(&self, generation: usize) -> f64 {
        let counts = self.seeds.iter().filter_map(|seed| seed.disqualified.get(generation));
        let (sum, seeds) = counts.fold((0_u32, 0_u32), |(sum, seeds), one| (sum + one, seeds + 1));
        f64::from(sum) / f64::from(seeds.max(1))
    }

    /// Number of seeds in which the mean rises with every generation.
    pub fn rising(&self) -> usize {
        self.seeds.iter().filter(|seed| seed.rises()).count()
    }

    /// Number of seeds in which the last mean is at least the report's.
    pub fn reaching(&self) -> usize {
        self.seeds.iter().filter(|seed| seed.reaches_the_report()).count()
    }

    /// Number of seeds for which both are true.
    pub fn both(&self) -> usize {
        self.seeds.iter().filter(|seed| seed.rises() && seed.reaches_the_report()).count()
    }

    /// The two tables side by side, as text. `meaning` expresses a mean in the report's words.
    pub fn text(&self, meaning: impl Fn(f64) -> String) -> String {
        let mut text = format!(
            "{:>10} | {:>7}  {:<18} | {:>7}  {:>9}  {:>7}  {:>7}  {:>12}  {}\n",
            "", "report", "in words", "ours", "std.dev.", "min", "max", "disqualified", "in words"
        );
        for (index, spread) in self.spreads().into_iter().enumerate() {
            let report = REPORT_MEANS.get(index);
            let theirs = report.map_or("-".to_owned(), |mean| format!("{mean:.2}"));
            let words = report.map_or(String::new(), |mean| meaning(*mean));
            let ours = match spread {
                Some(s) => format!(
                    "{:>7.2}  {:>9.2}  {:>7.2}  {:>7.2}  {:>12.0}  {}",
                    s.mean,
                    s.std,
                    s.least,
                    s.greatest,
                    self.disqualified(index),
                    meaning(s.mean)
                ),
                None => "all disqualified".to_owned(),
            };
            text += &format!("{:>10} | {theirs:>7}  {words:<18} | {ours}\n", index + 1);
        }
        let seeds = self.seeds.len();
        text += &format!(
            "\nThe mean rises with every generation in {} of {seeds} seeds, ends at {:.2} or more in {}, \
             and does both in {}.\n",
            self.rising(),
            REPORT_MEANS[REPORT_MEANS.len() - 1],
            self.reaching(),
            self.both(),
        );
        text
    }

    /// The records of the CSV file, the header first: one per seed and generation.
    pub fn records(&self) -> Vec<Vec<String>> {
        let head = ["seed", "generation", "mean_m", "disqualified", "report_mean_m", "run_hash"];
        let mut records = vec![head.map(str::to_owned).to_vec()];
        for seed in &self.seeds {
            for (index, (mean, disqualified)) in
                seed.means.iter().zip(&seed.disqualified).enumerate()
            {
                records.push(vec![
                    seed.seed.to_string(),
                    (index + 1).to_string(),
                    mean.map_or(String::new(), |mean| mean.to_string()),
                    disqualified.to_string(),
                    REPORT_MEANS.get(index).map_or(String::new(), f64::to_string),
                    format!("{:016x}", seed.run_hash),
                ]);
            }
        }
        records
    }
}

impl SeedSpread {
    fn of(values: &[f64]) -> Option<Self> {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>();
        let least = values.iter().copied().reduce(f64::min)?;
        let greatest = values.iter().copied().reduce(f64::max)?;
        Some(Self { mean, std: (squares / (count - 1.0).max(1.0)).sqrt(), least, greatest })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::{LocalPool, RunControl};
    use snakes_core::evolve::Settings;

    fn seed(seed: u64, means: &[f64]) -> SeedResult {
        SeedResult {
            seed,
            means: means.iter().copied().map(Some).collect(),
            disqualified: vec![0; means.len()],
            run_hash: seed,
        }
    }

    #[test]
    fn the_table_counts_rising_and_reaching_seeds() {
        let mut table = Table1 {
            seeds: vec![
                seed(1, &[-7.0, -5.0, -2.0, 3.0, 6.0, 9.0]),
                seed(2, &[-7.0, -5.0, -2.0, 3.0, 2.9, 8.1]),
                seed(3, &[-7.0, -5.0, -2.0, 3.0, 6.0, 8.0]),
            ],
        };
        assert_eq!((table.rising(), table.reaching(), table.both()), (2, 2, 1));
        let last = table.spreads()[5].expect("three means");
        assert!((last.mean - 25.1 / 3.0).abs() < 1e-9);
        assert_eq!((last.least, last.greatest), (8.0, 9.0));
        assert!((last.std - 0.5507).abs() < 1e-3, "{}", last.std);
        table.seeds[0].disqualified[5] = 300;
        let text = table.text(|mean| format!("<{mean:.1}>"));
        assert!(text.contains("8.05  <8.1>") && text.contains("  100  <8.4>"), "{text}");
        assert_eq!(table.records().len(), 19);
        assert_eq!(table.records()[6][..5], ["1", "6", "9", "300", "8.05"]);
    }

    #[test]
    fn a_seed_has_the_hash_of_the_same_run_elsewhere() {
        let mut settings = Settings::default();
        settings.evolution.population = 6;
        settings.evolution.generations = 2;
        settings.trial.duration_s = 0.5;
        let plan = RunPlan::new("test", 3, settings);
        let evaluator = LocalPool::new(1).expect("threads");
        let control = RunControl::default();
        let mut run = |experiment: &mut Experiment| experiment.run_generation(&evaluator, &control);
        let result = run_seed(plan.clone(), &mut run).expect("not cancelled");
        let mut experiment = Experiment::new(plan);
        while !experiment.is_over() {
            run(&mut experiment).expect("not cancelled");
        }
        assert_eq!(result.run_hash, experiment.run_hash());
        assert_eq!(result.means.len(), 2);
    }
}
