"""Results, runs and champions as pandas data frames. pandas is imported when it is needed."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Union

from . import _core
from ._core import Champion, Evaluations

if TYPE_CHECKING:
    import pandas

#: The columns of :func:`evaluations_frame`, each an array of :class:`Evaluations`.
EVALUATION_COLUMNS = (
    "fitness",
    "steps_climbed",
    "on_landing",
    "disqualified",
    "centre_y_m",
    "energy_j",
    "top_speed_m_s",
    "joint_drift_m",
    "sideways_m",
    "mean_height_m",
    "mean_sideways_m",
    "contact_duty",
    "frequency_hz",
    "cost_of_transport",
    "climbing_efficiency",
    "physics_steps",
    "trace_hash",
)


def evaluations_frame(evaluations: Evaluations) -> pandas.DataFrame:
    """A row per snake: fitness, steps climbed, energy, behaviour, trace hash, the ending, and the reason of a disqualification."""
    pandas = _pandas()
    columns: dict[str, Any] = {name: getattr(evaluations, name) for name in EVALUATION_COLUMNS}
    columns["ending"] = evaluations.endings
    columns["reason"] = evaluations.reasons
    return pandas.DataFrame(columns)


def run_frame(folder: Union[str, os.PathLike[str]]) -> pandas.DataFrame:
    """A row per generation of a run, with the run's seed and the names of its lines of JSON: evaluations, disqualified, on the landing,
    statistics of the fitness, its hash."""
    run = _core.load_run(folder)
    return _pandas().DataFrame([{"seed": run["seed"], **line} for line in run["generations"]])


def champions_frame(folder: Union[str, os.PathLike[str]]) -> pandas.DataFrame:
    """A row per saved generation of a run, with the run's seed: what its champion achieved."""
    rows = []
    run = _core.load_run(folder)
    for entry in run["champions"]:
        recorded = entry["champion"].to_dict()["recorded"]
        row = {"seed": run["seed"], "generation": entry["generation"]}
        for name, value in recorded.items():
            row.update(value if isinstance(value, dict) else {name: value})
        rows.append(row)
    return _pandas().DataFrame(rows)


def trajectory_frame(champion: Union[str, os.PathLike[str], Champion]) -> pandas.DataFrame:
    """The motion of a champion (or of its file), simulated again: a row per moment and limb.

    Columns, as in exported tables: ``time_s``, ``limb`` (the head is 1), ``x_m``, ``y_m``, ``z_m``, the unit quaternion
    ``rotation_x``, ``rotation_y``, ``rotation_z``, ``rotation_w``, and of the joint in front of the limb ``joint_bend_rad``,
    ``joint_twist_rad``, ``joint_bend_rate_rad_s``, ``joint_twist_rate_rad_s`` (NaN for the head).
    """
    import numpy as np

    pandas = _pandas()
    if not isinstance(champion, Champion):
        champion = _core.load_champion(champion)
    motion = champion.trajectory()
    moments, limbs, _ = motion["position_m"].shape
    columns = {
        "time_s": np.repeat(motion["time_s"], limbs),
        "limb": np.tile(np.arange(1, limbs + 1), moments),
    }
    for index, name in enumerate(("x_m", "y_m", "z_m")):
        columns[name] = motion["position_m"][:, :, index].ravel()
    for index, name in enumerate(("rotation_x", "rotation_y", "rotation_z", "rotation_w")):
        columns[name] = motion["rotation_xyzw"][:, :, index].ravel()
    of_head = np.full((moments, 1), np.nan)
    for name, values in motion.items():
        if name.startswith("joint_"):
            columns[name] = np.hstack([of_head, values]).ravel()
    return pandas.DataFrame(columns)


def _pandas() -> Any:
    try:
        import pandas
    except ImportError as error:
        raise ImportError("data frames need pandas: pip install pandas") from error
    return pandas
