"""Plays champions of Snakes & Stairs in MuJoCo.

Without arguments it is the partner of `snakes exam FILE --suite mujoco`, which starts it; judge.py has the protocol.

    mujoco.py MODEL.xml MOTION.csv PICTURE.png [SECOND ...]

draws the recorded motion of a champion (`snakes export CHAMPION -o MOTION.csv`) with MuJoCo's renderer, one moment below
the other. Without a screen, set MUJOCO_GL=egl or MUJOCO_GL=osmesa.
"""

import math
import os
import sys

from judge import missing, numbers, serve

# This file has the name of the package that it needs.
_here = os.path.dirname(os.path.abspath(__file__)) if "__file__" in globals() else os.getcwd()
sys.path = [entry for entry in sys.path if os.path.abspath(entry or os.getcwd()) != _here]


def limb_bodies(mujoco, model):
    """The numbers of the bodies of limbs and of parts of soft ones, in the order of their numbers: MuJoCo's own order follows
    one branch of a body to its end before the next."""
    names = [model.body(index).name for index in range(model.nbody)]
    limbs = [index for index, name in enumerate(names) if name.startswith("limb ")]
    return sorted(limbs, key=lambda index: numbers(names[index]))


class World:
    """A champion's body on its stairs."""

    def __init__(self, mujoco, numpy, order):
        self.mujoco, self.numpy = mujoco, numpy
        self.model = mujoco.MjModel.from_xml_string(order["model"])
        self.data = mujoco.MjData(self.model)
        self.limbs = limb_bodies(mujoco, self.model)
        # For each joint the places in that list of what it connects: a soft limb is several bodies.
        places = {body: place for place, body in enumerate(self.limbs)}
        names = [self.model.joint(hinge).name for hinge in range(self.model.njnt)]
        bends = [hinge for hinge, name in enumerate(names) if name.startswith("bend ")]
        rears = [self.model.jnt_bodyid[hinge] for hinge in sorted(bends, key=lambda hinge: numbers(names[hinge]))]
        # With the rotation of each joint's axes against the limb in front of it.
        self.joints = [(places[self.model.body_parentid[rear]], places[rear], self.turn(rear)) for rear in rears]
        if self.model.nkey:
            mujoco.mj_resetDataKeyframe(self.model, self.data, 0)
        self.substeps = order["substeps"]
        # Share of the angular momentum that the air takes in a substep.
        self.air = -math.expm1(-order["air_per_s"] * self.model.opt.timestep) / self.model.opt.timestep
        self.look()

    def turn(self, body):
        """The rotation of a body against its parent in the middle of the ranges of its joints."""
        turn = self.numpy.zeros(9)
        self.mujoco.mju_quat2Mat(turn, self.model.body_quat[body])
        return turn.reshape(3, 3)

    def look(self):
        """Computes poses and velocities. Contacts stay those of the last substep."""
        self.mujoco.mj_kinematics(self.model, self.data)
        self.mujoco.mj_comPos(self.model, self.data)
        self.mujoco.mj_comVel(self.model, self.data)

    def velocity(self, body):
        """Angular velocity and velocity of a body's centre, in the world."""
        found = self.numpy.zeros(6)
        kind = self.mujoco.mjtObj.mjOBJ_BODY
        self.mujoco.mj_objectVelocity(self.model, self.data, kind, body, found, 0)
        return found[:3], found[3:]

    def step(self, torques):
        """One step of control. A torque acts about the axes of the joint, which stand still in the limb in front of it, as in
        `snakes`: the twist of MuJoCo's hinges acts about the rear limb's axis. That is why the motors of the model are not
        used."""
        data, numpy = self.data, self.numpy
        couples = numpy.zeros((len(self.limbs), 3))
        for (front, rear, turn), (bend, twist) in zip(self.joints, torques):
            axes = data.xmat[self.limbs[front]].reshape(3, 3) @ turn
            couple = axes @ (bend, twist, 0.0)
            couples[front] -= couple
            couples[rear] += couple
        for _ in range(self.substeps):
            for limb, body in enumerate(self.limbs):
                torque = couples[limb]
                if self.air > 0.0:
                    axes = data.ximat[body].reshape(3, 3)
                    inertia = self.model.body_inertia[body]
                    spin, _ = self.velocity(body)
                    torque = torque - self.air * (axes @ (inertia * (axes.T @ spin)))
                data.xfrc_applied[body, 3:] = torque
            self.mujoco.mj_step(self.model, data)
            self.look()

    def forces(self):
        """For each body the force of ground and stairs in the last substep, if they touch it."""
        forces, found = {}, self.numpy.zeros(6)
        for index in range(self.data.ncon):
            contact = self.data.contact[index]
            bodies = [self.model.geom_bodyid[geom] for geom in contact.geom]
            if 0 not in bodies:
                continue
            self.mujoco.mj_contactForce(self.model, self.data, index, found)
            # The contact's first axis points from its first geom to its second one, on which the force acts.
            side = 1.0 if bodies[0] == 0 else -1.0
            body = bodies[1] if bodies[0] == 0 else bodies[0]
            force = side * (contact.frame.reshape(3, 3).T @ found[:3])
            forces[body] = forces.get(body, 0.0) + force
        return forces

    def is_broken(self):
        """Whether MuJoCo has given up and started anew."""
        bad = self.mujoco.mjtWarning
        kinds = [bad.mjWARN_BADQPOS, bad.mjWARN_BADQVEL, bad.mjWARN_BADQACC]
        return any(self.data.warning[kind].number > 0 for kind in kinds)

    def state(self):
        """The limbs, as judge.py describes them."""
        forces, rows = self.forces(), []
        for body in self.limbs:
            w, x, y, z = self.data.xquat[body]
            spin, velocity = self.velocity(body)
            force = forces.get(body)
            touch = [0.0] * 4 if force is None else [1.0, *force]
            rows.append([*self.data.xpos[body], x, y, z, w, *velocity, *spin, *touch])
        return rows


def draw(mujoco, numpy, arguments):
    """Draws moments of a recorded motion."""
    import csv

    from PIL import Image

    model_path, motion_path, picture_path, *seconds = arguments
    model = mujoco.MjModel.from_xml_path(model_path)
    data = mujoco.MjData(model)
    limbs = limb_bodies(mujoco, model)
    with open(motion_path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    times = sorted({float(row["time_s"]) for row in rows})
    pictures = []
    with mujoco.Renderer(model, 540, 960) as renderer:
        for second in map(float, seconds or [0, times[-1] / 2, times[-1]]):
            nearest = min(times, key=lambda time: abs(time - second))
            poses = [row for row in rows if float(row["time_s"]) == nearest]
            mujoco.mj_resetData(model, data)
            mujoco.mj_forward(model, data)
            if len(poses) != len(limbs):
                sys.exit(f"{motion_path} has {len(poses)} limbs, {model_path} {len(limbs)} parts: soft limbs cannot be drawn")
            for body, row in zip(limbs, poses):
                x, y, z, w = (float(row[f"rotation_{axis}"]) for axis in "xyzw")
                geom = model.body_geomadr[body]
                data.geom_xpos[geom] = [float(row[f"{axis}_m"]) for axis in "xyz"]
                mujoco.mju_quat2Mat(data.geom_xmat[geom], numpy.array([w, x, y, z]))
            renderer.update_scene(data, camera="overview")
            pictures.append(renderer.render())
    Image.fromarray(numpy.vstack(pictures)).save(picture_path)


def main():
    try:
        import mujoco
        import numpy
    except ImportError as error:
        return missing(error)
    if len(sys.argv) > 1:
        return draw(mujoco, numpy, sys.argv[1:])
    return serve(mujoco.__version__, lambda order: World(mujoco, numpy, order))


if __name__ == "__main__":
    sys.exit(main())
