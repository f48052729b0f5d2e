"""CMA-ES by pycma and by this project on the same climb: evaluations until the first snake stands on the landing.

    python examples/compare_cma.py --seeds 10 --evaluations 2000

Both begin at the best of the same 100 random snakes, with the same step size (0.15 of each range) and population (30), without
restarts and without bounds: genes beyond their range are reflected. Both rank a disqualified snake last, the longer it
lasted the better. The random numbers differ, so a single seed says little.
"""

import argparse
import math
import statistics
import time

import cma
import numpy as np

from snakes_and_stairs import Problem, Search

NEWBORNS = 100
STEP = 0.15
POPULATION = 30


def first_landing(results) -> float:
    """The number of the first evaluation that ended on the landing; infinite if none did."""
    landed = np.flatnonzero(results.on_landing)
    return float(landed[0] + 1) if len(landed) else math.inf


def ours(settings: dict, seed: int, budget: int) -> tuple[float, float]:
    """Evaluations until the landing, and the best fitness within the budget."""
    search = Search(
        "climb",
        strategy="cma_es",
        seed=seed,
        settings={
            **settings,
            "evolution.population": POPULATION,
            "evolution.generations": math.ceil(budget / POPULATION) + 1,
            "evolution.cma_es.step": STEP,
            "evolution.cma_es.newborns": NEWBORNS,
            "evolution.cma_es.restarts": "none",
        },
    )
    landing, best = math.inf, -math.inf
    while search.evaluations + search.population <= budget:
        before = search.evaluations
        results = search.evaluate()
        landing = min(landing, before + first_landing(results))
        best = max([best, *results.fitness[~results.disqualified]])
        search.tell(results)
    return landing, best


def losses(results) -> np.ndarray:
    """What pycma minimises: ranks as this project's CMA-ES ranks them."""
    fitness, out = results.fitness.copy(), results.disqualified
    least = fitness[~out].min() if (~out).any() else 0.0
    lasted = results.physics_steps / (1 + results.physics_steps.max())
    fitness[out] = least - 1e-3 * (2.0 - lasted[out])
    return -fitness


def pycmas(problem: Problem, seed: int, budget: int) -> tuple[float, float]:
    """The same by pycma."""
    newborns = problem.random(NEWBORNS, seed)
    results = problem.evaluate(newborns)
    landing, evaluated = first_landing(results), NEWBORNS
    best = results.fitness[~results.disqualified].max()
    start = newborns[np.argmin(losses(results))]
    options = {"popsize": POPULATION, "seed": seed, "verbose": -9}
    search = cma.CMAEvolutionStrategy(start, STEP, options)
    while evaluated + POPULATION <= budget:
        genomes = search.ask()
        results = problem.evaluate(np.array(genomes))
        landing = min(landing, evaluated + first_landing(results))
        evaluated += POPULATION
        best = max([best, *results.fitness[~results.disqualified]])
        search.tell(genomes, losses(results))
    return landing, float(best)


def shown(landing: float) -> str:
    return "-" if math.isinf(landing) else f"{landing:.0f}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--evaluations", type=int, default=2000, help="budget of each run")
    parser.add_argument("--duration", type=float, default=20.0, help="seconds of a trial")
    args = parser.parse_args()

    settings = {"trial.duration_s": args.duration}
    problem = Problem("climb", settings=settings)
    print(f"climb, {problem.dimension} genes, budget {args.evaluations} evaluations; - is not within the budget")
    print("seed | landing: ours, pycma | best fitness in m: ours, pycma | s", flush=True)
    rows = []
    for seed in range(args.first_seed, args.first_seed + args.seeds):
        started = time.perf_counter()
        (our_landing, our_best), (its_landing, its_best) = (
            ours(settings, seed, args.evaluations),
            pycmas(problem, seed, args.evaluations),
        )
        rows.append((our_landing, its_landing, our_best, its_best))
        print(
            f"{seed:4} | {shown(our_landing):>5} {shown(its_landing):>5} | {our_best:6.2f} {its_best:6.2f}"
            f" | {time.perf_counter() - started:.0f}",
            flush=True,
        )
    our_median, its_median, our_best, its_best = (statistics.median(column) for column in zip(*rows))
    print(f"median | {shown(our_median)} {shown(its_median)} | {our_best:.2f} {its_best:.2f}")
    landed = [sum(math.isfinite(row[index]) for row in rows) for index in (0, 1)]
    print(f"on the landing within the budget: ours {landed[0]}, pycma {landed[1]} of {len(rows)}")


if __name__ == "__main__":
    main()
