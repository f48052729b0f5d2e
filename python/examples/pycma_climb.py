"""pycma's CMA-ES on the climb: the first snake on the landing, saved so that `snakes replay FILE` plays it.

    python examples/pycma_climb.py --evaluations 2000 --out found.ron
"""

import argparse

import cma
import numpy as np

from snakes_and_stairs import Problem


def losses(results) -> np.ndarray:
    """What pycma minimises. A disqualified snake has no fitness: it gets the worst of its generation."""
    fitness = results.fitness.copy()
    healthy = ~results.disqualified
    fitness[~healthy] = fitness[healthy].min() if healthy.any() else 0.0
    return -fitness


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--evaluations", type=int, default=2000)
    parser.add_argument("--steps", type=int, default=10, help="steps of the stairs")
    parser.add_argument("--duration", type=float, default=20.0, help="seconds of a trial")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", help="file of the best snake")
    args = parser.parse_args()

    problem = Problem(
        "climb", stairs={"steps": args.steps}, settings={"trial.duration_s": args.duration}
    )
    random = problem.random(min(100, args.evaluations // 2), args.seed)
    evaluated = len(random)
    start = random[np.argmin(losses(problem.evaluate(random)))]
    options = {"popsize": 30, "seed": args.seed, "verbose": -9}
    search = cma.CMAEvolutionStrategy(start, 0.15, options)
    best, best_fitness, landed = start, -np.inf, None
    while evaluated < args.evaluations and not search.stop():
        genomes = np.array(search.ask())
        results = problem.evaluate(genomes)
        search.tell(list(genomes), losses(results))
        if landed is None and results.on_landing.any():
            landed = evaluated + int(np.argmax(results.on_landing)) + 1
        evaluated += len(genomes)
        leader = int(np.argmin(losses(results)))
        if not results.disqualified[leader] and results.fitness[leader] > best_fitness:
            best, best_fitness = genomes[leader], results.fitness[leader]
    where = "not reached" if landed is None else f"reached by evaluation {landed}"
    print(f"{evaluated} evaluations, best fitness {best_fitness:.2f} m, landing {where}")
    if args.out:
        problem.save_champion(args.out, best, seed=args.seed)
        print(f"saved to {args.out}")


if __name__ == "__main__":
    main()
