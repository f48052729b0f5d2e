"""Runs, champions and results as dictionaries and data frames."""

import sys

import numpy as np
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
    for entry, (_, row) in zip(loaded["champions"], champions.iterrows()):
        results = entry["champion"].evaluate()
        assert f"{results.trace_hash[0]:016x}" == row["trace_hash"]
        assert row["energy_j"] == pytest.approx(results.energy_j[0], rel=1e-6)


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
    assert frame[frame["limb"] == limbs]["bend_rad"].isna().all()
    assert frame[frame["limb"] < limbs]["bend_rad"].notna().all()
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
