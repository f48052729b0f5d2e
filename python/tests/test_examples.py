"""Every example runs, on small numbers."""

import re
import runpy
import subprocess
import sys

import pytest
import ribs.archives
from conftest import PYTHON

import snakes_and_stairs as sns

EXAMPLES = PYTHON / "examples"
RUNS = {
    "pycma_climb.py": (
        ["--evaluations", "160", "--duration", "4", "--steps", "2"],
        r"1[0-9]0 evaluations, best fitness -?[0-9.]+ m, landing",
    ),
    "pyribs_map_elites.py": (
        ["--iterations", "4", "--batch", "20", "--duration", "4"],
        r"[1-9][0-9]* elites in 256 cells, best fitness",
    ),
    "vectorised_random_policy.py": (
        ["--worlds", "8", "--episodes", "12", "--duration", "3"],
        r"1[2-9] episodes: mean return -?[0-9.]+ m",
    ),
    "dask_processes.py": (
        ["--processes", "2", "--genomes", "24", "--duration", "3"],
        r"24 genomes in 2 processes: best fitness .* the same bits as here",
    ),
    "compare_cma.py": (
        ["--seeds", "1", "--evaluations", "160", "--duration", "3"],
        r"median \| - - \|",
    ),
    "speed.py": (
        ["--worlds", "4", "--rounds", "1", "--seconds", "0.2"],
        r"targets, 1 steps per action: [1-9][0-9]*",
    ),
}


def test_every_example_is_run():
    assert {path.name for path in EXAMPLES.glob("*.py")} == set(RUNS)


@pytest.mark.parametrize("name", RUNS)
def test_an_example_runs(name, tmp_path):
    arguments, expected = RUNS[name]
    command = [sys.executable, str(EXAMPLES / name), *arguments]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, timeout=300)
    assert done.returncode == 0, done.stderr
    assert re.search(expected, done.stdout), done.stdout


def test_no_disqualified_snake_enters_the_archive_of_pyribs(monkeypatch):
    archives, archive_of_ribs, problem_of = [], ribs.archives.GridArchive, sns.Problem

    def archive(**arguments):
        archives.append(archive_of_ribs(**arguments))
        return archives[-1]

    def problem(preset, settings):
        return problem_of(preset, settings={**settings, "trial.health.speed_m_s": 2.0})

    monkeypatch.setattr(ribs.archives, "GridArchive", archive)
    monkeypatch.setattr(sns, "Problem", problem)
    monkeypatch.setattr(sys, "argv", ["", *RUNS["pyribs_map_elites.py"][0]])
    runpy.run_path(str(EXAMPLES / "pyribs_map_elites.py"), run_name="__main__")
    [archive] = archives
    solutions = archive.data("solution")
    results = problem("climb", {"trial.duration_s": 4}).evaluate(solutions)
    assert len(results) > 0 and not results.disqualified.any()
    assert archive.qd_score_offset == -30.0 < results.fitness.min()


def test_a_snake_of_pycma_is_saved_for_the_program(tmp_path, snakes):
    arguments, _ = RUNS["pycma_climb.py"]
    path = tmp_path / "found.ron"
    command = [sys.executable, str(EXAMPLES / "pycma_climb.py"), *arguments, "--out", str(path)]
    subprocess.run(command, check=True, capture_output=True, timeout=300)
    assert "equal to the record, bit for bit" in snakes("replay", path, "--no-render")
