"""What the judges of `snakes exam` have in common: the protocol with the program that starts them.

Each line on standard input is a JSON object, and so is each answer on standard output:

    (start)                                  -> {"version": "4.0.0"}, or {"missing": why}
    {"model": MJCF, "substeps": 2, "air_per_s": 2.0, "surfaces": {...}}
                                             -> {"limbs": [...]}
    {"torques": [[bend, twist], ...]}        -> {"limbs": [...]}, after one step of control,
                                                or "broken", if the engine cannot go on

A limb, or a part of a soft one, is [x, y, z, qx, qy, qz, qw, vx, vy, vz, wx, wy, wz, touches, fx, fy, fz]: pose, velocity and
angular velocity of its centre in the world, and the force of ground and stairs on it, in m, rad, s and N. The controller runs in
`snakes`, so that any of them can be played, also those that sense their surroundings.
"""

import json
import sys


def numbers(name):
    """The numbers in the name of a limb, a part or a joint, by which they are sorted."""
    return [int(word) for word in name.split() if word.isdigit()]


def answer(value):
    print(json.dumps(value), flush=True)


def serve(version, world_of):
    """Answers line by line until standard input ends. `world_of` makes a world of a model's order: it has `step(torques)`,
    `state()` and `is_broken()`."""
    answer({"version": version})
    try:
        for line in sys.stdin:
            order = json.loads(line)
            if "model" in order:
                world = world_of(order)
            else:
                world.step(order["torques"])
            if world.is_broken():
                answer("broken")
            else:
                answer({"limbs": [[float(number) for number in limb] for limb in world.state()]})
    except Exception as error:  # The partner reads one line, whatever went wrong.
        answer({"error": f"{type(error).__name__}: {error}"})
        return 1
    return 0


def missing(error):
    """Tells the partner that a package cannot be imported."""
    answer({"missing": str(error)})
    return 1
