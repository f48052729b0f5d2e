"""Random genomes evaluated in several processes by Dask: the same bits as in one.

    python examples/dask_processes.py --processes 4 --genomes 2000
"""

import argparse

import numpy as np
from dask.distributed import Client, LocalCluster

from snakes_and_stairs import Problem


def evaluated(problem: Problem, genomes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Fitness and trace hash of some genomes; runs in a worker process, on one thread."""
    results = problem.evaluate(genomes, threads=1)
    return results.fitness, results.trace_hash


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--genomes", type=int, default=200)
    parser.add_argument("--duration", type=float, default=20.0, help="seconds of a trial")
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()

    problem = Problem("climb", settings={"trial.duration_s": args.duration})
    genomes = problem.random(args.genomes, args.seed)
    portions = np.array_split(genomes, 4 * args.processes)
    cluster = LocalCluster(
        n_workers=args.processes, threads_per_worker=1, processes=True, dashboard_address=None
    )
    with cluster, Client(cluster) as client:
        results = client.gather([client.submit(evaluated, problem, part) for part in portions])
    fitness = np.concatenate([part for part, _ in results])
    hashes = np.concatenate([part for _, part in results])
    here = problem.evaluate(genomes[:10])
    assert np.array_equal(hashes[:10], here.trace_hash), "another process computes other bits"
    print(
        f"{len(fitness)} genomes in {args.processes} processes: best fitness {fitness.max():.2f} m,"
        " the same bits as here"
    )


if __name__ == "__main__":
    main()
