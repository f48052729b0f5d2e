//! The logs of a run. The first byte selects the log, and whether the lines get correct checksums; without them, a
//! fuzzer would hardly get further than the checksum.
#![no_main]

use std::path::Path;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use snakes_core::evolve::{RunPlan, Settings};
use snakes_core::save::{
    fingerprint, parse_changes, parse_evaluations, parse_lineage, parse_records,
};
use xxhash_rust::xxh3::xxh3_64;

static PLAN: LazyLock<(RunPlan, String)> = LazyLock::new(|| {
    let plan = RunPlan::new("x", 1, Settings::default());
    let fingerprint = fingerprint(&plan);
    (plan, fingerprint)
});

fuzz_target!(|input: (u8, Vec<u8>)| {
    let (how, bytes) = input;
    let mut bytes = String::from_utf8_lossy(&bytes).replace("PLAN", &PLAN.1).into_bytes();
    if how & 1 == 0 {
        let lines = bytes.split(|byte| *byte == b'\n').map(|line| {
            let sum = format!(",\"sum\":\"{:016x}\"}}\n", xxh3_64(line));
            [line, sum.as_bytes()].concat()
        });
        bytes = lines.collect::<Vec<_>>().concat();
    }
    let path = Path::new("x");
    let error = match how & 6 {
        0 => parse_records(path, &bytes, &PLAN.0).err(),
        2 => parse_evaluations(path, &bytes, 1, &PLAN.0).err(),
        4 => parse_lineage(path, &bytes, &PLAN.0).err(),
        _ => parse_changes(path, &bytes, &PLAN.0).err(),
    };
    assert!(!error.is_some_and(|error| error.to_string().contains('\n')));
});
