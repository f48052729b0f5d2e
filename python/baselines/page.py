"""Writes the tables of `docs/baselines.md` from the finished runs.

python python/baselines/page.py
"""

from __future__ import annotations

import argparse
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import binomtest, bootstrap, mannwhitneyu
from worlds import CLASSES, ROOT, SEEDS, WORLDS, stored

Row = dict[str, Any]

RUNS, PAGE = ROOT / "assets/results/baselines.jsonl", ROOT / "docs/baselines.md"
BEGIN, END = "<!-- begin: page.py -->", "<!-- end: page.py -->"
NAMES = {
    "cma-es": "CMA-ES, gait (ours)",
    "reflex": "CMA-ES, reflex gait (ours)",
    "pycma": "pycma, gait",
    "pyribs": "pyribs, gait",
    "random": "random, gait",
    "ppo": "PPO",
    "sac": "SAC",
}
METHODS = tuple(NAMES)
OURS = "cma-es"
#: Probability, corrected by Holm's method, below which a difference counts.
ALPHA = 0.05


def held_out(row: Row) -> int:
    """Landings of a run's best snake on the 60 held-out stairs."""
    return sum(row["held_out"].values())


def quartiles(values: list[float], digits: int) -> str:
    """Median [quartiles]."""
    low, middle, high = np.percentile(values, [25, 50, 75])
    return f"{middle:.{digits}f} [{low:.{digits}f} {high:.{digits}f}]"


def share(count: int, of: int) -> str:
    """A count with the 95 % interval of its share (Wilson's)."""
    interval = binomtest(count, of).proportion_ci(method="wilson")
    return f"{count} of {of} ({interval.low:.2f}–{interval.high:.2f})"


def mean(values: list[float]) -> str:
    """Mean with its 95 % interval over the seeds (bootstrap)."""
    if len(set(values)) == 1:
        return f"{values[0]:.1f}"
    interval = bootstrap((values,), np.mean, rng=np.random.default_rng(1), method="percentile").confidence_interval
    return f"{np.mean(values):.1f} ({interval.low:.1f}–{interval.high:.1f})"


def superiority(values: list[float], others: list[float]) -> float:
    """Probability that one of `values` exceeds one of `others`, a tie counting half (Vargha and Delaney's A)."""
    first, second = np.array(values)[:, None], np.array(others)[None]
    return float(np.mean((first > second) + 0.5 * (first == second)))


def superiority_cell(values: list[float], others: list[float]) -> str:
    """The same with its 95 % interval (bootstrap)."""
    random = np.random.default_rng(1)
    drawn = [superiority(random.choice(values, len(values)), random.choice(others, len(others))) for _ in range(2000)]
    low, high = np.percentile(drawn, [2.5, 97.5])
    return f"{superiority(values, others):.2f} ({low:.2f}–{high:.2f})"


def holm(probabilities: list[float]) -> list[float]:
    """Probabilities corrected for their number by Holm's method."""
    order = np.argsort(probabilities)
    corrected, greatest = np.empty(len(probabilities)), 0.0
    for place, index in enumerate(order):
        greatest = max(greatest, min(1.0, (len(order) - place) * probabilities[index]))
        corrected[index] = greatest
    return corrected.tolist()


def table(head: list[str], rows: list[list[str]]) -> str:
    """A Markdown table."""
    lines = [head, [":--"] + ["--:"] * (len(head) - 1), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def results(world: str, runs: dict[str, list[Row]]) -> str:
    """What the best snake of each run does in its own world and on the held-out stairs."""
    head = ["method", "runs", "fitness in m", "steps climbed", "land", "held-out stairs of 60"]
    head += [*CLASSES, "CPU s of a run", "wall s"]
    lines = []
    for method in METHODS:
        of = runs[method]
        if not of:
            continue
        classes = [sum(row["held_out"][name] for row in of) for name in CLASSES]
        lines.append(
            [
                NAMES[method],
                str(len(of)),
                quartiles([row["fitness_m"] for row in of], 2),
                quartiles([row["steps_climbed"] for row in of], 1),
                share(sum(row["landed"] for row in of), len(of)),
                mean([float(held_out(row)) for row in of]),
                *(f"{count / len(of):.1f}" for count in classes),
                quartiles([row["cpu_s"] for row in of], 0),
                quartiles([row["wall_s"] for row in of], 0),
            ]
        )
    return f"### Learned in `{world}`\n\n{table(head, lines)}"


MEASURES: dict[str, Callable[[Row], float]] = {
    "fitness": lambda row: row["fitness_m"],
    "held-out stairs": lambda row: float(held_out(row)),
}


def comparisons(runs: dict[tuple[str, str], list[Row]]) -> tuple[str, list[str]]:
    """Each method against our CMA-ES, and a sentence for each difference that counts."""
    cases = []
    for world in WORLDS:
        ours = runs[world, OURS]
        for measure, value in MEASURES.items():
            for method in METHODS:
                theirs = runs[world, method]
                if method != OURS and len(theirs) > 1 and len(ours) > 1:
                    values, others = [value(row) for row in theirs], [value(row) for row in ours]
                    probability = float(mannwhitneyu(values, others).pvalue)
                    cases.append((world, measure, method, values, others, probability))
    corrected = holm([case[-1] for case in cases])
    lines, sentences = [], []
    for (world, measure, method, values, others, probability), holms in zip(cases, corrected):
        counts = holms < ALPHA
        better = superiority(values, others) > 0.5
        verdict = ("better" if better else "worse") if counts else "–"
        medians = f"{np.median(values):.1f}, {np.median(others):.1f}"
        cell = superiority_cell(values, others)
        lines.append(
            [NAMES[method], f"`{world}`", measure, medians, cell, f"{probability:.4f}", f"{holms:.4f}", verdict]
        )
        if counts and better:
            sentences.append(f"**{NAMES[method]} beats our CMA-ES in `{world}`, {measure}: medians {medians}.**")
    head = ["method", "world", "measure", "medians: it, ours", "it exceeds ours", "p", "p, Holm", "it is"]
    return table(head, lines), sentences


def greatest(world: str, runs: dict[str, list[Row]]) -> str:
    """A sentence with the methods that lead in a world, whether or not by chance."""
    shown = {method: f"{NAMES[method]} ({len(of)} run{'s' * (len(of) > 1)})" for method, of in runs.items() if of}
    medians = {shown[method]: float(np.median([row["fitness_m"] for row in runs[method]])) for method in shown}
    means = {shown[method]: float(np.mean([held_out(row) for row in runs[method]])) for method in shown}
    far, wide = max(medians, key=medians.__getitem__), max(means, key=means.__getitem__)
    return (
        f"In `{world}`, {far} has the greatest median fitness, {medians[far]:.1f} m, and {wide} climbs most held-out stairs,"
        f" {means[wide]:.1f} of 60 in the mean."
    )


def hashes(runs: dict[tuple[str, str], list[Row]]) -> str:
    """The trace hash of the best snake of each run."""
    seeds = sorted({row["seed"] for rows in runs.values() for row in rows})
    lines = []
    for (world, method), rows in runs.items():
        if not rows:
            continue
        of_seed = {row["seed"]: f"`{row['trace_hash']}`" for row in rows}
        lines.append([NAMES[method], f"`{world}`", *(of_seed.get(seed, "") for seed in seeds)])
    return table(["method", "world", *(str(seed) for seed in seeds)], lines)


def tables(rows: list[Row]) -> str:
    """All that the page says of the runs."""
    grouped: dict[tuple[str, str], list[Row]] = defaultdict(list)
    for row in rows:
        grouped[row["world"], row["method"]].append(row)
    runs = {(world, method): grouped[world, method] for world in WORLDS for method in METHODS}
    present = [world for world in WORLDS if any(row["world"] == world for row in rows)]
    compared, sentences = comparisons(runs)
    wanted = len(METHODS) * len(WORLDS) * SEEDS
    spent = [row["simulated_s"] for row in rows]
    budgets = sorted({row["budget_s"] for row in rows})
    versions = rows[0]["versions"]
    if any(row["versions"] != versions or row["engine"] != rows[0]["engine"] for row in rows):
        raise ValueError("versions differ between runs; allowed: runs of one set of versions")
    minutes = sum(row["cpu_s"] for row in rows) / 60
    counted = (
        f"{len(rows)} of {wanted} runs are done. Each may spend {', '.join(f'{b:,.0f}' for b in budgets)} simulated seconds"
        f" and spent {min(spent):,.0f} to {max(spent):,.0f}; all together took {minutes:.0f} minutes of one core, without the"
        " held-out stairs."
    )
    if len(rows) < wanted:
        counted += " **The others are still to be computed, and medians of few runs say little.**"
    parts = [
        counted,
        "\n".join(greatest(world, {method: runs[world, method] for method in METHODS}) for world in present),
        "\n".join(sentences) or "No difference in favour of another method is more than chance (p < 0.05, corrected).",
        *(results(world, {method: runs[world, method] for method in METHODS}) for world in present),
        "### Against our CMA-ES\n\n" + compared,
        "### Hashes\n\nTrace hash of the best snake of each run in its own world:\n\n" + hashes(runs),
        f"Engine {rows[0]['engine']}; " + ", ".join(f"{name} {number}" for name, number in versions.items()) + ".",
    ]
    return "\n\n".join(parts)


def with_tables(text: str, rows: list[dict[str, Any]]) -> str:
    """The text of the page with the tables of these runs."""
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    return f"{before}{BEGIN}\n\n{tables(rows)}\n\n{END}{after}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--runs", type=Path, default=RUNS)
    parser.add_argument("--page", type=Path, default=PAGE)
    args = parser.parse_args()
    rows = stored(args.runs)
    if not rows:
        parser.error(f"{args.runs} has no runs; allowed: a file that run.py has begun")
    args.page.write_text(with_tables(args.page.read_text(encoding="utf-8"), rows), encoding="utf-8")


if __name__ == "__main__":
    main()
