"""Simulated seconds per second: the vectorised environment against the core (`snakes bench --json`).

    python examples/speed.py --snakes target/release/snakes --worlds 128

The environment does more than the core's scoring: it senses everything before each step, crosses to Python, and fills
arrays. Both take turns, so that other work on the machine slows both alike.
"""

import argparse
import json
import os
import statistics
import subprocess
import time

import gymnasium
import numpy as np

import snakes_and_stairs  # noqa: F401  (registers the environment)


def core(snakes: str, preset: str) -> float:
    """Simulated seconds per second of the core on all threads."""
    command = [snakes, "bench", "--preset", preset, "--json"]
    printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return json.loads(printed)["sim_s_per_s"]


def environment(preset: str, worlds: int, actions: str, steps_per_action: int, lasts_s: float) -> float:
    """Simulated seconds per second of the environment: slow random waves, episodes begun anew."""
    envs = gymnasium.make_vec(
        "SnakesAndStairs-v0",
        num_envs=worlds,
        preset=preset,
        actions=actions,
        steps_per_action=steps_per_action,
    )
    random = np.random.default_rng(1)
    shape = envs.action_space.shape
    limit = np.minimum(envs.single_action_space.high, 1.0 if actions == "targets" else 300.0)
    phase, rate = random.uniform(0, 6.28, shape), random.uniform(1, 6, shape)
    limit = np.broadcast_to(limit, shape)
    envs.reset(seed=1)
    seconds_per_action = 1.0 / envs.unwrapped.actions_per_s
    steps, ended, started = 0, 0, time.perf_counter()
    while time.perf_counter() - started < lasts_s:
        action = limit * np.sin(phase + rate * steps * seconds_per_action)
        _, _, terminated, truncated, _ = envs.step(action.astype(np.float32))
        steps += 1
        # A world whose episode has ended spends the next step on its reset.
        ended += int(np.count_nonzero(terminated | truncated))
    elapsed = time.perf_counter() - started
    envs.close()
    return (steps * worlds - ended) * seconds_per_action / elapsed


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--snakes", help="a release build of the program; without it only the environment is measured")
    parser.add_argument("--preset", default="climb")
    parser.add_argument("--worlds", type=int, default=128)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=6.0, help="wall seconds of each measurement")
    args = parser.parse_args()

    kinds = [("targets", 1), ("targets", 4), ("torques", 1), ("torques", 4)]
    rates: dict[tuple[str, int], list[float]] = {kind: [] for kind in kinds}
    cores: list[float] = []
    for _ in range(args.rounds):
        if args.snakes:
            cores.append(core(args.snakes, args.preset))
        for kind in kinds:
            rates[kind].append(environment(args.preset, args.worlds, *kind, args.seconds))
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
    print(f"{os.cpu_count()} cores, load {load:.1f}, {args.worlds} worlds, medians of {args.rounds}")
    if cores:
        print(f"core, all threads: {statistics.median(cores):.0f} simulated s per s")
    for (actions, steps_per_action), measured in rates.items():
        line = f"{actions}, {steps_per_action} steps per action: {statistics.median(measured):.0f}"
        if cores:
            ratio = statistics.median(ours / of for ours, of in zip(measured, cores))
            line += f" ({ratio:.2f} of the core)"
        print(line)


if __name__ == "__main__":
    main()
