"""Compares ODE's worlds with the bodies from which their models were made: `ode_models.py FOLDER`.

It reads the files that models.py reads, and makes the same checks of ODE, and three more: a block on a slope at the angle of
friction, a joint at its limit, and a damped twist. It prints the greatest differences, and every failure with its number.
"""

import json
import math
import pathlib
import sys

import numpy
from panda3d import core, ode

from ode import World  # Before models.py takes this folder out of the path.
from models import PLACE_M, Checks, finish, pendulum_reference

NAMES = ("friction", "bounce", "bounce_velocity_m_s", "soft_erp", "soft_cfm_m_s_per_n", "slip_m_s_per_n", "dampen_per_s")
HARD = dict(zip(NAMES, (1.0, 0.0, 0.0, 0.25, 0.0, 0.0, 0.0)))
SURFACES = {"stairs": HARD, "ground": HARD, "skin": HARD}
# Above the highest stairs, with room to fall.
HIGH_M = 30.0


def world_of(model, substeps=1, air_per_s=0.0, surfaces=SURFACES):
    return World(ode, core, {"model": model, "substeps": substeps, "air_per_s": air_per_s, "surfaces": surfaces})


def raised(model, expected, gravity=True):
    """A world whose limbs are high above the ground."""
    world = world_of(model, expected["substeps"])
    if not gravity:
        world.world.setGravity(0.0, 0.0, 0.0)
    for limb in world.limbs:
        limb.body.setPosition(limb.body.getPosition() + core.LVector3f(0.0, 0.0, HIGH_M))
    return world


def places(world):
    return numpy.array([list(limb.body.getPosition()) for limb in world.limbs])


def centre(world):
    masses = numpy.array([limb.kg for limb in world.limbs])
    return masses @ places(world) / masses.sum()


def bends(world):
    """The bends of the limbs behind; ODE tells those of the limbs in front."""
    return [-rear.joint.getAngle1() for _, rear, _ in world.joints]


def still(world):
    return [[0.0, 0.0] for _ in world.joints]


def clamp(world):
    """Holds the first limb."""
    world.clamp = ode.OdeFixedJoint(world.world)
    world.clamp.attachBody(world.limbs[0].body, 0)
    world.clamp.set()


def structure(checks, model, expected):
    """Check 1: masses, inertias, places, limits, stairs, pairs."""
    world = world_of(model)
    masses = [limb.body.getMass() for limb in world.limbs]
    checks.relative("masses", [mass.getMagnitude() for mass in masses], [limb["kg"] for limb in expected["limbs"]], 1e-6)
    inertias = [[mass.getInertialTensor().getCell(axis, axis) for axis in range(3)] for mass in masses]
    checks.relative("inertias", inertias, [limb["kg_m2"] for limb in expected["limbs"]], 1e-6)
    checks.near("places at the start", places(world), [limb["at_m"] for limb in expected["limbs"]], 2 * PLACE_M)
    checks.near("bends at the start", bends(world), expected.get("start_rad", [0.0] * len(world.joints)), 2e-5)
    limits = [[max(joint[f"{axis}_limit_rad"], 1e-4) for axis in ("bend", "twist")] for joint in expected["joints"]]
    found = [[rear.joint.getParamHiStop(axis) for axis in (0, 1)] for _, rear, _ in world.joints]
    checks.near("limits", found, limits, 1e-6)
    boxes = [solid.getAABB for solid, middle, _, _ in world.solids if middle is not None]
    found = []
    for box in boxes:
        low, high = core.LVecBase3f(), core.LVecBase3f()
        box(low, high)
        found.append([*low, *high])
    checks.near("stairs", numpy.reshape(found, (-1, 6)), numpy.reshape(expected["steps"], (-1, 6)), 2e-5)
    frictions = [way.surface.getMu() for _, middle, _, way in world.solids if middle is None]
    checks.relative("friction of the ground", frictions, [expected["ground_friction"]], 1e-6)


def free_fall(checks, model, expected):
    """Check 2: one second of free fall."""
    world = raised(model, expected)
    start = centre(world)[2]
    for _ in range(round(1.0 / world.step_s / world.substeps)):
        world.step(still(world))
    fallen = centre(world)[2] - start
    checks.near("free fall, and its closed form", fallen, world.world.getGravity()[2] * (1.0 + world.step_s) / 2.0, 1e-3)
    if abs(world.step_s - 1.0 / 240.0) < 1e-9:
        checks.near("free fall, here and there", fallen, expected["fallen_m"], 1e-3)


def pendulum(checks, model, expected):
    """Check 3: two limbs, of which the first is clamped, without damping, until the limit is near."""
    world = raised(model, expected)
    clamp(world)
    there = []
    for _ in expected["pendulum_rad"]:
        world.step(still(world))
        there.append(bends(world)[0])
    times = [(step + 1) * world.substeps * world.step_s for step in range(len(there))]
    reference = pendulum_reference(expected["limbs"][1], -world.world.getGravity()[2], times)
    limit = expected["joints"][0]["bend_limit_rad"]
    reached = numpy.flatnonzero(reference > limit - 0.05)
    until = int(reached[0]) if reached.size else len(times)
    checks.equal("pendulum swings", until >= 3, True)
    checks.near("pendulum, there and by Runge and Kutta", there[:until], reference[:until], 0.02)


def free_limbs(checks, model, expected):
    """Check 4: no gravity, damped joints, sines of torque on the bends for two seconds. A body that is turned as a whole moves alike."""
    for turn in (core.LQuaternionf(1.0, 0.0, 0.0, 0.0), core.LQuaternionf(0.5, 0.5, -0.5, 0.5)):
        world = raised(model, expected, gravity=False)
        # Branches of creatures that come close to each other may touch in one engine and not in the other. They are seen 2 cm before.
        near = [(first, second) for first, second, _ in world.pairs if "start_rad" in expected]
        world.pairs = []
        for limb in {limb for pair in near for limb in pair}:
            limb.geom.setLengths(*(2.0 * side + 0.02 for side in limb.half))
        for limb in world.limbs:
            limb.body.setQuaternion(core.LQuaternionf(limb.body.getQuaternion()) * turn)
            limb.body.setPosition(turn.xform(limb.body.getPosition() - core.LPoint3f(0.0, 0.0, HIGH_M)) + core.LVector3f(0.0, 0.0, HIGH_M))
        there, touching = [], False
        for torques in expected["bend_torques_nm"]:
            world.step([[bend, 0.0] for bend in torques])
            there.append(bends(world))
            touching |= any(ode.OdeUtil.collide(first.geom, second.geom).getNumContacts() > 0 for first, second in near)
        if touching:
            checks.worst["creatures whose branches touch"] = checks.worst.get("creatures whose branches touch", 0) + 1
            continue
        checks.near("bends of free limbs", there, expected["bends_rad"], 0.01)


def settling(checks, model, expected):
    """Check 5: limbs of equal heights come to rest at half of it, and none sinks in."""
    world = world_of(model, expected["substeps"])
    forces = []
    for _ in range(round(expected["settled_s"] / world.step_s / world.substeps)):
        world.step(still(world))
        forces.append(sum(force[2] for force in world.forces.values()))
    sizes = numpy.array([limb["size_m"] for limb in expected["limbs"]])
    if numpy.ptp(sizes[:, 2]) == 0.0:
        checks.near("heights at rest", places(world)[:, 2], expected["settled_z_m"], 0.005)
    weight = sum(limb.kg for limb in world.limbs) * -world.world.getGravity()[2]
    # A body that rocks a little presses unevenly. The mean force is its weight.
    second = round(1.0 / world.step_s / world.substeps)
    checks.near("force of the ground, per weight", sum(forces[-second:]) / second / weight, 1.0, 0.05)


def slope(checks, friction):
    """Check 6: a block rests on a slope that is 3 % flatter than the angle of friction, and slides as it must on one as much steeper."""
    for factor in (0.97, 1.03):
        angle = math.atan(friction * factor)
        down, pressing = 9.81 * math.sin(angle), 9.81 * math.cos(angle)
        world = world_of(
            f'<mujoco><option timestep="{1 / 240}" gravity="0 {down} {-pressing}"/><worldbody>'
            f'<geom type="plane" size="0 0 1" friction="{friction} 0 0"/>'
            '<body name="limb 1" pos="0 0 0.5"><geom type="box" size="0.5 1 0.5" density="8"/></body></worldbody></mujoco>'
        )
        for _ in range(240):
            world.step([])
        slides = max(0.0, down - friction * pressing)
        checks.near("speed after a second on a slope", world.limbs[0].body.getLinearVel()[1], slides, 0.01)


def limit(checks, model, expected):
    """Check 7: a joint that is pushed stops at its limit."""
    for side in (1.0, -1.0):
        world = raised(model, expected, gravity=False)
        clamp(world)
        strength = 20.0 * world.limbs[1].kg_m2[0]
        for _ in range(240):
            world.step([[side * strength, 0.0]])
        checks.near("bend at the limit", bends(world)[0], side * expected["joints"][0]["bend_limit_rad"], 0.02)


def damping(checks):
    """Check 8: two equal limbs that are twisted against each other, whose joint is damped, approach the rate that the damping allows."""
    damping, torque, density = 30.0, 20.0, 8.0
    box = f'<geom type="box" size="0.5 1 0.5" density="{density}"/>'
    hinge = f'<joint name="{{}} 1" axis="{{}}" pos="0 1 0" range="-1.5 1.5" damping="{damping}"/>'
    world = world_of(
        f'<mujoco><option timestep="{1 / 240}" gravity="0 0 0"/><worldbody><body name="limb 1" pos="0 0 9">{box}'
        f'<body name="limb 2" pos="0 -2 0">{hinge.format("bend", "1 0 0")}{hinge.format("twist", "0 1 0")}{box}</body></body>'
        "</worldbody></mujoco>"
    )
    slow = world.limbs[0].kg_m2[1] / 2.0 / damping
    for step in range(60):
        world.step([[0.0, torque]])
        time = (step + 1) * world.step_s
        rate = torque / damping * (1.0 - math.exp(-time / slow))
        found = [world.limbs[limb].body.getAngularVel()[1] for limb in (1, 0)]
        checks.near("rate of a damped twist", found[0] - found[1], rate, 0.02)


def main(folder):
    checks = Checks()
    # A world of ODE takes many times as long as one of MuJoCo, so every fourth body is enough.
    descriptions = sorted(pathlib.Path(folder).glob("*.json"))[::4]
    for path in descriptions:
        checks.name = path.stem
        expected = json.loads(path.read_text(encoding="utf-8"))
        model = path.with_suffix(".xml").read_text(encoding="utf-8")
        structure(checks, model, expected)
        free_fall(checks, model, expected)
        free_limbs(checks, model, expected)
        if "start_rad" not in expected and "hinges" not in expected:
            settling(checks, model, expected)
            swing = path.with_name(f"{path.stem}-pendulum.xml").read_text(encoding="utf-8")
            pendulum(checks, swing, expected)
            limit(checks, swing, expected)
    for friction in (0.3, 0.6, 1.0):
        slope(checks, friction)
    damping(checks)
    return finish(checks, f"ODE of Panda3D {core.PandaSystem.getVersionString()}", len(descriptions))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
