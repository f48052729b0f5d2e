"""Compares the speed of physics engines, one snake and one thread: lanes and rapier here, MuJoCo and the Open Dynamics Engine.

    speed.py PROGRAM CHAMPION.ron

All take 240 steps a second with the champion's body, stairs and commanded torques. MuJoCo and ODE simulate no air, and keep no
records. PROGRAM is `snakes`. Needs MuJoCo (requirements.txt), and for ODE a C compiler and Debian's libode-dev. Prints a table in
Markdown: simulated seconds per second, medians of five rounds in turn.
"""

import csv
import json
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

_here = pathlib.Path(__file__).resolve().parent
# mujoco.py in this folder has the name of the package.
sys.path = [entry for entry in sys.path if pathlib.Path(entry or ".").resolve() != _here]

import mujoco  # noqa: E402
import numpy  # noqa: E402
from mujoco import rollout  # noqa: E402

STEPS_PER_S = 240
ROUNDS = 5


def at_240_hz(text, engine):
    """The champion with 240 steps a second, one substep each, in one of the engines of `snakes`."""
    text, count = re.subn(r"steps_per_s: \d+,\s*substeps: \d+", f"steps_per_s: {STEPS_PER_S}, substeps: 1", text)
    assert count == 1, "the champion's file names its step rate once"
    text = re.sub(r"engine: (lanes|rapier),", "", text)
    return text.replace("physics: (", f"physics: (engine: {engine},", 1)


def recorded_torques(path):
    """The commanded torques of each step: bend and twist of each joint, in N·m."""
    rows = {}
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row["joint_bend_torque_nm"]:
                torques = (float(row["joint_bend_torque_nm"]), float(row["joint_twist_torque_nm"]))
                rows.setdefault(int(row["step"]), []).extend(torques)
    return numpy.array([rows[step] for step in sorted(rows) if step > 0])


def scene_of_ode(model, data, torques):
    """The scene that ode_speed.c reads."""
    geoms = range(model.ngeom)
    boxes = [geom for geom in geoms if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_BOX]
    solids = [geom for geom in boxes if model.geom_bodyid[geom] == 0]
    limbs = [geom for geom in boxes if model.geom_bodyid[geom] != 0]
    ground = model.geom("ground")
    damping = model.dof_damping[-1]
    numbers = [model.opt.timestep, -model.opt.gravity[2], ground.friction[0], damping, len(solids)]
    for geom in solids:
        numbers += [*data.geom_xpos[geom], *(2.0 * model.geom_size[geom])]
    numbers.append(len(limbs))
    for geom in limbs:
        numbers += [*data.geom_xpos[geom], *(2.0 * model.geom_size[geom]), model.body_mass[model.geom_bodyid[geom]]]
    for number in range(1, len(limbs)):
        bend, twist = model.joint(f"bend {number}").id, model.joint(f"twist {number}").id
        numbers += [*data.xanchor[bend], *data.xaxis[bend], *data.xaxis[twist]]
        numbers += [model.jnt_range[bend][1], model.jnt_range[twist][1]]
    numbers.append(len(torques))
    return " ".join(str(float(value)) for value in [*numbers, *torques.flatten()])


def main(program, champion):
    text = pathlib.Path(champion).read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        files = {}
        for engine in ["lanes", "rapier"]:
            files[engine] = folder / f"{engine}.ron"
            files[engine].write_text(at_240_hz(text, engine), encoding="utf-8")
        model_file, motion = folder / "model.xml", folder / "motion.csv"
        for target in [model_file, motion]:
            subprocess.run([program, "export", files["rapier"], "-o", target], check=True, stdout=subprocess.DEVNULL)
        torques = recorded_torques(motion)
        model = mujoco.MjModel.from_xml_path(str(model_file))
        assert abs(model.opt.timestep - 1.0 / STEPS_PER_S) < 1e-9 and torques.shape[1] == model.nu
        data = mujoco.MjData(model)
        mujoco.mj_resetDataKeyframe(model, data, 0)
        mujoco.mj_forward(model, data)
        state = numpy.zeros(mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS))
        mujoco.mj_getState(model, data, state, mujoco.mjtState.mjSTATE_FULLPHYSICS)
        simulated_s = len(torques) / STEPS_PER_S
        scene = scene_of_ode(model, data, torques)
        ode = folder / "ode_speed"
        compiler = ["cc", "-O2", _here / "ode_speed.c", "-o", ode, "-lode", "-lm"]
        has_ode = shutil.which("cc") is not None and subprocess.run(compiler, check=False).returncode == 0
        if not has_ode:
            print("ODE is left out: ode_speed.c could not be compiled", file=sys.stderr)
        rates = {}

        def count(name, rate):
            rates.setdefault(name, []).append(rate)

        for _ in range(ROUNDS):
            for engine, file in files.items():
                bench = [program, "bench", file, "--threads", "1", "--json"]
                found = json.loads(subprocess.run(bench, check=True, capture_output=True, text=True).stdout)
                count(f"`{engine}`", found["one_thread_sim_s_per_s"])
            began = time.perf_counter()
            rollout.rollout(model, data, state.reshape(1, -1), torques.reshape(1, *torques.shape))
            count(f"MuJoCo {mujoco.__version__}", simulated_s / (time.perf_counter() - began))
            for method, name in [("quick", "ODE, `dWorldQuickStep`"), ("exact", "ODE, `dWorldStep`")] if has_ode else []:
                found = subprocess.run([ode, method], input=scene, check=True, capture_output=True, text=True).stdout
                seconds, head_y_m = (float(part) for part in found.split())
                assert abs(head_y_m) < 1000.0, f"{name}: the head is at {head_y_m} m"
                count(name, simulated_s / seconds)
    print("| engine | simulated seconds per second |\n|---|---:|")
    for name, found in rates.items():
        print(f"| {name} | {statistics.median(found):,.0f} |")


if __name__ == "__main__":
    main(*sys.argv[1:])
