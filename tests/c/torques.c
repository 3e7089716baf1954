/* Two controllers of two modules in one program, C99 and C++17. Each line of the input is a call, of which the answer is one
 * line of bits. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "arm3_adaptive.h"
#include "step_exact.h"

static double from_bits(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static int numbers(double *x, int count)
{
    for (int i = 0; i < count; i++) {
        uint64_t bits;
        if (scanf("%" SCNx64, &bits) != 1)
            return 0;
        x[i] = from_bits(bits);
    }
    return 1;
}

static void print(const double *x, int count)
{
    for (int i = 0; i < count; i++) {
        uint64_t bits;
        memcpy(&bits, &x[i], sizeof bits);
        printf(" %" PRIx64, bits);
    }
}

/* Answers one call to one of the modules; 0 where it is none. */
#define ANSWER(name, joints)                                                              \
    static int answer_##name(struct name##_controller *controller, char call)             \
    {                                                                                     \
        double q[joints], qd[joints], torque[joints], time;                               \
        struct name##_desired desired;                                                    \
        struct name##_command command;                                                    \
        switch (call) {                                                                   \
        case 's':                                                                         \
            if (!numbers(q, joints) || !numbers(qd, joints) || !numbers(desired.q, joints) \
                || !numbers(desired.qd, joints) || !numbers(desired.qdd, joints))         \
                return 0;                                                                 \
            printf("%d", (int)name##_step(controller, q, qd, &desired, &command));        \
            printf(" %d %d", (int)command.fault_joint, (int)command.saturated);           \
            print(command.torque, joints);                                                \
            return 1;                                                                     \
        case 'r':                                                                         \
            if (!numbers(&time, 1))                                                       \
                return 0;                                                                 \
            printf("%d", (int)name##_reference(time, &desired));                          \
            print(desired.q, joints);                                                     \
            print(desired.qd, joints);                                                    \
            print(desired.qdd, joints);                                                   \
            return 1;                                                                     \
        case 'c':                                                                         \
            printf("%d", (int)name##_safe_command(controller, torque));                   \
            print(torque, joints);                                                        \
            return 1;                                                                     \
        case 'x':                                                                         \
            printf("%d", (int)name##_reset(controller));                                  \
            return 1;                                                                     \
        default:                                                                          \
            return 0;                                                                     \
        }                                                                                 \
    }

ANSWER(arm3_adaptive, ARM3_ADAPTIVE_JOINTS)
ANSWER(step_exact, STEP_EXACT_JOINTS)

/* θ̂, and the same put back. */
static int learnt(struct arm3_adaptive_controller *controller, char call)
{
    double theta[ARM3_ADAPTIVE_PARAMETERS];
    if (call == 'l') {
        printf("%d", (int)arm3_adaptive_learnt(controller, theta));
        print(theta, ARM3_ADAPTIVE_PARAMETERS);
        return 1;
    }
    if (call != 'p' || !numbers(theta, ARM3_ADAPTIVE_PARAMETERS))
        return 0;
    printf("%d", (int)arm3_adaptive_restore(controller, theta));
    return 1;
}

int main(void)
{
    struct arm3_adaptive_controller adaptive;
    struct step_exact_controller exact;
    char module, call;
    if (arm3_adaptive_init(&adaptive) != ARM3_ADAPTIVE_OK || step_exact_init(&exact) != STEP_EXACT_OK)
        return 2;
    while (scanf(" %c%c", &module, &call) == 2) {
        int answered = module == 'a' ? answer_arm3_adaptive(&adaptive, call) || learnt(&adaptive, call)
                                     : answer_step_exact(&exact, call);
        if (!answered)
            return 3;
        putchar('\n');
    }
    return 0;
}
