"""Baselines beside the program's own methods: each learns in two worlds, over ten seeds, for as many simulated seconds.

    python python/baselines/run.py

Each finished run is appended to `assets/results/baselines.jsonl` at once, and a command that was interrupted continues
there. At the end the tables of `docs/baselines.md` are written from the file, as `page.py` does alone.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import time
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import genomes
import page
from worlds import SEEDS, WORLDS, by_class, combined_hash, stored

from snakes_and_stairs import ENGINE_VERSION

METHODS = (*genomes.METHODS, "ppo", "sac")
#: Seeds of the table. Settings were chosen on others.
FIRST_SEED = 401
#: Simulated seconds that a run may spend.
BUDGET_S = 12_000.0
PACKAGES = ("snakes-and-stairs", "stable-baselines3", "torch", "cma", "ribs", "gymnasium", "numpy")


def version_of(package: str) -> str | None:
    """Version of a package; None if it is not installed, because not every method needs it."""
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def store(path: Path, row: dict[str, Any]) -> None:
    """Appends a run, so that it survives an end of the computer."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a", encoding="utf-8") as file:
        file.write(json.dumps(row) + "\n")
        file.flush()
        os.fsync(file.fileno())


def run(method: str, world: str, seed: int, budget_s: float, snakes: str) -> dict[str, Any]:
    """One method in one world with one seed: what it spent, and what its best snake does."""
    began, began_cpu = time.perf_counter(), time.process_time()
    if method in genomes.METHODS:
        ledger = genomes.search(method, world, seed, budget_s)
        wall_s, cpu_s = time.perf_counter() - began, time.process_time() - began_cpu
        if ledger.best is None:
            raise RuntimeError(f"every snake of {method} in {world} with seed {seed} was disqualified")
        spent, played = ledger, genomes.play(ledger.problem, ledger.best)
        own = {"evaluations": ledger.evaluations, "genome": ledger.best.tolist()}
        exam = genomes.examine(ledger.problem, ledger.best, snakes)
    else:
        # Without policies, no torch is needed.
        import policies

        learned = policies.learn(method, world, seed, budget_s)
        wall_s, cpu_s = time.perf_counter() - began, time.process_time() - began_cpu
        if learned.best is None:
            raise ValueError(f"budget is {budget_s} s; allowed: at least some roll-outs of {method}")
        spent, played = learned, policies.play(learned.best, policies.own_world(world))[0]
        trials = policies.examine(learned.best, world)
        own = {
            "actions": learned.steps,
            "trials_without_chance": learned.episodes,
            "updates": learned.updates,
            "policy_hash": learned.best.hash(),
            "held_out_hash": combined_hash([trial.trace_hash for trial in trials]),
        }
        exam = by_class([trial.landed for trial in trials])
    return {
        "type": "run",
        "method": method,
        "world": world,
        "seed": seed,
        "budget_s": budget_s,
        "simulated_s": round(spent.simulated_s, 3),
        "fitness_m": played.fitness_m,
        "steps_climbed": played.steps,
        "landed": played.landed,
        "disqualified": played.disqualified,
        "first_landing_s": spent.first_landing_s,
        "trace_hash": played.trace_hash,
        "held_out": exam,
        "wall_s": round(wall_s, 1),
        "cpu_s": round(cpu_s, 1),
        "progress": spent.progress,
        **own,
        "engine": ENGINE_VERSION,
        "versions": {"python": platform.python_version(), **{name: version_of(name) for name in PACKAGES}},
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--snakes", default="snakes", help="the program, whose exam has the held-out stairs")
    parser.add_argument("--out", type=Path, default=page.RUNS, help="its tables are written only from the default file")
    parser.add_argument("--methods", nargs="+", choices=METHODS, default=METHODS)
    parser.add_argument("--worlds", nargs="+", choices=WORLDS, default=WORLDS)
    parser.add_argument("--first-seed", type=int, default=FIRST_SEED)
    parser.add_argument("--seeds", type=int, default=SEEDS)
    parser.add_argument("--budget", type=float, default=BUDGET_S, help="simulated seconds of each run")
    args = parser.parse_args()

    rows = stored(args.out)
    other = sorted({row["budget_s"] for row in rows} - {args.budget})
    if other:
        parser.error(f"{args.out} has runs of {other} s; allowed: --budget {other[0]:g}, or another --out")
    done = {(row["method"], row["world"], row["seed"]) for row in rows}
    # Seed by seed, so that an interrupted command has compared all methods on the first seeds.
    for seed in range(args.first_seed, args.first_seed + args.seeds):
        for world in args.worlds:
            for method in args.methods:
                if (method, world, seed) in done:
                    continue
                row = run(method, world, seed, args.budget, args.snakes)
                store(args.out, row)
                print(
                    f"{seed} {world} {method}: {row['fitness_m']:.2f} m, {row['steps_climbed']} steps,"
                    f" held-out {sum(row['held_out'].values())} of 60, {row['cpu_s']:.0f} s",
                    flush=True,
                )
    if args.out == page.RUNS:
        page.PAGE.write_text(page.with_tables(page.PAGE.read_text(encoding="utf-8"), stored(page.RUNS)), encoding="utf-8")


if __name__ == "__main__":
    main()
