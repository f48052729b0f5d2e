//! Benchmarks of listing a large folder of saves and of reading one entry.

use criterion::Criterion;
use snakes_core::save::SavesFolder;
use snakes_core::save::library::{SavePlace, list, read_entry};

/// Lists a folder of ten thousand small files, whose contents are not read.
pub fn listing(criterion: &mut Criterion) {
    let folder = tempfile::tempdir().expect("a folder");
    for number in 0..10_000 {
        let path = folder.path().join(format!("champion {number}.ron"));
        std::fs::write(path, "()").expect("written");
    }
    let saves = SavesFolder::find(Some(folder.path()));
    let mut group = criterion.benchmark_group("library");
    group.sample_size(20);
    group.bench_function("list 10 000", |bencher| {
        bencher.iter(|| list(&saves).expect("readable"));
    });
    group.bench_function("read one", |bencher| {
        bencher.iter(|| read_entry(&SavePlace::Shipped("climber")).expect("whole"));
    });
}
