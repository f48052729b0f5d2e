"""Champions have the same bits in Python and on the command line."""

import json

import numpy as np
import pytest
from conftest import SAVES, SHORT

import snakes_and_stairs as sns

SHIPPED = sorted(SAVES.glob("*.ron"))


def test_champions_are_shipped():
    assert len(SHIPPED) >= 12


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_champion_has_the_trace_hash_of_its_record(path):
    champion = sns.load_champion(str(path))
    results = champion.evaluate()
    recorded = champion.to_dict()["recorded"]
    assert results.trace_hash[0] == recorded["trace_hash"]
    assert results.trace_hash[0] == champion.trace_hash
    assert results.fitness[0] == pytest.approx(recorded["fitness"], rel=1e-6)
    assert results.steps_climbed[0] == recorded["behaviour"]["steps_climbed"]
    assert sns.replay(str(path))["matches"] is True


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_champion_has_the_trace_hash_of_the_command_line(path, snakes):
    printed = json.loads(snakes("replay", path, "--no-render", "--json"))
    results = sns.load_champion(str(path)).evaluate()
    assert results.trace_hash[0] == printed["trace_hash"]
    assert sns.replay(str(path)) == printed


def test_paths_may_be_strings_or_paths():
    path = SAVES / "climber.ron"
    assert sns.load_champion(path).trace_hash == sns.load_champion(str(path)).trace_hash
    assert sns.replay(path) == sns.replay(str(path))


def test_an_edited_champion_does_not_match(tmp_path):
    text = (SAVES / "climber.ron").read_text()
    edited = text.replace("density_kg_m3: 8", "density_kg_m3: 9", 1)
    changed = edited if edited != text else text.replace("density_kg_m3: 9", "density_kg_m3: 8", 1)
    assert changed != text
    path = tmp_path / "edited.ron"
    path.write_text(changed)
    assert sns.replay(str(path))["matches"] is False


def test_a_trajectory_ends_where_the_evaluation_does():
    champion = sns.load_champion(str(SAVES / "climber.ron"))
    motion, results = champion.trajectory(), champion.evaluate()
    moments, limbs, _ = motion["position_m"].shape
    assert moments == results.physics_steps[0] + 1
    assert motion["time_s"][0] == 0.0
    assert motion["position_m"][-1, limbs // 2, 1] == pytest.approx(results.centre_y_m[0])
    assert np.allclose(np.linalg.norm(motion["rotation_xyzw"], axis=2), 1.0, atol=1e-4)
    assert motion["joint_bend_rad"].shape == motion["joint_twist_rate_rad_s"].shape == (moments, limbs - 1)


def test_a_snake_found_from_python_is_replayed_by_the_program(tmp_path, snakes):
    problem = sns.Problem("climb", stairs={"steps": 3}, settings=SHORT)
    genome = problem.random(1, seed=7)
    path = tmp_path / "found.ron"
    problem.save_champion(str(path), genome, seed=7)
    printed = json.loads(snakes("replay", path, "--no-render", "--json"))
    assert printed["matches"] is True
    assert printed["trace_hash"] == problem.evaluate(genome).trace_hash[0]
    # And it comes back as the row that it was.
    again = problem.genome_of(str(path))
    assert problem.evaluate(again).trace_hash[0] == printed["trace_hash"]


def test_a_champion_that_no_row_reaches_is_warned_of(tmp_path):
    problem = sns.Problem("report", settings=SHORT)
    path = tmp_path / "found.ron"
    problem.save_champion(path, np.full(problem.dimension, 0.5))
    text = path.read_text()
    assert "bend_nm: [0.0, " in text
    # Between -1000 and 1000, numbers of 64 bits are about 1e-13 apart.
    path.write_text(text.replace("bend_nm: [0.0, ", "bend_nm: [1.2345e-12, ", 1))
    with pytest.warns(UserWarning, match="no row reaches to the last bit"):
        problem.genome_of(path)


def test_f9_a_name_that_acts_on_a_terminal_is_escaped_in_an_error(tmp_path):
    with pytest.raises(OSError, match="cannot be read") as error:
        sns.load_champion(tmp_path / "\x1b[31mred\u202e.ron")
    assert "\\u001b[31mred\\u202e.ron" in str(error.value) and "\x1b" not in str(error.value)


def test_files_that_cannot_be_read_are_refused_in_one_line(tmp_path):
    with pytest.raises(OSError, match="missing.ron: cannot be read"):
        sns.load_champion(str(tmp_path / "missing.ron"))
    damaged = tmp_path / "damaged.ron"
    damaged.write_text("(kind: ")
    for read in (sns.load_champion, sns.replay):
        with pytest.raises(ValueError, match="damaged or incomplete at line 1") as error:
            read(str(damaged))
        assert "\n" not in str(error.value)
    with pytest.raises(OSError, match="cannot be"):
        problem = sns.Problem("climb", settings=SHORT)
        problem.save_champion(str(tmp_path / "no" / "folder.ron"), problem.random(1))


def test_a_champion_of_another_space_is_refused_with_the_gene():
    problem = sns.Problem("climb", settings={"genome.wave.harmonics": 3})
    with pytest.raises(ValueError, match=r"champion.joints\[0\].bend.harmonics is 2; allowed: 3"):
        problem.genome_of(str(SAVES / "climber.ron"))
