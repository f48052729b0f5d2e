"""One world as a Gymnasium environment."""

from __future__ import annotations

from typing import Any, Mapping, Optional, Union

import gymnasium
import numpy as np

from ._options import (
    Path,
    action_names,
    action_space,
    draw_seed,
    make_worlds,
    observation_space,
    physics_rate_hz,
)

_ALL = np.ones(1, dtype=bool)


class SnakesAndStairsEnv(gymnasium.Env):
    """A snake of blocks on a staircase: ``gymnasium.make("SnakesAndStairs-v0")``.

    Observation
        A ``Box`` of float32 with what the snake senses, in the order of :attr:`senses`: for each joint (from the head) bend,
        twist, bend rate, twist rate; for each limb (head first) touch, load, blocked, pitch, roll, gap, step up, clearance; for
        the snake yaw, speed ahead, speed up, aside. That is 60 numbers for a snake of five limbs. :attr:`senses` has index, name,
        unit and scale of each: a value times its scale is in the unit, up to ``low`` and ``high``, where it is clamped. Load and
        blocked are shares without a unit: F / (F + W/n) of a force F, for the weight W of a snake of n limbs, smoothed over
        0.1 s; ``half_force_n`` is W/n, the force that is sensed as 0.5. Nothing among the senses tells the time or the absolute
        place.

    Action
        A ``Box`` of float32 of shape ``(2 * joints,)``: bend and twist of the first joint, then of the next. With
        ``actions="targets"`` target angles in rad, which a servo on each axis follows (torque = stiffness · (target − angle) −
        damping · rate); with ``actions="torques"`` torques in N·m. Values beyond the space are clamped to it; NaN is refused.
        The space of an axis that cannot move, because its limit is 0, is ±0.0001; it stays where it is.

    Reward
        The change, over the step, of the score of the preset's measure of fitness (``trial.fitness``; for ``climb``: metres
        of y of the middle block, which beside the stairs count only up to the first riser), less ``trial.energy_cost_per_kj`` for
        the energy spent. The rewards of an episode add up to its final score less that at the start.

    End
        ``terminated`` if the snake is disqualified, because the physics broke or was exploited or it left the arena; then
        ``disqualification_penalty`` is subtracted. ``truncated`` at the end of the trial (``trial.duration_s``).

    Info
        ``time_s``, ``y_m`` and ``energy_j`` of the episode so far, ``steps_climbed`` now; in the last step also
        ``evaluation``: fitness as the program scores it, the reason of a disqualification, whether it stands on the landing,
        the trace hash (hexadecimal, as in files), and the number of physics steps.

    Arguments
        preset: a shipped preset (see :func:`snakes_and_stairs.presets`) or the path of a file.
        stairs: changes of the stairs by name: ``{"steps": 5, "rise_m": 0.3, "tread_m": 2.5}``.
        settings: changes of other settings, as ``--set`` of the program takes them: ``{"trial.duration_s": 10}``. A setting
            that has no effect here, such as one of the search, is refused.
        body: must be None, because there are no evolved bodies yet. The body is that of the preset; properties that would
            evolve (joint limits, density) are in the middle of their ranges, unless settings fix them.
        actions: ``"targets"`` or ``"torques"``.
        steps_per_action: physics steps for which an action holds.
        stiffness_nm_per_rad, damping_nms_per_rad: of the servo; None for the middle of the preset's range of stiffness, and
            for the preset's damping.
        perturbation: None for the same start in every episode; True for the program's usual ranges; or the ranges of
            friction, rise, density, start_m, turn_deg, tread, step_rate, shove_m_s, of which missing ones are 0.
        disqualification_penalty: subtracted from the reward on disqualification, in units of the reward.
    """

    metadata = {"render_modes": []}

    def __init__(
        self,
        preset: Path = "climb",
        *,
        stairs: Optional[Mapping[str, Any]] = None,
        body: None = None,
        settings: Optional[Mapping[str, Any]] = None,
        actions: str = "targets",
        steps_per_action: int = 1,
        stiffness_nm_per_rad: Optional[float] = None,
        damping_nms_per_rad: Optional[float] = None,
        perturbation: Union[None, bool, Mapping[str, float]] = None,
        disqualification_penalty: float = 0.0,
        render_mode: None = None,
    ):
        if render_mode is not None:
            raise ValueError(
                f"render_mode is {render_mode!r}; allowed: None: save a champion and play it with `snakes replay`"
            )
        self.render_mode = None
        self.problem, self._worlds = make_worlds(
            1,
            preset,
            stairs,
            body,
            settings,
            actions,
            steps_per_action,
            stiffness_nm_per_rad,
            damping_nms_per_rad,
            perturbation,
            disqualification_penalty,
            1,
        )
        self._actions = actions
        self.observation_space = observation_space(self._worlds)
        self.action_space = action_space(self._worlds)
        #: Actions per simulated second.
        self.actions_per_s = physics_rate_hz(self._worlds, steps_per_action)

    @property
    def senses(self) -> list[dict[str, Any]]:
        """Index, name, unit, scale, low and high of each part of an observation, and ``half_force_n``: see Observation."""
        return self._worlds.senses

    @property
    def action_parts(self) -> list[dict[str, Any]]:
        """Index, name, unit and greatest magnitude of each part of an action; 0 for an axis that cannot move."""
        return action_names(self._worlds, self._actions)

    @property
    def servo(self) -> tuple[float, float]:
        """Stiffness in N·m/rad and damping in N·m·s/rad of the servo that follows targets."""
        return self._worlds.servo

    def poses(self) -> np.ndarray:
        """Poses of the limbs, head first: rows of x, y, z in m and a quaternion x, y, z, w."""
        return self._worlds.poses(0)

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begins an episode. ``seed`` starts the random numbers of the perturbations anew; there are no options."""
        super().reset(seed=seed)
        if options:
            raise ValueError(f"options is {options!r}; allowed: None: this environment has none")
        seeds = np.array([draw_seed(self.np_random)], dtype=np.uint64)
        observations = self._worlds.reset(_ALL, seeds)
        return observations[0], self._info(False)

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Holds an action for ``steps_per_action`` physics steps."""
        actions = np.asarray(action, dtype=np.float32)[np.newaxis]
        if actions.ndim != 2:
            shape = self.action_space.shape
            raise ValueError(f"action is of shape {actions.shape[1:]}; allowed: shape {shape}")
        observations, rewards, terminated, truncated = self._worlds.step(_ALL, actions)
        ended, cut = bool(terminated[0]), bool(truncated[0])
        return observations[0], float(rewards[0]), ended, cut, self._info(ended or cut)

    def _info(self, is_last: bool) -> dict[str, Any]:
        info = {name: values[0].item() for name, values in self._worlds.state().items()}
        if is_last:
            info["evaluation"] = self._worlds.evaluations(_ALL)[0]
        return info
