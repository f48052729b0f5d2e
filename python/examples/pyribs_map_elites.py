"""MAP-Elites by pyribs: the best snake for each height of the body and share of blocks on the ground.

    python examples/pyribs_map_elites.py --iterations 50
"""

import argparse

import numpy as np
from ribs.archives import GridArchive
from ribs.emitters import GaussianEmitter

from snakes_and_stairs import Problem


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--iterations", type=int, default=50)
    parser.add_argument("--batch", type=int, default=40)
    parser.add_argument("--duration", type=float, default=20.0, help="seconds of a trial")
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()

    problem = Problem("climb", settings={"trial.duration_s": args.duration})
    # No healthy snake is further back than the arena reaches, so each counts for the QD score.
    worst_m = -float(problem.settings["trial.health.arena_back_m"])
    archive = GridArchive(
        solution_dim=problem.dimension,
        dims=[16, 16],
        ranges=[(0.3, 2.3), (0.0, 1.0)],
        qd_score_offset=worst_m,
        seed=args.seed,
    )
    emitter = GaussianEmitter(
        archive,
        sigma=0.05,
        initial_solutions=problem.random(args.batch, args.seed),
        batch_size=args.batch,
        seed=args.seed,
    )
    for _ in range(args.iterations):
        genomes = emitter.ask()
        results = problem.evaluate(genomes)
        # A disqualified snake has no place in the archive.
        healthy = ~results.disqualified
        measures = np.stack([results.mean_height_m, results.contact_duty], axis=1)
        if healthy.any():
            archive.add(genomes[healthy], results.fitness[healthy], measures[healthy])
    stats = archive.stats
    print(
        f"{stats.num_elites} elites in {archive.cells} cells, best fitness {stats.obj_max:.2f} m,"
        f" QD score {stats.qd_score:.1f}"
    )


if __name__ == "__main__":
    main()
