"""Plays champions of Snakes & Stairs in ODE as Panda3D ships it, the engine of the report.

It is the partner of `snakes exam FILE --suite ode`, which starts it; judge.py has the protocol. The world is built from the same
model (MJCF) as MuJoCo's. Panda3D's automatic collision would drop soft ERP and slip, therefore every contact is made here.

A pair of limbs is joined by a universal joint, which has the limits, and motors at rest whose yielding is the damping. Parts of a
soft limb are joined by a ball and three stops that yield like springs.
"""

import math
import sys
import xml.etree.ElementTree as xml

from judge import missing, numbers, serve

# Largest number of points in which two boxes touch.
POINTS = 8
# Time in which the ERP of a surface acts, in s.
ERP_TIME_S = 1.0 / 60.0
# What a motor may exert that only damps.
UNBOUNDED = 1e9


def floats(text):
    return [float(word) for word in text.split()]


class Limb:
    """A body with its box. It stands at the place that the model gives it in the middle of all ranges."""

    def __init__(self, name, half, density, at, turn):
        self.name, self.half, self.at, self.turn = name, half, at, turn
        sides = [2.0 * side for side in half]
        self.kg = density * math.prod(sides)
        x, y, z = (side * side for side in sides)
        self.kg_m2 = [self.kg * moment / 12.0 for moment in (y + z, x + z, x + y)]
        self.reach = math.hypot(*half)


class Contact:
    """How two materials meet: friction, bounce, softness, slip and damping."""

    def __init__(self, ode, friction, bounce, bounce_velocity, erp, cfm, slip, dampen, step_s):
        self.dampen = dampen
        self.surface = surface = ode.OdeSurfaceParameters()
        mode = surface.MFContactApprox1 | surface.MFContactSoftERP
        surface.setMu(friction)
        if cfm > 0.0:
            # The spring and the damper that ERP and CFM mean in steps of ERP_TIME_S.
            stiffness, damping = erp / (ERP_TIME_S * cfm), (1.0 - erp) / cfm
            mode |= surface.MFContactSoftCFM
            surface.setSoftErp(step_s * stiffness / (step_s * stiffness + damping))
            surface.setSoftCfm(1.0 / (step_s * stiffness + damping))
        else:
            surface.setSoftErp(1.0 - (1.0 - erp) ** (step_s / ERP_TIME_S))
        if bounce > 0.0:
            mode |= surface.MFContactBounce
            surface.setBounce(bounce)
            surface.setBounceVel(bounce_velocity)
        if slip > 0.0:
            mode |= surface.MFContactSlip1 | surface.MFContactSlip2
            surface.setSlip1(slip)
            surface.setSlip2(slip)
        surface.setMode(mode)


class World:
    """A champion's body on its stairs."""

    def __init__(self, ode, core, order):
        self.ode, self.core = ode, core
        model = xml.fromstring(order["model"])
        option = model.find("option")
        self.step_s = float(option.get("timestep"))
        self.substeps = order["substeps"]
        # Share of the angular momentum that the air takes in a substep.
        self.air = -math.expm1(-order["air_per_s"] * self.step_s) / self.step_s
        # The order in which ODE solves depends on its random numbers.
        ode.OdeUtil.randSetSeed(1)
        self.world = ode.OdeWorld()
        self.world.setGravity(*floats(option.get("gravity")))
        self.group = ode.OdeJointGroup()
        self.limbs, self.joints, self.springs, self.kept = [], [], [], []
        self.build(model)
        self.surround(model, order["surfaces"])
        self.forces = {}

    def build(self, model):
        """Builds limbs and joints in the middle of their ranges, and then turns the limbs to the angles of the start."""
        core, hinges = self.core, []

        def add(element, parent):
            place, turn = core.LVector3d(*floats(element.get("pos"))), core.LQuaterniond(1, 0, 0, 0)
            if element.get("quat"):
                turn = core.LQuaterniond(*floats(element.get("quat")))
            if parent is not None:
                # Panda3D writes the rotation that comes first on the left.
                place, turn = parent.at + parent.turn.xform(place), turn * parent.turn
            box = element.find("geom")
            limb = Limb(element.get("name"), floats(box.get("size")), float(box.get("density")), place, turn)
            limb.parent = parent
            self.limbs.append(limb)
            limb.hinges = element.findall("joint")
            hinges.extend((limb, hinge) for hinge in limb.hinges)
            for child in element.findall("body"):
                add(child, limb)

        for element in model.find("worldbody").findall("body"):
            add(element, None)
        for limb in self.limbs:
            self.embody(limb)
        for limb in self.limbs:
            if limb.hinges:
                self.join(limb)
        key = model.find("keyframe/key")
        if key is not None:
            self.turn(dict(zip((hinge.get("name") for _, hinge in hinges), floats(key.get("qpos"))[7:])))
        # The model lists one branch to its end before the next.
        self.limbs.sort(key=lambda limb: numbers(limb.name))
        self.joints.sort()
        self.joints = [joint[1:] for joint in self.joints]

    def embody(self, limb):
        limb.body = self.ode.OdeBody(self.world)
        mass = self.ode.OdeMass()
        sides = [2.0 * side for side in limb.half]
        mass.setBoxTotal(limb.kg, *sides)
        limb.body.setMass(mass)
        limb.geom = self.ode.OdeBoxGeom(*sides)
        limb.geom.setBody(limb.body)
        self.place(limb)

    def place(self, limb):
        limb.body.setPosition(*limb.at)
        limb.body.setQuaternion(self.core.LQuaternionf(*limb.turn))

    def join(self, limb):
        """Joins a limb to the one in front of it, as the hinges of the model say."""
        ode, front, first = self.ode, limb.parent, limb.hinges[0]
        anchor = limb.at + limb.turn.xform(self.core.LVector3d(*floats(first.get("pos"))))
        axes = [limb.turn.xform(self.core.LVector3d(*floats(hinge.get("axis")))) for hinge in limb.hinges]
        is_joint = first.get("name").startswith("bend ")
        joint = ode.OdeUniversalJoint(self.world) if is_joint else ode.OdeBallJoint(self.world)
        joint.attach(front.body, limb.body)
        joint.setAnchor(*anchor)
        limb.joint = joint
        self.kept.append(joint)
        # The turn of the limb against the one in front, in the middle of all ranges.
        between = self.core.LQuaterniond(limb.turn * conjugate(front.turn))
        if is_joint:
            joint.setAxis1(*axes[0])
            joint.setAxis2(*axes[1])
            for axis, hinge in enumerate(limb.hinges):
                low, high = floats(hinge.get("range"))
                joint.setParamLoStop(axis, low)
                joint.setParamHiStop(axis, high)
                damping = float(hinge.get("damping"))
                if damping > 0.0:
                    # The bend's axis stands still in the limb in front, the twist's in the one behind.
                    motor = self.motor(front, limb, 1 + axis, axes[axis])
                    motor.setParamVel(0, 0.0)
                    motor.setParamFMax(0, UNBOUNDED)
                    motor.setParamCFM(0, 1.0 / damping)
            # The axes of the torques stand still in the limb in front.
            self.joints.append((numbers(first.get("name")), front, limb, between))
        else:
            motors = [self.motor(limb, front, 2, axis) for axis in axes]
            for motor, hinge in zip(motors, limb.hinges):
                stiffness, damping = float(hinge.get("stiffness")), float(hinge.get("damping"))
                yields = self.step_s * stiffness + damping
                motor.setParamLoStop(0, 0.0)
                motor.setParamHiStop(0, 0.0)
                motor.setParamStopERP(0, self.step_s * stiffness / yields)
                motor.setParamStopCFM(0, 1.0 / yields)
            self.springs.append((front, limb, motors))

    def motor(self, first, second, rel, axis):
        """A motor about one axis, which stands still in the first or the second limb. In Panda3D, the parameters of a motor with
        several axes all act on the first of them."""
        motor = self.ode.OdeAMotorJoint(self.world)
        motor.attach(first.body, second.body)
        motor.setNumAxes(1)
        motor.setAxis(0, rel, *axis)
        self.kept.append(motor)
        return motor

    def turn_springs(self):
        """Tells the springs of soft limbs by how much each part is turned against the one in front."""
        for front, rear, motors in self.springs:
            turn = self.core.LQuaternionf(rear.body.getQuaternion()) * conjugate(front.body.getQuaternion())
            # A rotation and its negative are the same; this is the one by less than half a turn.
            w, *parts = turn if turn[0] >= 0.0 else -turn
            sine = math.hypot(*parts)
            scale = 2.0 * math.atan2(sine, w) / sine if sine > 0.0 else 2.0
            for motor, part in zip(motors, parts):
                motor.setAngle(0, scale * part)

    def turn(self, angles):
        """Turns each limb about its hinges by these angles, with all that hangs on it."""
        core, zero = self.core, {limb.name: (limb.at, limb.turn) for limb in self.limbs}
        for limb in self.limbs:
            if limb.parent is None:
                continue
            (front_at, front_turn), (at, turn) = zero[limb.parent.name], zero[limb.name]
            back = conjugate(front_turn)
            place, own = back.xform(at - front_at), turn * back
            for hinge in limb.hinges:
                axis = core.LVector3d(*floats(hinge.get("axis")))
                anchor = core.LVector3d(*floats(hinge.get("pos")))
                half = angles[hinge.get("name")] / 2.0
                by = core.LQuaterniond(math.cos(half), axis * math.sin(half))
                turned = by * own
                # The anchor stays where it is.
                place, own = place + own.xform(anchor) - turned.xform(anchor), turned
            limb.at = limb.parent.at + limb.parent.turn.xform(place)
            limb.turn = own * limb.parent.turn
            self.place(limb)

    def surround(self, model, surfaces):
        """Builds ground and stairs, and the ways in which they and the limbs touch."""
        ode, skin = self.ode, surfaces["skin"]
        # Of two soft materials, which are springs in series, the CFMs add up.
        soft = skin["soft_cfm_m_s_per_n"]

        def contact(surface, friction):
            cfm = surface["soft_cfm_m_s_per_n"] + soft
            series = [(part["soft_cfm_m_s_per_n"], part["soft_erp"]) for part in (surface, skin)]
            erp = cfm / sum(cfm / erp for cfm, erp in series) if soft > 0.0 else surface["soft_erp"]
            bounce = max(surface["bounce"], skin["bounce"])
            rest = (surface.get(name, 0.0) for name in ("slip_m_s_per_n", "dampen_per_s"))
            return Contact(ode, friction, bounce, surface.get("bounce_velocity_m_s", 0.0), erp, cfm, *rest, self.step_s)

        self.solids = []
        for geom in model.find("worldbody").findall("geom"):
            kind = "ground" if geom.get("type") == "plane" else "stairs"
            half = floats(geom.get("size"))
            if kind == "ground":
                solid, middle, reach = ode.OdePlaneGeom(0.0, 0.0, 1.0, 0.0), None, 0.0
            else:
                solid, middle, reach = ode.OdeBoxGeom(*(2.0 * side for side in half)), floats(geom.get("pos")), math.hypot(*half[1:])
                solid.setPosition(*middle)
                if geom.get("quat"):
                    solid.setQuaternion(self.core.LQuaternionf(*floats(geom.get("quat"))))
            self.solids.append((solid, middle, reach, contact(surfaces[kind], floats(geom.get("friction"))[0])))
        limbs = {limb.name: limb for limb in self.limbs}
        self.pairs = [
            (limbs[pair.get("geom1")], limbs[pair.get("geom2")], contact(skin, floats(pair.get("friction"))[0]))
            for pair in model.findall("contact/pair")
        ]

    def touch(self, first, second, way, bodies):
        """Makes the contacts of two geoms. Returns their joints."""
        entry = self.ode.OdeUtil.collide(first, second, POINTS)
        joints = []
        for index in range(entry.getNumContacts()):
            contact = self.ode.OdeContact()
            contact.setGeom(entry.getContactGeom(index))
            contact.setSurface(way.surface)
            joint = self.ode.OdeContactJoint(self.world, self.group, contact)
            joint.attach(*bodies)
            joints.append(joint)
        return joints

    def collide(self):
        """Makes all contacts. Returns those of each limb with ground and stairs, and how strongly they dampen it."""
        places = [limb.body.getPosition() for limb in self.limbs]
        touching = []
        for limb, at in zip(self.limbs, places):
            for solid, middle, reach, way in self.solids:
                far = at[2] if middle is None else math.hypot(at[1] - middle[1], at[2] - middle[2])
                if far < limb.reach + reach:
                    joints = self.touch(limb.geom, solid, way, (limb.body, None))
                    if joints:
                        touching.append((limb, joints, way.dampen))
        for first, second, way in self.pairs:
            if (first.body.getPosition() - second.body.getPosition()).length() < first.reach + second.reach:
                self.touch(first.geom, second.geom, way, (first.body, second.body))
        return touching

    def step(self, torques):
        """One step of control. A torque acts about the axes of the joint, which stand still in the limb in front of it."""
        couples = []
        for (front, rear, between), (bend, twist) in zip(self.joints, torques):
            axes = between.xform(self.core.LVector3d(bend, twist, 0.0))
            couples.append((front, rear, front.body.vectorToWorld(*axes)))
        for substep in range(self.substeps):
            for front, rear, couple in couples:
                front.body.addTorque(-couple)
                rear.body.addTorque(couple)
            if self.air > 0.0:
                for limb in self.limbs:
                    spin = limb.body.vectorFromWorld(limb.body.getAngularVel())
                    limb.body.addRelTorque(*(-self.air * moment * rate for moment, rate in zip(limb.kg_m2, spin)))
            self.turn_springs()
            touching = self.collide()
            is_last = substep + 1 == self.substeps
            if is_last:
                for _, joints, _ in touching:
                    for joint in joints:
                        joint.setFeedback(True)
            self.world.quickStep(self.step_s)
            self.dampen(touching)
            if is_last:
                self.feel(touching)
            self.group.empty()

    def dampen(self, touching):
        """Slows each limb on the surface that dampens it most."""
        rates = {}
        for limb, _, rate in touching:
            if rate > rates.get(limb, 0.0):
                rates[limb] = rate
        for limb, rate in rates.items():
            kept = math.exp(-rate * self.step_s)
            limb.body.setLinearVel(limb.body.getLinearVel() * kept)
            limb.body.setAngularVel(limb.body.getAngularVel() * kept)

    def feel(self, touching):
        """Keeps the force of ground and stairs on each limb that they touch."""
        self.forces = {}
        for limb, joints, _ in touching:
            for joint in joints:
                force = self.core.LVector3f(joint.getFeedback().getForce1())
                self.forces[limb] = self.forces.get(limb, self.core.LVector3f(0)) + force
                # The group does not free the feedback of its joints.
                joint.setFeedback(False)

    def is_broken(self):
        """Whether a number is not finite."""
        return any(limb.body.getPosition().isNan() or limb.body.getLinearVel().isNan() for limb in self.limbs)

    def state(self):
        """The limbs, as judge.py describes them."""
        rows = []
        for limb in self.limbs:
            body, force = limb.body, self.forces.get(limb)
            w, x, y, z = body.getQuaternion()
            touch = [0.0] * 4 if force is None else [1.0, *force]
            rows.append([*body.getPosition(), x, y, z, w, *body.getLinearVel(), *body.getAngularVel(), *touch])
        return rows


def conjugate(turn):
    w, x, y, z = turn
    return type(turn)(w, -x, -y, -z)


def main():
    try:
        from panda3d import core, ode
    except ImportError as error:
        return missing(error)
    return serve(core.PandaSystem.getVersionString(), lambda order: World(ode, core, order))


if __name__ == "__main__":
    sys.exit(main())
