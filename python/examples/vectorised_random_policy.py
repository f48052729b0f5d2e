"""A random policy in many worlds at once: how far do snakes get that hold random postures?

    python examples/vectorised_random_policy.py --worlds 64
"""

import argparse

import gymnasium
import numpy as np

import snakes_and_stairs  # noqa: F401  (registers the environment)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--worlds", type=int, default=64)
    parser.add_argument("--episodes", type=int, default=128)
    parser.add_argument("--duration", type=float, default=20.0, help="seconds of a trial")
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()

    worlds = gymnasium.make_vec(
        "SnakesAndStairs-v0",
        num_envs=args.worlds,
        preset="climb",
        settings={"trial.duration_s": args.duration},
        steps_per_action=15,
        perturbation=True,
    )
    worlds.action_space.seed(args.seed)
    worlds.reset(seed=args.seed)
    totals, returns, fitness = np.zeros(args.worlds), [], []
    while len(returns) < args.episodes:
        _, rewards, terminated, truncated, infos = worlds.step(worlds.action_space.sample())
        totals += rewards
        for index in np.flatnonzero(terminated | truncated):
            returns.append(totals[index])
            fitness.append(infos["evaluation"]["fitness"][index])
            totals[index] = 0.0
    worlds.close()
    print(
        f"{len(returns)} episodes: mean return {np.mean(returns):.2f} m, best {np.max(returns):.2f} m,"
        f" best fitness {np.max(fitness):.2f} m"
    )


if __name__ == "__main__":
    main()
