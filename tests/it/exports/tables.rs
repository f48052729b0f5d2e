//! Tables of motion, read by pandas and DuckDB.

use std::fs;
use std::path::Path;

use serde_json::json;
use snakes_core::save::load_champion;
use snakes_lab::export::columns;

use super::{peer_python, peer_script, succeed};
use crate::program::{folder, stdout_of};

#[test]
fn pandas_and_duckdb_read_the_same_values_from_csv_and_parquet() {
    let test = "pandas_and_duckdb_read_the_same_values_from_csv_and_parquet";
    let Some(mut python) = peer_python("pandas, pyarrow, duckdb, numpy", test) else { return };
    let folder = folder();
    let saves = Path::new(env!("CARGO_MANIFEST_DIR")).join("saves");
    // The second name has characters that tables must quote.
    let (first, second) = ("climber", "first, \"climber\"\u{e9}");
    fs::copy(saves.join("climber.ron"), folder.path().join("climber.ron")).expect("copied");
    let strange = folder.path().join("strange");
    fs::create_dir(&strange).expect("a folder");
    let file = strange.join(format!("{second}.ron"));
    fs::copy(saves.join("first-climber.ron"), &file).expect("copied");
    let rows: u32 = [&folder.path().join(format!("{first}.ron")), &file]
        .into_iter()
        .map(|file| load_champion(file).expect("well formed").champion)
        .map(|champion| (champion.evaluation.steps + 1) * champion.body().limbs() as u32)
        .sum();
    for ending in ["csv", "parquet"] {
        let mut export = crate::program::snakes(folder.path(), "export climber.ron");
        export.arg(&file).args(["-o", &format!("motion.{ending}")]);
        succeed(&mut export);
    }
    let list: Vec<_> = columns().map(|column| json!([column.name, column.meaning])).collect();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("columns.json"), json!(list).to_string()).expect("written");
    python.arg(peer_script("tables.py")).args([path("motion.csv"), path("motion.parquet")]);
    let said = succeed(python.arg(path("columns.json")));
    assert_eq!(said.trim(), format!("{rows} rows"));
    assert!(stdout_of(folder.path(), "export --help").contains(".parquet"));
}
