"""The project's own strategies, driven from Python."""

import copy
import pickle
import warnings

import numpy as np
import pytest
from conftest import PYTHON, SAVES, SHORT

import snakes_and_stairs as sns
from snakes_and_stairs import Problem, Search

SMALL = {**SHORT, "evolution.population": 8, "evolution.generations": 3}
#: Presets whose genomes are more than numbers.
MORE_THAN_NUMBERS = ["bodies", "creatures", "neat", "q-learning", "xcs", "zcs"]
#: A preset whose stairs evolve, too.
STAIRS = "poet"
ARRAYS = [name for name in sns.presets() if name not in [*MORE_THAN_NUMBERS, STAIRS]]
#: Strategies whose genomes are arrays in the space of the preset climb.
STRATEGIES = ["halving", "ga", "cma_es", "map_elites", "novelty", "random"]


@pytest.mark.parametrize("strategy", STRATEGIES)
def test_a_search_asks_and_learns_the_same_each_time(strategy):
    def generations():
        search = Search("climb", strategy=strategy, seed=4, settings=SMALL)
        asked = []
        while not search.is_over and len(asked) < 3:
            genomes = search.ask()
            assert genomes.shape == (search.population, search.dimension)
            assert np.array_equal(genomes, search.ask()), "asking twice gives the same"
            asked.append(genomes.tobytes())
            search.tell(search.evaluate())
        assert search.generation == len(asked) > 0
        return asked

    first = generations()
    assert first == generations()
    assert len(set(first)) == len(first), "every generation differs"


def test_an_array_that_was_asked_for_has_the_results_of_the_search_itself():
    search = Search("climb", strategy="ga", seed=4, settings=SMALL)
    problem = Problem("climb", settings=SHORT)
    for _ in range(2):
        own = search.evaluate()
        from_array = problem.evaluate(search.ask())
        assert np.array_equal(own.trace_hash, from_array.trace_hash)
        search.tell(from_array)


@pytest.mark.parametrize(
    "preset, settings",
    [
        ("climb", {"evolution.cma_es.newborns": 6, "repeats.champion_trials": 0}),
        ("mixed-stairs", {}),
        ("neat", {}),
        ("q-learning", {}),
        ("xcs", {}),
    ],
)
def test_a_search_makes_the_generations_of_the_command_line(preset, settings, snakes, tmp_path):
    settings = {**SMALL, **settings}
    flags = [flag for name, value in settings.items() for flag in ("--set", f"{name}={value}")]
    snakes("--no-render", "--preset", preset, "--seed", 9, "--out", tmp_path, *flags)
    [folder] = tmp_path.iterdir()
    run = sns.load_run(str(folder))
    assert run["preset"] == preset and run["seed"] == 9
    search = Search(preset, seed=9, settings=settings)
    for record in run["generations"]:
        assert not search.is_over
        results = search.evaluate()
        assert len(results) == record["evaluations"]
        healthy = results.fitness[~results.disqualified]
        assert int(results.disqualified.sum()) == record["disqualified"]
        assert healthy.max() == pytest.approx(record["best"], rel=1e-6)
        assert healthy.mean() == pytest.approx(record["mean"], rel=1e-6)
        search.tell(results)
    assert search.is_over


def small(preset):
    """Settings of a small search. One generation of islands, those of "bodies", is larger than three of the other strategies."""
    return {**SMALL, "evolution.generations": 20} if preset == "bodies" else SMALL


def test_r4_a_ladder_is_refused_rather_than_ignored():
    with pytest.raises(ValueError, match="evolution.ladder.first_rise_m is .*; allowed: 0: a search has no ladder"):
        Search("ladder")


@pytest.mark.parametrize("preset", MORE_THAN_NUMBERS)
def test_r4_dictionaries_that_were_asked_for_are_those_snakes_to_the_last_bit(preset):
    search = Search(preset, seed=3, settings=small(preset))
    problem = Problem(preset, settings=SHORT)
    for _ in range(2):
        genomes, own = search.ask(), search.evaluate()
        assert len(genomes) == search.population and all(isinstance(one, dict) for one in genomes)
        from_genomes = problem.evaluate(genomes)
        assert np.array_equal(own.trace_hash, from_genomes.trace_hash)
        search.tell(from_genomes)
    with pytest.raises(ValueError, match="dimension is asked for; allowed: a problem whose genomes are arrays"):
        search.dimension


@pytest.mark.parametrize("preset", ["climb", "report", *MORE_THAN_NUMBERS])
@pytest.mark.parametrize("copied", [copy.deepcopy, lambda search: pickle.loads(pickle.dumps(search))])
def test_r10_a_search_that_was_pickled_or_copied_goes_on_with_the_same_bits(preset, copied):
    search = Search(preset, seed=5, settings=small(preset))
    search.tell(search.evaluate())
    for is_asked in (False, True):
        if is_asked:
            search.ask()
        other = copied(search)
        assert (other.generation, other.evaluations) == (search.generation, search.evaluations)
        for _ in range(2):
            results = [one.evaluate() for one in (search, other)]
            assert np.array_equal(results[0].trace_hash, results[1].trace_hash)
            for one, its in zip((search, other), results):
                one.tell(its)


def test_r10_a_search_from_a_founder_travels_with_it():
    settings = {**SMALL, "trial.duration_s": 20}
    search = Search("climb", strategy="ga", settings=settings, founder=str(SAVES / "climber.ron"))
    other = pickle.loads(pickle.dumps(search))
    assert np.array_equal(search.ask(), other.ask())


@pytest.mark.parametrize("preset", ARRAYS)
def test_a_row_that_was_asked_for_is_that_snake_to_the_last_bit(preset):
    # A search has no ladder.
    settings = {**SMALL, "ladder.first_rise_m": 0} if preset == "ladder" else SMALL
    search = Search(preset, seed=3, settings=settings)
    problem = Problem(preset, settings=SHORT)
    with warnings.catch_warnings():
        # A row that stands for another snake would be warned of.
        warnings.simplefilter("error")
        for _ in range(3):
            rows, own = search.ask(), search.evaluate()
            from_rows = problem.evaluate(rows)
            assert np.array_equal(own.trace_hash, from_rows.trace_hash)
            # It takes only results of the very genomes that it asked for.
            search.tell(from_rows)


@pytest.mark.parametrize("preset", ["report", "climb", *MORE_THAN_NUMBERS])
def test_a_search_saves_the_snakes_that_it_found(preset, snakes, tmp_path):
    search = Search(preset, seed=3, settings=small(preset))
    search.tell(search.evaluate())
    results = search.evaluate()
    best = results.ranking.argmax()
    path = tmp_path / "found.ron"
    search.save_champion(path, best)
    champion = search.champion(best)
    assert champion.trace_hash == results.trace_hash[best]
    assert champion.evaluate().trace_hash[0] == champion.trace_hash
    loaded = sns.load_champion(path)
    assert loaded.to_dict() == champion.to_dict()
    origin = {"preset": preset, "seed": 3, "generation": 2, "individual": best}
    assert loaded.to_dict()["origin"] == origin
    assert "equal to the record, bit for bit" in snakes("replay", path, "--no-render")
    if preset not in MORE_THAN_NUMBERS:
        problem = Problem(preset, settings=SHORT)
        again = problem.evaluate(problem.genome_of(path))
        assert again.trace_hash[0] == champion.trace_hash


def test_a_strategy_whose_stairs_evolve_is_refused():
    with pytest.raises(ValueError, match="evolution.strategy is poet; allowed: a strategy whose"):
        Search(STAIRS)


def test_a_snake_that_was_not_asked_for_is_not_saved(tmp_path):
    search = Search("climb", strategy="ga", settings=SMALL)
    path = tmp_path / "none.ron"
    with pytest.raises(RuntimeError, match="champion without ask"):
        search.save_champion(path, 0)
    search.ask()
    for index in (-1, 8):
        with pytest.raises(ValueError, match=f"index is {index}; allowed: 0 to 7"):
            search.save_champion(path, index)
    assert not path.exists()


def test_results_of_other_genomes_are_refused():
    search = Search("climb", strategy="ga", seed=4, settings=SMALL)
    problem = Problem("climb", settings=SHORT)
    genomes = search.ask()
    for others, index in [(problem.random(8, seed=99), 0), (genomes[[0, 2, 1, *range(3, 8)]], 1)]:
        message = rf"results\[{index}\] is of another genome; allowed: results of the genomes that were asked"
        with pytest.raises(ValueError, match=message):
            search.tell(problem.evaluate(others))
    assert search.generation == 0
    search.tell(problem.evaluate(genomes))
    assert search.generation == 1


def test_a_preset_may_be_a_path():
    path = PYTHON.parent / "assets" / "presets" / "climb.ron"
    seen = [Search(preset, seed=2, settings=SMALL).ask() for preset in (path, str(path))]
    assert np.array_equal(*seen)
    assert sns.evaluate(seen[0], path, settings=SHORT).fitness.shape == (len(seen[0]),)
    env = sns.SnakesAndStairsEnv(path, settings=SHORT)
    envs = sns.SnakesAndStairsVectorEnv(2, path, settings=SHORT)
    assert np.array_equal(envs.reset(seed=1)[0][0], env.reset(seed=1)[0])


@pytest.mark.parametrize("seed", [-1, 2**64, 10**5000], ids=["negative", "65 bits", "thousands of digits"])
def test_seeds_beyond_64_bits_are_refused_with_their_range(seed):
    with pytest.raises(ValueError, match="seed is .*; allowed: 0 to 18446744073709551615"):
        Search("climb", seed=seed)
    with pytest.raises(TypeError, match="seed is a float; allowed: a whole number"):
        Search("climb", seed=1.5)


def test_cma_es_finds_the_optimum_of_a_function_of_ones_own():
    search = Search(
        "climb",
        strategy="cma_es",
        seed=2,
        settings={"evolution.cma_es.newborns": 0, "evolution.generations": 10_000},
    )
    best = -np.inf
    for _ in range(150):
        fitness = -((search.ask() - 0.3) ** 2).sum(axis=1)
        best = max(best, fitness.max())
        search.tell(fitness)
    # It starts at 0.5 in every coordinate: 0.04 off in each of them.
    assert best > -1e-3
    assert search.evaluations == 150 * 30


def test_disqualified_individuals_do_not_count():
    settings = {**SMALL, "evolution.cma_es.newborns": 0}
    searches = [Search("climb", strategy="cma_es", seed=2, settings=settings) for _ in range(2)]
    genomes, again = (search.ask() for search in searches)
    assert np.array_equal(genomes, again)
    fitness = genomes[:, 0]
    searches[0].tell(fitness)
    searches[1].tell(fitness, disqualified=fitness > np.median(fitness))
    assert not np.array_equal(searches[0].ask(), searches[1].ask())


def test_map_elites_keeps_an_archive():
    search = Search("climb", strategy="map_elites", seed=1, settings={**SMALL, "population": 20})
    search.tell(search.evaluate())
    archive = search.archive()
    cells = archive["columns"] * archive["rows"]
    assert 0 < len(archive["elites"]) <= cells
    assert archive["coverage"] == pytest.approx(len(archive["elites"]) / cells)
    elite = archive["elites"][0]
    again = Problem("climb", settings=SHORT).evaluate(elite["genome"])
    assert again.fitness[0] == elite["fitness"]
    assert Search("climb", strategy="ga", settings=SMALL).archive() is None


def test_map_elites_of_bodies_keeps_the_blocks_of_each_elite():
    search = Search("bodies", strategy="body_map_elites", seed=2, settings=SMALL)
    for _ in range(2):
        search.tell(search.evaluate())
    archive = search.archive()
    assert (archive["x"], archive["columns"], archive["rows"]) == ("Blocks", 11, 16)
    for elite in archive["elites"]:
        blocks = np.array(elite["blocks"])
        assert blocks.shape == (elite["column"] + 2, 3)
        assert blocks.prod(axis=1).sum() == pytest.approx(10.0, rel=1e-3)
        assert "genome" not in elite


def test_a_founder_is_in_the_first_generation():
    founder = str(SAVES / "climber.ron")
    search = Search("climb", strategy="ga", settings={**SMALL, "trial.duration_s": 20}, founder=founder)
    results = search.evaluate()
    # The trial may differ from the founder's own, but it still climbs.
    assert results.steps_climbed[0] == 10
    with pytest.raises(ValueError, match="founder.controller is gait; allowed: signal"):
        Search("report", founder=founder)


def test_what_is_not_allowed_is_refused():
    with pytest.raises(ValueError, match="strategy is .*; allowed: halving, "):
        Search("climb", strategy="annealing")
    with pytest.raises(ValueError, match="settings is .*strategy=... chooses it"):
        Search("climb", settings={"evolution.strategy": "ga"})
    search = Search("climb", strategy="ga", settings=SMALL)
    with pytest.raises(RuntimeError, match="tell without ask"):
        search.tell(np.zeros(8))
    search.ask()
    for fitness, message in [
        (np.zeros(7), "number of results is 7; allowed: 8"),
        (np.full(8, np.nan), r"fitness\[0\] is NaN; allowed"),
        (np.zeros((8, 1)), r"fitness is of shape \(8, 1\)"),
    ]:
        with pytest.raises(ValueError, match=message):
            search.tell(fitness)
    with pytest.raises(ValueError, match="number of flags in disqualified is 2; allowed: 8"):
        search.tell(np.zeros(8), disqualified=[True, False])
    results = search.evaluate()
    with pytest.raises(ValueError, match="disqualified is given"):
        search.tell(results, disqualified=np.zeros(8, dtype=bool))
    assert search.generation == 0
    search.tell(results)
    for strategy in ("map_elites", "novelty"):
        search = Search("climb", strategy=strategy, settings=SMALL)
        search.ask()
        with pytest.raises(ValueError, match="fitness alone; allowed: the result of evaluate"):
            search.tell(np.zeros(8))
    learner = Search("q-learning", settings=SMALL)
    count = len(learner.evaluate())
    with pytest.raises(ValueError, match="fitness alone"):
        learner.tell(np.zeros(count))
