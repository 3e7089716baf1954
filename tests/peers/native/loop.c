/* The C interface of one generated controller as plain functions for mujoco_loop.py. NAME is the module's name, UPPER the same
 * in capital letters; HEADER is its header. */
#include <stdint.h>

#include HEADER

#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)
#define OF(what) JOIN(NAME, what)

static struct OF(_controller) controller;

const int joints = JOIN(UPPER, _JOINTS);
const double period = JOIN(UPPER, _PERIOD);
const double duration = JOIN(UPPER, _DURATION);

/* Whether header and library belong together, and the controller is ready. */
int start(void)
{
    const char *ours = JOIN(UPPER, _SPEC_HASH), *theirs = OF(_spec_hash)();
    while (*ours != 0 && *ours == *theirs)
        ours++, theirs++;
    return *ours == *theirs && OF(_init)(&controller) == JOIN(UPPER, _OK);
}

/* Desired position, velocity and acceleration, one after the other. */
int reference(double time, double *desired)
{
    return (int)OF(_reference)(time, (struct OF(_desired) *)desired);
}

/* The torque to hold; answers the fault, and in `saturated` a bit for each joint whose torque a limit has cut. */
int step(const double *q, const double *qd, double time, double *torque, uint32_t *saturated)
{
    struct OF(_desired) desired;
    struct OF(_command) command;
    int fault = (int)OF(_reference)(time, &desired);
    int joint;
    if (fault != 0)
        return fault;
    fault = (int)OF(_step)(&controller, q, qd, &desired, &command);
    for (joint = 0; joint < joints; joint++)
        torque[joint] = command.torque[joint];
    *saturated = command.saturated;
    return fault;
}
