"""Many worlds as one Gymnasium environment."""

import os
import sys

import gymnasium
import numpy as np
import pytest
from conftest import SHORT
from gymnasium.vector import AutoresetMode

import snakes_and_stairs as sns


def make(num_envs=3, **arguments):
    arguments.setdefault("settings", SHORT)
    return gymnasium.make_vec("SnakesAndStairs-v0", num_envs=num_envs, **arguments)


def actions(count, worlds=3, seed=5):
    rng = np.random.default_rng(seed)
    return rng.uniform(-0.8, 0.8, (count, worlds, 8)).astype(np.float32)


def test_make_vec_makes_the_parallel_environment():
    envs = make(4)
    assert isinstance(envs.unwrapped, sns.SnakesAndStairsVectorEnv)
    assert envs.observation_space.shape == (4, 60)
    assert envs.action_space.shape == (4, 8)
    assert envs.single_action_space.shape == (8,)
    senses, infos = envs.reset(seed=1)
    assert envs.observation_space.contains(senses)
    assert infos["y_m"].shape == (4,)
    envs.close()


def test_each_world_has_the_bits_of_a_single_environment():
    perturbation = {"friction": 0.3, "start_m": 0.3, "turn_deg": 10}
    envs = make(3, perturbation=perturbation, steps_per_action=4)
    singles = [
        gymnasium.make(
            "SnakesAndStairs-v0", settings=SHORT, perturbation=perturbation, steps_per_action=4
        )
        for _ in range(3)
    ]
    senses, _ = envs.reset(seed=10)
    for index, single in enumerate(singles):
        assert np.array_equal(single.reset(seed=10 + index)[0], senses[index])
    ended = np.zeros(3, dtype=bool)
    evaluations = 0
    # Longer than two episodes of 30 actions.
    for batch in actions(70):
        senses, rewards, terminated, truncated, infos = envs.step(batch)
        for index, single in enumerate(singles):
            if ended[index]:
                assert np.array_equal(single.reset()[0], senses[index]), "the next episode begins"
                assert rewards[index] == 0 and not terminated[index] and not truncated[index]
                continue
            of_one = single.step(batch[index])
            assert np.array_equal(of_one[0], senses[index])
            assert of_one[1:4] == (rewards[index], terminated[index], truncated[index])
            if "evaluation" in of_one[4]:
                assert infos["_evaluation"][index]
                evaluation = {name: infos["evaluation"][name][index] for name in of_one[4]["evaluation"]}
                assert of_one[4]["evaluation"] == evaluation
                evaluations += 1
            assert of_one[4]["y_m"] == infos["y_m"][index]
        ended = terminated | truncated
    assert evaluations >= 6


def test_threads_change_no_bit():
    def trace(threads):
        envs = make(5, threads=threads)
        envs.reset(seed=1)
        return [envs.step(batch)[0].tobytes() for batch in actions(40, worlds=5)]

    assert trace(1) == trace(2) == trace(7)


def test_same_step_autoreset_gives_the_last_observation_as_information():
    next_step, same_step = make(), make(autoreset_mode=AutoresetMode.SAME_STEP)
    assert same_step.metadata["autoreset_mode"] is AutoresetMode.SAME_STEP
    first, _ = next_step.reset(seed=1)
    same_step.reset(seed=1)
    for batch in actions(120):
        before = next_step.step(batch)
        after = same_step.step(batch)
        assert np.array_equal(before[1], after[1])
    assert before[3].all() and after[3].all()
    assert np.array_equal(after[0], first), "every episode starts alike"
    assert after[4]["_final_obs"].all()
    assert np.array_equal(np.stack(after[4]["final_obs"]), before[0])
    final = after[4]["final_info"]["evaluation"]["trace_hash"]
    assert final.tolist() == before[4]["evaluation"]["trace_hash"].tolist()


def test_without_autoreset_a_mask_says_what_to_reset():
    envs = make(autoreset_mode=AutoresetMode.DISABLED)
    envs.reset(seed=1)
    for batch in actions(120):
        senses, _, _, truncated, _ = envs.step(batch)
    assert truncated.all()
    with pytest.raises(RuntimeError, match=r"episodes of worlds \[0, 1, 2\] are over"):
        envs.step(batch)
    mask = np.array([True, False, True])
    begun, _ = envs.reset(options={"reset_mask": mask})
    assert np.array_equal(begun[1], senses[1])
    assert not np.array_equal(begun[0], senses[0])
    with pytest.raises(RuntimeError, match=r"episodes of worlds \[1\] are over"):
        envs.step(batch)
    envs.reset(options={"reset_mask": ~mask})
    envs.step(batch)


def test_seeds_and_masks_of_the_wrong_shape_are_refused():
    envs = make().unwrapped
    with pytest.raises(ValueError, match="seed is a list of 2; allowed: 3"):
        envs.reset(seed=[1, 2])
    with pytest.raises(ValueError, match="reset_mask is of shape"):
        envs.reset(options={"reset_mask": np.zeros(3, dtype=bool)})
    with pytest.raises(ValueError, match="allowed: reset_mask"):
        envs.reset(options={"mask": 1})
    envs.reset(seed=[1, None, 2])
    with pytest.raises(ValueError, match="action is of shape"):
        envs.step(np.zeros((3, 7), dtype=np.float32))
    bad = np.zeros((3, 8), dtype=np.float32)
    bad[2, 1] = np.inf
    with pytest.raises(ValueError, match=r"action\[2, 1\] is inf; allowed: finite numbers"):
        envs.step(bad)
    with pytest.raises(ValueError, match="seed is -1; allowed: None, or 0 and greater"):
        envs.reset(seed=-1)
    for count in (0, -1, 2**64):
        with pytest.raises(ValueError, match=f"num_envs is {count}; allowed: 1 to 65536"):
            sns.SnakesAndStairsVectorEnv(count)
    for threads in (0, -1):
        with pytest.raises(ValueError, match=f"threads is {threads}; allowed"):
            sns.SnakesAndStairsVectorEnv(2, threads=threads)


def test_poses_of_a_world_that_there_is_not_are_refused():
    envs = make().unwrapped
    with pytest.raises(RuntimeError, match="poses before reset"):
        envs.poses(1)
    envs.reset(seed=1)
    assert envs.poses(2).shape == (5, 7)
    for index in (-1, 3, 99):
        with pytest.raises(ValueError, match=f"index is {index}; allowed: 0 to 2"):
            envs.poses(index)


def test_numbers_of_worlds_are_no_mask():
    envs = make(autoreset_mode=AutoresetMode.DISABLED)
    envs.reset(seed=1)
    for mask in ([0, 1, 2], [True, False, True], np.array([0, 1, 2]), np.ones(3), None):
        with pytest.raises(TypeError, match="reset_mask is .*; allowed: an array of 3 bools"):
            envs.reset(options={"reset_mask": mask})


def same_infos(its, ours):
    """Whether two dictionaries of information are equal, arrays within dictionaries included."""
    assert its.keys() == ours.keys()
    for name, values in its.items():
        if isinstance(values, dict):
            same_infos(values, ours[name])
        elif name == "final_obs":
            for one, other in zip(values, ours[name]):
                assert np.array_equal(one, other) if one is not None else other is None
        else:
            assert values.dtype == ours[name].dtype, name
            assert values.tolist() == ours[name].tolist(), name


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_information_is_that_of_gymnasiums_own_vectorisation(mode):
    # The worlds end at different times.
    settings = {**SHORT, "trial.health.speed_m_s": 1.0}
    arguments = {"settings": settings, "perturbation": True, "actions": "torques"}
    own = gymnasium.make_vec(
        "SnakesAndStairs-v0",
        num_envs=3,
        vectorization_mode="sync",
        vector_kwargs={"autoreset_mode": mode},
        **arguments,
    )
    envs = make(3, autoreset_mode=mode, **arguments)
    same_infos(own.reset(seed=4)[1], envs.reset(seed=4)[1])
    assert envs.np_random_seed == own.np_random_seed == (4, 5, 6)
    ends = partial_ends = 0
    for batch in 1000 * actions(150):
        its, ours = own.step(batch), envs.step(batch)
        assert np.array_equal(its[0], ours[0])
        same_infos(its[4], ours[4])
        ended = ours[2] | ours[3]
        ends += int(ended.sum())
        partial_ends += int(ended.any() and not ended.all())
        if mode is AutoresetMode.DISABLED and ended.any():
            its, ours = (of.reset(options={"reset_mask": ended.copy()}) for of in (own, envs))
            assert np.array_equal(its[0], ours[0])
            same_infos(its[1], ours[1])
    assert ends > 3 and partial_ends > 1
    own.close()


def test_seeds_are_those_of_the_worlds():
    envs = make().unwrapped
    before = envs.np_random_seed
    assert len(set(before)) == 3 and envs.np_random_seed == before
    envs.reset(seed=[7, None, 9])
    assert envs.np_random_seed == (7, before[1], 9)
    assert len(envs.np_random) == 3


def test_a_refused_step_leaves_the_worlds_as_they_were():
    envs, undisturbed = make().unwrapped, make().unwrapped
    envs.reset(seed=1)
    undisturbed.reset(seed=1)
    bad = np.full((3, 8), np.nan, dtype=np.float32)
    with pytest.raises(ValueError):
        envs.step(bad)
    for batch in actions(10):
        assert np.array_equal(envs.step(batch)[0], undisturbed.step(batch)[0])


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no fork")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_worlds_go_on_in_a_forked_process():
    envs = make(4, threads=2).unwrapped
    envs.reset(seed=1)
    batch = actions(1, worlds=4)[0]
    envs.step(batch)
    child = os.fork()
    if child == 0:
        envs.step(batch)
        os._exit(0)
    _, status = os.waitpid(child, 0)
    assert status == 0
    envs.step(batch)


@pytest.mark.parametrize("mode", ["sync", "async"])
def test_gymnasiums_own_vectorisation_gives_the_same_bits(mode):
    own = gymnasium.make_vec(
        "SnakesAndStairs-v0", num_envs=2, vectorization_mode=mode, settings=SHORT, perturbation=True
    )
    envs = make(2, perturbation=True)
    assert np.array_equal(own.reset(seed=3)[0], envs.reset(seed=3)[0])
    for batch in actions(130, worlds=2):
        its, ours = own.step(batch), envs.step(batch)
        assert np.array_equal(its[0], ours[0])
        if ours[3].all():
            for name, values in its[4]["evaluation"].items():
                assert values.tolist() == ours[4]["evaluation"][name].tolist(), name
    own.close()


def test_gymnasiums_vector_wrappers_work():
    envs = gymnasium.wrappers.vector.RecordEpisodeStatistics(make())
    envs.reset(seed=1)
    for batch in actions(120):
        _, _, _, truncated, infos = envs.step(batch)
    assert truncated.all()
    assert (infos["episode"]["l"] == 120).all()
