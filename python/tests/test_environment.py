"""One world as a Gymnasium environment."""

import warnings

import gymnasium
import numpy as np
import pytest
from conftest import SAVES, SHORT
from gymnasium.utils.env_checker import check_env

import snakes_and_stairs as sns


def make(**arguments):
    arguments.setdefault("settings", SHORT)
    return gymnasium.make("SnakesAndStairs-v0", **arguments)


def episode(env, policy, seed=None):
    """Senses, rewards and the last info of an episode."""
    senses, info = env.reset(seed=seed)
    seen, rewards = [senses], []
    while True:
        senses, reward, terminated, truncated, info = env.step(policy(len(rewards)))
        seen.append(senses)
        rewards.append(reward)
        if terminated or truncated:
            return np.array(seen), np.array(rewards), terminated, info


def wave(env):
    """A gait by hand."""
    parts = env.action_space.shape[0]
    shift = np.arange(parts)
    amplitude = 0.6 * (shift % 2 == 0)
    return lambda step: (amplitude * np.sin(0.1 * step + shift)).astype(np.float32)


@pytest.mark.parametrize("actions", ["targets", "torques"])
@pytest.mark.parametrize("perturbation", [None, True])
@pytest.mark.parametrize("preset", ["climb", "report", "ice", "squishy", "bodies", "creatures", "neat"])
def test_gymnasiums_checker_has_no_complaints(preset, actions, perturbation):
    for normalized in [True, False]:
        env = make(preset=preset, actions=actions, perturbation=perturbation, normalized=normalized)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            if not normalized:
                # Angles and torques are in rad and N·m on purpose.
                warnings.filterwarnings("ignore", message=".*symmetric and normalized.*")
            check_env(env.unwrapped)
        env.close()


@pytest.mark.parametrize("actions", ["targets", "torques"])
def test_normalized_actions_lead_to_the_bits_of_their_angles_or_torques(actions, tmp_path):
    plain, normalized = (make(actions=actions, normalized=normalized) for normalized in [False, True])
    assert np.array_equal(normalized.action_space.high, np.ones(8, dtype=np.float32))
    gait = wave(normalized)
    *_, of_normalized = episode(normalized, gait)
    *_, of_plain = episode(plain, lambda step: gait(step) * plain.action_space.high)
    assert of_normalized["evaluation"] == of_plain["evaluation"]
    worlds = [
        gymnasium.make_vec("SnakesAndStairs-v0", num_envs=2, settings=SHORT, actions=actions, normalized=normalized)
        for normalized in [True, False]
    ]
    for envs, unit in zip(worlds, [1, plain.action_space.high]):
        envs.reset(seed=1)
        seen = [envs.step(np.stack([gait(step) * unit] * 2))[0] for step in range(40)]
        envs.seen = np.array(seen)
    assert np.array_equal(worlds[0].single_action_space.high, np.ones(8, dtype=np.float32))
    assert np.array_equal(worlds[0].seen, worlds[1].seen)
    with pytest.raises(ValueError, match="shape"):
        normalized.reset()
        normalized.unwrapped.step(np.zeros(3, dtype=np.float32))


def test_the_same_actions_lead_to_the_same_bits():
    env = make()
    first, second = (episode(env, wave(env)) for _ in range(2))
    assert np.array_equal(first[0], second[0])
    assert np.array_equal(first[1], second[1])
    assert first[3]["evaluation"]["trace_hash"] == second[3]["evaluation"]["trace_hash"]
    other = episode(env, lambda step: wave(env)(step + 1))
    assert other[3]["evaluation"]["trace_hash"] != first[3]["evaluation"]["trace_hash"]


def test_an_episode_is_truncated_at_the_end_of_the_trial():
    env = make(settings={"trial.duration_s": 3}, steps_per_action=7)
    _, rewards, terminated, info = episode(env, wave(env))
    assert not terminated
    # 180 physics steps; the last action is cut off.
    assert len(rewards) == 26
    assert info["time_s"] == pytest.approx(3.0)
    assert info["evaluation"]["physics_steps"] == 180


@pytest.mark.parametrize("fitness", ["climb", "furthest_y", "share", "height"])
@pytest.mark.parametrize("steps_per_action", [1, 7])
def test_r3_rewards_add_up_to_the_fitness(fitness, steps_per_action):
    settings = {"trial.duration_s": 4, "trial.fitness": fitness, "trial.energy_cost_per_kj": 0.5}
    env = make(settings=settings, steps_per_action=steps_per_action)
    _, start = env.reset()
    _, rewards, _, info = episode(env, wave(env))
    assert info["fitness"] == info["evaluation"]["fitness"] != start["fitness"]
    assert rewards.sum() == pytest.approx(info["fitness"] - start["fitness"], abs=1e-9)
    if fitness == "climb":
        # The mean over the last half second is not where the snake ended.
        cost = 0.5 * info["energy_j"] / 1000
        assert 1e-4 < abs(info["fitness"] + cost - info["y_m"]) < 0.5
        assert start["fitness"] == pytest.approx(start["y_m"], abs=1e-6)


def test_energy_costs_reward_as_it_costs_fitness():
    free, dear = (make(settings={**SHORT, "trial.energy_cost_per_kj": cost}) for cost in (0, 2))
    _, free_rewards, _, info = episode(free, wave(free))
    _, dear_rewards, _, same = episode(dear, wave(dear))
    assert info["energy_j"] == same["energy_j"] > 0
    cost = 2 * info["energy_j"] / 1000
    # The fitness has 32 bits.
    assert free_rewards.sum() - dear_rewards.sum() == pytest.approx(cost, abs=2e-6)
    lost = info["evaluation"]["fitness"] - same["evaluation"]["fitness"]
    assert lost == pytest.approx(cost, rel=1e-3)


def test_a_disqualified_snake_terminates_and_pays_the_penalty():
    settings = {**SHORT, "trial.health.speed_m_s": 1.0}
    plain, fined = (
        make(settings=settings, actions="torques", disqualification_penalty=fine) for fine in (0, 5)
    )
    full = lambda step: np.full(8, 1000.0, dtype=np.float32)  # noqa: E731
    _, rewards, terminated, info = episode(plain, full)
    _, fined_rewards, _, _ = episode(fined, full)
    assert terminated
    assert info["evaluation"]["disqualified"] == "speed limit exceeded"
    assert info["evaluation"]["on_landing"] is False
    assert rewards.sum() - fined_rewards.sum() == pytest.approx(5)
    with pytest.raises(RuntimeError, match="over: call reset"):
        plain.unwrapped.step(full(0))


def test_actions_beyond_the_space_are_clamped_and_nan_is_refused():
    env = make(actions="torques")
    most = lambda step: env.action_space.high  # noqa: E731
    beyond = lambda step: 3 * env.action_space.high  # noqa: E731
    assert np.array_equal(episode(env, most)[0], episode(env.unwrapped, beyond)[0])
    env.reset()
    action = np.zeros(8, dtype=np.float32)
    action[3] = np.nan
    with pytest.raises(ValueError, match=r"action\[0, 3\] is NaN; allowed: finite numbers"):
        env.unwrapped.step(action)
    with pytest.raises(ValueError, match="action is of shape"):
        env.unwrapped.step(np.zeros(7, dtype=np.float32))
    with pytest.raises(ValueError, match="action is of shape"):
        env.unwrapped.step(np.zeros((2, 8), dtype=np.float32))


def test_a_step_before_the_first_reset_is_refused():
    env = sns.SnakesAndStairsEnv(settings=SHORT)
    with pytest.raises(RuntimeError, match="call reset"):
        env.step(np.zeros(8, dtype=np.float32))


def test_a_servo_holds_the_joints_at_their_targets():
    env = make(stiffness_nm_per_rad=900, settings={**SHORT, "gravity_m_s2": 0})
    target = np.zeros(8, dtype=np.float32)
    target[0], target[4] = 0.3, -0.3
    seen, _, _, _ = episode(env, lambda step: target)
    senses = {sense["name"]: sense for sense in env.unwrapped.senses}
    for name, angle in (("joint 1 bend", 0.3), ("joint 2 bend", 0.0), ("joint 3 bend", -0.3)):
        sense = senses[name]
        assert sense["unit"] == "rad"
        assert seen[-1, sense["index"]] * sense["scale"] == pytest.approx(angle, abs=0.02)
    assert env.unwrapped.servo == (900, 60)


def test_senses_and_parts_of_actions_are_described():
    env = make().unwrapped
    senses = env.senses
    assert len(senses) == env.observation_space.shape[0] == 60
    names = [sense["name"] for sense in senses]
    assert names[0] == "joint 1 bend" and names[16] == "block 1 touch" and names[-1] == "aside"
    assert [sense["index"] for sense in senses] == list(range(60))
    assert senses[names.index("block 2 gap")]["unit"] == "m"
    parts = env.action_parts
    assert [part["name"] for part in parts[:3]] == ["joint 1 bend", "joint 1 twist", "joint 2 bend"]
    assert {part["unit"] for part in parts} == {"rad"}
    assert [part["limit"] for part in parts] == env.action_space.high.tolist()
    torques = make(actions="torques").unwrapped
    assert {part["unit"] for part in torques.action_parts} == {"N·m"}
    assert torques.action_space.high[0] == 1000


@pytest.mark.parametrize("actions", ["targets", "torques"])
def test_an_axis_that_cannot_move_can_be_rescaled(actions):
    env = make(preset="thick-air", actions=actions)
    assert (env.action_space.high > env.action_space.low).all()
    if actions == "targets":
        twist = env.unwrapped.action_parts[1]
        assert twist["name"] == "joint 1 twist" and twist["limit"] == 0
        assert env.action_space.high[1] == np.float32(1e-4)
    rescaled = gymnasium.wrappers.RescaleAction(env, -1.0, 1.0)
    rescaled.reset(seed=1)
    for _ in range(5):
        senses = rescaled.step(np.ones(8, dtype=np.float32))[0]
    assert np.isfinite(senses).all()


def test_every_sense_has_a_scale_and_forces_say_where_they_are_half():
    env = make(settings={**SHORT, "gravity_m_s2": 9.0}).unwrapped
    assert all(sense["scale"] > 0 for sense in env.senses)
    senses = {sense["name"]: sense for sense in env.senses}
    for name in ("block 1 load", "block 5 blocked"):
        sense = senses[name]
        assert (sense["unit"], sense["scale"], sense["low"], sense["high"]) == ("", 1.0, 0.0, 1.0)
        settings = env.problem.settings
        length, width, height = (
            float(settings[f"trial.agent.limb_{side}_m"]) for side in ("length", "width", "height")
        )
        ends = [float(settings[f"genome.density_{end}_kg_m3"]) for end in ("min", "max")]
        assert sense["half_force_n"] == pytest.approx(length * width * height * sum(ends) / 2 * 9.0)
    assert senses["block 1 gap"]["half_force_n"] is None


def test_observations_stay_within_their_space():
    env = make(preset="trampoline", actions="torques", settings={"trial.duration_s": 5})
    rng = np.random.default_rng(3)
    low, high = env.action_space.low, env.action_space.high
    seen, _, _, _ = episode(env, lambda step: rng.uniform(low, high).astype(np.float32))
    assert len(seen) > 20
    assert all(env.observation_space.contains(senses) for senses in seen)


def test_stairs_and_settings_change_the_world():
    with_steps = make(stairs={"steps": 3, "rise_m": [0.2, 0.4, 0.3]}).unwrapped
    assert with_steps.problem.settings["trial.stairs.steps"] == "3"
    assert with_steps.problem.settings["trial.stairs.rise_m"] == "[0.2, 0.4, 0.3]"
    longer = make(settings={**SHORT, "agent.limbs": 7, "trial.start_y_m": np.float32(-9)}).unwrapped
    assert longer.action_space.shape == (12,)
    longer.reset()
    assert longer.poses().shape == (7, 7)
    assert longer.poses()[3, 1] == pytest.approx(-9)


def test_s9_a_seed_of_numpy_is_that_of_python():
    env = make(perturbation=True)
    starts = []
    for seed in (5, np.int64(5), np.uint8(5)):
        env.reset(seed=seed)
        starts.append(env.unwrapped.poses().tolist())
    assert starts[0] == starts[1] == starts[2]
    for seed in (5.0, np.float32(5), np.int64(-5)):
        with pytest.raises(Exception, match="Seed must be"):
            env.reset(seed=seed)


def test_perturbations_follow_the_seed():
    env = make(perturbation={"start_m": 1.0})
    starts = []
    for seed in (1, None, None, 1, 2):
        env.reset(seed=seed)
        starts.append(tuple(env.unwrapped.poses()[2, :2]))
    assert starts[0] == starts[3], "the same seed"
    assert len(set(starts)) == 4, "every other episode starts elsewhere"
    assert all(abs(x) <= 1 and abs(y + 7.23) <= 1 for x, y in starts)
    fixed = make()
    fixed.reset(seed=1)
    here = fixed.unwrapped.poses()
    fixed.reset(seed=2)
    assert np.array_equal(here, fixed.unwrapped.poses())


@pytest.mark.parametrize(
    "arguments, message",
    [
        ({"preset": "climbb"}, 'preset is "climbb"; allowed: climb,'),
        ({"stairs": {"steps": -1}}, r"trial.stairs.steps is .*-1.*; allowed: 0 to"),
        ({"stairs": {"step": 3}}, "trial.stairs.step"),
        ({"stairs": [3]}, "stairs is a list; allowed: a dictionary"),
        ({"settings": {"surface.friction": float("nan")}}, "trial.surface.friction is"),
        ({"settings": {"evolution.population": 5}}, "an environment has no genome and no search"),
        ({"settings": {"genome.wave.harmonics": 3}}, "an environment has no genome and no search"),
        ({"settings": {"repeats.trials": 3}}, "an environment has no genome and no search"),
        ({"settings": {"surface.friction": object()}}, "surface.friction is a object; allowed: a number"),
        ({"body": -1}, "body is -1; allowed: None, a seed, a champion or the path of its file"),
        ({"body": SAVES / "six.ron", "settings": {"agent.limbs": 7}}, "settings is of trial.agent; allowed: no settings"),
        ({"actions": "muscles"}, 'actions is "muscles"; allowed: targets, torques'),
        ({"steps_per_action": 0}, "steps_per_action is 0; allowed: 1 to 1000"),
        ({"steps_per_action": -1}, "steps_per_action is -1; allowed: 1 to 1000"),
        ({"steps_per_action": 2**64}, "steps_per_action is 18446744073709551616; allowed: 1 to 1000"),
        ({"stiffness_nm_per_rad": -1}, "stiffness_nm_per_rad is -1; allowed: 0 to 100000"),
        ({"actions": "torques", "damping_nms_per_rad": 5}, "damping_nms_per_rad is 5; allowed: None"),
        ({"perturbation": {"friction": 2}}, "perturbation.friction is 2; allowed: 0 to 0.9"),
        ({"perturbation": {"wind": 2}}, 'perturbation is "wind"'),
        ({"perturbation": 3}, "perturbation is a int; allowed: a dictionary"),
        ({"disqualification_penalty": float("inf")}, "disqualification_penalty is inf; allowed: 0 to"),
        ({"render_mode": "ansi"}, "render_mode is 'ansi'; allowed: None, "),
        ({"render_mode": "human", "perturbation": True}, "render_mode is 'human'; allowed: None, 'rgb_array'; 'human' needs one"),
    ],
)
def test_what_is_not_allowed_is_refused_in_one_line(arguments, message):
    with pytest.raises(ValueError, match=message) as error:
        sns.SnakesAndStairsEnv(**arguments)
    assert "\n" not in str(error.value)


def test_options_of_reset_are_refused():
    with pytest.raises(ValueError, match="options is"):
        make().unwrapped.reset(options={"low": 1})
