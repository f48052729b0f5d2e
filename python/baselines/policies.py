"""PPO and SAC of stable-baselines3 in the environment of a preset."""

from __future__ import annotations

import copy
import hashlib
import json
from dataclasses import dataclass, field
from typing import Any

import gymnasium
import numpy as np
import torch
from stable_baselines3 import PPO, SAC
from stable_baselines3.common.vec_env import DummyVecEnv, VecNormalize
from worlds import DURATION_S, HELD_OUT_DURATION_S, STEPS_PER_S, Arrival, Played, held_out

from snakes_and_stairs import SnakesAndStairsEnv

#: Worlds that are stepped in turn while a policy learns.
WORLDS_AT_ONCE = 8
#: Physics steps for which an action holds: 15 actions per second.
STEPS_PER_ACTION = 4
#: Greatest target of a bend, in rad: that of the genomes' gaits (`genome.wave.angle_range_rad`).
BEND_RAD = 1.0
#: Parts of the budget, after each of which the policy is tried without chance.
CHECKS = 20

#: Settings of a trial that decide which places count.
PLACES = ("stairs.tread_m", "stairs.first_riser_y_m", "agent.limbs", "agent.limb_length_m")

#: What each method changes of stable-baselines3's defaults.
SETTINGS: dict[str, dict[str, Any]] = {
    "ppo": {"n_steps": 256, "batch_size": 256, "n_epochs": 5},
    # With an update for 32 actions, which is few, a coefficient of the entropy that begins at 1 has no time to fall.
    "sac": {
        "train_freq": 8,
        "gradient_steps": 2,
        "learning_starts": 3000,
        "ent_coef": "auto_0.01",
        "policy_kwargs": {"net_arch": [64, 64], "optimizer_kwargs": {"fused": True}},
    },
}


class Bends(gymnasium.Wrapper):
    """Actions from -1 to 1 for the bends alone, and rewards at once.

    Twists are held straight: the genomes do not drive them either. A reward is the change of the place that the fitness `climb`
    counts, without its mean over the last half second, so that it follows the action.
    """

    def __init__(self, env: SnakesAndStairsEnv):
        super().__init__(env)
        axes = env.action_space.shape[0]
        self._targets = np.zeros(axes, dtype=np.float32)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (axes // 2,), np.float32)
        values = {name: json.loads(env.problem.settings[f"trial.{name}"]) for name in PLACES}
        treads = np.broadcast_to(values["stairs.tread_m"], env.problem.steps).astype(np.float32)
        self._riser_m = np.float32(values["stairs.first_riser_y_m"])
        half_m = np.float32(values["agent.limbs"] * values["agent.limb_length_m"] / 2)
        # Where the whole snake stands on the landing.
        self._arrived_m = self._riser_m + treads[:-1].sum() + half_m
        self._place_m = 0.0

    def reset(self, **options: Any) -> tuple[np.ndarray, dict[str, Any]]:
        senses, info = super().reset(**options)
        self._place_m = self._place(info)
        return senses, info

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        self._targets[0::2] = action * BEND_RAD
        senses, _, terminated, truncated, info = super().step(self._targets)
        before_m, self._place_m = self._place_m, self._place(info)
        return senses, self._place_m - before_m, terminated, truncated, info

    def _place(self, info: dict[str, Any]) -> float:
        """The y that counts, in m: beside the stairs up to the first riser, on the landing up to where the snake fits on it."""
        return min(info["y_m"], float(self._arrived_m if info["steps_climbed"] > 0 else self._riser_m))


def environment(world: str, **arguments: Any) -> Bends:
    """The environment of a preset."""
    return Bends(SnakesAndStairsEnv(world, **arguments))


@dataclass
class Policy:
    """A policy without chance, with the normalisation of its observations."""

    network: Any
    statistics: Any
    clip: float

    def actions(self, senses: np.ndarray) -> np.ndarray:
        """Actions for rows of senses."""
        scale = np.sqrt(self.statistics.var + 1e-8)
        scaled = np.clip((senses - self.statistics.mean) / scale, -self.clip, self.clip)
        return self.network.predict(scaled.astype(np.float32), deterministic=True)[0]

    def kept(self) -> tuple[dict[str, torch.Tensor], Any]:
        """Copies of the weights and of the normalisation, which go on to change while a method learns."""
        weights = {name: value.clone() for name, value in self.network.state_dict().items()}
        return weights, copy.deepcopy(self.statistics)

    def hash(self) -> str:
        """A hash over the bits of all weights."""
        digest = hashlib.sha256()
        for value in self.network.state_dict().values():
            digest.update(value.numpy().tobytes())
        return digest.hexdigest()[:16]


def play(policy: Policy, worlds: list[Bends]) -> list[Played]:
    """The policy in several worlds, side by side, to the end of each trial."""
    senses = np.stack([world.reset()[0] for world in worlds])
    ends: list[Played | None] = [None] * len(worlds)
    while any(end is None for end in ends):
        actions = policy.actions(senses)
        for index, world in enumerate(worlds):
            if ends[index] is None:
                senses[index], ends[index] = _held(world, actions[index])
    return [end for end in ends if end is not None]


def _held(world: Bends, action: np.ndarray) -> tuple[np.ndarray, Played | None]:
    """Holds an action; the worlds themselves advance by single physics steps if they observe arrivals."""
    arrival: Arrival | None = getattr(world, "arrival", None)
    senses, info = None, {}
    for _ in range(STEPS_PER_ACTION if arrival else 1):
        senses, _, terminated, truncated, info = world.step(action)
        # Only a snake whose middle block is on the landing can have arrived.
        if arrival and not arrival.arrived and info["steps_climbed"] == world.env.problem.steps:
            arrival.observe(world.env.poses()[:, :3], info["time_s"])
        if terminated or truncated:
            end = info["evaluation"]
            out = end["disqualified"] is not None
            landed = end["on_landing"] if arrival is None else arrival.arrived and not out
            steps = 0 if out else info["steps_climbed"]
            return senses, Played(end["fitness"], steps, landed, out, end["trace_hash"])
    return senses, None


def own_world(world: str) -> list[Bends]:
    """The trial in which a policy learned."""
    return [environment(world, steps_per_action=STEPS_PER_ACTION)]


def examine(policy: Policy, world: str) -> list[Played]:
    """The policy on the held-out stairs. It senses them, and counts as landed once its snake has arrived."""
    worlds = []
    for one in held_out():
        settings = {"trial.duration_s": HELD_OUT_DURATION_S}
        stairs = environment(world, stairs=one["stairs"], settings=settings)
        stairs.arrival = Arrival(one["stairs"])
        worlds.append(stairs)
    return play(policy, worlds)


@dataclass
class Learned:
    """What a run has learned, and what it has spent."""

    best: Policy | None = None
    played: Played | None = None
    simulated_s: float = 0.0
    episodes: int = 0
    steps: int = 0
    updates: int = 0
    first_landing_s: float | None = None
    #: Pairs of simulated seconds and fitness in m, one for each time the policy played without chance.
    progress: list[tuple[float, float]] = field(default_factory=list)


def learn(method: str, world: str, seed: int, budget_s: float, changes: dict[str, Any] | None = None) -> Learned:
    """Learns until the budget is spent. About twenty times the policy plays the trial without chance, which counts; the best stays."""
    torch.set_num_threads(1)
    algorithm = {"ppo": PPO, "sac": SAC}[method]
    settings = {**SETTINGS[method], **(changes or {})}
    single = DummyVecEnv([lambda: environment(world, steps_per_action=STEPS_PER_ACTION) for _ in range(WORLDS_AT_ONCE)])
    worlds = VecNormalize(single, norm_obs=True, norm_reward=True, gamma=settings.get("gamma", 0.99))
    model = algorithm("MlpPolicy", worlds, seed=seed, device="cpu", **settings)
    trial = own_world(world)
    learned, best = Learned(), None
    action_s = STEPS_PER_ACTION / STEPS_PER_S
    # Both methods learn for whole roll-outs.
    unit = WORLDS_AT_ONCE * settings["n_steps" if method == "ppo" else "train_freq"]
    portion = max(1, int((budget_s / CHECKS - DURATION_S) / action_s) // unit) * unit
    while learned.simulated_s + portion * action_s + DURATION_S <= budget_s:
        model.learn(portion, reset_num_timesteps=learned.steps == 0)
        policy = Policy(model.policy, worlds.obs_rms, worlds.clip_obs)
        played = play(policy, trial)[0]
        learned.steps = model.num_timesteps
        learned.episodes += 1
        learned.simulated_s = learned.steps * action_s + learned.episodes * DURATION_S
        learned.progress.append((round(learned.simulated_s, 1), round(played.fitness_m, 4)))
        if learned.first_landing_s is None and played.landed:
            learned.first_landing_s = learned.simulated_s
        if learned.played is None or played.ranking > learned.played.ranking:
            best, learned.played = policy.kept(), played
    learned.updates = model._n_updates
    if best is not None:
        weights, statistics = best
        model.policy.load_state_dict(weights)
        learned.best = Policy(model.policy, statistics, worlds.clip_obs)
    return learned
