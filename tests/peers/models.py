"""Compares exported models with the bodies from which they were made: `models.py FOLDER`.

For each NAME.json, which the test `exports::models` of Snakes & Stairs writes, it loads NAME.xml and NAME.urdf in MuJoCo
and makes five checks. The bounds are in the code. It prints the greatest differences, and every failure with its number.
"""

import json
import math
import pathlib
import re
import sys

# Beside this file lies a script with the name of the package.
sys.path = [entry for entry in sys.path if entry != str(pathlib.Path(__file__).resolve().parent)]

import mujoco  # noqa: E402
import numpy  # noqa: E402


# Places along the snake add up numbers of 32 bits, which are a micrometre apart at ten metres.
PLACE_M = 5e-6


class Checks:
    """Failures, and the greatest difference of each kind."""

    def __init__(self):
        self.failures, self.worst, self.name = [], {}, ""

    def equal(self, what, found, expected):
        if found != expected:
            self.failures.append(f"{self.name}: {what} is {found}; expected: {expected}")

    def near(self, what, found, expected, bound):
        found, expected = numpy.asarray(found, float), numpy.asarray(expected, float)
        if found.shape != expected.shape:
            self.failures.append(f"{self.name}: {what} has shape {found.shape}; expected: {expected.shape}")
            return
        off = float(numpy.max(numpy.abs(found - expected))) if found.size else 0.0
        self.worst[what] = max(self.worst.get(what, 0.0), off)
        if not off <= bound:
            self.failures.append(f"{self.name}: {what} is off by {off:.6g}; allowed: {bound:g}")

    def relative(self, what, found, expected, bound):
        self.near(what, numpy.asarray(found) / numpy.asarray(expected), numpy.ones_like(expected), bound)


def names(items, count):
    return [items(index).name for index in range(count)]


def principal(model, body):
    """The inertia of a body about its own axes; MuJoCo sorts the moments and turns the frame accordingly."""
    turn = numpy.zeros(9)
    mujoco.mju_quat2Mat(turn, model.body_iquat[body])
    turn = turn.reshape(3, 3)
    return numpy.diag(turn @ numpy.diag(model.body_inertia[body]) @ turn.T)


def structure(checks, model, expected):
    """Check 1: counts and names in order, masses, inertias, centre of mass, limits, stairs."""
    limbs, joints = len(expected["limbs"]), len(expected["joints"])
    axes = [f"{axis} {joint + 1}" for joint in range(joints) for axis in ("bend", "twist")]
    checks.equal("bodies", names(model.body, model.nbody), ["world"] + [f"limb {limb + 1}" for limb in range(limbs)])
    checks.equal("joints", names(model.joint, model.njnt), ["free", *axes])
    checks.equal("motors", names(model.actuator, model.nu), axes)
    checks.relative("masses", model.body_mass[1:], [limb["kg"] for limb in expected["limbs"]], 1e-6)
    inertias = [principal(model, body) for body in range(1, model.nbody)]
    checks.relative("inertias", inertias, [limb["kg_m2"] for limb in expected["limbs"]], 1e-6)
    checks.relative("total mass", model.body_mass.sum(), sum(limb["kg"] for limb in expected["limbs"]), 1e-6)
    # A locked axis needs a range that is not empty.
    limits = [max(joint[f"{axis}_limit_rad"], 1e-4) for joint in expected["joints"] for axis in ("bend", "twist")]
    checks.near("limits", model.jnt_range[1:, 1], limits, 1e-6)
    checks.near("limits", -model.jnt_range[1:, 0], limits, 1e-6)
    checks.relative("dampings", model.dof_damping[6:], [joint["damping"] for joint in expected["joints"] for _ in axes[:2]], 1e-6)
    torques = [joint[f"{axis}_nm"] for joint in expected["joints"] for axis in ("bend", "twist")]
    checks.relative("torques", model.actuator_ctrlrange[:, 1], torques, 1e-6)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    checks.near("places at the start", data.xpos[1:], [limb["at_m"] for limb in expected["limbs"]], PLACE_M)
    checks.near("centre of mass", data.subtree_com[0], expected["centre_m"], 1e-6)
    steps = [geom for geom in range(model.ngeom) if model.geom(geom).name.startswith("step ")]
    found = [[*(model.geom_pos[geom] - model.geom_size[geom]), *(model.geom_pos[geom] + model.geom_size[geom])] for geom in steps]
    checks.near("stairs", numpy.reshape(found, (-1, 6)), numpy.reshape(expected["steps"], (-1, 6)), 1e-5)
    checks.relative("friction of limbs", model.pair_friction[:, 0], [expected["skin_friction"] ** 2] * model.npair, 1e-6)
    checks.equal("pairs of limbs", model.npair, (limbs - 1) * (limbs - 2) // 2)


def soft_structure(checks, model, expected):
    """Check 1 for soft limbs: counts and names in order, masses, inertias, centre of mass, springs, pairs."""
    parts, joints = expected["limbs"], len(expected["joints"])
    checks.equal("bodies", names(model.body, model.nbody), ["world", *expected["bodies"]])
    checks.equal("joints", names(model.joint, model.njnt), ["free", *(hinge[0] for hinge in expected["hinges"])])
    checks.equal("motors", names(model.actuator, model.nu), [f"{axis} {joint + 1}" for joint in range(joints) for axis in ("bend", "twist")])
    checks.relative("masses", model.body_mass[1:], [part["kg"] for part in parts], 1e-6)
    inertias = [principal(model, body) for body in range(1, model.nbody)]
    checks.relative("inertias", inertias, [part["kg_m2"] for part in parts], 1e-6)
    checks.near("stiffnesses, relative", model.jnt_stiffness[1:] / numpy.maximum(1.0, [hinge[1] for hinge in expected["hinges"]]), [float(hinge[1] > 0.0) for hinge in expected["hinges"]], 1e-6)
    checks.relative("dampings", model.dof_damping[6:], [hinge[2] for hinge in expected["hinges"]], 1e-6)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    checks.near("places at the start", data.xpos[1:], [part["at_m"] for part in parts], PLACE_M)
    checks.near("centre of mass", data.subtree_com[0], expected["centre_m"], 1e-5)
    checks.equal("pairs of parts", model.npair, expected["pairs"])


def tree_structure(checks, model, expected):
    """Check 1 for creatures, whose bodies MuJoCo orders branch by branch: masses, inertias, places, limits and torques by
    name."""
    limbs, joints = range(1, len(expected["limbs"]) + 1), range(1, len(expected["joints"]) + 1)
    checks.equal("bodies", sorted(names(model.body, model.nbody)), sorted(["world", *(f"limb {limb}" for limb in limbs)]))
    bodies = [model.body(f"limb {limb}").id for limb in limbs]
    checks.relative("masses", model.body_mass[bodies], [limb["kg"] for limb in expected["limbs"]], 1e-6)
    checks.relative("inertias", [principal(model, body) for body in bodies], [limb["kg_m2"] for limb in expected["limbs"]], 1e-6)
    for axis in ("bend", "twist"):
        hinges = [model.joint(f"{axis} {joint}").id for joint in joints]
        # A locked axis needs a range that is not empty, and a motor that it may have no torque.
        limits = [max(joint[f"{axis}_limit_rad"], 1e-4) for joint in expected["joints"]]
        checks.near("limits", model.jnt_range[hinges, 1], limits, 1e-6)
        torques = [max(joint[f"{axis}_nm"], 1e-6) for joint in expected["joints"]]
        motors = [model.actuator(f"{axis} {joint}").id for joint in joints]
        checks.relative("torques", model.actuator_ctrlrange[motors, 1], torques, 1e-6)
    data = raised(model, 0.0)
    mujoco.mj_forward(model, data)
    checks.near("places at the start", data.xpos[bodies], [limb["at_m"] for limb in expected["limbs"]], PLACE_M)
    checks.near("centre of mass", data.subtree_com[0], expected["centre_m"], 1e-5)


def raised(model, height_m):
    """The start, high above the ground."""
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    data.qpos[2] += height_m
    return data


def free_fall(checks, model, expected):
    """Check 2: one second of free fall."""
    data = raised(model, 10.0)
    mujoco.mj_forward(model, data)
    start = data.subtree_com[0][2]
    for _ in range(round(1.0 / model.opt.timestep)):
        mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)
    fallen = data.subtree_com[0][2] - start
    step_s, gravity = model.opt.timestep, -model.opt.gravity[2]
    checks.near("free fall, and its closed form", fallen, -gravity * (1.0 + step_s) / 2.0, 1e-4)
    # Springs call for shorter steps there than here.
    here_s = 1.0 / 240.0
    checks.near("free fall, here and its closed form", expected["fallen_m"], -gravity * (1.0 + here_s) / 2.0, 1e-4)
    if step_s == here_s:
        checks.near("free fall, here and there", fallen, expected["fallen_m"], 1e-4)


def pendulum_reference(limb, gravity, times):
    """The bend of a limb that hangs on a hinge and starts level, by Runge and Kutta's fourth order."""
    _, length, height = limb["size_m"]
    moment = (length**2 + height**2) / 12.0 + length**2 / 4.0
    pull = gravity * length / 2.0 / moment
    bend, rate, time, found = 0.0, 0.0, 0.0, []
    step = 1.0 / 4800.0

    def slope(bend, rate):
        return rate, pull * math.cos(bend)

    for wanted in times:
        while time < wanted - step / 2.0:
            a = slope(bend, rate)
            b = slope(bend + a[0] * step / 2, rate + a[1] * step / 2)
            c = slope(bend + b[0] * step / 2, rate + b[1] * step / 2)
            d = slope(bend + c[0] * step, rate + c[1] * step)
            bend += (a[0] + 2 * b[0] + 2 * c[0] + d[0]) * step / 6
            rate += (a[1] + 2 * b[1] + 2 * c[1] + d[1]) * step / 6
            time += step
        found.append(bend)
    return numpy.array(found)


def pendulum(checks, text, expected):
    """Check 3: two limbs, of which the first is clamped, without damping, until the limit is near."""
    model = mujoco.MjModel.from_xml_string(text.replace('<freejoint name="free"/>', ""))
    checks.equal("joints of the pendulum", names(model.joint, model.njnt), ["bend 1", "twist 1"])
    # Away from the ground.
    model.body_pos[1, 2] += 20.0
    data = mujoco.MjData(model)
    substeps = expected["substeps"]
    here = numpy.array(expected["pendulum_rad"])
    times = [(step + 1) * substeps * model.opt.timestep for step in range(len(here))]
    there = []
    for _ in times:
        for _ in range(substeps):
            mujoco.mj_step(model, data)
        there.append(float(data.qpos[0]))
    reference = pendulum_reference(expected["limbs"][1], -model.opt.gravity[2], times)
    limit = expected["joints"][0]["bend_limit_rad"]
    reached = numpy.flatnonzero(reference > limit - 0.05)
    until = int(reached[0]) if reached.size else len(times)
    checks.equal("pendulum swings", until >= 3, True)
    checks.near("pendulum, there and by Runge and Kutta", there[:until], reference[:until], 0.02)
    checks.near("pendulum, here and by Runge and Kutta", here[:until], reference[:until], 0.02)


def free_limbs(checks, model, expected):
    """Check 4: no gravity, damped joints, sines of torque on the bends for two seconds.

    MuJoCo's integrator is of first order: with springs its own error is as large as the bound, so its steps are shorter here."""
    finer = 2 if "hinges" in expected else 1
    model.opt.timestep /= finer
    model.opt.gravity[:] = 0.0
    data = raised(model, 20.0)
    bends = [model.joint(f"bend {joint + 1}").qposadr[0] for joint in range(len(expected["joints"]))]
    if "start_rad" in expected:
        # Contacts are seen 2 cm before they push: that is how early the other engine foresees them.
        model.pair_margin[:], model.pair_gap[:] = 0.02, 0.02
    there, touching = [], False
    for torques in expected["bend_torques_nm"]:
        data.ctrl[0::2] = torques
        for _ in range(expected["substeps"] * finer):
            mujoco.mj_step(model, data)
            touching |= data.ncon > 0
        there.append(numpy.array(data.qpos[bends]))
    if "start_rad" in expected and touching:
        # Branches that come close to each other may touch in one engine and not in the other, and contacts differ.
        checks.worst["creatures whose branches touch"] = checks.worst.get("creatures whose branches touch", 0) + 1
        return
    limits = numpy.array([joint["bend_limit_rad"] for joint in expected["joints"]])
    here = numpy.array(expected["bends_rad"])
    checks.equal("free limbs stay within their limits", bool(numpy.all(numpy.abs(here) < limits)), True)
    checks.worst["greatest bend of free limbs"] = max(checks.worst.get("greatest bend of free limbs", 0.0), float(numpy.abs(here).max()))
    checks.near("bends of free limbs", there, here, 0.01)


def settling(checks, model, expected):
    """Check 5: the limbs come to rest on the ground at the same height as here, and touch it with the right friction.

    Limbs of unequal heights rest on edges, in one of several ways; those must not sink in."""
    data = mujoco.MjData(model)
    frictions = []
    for _ in range(round(expected["settled_s"] / model.opt.timestep)):
        mujoco.mj_step(model, data)
        frictions += [contact.friction[0] for contact in data.contact if 0 in model.geom_bodyid[contact.geom]]
    sizes = numpy.array([limb["size_m"] for limb in expected["limbs"]])
    if numpy.ptp(sizes[:, 2]) == 0.0:
        checks.near("heights at rest", data.xpos[1:, 2], expected["settled_z_m"], 0.005)
        checks.near("half heights at rest", data.xpos[1:, 2], sizes[:, 2] / 2.0, 0.005)
    reach = numpy.abs(data.xmat[1:].reshape(-1, 3, 3)[:, 2, :]) * sizes / 2.0
    sunk = numpy.minimum(data.xpos[1:, 2] - reach.sum(axis=1), 0.0)
    checks.near("depth in the ground", sunk, numpy.zeros(len(sizes)), 0.005)
    checks.equal("touches the ground", bool(frictions), True)
    checks.relative("friction of the ground", frictions, [expected["ground_friction"]] * len(frictions), 1e-6)


def freed(text):
    """The model of a URDF whose root moves freely from the start that its comment tells; MuJoCo alone would fix the root."""
    number = r"(-?[\d.e-]+)"
    place = re.search(rf"Start of limb_1 in the world: xyz {number} {number} {number}, rpy 0 0 {number} -->", text)
    x, y, z, turn = (float(part) for part in place.groups())
    spec = mujoco.MjSpec.from_string(text)
    # Links behind fixed joints stay links of their own.
    spec.compiler.fusestatic = False
    root = spec.body("limb_1")
    root.pos, root.quat = [x, y, z], [math.cos(turn / 2), 0, 0, math.sin(turn / 2)]
    root.add_freejoint()
    return spec.compile()


def urdf(checks, model, expected):
    """The URDF: names in order, degrees of freedom, masses, inertias, limits, torques."""
    limbs, joints = len(expected["limbs"]), len(expected["joints"])
    order = ["world", "limb_1"]
    order += [name for joint in range(1, joints + 1) for name in (f"joint_{joint}", f"limb_{joint + 1}")]
    # An axis with a limit of 0 is fixed; every other has its limit, which no program ignores.
    turning = [(joint, axis) for joint in range(joints) for axis in ("bend", "twist") if expected["joints"][joint][f"{axis}_limit_rad"] > 0.0]
    axes = [f"{axis}_{joint + 1}" for joint, axis in turning]
    # The links of a creature are ordered branch by branch.
    sort = sorted if "start_rad" in expected else list
    checks.equal("URDF: links", sort(names(model.body, model.nbody)), sort(order))
    checks.equal("URDF: joints", sort(names(model.joint, model.njnt)), sort(["", *axes]))
    checks.equal("URDF: degrees of freedom", model.nv, 6 + len(axes))
    bodies = [model.body(f"limb_{limb + 1}").id for limb in range(limbs)]
    checks.relative("URDF: masses", model.body_mass[bodies], [limb["kg"] for limb in expected["limbs"]], 1e-6)
    inertias = [principal(model, body) for body in bodies]
    checks.relative("URDF: inertias", inertias, [limb["kg_m2"] for limb in expected["limbs"]], 1e-6)
    limits = [expected["joints"][joint][f"{axis}_limit_rad"] for joint, axis in turning]
    hinges = [model.joint(axis).id for axis in axes]
    checks.equal("URDF: joints have limits", bool(numpy.all(model.jnt_limited[hinges])), True)
    checks.near("URDF: limits", model.jnt_range[hinges, 1], limits, 1e-6)
    torques = [expected["joints"][joint][f"{axis}_nm"] for joint, axis in turning]
    strong = numpy.maximum(torques, 1e-9)
    checks.relative("URDF: torques", numpy.maximum(model.jnt_actfrcrange[hinges, 1], 1e-9), strong, 1e-6)
    data = mujoco.MjData(model)
    for joint, bend_rad in enumerate(expected.get("start_rad", [])):
        if f"bend_{joint + 1}" not in axes:
            continue
        data.qpos[model.joint(f"bend_{joint + 1}").qposadr[0]] = bend_rad
    mujoco.mj_forward(model, data)
    centres = data.xipos[bodies]
    checks.near("URDF: places at the start", centres, [limb["at_m"] for limb in expected["limbs"]], PLACE_M)


def finish(checks, engine, bodies):
    """Prints the greatest differences and the failures, and returns the exit status."""
    print(f"{engine}, {bodies} bodies; greatest differences:")
    for what, off in checks.worst.items():
        print(f"  {what}: {off:.3g}")
    for failure in checks.failures:
        print(failure)
    print(f"{len(checks.failures)} failures")
    return 1 if checks.failures or not bodies else 0


def main(folder):
    checks = Checks()
    descriptions = sorted(pathlib.Path(folder).glob("*.json"))
    for path in descriptions:
        checks.name = path.stem
        expected = json.loads(path.read_text(encoding="utf-8"))
        text = path.with_suffix(".xml").read_text(encoding="utf-8")
        model = mujoco.MjModel.from_xml_string(text)
        if "start_rad" in expected:
            tree_structure(checks, model, expected)
            free_fall(checks, model, expected)
            free_limbs(checks, model, expected)
            robot = freed(path.with_suffix(".urdf").read_text(encoding="utf-8"))
            urdf(checks, robot, expected)
            continue
        if "hinges" in expected:
            soft_structure(checks, model, expected)
            free_fall(checks, model, expected)
            free_limbs(checks, model, expected)
            continue
        structure(checks, model, expected)
        free_fall(checks, model, expected)
        settling(checks, model, expected)
        free_limbs(checks, model, expected)
        swing = path.with_name(f"{path.stem}-pendulum.xml").read_text(encoding="utf-8")
        pendulum(checks, swing, expected)
        urdf(checks, freed(path.with_suffix(".urdf").read_text(encoding="utf-8")), expected)
    return finish(checks, f"MuJoCo {mujoco.__version__}", len(descriptions))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
