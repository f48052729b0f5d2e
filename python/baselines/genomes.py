"""Methods that search genomes of a preset: random, pycma, pyribs and the program's own CMA-ES."""

from __future__ import annotations

import json
import subprocess
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import cma
import numpy as np
from ribs.archives import GridArchive
from ribs.emitters import EvolutionStrategyEmitter, GaussianEmitter
from worlds import CLASSES, DURATION_S, STEPS_PER_S, Played

from snakes_and_stairs import Evaluations, Problem, Search

#: Random genomes with which CMA-ES begins, as in the presets.
NEWBORNS = 100
POPULATION = 30
#: Initial step, as a share of each range.
STEP = 0.15
#: Spread of Gaussian mutation in MAP-Elites, as a share of each range.
SPREAD = 0.05


@dataclass
class Ledger:
    """Simulated seconds of a search, and the best genome that it has met."""

    problem: Problem
    budget_s: float
    simulated_s: float = 0.0
    evaluations: int = 0
    best: np.ndarray | None = None
    best_ranking: float = -np.inf
    first_landing_s: float | None = None
    #: Pairs of simulated seconds and best fitness, one at each improvement.
    progress: list[tuple[float, float]] = field(default_factory=list)

    def fits(self, trials: int) -> bool:
        """Whether as many trials of full length fit into the rest of the budget."""
        return self.simulated_s + trials * DURATION_S <= self.budget_s

    def evaluate(self, genomes: np.ndarray) -> Evaluations:
        """Evaluates genomes, and counts them."""
        results = self.problem.evaluate(genomes, threads=1)
        self.count(genomes, results)
        return results

    def count(self, genomes: np.ndarray, results: Evaluations) -> None:
        """Counts genomes that have been evaluated."""
        ends_s = self.simulated_s + np.cumsum(results.physics_steps) / STEPS_PER_S
        self.simulated_s = float(ends_s[-1])
        self.evaluations += len(genomes)
        landed = np.flatnonzero(results.on_landing)
        if self.first_landing_s is None and len(landed):
            self.first_landing_s = float(ends_s[landed[0]])
        leader = int(np.argmax(results.ranking))
        if results.ranking[leader] > self.best_ranking:
            self.best, self.best_ranking = genomes[leader].copy(), float(results.ranking[leader])
            self.progress.append((round(self.simulated_s, 1), round(self.best_ranking, 4)))


def losses(results: Evaluations) -> np.ndarray:
    """What pycma minimises. A disqualified snake gets the worst fitness of its generation."""
    fitness, healthy = results.fitness.copy(), ~results.disqualified
    fitness[~healthy] = fitness[healthy].min() if healthy.any() else 0.0
    return -fitness


def random(ledger: Ledger, seed: int) -> None:
    """Independent random genomes."""
    count = int(ledger.budget_s // DURATION_S)
    for portion in np.array_split(ledger.problem.random(count, seed), max(1, count // 100)):
        ledger.evaluate(portion)


def pycma(ledger: Ledger, seed: int) -> None:
    """pycma's CMA-ES from the best of 100 random genomes."""
    newborns = ledger.problem.random(NEWBORNS, seed)
    start = newborns[np.argmin(losses(ledger.evaluate(newborns)))]
    search = cma.CMAEvolutionStrategy(start, STEP, {"popsize": POPULATION, "seed": seed, "verbose": -9})
    while ledger.fits(POPULATION):
        genomes = np.array(search.ask())
        search.tell(list(genomes), losses(ledger.evaluate(genomes)))


def pyribs(ledger: Ledger, seed: int) -> None:
    """MAP-Elites of pyribs over body height and contact, half by Gaussian mutation and half by CMA-ES (CMA-ME)."""
    worst_m = -float(ledger.problem.settings["trial.health.arena_back_m"])
    archive = GridArchive(
        solution_dim=ledger.problem.dimension,
        dims=[16, 16],
        ranges=[(0.3, 2.3), (0.0, 1.0)],
        qd_score_offset=worst_m,
        seed=seed,
    )
    newborns = ledger.problem.random(NEWBORNS, seed)
    results = ledger.evaluate(newborns)
    add_healthy(archive, newborns, results)
    start, half = newborns[np.argmin(losses(results))], POPULATION // 2
    emitters = [
        GaussianEmitter(archive, sigma=SPREAD, x0=start, batch_size=half, seed=seed),
        EvolutionStrategyEmitter(archive, x0=start, sigma0=STEP, batch_size=half, seed=seed),
    ]
    while ledger.fits(POPULATION):
        for emitter in emitters:
            genomes = emitter.ask()
            results = ledger.evaluate(genomes)
            emitter.tell(genomes, -losses(results), *add_healthy(archive, genomes, results))


def add_healthy(archive: GridArchive, genomes: np.ndarray, results: Evaluations) -> tuple[np.ndarray, dict]:
    """Adds all but disqualified snakes to an archive. Returns measures of all, and what the archive made of each."""
    healthy = ~results.disqualified
    measures = np.nan_to_num(np.stack([results.mean_height_m, results.contact_duty], axis=1))
    # Of a disqualified snake: not added, and worse than any other that was not.
    made = {"status": np.zeros(len(genomes), dtype=np.int32), "value": np.full(len(genomes), -1000.0)}
    if healthy.any():
        added = archive.add(genomes[healthy], results.fitness[healthy], measures[healthy])
        for name, values in made.items():
            values[healthy] = added[name]
    return measures, made


def own_cma(ledger: Ledger, seed: int) -> None:
    """The program's own CMA-ES with the settings of the preset; a run of the program makes the same generations."""
    problem = ledger.problem
    settings = {"genome.controller": problem.settings["genome.controller"], "evolution.generations": 1000}
    search = Search(problem.preset, strategy="cma_es", seed=seed, settings=settings)
    while ledger.fits(search.population):
        genomes = search.ask()
        results = search.evaluate(threads=1)
        ledger.count(genomes, results)
        search.tell(results)


#: Each method with the controller of its genomes.
METHODS = {
    "cma-es": (own_cma, "gait"),
    "reflex": (own_cma, "reflex"),
    "pycma": (pycma, "gait"),
    "pyribs": (pyribs, "gait"),
    "random": (random, "gait"),
}


def search(method: str, world: str, seed: int, budget_s: float) -> Ledger:
    """Searches until the budget is spent."""
    run, controller = METHODS[method]
    ledger = Ledger(Problem(world, settings={"genome.controller": controller}), budget_s)
    run(ledger, seed)
    return ledger


def play(problem: Problem, genome: np.ndarray) -> Played:
    """A genome in its own trial."""
    results = problem.evaluate(genome, threads=1)
    return Played(
        fitness_m=float(results.fitness[0]),
        steps=int(results.steps_climbed[0]),
        landed=bool(results.on_landing[0]),
        disqualified=bool(results.disqualified[0]),
        trace_hash=str(results.trace_hash[0]),
    )


def examine(problem: Problem, genome: np.ndarray, snakes: str) -> dict[str, int]:
    """Landings of a genome on the held-out stairs, class by class, by the program's exam."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "champion.ron"
        problem.save_champion(path, genome)
        command = [snakes, "exam", str(path), "--suite", "held-out", "--json", "--threads", "1"]
        printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    lines: list[dict[str, Any]] = [json.loads(line) for line in printed.splitlines()]
    suite = next(line for line in lines if line["type"] == "suite")
    if not suite["matches"]:
        raise RuntimeError(f"{snakes} simulates other bits than the package: both must be of one version")
    landed = {row["class"]: row["landed"] for row in suite["classes"]}
    return {name: landed[name] for name in CLASSES}
