/* What is measured of one module through its C interface, as `src/measure.rs` and `src/faults.rs` do it in Rust. Included once
 * for each module, with these defined:
 *
 *     MODULE  its name
 *     UPPER   its name in capitals
 *     ERROR   how far the measured position may be off the motion, rad or m
 */
#define PASTE(a, b) a##b
#define JOIN(a, b) PASTE(a, b)
#define QUOTE(a) #a
#define TEXT(a) QUOTE(a)
#define OWN(what) JOIN(MODULE, what)
#define JOINTS JOIN(UPPER, _JOINTS)

/* One control step, with all that it reads and writes. */
struct OWN(_case) {
    struct OWN(_controller) controller;
    struct OWN(_command) command;
    float q[JOINTS], qd[JOINTS];
    uint32_t tick;
    enum OWN(_fault) fault;
};

/* The whole step, as a timer's interrupt calls it: the reference, then the step. */
static void OWN(_control)(void *argument)
{
    struct OWN(_case) *const one = (struct OWN(_case) *)argument;
    struct OWN(_desired) desired;
    OWN(_reference)(one->tick, &desired);
    one->fault = OWN(_step)(&one->controller, one->q, one->qd, &desired, &one->command);
}

/* Random states: torques, faults, instructions, stack. */
static void OWN(_steps)(void)
{
    const uint32_t last = (uint32_t)(JOIN(UPPER, _DURATION) / JOIN(UPPER, _PERIOD) + 0.5f);
    uint64_t random = 1, hash = HASH_START;
    uint32_t worst = 0, total = 0, deepest = 0, faults = 0;
    struct OWN(_case) one;
    OWN(_init)(&one.controller);
    for (int state = 0; state < STATES; state++) {
        const struct OWN(_controller) before = one.controller;
        struct OWN(_desired) desired;
        uint32_t count;
        one.tick = random_below(&random, last + 1);
        OWN(_reference)(one.tick, &desired);
        for (int i = 0; i < JOINTS; i++) {
            one.q[i] = desired.q[i] + random_symmetric(&random) * ERROR;
            one.qd[i] = desired.qd[i] + random_symmetric(&random);
        }
        count = stack_of(OWN(_control), &one) - stack_of(nothing_to_do, &one);
        deepest = count > deepest ? count : deepest;
        faults += one.fault != JOIN(UPPER, _OK);
        one.controller = before;
        count = instructions_of(OWN(_control), &one);
        worst = count > worst ? count : worst;
        total += count;
        faults += one.fault != JOIN(UPPER, _OK);
        hash = hash_of(hash, one.command.torque, JOINTS);
    }
    print_line(TEXT(MODULE), "torques", hash);
    print_line(TEXT(MODULE), "steps_with_fault", faults);
    print_line(TEXT(MODULE), "instructions_worst", worst);
    print_line(TEXT(MODULE), "instructions_mean", total / STATES);
    print_line(TEXT(MODULE), "stack", deepest);
}

/* One infinite or NaN number at a time: the fault must name it, and the next step must be good. */
static void OWN(_refuse)(void)
{
    const uint32_t middle = (uint32_t)(JOIN(UPPER, _DURATION) / JOIN(UPPER, _PERIOD) + 0.5f) / 2;
    uint64_t hash = HASH_START;
    uint32_t wrong = 0;
    struct OWN(_desired) good;
    OWN(_reference)(middle, &good);
    for (int place = 0; place < 3 * 5 * JOINTS; place++) {
        const int joint = place % JOINTS, input = place / JOINTS % 5;
        const float bad[] = {NAN, INFINITY, -INFINITY};
        struct OWN(_controller) controller;
        struct OWN(_command) command;
        struct OWN(_desired) measured = good, desired = good;
        float *const inputs[] = {measured.q, measured.qd, desired.q, desired.qd, desired.qdd};
        int right;
        OWN(_init)(&controller);
        right = OWN(_step)(&controller, good.q, good.qd, &good, &command) == JOIN(UPPER, _OK);
        inputs[input][joint] = bad[place / (5 * JOINTS)];
        right &= (int)OWN(_step)(&controller, measured.q, measured.qd, &desired, &command) == input + 1;
        right &= command.fault_joint == joint;
        hash = hash_of(hash, command.torque, JOINTS);
        right &= OWN(_step)(&controller, good.q, good.qd, &good, &command) == JOIN(UPPER, _OK);
        wrong += !right;
    }
    print_line(TEXT(MODULE), "not_finite_and_wrong", wrong);
    print_line(TEXT(MODULE), "not_finite_commands", hash);
}

static void OWN(_measure)(void)
{
    OWN(_steps)();
    OWN(_refuse)();
}

#undef PASTE
#undef JOIN
#undef QUOTE
#undef TEXT
#undef OWN
#undef JOINTS
#undef MODULE
#undef UPPER
#undef ERROR
