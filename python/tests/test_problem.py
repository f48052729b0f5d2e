"""Evaluation in batches."""

import multiprocessing
import os
import pickle
import signal
import threading
import time

import numpy as np
import pytest
from conftest import SAVES, SHORT

import snakes_and_stairs as sns
from snakes_and_stairs import Problem, evaluate


def test_presets_are_listed_with_the_default_first():
    names = list(sns.presets())
    assert names[0] == "climb" and "ice" in names
    assert all(len(about) > 60 for about in sns.presets().values())


def test_a_batch_has_the_results_of_its_genomes_alone():
    problem = Problem("climb", settings=SHORT)
    genomes = problem.random(20, seed=3)
    assert genomes.shape == (20, problem.dimension)
    together = problem.evaluate(genomes)
    assert len(together) == 20
    assert len(set(together.trace_hash.tolist())) == 20, "different snakes move differently"
    for index in (0, 7, 19):
        alone = problem.evaluate(genomes[index], threads=1)
        assert alone.trace_hash[0] == together.trace_hash[index]
        assert alone.fitness[0] == together.fitness[index]
        assert alone.energy_j[0] == together.energy_j[index] > 0
    again = evaluate(genomes, "climb", settings=SHORT, threads=3)
    assert np.array_equal(again.trace_hash, together.trace_hash)


def test_results_are_arrays_with_one_value_per_snake():
    problem = Problem("climb", settings=SHORT)
    results = problem.evaluate(problem.random(5))
    for name in sns.frames.EVALUATION_COLUMNS:
        assert getattr(results, name).shape == (5,), name
    assert results.trace_hash.dtype == np.dtype("U16")
    assert results.disqualified.dtype == results.on_landing.dtype == bool
    assert results.steps_climbed.dtype == np.int64
    assert (results.frequency_hz > 0).all()


def test_the_shipped_climber_lands_and_its_row_does_too():
    path = str(SAVES / "climber.ron")
    record = sns.load_champion(path).to_dict()
    # The champion's own engine and duration.
    settings = {"trial.physics.engine": "rapier", "trial.duration_s": record["trial"]["duration_s"]}
    problem = Problem("climb", settings=settings)
    results = problem.evaluate(problem.genome_of(path))
    assert results.on_landing[0] and results.steps_climbed[0] == problem.steps == 10
    assert results.fitness[0] == pytest.approx(record["recorded"]["fitness"], abs=0.5)


def test_a_disqualified_snake_says_why():
    problem = Problem("climb", settings={**SHORT, "trial.health.speed_m_s": 1.0})
    results = problem.evaluate(problem.random(10))
    assert results.disqualified.any()
    for is_out, reason in zip(results.disqualified, results.reasons):
        assert (reason == "speed limit exceeded") if is_out else reason is None
    assert not (results.on_landing & results.disqualified).any()


def test_a_disqualified_snake_is_never_the_best():
    problem = Problem("climb", settings={**SHORT, "trial.health.speed_m_s": 2.0})
    results = problem.evaluate(problem.random(60))
    out = results.disqualified
    assert out.any() and not out.all()
    assert np.isneginf(results.ranking[out]).all()
    assert np.array_equal(results.ranking[~out], results.fitness[~out])
    assert not out[results.ranking.argmax()]


def test_numbers_outside_the_cube_are_reflected():
    problem = Problem("climb", settings=SHORT)
    inside = np.full(problem.dimension, 0.25)
    outside = inside.copy()
    outside[0] = -0.25
    hashes = problem.evaluate(np.stack([inside, outside])).trace_hash
    assert hashes[0] == hashes[1]


def test_genes_and_decoded_genomes_agree():
    problem = Problem("climb", settings=SHORT)
    genes = problem.genes
    assert [gene["index"] for gene in genes] == list(range(problem.dimension))
    frequency = next(gene for gene in genes if gene["field"] == "frequency_hz")
    assert frequency["unit"] == "Hz" and frequency["allowed"] == "0.2 to 3"
    genome = np.full(problem.dimension, 0.5)
    genome[frequency["index"]] = 1.0
    [decoded] = problem.decode(genome)
    assert decoded["controller"]["Gait"]["waves"]["frequency_hz"] == 3.0


def test_random_genomes_are_those_of_a_run():
    search = sns.Search("climb", strategy="random", seed=11, settings={**SHORT, "population": 6})
    problem = Problem("climb", settings=SHORT)
    assert np.array_equal(search.ask(), problem.random(6, seed=11))
    assert not np.array_equal(problem.random(6, seed=12), problem.random(6, seed=11))


@pytest.mark.parametrize("preset", ["report", "ice", "senses", "limb-neurons", "waves-by-rules"])
def test_every_kind_of_genome_that_is_an_array_can_be_evaluated(preset):
    problem = Problem(preset, settings=SHORT)
    results = problem.evaluate(problem.random(2))
    assert (results.physics_steps[~results.disqualified] > 0).all()
    assert np.isfinite(results.fitness).all()


@pytest.mark.parametrize("preset", ["bodies", "creatures", "neat", "q-learning", "xcs", "zcs"])
def test_r4_genomes_that_are_more_than_numbers_are_dictionaries(preset, tmp_path, snakes):
    problem = Problem(preset, settings=SHORT)
    genomes = problem.random(3, seed=2)
    assert len(genomes) == 3 and problem.decode(genomes) == genomes
    results = problem.evaluate(genomes)
    assert problem.evaluate(genomes[1]).trace_hash[0] == results.trace_hash[1]
    path = tmp_path / "found.ron"
    problem.save_champion(path, genomes[2])
    assert "equal to the record, bit for bit" in snakes("replay", path, "--no-render")
    assert problem.genome_of(path) == genomes[2]
    for name in ("dimension", "genes"):
        with pytest.raises(ValueError, match=f"{name} is asked for; allowed: a problem whose genomes are arrays"):
            getattr(problem, name)
    with pytest.raises(ValueError, match="genomes is an array; allowed: a list of dictionaries"):
        problem.evaluate(np.zeros((1, 1)))
    with pytest.raises(ValueError, match="genomes is unreadable .*; allowed: genomes as"):
        problem.evaluate([{"body": 3}])


def test_r4_bodies_of_a_preset_differ_and_are_checked():
    problem = Problem("bodies", settings=SHORT)
    genomes = problem.random(20)
    assert len({len(genome["body"]["segments"]) for genome in genomes}) > 3
    genomes[1]["body"]["segments"][0]["length_m"] = 99.0
    with pytest.raises(ValueError, match=r"genomes\[1\]\.segments is .*; allowed: 2 to 12 blocks"):
        problem.evaluate(genomes)


def test_dictionaries_of_an_array_are_the_same_snakes():
    problem = Problem("climb", settings=SHORT)
    genomes = problem.random(3)
    same = problem.evaluate(problem.decode(genomes))
    assert np.array_equal(problem.evaluate(genomes).trace_hash, same.trace_hash)


@pytest.mark.parametrize(
    "genomes, message",
    [
        (np.zeros((2, 3)), r"genomes is of shape \(2, 3\); allowed: shape \(n, 23\)"),
        (np.zeros((2, 3, 4)), "genomes is of shape"),
        (np.full((1, 23), np.nan), r"genomes\[0, 0\] is NaN; allowed: finite numbers"),
        (np.full((1, 23), -np.inf), r"genomes\[0, 0\] is -inf; allowed: finite numbers"),
    ],
)
def test_arrays_that_are_no_genomes_are_refused(genomes, message):
    problem = Problem("climb", settings=SHORT)
    with pytest.raises(ValueError, match=message):
        problem.evaluate(genomes)


def test_settings_without_effect_are_refused():
    for settings, allowed in [
        ({"evolution.population": 7}, "an evaluation has no search"),
        ({"evolution.strategy": "ga"}, "an evaluation has no search"),
        ({"repeats.champion_trials": 7}, "an evaluation has no search"),
    ]:
        with pytest.raises(ValueError, match=allowed):
            Problem("climb", settings=settings)
    with pytest.raises(ValueError, match="(?s)set is .*an unknown setting.*trial.surface.friction"):
        Problem("climb", settings={"surface.fricton": 1})
    with pytest.raises(ValueError, match="threads is 0; allowed"):
        problem = Problem("climb", settings=SHORT)
        problem.evaluate(problem.random(1), threads=0)


def test_an_own_ground_can_be_set():
    problem = Problem("climb", settings={"ground.friction": 0.3})
    assert problem.settings["trial.ground.friction"] == "0.3"


def test_a_problem_travels_to_other_processes():
    problem = Problem("climb", stairs={"steps": 3}, settings=SHORT)
    copy = pickle.loads(pickle.dumps(problem))
    assert copy.settings == problem.settings
    genome = problem.random(1)
    assert copy.evaluate(genome).trace_hash[0] == problem.evaluate(genome).trace_hash[0]


@pytest.mark.parametrize("preset", ["climb", "waves-by-rules", "q-learning", "xcs", "zcs"])
def test_results_travel_to_other_processes(preset):
    search = sns.Search(preset, settings={**SHORT, "population": 6, "trial.health.speed_m_s": 3.0})
    results = search.evaluate()
    copy = pickle.loads(pickle.dumps(results))
    for name in (*sns.frames.EVALUATION_COLUMNS, "ranking"):
        assert getattr(copy, name).tobytes() == getattr(results, name).tobytes(), name
    assert copy.reasons == results.reasons
    # What a learner learns from and the hashes of the genomes are there, too.
    search.tell(copy)


def test_a_pool_of_processes_evaluates():
    problem = Problem("climb", settings=SHORT)
    genomes = problem.random(8)
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        parts = pool.map(problem.evaluate, np.array_split(genomes, 2))
    hashes = np.concatenate([part.trace_hash for part in parts])
    assert np.array_equal(hashes, problem.evaluate(genomes).trace_hash)


def test_numbers_that_do_not_fit_are_refused_with_name_and_range(tmp_path):
    problem = Problem("climb", settings=SHORT)
    genome, path = problem.random(1), tmp_path / "none.ron"
    seeds, u32 = "0 to 18446744073709551615", "0 to 4294967295"
    for refused, message in [
        (lambda: problem.random(-1), "count is -1; allowed: 0 to "),
        (lambda: problem.random(10**9), "count is 1000000000; allowed: 0 to "),
        (lambda: problem.random(2, seed=-1), f"seed is -1; allowed: {seeds}"),
        (lambda: problem.evaluate(genome, threads=-1), r"threads is -1; allowed: None \(all cores\), or 1 to 1024"),
        (lambda: problem.evaluate(genome, threads=2**70), "threads is 1180591620717411303424; allowed"),
        (lambda: problem.save_champion(path, genome, seed=-1), f"seed is -1; allowed: {seeds}"),
        (lambda: problem.save_champion(path, genome, generation=-1), f"generation is -1; allowed: {u32}"),
        (lambda: problem.save_champion(path, genome, individual=2**32), f"individual is 4294967296; allowed: {u32}"),
    ]:
        with pytest.raises(ValueError, match=message):
            refused()
    with pytest.raises(TypeError, match="count is a float; allowed: a whole number, 0 to"):
        problem.random(2.0)
    assert not path.exists()
    assert len(problem.random(np.int64(2), seed=np.uint64(2**64 - 1))) == 2


def test_no_genomes_have_no_results():
    problem = Problem("climb", settings=SHORT)
    results = problem.evaluate(np.zeros((0, problem.dimension)))
    assert len(results) == 0 and results.fitness.shape == (0,)


def test_an_interrupt_ends_a_long_evaluation():
    # A process in the background of a shell ignores the interrupt key until it asks for it.
    earlier = signal.signal(signal.SIGINT, signal.default_int_handler)
    problem = Problem("climb", settings={"trial.duration_s": 60})
    genomes = problem.random(20_000)
    # On a machine of any size this takes longer than the test may.
    started = time.perf_counter()
    threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    try:
        with pytest.raises(KeyboardInterrupt):
            problem.evaluate(genomes)
    finally:
        signal.signal(signal.SIGINT, earlier)
    assert time.perf_counter() - started < 20


def test_an_interrupt_leaves_no_file(tmp_path):
    earlier = signal.signal(signal.SIGINT, signal.default_int_handler)
    settings = {"trial.duration_s": 600, "trial.repeats.trials": 10}
    problem = Problem("climb", settings=settings)
    path = tmp_path / "champion.ron"
    threading.Timer(0.1, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    try:
        with pytest.raises(KeyboardInterrupt):
            problem.save_champion(path, np.full(problem.dimension, 0.5))
    finally:
        signal.signal(signal.SIGINT, earlier)
    assert list(tmp_path.iterdir()) == []


def test_other_threads_of_python_go_on_during_an_evaluation():
    problem = Problem("climb", settings={"trial.duration_s": 20})
    genomes = problem.random(60)
    ticks, done = [], threading.Event()

    def tick():
        while not done.wait(0.001):
            ticks.append(time.perf_counter())

    ticker = threading.Thread(target=tick)
    ticker.start()
    started = time.perf_counter()
    problem.evaluate(genomes)
    ended = time.perf_counter()
    done.set()
    ticker.join()
    during = [at for at in ticks if started < at < ended]
    assert len(during) > 5
