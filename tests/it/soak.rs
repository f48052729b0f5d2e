//! A long run of half an hour: memory stays flat, logs stay small.
//!
//!     cargo test --release --test it soak -- --ignored --nocapture
//!
//! `SNAKES_SOAK_MINUTES` changes the duration. A million evaluations take about fifteen minutes on two
//! cores, or thirty on one.
#![cfg(target_os = "linux")]

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use super::program::{folder, run_in, snakes};

const SAMPLING_INTERVAL: Duration = Duration::from_secs(5);
/// Time after which threads, caches and the allocator have grown to their final size.
const WARM_UP: Duration = Duration::from_secs(30);
/// Noise of the allocator, in KiB. A leak of 20 bytes per evaluation would exceed it after a million evaluations.
const MAX_GROWTH_KIB: u64 = 16 * 1024;

/// Reads a value of `/proc/PID/status`, in KiB.
fn status_kib(process: u32, field: &str) -> u64 {
    let status = fs::read_to_string(format!("/proc/{process}/status")).expect("it runs");
    let line = status.lines().find(|line| line.starts_with(field)).expect(field);
    line.split_whitespace().nth(1).and_then(|kib| kib.parse().ok()).expect("a number")
}

/// Returns the number and the total size, in bytes, of a folder's files whose names begin with `prefix`.
fn count_and_bytes(run: &Path, prefix: &str) -> (usize, u64) {
    let files = fs::read_dir(run).expect("a folder").map(|file| file.expect("a file"));
    let files = files.filter(|file| file.file_name().to_string_lossy().starts_with(prefix));
    files.fold((0, 0), |(count, bytes), file| {
        (count + 1, bytes + file.metadata().map_or(0, |about| about.len()))
    })
}

#[test]
#[ignore = "half an hour; run it by hand"]
fn memory_stays_flat_and_logs_small() {
    let minutes = std::env::var("SNAKES_SOAK_MINUTES").ok();
    let minutes: f64 = minutes.map_or(30.0, |text| text.parse().expect("a number of minutes"));
    let saves = folder();
    let threads = std::env::var("SNAKES_SOAK_THREADS").unwrap_or("2".to_owned());
    let arguments = format!(
        "--no-render --json --duration 1 --generations 10000 --out out --threads {threads}"
    );
    let mut child = snakes(saves.path(), &arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    let generations = Arc::new(AtomicU64::new(0));
    let counter = Arc::clone(&generations);
    let lines = BufReader::new(child.stdout.take().expect("piped")).lines();
    let reader = thread::spawn(move || {
        for _ in lines {
            counter.fetch_add(1, Ordering::Relaxed);
        }
    });
    let started = Instant::now();
    let mut seen = Vec::new();
    while started.elapsed().as_secs_f64() < minutes * 60.0 {
        thread::sleep(SAMPLING_INTERVAL);
        let rss = status_kib(child.id(), "VmRSS:");
        let elapsed = started.elapsed();
        if elapsed > WARM_UP {
            seen.push((generations.load(Ordering::Relaxed) * 500, rss));
        }
    }
    let peak = status_kib(child.id(), "VmHWM:");
    let pid = child.id().to_string();
    Command::new("kill").args(["-INT", &pid]).status().expect("kill");
    child.wait().expect("ended");
    reader.join().expect("read");
    let run = run_in(&saves.path().join("out")).expect("a run");
    let (_, log_bytes) = count_and_bytes(&run, "log.jsonl");
    let (checkpoints, checkpoint_bytes) = count_and_bytes(&run, "checkpoint-");
    let (champions, champion_bytes) = count_and_bytes(&run, "generation-");
    let (first, last) = (seen[0], seen[seen.len() - 1]);
    for (evaluations, rss) in seen.iter().step_by((seen.len() / 12).max(1)).chain([&last]) {
        println!("{evaluations:>9} evaluations  {rss:>7} KiB");
    }
    println!(
        "peak {peak} KiB; log {log_bytes} bytes; {checkpoints} checkpoints, {checkpoint_bytes} bytes; \
         {champions} champions, {champion_bytes} bytes"
    );
    assert!(last.1 <= first.1 + MAX_GROWTH_KIB, "from {} to {} KiB", first.1, last.1);
    assert!(checkpoints <= 16, "{checkpoints} checkpoints");
    assert!(log_bytes < 1000 * champions as u64, "{log_bytes} bytes of log");
}
