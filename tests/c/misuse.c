/* Pointers that are NULL or badly aligned and controllers that are none, C99 and C++17. Gives the line that fails. */
#include <stdio.h>
#include <string.h>

#include "arm3_adaptive.h"
#include "step_exact.h"

#define CHECK(condition)                        \
    do {                                        \
        if (!(condition)) {                     \
            printf("line %d\n", __LINE__);      \
            return 1;                           \
        }                                       \
    } while (0)

static int zero(const double *x, int count)
{
    for (int i = 0; i < count; i++)
        if (x[i] != 0.0)
            return 0;
    return 1;
}

int main(void)
{
    const double q[3] = {0.1, 0.2, -1.0}, qd[3] = {0.0, 0.1, 0.2};
    double torque[3], far[3] = {9.0, 9.0, 9.0};
    struct step_exact_controller controller, other;
    struct step_exact_desired desired;
    struct step_exact_command command, safe;
    struct arm3_adaptive_controller adaptive;
    struct arm3_adaptive_command learning;
    struct arm3_adaptive_desired wanted;
    double theta[ARM3_ADAPTIVE_PARAMETERS];
    /* One byte behind a number. */
    const double *odd = (const double *)(const void *)((const char *)q + 1);

    CHECK(strcmp(step_exact_spec_hash(), STEP_EXACT_SPEC_HASH) == 0);
    CHECK(strcmp(arm3_adaptive_spec_hash(), ARM3_ADAPTIVE_SPEC_HASH) == 0);
    CHECK(strcmp(STEP_EXACT_SPEC_HASH, ARM3_ADAPTIVE_SPEC_HASH) != 0);
    CHECK(strlen(STEP_EXACT_SPEC_HASH) == 64);

    /* Before it is initialised. */
    memset(&controller, 0, sizeof controller);
    CHECK(step_exact_reference(1.0, &desired) == STEP_EXACT_OK);
    command.torque[0] = 7.0;
    CHECK(step_exact_step(&controller, q, qd, &desired, &command) == STEP_EXACT_FAULT_NOT_INITIALISED);
    CHECK(zero(command.torque, 3) && command.saturated == 0 && command.fault_joint == -1);
    CHECK(step_exact_safe_command(&controller, far) == STEP_EXACT_FAULT_NOT_INITIALISED && zero(far, 3));
    CHECK(step_exact_reset(&controller) == STEP_EXACT_FAULT_NOT_INITIALISED);

    /* A controller of another module. */
    CHECK(arm3_adaptive_init(&adaptive) == ARM3_ADAPTIVE_OK);
    CHECK(sizeof adaptive >= sizeof controller);
    memcpy(&controller, &adaptive, sizeof controller);
    CHECK(step_exact_step(&controller, q, qd, &desired, &command) == STEP_EXACT_FAULT_NOT_INITIALISED);

    /* NULL. */
    CHECK(step_exact_init(NULL) == STEP_EXACT_FAULT_POINTER);
    CHECK(step_exact_init(&controller) == STEP_EXACT_OK);
    CHECK(step_exact_step(NULL, q, qd, &desired, &command) == STEP_EXACT_FAULT_POINTER && zero(command.torque, 3));
    CHECK(step_exact_step(&controller, q, qd, &desired, NULL) == STEP_EXACT_FAULT_POINTER);
    CHECK(step_exact_reference(1.0, NULL) == STEP_EXACT_FAULT_POINTER);
    CHECK(step_exact_safe_command(NULL, torque) == STEP_EXACT_FAULT_POINTER && zero(torque, 3));
    CHECK(step_exact_safe_command(&controller, NULL) == STEP_EXACT_FAULT_POINTER);
    CHECK(step_exact_reset(NULL) == STEP_EXACT_FAULT_POINTER);

    /* After one good step the safe command is the gravity torque: not 0. */
    CHECK(step_exact_step(&controller, q, qd, &desired, &command) == STEP_EXACT_OK);
    CHECK(command.fault_joint == -1 && !zero(command.torque, 3));
    CHECK(step_exact_safe_command(&controller, torque) == STEP_EXACT_OK && !zero(torque, 3));
    for (int place = 0; place < 6; place++) {
        const double *bad = place % 2 ? odd : NULL;
        const struct step_exact_desired *bad_desired = (const struct step_exact_desired *)(const void *)bad;
        int fault = step_exact_step(&controller, place / 2 == 0 ? bad : q, place / 2 == 1 ? bad : qd,
                                    place / 2 == 2 ? bad_desired : &desired, &safe);
        CHECK(fault == STEP_EXACT_FAULT_POINTER && safe.fault_joint == -1 && safe.saturated == 0);
        CHECK(memcmp(safe.torque, torque, sizeof torque) == 0);
    }

    /* A copy is a controller; the first one does not see what the second one does. */
    other = controller;
    CHECK(step_exact_reset(&other) == STEP_EXACT_OK);
    CHECK(step_exact_safe_command(&other, far) == STEP_EXACT_OK && zero(far, 3));
    CHECK(step_exact_safe_command(&controller, far) == STEP_EXACT_OK && memcmp(far, torque, sizeof far) == 0);

    /* Arguments may overlap. */
    CHECK(step_exact_step(&controller, q, q, &desired, &safe) == STEP_EXACT_OK);
    memcpy(safe.torque, q, sizeof q);
    CHECK(step_exact_step(&controller, safe.torque, qd, &desired, &safe) == STEP_EXACT_OK);
    CHECK(memcmp(&safe, &command, sizeof safe) == 0);

    /* What is learnt. */
    CHECK(arm3_adaptive_learnt(NULL, theta) == ARM3_ADAPTIVE_FAULT_POINTER);
    CHECK(arm3_adaptive_learnt(&adaptive, NULL) == ARM3_ADAPTIVE_FAULT_POINTER);
    CHECK(arm3_adaptive_restore(NULL, theta) == ARM3_ADAPTIVE_FAULT_POINTER);
    CHECK(arm3_adaptive_restore(&adaptive, NULL) == ARM3_ADAPTIVE_FAULT_POINTER);
    CHECK(arm3_adaptive_learnt(&adaptive, theta) == ARM3_ADAPTIVE_OK);
    CHECK(arm3_adaptive_reference(1.0, &wanted) == ARM3_ADAPTIVE_OK);
    CHECK(arm3_adaptive_step(&adaptive, q, qd, &wanted, &learning) == ARM3_ADAPTIVE_OK);
    puts("good");
    return 0;
}
