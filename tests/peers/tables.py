"""Reads a CSV and a Parquet file of the same motion with pandas and DuckDB: `tables.py CSV PARQUET COLUMNS`.

COLUMNS is a JSON file with [name, meaning] for each column. Both files have to have these columns, in this order, and the
same values in every program; a value that is not there is missing everywhere. It prints the number of rows.
"""

import json
import pathlib
import sys

# Beside this file lies a script with the name of another package.
sys.path = [entry for entry in sys.path if entry != str(pathlib.Path(__file__).resolve().parent)]

import duckdb  # noqa: E402
import numpy  # noqa: E402
import pandas  # noqa: E402
import pyarrow.parquet  # noqa: E402

KEYS = {"champion": "object", "seed": "uint64", "generation": "int32", "step": "int32", "time_s": "float64", "limb": "int32"}


def main(csv_path, parquet_path, columns_path):
    columns = json.loads(pathlib.Path(columns_path).read_text(encoding="utf-8"))
    names = [name for name, _ in columns]
    with duckdb.connect() as database:
        tables = {
            "CSV in pandas": pandas.read_csv(csv_path, float_precision="round_trip", keep_default_na=False, na_values={name: [""] for name in names[1:]}),
            "Parquet in pandas": pandas.read_parquet(parquet_path),
            "CSV in DuckDB": database.read_csv(csv_path, header=True).df(),
            "Parquet in DuckDB": database.read_parquet(parquet_path).df(),
        }
    reference = tables["Parquet in pandas"]
    for name in names:
        kind = KEYS.get(name, "float32")
        found = reference[name].dtype
        assert kind == "object" or found == kind, f"{name} is {found}; expected: {kind}"
    for source, table in tables.items():
        assert list(table.columns) == names, f"{source}: columns {list(table.columns)}"
        assert len(table) == len(reference), f"{source}: {len(table)} rows; expected: {len(reference)}"
        assert list(table["champion"]) == list(reference["champion"]), f"{source}: champion differs"
        for name in names[1:]:
            kind = KEYS.get(name, "float32")
            if not kind.startswith("float"):
                assert list(table[name]) == list(reference[name]), f"{source}: {name} differs"
                continue
            there = table[name].to_numpy(dtype="float64").astype(kind)
            expected = reference[name].to_numpy(dtype="float64").astype(kind)
            assert numpy.array_equal(there, expected, equal_nan=True), f"{source}: {name} differs"
    metadata = pyarrow.parquet.read_schema(parquet_path).metadata
    for name, meaning in columns:
        assert metadata[name.encode()].decode() == meaning, f"{name} means {metadata[name.encode()]}"
    facts = json.loads(metadata[b"champions"])
    assert [of["champion"] for of in facts] == list(reference["champion"].unique()), facts
    assert all(len(of["trace_hash"]) == 16 and of["preset"] and of["seed"] for of in facts), facts
    for of in facts:
        rows = reference[reference["champion"] == of["champion"]]
        found = (rows["seed"].unique().tolist(), rows["generation"].unique().tolist())
        assert found == ([int(of["seed"])], [int(of["generation"])]), found
    # The head has no joint in front of it.
    assert reference.loc[reference["limb"] == 1, "joint_bend_rad"].isna().all()
    assert reference.loc[reference["limb"] > 1, "joint_bend_rad"].notna().all()
    print(f"{len(reference)} rows")


if __name__ == "__main__":
    main(*sys.argv[1:])
