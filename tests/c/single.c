/* A controller in f32, C99 and C++17. Each line of the input is a step, of which the answer is one line of bits. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "step_single.h"

static int numbers(float *x)
{
    for (int i = 0; i < STEP_SINGLE_JOINTS; i++) {
        uint32_t bits;
        if (scanf("%" SCNx32, &bits) != 1)
            return 0;
        memcpy(&x[i], &bits, sizeof bits);
    }
    return 1;
}

int main(void)
{
    struct step_single_controller controller;
    struct step_single_desired desired;
    struct step_single_command command;
    float q[STEP_SINGLE_JOINTS], qd[STEP_SINGLE_JOINTS];
    step_single_init(&controller);
    while (numbers(q) && numbers(qd) && numbers(desired.q) && numbers(desired.qd) && numbers(desired.qdd)) {
        printf("%d", (int)step_single_step(&controller, q, qd, &desired, &command));
        for (int i = 0; i < STEP_SINGLE_JOINTS; i++) {
            uint32_t bits;
            memcpy(&bits, &command.torque[i], sizeof bits);
            printf(" %" PRIx32, bits);
        }
        putchar('\n');
    }
    return 0;
}
