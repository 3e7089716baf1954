/* A controller in f32 that learns, C99 and C++17. Each line of the input is a period and a state: the number of the period, the
 * errors of position and velocity. The answer is one line of bits: the desired motion, the torque, what is learnt. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "single_adaptive.h"

static int numbers(float *x)
{
    for (int i = 0; i < SINGLE_ADAPTIVE_JOINTS; i++) {
        uint32_t bits;
        if (scanf("%" SCNx32, &bits) != 1)
            return 0;
        memcpy(&x[i], &bits, sizeof bits);
    }
    return 1;
}

static void print(const float *x, int count)
{
    for (int i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &x[i], sizeof bits);
        printf(" %" PRIx32, bits);
    }
}

int main(void)
{
    struct single_adaptive_controller controller;
    struct single_adaptive_desired desired;
    struct single_adaptive_command command;
    float q[SINGLE_ADAPTIVE_JOINTS], qd[SINGLE_ADAPTIVE_JOINTS], theta[SINGLE_ADAPTIVE_PARAMETERS];
    uint32_t tick;
    single_adaptive_init(&controller);
    while (scanf("%" SCNu32, &tick) == 1 && numbers(q) && numbers(qd)) {
        printf("%d", (int)single_adaptive_reference(tick, &desired));
        print(desired.q, SINGLE_ADAPTIVE_JOINTS);
        print(desired.qd, SINGLE_ADAPTIVE_JOINTS);
        print(desired.qdd, SINGLE_ADAPTIVE_JOINTS);
        for (int i = 0; i < SINGLE_ADAPTIVE_JOINTS; i++) {
            q[i] += desired.q[i];
            qd[i] += desired.qd[i];
        }
        printf(" %d", (int)single_adaptive_step(&controller, q, qd, &desired, &command));
        print(command.torque, SINGLE_ADAPTIVE_JOINTS);
        single_adaptive_learnt(&controller, theta);
        print(theta, SINGLE_ADAPTIVE_PARAMETERS);
        putchar('\n');
    }
    return 0;
}
