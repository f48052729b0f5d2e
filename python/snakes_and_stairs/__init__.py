"""Snakes & Stairs: a five-block snake on a staircase, as environments, as a function of genomes, and as saved runs.

Environments
    ``gymnasium.make("SnakesAndStairs-v0")`` and ``gymnasium.make_vec("SnakesAndStairs-v0", num_envs=N)``: see
    :class:`SnakesAndStairsEnv` and :class:`SnakesAndStairsVectorEnv`.

Genomes
    :func:`evaluate` and :class:`Problem` simulate arrays of genomes on all cores; :class:`Search` drives the project's own
    strategies by ask and tell; :func:`presets` lists the presets.

Files
    :func:`load_champion`, :func:`load_run` and :func:`replay` read what the program saves; :func:`run_frame`,
    :func:`champions_frame`, :func:`trajectory_frame` and :func:`evaluations_frame` make data frames (with pandas).

A value that is not allowed raises ``ValueError`` with field, value and allowed range; a file that cannot be read, ``OSError``.
"""

from ._core import __version__, ENGINE_VERSION, Champion, Evaluations, load_champion, load_run, presets, replay
from .environment import SnakesAndStairsEnv
from .frames import champions_frame, evaluations_frame, run_frame, trajectory_frame
from .problem import Problem, Search, evaluate
from .registration import ENV_ID, register
from .vector_environment import SnakesAndStairsVectorEnv

register()

__all__ = [
    "ENGINE_VERSION",
    "ENV_ID",
    "Champion",
    "Evaluations",
    "Problem",
    "Search",
    "__version__",
    "SnakesAndStairsEnv",
    "SnakesAndStairsVectorEnv",
    "champions_frame",
    "evaluate",
    "evaluations_frame",
    "load_champion",
    "load_run",
    "presets",
    "register",
    "replay",
    "run_frame",
    "trajectory_frame",
]
