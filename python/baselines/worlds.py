"""Worlds of the comparison, their held-out stairs, and the result of a trial."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
#: Number of seeds of the table.
SEEDS = 10
#: Presets in which every method learns.
WORLDS = ("climb", "house")
#: Physics steps per simulated second in both presets.
STEPS_PER_S = 60
#: Simulated seconds of a trial while a method learns, and at its end.
DURATION_S = 20.0
#: Simulated seconds of a trial on held-out stairs, as in the program's exam.
HELD_OUT_DURATION_S = 30.0
#: How long the middles of all blocks must be behind the last tread, as in the program's exam, in s.
ARRIVAL_S = 0.5

CLASSES = ("equal", "irregular", "house", "nosing")


@dataclass
class Played:
    """The end of a trial."""

    fitness_m: float
    steps: int
    landed: bool
    disqualified: bool
    trace_hash: str

    @property
    def ranking(self) -> float:
        """The fitness, and minus infinity after a disqualification."""
        return -np.inf if self.disqualified else self.fitness_m


def held_out() -> list[dict[str, Any]]:
    """Names and stairs of the program's 60 held-out staircases; a test of the core compares this file with them."""
    text = Path(__file__).with_name("held_out.jsonl").read_text(encoding="utf-8")
    return [json.loads(line) for line in text.splitlines()]


def stored(path: Path) -> list[dict[str, Any]]:
    """The finished runs. A last line that was cut off is left out; another bad line is an error."""
    if not path.exists():
        return []
    text = path.read_text(encoding="utf-8")
    complete = text[: text.rfind("\n") + 1]
    if complete != text:
        path.write_text(complete, encoding="utf-8")
    return [json.loads(line) for line in complete.splitlines()]


def by_class(landed: list[bool]) -> dict[str, int]:
    """Landings on the held-out stairs, class by class."""
    counts = dict.fromkeys(CLASSES, 0)
    for stairs, has_landed in zip(held_out(), landed):
        counts[stairs["name"].split()[0]] += int(has_landed)
    return counts


def combined_hash(hashes: list[str]) -> str:
    """A hash over the trace hashes of several trials, in their order."""
    return hashlib.sha256("".join(hashes).encode()).hexdigest()[:16]


class Arrival:
    """Notices when a snake has climbed a staircase: the middles of all blocks stay behind its last tread for half a second."""

    def __init__(self, stairs: dict[str, Any]):
        steps = stairs["steps"]

        def whole(values: Any) -> float:
            return float(np.sum(values)) if isinstance(values, list) else steps * values

        self._from_m = stairs["first_riser_y_m"] + whole(stairs["tread_m"])
        self._to_m = self._from_m + stairs["landing_m"]
        self._height_m = whole(stairs["rise_m"])
        self._half_width_m = stairs["width_m"] / 2
        self._since_s: float | None = None
        self.arrived = False

    def observe(self, position_m: np.ndarray, time_s: float) -> None:
        """Takes in the middles of the blocks, rows of x, y and z in m, after a physics step."""
        x, y, z = position_m.T
        on_top = (y >= self._from_m) & (y <= self._to_m) & (abs(x) <= self._half_width_m) & (z >= self._height_m)
        if not on_top.all():
            self._since_s = None
            return
        if self._since_s is None:
            self._since_s = time_s
        self.arrived = self.arrived or time_s - self._since_s >= ARRIVAL_S - 1e-6
