/* Steps a snake in the Open Dynamics Engine, for a comparison of speeds. Called by speed.py, which compiles it:
 *
 *     cc -O2 ode_speed.c -o ode_speed -lode -lm
 *     ode_speed exact|quick < SCENE
 *
 * A scene is a list of numbers: step in s, gravity in m/s2, friction, joint damping in N·m·s/rad; the number of
 * static boxes, each with its middle and its size; the number of limbs, each with its middle, its size and its mass; for each joint
 * between neighbouring limbs its anchor, the axes of bend and twist, and both limits in rad; the number of steps, and for each step and
 * each joint the torques of bend and twist in N·m. It prints the seconds that the steps took, and the y of the head at the end.
 */
#include <ode/ode.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MOST_LIMBS = 16, MOST_POINTS = 8 };

static dWorldID world;
static dJointGroupID contacts;
static dReal friction;

static double number(void) {
    double value = 0.0;
    if (scanf("%lf", &value) != 1) {
        fprintf(stderr, "the scene ends too early\n");
        exit(1);
    }
    return value;
}

static void vector(dReal into[3]) {
    for (int axis = 0; axis < 3; axis++) into[axis] = number();
}

static void touch(void *unused, dGeomID a, dGeomID b) {
    (void)unused;
    dBodyID front = dGeomGetBody(a), rear = dGeomGetBody(b);
    if (front && rear && dAreConnected(front, rear)) return;
    dContact points[MOST_POINTS];
    int count = dCollide(a, b, MOST_POINTS, &points[0].geom, sizeof(dContact));
    for (int point = 0; point < count; point++) {
        memset(&points[point].surface, 0, sizeof points[point].surface);
        points[point].surface.mode = dContactApprox1 | dContactSoftERP;
        /* Limbs glide along each other, as in the snake's world. */
        points[point].surface.mu = front && rear ? 0 : friction;
        points[point].surface.soft_erp = 0.25;
        dJointAttach(dJointCreateContact(world, contacts, &points[point]), front, rear);
    }
}

int main(int count, char **arguments) {
    int is_quick = count == 2 && strcmp(arguments[1], "quick") == 0;
    if (!is_quick && (count != 2 || strcmp(arguments[1], "exact") != 0)) {
        fprintf(stderr, "ode_speed exact|quick < SCENE\n");
        return 2;
    }
    dInitODE2(0);
    world = dWorldCreate();
    contacts = dJointGroupCreate(0);
    dSpaceID space = dSweepAndPruneSpaceCreate(0, dSAP_AXES_YZX);
    dReal step_s = number();
    dWorldSetGravity(world, 0, 0, -number());
    dWorldSetERP(world, 0.25);
    dWorldSetQuickStepNumIterations(world, 20);
    friction = number();
    dReal damping = number();
    dCreatePlane(space, 0, 0, 1, 0);
    for (int boxes = number(); boxes > 0; boxes--) {
        dReal at[3], size[3];
        vector(at);
        vector(size);
        dGeomSetPosition(dCreateBox(space, size[0], size[1], size[2]), at[0], at[1], at[2]);
    }
    dBodyID limbs[MOST_LIMBS];
    dJointID joints[MOST_LIMBS];
    int limb_count = number();
    if (limb_count > MOST_LIMBS) {
        fprintf(stderr, "more than %d limbs\n", MOST_LIMBS);
        return 1;
    }
    for (int limb = 0; limb < limb_count; limb++) {
        dReal at[3], size[3];
        vector(at);
        vector(size);
        dMass mass;
        dMassSetBoxTotal(&mass, number(), size[0], size[1], size[2]);
        limbs[limb] = dBodyCreate(world);
        dBodySetMass(limbs[limb], &mass);
        dBodySetPosition(limbs[limb], at[0], at[1], at[2]);
        dBodySetAutoDisableFlag(limbs[limb], 0);
        dGeomSetBody(dCreateBox(space, size[0], size[1], size[2]), limbs[limb]);
    }
    for (int joint = 0; joint + 1 < limb_count; joint++) {
        dReal at[3], bend[3], twist[3];
        vector(at);
        vector(bend);
        vector(twist);
        joints[joint] = dJointCreateUniversal(world, 0);
        dJointAttach(joints[joint], limbs[joint], limbs[joint + 1]);
        dJointSetUniversalAnchor(joints[joint], at[0], at[1], at[2]);
        dJointSetUniversalAxis1(joints[joint], bend[0], bend[1], bend[2]);
        dJointSetUniversalAxis2(joints[joint], twist[0], twist[1], twist[2]);
        dReal limit = number();
        dJointSetUniversalParam(joints[joint], dParamLoStop1, -limit);
        dJointSetUniversalParam(joints[joint], dParamHiStop1, limit);
        limit = number();
        dJointSetUniversalParam(joints[joint], dParamLoStop2, -limit);
        dJointSetUniversalParam(joints[joint], dParamHiStop2, limit);
    }
    int steps = number();
    int torques = 2 * (limb_count - 1);
    double *all = malloc(sizeof(double) * steps * torques);
    for (int index = 0; index < steps * torques; index++) all[index] = number();
    struct timespec begin, end;
    clock_gettime(CLOCK_MONOTONIC, &begin);
    for (int step = 0; step < steps; step++) {
        const double *now = all + step * torques;
        for (int joint = 0; joint + 1 < limb_count; joint++) {
            dReal bend = now[2 * joint] - damping * dJointGetUniversalAngle1Rate(joints[joint]);
            dReal twist = now[2 * joint + 1] - damping * dJointGetUniversalAngle2Rate(joints[joint]);
            dJointAddUniversalTorques(joints[joint], bend, twist);
        }
        dSpaceCollide(space, 0, touch);
        if (is_quick) dWorldQuickStep(world, step_s);
        else dWorldStep(world, step_s);
        dJointGroupEmpty(contacts);
    }
    clock_gettime(CLOCK_MONOTONIC, &end);
    double seconds = (end.tv_sec - begin.tv_sec) + (end.tv_nsec - begin.tv_nsec) * 1e-9;
    printf("%.6f %.3f\n", seconds, (double)dBodyGetPosition(limbs[0])[1]);
    return 0;
}
