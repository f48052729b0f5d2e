"""Bodies of environments: of the preset, drawn, of champions, soft and branching."""

import gymnasium
import numpy as np
import pytest
from conftest import SAVES, SHORT

import snakes_and_stairs as sns


def make(preset, **arguments):
    return sns.SnakesAndStairsEnv(preset, settings=SHORT, **arguments)


@pytest.mark.parametrize("preset", ["bodies", "creatures"])
def test_r4_where_bodies_evolve_an_environment_has_the_first_body_of_a_run(preset, tmp_path):
    problem = sns.Problem(preset, settings=SHORT)
    for seed in (1, 2, 3):
        genomes = problem.random(30, seed=seed)
        rests = problem.evaluate(genomes).physics_steps > 0
        genome = genomes[rests.argmax()]
        env = make(preset, body=seed)
        env.reset()
        body = genome["body"]
        if preset == "bodies":
            assert len(env.poses()) == len(body["segments"])
        assert env.action_space.shape == (2 * (len(env.poses()) - 1),)
        assert len(env.senses) == env.observation_space.shape[0] == 12 * len(env.poses())
        # It lies where the genome's own snake begins.
        problem.save_champion(tmp_path / "own.ron", genome)
        own = sns.load_champion(tmp_path / "own.ron").trajectory()
        assert np.allclose(env.poses()[:, :3], own["position_m"][0], atol=1e-6)
    again = make(preset)
    again.reset()
    one = make(preset, body=1)
    one.reset()
    assert np.array_equal(again.poses(), one.poses()), "None stands for the seed 1"
    shapes = {make(preset, body=seed).action_space.shape for seed in range(1, 12)}
    assert len(shapes) > 2


@pytest.mark.parametrize("name, limbs", [("six", 6), ("tapered", None), ("foam", None), ("rearer", None)])
def test_r4_an_environment_has_the_body_of_a_champion(name, limbs):
    path = SAVES / f"{name}.ron"
    champion = sns.load_champion(path)
    motion = champion.trajectory()
    env = sns.SnakesAndStairsEnv(
        "climb",
        body=path,
        settings={**SHORT, "physics.engine": "rapier", "start_y_m": champion.to_dict()["trial"]["start_y_m"]},
    )
    env.reset()
    assert limbs is None or len(env.poses()) == limbs
    assert len(env.poses()) == motion["position_m"].shape[1]
    assert np.allclose(env.poses()[:, 1], motion["position_m"][0][:, 1], atol=0.02)
    other = sns.SnakesAndStairsEnv("climb", body=champion, settings={**SHORT, "physics.engine": "rapier"})
    assert other.action_space == env.action_space


@pytest.mark.parametrize("engine", ["rapier", "lanes"])
def test_r4_a_creature_and_a_soft_snake_move_in_both_engines(engine):
    for preset in ("creatures", "squishy", "bodies"):
        env = gymnasium.make("SnakesAndStairs-v0", preset=preset, settings={**SHORT, "physics.engine": engine})
        env.reset(seed=1)
        before = env.unwrapped.poses()
        env.action_space.seed(1)
        for _ in range(60):
            senses, _, terminated, _, _ = env.step(env.action_space.sample())
            assert env.observation_space.contains(senses)
            if terminated:
                break
        assert not np.allclose(before, env.unwrapped.poses(), atol=0.01), preset


def test_r4_worlds_of_a_vector_environment_share_a_body():
    envs = sns.SnakesAndStairsVectorEnv(3, "creatures", body=4, settings=SHORT)
    env = make("creatures", body=4)
    assert np.array_equal(envs.reset(seed=1)[0][2], env.reset(seed=3)[0])
