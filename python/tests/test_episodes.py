"""Episodes of policies: recorded as champions, drawn, pickled and copied."""

import copy
import json
import multiprocessing
import pickle

import gymnasium
import numpy as np
import pytest
from conftest import SAVES, SHORT

import snakes_and_stairs as sns


def make(**arguments):
    arguments.setdefault("settings", SHORT)
    return sns.SnakesAndStairsEnv(**arguments)


def policy(env, senses):
    """A policy of the senses, whose actions no formula of the time gives."""
    scale = env.action_space.high
    share = np.sin(6 * np.cumsum(senses)[: len(scale)] + np.arange(len(scale)))
    return (0.7 * scale * share).astype(np.float32)


def play(env):
    """The last information of an episode."""
    senses, _ = env.reset(seed=1)
    while True:
        senses, _, terminated, truncated, info = env.step(policy(env, senses))
        if terminated or truncated:
            return info


@pytest.mark.parametrize(
    "arguments",
    [
        {},
        {"steps_per_action": 7},
        {"steps_per_action": 7, "actions": "torques"},
        {"stiffness_nm_per_rad": 300, "damping_nms_per_rad": 5, "steps_per_action": 4},
        {"preset": "thick-air"},
        {"preset": "squishy", "steps_per_action": 9},
        {"preset": "bodies", "body": 3},
        {"preset": "creatures", "actions": "torques"},
        {"preset": "creatures", "body": 5},
        {"preset": "generalist"},
        {"body": SAVES / "tapered.ron", "settings": {**SHORT, "physics.engine": "rapier"}},
        # A fast joint disqualifies the snake, and its episode ends early.
        {"actions": "torques", "settings": {**SHORT, "trial.health.speed_m_s": 2.0}},
    ],
)
def test_r10_an_episode_is_a_champion_that_replays_to_the_last_bit(arguments, tmp_path, snakes):
    env = make(**arguments)
    evaluation = play(env)["evaluation"]
    path = tmp_path / "episode.ron"
    env.save_episode(path, seed=7)
    champion = sns.load_champion(path)
    assert champion.trace_hash == env.champion().trace_hash == evaluation["trace_hash"]
    recorded = champion.to_dict()["recorded"]
    assert recorded["fitness"] == pytest.approx(evaluation["fitness"], rel=1e-6)
    assert recorded["disqualified"] == evaluation["disqualified"]
    assert champion.to_dict()["origin"]["seed"] == 7
    kind = "Signal" if arguments.get("actions") == "torques" else "Targets"
    assert list(champion.to_dict()["genome"]["controller"]) == [kind]
    printed = json.loads(snakes("replay", path, "--no-render", "--json"))
    assert printed["matches"] is True and printed["trace_hash"] == evaluation["trace_hash"]


def imitate(env, champion):
    """An episode of a policy that follows the joint angles of a champion, and climbs some steps by them."""
    motion = champion.trajectory()
    angles = np.stack([motion["joint_bend_rad"], motion["joint_twist_rad"]], axis=2)
    targets = angles.reshape(len(angles), -1).astype(np.float32)
    env.reset()
    for moment in range(2, len(targets), 4):
        _, _, terminated, truncated, info = env.step(targets[moment])
        if terminated or truncated:
            return info


@pytest.mark.parametrize("preset", ["climb", "creatures"])
def test_r10_an_episode_is_exported_and_examined_like_any_champion(preset, tmp_path, snakes):
    if preset == "climb":
        climber = sns.load_champion(SAVES / "climber.ron")
        trial = climber.to_dict()["trial"]
        settings = {"trial.duration_s": trial["duration_s"], "start_y_m": trial["start_y_m"]}
        env = make(body=climber, steps_per_action=4, stiffness_nm_per_rad=1500, settings=settings)
        info = imitate(env, climber)
        assert info["steps_climbed"] >= 2
    else:
        env = make(preset=preset, steps_per_action=4)
        info = play(env)
    evaluation = info["evaluation"]
    path = tmp_path / "episode.ron"
    env.save_episode(path)
    for suffix in ("html", "csv", "glb", "xml"):
        snakes("export", path, "-o", tmp_path / f"episode.{suffix}")
    assert evaluation["trace_hash"] in (tmp_path / "episode.html").read_text()
    lines = snakes("exam", path, "--suite", "step-rate", "--json").splitlines()
    result = json.loads(lines[0])
    assert result["suite"] == "step-rate" and result["matches"] is True
    if preset == "climb":
        assert result["kept_in"]["60 Hz"] == 1.0, "its own step rate"


def test_r10_evolution_begins_from_an_episode(tmp_path):
    env = make(steps_per_action=6)
    evaluation = play(env)["evaluation"]
    settings = {**SHORT, "controller": "targets", "points_per_s": 10, "population": 6, "angle_range_rad": 1.8}
    settings |= {"stiffness_max_nm_per_rad": 2000, "servo_damping_nms_per_rad": env.servo[1], "twist_range_rad": 1.5}
    body = env.champion().to_dict()["genome"]["body"]
    settings |= {"bend_limits_rad": [body["bend_limit_rad"]], "twist_limits_rad": [body["twist_limit_rad"]]}
    search = sns.Search("climb", strategy="ga", settings=settings, founder=env.champion())
    assert search.evaluate().trace_hash[0] == evaluation["trace_hash"]


def test_r10_episodes_that_no_champion_can_hold_are_refused(tmp_path):
    path = tmp_path / "none.ron"
    env = make()
    with pytest.raises(RuntimeError, match="champion before reset"):
        env.save_episode(path)
    env.reset()
    env.step(env.action_space.sample())
    with pytest.raises(ValueError, match="the episode is not over; allowed"):
        env.save_episode(path)
    perturbed = make(perturbation=True)
    play(perturbed)
    with pytest.raises(ValueError, match="perturbation is set; allowed: None for an episode"):
        perturbed.save_episode(path)
    assert not path.exists()


def test_r10_the_episode_of_a_world_among_many_is_saved(tmp_path):
    envs = sns.SnakesAndStairsVectorEnv(3, settings=SHORT, steps_per_action=6)
    single = make(steps_per_action=6)
    envs.action_space.seed(2)
    envs.reset(seed=1)
    single.reset(seed=2)
    for _ in range(20):
        actions = envs.action_space.sample()
        infos = envs.step(actions)[4]
        info = single.step(actions[1])[4]
    path = tmp_path / "episode.ron"
    envs.save_episode(1, path)
    hashes = infos["evaluation"]["trace_hash"]
    assert sns.load_champion(path).trace_hash == hashes[1] == info["evaluation"]["trace_hash"] != hashes[0]


def continued(env, steps):
    """The observations of the next steps."""
    seen, senses = [], np.zeros(env.observation_space.shape, dtype=np.float32)
    for _ in range(steps):
        senses, *_ = env.step(policy(env, senses))
        seen.append(senses.tobytes())
    return seen


COPIES = [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))]


@pytest.mark.parametrize("copied", COPIES, ids=["deepcopy", "pickle"])
@pytest.mark.parametrize("preset", ["climb", "creatures", "squishy"])
def test_r10_an_environment_is_copied_in_the_middle_of_an_episode(preset, copied):
    env = gymnasium.make("SnakesAndStairs-v0", preset=preset, settings=SHORT, perturbation=True)
    env.reset(seed=3)
    continued(env, 30)
    other = copied(env)
    assert continued(other, 20) == continued(env, 20)
    assert np.array_equal(env.reset()[0], other.reset()[0]), "the next episode is the same, too"
    fresh = copied(make(preset=preset))
    assert np.array_equal(fresh.reset(seed=1)[0], make(preset=preset).reset(seed=1)[0])


@pytest.mark.parametrize("copied", COPIES, ids=["deepcopy", "pickle"])
def test_r10_worlds_are_copied_in_the_middle_of_their_episodes(copied):
    envs = sns.SnakesAndStairsVectorEnv(3, settings=SHORT, perturbation=True)
    envs.reset(seed=3)
    envs.action_space.seed(1)
    for _ in range(30):
        envs.step(envs.action_space.sample())
    other = copied(envs)
    for _ in range(5):
        actions = envs.action_space.sample()
        its, ours = other.step(actions), envs.step(actions)
        assert its[0].tobytes() == ours[0].tobytes() and its[1].tobytes() == ours[1].tobytes()


def finished(env):
    return play(env)["evaluation"]["trace_hash"]


def test_r10_environments_problems_and_champions_travel_to_spawned_processes():
    env = make(steps_per_action=6)
    expected = finished(env)
    champion = sns.load_champion(SAVES / "climber.ron")
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.apply(finished, (env,)) == expected
        assert pool.apply(sns.Champion.evaluate, (champion,)).trace_hash[0] == champion.trace_hash
    other = pickle.loads(pickle.dumps(champion))
    assert other.to_dict() == champion.to_dict() and copy.deepcopy(champion).to_dict() == champion.to_dict()


def test_r10_a_moment_is_drawn():
    env = make(render_mode="rgb_array", width=160, height=100)
    with pytest.raises(RuntimeError, match="render before reset"):
        env.render()
    env.reset()
    first = env.render()
    assert first.shape == (100, 160, 3) and first.dtype == np.uint8
    red = (first[:, :, 0].astype(int) - first[:, :, 1] > 60).mean()
    assert 0.01 < red < 0.4, "red blocks"
    assert np.array_equal(first, env.render())
    for _ in range(60):
        env.step(env.action_space.sample())
    assert not np.array_equal(first, env.render())
    assert make().render() is None
    envs = sns.SnakesAndStairsVectorEnv(2, settings=SHORT, render_mode="rgb_array", width=64, height=48)
    envs.reset()
    assert [picture.shape for picture in envs.render()] == [(48, 64, 3)] * 2
    with pytest.raises(ValueError, match="width is 3; allowed: 16 to 4096"):
        env = make(render_mode="rgb_array", width=3)
        env.reset()
        env.render()


def test_r10_the_program_shows_an_episode_that_ends(tmp_path, monkeypatch):
    shown = tmp_path / "shown"
    program = tmp_path / "snakes"
    program.write_text(f'#!/bin/sh\ncp "$2" {shown}\n')
    program.chmod(0o755)
    monkeypatch.setenv("SNAKES", str(program))
    env = make(render_mode="human")
    evaluation = play(env)["evaluation"]
    env._window.wait(10)
    assert sns.load_champion(shown).trace_hash == evaluation["trace_hash"]
    monkeypatch.setenv("SNAKES", str(tmp_path / "none"))
    with pytest.raises(ValueError, match="'human' needs one world without perturbation, and the program"):
        make(render_mode="human")
