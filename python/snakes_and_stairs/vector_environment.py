"""Many worlds as one Gymnasium environment, stepped on all cores."""

from __future__ import annotations

from typing import Any, Mapping, Optional, Sequence, Union

import numpy as np
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

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
)


class SnakesAndStairsVectorEnv(VectorEnv):
    """N worlds: ``gymnasium.make_vec("SnakesAndStairs-v0", num_envs=N)``.

    Observations, actions, rewards, ends and arguments are those of :class:`snakes_and_stairs.SnakesAndStairsEnv`, with a
    first axis of N. In addition:

        num_envs: number of worlds.
        threads: number of threads that step them; None for all cores. Results do not depend on it.
        autoreset_mode: ``AutoresetMode.NEXT_STEP`` (the step after an episode's last one ignores the action and begins the next
            episode, with the reward 0), ``SAME_STEP`` (the last step begins the next episode; ``info["final_obs"]`` and
            ``info["final_info"]`` have what ended), or ``DISABLED`` (``reset(options={"reset_mask": mask})`` begins episodes).

    ``info`` has arrays ``time_s``, ``y_m``, ``energy_j``, ``fitness``, ``steps_climbed`` with a value per world; where an episode ended also
    ``evaluation``, a dictionary of arrays with the parts of an environment's ``evaluation``. As everywhere in Gymnasium, a mask
    beside each array, such as ``_evaluation``, tells in which worlds its values are valid: ``final_info`` tells only of worlds
    whose episode ended, and the information of a reset only of worlds that it reset.
    """

    metadata = {
        "render_modes": ["rgb_array"],
        "render_fps": 60,
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }

    def __init__(
        self,
        num_envs: int = 1,
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
        threads: Optional[int] = None,
        autoreset_mode: Union[str, AutoresetMode] = AutoresetMode.NEXT_STEP,
        render_mode: Optional[str] = None,
        width: int = 480,
        height: int = 320,
    ):
        check_render_mode(render_mode, ["rgb_array"])
        self.render_mode = render_mode
        self._size = (width, height)
        self.problem, self._worlds = make_worlds(
            num_envs,
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
            threads,
        )
        self.num_envs = num_envs
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self._actions = actions
        self.single_observation_space = observation_space(self._worlds)
        self.single_action_space, self._units = action_space(self._worlds, normalized)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        #: Actions per simulated second.
        self.actions_per_s = physics_rate_hz(self._worlds, steps_per_action)
        fps = max(round(self.actions_per_s), 1)
        self.metadata = {
            **self.metadata,
            "render_fps": fps,
            "autoreset_mode": self.autoreset_mode,
        }
        self._all = np.ones(num_envs, dtype=bool)
        # The worlds whose episode has ended.
        self._ended = np.zeros(num_envs, dtype=bool)
        # One stream per world, so that a world's episodes do not depend on when those of others end, and its seed.
        self._streams: list[np.random.Generator] = []
        self._seeds: list[int] = []

    @property
    def senses(self) -> list[dict[str, Any]]:
        """Index, name, unit, scale, low and high of each part of an observation, and ``half_force_n``: see the single environment."""
        return self._worlds.senses

    @property
    def action_parts(self) -> list[dict[str, Any]]:
        """Index, name, unit and limit of each part of an action: see the single environment."""
        return action_names(self._worlds, self._actions)

    @property
    def servo(self) -> tuple[float, float]:
        """Stiffness in N·m/rad and damping in N·m·s/rad of the servo that follows targets."""
        return self._worlds.servo

    def poses(self, index: int) -> np.ndarray:
        """Poses of the limbs of a world, head first: rows of x, y, z in m and the rotation as a unit quaternion x, y, z, w."""
        return self._worlds.poses(index)

    def champion(
        self, index: int, *, seed: int = 0, generation: int = 1, individual: int = 0
    ) -> Champion:
        """The episode of a world, which must be over and not begun anew, as a champion with recorded actions: see the single
        environment. With ``AutoresetMode.SAME_STEP`` there is no moment for it."""
        return self._worlds.champion(index, seed, generation, individual)

    def save_episode(
        self, index: int, path: Path, *, seed: int = 0, generation: int = 1, individual: int = 0
    ) -> None:
        """Writes :meth:`champion` to a file that the program replays, films, exports and examines, and shows in its window."""
        self.champion(index, seed=seed, generation=generation, individual=individual).save(path)

    def render(self) -> Optional[tuple[np.ndarray, ...]]:
        """A picture of each world with ``render_mode="rgb_array"``: see the single environment."""
        if self.render_mode != "rgb_array":
            return None
        return tuple(self._worlds.picture(index, *self._size) for index in range(self.num_envs))

    @property
    def np_random(self) -> tuple[np.random.Generator, ...]:
        """The random numbers of each world."""
        self._seed(None, self._all)
        return tuple(self._streams)

    @property
    def np_random_seed(self) -> tuple[int, ...]:
        """The seed of each world's random numbers."""
        self._seed(None, self._all)
        return tuple(self._seeds)

    def reset(
        self,
        *,
        seed: Union[None, int, Sequence[Optional[int]]] = None,
        options: Optional[dict[str, Any]] = None,
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begins an episode in every world, or in those of ``options["reset_mask"]``, an array of a bool per world.

        World ``i`` has the seed ``seed + i``, or ``seed[i]``, and then the episodes of a single environment with that seed.
        """
        options = dict(options or {})
        mask = options.pop("reset_mask", self._all)
        if options:
            raise ValueError(f"options is {options!r}; allowed: reset_mask")
        # Numbers of worlds would pass for flags otherwise.
        if not isinstance(mask, np.ndarray) or mask.dtype != np.bool_:
            raise TypeError(f"reset_mask is {mask!r}; allowed: an array of {self.num_envs} bools")
        if mask.shape != (self.num_envs,) or not mask.any():
            raise ValueError(
                f"reset_mask is of shape {mask.shape} with {mask.sum()} flags;"
                f" allowed: shape ({self.num_envs},) with at least one flag"
            )
        self._seed(seed, mask)
        observations = self._begin(mask)
        return observations, self._infos(mask)

    def step(
        self, actions: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Holds an action for ``steps_per_action`` physics steps in every world that is in an episode."""
        actions = np.asarray(actions, dtype=np.float32)
        if actions.ndim != 2:
            shape = self.action_space.shape
            raise ValueError(f"action is of shape {actions.shape}; allowed: shape {shape}")
        is_running = self._all
        begins = self._ended
        if begins.any():
            if self.autoreset_mode is AutoresetMode.DISABLED:
                which = np.flatnonzero(begins).tolist()
                raise RuntimeError(f"the episodes of worlds {which} are over: call reset() first")
            is_running = ~begins
        actions = in_units(actions, self._units)
        observations, rewards, terminated, truncated = self._worlds.step(is_running, actions)
        if begins.any():
            observations = self._begin(begins.copy())
        self._ended = terminated | truncated
        infos = self._infos(self._all)
        if self._ended.any():
            if self.autoreset_mode is AutoresetMode.SAME_STEP:
                observations, infos = self._begin_in_same_step(observations)
            else:
                infos = self._add_evaluations(infos)
        return observations, rewards, terminated, truncated, infos

    def _seed(self, seed: Union[None, int, Sequence[Optional[int]]], mask: np.ndarray) -> None:
        if seed is None and self._streams:
            return
        seeds: Sequence[Optional[int]]
        if seed is None:
            seeds = [None] * self.num_envs
        elif isinstance(seed, (int, np.integer)):
            seeds = [int(seed) + index for index in range(self.num_envs)]
        else:
            seeds = list(seed)
        if len(seeds) != self.num_envs:
            raise ValueError(f"seed is a list of {len(seeds)}; allowed: {self.num_envs}, one per world")
        least = min((one for one in seeds if one is not None), default=0)
        if least < 0:
            raise ValueError(f"seed is {least}; allowed: None, or 0 and greater")
        if not self._streams:
            # Each starts like that of a single environment without a seed.
            drawn = [seeding.np_random() for _ in range(self.num_envs)]
            self._streams, self._seeds = [list(part) for part in zip(*drawn)]
        for index, one in enumerate(seeds):
            if one is not None and mask[index]:
                self._streams[index], self._seeds[index] = seeding.np_random(int(one))

    def _begin(self, mask: np.ndarray) -> np.ndarray:
        self._seed(None, mask)
        seeds = np.zeros(self.num_envs, dtype=np.uint64)
        for index in np.flatnonzero(mask):
            seeds[index] = draw_seed(self._streams[index])
        observations = self._worlds.reset(mask, seeds)
        self._ended = self._ended & ~mask
        return observations

    def _begin_in_same_step(self, observations: np.ndarray) -> tuple[np.ndarray, dict[str, Any]]:
        ended = self._ended.copy()
        infos = self._add_evaluations(self._infos(ended))
        final = np.full(self.num_envs, None, dtype=object)
        for index in np.flatnonzero(ended):
            final[index] = observations[index].copy()
        observations = self._begin(ended)
        new = self._infos(self._all)
        new.update(final_obs=final, _final_obs=ended, final_info=infos, _final_info=ended.copy())
        return observations, new

    def _infos(self, mask: np.ndarray) -> dict[str, Any]:
        """The state of the worlds of a mask; 0 elsewhere, as Gymnasium has it."""
        infos: dict[str, Any] = {}
        for name, values in self._worlds.state().items():
            infos[name] = np.where(mask, values, np.zeros_like(values))
            infos[f"_{name}"] = mask.copy()
        return infos

    def _add_evaluations(self, infos: dict[str, Any]) -> dict[str, Any]:
        for index, result in enumerate(self._worlds.evaluations(self._ended)):
            if result is not None:
                infos = self._add_info(infos, {"evaluation": result}, index)
        return infos
