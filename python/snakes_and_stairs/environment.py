"""One world as a Gymnasium environment."""

from __future__ import annotations

import os
import subprocess
import tempfile
from typing import Any, Mapping, Optional, Union

import gymnasium
import numpy as np

from ._core import Champion
from ._options import (
    Body,
    Path,
    action_names,
    action_space,
    check_render_mode,
    draw_seed,
    in_units,
    make_worlds,
    observation_space,
    physics_rate_hz,
    program,
)

_ALL = np.ones(1, dtype=bool)


class SnakesAndStairsEnv(gymnasium.Env):
    """A snake of blocks, or a creature, on a staircase: ``gymnasium.make("SnakesAndStairs-v0")``.

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
        The change, over the step, of the fitness (``trial.fitness``; for ``climb``: metres of y of the middle block, which beside
        the stairs count only up to the first riser), as the program scores it: the mean over the last half second, less
        ``trial.energy_cost_per_kj`` for the energy spent. The rewards of an episode add up to ``info["fitness"]`` at its end,
        which is the fitness of the evaluation, less that at its start.

    End
        ``terminated`` if the snake is disqualified, because the physics broke or was exploited or it left the arena; then
        ``disqualification_penalty`` is subtracted. ``truncated`` at the end of the trial (``trial.duration_s``).

    Info
        ``time_s``, ``y_m``, ``energy_j`` and ``fitness`` of the episode so far, ``steps_climbed`` now; in the last step also
        ``evaluation``: fitness as the program scores it, the reason of a disqualification, whether it stands on the landing,
        the trace hash (hexadecimal, as in files), and the number of physics steps.

    Arguments
        preset: a shipped preset (see :func:`snakes_and_stairs.presets`) or the path of a file.
        stairs: changes of the stairs by name: ``{"steps": 5, "rise_m": 0.3, "tread_m": 2.5}``.
        settings: changes of other settings, as ``--set`` of the program takes them: ``{"trial.duration_s": 10}``. A setting
            that has no effect here, such as one of the search, is refused.
        body: None for the body of the preset, where joint limits and density, which evolve in other uses, are in the middle of
            their ranges unless settings fix them. Where bodies evolve, as in ``bodies`` and ``creatures``, None stands for 1. A
            number: the first body of a run with this seed that comes to rest on the ground. A champion, or the path of its file: its body. The policy takes
            the place of the controller of the preset or champion.
        actions: ``"targets"`` or ``"torques"``.
        steps_per_action: physics steps for which an action holds.
        stiffness_nm_per_rad, damping_nms_per_rad: of the servo; None for the middle of the preset's range of stiffness, and
            for the preset's damping.
        normalized: whether each part of an action is from -1 to 1 of its range, as many learners expect, instead of an angle or torque.
        perturbation: None for the same start in every episode; True for the program's usual ranges; or the ranges of
            friction, rise, density, start_m, turn_deg, tread, step_rate, shove_m_s, of which missing ones are 0.
        disqualification_penalty: subtracted from the reward on disqualification, in units of the reward.
        render_mode: ``"rgb_array"``: :meth:`render` draws the present moment, without a graphics device. ``"human"``: the program
            shows each episode that ends while its window is not open yet; it must be on the PATH or be named by the variable
            SNAKES. None for neither.
        width, height: of a picture, in pixels.

    Environments can be pickled and copied (``copy.deepcopy``) in the middle of an episode. A copy in another process simulates the
    episode again.
    """

    metadata = {"render_modes": ["human", "rgb_array"], "render_fps": 60}

    def __init__(
        self,
        preset: Path = "climb",
        *,
        stairs: Optional[Mapping[str, Any]] = None,
        body: Body = None,
        settings: Optional[Mapping[str, Any]] = None,
        actions: str = "targets",
        steps_per_action: int = 1,
        stiffness_nm_per_rad: Optional[float] = None,
        damping_nms_per_rad: Optional[float] = None,
        normalized: bool = False,
        perturbation: Union[None, bool, Mapping[str, float]] = None,
        disqualification_penalty: float = 0.0,
        render_mode: Optional[str] = None,
        width: int = 480,
        height: int = 320,
    ):
        is_shown = not perturbation and program() is not None
        modes = (["human"] if is_shown else []) + ["rgb_array"]
        check_render_mode(render_mode, modes)
        self.render_mode = render_mode
        self._size = (width, height)
        self._window: Optional[subprocess.Popen[bytes]] = None
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
        self.action_space, self._units = action_space(self._worlds, normalized)
        #: Actions per simulated second.
        self.actions_per_s = physics_rate_hz(self._worlds, steps_per_action)
        fps = max(round(self.actions_per_s), 1)
        self.metadata = {**self.metadata, "render_modes": modes, "render_fps": fps}

    @property
    def senses(self) -> list[dict[str, Any]]:
        """Index, name, unit, scale, low and high of each part of an observation, and ``half_force_n``: see Observation."""
        return self._worlds.senses

    @property
    def action_parts(self) -> list[dict[str, Any]]:
        """Index, name, unit and greatest angle or torque of each part of an action, for which 1 stands if actions are normalized; 0 for an
        axis that cannot move."""
        return action_names(self._worlds, self._actions)

    @property
    def servo(self) -> tuple[float, float]:
        """Stiffness in N·m/rad and damping in N·m·s/rad of the servo that follows targets."""
        return self._worlds.servo

    def poses(self) -> np.ndarray:
        """Poses of the limbs, head first: rows of x, y, z in m and the rotation as a unit quaternion x, y, z, w."""
        return self._worlds.poses(0)

    def champion(self, *, seed: int = 0, generation: int = 1, individual: int = 0) -> Champion:
        """The episode, which must be over, as a champion with recorded actions: target angles, or torques, with their rate.

        It repeats the episode to the last bit. ``seed``, ``generation`` and ``individual`` are its origin, for people. An episode
        with a perturbation is refused, because a champion has a trial and no perturbed world.
        """
        return self._worlds.champion(0, seed, generation, individual)

    def save_episode(
        self, path: Path, *, seed: int = 0, generation: int = 1, individual: int = 0
    ) -> None:
        """Writes :meth:`champion` to a file that the program replays, films, exports and examines, and shows in its window."""
        self.champion(seed=seed, generation=generation, individual=individual).save(path)

    def render(self) -> Optional[np.ndarray]:
        """The present moment with ``render_mode="rgb_array"``: rows of pixels of red, green and blue, of shape (height, width, 3)."""
        if self.render_mode != "rgb_array":
            return None
        return self._worlds.picture(0, *self._size)

    def _show(self) -> None:
        """Shows the episode in the program's window, unless it shows an earlier one."""
        if self._window is not None and self._window.poll() is None:
            return
        path = os.path.join(tempfile.mkdtemp(prefix="snakes-and-stairs-"), "episode.ron")
        self.save_episode(path)
        self._window = subprocess.Popen([program() or "snakes", "replay", path])

    def __getstate__(self) -> dict[str, Any]:
        # A window stays with the process that opened it.
        return {**self.__dict__, "_window": None}

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begins an episode. ``seed`` starts the random numbers of the perturbations anew; there are no options."""
        # Gymnasium refuses NumPy's integers, which the vector environment and its own spaces take.
        super().reset(seed=int(seed) if isinstance(seed, np.integer) else seed)
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
        actions = in_units(actions, self._units)
        observations, rewards, terminated, truncated = self._worlds.step(_ALL, actions)
        ended, cut = bool(terminated[0]), bool(truncated[0])
        if self.render_mode == "human" and (ended or cut):
            self._show()
        return observations[0], float(rewards[0]), ended, cut, self._info(ended or cut)

    def _info(self, is_last: bool) -> dict[str, Any]:
        info = {name: values[0].item() for name, values in self._worlds.state().items()}
        if is_last:
            info["evaluation"] = self._worlds.evaluations(_ALL)[0]
        return info
