"""Runs, champions and results as dictionaries and data frames."""

import json
import sys

import numpy as np
import pandas
import pytest
from conftest import SAVES, SHORT

import snakes_and_stairs as sns


@pytest.fixture(scope="module")
def run(snakes, tmp_path_factory):
    """The folder of a small run."""
    saves = tmp_path_factory.mktemp("saves")
    settings = {**SHORT, "evolution.population": 8, "evolution.generations": 3, "newborns": 6}
    flags = [flag for name, value in settings.items() for flag in ("--set", f"{name}={value}")]
    snakes("--no-render", "--preset", "climb", "--seed", 3, "--out", saves, *flags)
    [folder] = saves.iterdir()
    return str(folder)


def test_a_run_is_a_dictionary_and_a_frame(run):
    loaded = sns.load_run(run)
    assert loaded["seed"] == 3 and loaded["settings"]["evolution"]["population"] == 8
    generations = len(loaded["generations"])
    frame = sns.run_frame(run)
    assert list(frame["generation"]) == list(range(1, generations + 1))
    assert (frame["best"] >= frame["mean"]).all()
    assert frame["hash"].str.fullmatch("[0-9a-f]{16}").all()
    champions = sns.champions_frame(run)
    assert len(champions) == len(loaded["champions"]) > 0
    assert list(frame["seed"]) == [3] * generations and set(champions["seed"]) == {3}
    for entry, (_, row) in zip(loaded["champions"], champions.iterrows()):
        results = entry["champion"].evaluate()
        assert results.trace_hash[0] == row["trace_hash"]
        assert row["energy_j"] == pytest.approx(results.energy_j[0], rel=1e-6)


def test_r6_a_runs_frame_has_the_names_and_values_of_its_lines_of_json(snakes, tmp_path):
    # Snakes that differ little from their founder land, so that the first landing has a number.
    settings = {"cma_es.step": 0.001, "evolution.population": 8, "evolution.generations": 2, "newborns": 6}
    flags = [flag for name, value in settings.items() for flag in ("--set", f"{name}={value}")]
    founder = ["--from", SAVES / "climber.ron"]
    printed = snakes("run", "--json", "--preset", "climb", "--out", tmp_path, *founder, *flags)
    lines = [json.loads(line) for line in printed.splitlines()]
    lines = [line for line in lines if "generation" in line and "mean" in line]
    [folder] = [path for path in tmp_path.iterdir() if path.is_dir()]
    frame = sns.run_frame(folder)
    assert len(frame) == len(lines) > 1
    same = ["generation", "evaluations", "disqualified", "crashed", "on_landing", "first_landing", "hash"]
    for line, (_, row) in zip(lines, frame.iterrows()):
        for name in same:
            assert row[name] == line[name] or line[name] is None and row[name] != row[name], name
        for name in ("mean", "best", "median", "std", "worst"):
            assert row[name] == pytest.approx(line[name], rel=1e-5), name
    assert "first_on_landing" not in frame and frame["first_landing"].notna().any()


def test_r9_an_exported_run_has_whole_numbers_of_seed_and_generation(snakes, run, tmp_path):
    path = tmp_path / "motion.csv"
    snakes("export", run, "-o", path)
    table = pandas.read_csv(path)
    assert set(table["seed"]) == {3} and pandas.api.types.is_integer_dtype(table["generation"])
    assert set(table["generation"]) == {entry["generation"] for entry in sns.load_run(run)["champions"]}


def test_r6_a_trajectory_has_the_columns_of_an_exported_table(snakes, tmp_path):
    path = tmp_path / "climber.csv"
    snakes("export", SAVES / "climber.ron", "-o", path)
    table, frame = pandas.read_csv(path), sns.trajectory_frame(SAVES / "climber.ron")
    assert len(table) == len(frame) and set(frame.columns) <= set(table.columns)
    for name in frame.columns:
        assert np.allclose(table[name], frame[name], atol=1e-6, equal_nan=True), name


def test_results_are_a_frame():
    problem = sns.Problem("climb", settings=SHORT)
    results = problem.evaluate(problem.random(4))
    frame = sns.evaluations_frame(results)
    assert len(frame) == 4
    assert np.array_equal(frame["trace_hash"], results.trace_hash)
    assert frame["fitness"].tolist() == results.fitness.tolist()


def test_a_trajectory_is_a_frame_with_a_row_per_moment_and_limb():
    path = str(SAVES / "climber.ron")
    frame, results = sns.trajectory_frame(path), sns.load_champion(path).evaluate()
    limbs = frame["limb"].max()
    assert len(frame) == (results.physics_steps[0] + 1) * limbs
    assert frame[frame["limb"] == 1]["joint_bend_rad"].isna().all()
    assert frame[frame["limb"] > 1]["joint_bend_rad"].notna().all()
    last = frame[frame["limb"] == limbs // 2 + 1].iloc[-1]
    assert last["y_m"] == pytest.approx(results.centre_y_m[0])


def test_a_folder_without_a_run_is_refused(tmp_path):
    with pytest.raises(OSError, match="cannot be read"):
        sns.load_run(str(tmp_path / "none"))


def test_without_pandas_frames_say_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    problem = sns.Problem("climb", settings=SHORT)
    with pytest.raises(ImportError, match="pip install pandas"):
        sns.evaluations_frame(problem.evaluate(problem.random(1)))
