"""What both environments have in common: the worlds that their arguments describe, their spaces and seeds."""

from __future__ import annotations

import os
import shutil
from typing import Any, Mapping, Optional, Union

import numpy as np
from gymnasium import spaces

from ._core import Champion, Problem, Worlds, load_champion

Path = Union[str, "os.PathLike[str]"]
#: A body: None for that of the preset, the seed of a run for its first body, or a champion with its file's path.
Body = Union[None, int, Champion, Path]


def make_worlds(
    count: int,
    preset: Path,
    stairs: Optional[Mapping[str, Any]],
    body: Body,
    settings: Optional[Mapping[str, Any]],
    actions: str,
    steps_per_action: int,
    stiffness_nm_per_rad: Optional[float],
    damping_nms_per_rad: Optional[float],
    perturbation: Union[None, bool, Mapping[str, float]],
    disqualification_penalty: float,
    threads: Optional[int],
) -> tuple[Problem, Worlds]:
    """The problem and the worlds of an environment; every argument is checked."""
    if isinstance(body, (str, os.PathLike)):
        body = load_champion(body)
    problem = Problem(os.fspath(preset), plain(stairs), plain(settings), "environment", None, body)
    worlds = Worlds(
        problem,
        count,
        actions=actions,
        steps_per_action=steps_per_action,
        stiffness_nm_per_rad=stiffness_nm_per_rad,
        damping_nms_per_rad=damping_nms_per_rad,
        perturbation=plain(perturbation),
        disqualification_penalty=disqualification_penalty,
        threads=threads,
    )
    return problem, worlds


def program() -> Optional[str]:
    """The path of the program: what the variable SNAKES names, or ``snakes`` on the PATH; None without it."""
    return shutil.which(os.environ.get("SNAKES") or "snakes")


def check_render_mode(render_mode: Optional[str], modes: list[str]) -> None:
    """Refuses a way to render that an environment does not have."""
    if render_mode is None or render_mode in modes:
        return
    allowed = ", ".join(["None", *map(repr, modes)])
    if render_mode == "human":
        allowed += "; 'human' needs one world without perturbation, and the program: on the PATH, or named by SNAKES"
    raise ValueError(f"render_mode is {render_mode!r}; allowed: {allowed}")


def plain(values: Any) -> Any:
    """Any mapping as a dictionary; anything else as it is, for the core to check."""
    return dict(values) if isinstance(values, Mapping) else values


def observation_space(worlds: Worlds) -> spaces.Box:
    """The ranges of the senses."""
    senses = worlds.senses
    low = np.array([sense["low"] for sense in senses], dtype=np.float32)
    high = np.array([sense["high"] for sense in senses], dtype=np.float32)
    return spaces.Box(low, high, dtype=np.float32)


#: Half the width of the range of an axis that cannot move; the world clamps to its own limit, 0.
_LEAST_LIMIT = 1e-4


def action_space(worlds: Worlds, is_normalized: bool) -> tuple[spaces.Box, np.ndarray]:
    """The ranges of target angles or torques, or -1 to 1 for each; and the angle or torque of one unit of each part."""
    # An axis that cannot move gets a range, too, because wrappers that rescale actions divide by its width.
    limits = np.where(worlds.action_limits > 0, worlds.action_limits, _LEAST_LIMIT)
    limits = limits.astype(np.float32)
    units = limits if is_normalized else np.ones_like(limits)
    return spaces.Box(-limits / units, limits / units, dtype=np.float32), units


def in_units(actions: np.ndarray, units: np.ndarray) -> np.ndarray:
    """Actions, one in a row, as angles or torques. Those of a wrong length stay, because the worlds refuse them by their shape."""
    return actions * units if actions.shape[1:] == units.shape else actions


def action_names(worlds: Worlds, actions: str) -> list[dict[str, Any]]:
    """Index, name, unit and greatest magnitude of each part of an action."""
    unit = "rad" if actions == "targets" else "N·m"
    return [
        {
            "index": index,
            "name": f"joint {index // 2 + 1} {('bend', 'twist')[index % 2]}",
            "unit": unit,
            "limit": float(limit),
        }
        for index, limit in enumerate(worlds.action_limits)
    ]


def physics_rate_hz(worlds: Worlds, steps_per_action: int) -> float:
    """Actions per simulated second."""
    return worlds.physics_steps_per_s / steps_per_action


def draw_seed(random: np.random.Generator) -> np.uint64:
    """The seed of an episode's perturbation."""
    return random.integers(0, 2**64, dtype=np.uint64)
