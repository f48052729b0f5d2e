"""The comparison with baselines: what it counts, and that it continues."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest
from conftest import PYTHON

import snakes_and_stairs as sns

BASELINES = PYTHON / "baselines"
sys.path.insert(0, str(BASELINES))

import genomes  # noqa: E402
import page  # noqa: E402
import worlds  # noqa: E402

THRIFTY = PYTHON.parent / "saves/thrifty.ron"


def test_r13_a_policy_arrives_where_the_exam_of_the_program_says_so(tmp_path, snakes):
    genome = sns.Problem("climb").genome_of(THRIFTY)
    problem = sns.Problem("climb")
    landed = []
    for one in worlds.held_out():
        settings = {"trial.duration_s": worlds.HELD_OUT_DURATION_S}
        sns.Problem("climb", stairs=one["stairs"], settings=settings).save_champion(tmp_path / "a.ron", genome)
        moved = sns.load_champion(tmp_path / "a.ron").trajectory()
        arrival = worlds.Arrival(one["stairs"])
        for position_m, time_s in zip(moved["position_m"][1:], moved["time_s"][1:]):
            arrival.observe(position_m, time_s)
        landed.append(arrival.arrived)
    assert worlds.by_class(landed) == genomes.examine(problem, genome, os.environ["SNAKES"])
    assert 0 < sum(landed) < 60


@pytest.mark.parametrize("method", genomes.METHODS)
def test_r13_a_search_spends_no_more_than_its_budget_and_all_but_a_generation(method):
    ledger = genomes.search(method, "climb", 3, 2700.0)
    assert 2700.0 - genomes.POPULATION * worlds.DURATION_S < ledger.simulated_s <= 2700.0
    played = genomes.play(ledger.problem, ledger.best)
    assert played.fitness_m == ledger.best_ranking
    again = genomes.search(method, "climb", 3, 2700.0)
    assert np.array_equal(again.best, ledger.best)


def command(out, *arguments):
    line = [sys.executable, str(BASELINES / "run.py"), "--snakes", os.environ["SNAKES"], "--out", str(out)]
    line += ["--methods", "random", "--worlds", "climb", *arguments]
    return subprocess.run(line, capture_output=True, text=True)


def test_r13_a_comparison_continues_where_it_was_interrupted(tmp_path, snakes):
    out = tmp_path / "runs.jsonl"
    assert command(out, "--seeds", "2", "--budget", "100").returncode == 0
    whole = [json.loads(line) for line in out.read_text().splitlines()]
    assert [row["seed"] for row in whole] == [401, 402]
    # The second run was cut off while it was written.
    out.write_text(out.read_text()[:-20])
    again = command(out, "--seeds", "2", "--budget", "100")
    assert again.stdout.count("random") == 1, again.stdout
    rows = [json.loads(line) for line in out.read_text().splitlines()]
    times = {"wall_s", "cpu_s"}
    assert [{k: v for k, v in row.items() if k not in times} for row in rows] == [
        {k: v for k, v in row.items() if k not in times} for row in whole
    ]
    refused = command(out, "--seeds", "2", "--budget", "200")
    assert refused.returncode == 2 and "allowed: --budget 100" in refused.stderr


def rows_of(fitness):
    """Runs of our CMA-ES and of PPO with these fitnesses in `climb`."""
    return [
        {
            "method": method,
            "world": "climb",
            "seed": 401 + index,
            "budget_s": 100.0,
            "simulated_s": 100.0,
            "fitness_m": value,
            "steps_climbed": 3,
            "landed": False,
            "trace_hash": "00",
            "held_out": dict.fromkeys(worlds.CLASSES, 1),
            "wall_s": 1.0,
            "cpu_s": 1.0,
            "engine": 3,
            "versions": {"python": "3"},
        }
        for method, values in fitness.items()
        for index, value in enumerate(values)
    ]


def test_r13_the_page_has_the_tables_of_the_stored_runs():
    text = page.PAGE.read_text(encoding="utf-8")
    assert page.with_tables(text, worlds.stored(page.RUNS)) == text


def test_r13_the_page_says_when_a_baseline_wins_and_only_then():
    low, high = [float(i) for i in range(10)], [20.0 + i for i in range(10)]
    assert "**PPO beats our CMA-ES in `climb`, fitness" in page.tables(rows_of({"cma-es": low, "ppo": high}))
    for other in (low, [-value for value in high]):
        text = page.tables(rows_of({"cma-es": low, "ppo": other}))
        assert "No difference in favour of another method" in text and "**PPO" not in text
    assert "| worse |" in text


def test_r13_probabilities_are_corrected_for_their_number():
    # Holm's own example of three tests.
    assert page.holm([0.01, 0.04, 0.03]) == pytest.approx([0.03, 0.06, 0.06])


def test_r13_a_policy_learns_alike_twice_and_within_its_budget():
    policies = pytest.importorskip("policies", reason="stable-baselines3 is not installed", exc_type=ImportError)
    first, second = (policies.learn("ppo", "climb", 3, 600.0) for _ in range(2))
    assert first.played == second.played and first.best.hash() == second.best.hash()
    assert 0 < first.simulated_s <= 600.0
    # Its trial is the same in physics steps of which each holds for itself, as on the held-out stairs.
    [stepped] = policies.own_world("climb")
    assert policies.play(first.best, [stepped])[0] == first.played
    single = policies.environment("climb")
    single.arrival = worlds.Arrival(worlds.held_out()[0]["stairs"])
    assert policies.play(first.best, [single])[0].trace_hash == first.played.trace_hash


def test_r13_a_policy_is_rewarded_at_once_for_what_the_fitness_counts():
    policies = pytest.importorskip("policies", reason="stable-baselines3 is not installed", exc_type=ImportError)
    world = policies.environment("climb", steps_per_action=policies.STEPS_PER_ACTION)
    _, info = world.reset()
    start_m, total_m, step, is_over = info["y_m"], 0.0, 0, False
    while not is_over:
        # A wave at first; at rest the mean over the last half second is the last place.
        wave = 0.8 * np.sin(0.2 * step + np.arange(4)) if step < 200 else np.zeros(4)
        _, reward, terminated, truncated, info = world.step(wave.astype(np.float32))
        step, total_m, is_over = step + 1, total_m + reward, terminated or truncated
    assert abs(info["y_m"] - start_m) > 0.5
    assert total_m == pytest.approx(info["evaluation"]["fitness"] - start_m, abs=0.01)
